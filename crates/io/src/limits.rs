//! How much a file may ask for.

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
