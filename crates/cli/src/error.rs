//! What the program tells people when something is wrong.

use thiserror::Error;
use tigereye_report::shortened;

/// A fault that ends the program. One clear message each, with the place and what was expected.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// Input or usage that cannot work.
    #[error("{}", shortened(.0))]
    Input(String),
    /// Several faults in experiment files, one line each.
    #[error("{}", .0.join("\ntigereye: "))]
    Inputs(Vec<String>),
    /// A file that cannot be read or written.
    #[error("{path}: {action} failed: {source}")]
    File {
        /// The file.
        path: String,
        /// What was tried.
        action: &'static str,
        /// Why it failed.
        source: std::io::Error,
    },
    /// Ctrl-C.
    #[error("interrupted; nothing half-written remains")]
    Interrupted,
    /// Ctrl-C, with a checkpoint to go on from.
    #[error("interrupted; progress saved in {checkpoint}: run the same command to continue")]
    Resumable {
        /// The checkpoint's file.
        checkpoint: String,
    },
}

impl From<tigereye_report::review::ReviewError> for CliError {
    fn from(error: tigereye_report::review::ReviewError) -> Self {
        Self::Input(error.to_string())
    }
}

impl CliError {
    /// 130 for an interruption, 2 otherwise.
    pub(crate) const fn exit_code(&self) -> u8 {
        match self {
            Self::Interrupted | Self::Resumable { .. } => 130,
            _ => 2,
        }
    }

    /// An input fault about something called `subject`.
    pub(crate) fn input(subject: &str, problem: impl std::fmt::Display) -> Self {
        Self::Input(format!("{}: {}", shortened(subject), shortened(&problem.to_string())))
    }
}
