//! Ctrl-C: the first asks the computation to end, the second ends the program.

use crate::error::CliError;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
/// Whether the first one ends the program: nobody asks before the end.
static AT_ONCE: AtomicBool = AtomicBool::new(false);

/// Installs the handler; where the program ends at once, it calls `clear` before.
pub(crate) fn install(clear: fn()) -> Result<(), CliError> {
    ctrlc::set_handler(move || {
        if ASKED.swap(true, Ordering::SeqCst) || AT_ONCE.load(Ordering::SeqCst) {
            clear();
            std::process::exit(130);
        }
    })
    .map_err(|e| CliError::Input(format!("cannot watch for interrupts: {e}")))
}

/// From now on the first interrupt ends the program, because what it does does not ask. Files that are being written
/// are removed.
pub(crate) fn end_at_once() {
    AT_ONCE.store(true, Ordering::SeqCst);
}

/// Whether the user asked to end.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// An error where the user asked to end.
pub(crate) fn check() -> Result<(), CliError> {
    if asked() { Err(CliError::Interrupted) } else { Ok(()) }
}
