//! Waiting for other programs.

use std::time::{Duration, Instant};

/// The longest wait, which only keeps tests from hanging.
const PATIENCE: Duration = Duration::from_secs(120);

/// Waits until `is_so`; false if that takes too long.
pub fn eventually(mut is_so: impl FnMut() -> bool) -> bool {
    let start = Instant::now();
    while !is_so() {
        if start.elapsed() > PATIENCE {
            return false;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    true
}
