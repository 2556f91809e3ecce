//! Threads for what the propagation leaves to its caller.

use rayon::prelude::*;
use tigereye_transport::Parallel;

/// Rayon's current thread pool.
pub(crate) struct Pool;

impl Parallel for Pool {
    fn for_each(&self, count: usize, task: &(dyn Fn(usize) + Sync)) {
        (0..count).into_par_iter().with_max_len(1).for_each(task);
    }
}
