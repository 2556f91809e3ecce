//! What is wrong with the header of a NIfTI file.

use thiserror::Error;

/// What is wrong with a NIfTI file, or keeps a volume from being one.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NiftiError {
    /// A field of a NIfTI header that makes no sense.
    #[error("byte {byte}: NIfTI field {field}: found {found}, expected {expected}")]
    Field {
        /// Where the field stands, in the unpacked file.
        byte: usize,
        /// Name of the field in the standard.
        field: &'static str,
        /// Its value.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
    /// More voxels along an axis than the format can say.
    #[error(
        "{} x {} x {} voxels do not fit into NIfTI-1: expected at most 32767 along each axis",
        size[0], size[1], size[2]
    )]
    Size {
        /// Voxels along each axis.
        size: [usize; 3],
    },
}
