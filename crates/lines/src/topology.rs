//! The topological skeleton of a tensor field: degenerate points and the separatrices that bound their sectors.

use crate::degenerate::points_of_stretching;
use crate::{
    Axes, DegeneratePoint, Family, Interpolated, LineOptions, Major, TensorLine, degenerate_points, half_line,
};
use core::f64::consts::{PI, TAU};
use tigereye_core::{Point, Vector, math};

/// A line that leaves a degenerate point between two sectors, at least one of which is hyperbolic.
#[derive(Clone, Debug, PartialEq)]
pub struct Separatrix {
    /// Index of its point in [`Topology::points`].
    pub point: usize,
    /// The axis it follows.
    pub family: Family,
    /// Starts at the degenerate point; the second of its ends tells where it leads.
    pub line: TensorLine,
}

/// Degenerate points and separatrices of a field.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Topology {
    /// The points, as [`degenerate_points`] finds them.
    pub points: Vec<DegeneratePoint>,
    /// Their separatrices, point by point, counter-clockwise.
    pub separatrices: Vec<Separatrix>,
}

impl Topology {
    /// Points and separatrices of the axes of a field. Closed lines that separate regions are not searched for.
    #[must_use]
    pub fn of(field: &Interpolated<'_>, families: &[Family], options: &LineOptions) -> Self {
        let points = match (field.axes().axes(), field.axes().major()) {
            (Axes::HalfAxes, Major::Magnitude) => degenerate_points(field.field()),
            // Eigenvectors and their bisectors are undefined where the stretching vanishes. By value, semi-axes swap
            // along the lines of zero trace, on which the zeros of E lie.
            (Axes::HalfAxes, Major::Value) | (Axes::Eigenvectors | Axes::DualEigenvectors, _) => {
                points_of_stretching(field.field())
            }
        };
        let mut separatrices = Vec::new();
        for (point, degenerate) in points.iter().enumerate() {
            for &family in families {
                separatrices.extend(separatrices_of(field, point, degenerate, family, options));
            }
        }
        Self { points, separatrices }
    }
}

/// Radii of the circles on which the pattern around a degenerate point is sampled, in units of the smaller side of a
/// cell. A point within one quad has its pattern at any of them; a merged point needs a larger one.
const RADII: [f64; 6] = [0.02, 0.1, 0.3, 0.7, 1.2, 2.0];
/// Number of directions sampled.
const AROUND: usize = 360;
/// Least relative difference of the semi-axes at which a direction is taken as known.
const LEAST: f64 = 1e-9;

fn separatrices_of(
    field: &Interpolated<'_>,
    point: usize,
    degenerate: &DegeneratePoint,
    family: Family,
    options: &LineOptions,
) -> Vec<Separatrix> {
    let centre = degenerate.position;
    // The smallest circle on which the axes rotate by the index of the point has its pattern.
    let seen = RADII.into_iter().find_map(|radius| {
        let ring = Ring::around(field, centre, radius, family)?;
        (ring.half_turns() == degenerate.half_turns()).then_some((radius, ring))
    });
    let Some((radius, ring)) = seen else { return Vec::new() };
    // The axes differ little near the point, which must not end a line that is just leaving it.
    let options = &LineOptions { least_anisotropy: LEAST, ..*options };
    let leave = |angle: f64| {
        let direction = Vector::new(math::cos(angle), math::sin(angle));
        let start = field.cell().ahead(centre, direction, radius);
        let mut line = half_line(field, start, direction, family, options);
        line.points.insert(0, centre);
        line.seed = 0;
        Separatrix { point, family, line }
    };
    ring.separating().into_iter().map(leave).collect()
}

/// The axis on a circle around a point: its angle relative to the radius, continued without jumps.
struct Ring {
    /// At `AROUND + 1` angles over a full turn, the last one the same as the first, radians.
    ahead: Vec<f64>,
}

