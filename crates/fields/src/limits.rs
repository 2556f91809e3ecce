//! Sizes beyond which nothing is made or parsed.

/// Columns and rows of a resampled field.
pub const MAX_RESAMPLED: usize = 1 << 14;
/// Cells of a resampled field, unless it had more before.
pub const MAX_RESAMPLED_CELLS: usize = 1 << 24;
/// Longest formula in characters.
pub const MAX_LENGTH: usize = 10_000;
/// Deepest nesting of parentheses, signs, powers and arguments.
pub const MAX_NESTING: usize = 200;
