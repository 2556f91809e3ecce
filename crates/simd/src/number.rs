//! Arithmetic of one number.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Sub};

/// Arithmetic of one number.
pub trait Number:
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
    /// Added to a divisor so that a quotient stays finite where both numbers vanish: far below numbers that matter, far
    /// above what cannot be divided by.
    const TINY: Self;

    /// The nearest number of this type.
    fn narrowed(value: f64) -> Self;
    /// The same number in double precision.
    fn widened(self) -> f64;
    /// `self * factor + term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// Its absolute value.
    fn abs(self) -> Self;
}

macro_rules! number {
    ($type:ident, $tiny:literal) => {
        impl Number for $type {
            const TINY: Self = $tiny;

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

number!(f64, 1e-280);
number!(f32, 1e-30);
