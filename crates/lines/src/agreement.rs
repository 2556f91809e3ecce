//! Agreement of two scalar fields and of their ridges.

use crate::{NearestSegment, Polyline, Polylines, RidgeOptions, Threshold};
use tigereye_core::{Field, Grid, Point, length};

/// Cells along the border in which ridges are not compared: gradients are 0 in the outermost cells, and ridges need
/// neighbours.
pub const MARGIN: f64 = 4.0;
/// Ridges are sampled in pieces of this length, cells.
const PIECE: f64 = 0.25;
/// Shorter ridges are left out, cells.
const LEAST_LENGTH: f64 = 3.0;
/// Ridges weaker than this fraction of the strongest curvature are ignored.
const LEAST_STRENGTH: f64 = 0.05;
/// So are those below this fraction of the range of values.
const LEAST_VALUE: f64 = 0.25;

/// Which ridges are compared: at least a twentieth as strong as the strongest one, in the upper three quarters of the
/// range of values, and at least three cells long. All scalars are sampled at the cells, because between them
/// exponents have the kinks of the interpolated tensors, which look like ridges.
pub const COMPARED: RidgeOptions = RidgeOptions {
    least_strength: Threshold::Part(LEAST_STRENGTH),
    least_value: Threshold::Part(LEAST_VALUE),
    least_extent: LEAST_LENGTH,
    ..RidgeOptions::USUAL
};

/// Appends lines to others.
pub fn append(all: &mut Polylines, more: &Polylines) {
    let first = all.points.len() as u32;
    all.points.extend_from_slice(&more.points);
    all.lines.extend(more.lines.iter().map(|line| Polyline {
        points: line.points.iter().map(|i| i + first).collect(),
        closed: line.closed,
    }));
}

/// Distances of one set of ridges from another, weighted by the length of the first; cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Distances {
    /// Distance and length of every piece, the nearest first.
    pieces: Vec<(f64, f64)>,
    length: f64,
}

impl Distances {
    /// Distances of the pieces of `of` that lie at least [`MARGIN`] cells inside a grid from the nearest point of
    /// `from`; infinite if `from` is empty.
    #[must_use]
    pub fn between(of: &Polylines, from: &Polylines, grid: Grid) -> Self {
        let near = NearestSegment::new(from);
        let [right, bottom] = [grid.width(), grid.height()].map(|n| (n - 1) as f64 - MARGIN);
        let mut pieces = Vec::new();
        for [a, b] in of.lines.iter().flat_map(Polyline::segments) {
            let (p, q) = (of.points[a as usize], of.points[b as usize]);
            let extent = length(q - p);
            let count = (extent / PIECE).ceil().max(1.0) as usize;
            for k in 0..count {
                let t = (k as f64 + 0.5) / count as f64;
                let at = p + (q - p) * t;
                if (MARGIN..=right).contains(&at.x) && (MARGIN..=bottom).contains(&at.y) {
                    let distance = near.distance(at).unwrap_or(f64::INFINITY);
                    pieces.push((distance, extent / count as f64));
                }
            }
        }
        pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
        // The sum of nothing is -0.
        let length = pieces.iter().map(|p| p.1).sum::<f64>() + 0.0;
        Self { pieces, length }
    }

    /// Length of the compared pieces, cells.
    #[must_use]
    pub const fn length(&self) -> f64 {
        self.length
    }

    /// Mean distance; NaN if nothing was compared.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.pieces.iter().map(|(d, l)| d * l).sum::<f64>() / self.length
    }

    /// The distance within which the fraction `share` of the length lies; NaN if nothing was compared.
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        let mut gone = 0.0;
        for (distance, length) in &self.pieces {
            gone += length;
            if gone >= share * self.length {
                return *distance;
            }
        }
        self.pieces.last().map_or(f64::NAN, |p| p.0)
    }

    /// Share of the length within a distance; NaN if nothing was compared.
    #[must_use]
    pub fn share_within(&self, distance: f64) -> f64 {
        self.pieces.iter().filter(|(d, _)| *d <= distance).map(|p| p.1).fold(0.0, |sum, l| sum + l)
            / self.length
    }
}

