//! Delta pulses of one cell in many directions at once, from which the light transport gradient is computed.
//!
//! The propagations share the field and the window, so a cell's numbers are loaded once for all, and they stop at
//! nearly the same step. A lane that has stopped keeps running until the last one has, but its light is recorded when
//! it stops, so the numbers are those of separate propagations, bit for bit.

mod difference;
mod memory;
mod passage;
mod run;
mod sector_sums;
mod solver;
mod source;
mod stationary;
mod stream;
#[cfg(test)]
mod tests;
mod walls;

pub use difference::l1_difference;
pub use solver::{LaneOutcome, PulseSolver};

pub(crate) use passage::Passage;
pub(crate) use sector_sums::SectorSums;
pub(crate) use walls::Walls;

use crate::Real;
use crate::aligned::Aligned;
use crate::window::Window;
use tigereye_core::Cell;

/// The light of one pulse: eight fluxes per cell, `lobes[cell][direction]`, W, row-major.
///
/// The pulse's own sample counts as 0 in its source cell.
#[derive(Debug)]
pub struct PulseDistribution<T> {
    numbers: Aligned<T>,
    source: Cell,
    sample: usize,
    /// Light lies only inside this window; empty before the first write.
    window: Option<Window>,
}

impl<T: Real> PulseDistribution<T> {
    /// A dark distribution of `cells` cells.
    #[must_use]
    pub fn dark(cells: usize) -> Self {
        Self { numbers: Aligned::zeros(8 * cells), source: Cell::new(0, 0), sample: 0, window: None }
    }
    /// Size of a distribution over `cells` cells, bytes.
    #[must_use]
    pub const fn bytes(cells: usize) -> u128 {
        (cells * 8 * size_of::<T>()) as u128 + 64
    }
    /// The fluxes.
    #[must_use]
    pub fn lobes(&self) -> &[[T; 8]] {
        self.numbers.as_slice().as_chunks().0
    }
    /// Clears the light outside `window`, all of whose cells are about to be written.
    pub(crate) fn keep(&mut self, width: usize, window: Window) {
        let Some(old) = self.window.replace(window) else {
            // Nothing is lit. Written all the same: memory that is read before it is written costs the system two
            // visits, the second of which stops all threads.
            self.lobes_mut().fill([T::default(); 8]);
            return;
        };
        for y in old.y0..=old.y1 {
            let row = &mut self.lobes_mut()[y * width..][..width];
            let kept = if (window.y0..=window.y1).contains(&y) { window.x0..window.x1 + 1 } else { 0..0 };
            let left = old.x0..kept.start.clamp(old.x0, old.x1 + 1);
            let right = kept.end.clamp(old.x0, old.x1 + 1)..old.x1 + 1;
            row[left].fill([T::default(); 8]);
            row[right].fill([T::default(); 8]);
        }
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
