//! What an experiment needs from outside.

use std::ops::ControlFlow;
use tigereye_transport::Level;

/// The world as experiments see it. The program implements it with files, a clock and a progress bar.
pub trait Host: Sync {
    /// Bytes of a data file that an experiment names.
    ///
    /// # Errors
    /// A sentence saying where it was looked for.
    fn read(&self, path: &str) -> Result<Vec<u8>, String>;

    /// Whether there is such a file.
    fn has(&self, path: &str) -> bool {
        self.read(path).is_ok()
    }

    /// Something was assumed about a data file, or looks wrong.
    fn remark(&self, _words: &str) {}

    /// Seconds on a clock that only goes forward, for runtimes in figures; they enter no check and no snapshot.
    fn seconds(&self) -> f64 {
        0.0
    }

    /// The instruction set for sweeps; results do not depend on it.
    fn level(&self) -> Level {
        Level::detect()
    }

    /// Something happens: `done` of `total` parts of `what`. `Break` ends the experiment.
    fn progress(&self, _what: &str, _done: u64, _total: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// A function that reads files is a host without clock and progress.
impl<F: Fn(&str) -> Result<Vec<u8>, String> + Sync> Host for F {
    fn read(&self, path: &str) -> Result<Vec<u8>, String> {
        self(path)
    }
}
