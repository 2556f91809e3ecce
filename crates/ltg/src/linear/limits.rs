//! How many sketches an estimate may have.

/// The fewest sketches: with fewer the standard error is 40 % and more, and cannot be measured.
pub const FEWEST_SKETCHES: u32 = 16;
/// The most sketches: their relative error is 0.15 %; for a smaller one there is the exact gradient.
pub const MOST_SKETCHES: u32 = 1 << 20;
