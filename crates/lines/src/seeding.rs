//! Lines that cover a field evenly.

use crate::{Family, Interpolated, LineEnd, LineOptions, TensorLine, tensor_line};
use std::collections::VecDeque;
use tigereye_core::{PhysicalPoint, Point, Vector, length};

/// The distance at which lines end, as a fraction of the distance of their seeds (Jobard and Lefer).
const CLOSEST: f64 = 0.5;
/// Lines shorter than this multiple of the separation are omitted.
const SHORTEST: f64 = 0.5;

/// Largest number of points of all lines together: beyond it, pictures and files take gigabytes.
pub const MAX_POINTS: usize = 1 << 24;

/// Evenly spaced lines about `separation` apart (in units of the smaller side of a cell, at least 0.1), in an order
/// that depends only on the field: seeds are tried beside existing lines first, then all over the field (Jobard and
/// Lefer, Creating evenly-spaced streamlines of arbitrary density, 1997). A line keeps its distance from other lines,
/// but not from itself: a spiral continues up to the greatest length. Degenerate fields give no lines. The search stops
/// after the line that brings the total above [`MAX_POINTS`] points.
#[must_use]
pub fn evenly_spaced(
    field: &Interpolated<'_>,
    family: Family,
    separation: f64,
    options: &LineOptions,
) -> Vec<TensorLine> {
    let separation = if separation >= 0.1 { separation } else { 0.1 };
    let last = field.last();
    let cell = field.cell();
    let mut covered = Covered::new(cell.physical(last), separation);
    let mut lines: Vec<TensorLine> = Vec::new();
    let mut queue = VecDeque::new();
    let mut points = 0;
    let middle = last * 0.5;
    // At half the separation, no gap is missed that a line would fit into.
    let stride = (0.5 * separation).max(1.0);
    let [dx, dy] = cell.sides().map(|side| stride / side);
    let along = move |last: f64, step: f64| (0..=(last / step) as usize).map(move |i| i as f64 * step);
    let everywhere = along(last.y, dy).flat_map(|y| along(last.x, dx).map(move |x| Point::new(x, y)));
    for start in std::iter::once(middle).chain(everywhere) {
        queue.push_back(start);
        while let Some(seed) = queue.pop_front() {
            if covered.is_near(cell.physical(seed), separation) {
                continue;
            }
            let line = tensor_line(field, seed, family, options, &mut |p| {
                !covered.is_near(cell.physical(p), CLOSEST * separation)
            });
            if line.points.len() < 2 || line.length(cell) < SHORTEST * separation {
                continue;
            }
            let physical: Vec<PhysicalPoint> = line.points.iter().map(|p| cell.physical(*p)).collect();
            covered.add(&physical);
            queue.extend(beside(&physical, separation).into_iter().map(|p| cell.in_cells(p)));
            points += line.points.len();
            lines.push(line);
            if points > MAX_POINTS {
                return lines;
            }
        }
    }
    lines
}

/// Candidate seeds at both sides of a line.
fn beside(line: &[PhysicalPoint], separation: f64) -> Vec<PhysicalPoint> {
    let mut seeds = Vec::new();
    for p in line.windows(2).step_by(4) {
        let along = p[1] - p[0];
        let size = length(along);
        if size > 0.0 {
            let across = Vector::new(along.y, -along.x) / size;
            // A little further, so that rounding does not put the seed too close.
            for side in [1.0 + 1e-9, -1.0 - 1e-9] {
                seeds.push(p[0] + across * (side * separation));
            }
        }
    }
    seeds
}

/// Points of the finished lines in a grid of squares.
struct Covered {
    squares: Vec<Vec<PhysicalPoint>>,
    columns: usize,
    rows: usize,
    side: f64,
    /// Points of a line that are closer to the last kept one than this are dropped.
    grain: f64,
}

