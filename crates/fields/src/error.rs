//! Errors in the name, arguments or expressions of a field.

use crate::nearest::did_you_mean;
use crate::{ExpressionError, ParameterKind};
use thiserror::Error;
use tigereye_core::CoreError;

/// A field that cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FieldError {
    /// No generator of this name.
    #[error("there is no field `{name}`{}", did_you_mean(*suggestion))]
    UnknownGenerator {
        /// Name given.
        name: String,
        /// A known name that resembles it.
        suggestion: Option<&'static str>,
    },
    /// A parameter the generator does not have.
    #[error("field `{generator}` has no parameter `{parameter}`: expected {}", known.join(", "))]
    UnknownParameter {
        /// Generator asked for.
        generator: &'static str,
        /// Key given.
        parameter: String,
        /// Keys it has.
        known: Vec<&'static str>,
    },
    /// A value that is not a number, not finite, or out of range.
    #[error("parameter `{parameter}` of field `{generator}` is `{text}`: expected {expected}")]
    InvalidValue {
        /// Generator asked for.
        generator: &'static str,
        /// Key.
        parameter: &'static str,
        /// Value given.
        text: String,
        /// The accepted values.
        expected: ParameterKind,
    },
    /// The same key twice.
    #[error("parameter `{parameter}` is given twice")]
    DuplicateParameter {
        /// Key.
        parameter: String,
    },
    /// A part of a field specification that is not `key=value`.
    #[error("`{part}` in `{text}` is not a parameter: expected NAME or NAME:key=value,key=value")]
    MalformedSpec {
        /// Offending part, possibly empty.
        part: String,
        /// Whole specification.
        text: String,
    },
    /// A side of a user-defined field outside 1 to [`crate::MAX_SIDE`].
    #[error("a field of {width} x {height} cells is not possible: expected 1 to {max} a side", max = crate::MAX_SIDE)]
    Side {
        /// Width given.
        width: usize,
        /// Height given.
        height: usize,
    },
    /// A grid core refuses.
    #[error(transparent)]
    Grid(#[from] CoreError),
    /// Sides that a resampled field may not have.
    #[error(
        "{width} x {height} cells: expected at most {} along each side and {} in all, before and after",
        crate::limits::MAX_RESAMPLED,
        crate::limits::MAX_RESAMPLED_CELLS
    )]
    ResampledSize {
        /// Columns asked for.
        width: usize,
        /// Rows asked for.
        height: usize,
    },
    /// An expression that cannot be read.
    #[error("expression `{expression}`: {error}")]
    Expression {
        /// Which one: `phi`, `s1`, `s2`, `xx`, `xy`, `yx` or `yy`.
        expression: &'static str,
        /// The error and its position.
        #[source]
        error: ExpressionError,
    },
    /// An expression whose value is not finite somewhere.
    #[error("expression `{expression}` = `{text}` is {value} in cell ({x}, {y}): expected a finite number")]
    NonFiniteValue {
        /// Which one.
        expression: &'static str,
        /// Its text.
        text: String,
        /// Column of the first such cell in row-major order.
        x: usize,
        /// Its row.
        y: usize,
        /// The value there.
        value: f64,
    },
    /// A semi-axis of negative length.
    #[error(
        "expression `{expression}` = `{text}` is {value} in cell ({x}, {y}): a semi-axis has a length of at least 0"
    )]
    NegativeAxis {
        /// Which one: `s1` or `s2`.
        expression: &'static str,
        /// Its text.
        text: String,
        /// Column of the first such cell in row-major order.
        x: usize,
        /// Its row.
        y: usize,
        /// The value there.
        value: f64,
    },
}
