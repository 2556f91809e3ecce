//! VTK XML image data, `.vti`.
//!
//! Read: text, inline base64 and appended data in base64 or raw; headers of 32 and 64 bits in both byte orders; no
//! compression, zlib or LZ4; all number types of up to 64 bits, and strings in the field data. Arrays of bits and
//! strings at points and cells are passed over. Refused with a specific message: LZMA, several pieces, time steps.
//!
//! Written: appended raw data in zlib blocks behind 64-bit little-endian headers, as ParaView reads them back. The same
//! image always gives the same bytes.

mod read;
mod write;

pub use read::{read, read_with_limits};
pub use write::write;
