//! Sizes beyond which nothing is made, so that no input asks for memory without end.

/// Cells of a grid.
pub(crate) const MAX_CELLS: usize = 1 << 28;
/// Angular samples.
pub(crate) const MAX_DIRECTIONS: usize = 7200;
/// Samples of a transmission field: cells times directions.
pub(crate) const MAX_SAMPLES: usize = 1 << 29;
