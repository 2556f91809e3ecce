//! Known answers: what a generator's file says of its fields, for the laws to check.

use tigereye_core::Tensor2;

/// What is known about a field of a generator. The first part are its arguments as a specification has them behind the
/// colon, `size=13,anisotropy=4`, or nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// The field is its own image under each of these.
    Symmetries(&'static str, &'static [Mirror]),
    /// The direction of the major semi-axis of a cell (column, row), degrees, up to half a turn.
    MajorAxis(&'static str, [usize; 2], f64),
    /// The tensor of a cell (column, row).
    Tensor(&'static str, [usize; 2], Tensor2),
    /// How many tensors make no ellipse but the unit circle.
    Circles(&'static str, usize),
    /// How often the major axis turns on a loop around the centre, counter-clockwise, in full turns.
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
