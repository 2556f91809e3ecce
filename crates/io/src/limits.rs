//! How much a file may ask for.

use thiserror::Error;

/// Upper bounds for what a header declares. They matter where compression hides the true size; uncompressed data are
/// bounded by the bytes that are there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Points (or cells) of one data set.
    pub cells: u64,
    /// Numbers in all arrays of one file together.
    pub values: u64,
}

impl Default for Limits {
    /// 2^28 cells and 2^28 values, which take 2 GiB in double precision.
    fn default() -> Self {
        Self { cells: 1 << 28, values: 1 << 28 }
    }
}

/// More than [`Limits`] allow.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LimitError {
    /// A header that declares more cells than the limit.
    #[error("byte {byte}: {cells} cells are declared, the limit is {limit}")]
    Cells {
        /// Where they are declared.
        byte: usize,
        /// Declared cells.
        cells: u128,
        /// [`Limits::cells`].
        limit: u64,
    },
    /// Arrays that hold more numbers than the limit.
    #[error("byte {byte}: array `{array}` brings the file to more than the limit of {limit} values")]
    Values {
        /// Name of the array.
        array: String,
        /// Where the array is declared.
        byte: usize,
        /// [`Limits::values`].
        limit: u64,
    },
}
