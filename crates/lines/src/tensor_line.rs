//! Lines whose tangent is an axis of the tensor.

use crate::{Family, Interpolated};

/// How lines are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOptions {
    /// Length of a step, cells.
    pub step: f64,
    /// Longest line in each direction, cells.
    pub length: f64,
    /// Lines end where the half-axes differ by less than this part of the longer one.
    pub least_anisotropy: f64,
}

impl Default for LineOptions {
    fn default() -> Self {
        Self { step: 0.1, length: 1000.0, least_anisotropy: 1e-3 }
    }
}

/// Why a line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineEnd {
    /// It reaches the centres of the outermost cells, or cells without numbers.
    Border,
    /// The tensor has no axis there, or the axis turns by more than 60 degrees within a step.
    Degenerate,
    /// It is as long as it may be.
    Length,
    /// It comes back to where it began.
    Closed,
    /// It was told to end.
    Stopped,
}

/// A tensor line.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorLine {
    /// Its points, in cells; the seed is among them.
    pub points: Vec<[f64; 2]>,
    /// Index of the seed.
    pub seed: usize,
    /// Why it ends at its first and at its last point.
    pub ends: [LineEnd; 2],
}

impl TensorLine {
    /// Sum of the distances of its points, cells.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|p| distance(p[0], p[1])).sum()
    }
}

/// Cosine of the largest turn within a step, 60 degrees.
const LARGEST_TURN: f64 = 0.5;
/// Longest line, in steps.
const MAX_STEPS: f64 = 1e7;
/// A step that would leave the field is halved as often, so that lines end at the border.
const HALVINGS: usize = 16;

/// The line through `seed`, followed in both directions by the classical Runge-Kutta method of fourth order with a fixed
/// step. A step that is not positive, or a length of more than 10^7 steps, gives a line of one point. A seed outside of the field, or where the tensor has no axis, is a line of one point. Lines end where `keep` says
/// no to their next point.
#[must_use]
pub fn tensor_line(
    field: &Interpolated<'_>,
    seed: [f64; 2],
    family: Family,
    options: &LineOptions,
    keep: &mut dyn FnMut([f64; 2]) -> bool,
) -> TensorLine {
    // Steps that lead nowhere, or so many that they do not end.
    let steps = options.length / options.step;
    if !(options.step > 0.0 && options.step.is_finite() && steps <= MAX_STEPS) {
        return TensorLine { points: vec![seed], seed: 0, ends: [LineEnd::Length; 2] };
    }
    let Some(start) = field.direction(seed, family, options.least_anisotropy) else {
        let end = if field.at(seed).is_some() { LineEnd::Degenerate } else { LineEnd::Border };
        return TensorLine { points: vec![seed], seed: 0, ends: [end; 2] };
    };
    let walk = Walk { field, family, options };
    let (forth, last) = walk.from(seed, start, keep);
    if last == LineEnd::Closed {
        let mut points = vec![seed];
        points.extend(forth);
        return TensorLine { points, seed: 0, ends: [LineEnd::Closed; 2] };
    }
    let (mut points, first) = walk.from(seed, [-start[0], -start[1]], keep);
    points.reverse();
    let seed_at = points.len();
    points.push(seed);
    points.extend(forth);
    TensorLine { points, seed: seed_at, ends: [first, last] }
}

struct Walk<'a> {
    field: &'a Interpolated<'a>,
    family: Family,
    options: &'a LineOptions,
}

impl Walk<'_> {
    /// The points behind `seed` in a direction.
    fn from(
        &self,
        seed: [f64; 2],
        start: [f64; 2],
        keep: &mut dyn FnMut([f64; 2]) -> bool,
    ) -> (Vec<[f64; 2]>, LineEnd) {
        let (mut points, mut at, mut towards, mut gone) = (Vec::new(), seed, start, 0.0);
        // Not a number is no length either.
        while gone + self.options.step <= self.options.length {
            let mut step = self.options.step;
            let mut next = self.step(at, towards, step);
            for _ in 0..HALVINGS {
                if next != Err(LineEnd::Border) {
                    break;
                }
                step *= 0.5;
                next = self.step(at, towards, step);
            }
            let (to, direction) = match next {
                Ok(next) => next,
                Err(end) => return (points, end),
            };
            if !keep(to) {
                return (points, LineEnd::Stopped);
            }
            gone += step;
            points.push(to);
            let comes_back = direction[0] * start[0] + direction[1] * start[1] > LARGEST_TURN;
            if gone > 4.0 * self.options.step && comes_back && distance(to, seed) < 0.75 * self.options.step {
                points.push(seed);
                return (points, LineEnd::Closed);
            }
            (at, towards) = (to, direction);
        }
        (points, LineEnd::Length)
    }

    /// The axis at a point, with the sign that is nearer to `towards`.
    fn slope(&self, at: [f64; 2], towards: [f64; 2]) -> Result<[f64; 2], LineEnd> {
        let Some(d) = self.field.direction(at, self.family, self.options.least_anisotropy) else {
            return Err(if self.field.at(at).is_some() { LineEnd::Degenerate } else { LineEnd::Border });
        };
        let along = d[0] * towards[0] + d[1] * towards[1];
        if along.abs() < LARGEST_TURN {
            return Err(LineEnd::Degenerate);
        }
        Ok(if along < 0.0 { [-d[0], -d[1]] } else { d })
    }

    /// One step: where it leads, and the direction there.
    fn step(&self, at: [f64; 2], towards: [f64; 2], h: f64) -> Result<([f64; 2], [f64; 2]), LineEnd> {
        let ahead = |k: [f64; 2], h: f64| [at[0] + h * k[0], at[1] + h * k[1]];
        let a = self.slope(at, towards)?;
        let b = self.slope(ahead(a, 0.5 * h), a)?;
        let c = self.slope(ahead(b, 0.5 * h), b)?;
        let d = self.slope(ahead(c, h), c)?;
        let mean = [0, 1].map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0);
        let to = ahead(mean, h);
        let direction = self.slope(to, d)?;
        Ok((to, direction))
    }
}

