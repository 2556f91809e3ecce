//! The finite-time Lyapunov exponent of a flow map: the rate at which neighbouring points separate.

use euclid::{Point2D, Vector2D};
use tigereye_core::{Cell, Conformal, Field, Grid, Tensor2, math, runge_kutta_step};

/// The exponent `ln(sqrt(lambda)) / duration` of every sample, where lambda is the larger eigenvalue of the
/// Cauchy-Green tensor `F^T F` and F the gradient of the flow map (Shadden, Lekien and Marsden, 2005). `ends` is the
/// flow map: the end point of each sample in units of `spacing`, the distances of samples along x and y, or `None` if
/// it is unknown. Differences are central, and one-sided at the border and beside samples without an end. The exponent
/// is NaN if a sample has no end, or no neighbour with one along an axis. Whether rows run up or down does not matter.
#[must_use]
pub fn exponents<Frame>(
    ends: &Field<Option<Point2D<f64, Frame>>>,
    spacing: [f64; 2],
    duration: f64,
) -> Field<f64> {
    Field::from_fn(ends.grid(), |cell| {
        let gradient = gradient_at(cell, ends.grid(), spacing, &|c| *ends.at(c));
        gradient.map_or(f64::NAN, |f| exponent_of(&f, duration))
    })
}

/// The gradient of a map at a sample, `[[dX/dx, dX/dy], [dY/dx, dY/dy]]`.
pub(crate) fn gradient_at<Frame>(
    cell: Cell,
    grid: Grid,
    spacing: [f64; 2],
    end: &dyn Fn(Cell) -> Option<Point2D<f64, Frame>>,
) -> Option<Tensor2> {
    let here = end(cell)?;
    let beside = |dx: isize, dy: isize| {
        let x = cell.x.checked_add_signed(dx)?;
        let y = cell.y.checked_add_signed(dy)?;
        let c = Cell::new(x, y);
        if grid.contains(c) { end(c) } else { None }
    };
    // Central differences; with one neighbour only, the sample itself stands in for the other.
    let along = |dx: isize, dy: isize, h: f64| {
        let (before, after) = (beside(-dx, -dy), beside(dx, dy));
        let steps = f64::from(u8::from(before.is_some()) + u8::from(after.is_some()));
        if steps == 0.0 {
            return None;
        }
        let (a, b) = (before.unwrap_or(here), after.unwrap_or(here));
        Some((b - a) / (steps * h))
    };
    let (x, y) = (along(1, 0, spacing[0])?, along(0, 1, spacing[1])?);
    Some(Tensor2::new(x.x, y.x, x.y, y.y))
}

/// The exponent of a gradient.
pub(crate) fn exponent_of(gradient: &Tensor2, duration: f64) -> f64 {
    // The larger singular value is (|F| + |E|) / 2, as in `axes`.
    let Conformal { e, f } = Conformal::of(gradient);
    math::ln(0.5 * (math::hypot(f.re, f.im) + math::hypot(e.re, e.im))) / duration
}

/// Position of a particle that moves with a velocity from time `from` to `to`, by the classical Runge-Kutta method in
/// `steps` steps of equal length.
#[must_use]
pub fn advected<Frame>(
    velocity: &dyn Fn(f64, Point2D<f64, Frame>) -> Vector2D<f64, Frame>,
    start: Point2D<f64, Frame>,
    [from, to]: [f64; 2],
    steps: usize,
) -> Point2D<f64, Frame> {
    let h = (to - from) / steps as f64;
    let rate = |t: f64, p: [f64; 2]| velocity(t, p.into()).to_array();
    let step = |p, i| runge_kutta_step(rate, from + i as f64 * h, p, h);
    (0..steps).fold(start.to_array(), step).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{PhysicalPoint, Vector};

    fn field(
        size: [usize; 2],
        end: impl Fn(PhysicalPoint) -> Option<PhysicalPoint>,
    ) -> Field<Option<PhysicalPoint>> {
        let grid = Grid::new(size[0], size[1]).expect("a size");
        Field::from_fn(grid, |c| end(PhysicalPoint::new(0.1 * c.x as f64, 0.2 * c.y as f64)))
    }

    /// A saddle separates neighbours by exp(t) along x, wherever they are.
    #[test]
    fn saddle_has_exponent_one() {
        let velocity = |_: f64, p: PhysicalPoint| Vector::new(p.x, -p.y);
        let ends = field([6, 5], |p| Some(advected(&velocity, p, [0.0, 2.0], 200)));
        let found = exponents(&ends, [0.1, 0.2], 2.0);
        assert!(found.values().iter().all(|v| (v - 1.0).abs() < 1e-8), "{:?}", found.values());
    }

    /// The gradient of a shear is [[1, t], [0, 1]].
    #[test]
    fn shear_has_the_exponent_of_its_gradient() {
        let t = 3.0;
        let ends = field([5, 5], |p| Some(p + Vector::new(t * p.y, 0.0)));
        let largest = (1.0 + 0.5 * t * t + t * (1.0_f64 + 0.25 * t * t).sqrt()).sqrt();
        let found = exponents(&ends, [0.1, 0.2], t);
        assert!(found.values().iter().all(|v| (v - math::ln(largest) / t).abs() < 1e-12));
    }

    #[test]
    fn a_rigid_rotation_has_exponent_zero() {
        let velocity = |_: f64, p: PhysicalPoint| Vector::new(-p.y, p.x);
        let ends = field([5, 4], |p| Some(advected(&velocity, p, [1.0, 4.0], 100)));
        assert!(exponents(&ends, [0.1, 0.2], 3.0).values().iter().all(|v| v.abs() < 1e-7));
    }

    #[test]
    fn missing_samples_have_no_exponent_and_do_not_affect_others() {
        let ends = field([5, 5], |p| (p != PhysicalPoint::new(0.2, 0.4)).then_some(p));
        let found = exponents(&ends, [0.1, 0.2], 1.0);
        let missing = found.iter().filter(|(_, v)| v.is_nan()).map(|(c, _)| c).collect::<Vec<_>>();
        assert_eq!(missing, [Cell::new(2, 2)]);
        assert!(found.values().iter().all(|v| v.is_nan() || v.abs() < 1e-12));
        assert!(exponents(&field([1, 5], Some), [0.1, 0.2], 1.0).values().iter().all(|v| v.is_nan()));
    }
}
