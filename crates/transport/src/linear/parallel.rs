//! Work that may be spread over threads.

/// Runs independent tasks, side by side or one after the other. This crate starts no threads: who calls it decides.
pub trait Parallel: Sync {
    /// Calls `task` with each of `0..count` once and returns when all have returned. Results must not depend on the
    /// order.
    fn for_each(&self, count: usize, task: &(dyn Fn(usize) + Sync));
}

/// One task after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Serial;

impl Parallel for Serial {
    fn for_each(&self, count: usize, task: &(dyn Fn(usize) + Sync)) {
        (0..count).for_each(task);
    }
}
