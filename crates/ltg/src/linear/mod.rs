//! The gradient of the linear scheme, in which every photon goes its own way.
//!
//! Light superposes, so all pulses of a cell are combinations of the responses to its eight lobes: the exact gradient
//! ([`linear_sweep_part`]) needs eight solutions a cell instead of S. And the L1 norms of the gradient can be estimated
//! from the answers of the whole field to random receivers ([`SketchedGradient`]): some hundred solutions in all.

mod estimate;
mod exact;
mod logarithms;
mod pulses;
mod random;
mod sketch;

pub use estimate::{Estimate, SketchSums};
pub use exact::{check_linear_fit, linear_sweep_part};
pub use sketch::{FEWEST_SKETCHES, MOST_SKETCHES, SketchObserver, SketchSettings, SketchedGradient};

use rayon::prelude::*;
use tigereye_transport::Parallel;

/// Rayon's current thread pool.
pub(crate) struct Pool;

impl Parallel for Pool {
    fn for_each(&self, count: usize, task: &(dyn Fn(usize) + Sync)) {
        (0..count).into_par_iter().with_max_len(1).for_each(task);
    }
}
