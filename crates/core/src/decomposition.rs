//! Closed-form singular value and eigenvalue decompositions of a real 2x2 tensor.
//!
//! Everything is computed on the tensor scaled by a power of two so that its largest component lies in [0.5, 1):
//! entries near 1e-300 or 1e200 are as accurate as those near 1.

use crate::{Conformal, Tensor2, Vector, math};
use nalgebra::{Complex, Matrix2, Vector2};

/// `A = U diag(s1, s2) V^T` with `s1 >= s2 >= 0`, `U` a rotation, `V` a rotation (det A >= 0) or a reflection.
///
/// The columns of `U` are the semi-axes of the ellipse the tensor makes of the unit circle (thesis, section 2.3,
/// after Moler). Where `s1 = s2` the axes are arbitrary; a zero tensor has `U = V = I`. A tensor with a non-finite
/// component has non-finite singular values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Svd {
    /// Left singular vectors as columns, major first.
    pub u: Matrix2<f64>,
    /// Singular values, largest first.
    pub s: [f64; 2],
    /// Right singular vectors as columns.
    pub v: Matrix2<f64>,
}

impl Svd {
    /// Decomposes `a`; relative error of both singular values a few units in the last place.
    #[must_use]
    pub fn of(a: &Tensor2) -> Self {
        let exponent = math::binary_exponent(a.max_abs());
        if a.max_abs() == 0.0 || !a.is_finite() {
            let s = if a.is_finite() { 0.0 } else { f64::NAN };
            return Self { u: Matrix2::identity(), s: [s, s], v: Matrix2::identity() };
        }
        let [p, q, r, t] = a.components().map(|c| math::scale_by_power_of_two(c, -exponent));
        let Conformal { e, f } = Conformal::of(&Tensor2::new(p, q, r, t));
        let (e, f) = (e * 0.5, f * 0.5);
        let s1 = math::hypot(e.re, e.im) + math::hypot(f.re, f.im);
        let det = math::difference_of_products(p, t, q, r);
        let s2 = (det.abs() / s1).min(s1);

        // The product of both parts points to twice the angle of the major left vector.
        let u1 = half_angle(e * f);
        let u2 = Vector2::new(-u1.y, u1.x);
        let scaled = Matrix2::new(p, q, r, t);
        let v1 = (scaled.transpose() * u1) / s1;
        let v1 = v1 / math::hypot(v1.x, v1.y);
        let handed = if det < 0.0 { -1.0 } else { 1.0 };
        let v2 = Vector2::new(-v1.y, v1.x) * handed;
        Self {
            u: Matrix2::from_columns(&[u1, u2]),
            s: [s1, s2].map(|s| math::scale_by_power_of_two(s, exponent)),
            v: Matrix2::from_columns(&[v1, v2]),
        }
    }

    /// Direction of the major semi-axis, radians in (-pi, pi]: `atan2(U[1][0], U[0][0])`.
    #[must_use]
    pub fn phi_rad(&self) -> f64 {
        math::atan2(self.u[(1, 0)], self.u[(0, 0)])
    }

    /// Unit vector of the major semi-axis; its sign is arbitrary.
    #[must_use]
    pub fn major(&self) -> Vector {
        Vector::new(self.u[(0, 0)], self.u[(1, 0)])
    }

    /// `s2 / s1` in [0, 1]; 1 for a zero tensor.
    #[must_use]
    pub fn axis_ratio(&self) -> f64 {
        if self.s[0] > 0.0 { (self.s[1] / self.s[0]).min(1.0) } else { 1.0 }
    }
}

/// Unit vector at half the argument of `z`, taken in (-pi/2, pi/2].
pub(crate) fn half_angle(z: Complex<f64>) -> Vector2<f64> {
    let (x, y) = (z.re, z.im);
    let r = math::hypot(x, y);
    if r == 0.0 {
        return Vector2::new(1.0, 0.0);
    }
    // The larger component comes from the square root, the smaller from a quotient: no cancellation in either.
    let (c, s) = if x >= 0.0 {
        let c = (0.5 * (1.0 + x / r)).sqrt();
        (c, y / r / (2.0 * c))
    } else {
        let s = (0.5 * (1.0 - x / r)).sqrt();
        let s = if y < 0.0 { -s } else { s };
        (y / r / (2.0 * s), s)
    };
    let n = math::hypot(c, s);
    Vector2::new(c / n, s / n)
}

