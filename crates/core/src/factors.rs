//! Parts of a real 2x2 tensor in closed form: its orthogonal factor and the principal axes of its symmetric part.

use crate::decomposition::{Eigenvalues, half_angle};
use crate::{Conformal, Tensor2, Vector, math, quarter_turned};

/// The orthogonal factor `Q = U V^T` of the polar decomposition `A = P Q` with the symmetric `P = U S U^T`: the
/// rotation or reflection that remains apart from stretching.
///
/// Of the two parts of [`Conformal`], `E` is a multiple of a rotation, `F` one of a reflection, and the larger one
/// points to `Q` (Higham 1986, "Computing the polar decomposition", for the general case).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrthogonalFactor {
    /// `det A >= 0`: a rotation, counter-clockwise.
    Rotation {
        /// `atan2(yx - xy, xx + yy)`, radians in (-pi, pi].
        angle_rad: f64,
    },
    /// `det A < 0`: a reflection that keeps one line as it is.
    Reflection {
        /// Direction of that line, `atan2(xy + yx, xx - yy) / 2`, radians in (-pi/2, pi/2].
        axis_rad: f64,
    },
}

impl OrthogonalFactor {
    /// The factor of `a`. Of a singular tensor it is the rotation that takes `v1` into `u1`, whatever sign rounding of
    /// the components gives its determinant; of the zero tensor and of one that is not finite, the rotation by 0.
    #[must_use]
    pub fn of(a: &Tensor2) -> Self {
        if !a.is_finite() {
            return Self::Rotation { angle_rad: 0.0 };
        }
        let exponent = math::binary_exponent(a.max_abs());
        let [p, q, r, t] = a.components().map(|c| math::scale_by_power_of_two(c, -exponent));
        // Largest effect of rounded components, as in files, on the determinant.
        let largest = p.abs().max(q.abs()).max(r.abs()).max(t.abs());
        let rounding = Eigenvalues::ROUNDING * largest * largest;
        let Conformal { e, f } = Conformal::of(&Tensor2::new(p, q, r, t));
        // Adding 0 makes a negative zero positive: half a turn is pi, never -pi.
        if math::difference_of_products(p, t, q, r) < -rounding {
            Self::Reflection { axis_rad: 0.5 * math::atan2(f.im + 0.0, f.re) }
        } else {
            Self::Rotation { angle_rad: math::atan2(e.im + 0.0, e.re) }
        }
    }
}

/// Principal values and axes of the symmetric part of a tensor, of a stress for example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes {
    /// Eigenvalues of the symmetric part in the tensor's unit, the algebraically larger first.
    pub values: [f64; 2],
    /// Unit vector of the first value, its angle in (-pi/2, pi/2]; the second axis is perpendicular.
    /// (1, 0) where both values are equal and every direction is an axis.
    pub first: Vector,
}

impl PrincipalAxes {
    /// Axes of `(a + a^T) / 2`; the values are NaN if `a` is not finite.
    #[must_use]
    pub fn of(a: &Tensor2) -> Self {
        if a.is_zero() || !a.is_finite() {
            let l = if a.is_finite() { 0.0 } else { f64::NAN };
            return Self { values: [l, l], first: Vector::new(1.0, 0.0) };
        }
        let exponent = math::binary_exponent(a.max_abs());
        let [p, q, r, t] = a.components().map(|c| math::scale_by_power_of_two(c, -exponent));
        let [l1, l2] = Eigenvalues::of(&Tensor2::symmetric(p, 0.5 * (q + r), t)).real_parts();
        let values = [l1.max(l2), l1.min(l2)].map(|l| math::scale_by_power_of_two(l, exponent));
        // The deviator points to twice the angle of the larger value's axis.
        let axis = half_angle(Conformal::of(&Tensor2::new(p, q, r, t)).f);
        Self { values, first: Vector::new(axis.x, axis.y) }
    }

