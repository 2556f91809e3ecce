//! What is wrong with a `.part` file.

use thiserror::Error;

/// What is wrong with a `.part` file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PartError {
    /// A `.part` file with something else where its format has a fixed meaning.
    #[error("byte {byte}: expected {expected}")]
    Field {
        /// Where.
        byte: usize,
        /// What should have been there.
        expected: &'static str,
    },
    /// A `.part` file of a format that is not read.
    #[error("byte {byte}: version {found} of the format: expected {expected}")]
    Version {
        /// Where the version stands.
        byte: usize,
        /// The version found.
        found: u32,
        /// The version that is read.
        expected: u32,
    },
    /// A `.part` file of another length than its sizes add up to.
    #[error("byte {byte}: the file has {present} bytes, expected {declared}")]
    Length {
        /// Where the file ends, or where it should have ended.
        byte: usize,
        /// Length of the file.
        present: usize,
        /// Length as declared.
        declared: u128,
    },
    /// A `.part` file that was changed.
    #[error("byte {byte}: expected the checksum of everything before it: the file is damaged")]
    Checksum {
        /// Where the checksum stands.
        byte: usize,
    },
}
