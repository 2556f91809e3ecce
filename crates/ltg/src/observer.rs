//! Observers of a sweep.

use crate::PartialVolume;
use std::ops::ControlFlow;

/// The activity of a thread of the sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Solving pulses.
    Propagation,
    /// Comparing distributions.
    Difference,
}

/// Receives the progress of a sweep and may end it.
pub trait SweepObserver: Sync {
    /// The calling thread enters another phase, or `None`. Called from all threads of the sweep; the last call of each
    /// task is `None`.
    fn busy(&self, _with: Option<Phase>) {}
    /// `done` of `total` sources are solved, including those of an earlier run and those solved again at the border of
    /// a tile. Called from all threads of the sweep. `Break` ends the sweep at the next source.
    fn progress(&self, _done: u64, _total: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// More work is finished, or the sweep is being interrupted. Called after a row, on the thread that started the
    /// sweep, while no other thread runs. `Break` ends the sweep.
    fn finished(&self, _volume: &PartialVolume) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// An observer that does nothing.
impl SweepObserver for () {}
