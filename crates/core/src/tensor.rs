//! The tensor of one cell.

use crate::math;
use nalgebra::Matrix2;

/// A real second-order tensor in the plane, symmetric or not.
///
/// ```text
///   | xx  xy |     row = component of the result,
///   | yx  yy |     column = direction it acts on
/// ```
///
/// Components live in the frame x right, y up. Entries may be anything a file holds; the decompositions
/// are meaningful if [`Tensor2::is_finite`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tensor2 {
    m: [[f64; 2]; 2],
}

impl Tensor2 {
    /// The tensor that maps everything to zero: a cell that transmits nothing.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0, 0.0);
    /// The isotropic unit tensor.
    pub const IDENTITY: Self = Self::new(1.0, 0.0, 0.0, 1.0);

    /// `[[xx, xy], [yx, yy]]`.
    #[must_use]
    pub const fn new(xx: f64, xy: f64, yx: f64, yy: f64) -> Self {
        Self { m: [[xx, xy], [yx, yy]] }
    }

    /// A symmetric tensor, as stresses and diffusion tensors are.
    #[must_use]
    pub const fn symmetric(xx: f64, xy: f64, yy: f64) -> Self {
        Self::new(xx, xy, xy, yy)
    }

    /// A multiple of the identity.
    #[must_use]
    pub const fn isotropic(value: f64) -> Self {
        Self::new(value, 0.0, 0.0, value)
    }

    /// A rotation by `phi_rad` times `diag(s1, s2)`: the major semi-axis of length `s1` points to `phi_rad`.
    ///
    /// Not symmetric in general; its left singular vectors are the columns of the rotation.
    #[must_use]
    pub fn from_axes(phi_rad: f64, s1: f64, s2: f64) -> Self {
        let (c, s) = (math::cos(phi_rad), math::sin(phi_rad));
        Self::new(s1 * c, -s2 * s, s1 * s, s2 * c)
    }

    /// The symmetric tensor `R diag(l1, l2) R^T` with eigenvalue `l1` in direction `phi_rad`.
    #[must_use]
    pub fn from_eigen(phi_rad: f64, l1: f64, l2: f64) -> Self {
        let (c, s) = (math::cos(phi_rad), math::sin(phi_rad));
        Self::symmetric(l1 * c * c + l2 * s * s, (l1 - l2) * c * s, l1 * s * s + l2 * c * c)
    }

    /// Component xx.
    #[must_use]
    pub const fn xx(&self) -> f64 {
        self.m[0][0]
    }
    /// Component xy: first row, second column.
    #[must_use]
    pub const fn xy(&self) -> f64 {
        self.m[0][1]
    }
    /// Component yx: second row, first column.
    #[must_use]
    pub const fn yx(&self) -> f64 {
        self.m[1][0]
    }
    /// Component yy.
    #[must_use]
    pub const fn yy(&self) -> f64 {
        self.m[1][1]
    }
    /// The components row by row: xx, xy, yx, yy.
    #[must_use]
    pub const fn components(&self) -> [f64; 4] {
        [self.m[0][0], self.m[0][1], self.m[1][0], self.m[1][1]]
    }

    /// Sum of the diagonal.
    #[must_use]
    pub fn trace(&self) -> f64 {
        self.m[0][0] + self.m[1][1]
    }

    /// Determinant, accurate to the last bits of its own size.
    #[must_use]
    pub fn determinant(&self) -> f64 {
        math::difference_of_products(self.m[0][0], self.m[1][1], self.m[0][1], self.m[1][0])
    }

    /// The transposed tensor.
    #[must_use]
    pub const fn transposed(&self) -> Self {
        Self::new(self.m[0][0], self.m[1][0], self.m[0][1], self.m[1][1])
    }

    /// Half of the sum with its transpose.
    #[must_use]
    pub fn symmetric_part(&self) -> Self {
        Self::symmetric(self.xx(), 0.5 * (self.xy() + self.yx()), self.yy())
    }

    /// `|xy - yx|`: twice the rotation the tensor contains. 0 for a symmetric tensor.
    #[must_use]
    pub fn asymmetry(&self) -> f64 {
        (self.xy() - self.yx()).abs()
    }

    /// Whether the shear components differ by at most `tolerance`, in the tensor's unit: [`crate::Symmetry`] knows that
    /// of a field.
    #[must_use]
    pub fn is_symmetric_within(&self, tolerance: f64) -> bool {
        self.asymmetry() <= tolerance
    }

    /// Every component times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let [a, b, c, d] = self.components();
        Self::new(a * factor, b * factor, c * factor, d * factor)
    }

    /// Largest absolute component.
    #[must_use]
    pub fn max_abs(&self) -> f64 {
        self.components().into_iter().fold(0.0, |m, c| m.max(c.abs()))
    }

    /// Whether every component is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.components().iter().all(|c| c.is_finite())
    }

    /// Whether every component is exactly zero.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.components().iter().all(|&c| c == 0.0)
    }

    /// The tensor rotated by a quarter turn counter-clockwise: what acted along +x acts along +y.
    #[must_use]
    pub const fn quarter_turned(&self) -> Self {
        Self::new(self.m[1][1], -self.m[1][0], -self.m[0][1], self.m[0][0])
    }

    /// The same tensor with the y axis pointing the other way: the off-diagonal components change sign.
    ///
    /// Used where a file's rows run upwards and the grid's run downwards.
    #[must_use]
    pub const fn mirrored_y(&self) -> Self {
        Self::new(self.m[0][0], -self.m[0][1], -self.m[1][0], self.m[1][1])
    }
}

impl From<Matrix2<f64>> for Tensor2 {
    fn from(m: Matrix2<f64>) -> Self {
        Self::new(m[(0, 0)], m[(0, 1)], m[(1, 0)], m[(1, 1)])
    }
}

impl From<Tensor2> for Matrix2<f64> {
    fn from(t: Tensor2) -> Self {
        let [xx, xy, yx, yy] = t.components();
        Self::new(xx, xy, yx, yy)
    }
}

impl core::ops::Add for Tensor2 {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.xx() + o.xx(), self.xy() + o.xy(), self.yx() + o.yx(), self.yy() + o.yy())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_put_the_major_semi_axis_first() {
        let t = Tensor2::from_axes(math::FRAC_PI_2, 3.0, 0.5);
        assert!((t.yx() - 3.0).abs() < 1e-15 && (t.xy() + 0.5).abs() < 1e-15);
        assert!((t.determinant() - 1.5).abs() < 1e-15);
    }

    #[test]
    fn eigen_form_is_symmetric_and_keeps_the_trace() {
        let t = Tensor2::from_eigen(0.3, 2.0, -1.0);
        assert_eq!(t.asymmetry(), 0.0);
        assert!((t.trace() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn four_quarter_turns_are_the_identity() {
        let t = Tensor2::new(1.0, 2.0, 3.0, 4.0);
        let turned = t.quarter_turned().quarter_turned().quarter_turned().quarter_turned();
        assert_eq!(turned, t);
        let once = Tensor2::from_eigen(0.2, 2.0, 1.0).quarter_turned();
        let expected = Tensor2::from_eigen(0.2 + math::FRAC_PI_2, 2.0, 1.0);
        assert!((once.xy() - expected.xy()).abs() < 1e-15 && (once.xx() - expected.xx()).abs() < 1e-15);
    }
}
