//! Tensor lines: lines whose tangent is an axis of the tensor.

use crate::line_options::{LineEnd, LineOptions};
use crate::walk::Walk;
use crate::{Family, Interpolated};
use tigereye_core::{CellShape, Point, Vector, length};

/// A tensor line.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorLine {
    /// Its points; the seed is among them.
    pub points: Vec<Point>,
    /// Index of the seed.
    pub seed: usize,
    /// Why it ends at its first and at its last point.
    pub ends: [LineEnd; 2],
    /// The distance at which a closed line passes its seed, in the unit of [`CellShape`]; 0 for other lines. The last
    /// point of a closed line is its seed again.
    pub gap: f64,
}

impl TensorLine {
    /// Sum of the distances between its points, for cells of a shape.
    #[must_use]
    pub fn length(&self, cell: CellShape) -> f64 {
        cell.length(&self.points)
    }

    fn alone(seed: Point, end: LineEnd) -> Self {
        Self { points: vec![seed], seed: 0, ends: [end; 2], gap: 0.0 }
    }
}

/// A line is closed if it passes its seed at this distance or closer, in its initial direction; in the unit of
/// [`CellShape`].
const CLOSING: f64 = 0.05;

/// The line through `seed`, followed in both directions until `keep` rejects its next point. The line is the seed alone
/// if steps are not positive or more than [`LineOptions::MAX_STEPS`], and for a seed outside the field or at a
/// degenerate tensor.
#[must_use]
pub fn tensor_line(
    field: &Interpolated<'_>,
    seed: Point,
    family: Family,
    options: &LineOptions,
    keep: &mut dyn FnMut(Point) -> bool,
) -> TensorLine {
    if !options.are_possible() {
        return TensorLine::alone(seed, LineEnd::Length);
    }
    let Some(start) = field.direction(seed, family, options.least_anisotropy) else {
        let end = if field.at(seed).is_some() { LineEnd::Degenerate } else { LineEnd::Border };
        return TensorLine::alone(seed, end);
    };
    let walk = Walk { field, family, options };
    let mut forth = follow(&walk, seed, start, keep);
    if forth.end == LineEnd::Closed {
        forth.points.insert(0, seed);
        return TensorLine { points: forth.points, seed: 0, ends: [LineEnd::Closed; 2], gap: forth.gap };
    }
    let back = follow(&walk, seed, -start, keep);
    let mut points = back.points;
    points.reverse();
    let seed_at = points.len();
    points.push(seed);
    points.extend(forth.points);
    TensorLine { points, seed: seed_at, ends: [back.end, forth.end], gap: 0.0 }
}

/// The line from `start` in one direction: along the axis there, with the sign closer to `towards` (of any length but
/// 0). Its first point is `start`; the second of its ends tells why it ends.
#[must_use]
pub fn half_line(
    field: &Interpolated<'_>,
    start: Point,
    towards: Vector,
    family: Family,
    options: &LineOptions,
) -> TensorLine {
    let size = length(towards);
    if !(options.are_possible() && size > 0.0) {
        return TensorLine::alone(start, LineEnd::Length);
    }
    let walk = Walk { field, family, options };
    let towards = towards / size;
    if let Err(end) = walk.begin(start, towards) {
        return TensorLine::alone(start, end);
    }
    let mut line = follow(&walk, start, towards, &mut |_| true);
    line.points.insert(0, start);
    TensorLine { points: line.points, seed: 0, ends: [LineEnd::Stopped, line.end], gap: line.gap }
}

/// Where [`half_line`] ends, and why. Its points are not kept, so a line that returns to its start is not closed but
/// continues.
#[must_use]
pub fn half_line_end(
    field: &Interpolated<'_>,
    start: Point,
    direction: Vector,
    family: Family,
    options: &LineOptions,
) -> (Point, LineEnd) {
    let walk = Walk { field, family, options };
    if !options.are_possible() {
        return (start, LineEnd::Length);
    }
    walk.end_of(start, direction)
}

/// The part of a line on one side of its seed.
struct Branch {
    points: Vec<Point>,
    end: LineEnd,
    gap: f64,
}

