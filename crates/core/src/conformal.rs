//! The conformal and the anticonformal part of a tensor, as complex numbers.

use crate::Tensor2;
use nalgebra::Complex;

/// The two parts of the linear map `z -> (E z + F conj(z)) / 2` of the complex plane that a tensor is.
///
/// `E` scales by `|E| / 2` and rotates by `arg E`; `F` reflects and stretches along `arg F / 2`. Hence the semi-axes
/// `(|E| + |F|) / 2` and `||E| - |F|| / 2`, the longer one at `(arg E + arg F) / 2`, and the determinant
/// `(|E|^2 - |F|^2) / 4`. A symmetric tensor has a real `E`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conformal {
    /// `E = (xx + yy) + i (yx - xy)`.
    pub e: Complex<f64>,
    /// `F = (xx - yy) + i (xy + yx)`.
    pub f: Complex<f64>,
}

impl Conformal {
    /// The parts of `t`; sums of its components, which may overflow for the largest numbers.
    #[must_use]
    pub fn of(t: &Tensor2) -> Self {
        Self {
            e: Complex::new(t.xx() + t.yy(), t.yx() - t.xy()),
            f: Complex::new(t.xx() - t.yy(), t.xy() + t.yx()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;

    #[test]
    fn the_parts_rebuild_the_map() {
        let t = Tensor2::new(1.0, 2.0, -0.5, 0.25);
        let Conformal { e, f } = Conformal::of(&t);
        for v in [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0), Vector::new(-3.0, 0.5)] {
            let z = Complex::new(v.x, v.y);
            let image = (e * z + f * z.conj()) * 0.5;
            assert_eq!(image.re, t.xx() * v.x + t.xy() * v.y);
            assert_eq!(image.im, t.yx() * v.x + t.yy() * v.y);
        }
        assert_eq!(0.25 * (e.norm_sqr() - f.norm_sqr()), t.determinant());
    }
}
