//! From tensors to pixels.

use super::kind::GlyphScale;
use crate::scene::PagePoint;
use tigereye_core::{Svd, Vector};

/// From the tensor's unit to pixels.
pub(super) struct Scaling {
    pub(super) kind: GlyphScale,
    /// Largest semi-axis of the field, finite.
    pub(super) largest: f64,
    /// Its length in pixels: less than half of the distance between glyphs.
    pub(super) radius: f64,
}

impl Scaling {
    /// Pixels for a length `value >= 0` of a glyph whose largest semi-axis is `size`.
    pub(super) fn length(&self, value: f64, size: f64) -> f64 {
        let unit = if self.kind == GlyphScale::Glyph { size } else { self.largest };
        let share = if unit > 0.0 { value / unit } else { 0.0 };
        self.radius * if self.kind == GlyphScale::SquareRoot { share.sqrt() } else { share }
    }

    /// Semi-axes in pixels.
    pub(super) fn axes(&self, svd: &Svd) -> [f64; 2] {
        svd.s.map(|s| self.length(s, svd.s[0]))
    }
}

/// The point at `length` pixels from `centre` in a direction of the tensor's frame.
pub(super) fn towards(centre: PagePoint, direction: Vector, length: f64) -> PagePoint {
    PagePoint::new(centre.x + length * direction.x, centre.y - length * direction.y)
}
