//! gzip within limits: the output grows with what the stream yields and stops where enough is there.

use flate2::read::MultiGzDecoder;
use std::io::Read as _;
use thiserror::Error;

/// The first `most` bytes of a gzip stream that starts at `byte` of its file, or all of it where it is shorter.
pub(crate) fn gunzip(packed: &[u8], byte: usize, most: u64) -> Result<Vec<u8>, DataError> {
    let mut bytes = Vec::new();
    let read = MultiGzDecoder::new(packed).take(most).read_to_end(&mut bytes);
    read.map_err(|e| DataError::Gzip { byte, problem: e.to_string() })?;
    Ok(bytes)
}

/// Whether bytes begin as gzip does.
pub(crate) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// What is wrong with the bytes behind a header.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum DataError {
    /// Data that end too early.
    #[error("byte {byte}: the data are truncated: expected {needed} bytes, found {present}")]
    Truncated {
        /// Where the data start.
        byte: usize,
        /// Bytes that the header declares.
        needed: u128,
        /// Bytes there, after decompression.
        present: u64,
    },
    /// Corrupt compressed data.
    #[error("byte {byte}: expected gzip data: {problem}")]
    Gzip {
        /// Where they start.
        byte: usize,
        /// What the decompressor says.
        problem: String,
    },
}
