//! What can be wrong with a sweep's arguments.

use thiserror::Error;
use tigereye_transport::TransportError;

/// An argument a sweep cannot work with, or its interruption.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LtgError {
    /// The half-width of the angular difference is not in 1..=S/2.
    #[error("the angular step is {omega_step} samples: expected 1 to {}", directions / 2)]
    OmegaStep {
        /// Half-width asked for.
        omega_step: usize,
        /// Number of samples.
        directions: usize,
    },
    /// A slice that does not exist.
    #[error("slice {slice} does not exist: expected 0 to {}", directions - 1)]
    Slice {
        /// Slice asked for.
        slice: usize,
        /// Number of samples.
        directions: usize,
    },
    /// No slices at all.
    #[error("no slices: expected at least one")]
    NoSlices,
    /// The sweep does not fit.
    #[error(
        "the sweep needs at least {needed} bytes and may use {bound}: allow more memory or use a smaller field"
    )]
    Memory {
        /// Bytes of the smallest possible tile.
        needed: u128,
        /// Bytes allowed.
        bound: u64,
    },
    /// A stopping rule out of range.
    #[error(transparent)]
    Stopping(#[from] TransportError),
    /// The observer asked to end.
    #[error("interrupted after {done} of {total} sources")]
    Interrupted {
        /// Sources solved.
        done: u64,
        /// Sources of the whole sweep.
        total: u64,
    },
}