/// Largest number of squares along a side.
const MAX_SQUARES: f64 = 1024.0;
/// Distance of the points kept of a line, as a fraction of the separation.
const GRAIN: f64 = 0.1;

impl Covered {
    /// For points between the origin and `last`, to the right and below.
    fn new(last: PhysicalPoint, separation: f64) -> Self {
        let (right, bottom) = (last.x, -last.y);
        let side = separation.max(right.max(bottom) / MAX_SQUARES);
        let (columns, rows) = ((right / side) as usize + 1, (bottom / side) as usize + 1);
        Self { squares: vec![Vec::new(); columns * rows], columns, rows, side, grain: GRAIN * separation }
    }

    fn square(&self, p: PhysicalPoint) -> (usize, usize) {
        let index = |v: f64, n: usize| ((v / self.side).max(0.0) as usize).min(n - 1);
        (index(p.x, self.columns), index(-p.y, self.rows))
    }

    fn add(&mut self, line: &[PhysicalPoint]) {
        let mut last = None;
        for (i, p) in line.iter().enumerate() {
            if i + 1 < line.len() && last.is_some_and(|q| length(*p - q) < self.grain) {
                continue;
            }
            last = Some(*p);
            let (x, y) = self.square(*p);
            self.squares[y * self.columns + x].push(*p);
        }
    }

    /// Whether a point of a line lies within `reach`, which is at most the side of a square.
    fn is_near(&self, p: PhysicalPoint, reach: f64) -> bool {
        let (x, y) = self.square(p);
        let around = |v: usize, n: usize| v.saturating_sub(1)..(v + 2).min(n);
        let near = |q: &PhysicalPoint| (p - *q).square_length() < reach * reach;
        around(y, self.rows)
            .any(|y| around(x, self.columns).any(|x| self.squares[y * self.columns + x].iter().any(near)))
    }
}

impl TensorLine {
    /// Whether it returns to its seed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.ends == [LineEnd::Closed; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Field, Grid, Tensor2};

    #[test]
    fn lines_keep_their_distance_and_leave_no_gap() {
        let field = Field::from_fn(Grid::new(31, 21).expect("a size"), |c| {
            Tensor2::from_axes(0.05 * c.x as f64 - 0.03 * c.y as f64, 3.0, 1.0)
        });
        let between = Interpolated::new(&field);
        let separation = 2.0;
        let lines = evenly_spaced(&between, Family::Major, separation, &LineOptions::default());
        for (i, a) in lines.iter().enumerate() {
            for b in &lines[i + 1..] {
                let closest = a.points.iter().flat_map(|p| b.points.iter().map(|q| length(*p - *q)));
                // The compared points may be up to half of a grain off.
                let least = (CLOSEST - 0.5 * GRAIN) * separation;
                assert!(closest.fold(f64::INFINITY, f64::min) >= least);
            }
        }
        for y in 0..21 {
            for x in 0..31 {
                let p = Point::new(f64::from(x), f64::from(y));
                let near = lines.iter().flat_map(|l| &l.points).map(|q| length(p - *q));
                assert!(near.fold(f64::INFINITY, f64::min) < 1.5 * separation, "{p:?}");
            }
        }
    }

    #[test]
    fn degenerate_fields_have_no_lines() {
        for t in [Tensor2::ZERO, Tensor2::IDENTITY, Tensor2::isotropic(f64::NAN)] {
            let field = Field::from_fn(Grid::new(12, 9).expect("a size"), |_| t);
            let lines =
                evenly_spaced(&Interpolated::new(&field), Family::Minor, 1.0, &LineOptions::default());
            assert!(lines.is_empty());
        }
        let point = Field::from_fn(Grid::new(1, 1).expect("a size"), |_| Tensor2::from_axes(0.0, 2.0, 1.0));
        assert!(
            evenly_spaced(&Interpolated::new(&point), Family::Major, 1.0, &LineOptions::default()).is_empty()
        );
    }
}
