//! Syntax errors of formulas, with their positions.

use crate::nearest::did_you_mean;
use thiserror::Error;

/// A problem in a formula.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("line {line}, column {column}: {kind}")]
pub struct ExpressionError {
    /// Line from 1.
    pub line: usize,
    /// Column in characters from 1.
    pub column: usize,
    /// The error.
    pub kind: ExpressionErrorKind,
}

/// An error in a formula.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ExpressionErrorKind {
    /// Something else is expected.
    #[error("found {found}, expected {expected}")]
    Unexpected {
        /// The text found.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// A name that is neither variable nor constant nor function.
    #[error("unknown name `{name}`{}; variables: {}", did_you_mean(suggestion.as_deref()), variables.join(", "))]
    UnknownName {
        /// The name.
        name: String,
        /// A known name that resembles it.
        suggestion: Option<String>,
        /// The variables there are.
        variables: Vec<String>,
    },
    /// A function's name without arguments.
    #[error("`{name}` is a function: expected `(` after it")]
    MissingArguments {
        /// The function.
        name: &'static str,
    },
    /// A variable or constant with arguments.
    #[error("`{name}` is not a function; write `*` for a product")]
    NotAFunction {
        /// The name.
        name: String,
    },
    /// Too few or too many arguments.
    #[error("`{name}` takes {expected}, not {found}")]
    ArgumentCount {
        /// The function.
        name: &'static str,
        /// How many it takes, in words.
        expected: &'static str,
        /// How many there are.
        found: usize,
    },
    /// A comparison of a comparison.
    #[error("comparisons do not chain: write `a < b && b < c`")]
    ChainedComparison,
    /// A number that is too large for an `f64`, or not written as one.
    #[error("`{text}` is not a number")]
    Number {
        /// The text found.
        text: String,
    },
    /// A character that means nothing.
    #[error("unknown character {character:?}")]
    Character {
        /// The character.
        character: char,
    },
    /// A formula of more than [`crate::limits::MAX_LENGTH`] characters.
    #[error("the expression has {length} characters: expected at most {}", crate::limits::MAX_LENGTH)]
    TooLong {
        /// Its length.
        length: usize,
    },
    /// A formula nested deeper than [`crate::limits::MAX_NESTING`].
    #[error("nested too deeply: expected at most {} levels", crate::limits::MAX_NESTING)]
    TooDeep,
}
