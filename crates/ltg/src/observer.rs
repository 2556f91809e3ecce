//! Who watches a sweep.

use crate::PartialVolume;
use std::ops::ControlFlow;

/// What a thread of the sweep is busy with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// It solves pulses.
    Propagation,
    /// It compares distributions.
    Difference,
}

/// Somebody who watches a sweep.
pub trait SweepObserver: Sync {
    /// The calling thread turns to another phase, or to nothing. Called from all threads of the sweep; the last call of
    /// every piece of work is `None`.
    fn busy(&self, _with: Option<Phase>) {}
    /// `done` of `total` sources are solved, those of an earlier run and those solved again for the rim of a tile among
    /// them. Called from all threads of the sweep. `Break` ends the sweep at the next source.
    fn progress(&self, _done: u64, _total: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// More is finished, or the sweep is being interrupted. Called after a row, from the thread that called the sweep,
    /// while nothing else runs. `Break` ends the sweep.
    fn finished(&self, _volume: &PartialVolume) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Watches nothing.
impl SweepObserver for () {}
