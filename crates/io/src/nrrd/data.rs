//! The numbers of an NRRD file.

use super::header::{Encoding, Header};
use crate::IoError;
use crate::inflate::{DataError, gunzip};
use crate::words::numbers_in_text;

/// Most bytes that a gzip stream may hold before the numbers.
const MAX_SKIP: u64 = 1 << 20;

/// Decodes the numbers; `start` is the place of `data` in its file.
pub(super) fn read(header: &Header, data: &[u8], start: usize) -> Result<Vec<f64>, IoError> {
    let (mut rest, mut start) = (data, start);
    for _ in 0..header.line_skip {
        let Some(end) = rest.iter().position(|&b| b == b'\n') else {
            return Err(header
                .fault("line skip", &header.line_skip.to_string(), "as many lines in the data")
                .into());
        };
        rest = &rest[end + 1..];
        start += end + 1;
    }
    if header.encoding == Encoding::Text {
        let skip = usize::try_from(header.byte_skip.unwrap_or(0)).unwrap_or(usize::MAX);
        let text = rest.get(skip..).ok_or_else(|| truncated(start, skip as u128, rest))?;
        return Ok(numbers_in_text(text, start + skip, header.scalar, header.count)?);
    }
    let bytes = u128::from(header.count) * header.scalar.bytes() as u128;
    let unpacked;
    if header.encoding == Encoding::Gzip {
        let skip = header.byte_skip.unwrap_or(0);
        if skip > MAX_SKIP {
            return Err(header.fault("byte skip", &skip.to_string(), "at most a megabyte").into());
        }
        // The count is within the limits, so this does not overflow.
        unpacked = gunzip(rest, start, skip + bytes as u64)?;
        rest = &unpacked;
    }
    let skip = match header.byte_skip {
        Some(skip) => u128::from(skip),
        None => (rest.len() as u128).saturating_sub(bytes),
    };
    if (rest.len() as u128) < skip + bytes {
        return Err(truncated(start, skip + bytes, rest).into());
    }
    let skip = skip as usize;
    Ok(header.scalar.decode(header.order, &rest[skip..skip + bytes as usize]))
}

fn truncated(byte: usize, needed: u128, rest: &[u8]) -> DataError {
    DataError::Truncated { byte, needed, present: rest.len() as u64 }
}
