//! The embedded font: widths and outlines of text.
//!
//! All pictures use one face, a subset of DejaVu Sans (see `assets/README.md`). Nothing is asked of the system.

use crate::scene::{Anchor, PagePoint, PathBuilder, Segment, Text};
use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve, Point};
use std::sync::OnceLock;

/// The font file.
pub(crate) const BYTES: &[u8] = include_bytes!("../assets/DejaVuSans-subset.ttf");

/// Font units per em of the embedded face.
pub(crate) const UNITS_PER_EM: f64 = 2048.0;

/// Height of capitals and digits in em.
pub(crate) const CAP_HEIGHT_EM: f64 = 0.729;

/// Left, lower, right and upper end of all glyphs, font units (the font's table `head`).
pub(crate) const BOUNDS: [f64; 4] = [-2090.0, -948.0, 3673.0, 2524.0];
/// Ascent and descent, font units (the font's table `hhea`).
pub(crate) const ASCENT: f64 = 1901.0;
pub(crate) const DESCENT: f64 = -483.0;

fn face() -> Option<&'static FontRef<'static>> {
    static FACE: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    // The bytes are part of the crate and a test reads them; text would be left out, not crash, were they broken.
    FACE.get_or_init(|| FontRef::try_from_slice(BYTES).ok()).as_ref()
}

/// Width of `text` at `size_px`, in pixels.
#[must_use]
pub fn text_width(text: &str, size_px: f64) -> f64 {
    let Some(face) = face() else { return 0.0 };
    let units: f64 = text.chars().map(|c| f64::from(face.h_advance_unscaled(face.glyph_id(c)))).sum();
    units / UNITS_PER_EM * size_px
}

/// Horizontal shift in pixels from the anchor point to the left end of a text.
pub(crate) fn anchor_shift(text: &Text) -> f64 {
    let width = text_width(&text.text, text.size_px);
    match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * width,
        Anchor::End => -width,
    }
}

/// Whether the embedded font has a shape for `c`.
#[must_use]
pub fn has_glyph(c: char) -> bool {
    face().is_some_and(|f| f.glyph_id(c).0 != 0)
}

/// The glyphs of `text` with the characters they stand for.
pub(crate) fn glyphs(text: &str) -> Vec<(u16, char)> {
    let Some(face) = face() else { return Vec::new() };
    text.chars().map(|c| (face.glyph_id(c).0, c)).collect()
}

/// Width of a glyph, font units.
pub(crate) fn glyph_width(glyph: u16) -> f64 {
    face().map_or(0.0, |face| f64::from(face.h_advance_unscaled(GlyphId(glyph))))
}

/// Outline of `text` in font units, y up, starting at the origin on the baseline.
pub(crate) fn outline(text: &str) -> Vec<Segment> {
    let Some(face) = face() else { return Vec::new() };
    let mut path = PathBuilder::default();
    let mut x = 0.0;
    for c in text.chars() {
        let id = face.glyph_id(c);
        if let Some(shape) = face.outline(id) {
            add_glyph(&mut path, &shape.curves, x);
        }
        x += f64::from(face.h_advance_unscaled(id));
    }
    path.finish()
}

fn add_glyph(path: &mut PathBuilder, curves: &[OutlineCurve], dx: f64) {
    let at = |p: Point| PagePoint::new(f64::from(p.x) + dx, f64::from(p.y));
    let mut pen: Option<Point> = None;
    for curve in curves {
        let (OutlineCurve::Line(from, to)
        | OutlineCurve::Quad(from, _, to)
        | OutlineCurve::Cubic(from, _, _, to)) = *curve;
        if pen != Some(from) {
            if pen.is_some() {
                path.close();
            }
            path.move_to(at(from));
        }
        match *curve {
            OutlineCurve::Line(_, to) => path.line_to(at(to)),
            OutlineCurve::Quad(_, c, to) => path.quad_to(at(c), at(to)),
            OutlineCurve::Cubic(_, c, d, to) => path.cubic_to(at(c), at(d), at(to)),
        }
        pen = Some(to);
    }
    if pen.is_some() {
        path.close();
    }
}

/// `text` broken at spaces into lines no wider than `max_width_px`; a single longer word keeps its own line.
pub(crate) fn wrapped(text: &str, size_px: f64, max_width_px: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match (longer, lines.last_mut()) {
            (Some(longer), Some(last)) if text_width(&longer, size_px) <= max_width_px => *last = longer,
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
