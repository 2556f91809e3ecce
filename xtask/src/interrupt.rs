//! Ctrl-C: the first asks the task to end, the second ends it.

use crate::error::Fault;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Installs the handler; where the process ends at once, it calls `clear` before.
pub(crate) fn install(clear: fn()) -> Result<(), Fault> {
    ctrlc::set_handler(move || {
        if ASKED.swap(true, Ordering::SeqCst) {
            clear();
            std::process::exit(130);
        }
    })?;
    Ok(())
}

/// Whether the user asked to end.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// An error where the user asked to end.
pub(crate) fn check() -> Result<(), Fault> {
    if asked() { Err(Fault::Interrupted) } else { Ok(()) }
}
