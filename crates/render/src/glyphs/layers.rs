//! All glyphs of a picture, gathered by colour so that it has few paths.

use super::kind::{GlyphColour, GlyphKind};
use super::note::Note;
use crate::colour::{ColourMap, Rgba};
use crate::scene::{PathBuilder, Scene};
use std::collections::BTreeSet;
use tigereye_core::{Anisotropy, Tensor2};

pub(super) const ANISOTROPY_STEPS: usize = 16;
pub(super) const TENSION: Rgba = Rgba::hex(0xd55e00);
pub(super) const COMPRESSION: Rgba = Rgba::hex(0x0072b2);
pub(super) const MIXED: Rgba = Rgba::hex(0x8a7a9b);
/// Ellipses without a sign.
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

/// The class of a glyph that determines its colour if colours show signs.
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
    /// Colours of the anisotropy.
    pub(super) map: ColourMap,
    /// By [`Tone`].
    pub(super) tones: [Layer; 4],
    pub(super) anisotropy: [Layer; ANISOTROPY_STEPS],
    /// Major axes of indefinite tensors: tension, compression.
    pub(super) signed_lines: [PathBuilder; 2],
    /// Sectors of rotations: counter-clockwise, clockwise.
    pub(super) sectors: [PathBuilder; 2],
    /// Lines that reflections keep.
    pub(super) mirrors: PathBuilder,
    pub(super) zeros: PathBuilder,
    pub(super) broken: PathBuilder,
    /// Marks that the legend has to explain.
    pub(super) notes: BTreeSet<Note>,
}

impl Layers {
    pub(super) fn of(kind: GlyphKind, colour: GlyphColour, map: ColourMap) -> Self {
        Self {
            kind,
            colour,
            map,
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

    /// The layer of a glyph of `t`, which belongs to `tone` if colours show signs.
    pub(super) fn layer(&mut self, t: &Tensor2, tone: Tone) -> &mut Layer {
        match self.colour {
            GlyphColour::Anisotropy => {
                let step = Anisotropy::of(t).linear * (ANISOTROPY_STEPS - 1) as f64;
                &mut self.anisotropy[(step.round().max(0.0) as usize).min(ANISOTROPY_STEPS - 1)]
            }
            GlyphColour::AxisSign => &mut self.tones[tone as usize],
        }
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