/// Eigenvalues of a real 2x2 tensor, the larger magnitude of the real part first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eigenvalues {
    /// Two real eigenvalues, `|first| >= |second|`.
    Real([f64; 2]),
    /// A conjugate pair `re +- im*i`, `im > 0`: the tensor rotates more than it stretches.
    Complex {
        /// Real part of both.
        re: f64,
        /// Imaginary part of one, positive.
        im: f64,
    },
}

impl Eigenvalues {
    /// Eigenvalues of `a`. The smaller real one comes from the determinant, so it does not suffer cancellation.
    #[must_use]
    pub fn of(a: &Tensor2) -> Self {
        if a.is_zero() || !a.is_finite() {
            let l = if a.is_finite() { 0.0 } else { f64::NAN };
            return Self::Real([l, l]);
        }
        let exponent = math::binary_exponent(a.max_abs());
        let back = |x| math::scale_by_power_of_two(x, exponent);
        let [p, q, r, t] = a.components().map(|c| math::scale_by_power_of_two(c, -exponent));
        let mean = 0.5 * (p + t);
        let half_difference = 0.5 * (p - t);
        // Discriminant (p-t)^2/4 + q r.
        let discriminant = math::difference_of_products(half_difference, half_difference, -q, r);
        if discriminant < 0.0 {
            return Self::Complex { re: back(mean), im: back((-discriminant).sqrt()) };
        }
        let root = discriminant.sqrt();
        let large = if mean < 0.0 { mean - root } else { mean + root };
        let det = math::difference_of_products(p, t, q, r);
        let small = if large == 0.0 { 0.0 } else { det / large };
        Self::Real([back(large), back(small)])
    }

    /// Real parts, in the order of the enum's documentation.
    #[must_use]
    pub fn real_parts(&self) -> [f64; 2] {
        match *self {
            Self::Real(l) => l,
            Self::Complex { re, .. } => [re, re],
        }
    }

    /// A real part counts as zero up to this fraction of the larger one: in single precision a vanishing eigenvalue
    /// becomes a small number of either sign.
    pub const ROUNDING: f64 = 1e-6;

    /// The signs of the real parts (thesis, section 2.3), neutral for those within [`Self::ROUNDING`] of zero. They
    /// colour glyphs and never affect the propagation.
    #[must_use]
    pub fn axis_signs(&self) -> [AxisSign; 2] {
        let parts = self.real_parts();
        let zero = Self::ROUNDING * parts[0].abs().max(parts[1].abs());
        parts.map(|l| match l {
            l if l > zero => AxisSign::Tension,
            l if l < -zero => AxisSign::Compression,
            _ => AxisSign::Neutral,
        })
    }

    /// Whether one real part is negative and the other positive, both by more than [`Self::ROUNDING`].
    #[must_use]
    pub fn is_indefinite(&self) -> bool {
        let [a, b] = self.axis_signs();
        a != b && a != AxisSign::Neutral && b != AxisSign::Neutral
    }

    /// Number of real parts that are negative by more than [`Self::ROUNDING`].
    #[must_use]
    pub fn negative(&self) -> usize {
        self.axis_signs().into_iter().filter(|s| *s == AxisSign::Compression).count()
    }
}

