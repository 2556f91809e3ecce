//! Vectors of several instruction sets behind one trait, and the hot loops compiled for each, chosen once at run time.
//!
//! The loops are written once, generic over [`Vector`]. No operation is fused or reordered and lanes never mix, so every
//! level and every number of lanes gives the same bits.
//!
//! The crate's only `unsafe` is here. Its invariants:
//! - [`Level`]'s field cannot be set from outside, and [`Level::available`] lists a level only where the processor has
//!   its instructions. So a function compiled for a level may be called once a `Level` says so.
//! - A vector of a level is only made from that level's proof ([`HasAvx2`], [`HasAvx512`]), and a proof is only made
//!   where a `Level` says so. So whoever holds a vector may use its instructions.
//! - Loads and stores take references to whole arrays of the vector's width and ask for no alignment. So they never leave
//!   them.
#![allow(unsafe_code)]

use crate::Stopping;
use crate::pulses::{LaneOf, LaneOutcome, PulseBlock, PulseSolver};
use crate::sectors::Sectors;
#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Sub};
use tigereye_core::Cell;

/// Instruction set of the hot loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Level {
    /// What every processor of the target has.
    pub const BASELINE: Self = Self(Kind::Baseline);

    /// The widest set this processor has.
    #[must_use]
    pub fn detect() -> Self {
        Self::available().pop().unwrap_or(Self::BASELINE)
    }

    /// All sets this processor has, narrowest first.
    #[must_use]
    pub fn available() -> Vec<Self> {
        let mut levels = vec![Self::BASELINE];
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            levels.push(Self(Kind::Avx2));
            // Lanes that do not fill a wide vector use the narrow one: the wide level includes the narrow.
            if is_x86_feature_detected!("avx512f") {
                levels.push(Self(Kind::Avx512));
            }
        }
        levels
    }

    /// Name for reports: `baseline`, `avx2` or `avx512`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self.0 {
            Kind::Baseline => "baseline",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => "avx512",
        }
    }
}

/// W numbers that are computed with at once.
///
/// Methods of the wide vectors become single instructions only when inlined into a function compiled for their level:
/// everything between [`for_every_level`] and them is `#[inline(always)]`.
pub(crate) trait Vector<const W: usize>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Evidence that the processor has the instructions.
    type Proof: Copy;

    /// The same number W times.
    fn splat(proof: Self::Proof, value: f64) -> Self;
    /// The numbers of an array.
    fn load(proof: Self::Proof, from: &[f64; W]) -> Self;
    /// Back to an array.
    fn store(self, to: &mut [f64; W]);
    /// Absolute values.
    fn abs(self) -> Self;
    /// `then` where `condition > 0`, elsewhere (not a number too) `otherwise`.
    fn if_positive(condition: Self, then: Self, otherwise: Self) -> Self;

    /// Vector `c` of an array of several.
    #[inline(always)]
    fn load_part<const N: usize>(proof: Self::Proof, from: &[f64; N], c: usize) -> Self {
        Self::load(proof, &from.as_chunks().0[c])
    }
    /// To vector `c` of an array of several.
    #[inline(always)]
    fn store_part<const N: usize>(self, to: &mut [f64; N], c: usize) {
        self.store(&mut to.as_chunks_mut().0[c]);
    }
    /// Adds to vector `c` of an array of sums.
    #[inline(always)]
    fn add_to<const N: usize>(self, proof: Self::Proof, sums: &mut [f64; N], c: usize) {
        (Self::load_part(proof, sums, c) + self).store_part(sums, c);
    }
}

/// The vector of every processor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plain<const W: usize>(pub(crate) [f64; W]);

impl<const W: usize> Vector<W> for Plain<W> {
    type Proof = ();

    #[inline(always)]
    fn splat((): (), value: f64) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn load((): (), from: &[f64; W]) -> Self {
        Self(*from)
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; W]) {
        *to = self.0;
    }
    #[inline(always)]
    fn abs(mut self) -> Self {
        for l in 0..W {
            self.0[l] = self.0[l].abs();
        }
        self
    }
    #[inline(always)]
    fn if_positive(condition: Self, mut then: Self, otherwise: Self) -> Self {
        for l in 0..W {
            then.0[l] = if condition.0[l] > 0.0 { then.0[l] } else { otherwise.0[l] };
        }
        then
    }
}

/// Two lanes in the register every x86-64 processor has.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct Sse2(__m128d);

// SAFETY of every block in this implementation: SSE2 is part of the target, arrays have the vector's size.
#[cfg(target_arch = "x86_64")]
impl Vector<2> for Sse2 {
    type Proof = ();

