//! What is wrong with the header of an NRRD file.

use thiserror::Error;

/// What is wrong with the header of an NRRD file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NrrdError {
    /// Diffusion-weighted images where tensors were expected.
    #[error(
        "line {line}: these are diffusion-weighted images: expected tensors, as `tend estim` of teem or `DWIToDTIEstimation` of 3D Slicer fit them"
    )]
    Weighted {
        /// The line that says so.
        line: usize,
    },
    /// A field of an NRRD header that is missing or makes no sense.
    #[error("line {line}: NRRD field `{field}`: found `{found}`, expected {expected}")]
    Field {
        /// Line, from 1; that of the header's end for a missing field.
        line: usize,
        /// Name of the field.
        field: &'static str,
        /// Its value, shortened.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
}