    /// Unit vector of the second value, a quarter turn counter-clockwise from the first.
    #[must_use]
    pub const fn second(&self) -> Vector {
        quarter_turned(self.first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Svd;
    use nalgebra::Matrix2;
    use proptest::prelude::*;

    fn matrix(factor: OrthogonalFactor) -> Matrix2<f64> {
        match factor {
            OrthogonalFactor::Rotation { angle_rad: w } => {
                Matrix2::new(math::cos(w), -math::sin(w), math::sin(w), math::cos(w))
            }
            OrthogonalFactor::Reflection { axis_rad: w } => {
                let (c, s) = (math::cos(2.0 * w), math::sin(2.0 * w));
                Matrix2::new(c, s, s, -c)
            }
        }
    }

    #[test]
    fn factors_of_known_tensors() {
        let turn = |t: &Tensor2| OrthogonalFactor::of(t);
        let rotation = |angle_rad| OrthogonalFactor::Rotation { angle_rad };
        assert_eq!(turn(&Tensor2::symmetric(3.0, 0.0, 1.0)), rotation(0.0));
        assert_eq!(turn(&Tensor2::isotropic(-2.0)), rotation(math::PI));
        assert_eq!(turn(&Tensor2::new(-1.0, 0.0, -0.0, -1.0)), rotation(math::PI));
        assert_eq!(turn(&Tensor2::new(0.0, -1e300, 1e300, 0.0)), rotation(math::FRAC_PI_2));
        assert_eq!(turn(&Tensor2::ZERO), rotation(0.0));
        assert_eq!(turn(&Tensor2::new(f64::NAN, 0.0, 0.0, -1.0)), rotation(0.0));
        let mirrored = OrthogonalFactor::Reflection { axis_rad: math::FRAC_PI_4 };
        assert_eq!(turn(&Tensor2::symmetric(0.0, 1e-300, 0.0)), mirrored);
        // A singular tensor takes v1, here along y, into u1, here along x.
        assert_eq!(turn(&Tensor2::new(0.0, 5.0, 0.0, 0.0)), rotation(-math::FRAC_PI_2));
        assert!(matches!(
            turn(&Tensor2::symmetric(0.09, 0.3, 1.0 - 1e-16)),
            OrthogonalFactor::Rotation { .. }
        ));
    }

    #[test]
    fn axes_of_known_tensors() {
        let shear = PrincipalAxes::of(&Tensor2::symmetric(0.0, 2.0, 0.0));
        assert_eq!(shear.values, [2.0, -2.0]);
        assert!((shear.first.x - shear.first.y).abs() < 1e-15 && shear.first.x > 0.0);
        let pressed = PrincipalAxes::of(&Tensor2::symmetric(-3.0, 0.0, -1e-20));
        assert_eq!((pressed.values, pressed.first), ([-1e-20, -3.0], Vector::new(0.0, 1.0)));
        assert_eq!(PrincipalAxes::of(&Tensor2::new(0.0, -7.0, 7.0, 0.0)).values, [0.0, 0.0]);
        assert_eq!(PrincipalAxes::of(&Tensor2::isotropic(2.0)).first, Vector::new(1.0, 0.0));
        assert!(PrincipalAxes::of(&Tensor2::isotropic(f64::INFINITY)).values[0].is_nan());
        let huge = PrincipalAxes::of(&Tensor2::new(0.0, f64::MAX, f64::MAX, 0.0));
        assert_eq!(huge.values, [f64::MAX, -f64::MAX]);
    }

    proptest! {
        /// Rounding of 1e-16 grows as s1 / s2, which is bounded here by 1000, times a few operations.
        #[test]
        fn the_factor_is_that_of_the_singular_vectors(a in -9.0..9f64, b in -9.0..9f64, c in -9.0..9f64, d in -9.0..9f64) {
            let t = Tensor2::new(a, b, c, d);
            let svd = Svd::of(&t);
            // The factor of a nearly singular tensor hangs on the smaller singular value.
            prop_assume!(svd.s[1] > 1e-3 * svd.s[0]);
            let q = svd.u * svd.v.transpose();
            prop_assert!((matrix(OrthogonalFactor::of(&t)) - q).abs().max() < 1e-12);
        }

        #[test]
        fn principal_axes_rebuild_the_symmetric_part(a in -9.0..9f64, b in -9.0..9f64, c in -9.0..9f64, d in -9.0..9f64) {
            let t = Tensor2::new(a, b, c, d);
            let axes = PrincipalAxes::of(&t);
            prop_assert!(axes.values[0] >= axes.values[1]);
            let part = Tensor2::from_eigen(math::atan2(axes.first.y, axes.first.x), axes.values[0], axes.values[1]);
            let off = part.components().into_iter().zip(t.symmetric_part().components());
            prop_assert!(off.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max) < 2e-14, "{axes:?}");
            prop_assert_eq!(axes, PrincipalAxes::of(&t.transposed()));
        }
    }
}
