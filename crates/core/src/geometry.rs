//! Points and vectors, and the frames they belong to.
//!
//! The types are those of `euclid`, whose unit parameter keeps frames apart: rows of cells run downwards and directions
//! of tensors upwards, so that adding one to the other has to be a compile error. The other vector types at hand (those
//! of `nalgebra`) would accept the sum and get the sign of y wrong.

use crate::math;
use euclid::{Point2D, Vector2D};

/// Frame of the grid: counted in cells from the centre of the upper left cell, x to the right, y **downwards**.
#[derive(Clone, Copy, Debug)]
pub enum Cells {}

/// Frame of tensors and angles: x to the right, y **upwards**, equal units along both. Lengths count in the smaller
/// side of a cell ([`crate::CellShape`]), which also converts positions between the two frames.
#[derive(Clone, Copy, Debug)]
pub enum Physical {}

/// A position in the grid, in cells.
pub type Point = Point2D<f64, Cells>;

/// A position in the physical frame.
pub type PhysicalPoint = Point2D<f64, Physical>;

/// A direction or displacement in the physical frame: an axis of a tensor, a tangent of a line.
pub type Vector = Vector2D<f64, Physical>;

/// Length of a vector of any frame, without overflow or underflow ([`math::hypot`]; `euclid` sums squares).
#[must_use]
pub fn length<Frame>(v: Vector2D<f64, Frame>) -> f64 {
    math::hypot(v.x, v.y)
}

/// The vector a quarter turn counter-clockwise from `v`, in the physical frame.
#[must_use]
pub const fn quarter_turned(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_neither_overflow_nor_vanish() {
        for scale in [1e-200, 1.0, 1e200] {
            assert!((length(Vector::new(3.0 * scale, -4.0 * scale)) / scale - 5.0).abs() < 1e-14);
        }
        assert_eq!(quarter_turned(Vector::new(1.0, 2.0)), Vector::new(-2.0, 1.0));
    }
}
