//! Faults of the libraries as Python's exceptions, in the program's words.

use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError, PyOSError, PyRuntimeError, PyValueError};
use std::fmt::Display;
use tigereye_input::InputError;
use tigereye_ltg::LtgError;

/// What went wrong in work that runs without the interpreter.
#[derive(Debug)]
pub(crate) enum Fault {
    /// A value that was given: `ValueError`.
    Value(String),
    /// A file: `OSError`.
    File(String),
    /// Too little memory: `MemoryError`.
    Memory(String),
    /// The caller asked to end: `KeyboardInterrupt`, unless Python has raised another exception already.
    Interrupted,
    /// A fault of the program itself: `RuntimeError`.
    Program(String),
}

impl Fault {
    /// A fault of the value of an option.
    pub(crate) fn option(name: &str, problem: impl Display) -> Self {
        Self::Value(format!("{name}: {problem}"))
    }

    /// A fault of the input.
    pub(crate) fn input(name: &str, error: InputError) -> Self {
        match error {
            InputError::Unread { words } => Self::File(words),
            other => Self::Value(format!("{name}: {other}")),
        }
    }

    /// A fault of a sweep; the names are those of the options.
    pub(crate) fn sweep(error: LtgError) -> Self {
        match error {
            LtgError::Interrupted { .. } => Self::Interrupted,
            LtgError::Memory { .. } => Self::Memory(format!("memory: {error}")),
            LtgError::OmegaStep { .. } => Self::option("omega_step", error),
            LtgError::Slice { .. } | LtgError::NoSlices => Self::option("slices", error),
            LtgError::Stopping(_) => Self::option("threshold", error),
            other => Self::Value(other.to_string()),
        }
    }
}

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Value(words) => PyValueError::new_err(words),
            Fault::File(words) => PyOSError::new_err(words),
            Fault::Memory(words) => PyMemoryError::new_err(words),
            Fault::Interrupted => PyKeyboardInterrupt::new_err(()),
            Fault::Program(words) => PyRuntimeError::new_err(words),
        }
    }
}
