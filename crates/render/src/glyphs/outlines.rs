//! The outlines of glyphs as lines instead of a picture.

use super::layers::{Layer, Layers, Tone};
use super::{GlyphColour, GlyphOptions, Scaling};
use crate::colour::ColourMap;
use crate::map_frame;
use crate::scene::{PagePoint, PathBuilder, Segment};
use tigereye_core::{Cell, Field, Point, Tensor2};

/// The part of a glyph that an outline draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GlyphPart {
    /// An area: an ellipse, a box, a superellipse, a lobe of tension.
    Area,
    /// An area that pictures leave white: a lobe of compression.
    Hollow,
    /// A line: a glyph without width, the major axis within an area, the shaft of an arrow.
    Line,
    /// The head of an arrow.
    Head,
    /// A sector that spans the angle of a tensor's rotation.
    Sector,
    /// The invariant line of a reflection.
    Mirror,
}

/// A line, or the boundary of an area, of a glyph.
#[derive(Debug, Clone, PartialEq)]
pub struct GlyphOutline {
    /// The cell of the tensor.
    pub cell: Cell,
    /// The part of the glyph.
    pub part: GlyphPart,
    /// 1 for tension and counter-clockwise rotation, -1 for compression and clockwise rotation, 0 for neither or both.
    pub sign: i8,
    /// Whether its last point is connected with its first.
    pub closed: bool,
    /// Its points; curves in straight pieces.
    pub points: Vec<Point>,
}

/// Pixels per cell at which outlines are computed: curves are as fine as in a large picture.
const CELL_PX: f64 = 64.0;
/// Pieces of a cubic; those of an ellipse are a quarter of it.
const PIECES: usize = 8;

/// The outlines of [`super::glyphs`], glyph by glyph, for every n-th cell (`every`, 1 by default) and the options
/// `kind`, `scale` and `cell`; the other options apply to pictures only. Zero and non-finite tensors have no outlines.
#[must_use]
pub fn glyph_outlines(field: &Field<Tensor2>, options: &GlyphOptions) -> Vec<GlyphOutline> {
    let (kind, every) = (options.kind, options.every.unwrap_or(1).max(1));
    let largest = super::largest(field, kind);
    let scaling = Scaling { kind: options.scale, largest, radius: kind.radius() * CELL_PX * every as f64 };
    let mut outlines = Vec::new();
    for cell in map_frame::sampled_cells(field.grid(), every) {
        let mut layers = Layers::of(kind, GlyphColour::AxisSign, ColourMap::Batlow);
        layers.add(PagePoint::zero(), field.at(cell), &scaling);
        let [width, height] = options.cell.sides();
        let in_cells = |p: &PagePoint| {
            let centre = cell.centre();
            Point::new(centre.x + p.x / CELL_PX / width, centre.y + p.y / CELL_PX / height)
        };
        let mut push = |path: PathBuilder, part: GlyphPart, sign: i8| {
            for (points, closed) in pieces(&path.finish()) {
                let points = points.iter().map(in_cells).collect();
                outlines.push(GlyphOutline { cell, part, sign, closed, points });
            }
        };
        let signs = [Tone::Tension, Tone::Compression, Tone::Mixed, Tone::Plain].map(Tone::sign);
        for (layer, sign) in layers.tones.into_iter().zip(signs) {
            let Layer { areas, hollow, lines, segments, heads } = layer;
            let parts = [
                (areas, GlyphPart::Area),
                (hollow, GlyphPart::Hollow),
                (lines, GlyphPart::Line),
                (segments, GlyphPart::Line),
                (heads, GlyphPart::Head),
            ];
            parts.into_iter().for_each(|(path, part)| push(path, part, sign));
        }
        // Omit the signed lines of indefinite tensors: they repeat the major axis only to colour it.
        for (sector, sign) in layers.sectors.into_iter().zip([1, -1]) {
            push(sector, GlyphPart::Sector, sign);
        }
        push(layers.mirrors, GlyphPart::Mirror, 0);
    }
    outlines
}

impl Tone {
    const fn sign(self) -> i8 {
        match self {
            Self::Tension => 1,
            Self::Compression => -1,
            Self::Mixed | Self::Plain => 0,
        }
    }
}

