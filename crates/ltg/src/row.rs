//! Differences and counters of one row while it is computed. Every number is written once, by any thread.

use crate::pass::Pass;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use tigereye_core::{StopReason, SweepWork};
use tigereye_transport::LaneOutcome;

/// The results of a row.
pub(crate) struct RowResults {
    /// `g_x` and `g_y` by position of the direction in the set.
    pub(crate) along_x: Differences,
    pub(crate) along_y: Differences,
    /// `g_w` by index of the angular difference in the set.
    pub(crate) turned: Differences,
    pub(crate) work: WorkCounter,
}

impl RowResults {
    pub(crate) fn new(pass: &Pass<'_>) -> Self {
        let differences = |lists: usize| Differences {
            columns: pass.columns.clone(),
            values: (0..lists * pass.columns.len()).map(|_| AtomicU64::new(0)).collect(),
        };
        let places = pass.set.directions.len();
        Self {
            along_x: differences(places),
            along_y: differences(places),
            turned: differences(pass.set.turns.len()),
            work: WorkCounter::default(),
        }
    }
}

/// A number for each column of several lists, as bits.
pub(crate) struct Differences {
    columns: Range<usize>,
    values: Vec<AtomicU64>,
}

impl Differences {
    fn at(&self, list: usize, x: usize) -> &AtomicU64 {
        &self.values[list * self.columns.len() + x - self.columns.start]
    }
    /// The end of a parallel loop makes writes visible to the waiting thread, so relaxed ordering suffices.
    pub(crate) fn set(&self, list: usize, x: usize, value: f64) {
        self.at(list, x).store(value.to_bits(), Ordering::Relaxed);
    }
    pub(crate) fn get(&self, list: usize, x: usize) -> f64 {
        f64::from_bits(self.at(list, x).load(Ordering::Relaxed))
    }
}

/// Counters that threads add to; integer addition does not depend on the order.
#[derive(Default)]
pub(crate) struct WorkCounter {
    sources: AtomicU64,
    iterations_total: AtomicU64,
    iterations_max: AtomicU64,
    cell_updates: AtomicU64,
    limited: AtomicU64,
}

impl WorkCounter {
    pub(crate) fn add(&self, outcomes: &[LaneOutcome]) {
        let sum = |of: &dyn Fn(&LaneOutcome) -> u64| outcomes.iter().map(of).sum();
        let longest = outcomes.iter().map(|o| o.work.steps as u64).max().unwrap_or(0);
        self.sources.fetch_add(outcomes.len() as u64, Ordering::Relaxed);
        self.iterations_total.fetch_add(sum(&|o| o.work.steps as u64), Ordering::Relaxed);
        self.iterations_max.fetch_max(longest, Ordering::Relaxed);
        self.cell_updates.fetch_add(sum(&|o| o.work.cell_updates), Ordering::Relaxed);
        self.limited.fetch_add(sum(&|o| u64::from(o.stop == StopReason::StepLimit)), Ordering::Relaxed);
    }

    /// The work, and the number of propagations that ended at the step limit.
    pub(crate) fn total(&self) -> (SweepWork, u64) {
        let work = SweepWork {
            sources: self.sources.load(Ordering::Relaxed),
            iterations_total: self.iterations_total.load(Ordering::Relaxed),
            iterations_max: self.iterations_max.load(Ordering::Relaxed),
            cell_updates: self.cell_updates.load(Ordering::Relaxed),
        };
        (work, self.limited.load(Ordering::Relaxed))
    }
}
