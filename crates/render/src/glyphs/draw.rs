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
use tigereye_core::{Symmetry, Tensor2, math};

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
            layer.draw(scene, legible(self.map.sample(i as f64 / (ANISOTROPY_STEPS - 1) as f64)));
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

/// Least contrast of a line with white, as for marks in WCAG 2.2, 1.4.11.
const LEAST_CONTRAST: f64 = 3.0;

/// A colour as a thin line on white: darkened until it stands out, its hue kept.
fn legible(colour: Rgba) -> Rgba {
    let darkened = |percent: u32| {
        let darker = |c: u8| (u32::from(c) * percent / 100) as u8;
        Rgba { r: darker(colour.r), g: darker(colour.g), b: darker(colour.b), a: colour.a }
    };
    let stands_out = |c: &Rgba| 1.05 / (luminance(*c) + 0.05) >= LEAST_CONTRAST;
    (0..=100).rev().map(darkened).find(stands_out).unwrap_or(colour)
}

/// Relative luminance, of 1 (WCAG 2.2).
fn luminance(c: Rgba) -> f64 {
    let linear = |v: u8| {
        let v = f64::from(v) / 255.0;
        if v <= 0.040_45 { v / 12.92 } else { math::pow((v + 0.055) / 1.055, 2.4) }
    };
    0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glyphs_of_every_anisotropy_stand_out_on_white() {
        for i in 0..=100 {
            let colour = crate::ColourMap::Batlow.sample(f64::from(i) / 100.0);
            let drawn = legible(colour);
            assert!(1.05 / (luminance(drawn) + 0.05) >= LEAST_CONTRAST, "{i}: {drawn:?}");
            assert!(luminance(colour) > 0.3 || drawn == colour, "dark colours stay");
        }
    }
}
