//! Errors of a sweep.

use thiserror::Error;
use tigereye_transport::TransportError;

/// An invalid argument, parts that do not belong together, or an interruption.
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
    #[error("slice {slice} does not exist: expected a sample index from 0 to {}; 90 degrees are slice {}", directions - 1, directions / 4)]
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
    /// A stored value that no gradient can have.
    #[error("value {index} is {value}: expected a finite number from 0")]
    Value {
        /// Index into the values.
        index: usize,
        /// The value.
        value: f64,
    },
    /// Too few sketches to say anything, or more than are worth their time.
    #[error("{sketches} sketches: expected 16 to 1048576; for a smaller error, compute the exact gradient")]
    Sketches {
        /// How many were asked for, or would be needed.
        sketches: u64,
    },
    /// An estimate from nothing.
    #[error("no sketch is finished: expected at least one batch")]
    NoSketches,
    /// A stored sum that is not a whole number.
    #[error("sum {index} is {value}: expected a whole number below 2^53")]
    Sum {
        /// Index into the sums.
        index: usize,
        /// What is there.
        value: f64,
    },
    /// Sketches in both of two parts.
    #[error("sketches {first} to {last} are in both parts")]
    SketchedTwice {
        /// First of a batch.
        first: usize,
        /// Last of it.
        last: usize,
    },
    /// A stopping rule out of range, or a field without a stationary state.
    #[error(transparent)]
    Stopping(#[from] TransportError),
    /// A shard that does not exist.
    #[error("shard {index}/{count} does not exist: expected K/N with K from 0 to N-1")]
    Shard {
        /// Shard asked for, from 0.
        index: usize,
        /// Number of shards.
        count: usize,
    },
    /// Partial volumes of different sweeps.
    #[error("the partial volumes differ in their {what}")]
    Unlike {
        /// The property that differs.
        what: &'static str,
    },
    /// A partial volume whose lists do not have the lengths that its shape needs.
    #[error("a partial volume has {found} {what}: expected {expected}")]
    Length {
        /// The contents of the list.
        what: &'static str,
        /// Actual length.
        found: usize,
        /// Expected length.
        expected: u128,
    },
    /// Work that is finished in both of two partial volumes.
    #[error("cell ({x}, {y}) is finished twice in the set of direction {direction} ({count} times in all)")]
    DoneTwice {
        /// Column of the first such cell.
        x: usize,
        /// Row of the first such cell.
        y: usize,
        /// First direction of its set.
        direction: usize,
        /// Number of cells and sets that are finished twice.
        count: usize,
    },
    /// A volume that is not finished.
    #[error(
        "cell ({x}, {y}) is missing in the set of direction {direction} ({count} of {total} cells and sets are)"
    )]
    Missing {
        /// Column of the first missing cell.
        x: usize,
        /// Row of the first missing cell.
        y: usize,
        /// First direction of its set.
        direction: usize,
        /// Number of cells and sets that are missing.
        count: usize,
        /// Number of cells and sets in all.
        total: usize,
    },
    /// The observer ended the sweep.
    #[error("interrupted after {done} of {total} sources")]
    Interrupted {
        /// Sources solved.
        done: u64,
        /// Sources of the whole sweep.
        total: u64,
    },
}
