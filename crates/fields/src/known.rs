//! Known answers: properties of its fields that a generator declares and the tests check.

use tigereye_core::Tensor2;

/// A known property of a generator's field. The first value holds the arguments of the field as they follow the colon
/// of a specification, `size=13,anisotropy=4`; it may be empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// The field is its own image under each of these.
    Symmetries(&'static str, &'static [Mirror]),
    /// The direction of the major semi-axis of a cell (column, row), degrees, up to half a turn.
    MajorAxis(&'static str, [usize; 2], f64),
    /// The tensor of a cell (column, row).
    Tensor(&'static str, [usize; 2], Tensor2),
    /// Number of tensors whose ellipse is the unit circle.
    Circles(&'static str, usize),
    /// Number of full counter-clockwise turns of the major axis along a loop around the centre.
    Index(&'static str, f64),
}

/// A map of the plane to itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mirror {
    /// Left and right exchanged.
    LeftRight,
    /// Top and bottom exchanged.
    UpDown,
    /// A quarter turn counter-clockwise.
    QuarterTurn,
    /// A half turn.
    HalfTurn,
}

impl Known {
    /// The arguments of the field.
    #[must_use]
    pub const fn arguments(&self) -> &'static str {
        match self {
            Self::Symmetries(arguments, _)
            | Self::MajorAxis(arguments, ..)
            | Self::Tensor(arguments, ..)
            | Self::Circles(arguments, _)
            | Self::Index(arguments, _) => arguments,
        }
    }
}
