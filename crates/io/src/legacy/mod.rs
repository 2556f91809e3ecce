//! Legacy VTK files, `.vtk`, to [`ImageData`] and back.
//!
//! Read: versions 1 to 5.1, ASCII and BINARY (big-endian); STRUCTURED_POINTS, and STRUCTURED_GRID or RECTILINEAR_GRID
//! whose points form a lattice; all attributes of points and cells, arrays in FIELD, names of components in METADATA.
//! Arrays of bits, strings and variants are passed over. Refused with a specific message: other data sets.
//!
//! Written: version 3.0, BINARY, as STRUCTURED_POINTS, or as STRUCTURED_GRID where the axes are turned.
//!
//! Format: "VTK File Formats", The VTK User's Guide.

mod attributes;
mod cursor;
mod error;
mod geometry;
mod write;

pub use error::LegacyError;
pub use write::write;

use crate::{ImageData, IoError, Limits};
use cursor::Cursor;

/// Reads a file with the default [`Limits`].
///
/// # Errors
/// See [`read_with_limits`].
pub fn read(bytes: &[u8]) -> Result<ImageData, IoError> {
    read_with_limits(bytes, Limits::default())
}

/// Reads a file.
///
/// # Errors
/// Names the byte and what was expected there, or the array.
pub fn read_with_limits(bytes: &[u8], limits: Limits) -> Result<ImageData, IoError> {
    let mut cursor = Cursor::open(bytes, limits)?;
    let mut image = geometry::read(&mut cursor)?;
    attributes::read(&mut cursor, &mut image)?;
    Ok(image)
}