pub(crate) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    tigereye_core::math::hypot(a[0] - b[0], a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Field, Grid, Tensor2};

    const SIDE: usize = 41;

    fn place(p: [f64; 2]) -> (f64, f64) {
        let middle = 0.5 * (SIDE - 1) as f64;
        (p[0] - middle, middle - p[1])
    }

    /// Its components are linear, so nothing is lost between the cells.
    fn wedge() -> Field<Tensor2> {
        Field::from_fn(Grid::new(SIDE, SIDE).expect("a size"), |c| {
            let (x, y) = place([c.x as f64, c.y as f64]);
            Tensor2::symmetric(100.0 + x, y, 100.0 - x)
        })
    }

    fn follow(field: &Field<Tensor2>, seed: [f64; 2], family: Family, options: &LineOptions) -> TensorLine {
        tensor_line(&Interpolated::new(field), seed, family, options, &mut |_| true)
    }

    /// The major lines of a wedge are parabolas around its point: r - x is the same along each.
    #[test]
    fn lines_of_a_wedge_are_parabolas_to_fourth_order() {
        let field = wedge();
        let worst = |step: f64| {
            let options = LineOptions { step, length: 15.0, ..LineOptions::default() };
            let line = follow(&field, [24.0, 14.0], Family::Major, &options);
            let constant = |p: &[f64; 2]| {
                let (x, y) = place(*p);
                tigereye_core::math::hypot(x, y) - x
            };
            let first = constant(&[24.0, 14.0]);
            line.points.iter().map(|p| (constant(p) - first).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (worst(0.8), worst(0.4));
        assert!(coarse < 1e-4 && coarse / fine > 12.0 && coarse / fine < 20.0, "{coarse} {fine}");
    }

    #[test]
    fn both_families_cross_at_right_angles() {
        let field = wedge();
        let options = LineOptions::default();
        for seed in [[10.0, 12.0], [30.5, 8.25]] {
            let [a, b] = [Family::Major, Family::Minor].map(|family| {
                let line = follow(&field, seed, family, &options);
                let (p, q) = (line.points[line.seed], line.points[line.seed + 1]);
                [q[0] - p[0], q[1] - p[1]]
            });
            assert!((a[0] * b[0] + a[1] * b[1]).abs() < 2e-2 * options.step * options.step, "{seed:?}");
        }
    }

    #[test]
    fn circles_close() {
        let field = Field::from_fn(Grid::new(SIDE, SIDE).expect("a size"), |c| {
            let (x, y) = place([c.x as f64, c.y as f64]);
            // Components are quadratic: what bends the circle is the interpolation.
            Tensor2::symmetric(500.0 - x * x, -x * y, 500.0 - y * y)
        });
        let line = follow(&field, [32.0, 20.0], Family::Major, &LineOptions::default());
        assert_eq!(line.ends, [LineEnd::Closed; 2]);
        let radius = |p: &[f64; 2]| distance(*p, [20.0, 20.0]);
        assert!(line.points.iter().all(|p| (radius(p) - 12.0).abs() < 2e-2));
        assert!((line.length() - 2.0 * core::f64::consts::PI * 12.0).abs() < 0.1, "{}", line.length());
    }

    #[test]
    fn lines_end_where_they_must() {
        let straight =
            Field::from_fn(Grid::new(9, 7).expect("a size"), |_| Tensor2::from_axes(0.0, 2.0, 1.0));
        let line = follow(&straight, [4.0, 3.0], Family::Major, &LineOptions::default());
        assert_eq!(line.ends, [LineEnd::Border; 2]);
        let (a, b) = (line.points[0], line.points[line.points.len() - 1]);
        assert!((a[0] - b[0]).abs() > 8.0 - 1e-4 && (a[1] - 3.0).abs() < 1e-12, "{a:?} {b:?}");
        let short = LineOptions { length: 1.0, ..LineOptions::default() };
        let line = follow(&straight, [4.0, 3.0], Family::Minor, &short);
        assert_eq!(line.ends, [LineEnd::Length; 2]);
        assert!((line.length() - 2.0).abs() < 0.21);
        for (t, end) in [(Tensor2::IDENTITY, LineEnd::Degenerate), (Tensor2::ZERO, LineEnd::Degenerate)] {
            let field = Field::from_fn(Grid::new(4, 4).expect("a size"), |_| t);
            let line = follow(&field, [1.5, 1.5], Family::Major, &LineOptions::default());
            assert_eq!((line.points.len(), line.ends), (1, [end; 2]));
        }
        let line = follow(&straight, [20.0, 3.0], Family::Major, &LineOptions::default());
        assert_eq!((line.points.len(), line.ends), (1, [LineEnd::Border; 2]));
        let thin = Field::from_fn(Grid::new(1, 5).expect("a size"), |_| Tensor2::from_axes(0.0, 2.0, 1.0));
        assert_eq!(follow(&thin, [0.0, 2.0], Family::Major, &LineOptions::default()).points.len(), 1);
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
            assert_eq!(follow(&field, [10.0, 10.0], Family::Major, &options).points.len(), 1);
        }
    }
}
