//! VTK XML poly data, `.vtp`.
//!
//! Read and written in the encodings of [`crate::vti`]. Tensors are taken where the points form a lattice, x fastest,
//! as slices of volumes have them; the cells between the points then play no part.

mod read;
mod write;

pub use read::{read, read_with_limits};
pub use write::write;
