//! Why reviews fail, and how large their files may be.

use thiserror::Error;

/// Largest summary, snapshot or picture, bytes.
pub const MAX_FILE: u64 = 64 << 20;

/// Why two results cannot be compared.
#[derive(Debug, Error)]
pub enum ReviewError {
    /// A file that is no JSON.
    #[error("{file}: expected the JSON that `reproduce --out` writes: {problem}")]
    Json {
        /// The file.
        file: String,
        /// What the reader says.
        problem: String,
    },
    /// A value that is missing or wrong.
    #[error("{file}: {key}: expected {expected}")]
    Key {
        /// The file.
        file: String,
        /// Where in the file, for example `experiments[2].checks[0].value`.
        key: String,
        /// What should stand there.
        expected: String,
    },
    /// A figure that is no readable picture.
    #[error("{file}: {problem}")]
    Picture {
        /// The file.
        file: String,
        /// What is wrong with it.
        problem: String,
    },
}
