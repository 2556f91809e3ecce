//! gzip within limits: the output grows with what the stream yields and stops where enough is there.

use crate::IoError;
use flate2::read::MultiGzDecoder;
use std::io::Read as _;

/// The first `most` bytes of a gzip stream that starts at `byte` of its file, or all of it where it is shorter.
pub(crate) fn gunzip(packed: &[u8], byte: usize, most: u64) -> Result<Vec<u8>, IoError> {
    let mut bytes = Vec::new();
    let read = MultiGzDecoder::new(packed).take(most).read_to_end(&mut bytes);
    read.map_err(|e| IoError::Gzip { byte, problem: e.to_string() })?;
    Ok(bytes)
}

/// Whether bytes begin as gzip does.
pub(crate) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}
