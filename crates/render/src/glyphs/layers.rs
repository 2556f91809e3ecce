//! All glyphs of a picture, gathered by colour so that it has few paths.

use super::legend::Note;
use super::{GlyphColour, GlyphKind, Scaling, arrows, quadric, signed, turned};
use crate::colour::{ColourMap, Rgba};
use crate::legend::Entry;
use crate::scene::{PathBuilder, Scene};
use crate::shapes;
use std::collections::BTreeSet;
use tigereye_core::{Anisotropy, Symmetry, Tensor2};

const ANISOTROPY_STEPS: usize = 16;
pub(super) const TENSION: Rgba = Rgba::hex(0xd55e00);
pub(super) const COMPRESSION: Rgba = Rgba::hex(0x0072b2);
pub(super) const MIXED: Rgba = Rgba::hex(0x8a7a9b);
/// Ellipses whose colour means nothing.
pub(super) const PLAIN: Rgba = Rgba::hex(0x8c8c8c);
/// Dashes of the lines that reflections keep, pixels.
pub(super) const DASH_PX: [f64; 2] = [2.5, 2.5];

/// Glyphs of one colour.
#[derive(Default)]
pub(super) struct Layer {
    /// Filled outlines.
    pub(super) areas: PathBuilder,
    /// Outlines on white.
    pub(super) hollow: PathBuilder,
    /// Thin lines within outlines.
    pub(super) lines: PathBuilder,
    /// Glyphs that are lines.
    pub(super) segments: PathBuilder,
    /// Small areas without outline.
    pub(super) heads: PathBuilder,
}

/// What decides about a glyph's colour where colours show signs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tone {
    Tension,
    Compression,
    Mixed,
    Plain,
}

/// All glyphs.
pub(super) struct Layers {
    pub(super) kind: GlyphKind,
    pub(super) colour: GlyphColour,
    /// By [`Tone`].
    pub(super) tones: [Layer; 4],
    anisotropy: [Layer; ANISOTROPY_STEPS],
    /// Major axes of indefinite tensors: tension, compression.
    pub(super) signed_lines: [PathBuilder; 2],
    /// Sectors of rotations: counter-clockwise, clockwise.
    pub(super) sectors: [PathBuilder; 2],
    /// Lines that reflections keep.
    pub(super) mirrors: PathBuilder,
    zeros: PathBuilder,
    broken: PathBuilder,
    /// What the legend must explain.
    pub(super) notes: BTreeSet<Note>,
}

impl Layers {
    pub(super) fn of(kind: GlyphKind, colour: GlyphColour) -> Self {
        Self {
            kind,
            colour,
            tones: Default::default(),
            anisotropy: Default::default(),
            signed_lines: Default::default(),
            sectors: Default::default(),
            mirrors: PathBuilder::default(),
            zeros: PathBuilder::default(),
            broken: PathBuilder::default(),
            notes: BTreeSet::new(),
        }
    }

    pub(super) fn add(&mut self, centre: [f64; 2], t: &Tensor2, scaling: &Scaling) {
        let size = self.kind.size(t);
        if !size.is_finite() {
            let r = (0.25 * scaling.radius).clamp(1.5, 4.0);
            self.broken.line([centre[0] - r, centre[1] - r], [centre[0] + r, centre[1] + r]);
            self.broken.line([centre[0] - r, centre[1] + r], [centre[0] + r, centre[1] - r]);
            self.notes.insert(Note::Broken);
            return;
        }
        let is_symmetric = t.is_symmetric_within(Symmetry::ROUNDING * scaling.largest);
        if self.kind.is_symmetric() && !is_symmetric {
            self.notes.insert(Note::SymmetricPart);
        }
        if size == 0.0 {
            self.zeros.circle(centre, (0.16 * scaling.radius).clamp(1.2, 2.5));
            // Both are drawn alike, so one entry must name both.
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

    /// Where a glyph of `t` goes that has `tone` as long as colours show signs.
    pub(super) fn layer(&mut self, t: &Tensor2, tone: Tone) -> &mut Layer {
        match self.colour {
            GlyphColour::Anisotropy => {
                let step = Anisotropy::of(t).linear * (ANISOTROPY_STEPS - 1) as f64;
                &mut self.anisotropy[(step.round().max(0.0) as usize).min(ANISOTROPY_STEPS - 1)]
            }
            GlyphColour::AxisSign => &mut self.tones[tone as usize],
        }
    }

    /// Paints everything and returns the legend of what there was.
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
            layer.draw(scene, ColourMap::Batlow.sample(i as f64 / (ANISOTROPY_STEPS - 1) as f64));
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

impl Layer {
    pub(super) fn draw(self, scene: &mut Scene, colour: Rgba) {
        if !self.areas.is_empty() {
            scene.paint(self.areas.finish(), colour.with_opacity(0.35), colour, 0.8);
        }
        if !self.hollow.is_empty() {
            scene.paint(self.hollow.finish(), Rgba::WHITE, colour, 0.8);
        }
        if !self.lines.is_empty() {
            scene.stroke(self.lines.finish(), colour.mixed(Rgba::INK, 0.35), 0.7);
        }
        if !self.segments.is_empty() {
            scene.stroke(self.segments.finish(), colour, 1.6);
        }
        if !self.heads.is_empty() {
            scene.fill(self.heads.finish(), colour);
        }
    }
}
