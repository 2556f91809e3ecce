//! Why reviews fail, and how large their files may be.

use crate::SummaryError;
use thiserror::Error;

/// Largest summary, snapshot or picture, bytes.
pub const MAX_FILE: u64 = 64 << 20;

/// Why two results cannot be compared.
#[derive(Debug, Error)]
pub enum ReviewError {
    /// A summary that cannot be read.
    #[error(transparent)]
    Summary(#[from] SummaryError),
    /// A figure that is no readable picture.
    #[error("{file}: {problem}")]
    Picture {
        /// The file.
        file: String,
        /// What is wrong with it.
        problem: String,
    },
}
