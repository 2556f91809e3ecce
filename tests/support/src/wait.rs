//! Waiting for other programs.

use std::time::{Duration, Instant};

/// How long is waited. It only keeps tests from hanging: whatever is waited for may take its time.
const PATIENCE: Duration = Duration::from_secs(120);

/// Waits until `is_so`; false where it never is.
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