/// Share of the area at least [`MARGIN`] cells inside a grid that lies within a distance of lines: the share of
/// anything unrelated that would lie there by chance.
#[must_use]
pub fn chance(lines: &Polylines, grid: Grid, within: f64) -> f64 {
    let near = NearestSegment::new(lines);
    let steps = [grid.width(), grid.height()].map(|n| (((n - 1) as f64 - 2.0 * MARGIN) / PIECE) as usize + 1);
    let along = |k: usize| MARGIN + k as f64 * PIECE;
    let samples = (0..steps[1]).flat_map(|j| (0..steps[0]).map(move |i| Point::new(along(i), along(j))));
    let met = samples.filter(|&p| near.distance(p).is_some_and(|d| d <= within)).count();
    met as f64 / (steps[0] * steps[1]) as f64
}

/// Pearson's correlation over the cells where both scalars are finite; `None` for fields of different size, or if one
/// of them is constant.
#[must_use]
pub fn correlation(a: &Field<f64>, b: &Field<f64>) -> Option<f64> {
    if a.grid() != b.grid() {
        return None;
    }
    let pairs: Vec<(f64, f64)> = a.values().iter().copied().zip(b.values().iter().copied()).collect();
    let pairs: Vec<(f64, f64)> = pairs.into_iter().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    tigereye_core::pearson(&pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line<const N: usize>(points: [(f64, f64); N]) -> Polylines {
        let indices = (0..N as u32).collect();
        Polylines {
            points: points.map(Point::from).to_vec(),
            lines: vec![Polyline { points: indices, closed: false }],
        }
    }

    fn grid() -> Grid {
        Grid::new(41, 41).expect("a size")
    }

    #[test]
    fn distances_are_measured_along_the_first() {
        let (a, b) = (line([(10.0, 10.0), (30.0, 10.0)]), line([(10.0, 12.0), (20.0, 12.0)]));
        let forth = Distances::between(&a, &b, grid());
        // Half of it is 2 away; the rest goes on to (30, 10), which is hypot(10, 2) away.
        assert!((forth.length() - 20.0).abs() < 1e-9 && forth.quantile(0.4) == 2.0);
        assert!((forth.share_within(2.0) - 0.5).abs() < 0.02, "{}", forth.share_within(2.0));
        assert!(forth.mean() > 3.0 && forth.quantile(0.95) > 8.0);
        let back = Distances::between(&b, &a, grid());
        assert!((back.mean() - 2.0).abs() < 1e-12 && back.share_within(1.9) == 0.0);
    }

    #[test]
    fn borders_are_left_out_and_nothing_is_infinitely_far() {
        let edge = line([(0.0, 2.0), (40.0, 2.0)]);
        let inside = line([(0.0, 20.0), (40.0, 20.0)]);
        assert!(Distances::between(&edge, &inside, grid()).mean().is_nan());
        let cut = Distances::between(&inside, &edge, grid());
        assert!((cut.length() - 32.0).abs() < 0.3 && (cut.mean() - 18.0).abs() < 1e-9, "{}", cut.length());
        let alone = Distances::between(&inside, &Polylines::default(), grid());
        assert_eq!((alone.mean(), alone.share_within(5.0)), (f64::INFINITY, 0.0));
    }

    #[test]
    fn appended_lines_keep_their_points() {
        let mut all = line([(1.0, 1.0), (2.0, 2.0)]);
        append(&mut all, &line([(4.0, 6.0), (8.0, 10.0)]));
        assert_eq!(all.points[2..], [(4.0, 6.0), (8.0, 10.0)].map(Point::from));
        assert_eq!(all.lines[1].points, [2, 3]);
    }

    #[test]
    fn chance_is_the_share_of_the_area() {
        // A band of two cells in the middle 32.
        let found = chance(&line([(0.0, 20.0), (40.0, 20.0)]), grid(), 1.0);
        assert!((found - 2.0 / 32.0).abs() < 0.01, "{found}");
        assert_eq!(chance(&Polylines::default(), grid(), 1.0), 0.0);
    }

    #[test]
    fn correlation_uses_cells_with_both_values() {
        let field = |f: fn(f64) -> f64| Field::from_fn(grid(), |c| f(c.x as f64));
        let rising = field(|x| x);
        let holes = field(|x| if x < 5.0 { f64::NAN } else { 3.0 - 2.0 * x });
        assert!((correlation(&rising, &holes).expect("both vary") + 1.0).abs() < 1e-12);
        assert_eq!(correlation(&rising, &field(|_| 1.0)), None);
    }
}