    #[inline(always)]
    fn splat((): (), value: f64) -> Self {
        Self(unsafe { _mm_set1_pd(value) })
    }
    #[inline(always)]
    fn load((): (), from: &[f64; 2]) -> Self {
        Self(unsafe { _mm_loadu_pd(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 2]) {
        unsafe { _mm_storeu_pd(to.as_mut_ptr(), self.0) };
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm_andnot_pd(_mm_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn if_positive(condition: Self, then: Self, otherwise: Self) -> Self {
        Self(unsafe {
            let mask = _mm_cmpgt_pd(condition.0, _mm_setzero_pd());
            _mm_or_pd(_mm_and_pd(mask, then.0), _mm_andnot_pd(mask, otherwise.0))
        })
    }
}

/// The baseline's pair of lanes.
#[cfg(target_arch = "x86_64")]
type Pair = Sse2;
/// The baseline's pair of lanes.
#[cfg(not(target_arch = "x86_64"))]
type Pair = Plain<2>;

/// Evidence of AVX2.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct HasAvx2(());

/// Four lanes in an AVX2 register.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct Avx2(__m256d);

// SAFETY of every block in this implementation: the vectors prove the instructions, arrays have the vector's size.
#[cfg(target_arch = "x86_64")]
impl Vector<4> for Avx2 {
    type Proof = HasAvx2;

    #[inline(always)]
    fn splat(_: HasAvx2, value: f64) -> Self {
        Self(unsafe { _mm256_set1_pd(value) })
    }
    #[inline(always)]
    fn load(_: HasAvx2, from: &[f64; 4]) -> Self {
        Self(unsafe { _mm256_loadu_pd(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 4]) {
        unsafe { _mm256_storeu_pd(to.as_mut_ptr(), self.0) };
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn if_positive(condition: Self, then: Self, otherwise: Self) -> Self {
        Self(unsafe {
            let mask = _mm256_cmp_pd::<_CMP_GT_OQ>(condition.0, _mm256_setzero_pd());
            _mm256_blendv_pd(otherwise.0, then.0, mask)
        })
    }
}

/// Evidence of AVX-512 (foundation).
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct HasAvx512(());

/// Eight lanes in an AVX-512 register.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct Avx512(__m512d);

// SAFETY of every block in this implementation: the vectors prove the instructions, arrays have the vector's size.
#[cfg(target_arch = "x86_64")]
impl Vector<8> for Avx512 {
    type Proof = HasAvx512;

    #[inline(always)]
    fn splat(_: HasAvx512, value: f64) -> Self {
        Self(unsafe { _mm512_set1_pd(value) })
    }
    #[inline(always)]
    fn load(_: HasAvx512, from: &[f64; 8]) -> Self {
        Self(unsafe { _mm512_loadu_pd(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) };
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn if_positive(condition: Self, then: Self, otherwise: Self) -> Self {
        Self(unsafe {
            let mask = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(condition.0, _mm512_setzero_pd());
            _mm512_mask_blend_pd(mask, otherwise.0, then.0)
        })
    }
}

/// One arithmetic operator of all vectors.
macro_rules! operator {
    ($trait:ident, $method:ident, $sse2:ident, $avx2:ident, $avx512:ident) => {
        impl<const W: usize> $trait for Plain<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for l in 0..W {
                    self.0[l] = self.0[l].$method(other.0[l]);
                }
                self
            }
        }
        operator!($trait, $method, Sse2, $sse2);
        operator!($trait, $method, Avx2, $avx2);
        operator!($trait, $method, Avx512, $avx512);
    };
    ($trait:ident, $method:ident, $vector:ident, $instruction:ident) => {
        #[cfg(target_arch = "x86_64")]
        impl $trait for $vector {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the vectors prove the instructions.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    };
}

operator!(Add, add, _mm_add_pd, _mm256_add_pd, _mm512_add_pd);
operator!(Sub, sub, _mm_sub_pd, _mm256_sub_pd, _mm512_sub_pd);
operator!(Mul, mul, _mm_mul_pd, _mm256_mul_pd, _mm512_mul_pd);
operator!(Div, div, _mm_div_pd, _mm256_div_pd, _mm512_div_pd);

/// Defines a function that runs the one of its name in `pulses`, which is generic over lanes N, width W and vector V, with
/// the widest vector of the given level that N lanes fill.
macro_rules! for_every_level {
    ($(#[$doc:meta])* fn $name:ident<N>($($arg:ident: $ty:ty),* $(,)?) -> $ret:ty) => {
        $(#[$doc])*
        pub(crate) fn $name<const N: usize>(level: Level, $($arg: $ty),*) -> $ret {
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2")]
            fn avx2<const N: usize>($($arg: $ty),*) -> $ret {
                crate::pulses::$name::<N, 4, Avx2>(HasAvx2(()), $($arg),*)
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f")]
            fn avx512<const N: usize>($($arg: $ty),*) -> $ret {
                crate::pulses::$name::<N, 8, Avx512>(HasAvx512(()), $($arg),*)
            }
            match level.0 {
                // SAFETY: the level exists only where the processor has the instructions.
                #[cfg(target_arch = "x86_64")]
                Kind::Avx512 if N % 8 == 0 => unsafe { avx512::<N>($($arg),*) },
                // SAFETY: as above; the wide level includes the narrow.
                #[cfg(target_arch = "x86_64")]
                Kind::Avx512 | Kind::Avx2 if N % 4 == 0 => unsafe { avx2::<N>($($arg),*) },
                _ if N % 2 == 0 => crate::pulses::$name::<N, 2, Pair>((), $($arg),*),
                _ => crate::pulses::$name::<N, 1, Plain<1>>((), $($arg),*),
            }
        }
    };
}

for_every_level! {
    /// [`crate::pulses::solve`].
    fn solve<N>(
        solver: &mut PulseSolver<'_, N>,
        cell: Cell,
        stopping: &Stopping,
        block: &mut PulseBlock<N>,
    ) -> [LaneOutcome; N]
}

for_every_level! {
    /// [`crate::pulses::l1_blocks`].
    fn l1_blocks<N>(
        sectors: &Sectors,
        width: usize,
        b1: &PulseBlock<N>,
        b2: &PulseBlock<N>,
    ) -> [f64; N]
}

for_every_level! {
    /// [`crate::pulses::l1_lanes`].
    fn l1_lanes<N>(
        sectors: &Sectors,
        width: usize,
        blocks: &[&PulseBlock<N>],
        pairs: &[(LaneOf, LaneOf); N],
    ) -> [f64; N]
}
