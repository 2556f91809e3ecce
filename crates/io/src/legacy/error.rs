//! What is wrong with a legacy VTK file.

use thiserror::Error;

/// What is wrong with a legacy VTK file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LegacyError {
    /// A legacy VTK file with something else where its format has a fixed meaning.
    #[error("byte {byte}: found `{found}`, expected {expected}")]
    Word {
        /// Where.
        byte: usize,
        /// What is there, shortened.
        found: String,
        /// What should have been there.
        expected: &'static str,
    },
}
