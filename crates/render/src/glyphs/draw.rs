//! Every kind of glyph into its layers, and the layers onto a scene.

use super::kind::GlyphKind;
use super::layers::{ANISOTROPY_STEPS, COMPRESSION, DASH_PX, Layers, MIXED, PLAIN, TENSION};
use super::note::Note;
use super::scaling::Scaling;
use super::{arrows, quadric, signed, turned};
use crate::colour::Rgba;
use crate::legend::Entry;
use crate::scene::{PagePoint, PageVector, Scene};
use crate::shapes;
use tigereye_core::{Symmetry, Tensor2};

impl Layers {
    pub(super) fn add(&mut self, centre: PagePoint, t: &Tensor2, scaling: &Scaling) {
        let size = self.kind.size(t);
        if !size.is_finite() {
            let r = (0.25 * scaling.radius).clamp(1.5, 4.0);
            for diagonal in [PageVector::new(r, r), PageVector::new(r, -r)] {
                self.broken.line(centre - diagonal, centre + diagonal);
            }
            self.notes.insert(Note::Broken);
            return;
        }
        let is_symmetric = t.is_symmetric_within(Symmetry::ROUNDING * scaling.largest);
        if self.kind.is_symmetric() && !is_symmetric {
            self.notes.insert(Note::SymmetricPart);
        }
        if size == 0.0 {
            self.zeros.circle(centre, (0.16 * scaling.radius).clamp(1.2, 2.5));
            // Both look the same, so one entry must name both.
            if !t.is_zero() {
                self.notes.remove(&Note::Zero);
                self.notes.insert(Note::NoSymmetricPart);
            } else if !self.notes.contains(&Note::NoSymmetricPart) {
                self.notes.insert(Note::Zero);
            }
            return;
        }
        match self.kind {
            GlyphKind::Ellipse | GlyphKind::Box | GlyphKind::Superquadric { .. } => {
                quadric::add(self, centre, t, scaling);
            }
            GlyphKind::Signed => signed::add(self, centre, t, scaling),
            GlyphKind::Arrows => arrows::add(self, centre, t, scaling),
            GlyphKind::Asymmetric => turned::add(self, centre, t, scaling),
        }
    }

    /// Paints all layers and returns the legend of the marks that occur.
    pub(super) fn draw(self, scene: &mut Scene) -> Vec<Entry> {
        for (layer, colour) in self.tones.into_iter().zip([TENSION, COMPRESSION, MIXED, PLAIN]) {
            layer.draw(scene, colour);
        }
        for (lines, colour) in self.signed_lines.into_iter().zip([TENSION, COMPRESSION]) {
            if !lines.is_empty() {
                scene.stroke(lines.finish(), colour, 1.2);
            }
        }
        for (i, layer) in self.anisotropy.into_iter().enumerate() {
            layer.draw(scene, self.map.sample(i as f64 / (ANISOTROPY_STEPS - 1) as f64));
        }
        let [left, right] = self.sectors;
        if !left.is_empty() {
            turned::paint_left(scene, left.finish(), self.colour);
        }
        if !right.is_empty() {
            turned::paint_right(scene, right.finish(), self.colour);
        }
        if !self.mirrors.is_empty() {
            shapes::dashed(scene, self.mirrors.finish(), Rgba::INK, 1.2, &DASH_PX);
        }
        if !self.zeros.is_empty() {
            scene.stroke(self.zeros.finish(), Rgba::MUTED, 0.8);
        }
        if !self.broken.is_empty() {
            scene.stroke(self.broken.finish(), Rgba::NOT_FINITE, 1.2);
        }
        self.notes.into_iter().map(|note| note.entry(self.colour)).collect()
    }
}
