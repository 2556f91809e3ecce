//! Scalar anisotropy measures of a 2D tensor.
//!
//! The 3D measures of the literature have planar counterparts; several are in use, so each formula is named here.
//! Most are computed from singular values (for a symmetric tensor: the magnitudes of its eigenvalues);
//! [`Anisotropy::mode`] and [`Anisotropy::fractional`] need the signs.

use crate::{Eigenvalues, Svd, Tensor2, fractional_anisotropy3, math, symmetric_eigenvalues3};

/// The measures of one tensor. A zero tensor is isotropic: its `spherical` is 1, all others are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anisotropy {
    /// Linear coefficient `c_l = (s1 - s2) / (s1 + s2)` in [0, 1] (Westin et al. 2002, reduced to two axes).
    pub linear: f64,
    /// Spherical coefficient `c_s = 2 s2 / (s1 + s2) = 1 - c_l` in [0, 1].
    pub spherical: f64,
    /// Planar anisotropy of the semi-axes, `|s1 - s2| / sqrt(s1^2 + s2^2)` in [0, 1]: the norm of the deviator of the
    /// tensor's symmetric factor over its norm, times sqrt(2) so that one vanishing axis gives 1. It has the
    /// form of fractional anisotropy for two axes without signs, but is a different number.
    pub planar: f64,
    /// Fractional anisotropy, FA (Basser and Pierpaoli 1996): [`fractional_anisotropy3`] of the tensor as a volume
    /// holds it, with a third row and column of zeros, so that a plane and a volume of one layer say the same. From the
    /// signed eigenvalues of the symmetric part: sqrt(1/2) for isotropic tensors, 1 for one vanishing axis, above 1
    /// only where the signs differ, up to sqrt(3/2) for pure shear; NaN if the eigenvalues are not finite.
    pub fractional: f64,
    /// Mean semi-axis `(s1 + s2) / 2`, in the tensor's unit.
    pub mean: f64,
    /// Mode `(l1 + l2) / sqrt(2 (l1^2 + l2^2))` in [-1, 1] of the real parts of the eigenvalues: 1 isotropic tension,
    /// 0 pure shear, -1 isotropic compression (the 3D mode is constant in the plane; this is the planar isotropy
    /// index after Palacios et al. 2016).
    pub mode: f64,
}

impl Anisotropy {
    /// Measures of `t`.
    #[must_use]
    pub fn of(t: &Tensor2) -> Self {
        let [s1, s2] = Svd::of(t).s;
        let [l1, l2] = Eigenvalues::of(t).real_parts();
        let ratio = |x: f64, y: f64, zero: f64| if y > 0.0 { x / y } else { zero };
        // Halving first keeps the sums finite for the largest numbers.
        let half_sum = 0.5 * s1 + 0.5 * s2;
        let half_difference = 0.5 * s1 - 0.5 * s2;
        Self {
            linear: ratio(half_difference, half_sum, 0.0),
            spherical: ratio(s2, half_sum, 1.0),
            planar: ratio(half_difference, math::hypot(0.5 * s1, 0.5 * s2), 0.0),
            fractional: fractional_of_volume(t),
            mean: half_sum,
            mode: ratio(0.5 * l1 + 0.5 * l2, math::hypot(0.5 * l1, 0.5 * l2), 0.0)
                / core::f64::consts::SQRT_2,
        }
    }
}

/// Fractional anisotropy of the tensor with a third row and column of zeros.
fn fractional_of_volume(t: &Tensor2) -> f64 {
    let [xx, xy, yx, yy] = t.components();
    fractional_anisotropy3(symmetric_eigenvalues3(&[xx, xy, 0.0, yx, yy, 0.0, 0.0, 0.0, 0.0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_of_known_tensors() {
        let a = Anisotropy::of(&Tensor2::symmetric(3.0, 0.0, 1.0));
        assert_eq!((a.linear, a.spherical, a.mean), (0.5, 0.5, 2.0));
        assert!((a.planar - 2.0 / 10f64.sqrt()).abs() < 1e-15);
        assert!((a.fractional - (7.0_f64 / 10.0).sqrt()).abs() < 1e-15);
        assert!((a.mode - 4.0 / 20f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn limits_are_reached() {
        let line = Anisotropy::of(&Tensor2::symmetric(1.0, 0.0, 0.0));
        assert_eq!((line.linear, line.spherical, line.planar), (1.0, 0.0, 1.0));
        assert!((Anisotropy::of(&Tensor2::IDENTITY).mode - 1.0).abs() < 1e-15);
        assert!((Anisotropy::of(&Tensor2::isotropic(-2.0)).mode + 1.0).abs() < 1e-15);
        assert_eq!(Anisotropy::of(&Tensor2::symmetric(1.0, 0.0, -1.0)).mode, 0.0);
        let zero = Anisotropy::of(&Tensor2::ZERO);
        assert_eq!((zero.linear, zero.spherical, zero.planar, zero.mode), (0.0, 1.0, 0.0, 0.0));
        assert_eq!(zero.fractional, 0.0);
    }

    #[test]
    fn measures_do_not_depend_on_scale() {
        let (small, large) =
            (Tensor2::new(1e-300, 2e-300, 0.0, 3e-300), Tensor2::new(1e200, 2e200, 0.0, 3e200));
        let (a, b) = (Anisotropy::of(&small), Anisotropy::of(&large));
        assert!((a.linear - b.linear).abs() < 1e-14 && (a.planar - b.planar).abs() < 1e-14);
        assert!((a.fractional - b.fractional).abs() < 1e-14);
        assert!((a.mode - b.mode).abs() < 1e-14);
    }

    /// The signs of eigenvalues count: pure shear is as far from isotropic as a volume's tensor can be, though its
    /// semi-axes are equal.
    #[test]
    fn fractional_anisotropy_is_that_of_a_volume() {
        let of = |t: Tensor2| Anisotropy::of(&t);
        let shear = of(Tensor2::symmetric(0.0, 1.0, 0.0));
        assert_eq!(shear.planar, 0.0);
        assert!((shear.fractional - 1.5_f64.sqrt()).abs() < 1e-15);
        assert!((of(Tensor2::IDENTITY).fractional - 0.5_f64.sqrt()).abs() < 1e-15);
        assert!((of(Tensor2::symmetric(2.0, 0.0, 0.0)).fractional - 1.0).abs() < 1e-15);
        // Rotations do not count, as in volumes: only the symmetric part has eigenvalues there.
        let turning = of(Tensor2::new(3.0, 5.0, -5.0, 1.0));
        assert_eq!(turning.fractional, of(Tensor2::symmetric(3.0, 0.0, 1.0)).fractional);
    }
}
