//! What keeps a file from being a picture.

use thiserror::Error;

/// What keeps a file from being a picture.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PictureError {
    /// A picture that cannot be decoded.
    #[error("expected a PNG picture: {problem}")]
    Png {
        /// What the decoder says.
        problem: String,
    },
}
