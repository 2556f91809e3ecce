//! Errors of tasks.

use std::path::Path;
use std::process::ExitStatus;
use thiserror::Error;
use tigereye_report::review::ReviewError;

/// A fault that ends a task.
#[derive(Debug, Error)]
pub(crate) enum Fault {
    /// Neither a revision nor a folder of results.
    #[error("{name}: is neither a git revision nor a folder with a summary.json: expected either")]
    Unknown { name: String },
    /// An experiment that neither side has.
    #[error("--only {slug}: no such experiment in {base} or {head}")]
    NoExperiment { slug: String, base: String, head: String },
    /// A file or folder that cannot be read or written.
    #[error("{path}: {action} failed: {source}")]
    File { path: String, action: &'static str, source: std::io::Error },
    /// A program that cannot be started, or waited for.
    #[error("cannot run {program}: {source}")]
    NotRun { program: String, source: std::io::Error },
    /// A program that ended with an exit code other than the expected ones.
    #[error("{name}: `{command}` ended with {status}")]
    Ended { name: String, command: String, status: ExitStatus },
    /// Results that cannot be compared.
    #[error(transparent)]
    Review(#[from] ReviewError),
    /// The handler of Ctrl-C cannot be installed.
    #[error("cannot watch for interrupts: {0}")]
    Watch(#[from] ctrlc::Error),
    /// Ctrl-C.
    #[error("interrupted; nothing half-written remains")]
    Interrupted,
}

impl Fault {
    /// 130 for an interruption, 2 otherwise.
    pub(crate) const fn exit_code(&self) -> u8 {
        match self {
            Self::Interrupted => 130,
            _ => 2,
        }
    }

    /// What went wrong with a file.
    pub(crate) fn file(path: &Path, action: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.display().to_string();
        move |source| Self::File { path, action, source }
    }
}
