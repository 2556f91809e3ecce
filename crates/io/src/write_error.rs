//! What writers of VTK formats refuse.

use thiserror::Error;

/// Data that cannot be written.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum WriteError {
    /// An image without any point.
    #[error(
        "{} x {} x {} points cannot be written: expected at least one along each axis",
        dimensions[0], dimensions[1], dimensions[2]
    )]
    EmptyImage {
        /// Points along x, y and z.
        dimensions: [usize; 3],
    },
    /// A name or text that the format cannot hold.
    #[error("`{name}` cannot be written: expected text without control characters")]
    Unwritable {
        /// Name of the array.
        name: String,
    },
}
