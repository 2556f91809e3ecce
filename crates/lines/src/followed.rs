//! A field prepared for following its axes: the tensors to interpolate, the axes, and the shape of a cell.

use crate::{Axes, Decomposition, Interpolated, Major, OrderedAxes, ellipse_tensors, signed_ellipse_tensors};
use tigereye_core::{CellShape, Field, Grid, Symmetry, Tensor2};

/// The usual axes of a field: eigenvectors if it is symmetric ([`Symmetry`]), semi-axes otherwise.
#[must_use]
pub fn usual_axes(field: &Field<Tensor2>) -> Axes {
    if Symmetry::of(field).is_symmetric() { Axes::Eigenvectors } else { Axes::HalfAxes }
}

/// Least excess of the rotation over the stretching, as a fraction of the latter: in simple shear they are equal up to
/// rounding.
const COMPLEX_ABOVE: f64 = 1e-6;

/// Whether the eigenvalues of a tensor are complex: it rotates more than it stretches. Meant for tensors of
/// [`Field::without_rounding`].
#[must_use]
pub fn is_complex(t: &Tensor2) -> bool {
    let Decomposition { rotation, stretching, .. } = Decomposition::of(t);
    t.is_finite() && rotation.abs() > (1.0 + COMPLEX_ABOVE) * stretching
}

/// The axes to follow, in which order, and the shape of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following {
    /// The axes, and which of them is major.
    pub axes: OrderedAxes,
    /// The shape of a cell.
    pub cell: CellShape,
}

impl Following {
    /// The longer side of a grid, in the unit of the smaller side of a cell.
    #[must_use]
    pub fn longer_side(&self, grid: Grid) -> f64 {
        self.cell.longer_side([grid.width(), grid.height()])
    }
}

/// A field whose axes are followed between its cells. For semi-axes the ellipses are interpolated, because the
/// components of asymmetric tensors may cancel between cells whose ellipses agree. A field that is asymmetric only by
/// rounding counts as symmetric.
#[derive(Clone, Debug)]
pub struct Followed {
    tensors: Field<Tensor2>,
    following: Following,
}

impl Followed {
    /// The tensors to interpolate for these axes.
    #[must_use]
    pub fn new(field: &Field<Tensor2>, following: Following) -> Self {
        let plain = field.without_rounding();
        let tensors = match (following.axes.axes(), following.axes.major()) {
            (Axes::HalfAxes, Major::Magnitude) => ellipse_tensors(&plain),
            (Axes::HalfAxes, Major::Value) => signed_ellipse_tensors(&plain),
            (Axes::Eigenvectors | Axes::DualEigenvectors, _) => plain,
        };
        Self { tensors, following }
    }

    /// The axes that are followed.
    #[must_use]
    pub const fn following(&self) -> Following {
        self.following
    }

    /// The field between its cells.
    #[must_use]
    pub fn interpolated(&self) -> Interpolated<'_> {
        Interpolated::new(&self.tensors).with_axes(self.following.axes).with_cell(self.following.cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_fields::generators;
    use tigereye_test_support::field;

    /// The asymmetry of each generator is either rounding or large; none lies near the threshold.
    #[test]
    fn generators_are_judged_with_a_wide_margin() {
        let (mut symmetric, mut others) = (0, 0);
        for generator in generators() {
            let field = field(generator.name);
            let ratio = Symmetry::of(&field).ratio();
            let is_symmetric = usual_axes(&field) == Axes::Eigenvectors;
            assert!(!(1e-12..=0.05).contains(&ratio), "{}: {ratio}", generator.name);
            assert_eq!(is_symmetric, ratio < 1e-12, "{}", generator.name);
            symmetric += usize::from(is_symmetric);
            others += usize::from(!is_symmetric);
        }
        assert!(symmetric > 3 && others > 3, "{symmetric} {others}");
    }

    /// Simple shear stretches as much as it rotates, also in single precision.
    #[test]
    fn simple_shear_is_not_complex_by_rounding() {
        for rounding in [0.0, 6e-8, -6e-8] {
            assert!(!is_complex(&Tensor2::new(rounding, 1.0, rounding, -rounding)), "{rounding}");
        }
        assert!(is_complex(&Tensor2::new(0.0, 1.0, -1e-3, 0.0)));
    }
}
