//! NumPy arrays, `.npy` versions 1 to 3.
//!
//! Tensor fields are arrays (H, W, 2, 2), `[row][column][i][j]`, with row 0 on top and components in the frame x right,
//! y up: what [`write_tensors`] writes. Read as well: (H, W, 4), the components xx, xy, yx, yy; and (H, W, 3), the
//! components xx, xy, yy of a symmetric tensor.

mod header;
mod read;
mod write;

pub use read::{NpyArray, read_array, read_tensors};
pub use write::{write_array, write_light, write_ltg, write_tensors};
