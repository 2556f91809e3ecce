//! Ctrl-C: the first asks the task to end, the second ends it.

use crate::error::Fault;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Installs the handler, which calls `clear` before it ends the process at once.
pub(crate) fn install(clear: fn()) -> Result<(), Fault> {
    ctrlc::set_handler(move || {
        if ASKED.swap(true, Ordering::SeqCst) {
            clear();
            std::process::exit(130);
        }
    })?;
    Ok(())
}

/// Whether the user has interrupted the task.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// An error if the user has interrupted the task.
pub(crate) fn check() -> Result<(), Fault> {
    if asked() { Err(Fault::Interrupted) } else { Ok(()) }
}
