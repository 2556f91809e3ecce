//! Errors of volumes and of the options of an extraction.

use thiserror::Error;

/// Largest number of samples from which ridges and contours are extracted.
pub(crate) const MAX_SAMPLES: usize = 1 << 28;

/// A volume or an option outside its range.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ExtractionError {
    /// A volume needs at least one sample and at most `MAX_SAMPLES`.
    #[error("a volume of {} x {} x {} samples is not possible: expected 1 to {max}", size[0], size[1], size[2], max = MAX_SAMPLES)]
    VolumeSize {
        /// Samples along each axis.
        size: [usize; 3],
    },
    /// The number of values is not the number of samples.
    #[error("{values} values for a volume of {samples} samples: expected one each")]
    ValueCount {
        /// Values given.
        values: usize,
        /// Samples of the volume.
        samples: usize,
    },
    /// The slices of a gradient are not equally spaced.
    #[error(
        "the slices of the gradient are not equally far from each other: slice {slice} where {expected} is expected"
    )]
    UnevenSlices {
        /// The first slice out of step.
        slice: usize,
        /// The slice expected there.
        expected: usize,
    },
    /// An option outside its range.
    #[error("{option} is {value}: expected {expected}")]
    Option {
        /// Name of the option.
        option: &'static str,
        /// Its value.
        value: f64,
        /// The accepted values.
        expected: &'static str,
    },
    /// The refined mesh would have too many nodes.
    #[error("{samples_per_cell} samples per cell give a mesh of {nodes} nodes: expected at most {most}")]
    MeshSize {
        /// Samples per cell requested.
        samples_per_cell: usize,
        /// Nodes of the resulting mesh.
        nodes: u128,
        /// Most nodes allowed.
        most: usize,
    },
}
