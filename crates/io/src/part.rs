//! Parts of a gradient volume: what a shard leaves, and the checkpoints of a sweep.
//!
//! ```text
//!      0   8 bytes   "tigerprt"
//!      8   u32       version of the format, 1
//!     12   u32       0
//!     16   u64       h, bytes of the header
//!     24   u64       v, number of values
//!     32   u64       m, number of marks
//!     40   h bytes   header, a JSON object in UTF-8
//!          8v bytes  values, f64
//!          m/8 bytes marks, rounded up to whole bytes, the lowest bit of a byte first; unused bits are 0
//!          32 bytes  BLAKE3 of everything before
//! ```
//!
//! Everything is little-endian and the file ends with the checksum. What the numbers mean belongs to the sweep: the
//! values are sums of squared differences and the marks say for each set of directions and each inner cell whether its
//! differences are in them. The header tells what determines both.

mod error;
pub use error::PartError;

/// First bytes of a file.
const MAGIC: &[u8; 8] = b"tigerprt";
const VERSION: u32 = 1;
/// Bytes in front of the header.
const START: usize = 40;
const CHECKSUM: usize = blake3::OUT_LEN;

/// A part as read.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// JSON text.
    pub header: String,
    /// All values.
    pub values: Vec<f64>,
    /// All marks.
    pub marks: Vec<bool>,
}

/// Where the header stands in a file, for messages about it.
pub const HEADER_START: usize = START;

/// Writes a part.
#[must_use]
pub fn write(header: &str, values: &[f64], marks: &[bool]) -> Vec<u8> {
    let mut bytes =
        Vec::with_capacity(START + header.len() + 8 * values.len() + marks.len().div_ceil(8) + CHECKSUM);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(&[0; 4]);
    for size in [header.len(), values.len(), marks.len()] {
        bytes.extend_from_slice(&(size as u64).to_le_bytes());
    }
    bytes.extend_from_slice(header.as_bytes());
    bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    let packed = |marks: &[bool]| marks.iter().enumerate().fold(0, |byte, (i, &m)| byte | u8::from(m) << i);
    bytes.extend(marks.chunks(8).map(packed));
    let checksum = blake3::hash(&bytes);
    bytes.extend_from_slice(checksum.as_bytes());
    bytes
}

/// Reads a part. Sizes are compared with the bytes there before anything is allocated.
///
/// # Errors
/// [`PartError::Field`], [`PartError::Version`], [`PartError::Length`], [`PartError::Checksum`].
pub fn read(bytes: &[u8]) -> Result<Part, PartError> {
    if !bytes.starts_with(MAGIC) {
        return Err(PartError::Field { byte: 0, expected: "`tigerprt`, the first bytes of a part" });
    }
    let truncated =
        PartError::Length { byte: bytes.len(), present: bytes.len(), declared: (START + CHECKSUM) as u128 };
    let start: &[u8; START] = bytes.first_chunk().ok_or(truncated)?;
    let version = u32::from_le_bytes([start[8], start[9], start[10], start[11]]);
    if version != VERSION {
        return Err(PartError::Version { byte: 8, found: version, expected: VERSION });
    }
    if start[12..16] != [0; 4] {
        return Err(PartError::Field { byte: 12, expected: "four zero bytes" });
    }
    let size = |at: usize| start[at..at + 8].iter().rev().fold(0_u64, |n, &b| n << 8 | u64::from(b));
    let [header, values, marks] = [16, 24, 32].map(|at| u128::from(size(at)));
    let declared = (START + CHECKSUM) as u128 + header + 8 * values + marks.div_ceil(8);
    if declared != bytes.len() as u128 {
        let byte = usize::try_from(declared).map_or(bytes.len(), |d| d.min(bytes.len()));
        return Err(PartError::Length { byte, present: bytes.len(), declared });
    }
    let (content, checksum) = bytes.split_at(bytes.len() - CHECKSUM);
    if blake3::hash(content).as_bytes() != checksum {
        return Err(PartError::Checksum { byte: content.len() });
    }
    // All sizes are below that of the file now.
    let (header, rest) = content[START..].split_at(header as usize);
    let (values, packed) = rest.split_at(8 * values as usize);
    let header = std::str::from_utf8(header)
        .map_err(|e| PartError::Field { byte: START + e.valid_up_to(), expected: "a header in UTF-8" })?;
    let number = |b: &[u8; 8]| f64::from_le_bytes(*b);
    let (values, _) = values.as_chunks();
    let count = marks as usize;
    let mut marks: Vec<bool> =
        packed.iter().flat_map(|byte| (0..8).map(move |i| byte >> i & 1 == 1)).collect();
    if marks[count..].contains(&true) {
        let byte = content.len() - 1;
        return Err(PartError::Field { byte, expected: "zeros in the bits behind the last mark" });
    }
    marks.truncate(count);
    Ok(Part { header: header.to_owned(), values: values.iter().map(number).collect(), marks })
}
