//! Lines that cover a field evenly.

use crate::{Family, Interpolated, LineEnd, LineOptions, TensorLine, tensor_line};
use std::collections::VecDeque;
use tigereye_core::{PhysicalPoint, Point, Vector, length};

/// Lines end closer to each other than they begin, by this factor (Jobard and Lefer).
const CLOSEST: f64 = 0.5;
/// Lines shorter than this many distances are left out.
const SHORTEST: f64 = 0.5;

/// So many points of lines are enough: drawn, written and held in memory they are gigabytes.
pub const MAX_POINTS: usize = 1 << 24;

/// Lines about `separation` apart (in the unit of [`tigereye_core::CellShape`], at least 0.1), in an order that only
/// depends on the field: seeds are tried beside the lines that are there, then all over the field (Jobard and Lefer,
/// Creating evenly-spaced streamlines of arbitrary density, 1997). A line keeps away from the others, not from itself:
/// one that winds inwards does so to its longest length. Fields without axes give no lines. After the line that makes
/// them more than [`MAX_POINTS`] points together no further one follows.
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
    // Half a distance leaves no gap that a line would fit into.
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

/// Points to both sides of a line.
fn beside(line: &[PhysicalPoint], separation: f64) -> Vec<PhysicalPoint> {
    let mut seeds = Vec::new();
    for p in line.windows(2).step_by(4) {
        let along = p[1] - p[0];
        let size = length(along);
        if size > 0.0 {
            let across = Vector::new(along.y, -along.x) / size;
            // A little more, so that rounding does not make it too near.
            for side in [1.0 + 1e-9, -1.0 - 1e-9] {
                seeds.push(p[0] + across * (side * separation));
            }
        }
    }
    seeds
}

/// Physical points of finished lines, in squares.
struct Covered {
    squares: Vec<Vec<PhysicalPoint>>,
    columns: usize,
    rows: usize,
    side: f64,
    /// Points of a line that are nearer to each other than this are one.
    grain: f64,
}

/// Most squares along a side.
const MAX_SQUARES: f64 = 1024.0;
/// Distance of the points that are kept of a line, in parts of the distance of the lines.
const GRAIN: f64 = 0.1;

impl Covered {
    /// For points from the origin to `last`, which is to the right and below.
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

    /// Whether a point is within `reach`, at most a square's side.
    fn is_near(&self, p: PhysicalPoint, reach: f64) -> bool {
        let (x, y) = self.square(p);
        let around = |v: usize, n: usize| v.saturating_sub(1)..(v + 2).min(n);
        let near = |q: &PhysicalPoint| (p - *q).square_length() < reach * reach;
        around(y, self.rows)
            .any(|y| around(x, self.columns).any(|x| self.squares[y * self.columns + x].iter().any(near)))
    }
}

impl TensorLine {
    /// Whether it comes back to where it began.
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
                // Half of a grain may lie between the points that are compared.
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
    fn fields_without_axes_have_no_lines() {
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
