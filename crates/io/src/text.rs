//! Errors in text data, and text of files for messages.

use thiserror::Error;

/// What is wrong with text data, whatever the format.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TextError {
    /// A text without any number.
    #[error("line 1: expected rows of numbers, found none (an empty file, or words alone)")]
    Empty,
    /// A word that is not a number.
    #[error("line {line}, column {column}: expected a number, found `{found}`")]
    NotANumber {
        /// Line, from 1.
        line: usize,
        /// Column of the word, from 1.
        column: usize,
        /// The word, shortened.
        found: String,
    },
    /// A number that is not finite.
    #[error("line {line}, column {column}: expected a finite number, found `{found}`")]
    NotFinite {
        /// Line, from 1.
        line: usize,
        /// Column of the word, from 1.
        column: usize,
        /// The word, shortened.
        found: String,
    },
    /// A row with more or fewer numbers than the first.
    #[error("line {line}, column {column}: expected {expected} numbers as in line 1, found {found}")]
    RaggedRow {
        /// Line, from 1.
        line: usize,
        /// Column of the first number too many, or where the next was expected.
        column: usize,
        /// Numbers in this row.
        found: usize,
        /// Numbers in the first row.
        expected: usize,
    },
    /// A word in text data that is not a number of its type, or missing.
    #[error("byte {byte}: found `{found}`, expected a {scalar} number")]
    Word {
        /// Where.
        byte: usize,
        /// The word, shortened; empty at the end.
        found: String,
        /// Type of the numbers.
        scalar: &'static str,
    },
}

/// At most 40 characters of something found in a file, for messages.
pub(crate) fn shortened(bytes: &[u8]) -> String {
    const LENGTH: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * LENGTH)]);
    let mut short: String =
        text.chars().take(LENGTH).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().nth(LENGTH).is_some() {
        short.push_str("...");
    }
    short
}
