//! Delta pulses of one cell in many directions at once: what the light transport gradient is made of.
//!
//! The propagations share the field and the window, so a cell's numbers are loaded once for all, and they stop at nearly
//! the same step. A lane that has stopped keeps computing unseen until the last one has; its light was taken when it
//! stopped, so the numbers are those of separate propagations, bit for bit.

mod difference;
mod passage;
mod solver;
mod source;
mod stationary;
mod stream;
#[cfg(test)]
mod tests;

pub use difference::l1_difference;
pub use solver::{LaneOutcome, PulseSolver};

pub(crate) use difference::SectorSums;
pub(crate) use passage::Passage;
pub(crate) use solver::Run;

use crate::Real;
use crate::aligned::Aligned;
use tigereye_core::Cell;

/// The light of one pulse: eight fluxes a cell, `lobes[cell][direction]`, W, row-major.
///
/// The pulse's own sample counts as 0 in its source cell.
#[derive(Debug)]
pub struct PulseDistribution<T> {
    numbers: Aligned<T>,
    source: Cell,
    sample: usize,
}

impl<T: Real> PulseDistribution<T> {
    /// No light in `cells` cells.
    #[must_use]
    pub fn dark(cells: usize) -> Self {
        Self { numbers: Aligned::zeros(8 * cells), source: Cell::new(0, 0), sample: 0 }
    }
    /// Bytes a distribution over `cells` cells takes.
    #[must_use]
    pub const fn bytes(cells: usize) -> u128 {
        (cells * 8 * size_of::<T>()) as u128 + 64
    }
    /// The fluxes.
    #[must_use]
    pub fn lobes(&self) -> &[[T; 8]] {
        self.numbers.as_slice().as_chunks().0
    }
    pub(crate) fn lobes_mut(&mut self) -> &mut [[T; 8]] {
        self.numbers.as_mut_slice().as_chunks_mut().0
    }
    /// The cell of the pulse.
    #[must_use]
    pub const fn source(&self) -> Cell {
        self.source
    }
    /// The sample of the pulse.
    #[must_use]
    pub const fn sample(&self) -> usize {
        self.sample
    }
}

impl<T: Real> Clone for PulseDistribution<T> {
    fn clone(&self) -> Self {
        Self { numbers: self.numbers.clone(), ..*self }
    }
}
