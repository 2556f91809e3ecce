//! Hyperstreamlines: lines along one axis whose width is the other.

use crate::{Family, Interpolated, TensorLine};
use tigereye_core::Point;

/// Half of a hyperstreamline's width at every point of its line, in units of the smaller side of a cell
/// ([`tigereye_core::CellShape`]): `scale` times the length of the other semi-axis, or the magnitude of the other
/// eigenvalue (Delmarcelle and Hesselink, Visualizing second-order tensor fields with hyperstreamlines, 1993, where the
/// line is a tube whose cross-section is given by the two other axes). 0 where the tensor is zero, NaN where it is not
/// finite.
#[must_use]
pub fn half_widths(field: &Interpolated<'_>, line: &TensorLine, family: Family, scale: f64) -> Vec<f64> {
    let width = |p: &Point| {
        let values = field.at(*p).and_then(|t| field.axes().values(&t));
        values.map_or(f64::NAN, |v| scale * v[1 - family as usize].abs())
    };
    line.points.iter().map(width).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axes, LineOptions, tensor_line};
    use tigereye_core::{Field, Grid, Tensor2};

    /// The lengths of both axes grow along x.
    #[test]
    fn width_is_the_other_axis() {
        let field = Field::from_fn(Grid::new(11, 11).expect("a size"), |c| {
            Tensor2::symmetric(30.0 + c.x as f64, 0.0, -(1.0 + c.x as f64))
        });
        for axes in [Axes::HalfAxes, Axes::Eigenvectors] {
            let between = Interpolated::new(&field).with_axes(axes);
            let through = |family: Family| {
                tensor_line(&between, Point::new(2.0, 5.0), family, &LineOptions::default(), &mut |_| true)
            };
            let line = through(Family::Major);
            let widths = half_widths(&between, &line, Family::Major, 0.1);
            assert!(line.points.len() > 50);
            for (p, w) in line.points.iter().zip(&widths) {
                assert!((w - 0.1 * (1.0 + p.x)).abs() < 1e-12, "{p:?} {w}");
            }
            let across = through(Family::Minor);
            let widths = half_widths(&between, &across, Family::Minor, 0.1);
            assert!(widths.iter().all(|w| (w - 3.2).abs() < 1e-12));
        }
    }
}