/// The sub-paths of a path with curves in straight pieces, and which are closed.
fn pieces(path: &[Segment]) -> Vec<(Vec<PagePoint>, bool)> {
    let mut all: Vec<(Vec<PagePoint>, bool)> = Vec::new();
    for segment in path {
        let curve = |points: &mut Vec<PagePoint>, controls: &[PagePoint]| {
            let Some(&from) = points.last() else { return };
            points.extend((1..=PIECES).map(|i| bezier(from, controls, i as f64 / PIECES as f64)));
        };
        match (*segment, all.last_mut()) {
            (Segment::Move(p), _) => all.push((vec![p], false)),
            (Segment::Close, Some((points, closed))) => {
                *closed = true;
                // A closed curve repeats its first point.
                if points.len() > 1 && near(points[0], points[points.len() - 1]) {
                    points.pop();
                }
            }
            (Segment::Line(p), Some((points, _))) => points.push(p),
            (Segment::Quad(c, p), Some((points, _))) => curve(points, &[c, p]),
            (Segment::Cubic(c, d, p), Some((points, _))) => curve(points, &[c, d, p]),
            (_, None) => {}
        }
    }
    all
}

fn near(p: PagePoint, q: PagePoint) -> bool {
    (p.x - q.x).abs() < 1e-9 * CELL_PX && (p.y - q.y).abs() < 1e-9 * CELL_PX
}

/// A point of the curve from `from` with these control points, the last of which is its end (de Casteljau).
fn bezier(from: PagePoint, controls: &[PagePoint], t: f64) -> PagePoint {
    let mut points = [PagePoint::zero(); 4];
    let count = controls.len() + 1;
    points[0] = from;
    points[1..count].copy_from_slice(controls);
    for level in (1..count).rev() {
        for i in 0..level {
            points[i] = points[i] + (points[i + 1] - points[i]) * t;
        }
    }
    points[0]
}

#[cfg(test)]
mod tests {
    use super::super::{GlyphKind, GlyphScale};
    use super::*;
    use tigereye_core::Grid;

    fn outlines(kind: GlyphKind, tensors: &[Tensor2]) -> Vec<GlyphOutline> {
        let field = Field::from_fn(Grid::new(tensors.len(), 1).expect("a size"), |c| tensors[c.x]);
        glyph_outlines(&field, &GlyphOptions { kind, scale: GlyphScale::Glyph, ..GlyphOptions::default() })
    }

    #[test]
    fn ellipses_have_their_axes_within_their_cell() {
        let found = outlines(GlyphKind::Ellipse, &[Tensor2::ZERO, Tensor2::from_axes(0.5, 3.0, 1.0)]);
        let [area, axis] = &found[..] else { panic!("{found:?}") };
        assert_eq!((area.part, area.sign, area.closed), (GlyphPart::Area, 1, true));
        assert_eq!((axis.part, axis.closed, axis.points.len()), (GlyphPart::Line, false, 2));
        assert!(found.iter().all(|o| o.cell == Cell::new(1, 0)));
        for p in &area.points {
            // Semi-axes 0.45 and 0.15 about (1, 0), y downwards, tilted up by 0.5.
            let (x, y) = (p.x - 1.0, -p.y);
            let (c, s) = (tigereye_core::math::cos(0.5), tigereye_core::math::sin(0.5));
            let (u, v) = ((c * x + s * y) / 0.45, (c * y - s * x) / 0.15);
            assert!((u * u + v * v - 1.0).abs() < 1e-3, "{p:?}");
        }
        assert_eq!(area.points.len(), 4 * PIECES, "the first point is not repeated");
    }

    #[test]
    fn outlines_have_their_signs_and_parts() {
        let parts = |kind, t: Tensor2| {
            let mut all: Vec<_> =
                outlines(kind, &[t]).iter().map(|o| (o.part as usize, o.sign, o.closed)).collect();
            all.sort_unstable();
            all
        };
        let (area, hollow, line, head) = (0, 1, 2, 3);
        let pulled = Tensor2::symmetric(2.0, 0.0, -1.0);
        assert_eq!(
            parts(GlyphKind::Signed, pulled),
            [(area, 1, true), (area, 1, true), (hollow, -1, true), (hollow, -1, true)]
        );
        let arrows = [(-1, head), (1, head)].map(|(sign, part)| [(part, sign, true); 2]).concat();
        let mut expected = [vec![(line, -1, false), (line, 1, false)], arrows].concat();
        expected.sort_unstable();
        assert_eq!(parts(GlyphKind::Arrows, pulled), expected);
        let turned = Tensor2::new(1.0, -0.5, 0.5, 1.0);
        let sectors = parts(GlyphKind::Asymmetric, turned);
        assert_eq!(sectors.iter().filter(|p| **p == (4, 1, true)).count(), 2, "{sectors:?}");
        let back = parts(GlyphKind::Asymmetric, turned.transposed());
        assert_eq!(back.iter().filter(|p| **p == (4, -1, true)).count(), 2, "{back:?}");
        let mirrored = parts(GlyphKind::Asymmetric, Tensor2::new(1.0, 0.0, 0.0, -1.0));
        assert!(mirrored.contains(&(5, 0, false)), "{mirrored:?}");
    }
}
