//! Arithmetic of one number.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Sub};

/// Arithmetic of one number.
pub(crate) trait Number:
    Copy
    + Debug
    + Default
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// Added to what passes a cell so that the quotient that makes up for losses stays finite where nothing passes. Far
    /// below any light that matters, far above what cannot be divided by.
    const TINY: Self;
    /// Relative changes of a whole distribution below this are rounding.
    const SETTLED: f64;
    /// A pulse whose light stays longer than so many steps has no stationary state within reach of these numbers.
    const RESIDENCE: f64;
    /// Light counts as trapped if less than this fraction escapes per passage between two halves of a block: smaller
    /// losses are hidden by rounding.
    const SMALLEST_PIVOT: f64;

    fn narrowed(value: f64) -> Self;
    fn widened(self) -> f64;
    /// `self * factor + term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    fn abs(self) -> Self;
}

macro_rules! number {
    ($type:ident, $tiny:literal, $settled:literal, $residence:literal, $pivot:literal) => {
        impl Number for $type {
            const TINY: Self = $tiny;
            const SETTLED: f64 = $settled;
            const RESIDENCE: f64 = $residence;
            const SMALLEST_PIVOT: f64 = $pivot;

            #[inline(always)]
            fn narrowed(value: f64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn widened(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, term: Self) -> Self {
                $type::mul_add(self, factor, term)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $type::abs(self)
            }
        }
    };
}

number!(f64, 1e-280, 1e-14, 1e7, 1e-12);
number!(f32, 1e-30, 1e-6, 1e4, 1e-5);
