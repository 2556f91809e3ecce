//! Why reviews fail.

use crate::SummaryError;
use thiserror::Error;

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
