//! What counts as nothing, by the precision of the numbers.

use tigereye_simd::Number;

/// Bounds that depend on the number type.
pub(crate) trait Tolerances: Number {
    /// Relative changes of a whole distribution below this are rounding.
    const SETTLED: f64;
    /// A pulse whose light stays longer than so many steps has no stationary state within reach of these numbers.
    const RESIDENCE: f64;
    /// Light counts as trapped if less than this fraction escapes per passage between two halves of a block: smaller
    /// losses are hidden by rounding.
    const SMALLEST_PIVOT: f64;
}

impl Tolerances for f64 {
    const SETTLED: f64 = 1e-14;
    const RESIDENCE: f64 = 1e7;
    const SMALLEST_PIVOT: f64 = 1e-12;
}

impl Tolerances for f32 {
    const SETTLED: f64 = 1e-6;
    const RESIDENCE: f64 = 1e4;
    const SMALLEST_PIVOT: f64 = 1e-5;
}