/// Whether an axis is in tension or compression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisSign {
    /// Positive real part.
    Tension,
    /// Negative real part.
    Compression,
    /// Zero, up to rounding.
    Neutral,
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check_svd(t: &Tensor2) {
        let Svd { u, s, v } = Svd::of(t);
        let a = Matrix2::from(*t);
        let scale = t.max_abs();
        assert!(s[0] >= s[1] && s[1] >= 0.0, "{t:?}: order {s:?}");
        for (name, m) in [("U", u), ("V", v)] {
            let e = (m.transpose() * m - Matrix2::identity()).abs().max();
            assert!(e < 4.0 * f64::EPSILON, "{t:?}: {name} not orthogonal by {e:e}");
        }
        assert!(u.determinant() > 0.0, "{t:?}: U is a rotation");
        let unit = if scale > 0.0 { scale } else { 1.0 };
        let scaled_back = u * Matrix2::new(s[0] / unit, 0.0, 0.0, s[1] / unit) * v.transpose();
        let e = (scaled_back - a / unit).abs().max();
        assert!(e < 1e-15 * 4.0, "{t:?}: A - U S V^T = {e:e}");
    }

    #[test]
    fn svd_of_special_tensors() {
        for t in [
            Tensor2::ZERO,
            Tensor2::IDENTITY,
            Tensor2::new(0.0, 1.0, -1.0, 0.0),
            Tensor2::new(0.0, 1.0, 1.0, 0.0),
            Tensor2::new(1.0, 1.0, 1.0, 1.0),
            Tensor2::new(1.0, 0.0, 0.0, 0.0),
            Tensor2::new(0.0, 0.0, 0.0, -3.0),
            Tensor2::new(1e-300, 2e-300, -3e-300, 1e-301),
            Tensor2::new(1e200, 2e200, -3e200, 1e199),
            Tensor2::new(1e200, 1.0, 1.0, 1e-200),
            Tensor2::new(f64::MAX, f64::MAX, f64::MAX, -f64::MAX).scaled(0.25),
            Tensor2::new(-1.0, 1e-17, 0.0, -1.0),
        ] {
            check_svd(&t);
        }
    }

    #[test]
    fn svd_keeps_a_tiny_second_value() {
        // diag(1, 1e-20), turned: the smaller singular value must not drown in the larger one's rounding.
        let s = Svd::of(&Tensor2::new(1.0, 0.0, 0.0, 1e-20)).s;
        assert_eq!(s, [1.0, 1e-20]);
    }

    #[test]
    fn svd_of_non_finite_is_nan_not_a_hang() {
        assert!(Svd::of(&Tensor2::new(f64::NAN, 0.0, 0.0, 1.0)).s[0].is_nan());
        assert!(Svd::of(&Tensor2::new(f64::INFINITY, 0.0, 0.0, 1.0)).s[0].is_nan());
    }

    #[test]
    fn eigenvalues_of_known_tensors() {
        assert_eq!(Eigenvalues::of(&Tensor2::symmetric(2.0, 0.0, -3.0)), Eigenvalues::Real([-3.0, 2.0]));
        assert_eq!(
            Eigenvalues::of(&Tensor2::new(0.0, -1.0, 1.0, 0.0)),
            Eigenvalues::Complex { re: 0.0, im: 1.0 }
        );
        let Eigenvalues::Real([l1, l2]) = Eigenvalues::of(&Tensor2::new(1e200, 1e200, 1e200, 1e200)) else {
            panic!("real eigenvalues expected")
        };
        assert_eq!((l1, l2), (2e200, 0.0));
        assert!(Eigenvalues::of(&Tensor2::symmetric(1e-200, 0.0, -1e-200)).is_indefinite());
    }

    #[test]
    fn signs_follow_the_eigenvalues() {
        // A vanishing eigenvalue rounded to single precision has no sign.
        for rounding in [3e-8, 0.0, -3e-8] {
            let values = Eigenvalues::of(&Tensor2::symmetric(2.0, 0.0, 2.0 * rounding));
            assert_eq!(values.axis_signs(), [AxisSign::Tension, AxisSign::Neutral]);
            assert_eq!((values.is_indefinite(), values.negative()), (false, 0));
        }
        let signs = Eigenvalues::of(&Tensor2::symmetric(1.0, 0.0, -2.0)).axis_signs();
        assert_eq!(signs, [AxisSign::Compression, AxisSign::Tension]);
    }

    proptest! {
        #[test]
        fn svd_rebuilds_any_tensor(a in -1e3..1e3f64, b in -1e3..1e3f64, c in -1e3..1e3f64, d in -1e3..1e3f64,
                                   e in -900i32..900) {
            let f = |x| math::scale_by_power_of_two(x, e);
            check_svd(&Tensor2::new(f(a), f(b), f(c), f(d)));
        }

        #[test]
        fn svd_finds_the_axes_it_was_built_from(phi in -3.1..3.1f64, s2 in 0.0..0.999f64) {
            let svd = Svd::of(&Tensor2::from_axes(phi, 1.0, s2));
            let [x, y] = svd.major().to_array();
            let off_axis = x * math::sin(phi) - y * math::cos(phi);
            prop_assert!(off_axis.abs() < 4e-16 / (1.0 - s2) + 1e-15);
            prop_assert!((svd.s[1] - s2).abs() < 1e-15);
        }

        #[test]
        fn eigenvalues_solve_the_characteristic_equation(a in -9.0..9f64, b in -9.0..9f64, c in -9.0..9f64, d in -9.0..9f64) {
            let t = Tensor2::new(a, b, c, d);
            match Eigenvalues::of(&t) {
                Eigenvalues::Real([l1, l2]) => {
                    prop_assert!(l1.abs() >= l2.abs());
                    prop_assert!((l1 + l2 - t.trace()).abs() < 1e-13);
                    prop_assert!((l1 * l2 - t.determinant()).abs() < 1e-12);
                }
                Eigenvalues::Complex { re, im } => {
                    prop_assert!((2.0 * re - t.trace()).abs() < 1e-14);
                    prop_assert!((re * re + im * im - t.determinant()).abs() < 1e-12);
                }
            }
        }
    }
}