/// Follows the line from `seed` in a direction.
fn follow(walk: &Walk<'_>, seed: Point, towards: Vector, keep: &mut dyn FnMut(Point) -> bool) -> Branch {
    let mut points = Vec::new();
    let end = |points, end| Branch { points, end, gap: 0.0 };
    let mut line = match walk.begin(seed, towards) {
        Ok(line) => line,
        Err(why) => return end(points, why),
    };
    let start = line.pose().towards;
    loop {
        let before = line.pose().at;
        if let Err(why) = walk.advance(&mut line) {
            return end(points, why);
        }
        let at = line.pose().at;
        if let Some(gap) = passes(walk.field.cell(), [seed, before, at], start).filter(|_| !points.is_empty())
        {
            points.push(seed);
            return Branch { points, end: LineEnd::Closed, gap };
        }
        if !keep(at) {
            return end(points, LineEnd::Stopped);
        }
        points.push(at);
    }
}

/// The distance at which the segment from the second to the third point passes the seed, the first one, in the initial
/// direction of the line; `None` if it does not pass it, or further away than [`CLOSING`].
fn passes(cell: CellShape, points: [Point; 3], start: Vector) -> Option<f64> {
    let [seed, a, b] = points.map(|p| cell.physical(p));
    let (before, after) = ((a - seed).dot(start), (b - seed).dot(start));
    if !(before < 0.0 && after >= 0.0) {
        return None;
    }
    let t = before / (before - after);
    let gap = length(a + (b - a) * t - seed);
    (gap <= CLOSING).then_some(gap)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Inertia, Method};
    use tigereye_core::{Field, Grid, Tensor2};

    const SIDE: usize = 41;
    const SEED: Point = Point::new(24.0, 14.0);

    /// Coordinates with their origin in the middle, y upwards.
    fn centred(p: Point) -> (f64, f64) {
        let middle = 0.5 * (SIDE - 1) as f64;
        (p.x - middle, middle - p.y)
    }

    /// Components are linear, so interpolation is exact.
    fn wedge() -> Field<Tensor2> {
        Field::from_fn(Grid::new(SIDE, SIDE).expect("a size"), |c| {
            let (x, y) = centred(Point::new(c.x as f64, c.y as f64));
            Tensor2::symmetric(100.0 + x, y, 100.0 - x)
        })
    }

    fn follow(field: &Field<Tensor2>, seed: Point, family: Family, options: &LineOptions) -> TensorLine {
        tensor_line(&Interpolated::new(field), seed, family, options, &mut |_| true)
    }

    /// The major lines of a wedge are parabolas around its point: r - x is the same along each.
    #[test]
    fn lines_of_a_wedge_are_parabolas_to_fourth_order() {
        let field = wedge();
        let worst = |step: f64| {
            let options = LineOptions { step, length: 15.0, ..LineOptions::default() };
            let line = follow(&field, SEED, Family::Major, &options);
            let constant = |p: &Point| {
                let (x, y) = centred(*p);
                tigereye_core::math::hypot(x, y) - x
            };
            let first = constant(&SEED);
            line.points.iter().map(|p| (constant(p) - first).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (worst(0.8), worst(0.4));
        assert!(coarse < 1e-4 && coarse / fine > 12.0 && coarse / fine < 20.0, "{coarse} {fine}");
    }

    /// The error of a line scales with the tolerance, at far fewer steps.
    #[test]
    fn adaptive_steps_meet_their_tolerance() {
        let field = wedge();
        let constant = |p: &Point| {
            let (x, y) = centred(*p);
            tigereye_core::math::hypot(x, y) - x
        };
        let worst = |tolerance: f64| {
            let method = Method::DormandPrince { tolerance };
            let options = LineOptions { method, step: 5.0, length: 15.0, ..LineOptions::default() };
            let line = follow(&field, SEED, Family::Major, &options);
            let first = constant(&SEED);
            let off = line.points.iter().map(|p| (constant(p) - first).abs()).fold(0.0, f64::max);
            (off, line.points.len())
        };
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let (off, points) = worst(tolerance);
            // A line has some ten to hundred steps, each with an error of the tolerance at most.
            assert!(off < points as f64 * tolerance, "{tolerance}: {off} in {points}");
        }
        let fixed = LineOptions { step: 0.1, length: 15.0, ..LineOptions::default() };
        assert!(8 * worst(1e-6).1 < follow(&field, SEED, Family::Major, &fixed).points.len());
    }

    /// A line with inertia crosses an isotropic region between two regions with the same axis.
    #[test]
    fn inertia_crosses_isotropic_tensors() {
        let field = Field::from_fn(Grid::new(31, 9).expect("a size"), |c| match c.x {
            0..12 | 19..31 => Tensor2::from_axes(0.0, 3.0, 1.0),
            _ => Tensor2::IDENTITY,
        });
        let plain = LineOptions::default();
        let stops = follow(&field, Point::new(4.0, 4.0), Family::Major, &plain);
        assert_eq!(stops.ends[1], LineEnd::Degenerate);
        for puncture in [0.0, 0.5, 1.0] {
            let options = LineOptions { inertia: Some(Inertia { puncture }), ..plain };
            let line = follow(&field, Point::new(4.0, 4.0), Family::Major, &options);
            assert_eq!(line.ends, [LineEnd::Border; 2], "{puncture}");
            let last = line.points[line.points.len() - 1];
            assert!(last.x > 29.9 && (last.y - 4.0).abs() < 1e-9, "{last:?}");
        }
        // Zero tensors end a line even with inertia.
        let dark = field.map(|t| if *t == Tensor2::IDENTITY { Tensor2::ZERO } else { *t });
        let options = LineOptions { inertia: Some(Inertia { puncture: 0.5 }), ..plain };
        assert_eq!(follow(&dark, Point::new(4.0, 4.0), Family::Major, &options).ends[1], LineEnd::Degenerate);
    }

    /// Inertia has no effect on totally anisotropic tensors.
    #[test]
    fn inertia_leaves_totally_anisotropic_tensors_alone() {
        let field = Field::from_fn(Grid::new(41, 41).expect("a size"), |c| {
            Tensor2::from_eigen(0.02 * (c.x + c.y) as f64, 1.0, 0.0)
        });
        let seed = SEED;
        let plain = follow(&field, seed, Family::Major, &LineOptions::default());
        let options = LineOptions { inertia: Some(Inertia { puncture: 0.2 }), ..LineOptions::default() };
        let line = follow(&field, seed, Family::Major, &options);
        // Tensors that differ by 0.02 rad mix to one with semi-axes 1 : 0.0001.
        let off = plain.points.iter().zip(&line.points).map(|(a, b)| length(*a - *b)).fold(0.0, f64::max);
        assert!(plain.points.len() > 100 && off < 1e-4 * 40.0, "{off}");
    }

    #[test]
    fn half_lines_run_in_one_direction() {
        let field = wedge();
        let options = LineOptions { length: 3.0, ..LineOptions::default() };
        let whole = follow(&field, SEED, Family::Major, &options);
        let seed = whole.points[whole.seed];
        for (side, next) in [(1, whole.points[whole.seed + 1]), (0, whole.points[whole.seed - 1])] {
            let towards = Vector::new(next.x - seed.x, seed.y - next.y);
            let half = half_line(&Interpolated::new(&field), seed, towards, Family::Major, &options);
            assert_eq!(half.ends, [LineEnd::Stopped, whole.ends[side]]);
            let end = if side == 1 { whole.points[whole.points.len() - 1] } else { whole.points[0] };
            assert!(length(half.points[half.points.len() - 1] - end) < 1e-12);
        }
        let nowhere = half_line(
            &Interpolated::new(&field),
            Point::new(-3.0, 0.0),
            Vector::new(1.0, 0.0),
            Family::Major,
            &options,
        );
        assert_eq!((nowhere.points.len(), nowhere.ends), (1, [LineEnd::Border; 2]));
        let aimless = half_line(&Interpolated::new(&field), seed, Vector::zero(), Family::Major, &options);
        assert_eq!(aimless.points.len(), 1);
    }

    #[test]
    fn both_families_cross_at_right_angles() {
        let field = wedge();
        let options = LineOptions::default();
        for seed in [Point::new(10.0, 12.0), Point::new(30.5, 8.25)] {
            let [a, b] = [Family::Major, Family::Minor].map(|family| {
                let line = follow(&field, seed, family, &options);
                line.points[line.seed + 1] - line.points[line.seed]
            });
            assert!(a.dot(b).abs() < 2e-2 * options.step * options.step, "{seed:?}");
        }
    }

    #[test]
    fn circles_close() {
        let field = Field::from_fn(Grid::new(SIDE, SIDE).expect("a size"), |c| {
            let (x, y) = centred(Point::new(c.x as f64, c.y as f64));
            // Components are quadratic, so the circle is bent by the interpolation.
            Tensor2::symmetric(500.0 - x * x, -x * y, 500.0 - y * y)
        });
        let line = follow(&field, Point::new(32.0, 20.0), Family::Major, &LineOptions::default());
        assert_eq!(line.ends, [LineEnd::Closed; 2]);
        let radius = |p: &Point| length(*p - Point::new(20.0, 20.0));
        assert!(line.points.iter().all(|p| (radius(p) - 12.0).abs() < 2e-2));
        assert!(
            (line.length(CellShape::SQUARE) - 2.0 * core::f64::consts::PI * 12.0).abs() < 0.1,
            "{}",
            line.length(CellShape::SQUARE)
        );
    }

    #[test]
    fn lines_end_where_they_must() {
        let straight =
            Field::from_fn(Grid::new(9, 7).expect("a size"), |_| Tensor2::from_axes(0.0, 2.0, 1.0));
        let line = follow(&straight, Point::new(4.0, 3.0), Family::Major, &LineOptions::default());
        assert_eq!(line.ends, [LineEnd::Border; 2]);
        let (a, b) = (line.points[0], line.points[line.points.len() - 1]);
        assert!((a.x - b.x).abs() > 8.0 - 1e-4 && (a.y - 3.0).abs() < 1e-12, "{a:?} {b:?}");
        let short = LineOptions { length: 1.0, ..LineOptions::default() };
        let line = follow(&straight, Point::new(4.0, 3.0), Family::Minor, &short);
        assert_eq!(line.ends, [LineEnd::Length; 2]);
        assert!((line.length(CellShape::SQUARE) - 2.0).abs() < 0.21);
        for (t, end) in [(Tensor2::IDENTITY, LineEnd::Degenerate), (Tensor2::ZERO, LineEnd::Degenerate)] {
            let field = Field::from_fn(Grid::new(4, 4).expect("a size"), |_| t);
            let line = follow(&field, Point::new(1.5, 1.5), Family::Major, &LineOptions::default());
            assert_eq!((line.points.len(), line.ends), (1, [end; 2]));
        }
        let line = follow(&straight, Point::new(20.0, 3.0), Family::Major, &LineOptions::default());
        assert_eq!((line.points.len(), line.ends), (1, [LineEnd::Border; 2]));
        let thin = Field::from_fn(Grid::new(1, 5).expect("a size"), |_| Tensor2::from_axes(0.0, 2.0, 1.0));
        assert_eq!(
            follow(&thin, Point::new(0.0, 2.0), Family::Major, &LineOptions::default()).points.len(),
            1
        );
    }

    /// Rounding moves steps along the border outside, which must not end the line.
    #[test]
    fn lines_run_along_the_border() {
        let grid = Grid::new(60, 50).expect("a size");
        for (phi, seed, family) in [
            (0.0, (30.3, 0.0), Family::Major),
            (0.0, (0.0, 20.7), Family::Minor),
            (core::f64::consts::PI, (30.3, 49.0), Family::Major),
            (core::f64::consts::FRAC_PI_2, (59.0, 20.7), Family::Major),
            (core::f64::consts::FRAC_PI_2, (30.3, 0.0), Family::Minor),
        ] {
            let field = Field::from_fn(grid, |_| Tensor2::from_axes(phi, 2.0, 1.0));
            let line = follow(&field, Point::from(seed), family, &LineOptions::default());
            let last = Interpolated::new(&field).last();
            let whole = if seed.0 == 0.0 || seed.0 == last.x { last.y } else { last.x };
            assert_eq!(line.ends, [LineEnd::Border; 2], "{phi} {seed:?}");
            assert!(
                (line.length(CellShape::SQUARE) - whole).abs() < 1e-4,
                "{phi} {seed:?}: {}",
                line.length(CellShape::SQUARE)
            );
        }
    }

    #[test]
    fn impossible_steps_end_at_once() {
        let field = wedge();
        let impossible = [
            (f64::NAN, 10.0),
            (0.1, f64::NAN),
            (f64::INFINITY, 10.0),
            (0.0, 10.0),
            (-0.1, 10.0),
            (0.1, f64::INFINITY),
            (1e-300, 1.0),
        ];
        for (step, length) in impossible {
            let options = LineOptions { step, length, ..LineOptions::default() };
            assert_eq!(follow(&field, Point::new(10.0, 10.0), Family::Major, &options).points.len(), 1);
        }
    }
}
