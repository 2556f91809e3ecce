//! The number types pulses can be computed in.

use crate::pulses::{Passage, SectorSums, Walls};
use crate::scattering::Scattering;
use crate::simd::Vectors;
use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Sub};

/// A floating-point number: `f64` or `f32`.
///
/// Sums over the grid that decide when a propagation ends are taken in double precision in either case.
#[expect(private_bounds, reason = "only the types with vectors at every level qualify")]
pub trait Real: Vectors {
    /// Pulses that are propagated side by side: those a register of AVX-512 holds.
    const LANES: usize;
    /// Name on the command line and in reports.
    const NAME: &'static str;

    /// The nearest number of this type.
    #[must_use]
    fn from_f64(value: f64) -> Self {
        Self::narrowed(value)
    }
    /// The same number.
    #[must_use]
    fn to_f64(self) -> f64 {
        self.widened()
    }
}

impl Real for f64 {
    const LANES: usize = 8;
    const NAME: &'static str = "f64";
}

impl Real for f32 {
    const LANES: usize = 16;
    const NAME: &'static str = "f32";
}

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

    /// How the cells of a field pass light on, row-major.
    fn passages<'f>(field: &'f Scattering<'_>) -> &'f [Passage<Self>];
    /// The cells that send light back.
    fn walls<'f>(field: &'f Scattering<'_>) -> &'f Walls<Self>;
    /// The field's angular sums.
    fn sector_sums<'f>(field: &'f Scattering<'_>) -> &'f SectorSums<Self>;
    fn narrowed(value: f64) -> Self;
    fn widened(self) -> f64;
    /// `self * factor + term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    fn abs(self) -> Self;
}

macro_rules! number {
    ($type:ident, $passages:ident, $walls:ident, $sums:ident, $tiny:literal, $settled:literal, $residence:literal) => {
        impl Number for $type {
            const TINY: Self = $tiny;
            const SETTLED: f64 = $settled;
            const RESIDENCE: f64 = $residence;

            fn passages<'f>(field: &'f Scattering<'_>) -> &'f [Passage<Self>] {
                field.$passages.get_or_init(|| field.make_passages())
            }
            fn walls<'f>(field: &'f Scattering<'_>) -> &'f Walls<Self> {
                field.$walls.get_or_init(|| Walls::of(field.transmission()))
            }
            fn sector_sums<'f>(field: &'f Scattering<'_>) -> &'f SectorSums<Self> {
                field.$sums.get_or_init(|| SectorSums::new(field.scheme()))
            }

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

number!(f64, passages_f64, walls_f64, sums_f64, 1e-280, 1e-14, 1e7);
number!(f32, passages_f32, walls_f32, sums_f32, 1e-30, 1e-6, 1e4);