impl Ring {
    fn around(field: &Interpolated<'_>, centre: Point, radius: f64, family: Family) -> Option<Self> {
        let mut ahead: Vec<f64> = Vec::with_capacity(AROUND + 1);
        for i in 0..=AROUND {
            // Offset from multiples of 45 degrees, at which roots are common.
            let angle = TAU * (i as f64 + 0.37) / AROUND as f64;
            let radial = Vector::new(math::cos(angle), math::sin(angle));
            let axis = field.direction(field.cell().ahead(centre, radial, radius), family, LEAST)?;
            let off = math::atan2(axis.y, axis.x) - angle;
            // The axis has no sign: take the angle closest to the previous one.
            let last = ahead.last().copied().unwrap_or(off);
            ahead.push(off + PI * ((last - off) / PI).round());
        }
        Some(Self { ahead })
    }

    /// Half turns of the axis along the circle.
    fn half_turns(&self) -> i32 {
        ((self.ahead[AROUND] - self.ahead[0] + TAU) / PI).round() as i32
    }

    /// Angles at which the axis is radial and bounds a hyperbolic sector.
    fn separating(&self) -> Vec<f64> {
        // (angle, multiple of pi) of the roots. From root to root, the axis loses pi against the radius in a hyperbolic
        // sector, keeps level in a parabolic one, and gains pi in an elliptic one.
        let mut roots: Vec<(f64, i64)> = Vec::new();
        for i in 0..AROUND {
            let (a, b) = (self.ahead[i] / PI, self.ahead[i + 1] / PI);
            let level = if b < a { a.floor() } else { a.ceil() };
            if (a < level) != (b < level) && (a - b).abs() < 0.5 {
                let t = (level - a) / (b - a);
                roots.push((TAU * (i as f64 + 0.37 + t) / AROUND as f64, level as i64));
            }
        }
        // A root bounds a hyperbolic sector if the level falls on either side of it, around the circle.
        let turns = ((self.ahead[AROUND] - self.ahead[0]) / PI).round() as i64;
        let n = roots.len();
        let is_hyperbolic = |i: usize| {
            let (here, next) = (roots[i].1, roots[(i + 1) % n].1 + if i + 1 == n { turns } else { 0 });
            next < here
        };
        (0..n).filter(|&i| is_hyperbolic(i) || is_hyperbolic((i + n - 1) % n)).map(|i| roots[i].0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LineEnd;
    use tigereye_core::{Field, Grid, Tensor2};
    use tigereye_test_support::field;

    fn topology(field: &Field<Tensor2>, axes: Axes) -> Topology {
        let between = Interpolated::new(field).with_axes(axes);
        Topology::of(&between, &[Family::Major], &LineOptions::default())
    }

    fn angles(topology: &Topology) -> Vec<f64> {
        let angle = |s: &Separatrix| {
            let (a, b) = (s.line.points[0], s.line.points[1]);
            // Rounding below 0 gives 0, not 360.
            (math::degrees(math::atan2(a.y - b.y, b.x - a.x)) + 1.0).rem_euclid(360.0) - 1.0
        };
        let mut angles: Vec<f64> = topology.separatrices.iter().map(angle).collect();
        angles.sort_by(f64::total_cmp);
        angles
    }

    fn linear(f: impl Fn(f64, f64) -> [f64; 2]) -> Field<Tensor2> {
        Field::from_fn(Grid::new(21, 21).expect("a size"), |c| {
            let [a, b] = f(c.x as f64 - 10.3, 10.2 - c.y as f64);
            Tensor2::symmetric(50.0 + a, b, 50.0 - a)
        })
    }

    fn close(found: &[f64], expected: &[f64]) -> bool {
        found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.01)
    }

    /// Around [[x, -y], [-y, -x]] the major axis lies at minus half the polar angle: radial at 0, 120 and 240 degrees.
    #[test]
    fn trisectors_have_three_separatrices() {
        for axes in [Axes::HalfAxes, Axes::Eigenvectors] {
            let found = topology(&linear(|x, y| [x, -y]), axes);
            assert!(close(&angles(&found), &[0.0, 120.0, 240.0]), "{:?}", angles(&found));
            assert!(found.separatrices.iter().all(|s| s.line.ends[1] == LineEnd::Border));
        }
    }

    /// Around [[x, b y], [b y, -x]] a direction t is radial where cos t sin 2t = b sin t cos 2t (the cubic of
    /// Delmarcelle and Hesselink, 1994): t = 0, and cos^2 t = b / (2 b - 2) from b = 2 on. Where there are three, the
    /// middle one lies within the parabolic sector and separates nothing.
    #[test]
    fn wedges_have_one_or_two_separatrices() {
        let plain = topology(&linear(|x, y| [x, y]), Axes::HalfAxes);
        assert!(close(&angles(&plain), &[0.0]), "{:?}", angles(&plain));
        for b in [0.2, 0.8, 1.9] {
            let found = topology(&linear(|x, y| [x, b * y]), Axes::HalfAxes);
            assert!(close(&angles(&found), &[0.0]), "{b}: {:?}", angles(&found));
        }
        for b in [2.5_f64, 5.0] {
            let t = math::degrees(math::acos((b / (2.0 * b - 2.0)).sqrt()));
            let found = topology(&linear(|x, y| [x, b * y]), Axes::HalfAxes);
            assert!(close(&angles(&found), &[t, 360.0 - t]), "{b}: {:?} {t}", angles(&found));
        }
    }

    #[test]
    fn separatrices_rotate_with_the_field() {
        let field = linear(|x, y| [x + 0.3 * y, -y + 0.2 * x]);
        let (straight, turned) =
            (topology(&field, Axes::HalfAxes), topology(&field.quarter_turned(), Axes::HalfAxes));
        let mut expected: Vec<f64> = angles(&straight).iter().map(|a| (a + 90.0) % 360.0).collect();
        expected.sort_by(f64::total_cmp);
        assert_eq!(expected.len(), 3);
        assert!(close(&angles(&turned), &expected), "{expected:?} {:?}", angles(&turned));
    }

    /// A saddle with four hyperbolic sectors: two merged trisectors.
    #[test]
    fn merged_points_have_the_separatrices_of_their_sectors() {
        let of = |spec| topology(&crate::ellipse_tensors(&field(spec)), Axes::HalfAxes);
        let found = of("inverse:size=21");
        assert_eq!(found.points.len(), 1);
        assert_eq!(found.separatrices.len(), 4, "{:?}", angles(&found));
        let found = of("star:size=21");
        assert_eq!((found.points.len(), found.separatrices.len()), (1, 0), "rays bound no sector");
    }

    /// Eigenvectors of symmetric tensors are also defined where the trace is zero.
    #[test]
    fn eigenvectors_are_not_degenerate_at_zero_trace() {
        let field = Field::from_fn(Grid::new(15, 15).expect("a size"), |c| {
            let (x, y) = (c.x as f64 - 7.2, 7.2 - c.y as f64);
            Tensor2::symmetric(x + 2.0, y, -x + 2.0 - 0.5 * y)
        });
        let points = topology(&field, Axes::Eigenvectors).points;
        assert!(!points.is_empty() && points.iter().all(|p| p.half_turns().abs() == 1));
    }

    #[test]
    fn degenerate_fields_have_no_skeleton() {
        for t in [Tensor2::ZERO, Tensor2::IDENTITY, Tensor2::isotropic(f64::NAN)] {
            for (width, height) in [(1, 1), (1, 5), (6, 6)] {
                let field = Field::from_fn(Grid::new(width, height).expect("a size"), |_| t);
                for axes in [Axes::HalfAxes, Axes::Eigenvectors, Axes::DualEigenvectors] {
                    assert_eq!(topology(&field, axes), Topology::default());
                }
            }
        }
    }
}
