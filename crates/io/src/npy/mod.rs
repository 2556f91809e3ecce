//! NumPy arrays, `.npy` versions 1 to 3, and archives of them, `.npz`.
//!
//! Tensor fields are arrays (H, W, 2, 2), `[row][column][i][j]`, with row 0 on top and components in the frame x right,
//! y up: what [`write_tensors`] writes. Read as well ([`read_lattice`]):
//!
//! | shape | is |
//! | --- | --- |
//! | (H, W, 4), (H, W, 3) | xx, xy, yx, yy; xx, xy, yy |
//! | (H, W, 3, 3), (H, W, 9), (H, W, 6), (H, W, 7) | 3x3 tensors; six or a mask and six of symmetric ones |
//! | (X, Y, Z, 3, 3), (X, Y, Z, 9), (X, Y, Z, 6), (X, Y, Z, 7) | a volume, indexed `[x][y][z]` as nibabel and dipy have it |
//! | (H, W), (X, Y, Z) | single numbers, where they are wanted |
//! | (H, W, 2), (H, W, 3), (X, Y, Z, 3) | vectors, where they are wanted |
//!
//! Archives may hold positions beside the data: x and y (and z), one number a cell or one a column and row, as
//! `numpy.meshgrid` takes and makes them. They place the cells, so that what has the largest y is on top.

mod archive;
mod error;
mod header;
mod lattice;
mod positions;
mod read;
mod write;

pub use archive::{array_of_archive, arrays_of_archive, read_archive};
pub use error::NpyError;
pub use lattice::{lattice_of_members, read_lattice};
pub use read::{NpyArray, read_array, read_tensors};
pub use write::{write_array, write_light, write_ltg, write_tensors};
