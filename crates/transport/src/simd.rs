//! Vectors of several instruction sets behind two traits, and the hot loops compiled for each, chosen once at run time.
//!
//! The loops are written once. Products and sums are fused (`fma`) at every level, in the same places, and lanes never
//! mix: every level and every number of lanes gives the same bits. A processor without the instruction pays for it with a
//! function call; all that have AVX2 in fact have it too.
//!
//! The crate's only `unsafe` is here. Its invariants:
//! - [`Level`]'s field cannot be set from outside, and [`Level::available`] lists a level only where the processor has
//!   its instructions. So a function compiled for a level may be called once a `Level` says so.
//! - A vector of a level is only made from that level's proof ([`HasAvx2`], [`HasAvx512`]), and a proof is only made
//!   where a `Level` says so. So whoever holds a vector may use its instructions.
//! - Loads and stores take references to whole arrays, check that the part they want lies inside, and ask for no
//!   alignment. So they never leave them.
#![allow(unsafe_code)]

use crate::real::Number;
#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Sub};

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
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            levels.push(Self(Kind::Avx2));
            // Lanes that do not fill a wide vector use the narrow one: the wide level includes the narrow.
            if is_x86_feature_detected!("avx512f") {
                levels.push(Self(Kind::Avx512));
            }
        }
        levels
    }

    /// The set called `name`, if this processor has it.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::available().into_iter().find(|l| l.name() == name)
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

/// Several numbers that are computed with at once.
///
/// Methods of the wide vectors become single instructions only when inlined into a function compiled for their level:
/// everything between [`Level::dispatch`] and them is `#[inline(always)]`.
pub(crate) trait Vector:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// What it holds.
    type Number: Number;
    /// Evidence that the processor has the instructions.
    type Proof: Copy;
    /// How many it holds.
    const WIDTH: usize;

    /// The same number everywhere.
    fn splat(proof: Self::Proof, value: Self::Number) -> Self;
    /// Part `c` of an array that holds several vectors.
    fn load<const N: usize>(proof: Self::Proof, from: &[Self::Number; N], c: usize) -> Self;
    /// Back to an array.
    fn store<const N: usize>(self, to: &mut [Self::Number; N], c: usize);
    /// `self * factor + term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// Adds to part `c` of an array of sums in double precision.
    fn add_to<const N: usize>(self, sums: &mut [f64; N], c: usize);
}

/// Eight numbers, one for each direction.
pub(crate) trait Octet: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// What it holds.
    type Number: Number;
    /// Evidence that the processor has the instructions.
    type Proof: Copy;

    /// The same number eight times.
    fn splat(proof: Self::Proof, value: Self::Number) -> Self;
    /// The numbers of an array.
    fn load(proof: Self::Proof, from: &[Self::Number; 8]) -> Self;
    /// Back to an array.
    fn store(self, to: &mut [Self::Number; 8]);
    /// `self * factor + term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// Absolute values.
    fn abs(self) -> Self;
    /// The larger ones.
    fn max(self, other: Self) -> Self;
    /// Every number's successor; the first comes last.
    fn next(self) -> Self;
    /// Every number's predecessor; the last comes first.
    fn previous(self) -> Self;
    /// Announces that numbers will be read soon.
    fn expect(_proof: Self::Proof, _soon: &[Self::Number; 8]) {}
}

/// Vectors and octets of a number type at every level.
pub(crate) trait Vectors: Number {
    type Baseline: Vector<Number = Self, Proof = ()>;
    type BaselineOctet: Octet<Number = Self, Proof = ()>;
    #[cfg(target_arch = "x86_64")]
    type Avx2: Vector<Number = Self, Proof = HasAvx2>;
    #[cfg(target_arch = "x86_64")]
    type Avx2Octet: Octet<Number = Self, Proof = HasAvx2>;
    #[cfg(target_arch = "x86_64")]
    type Avx512: Vector<Number = Self, Proof = HasAvx512>;
    #[cfg(target_arch = "x86_64")]
    type Avx512Octet: Octet<Number = Self, Proof: From<HasAvx512>>;
}

impl Vectors for f64 {
    type Baseline = Plain<Self, 4>;
    type BaselineOctet = Plain<Self, 8>;
    #[cfg(target_arch = "x86_64")]
    type Avx2 = Avx2<__m256d>;
    #[cfg(target_arch = "x86_64")]
    type Avx2Octet = Avx2<[__m256d; 2]>;
    #[cfg(target_arch = "x86_64")]
    type Avx512 = Avx512<__m512d>;
    #[cfg(target_arch = "x86_64")]
    type Avx512Octet = Avx512<__m512d>;
}

impl Vectors for f32 {
    type Baseline = Plain<Self, 8>;
    type BaselineOctet = Plain<Self, 8>;
    #[cfg(target_arch = "x86_64")]
    type Avx2 = Avx2<__m256>;
    #[cfg(target_arch = "x86_64")]
    type Avx2Octet = Avx2<__m256>;
    #[cfg(target_arch = "x86_64")]
    type Avx512 = Avx512<__m512>;
    #[cfg(target_arch = "x86_64")]
    type Avx512Octet = Avx2<__m256>;
}

/// The vector of every processor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plain<T, const W: usize>([T; W]);

impl<T: Number, const W: usize> Plain<T, W> {
    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        for l in 0..W {
            self.0[l] = f(self.0[l], other.0[l]);
        }
        self
    }
}

impl<T: Number, const W: usize> Vector for Plain<T, W> {
    type Number = T;
    type Proof = ();
    const WIDTH: usize = W;

    #[inline(always)]
    fn splat((): (), value: T) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn load<const N: usize>((): (), from: &[T; N], c: usize) -> Self {
        Self(from.as_chunks().0[c])
    }
    #[inline(always)]
    fn store<const N: usize>(self, to: &mut [T; N], c: usize) {
        to.as_chunks_mut().0[c] = self.0;
    }
    #[inline(always)]
    fn mul_add(mut self, factor: Self, term: Self) -> Self {
        for l in 0..W {
            self.0[l] = self.0[l].mul_add(factor.0[l], term.0[l]);
        }
        self
    }
    #[inline(always)]
    fn add_to<const N: usize>(self, sums: &mut [f64; N], c: usize) {
        let sums: &mut [f64; W] = &mut sums.as_chunks_mut().0[c];
        for l in 0..W {
            sums[l] += self.0[l].widened();
        }
    }
}

impl<T: Number> Octet for Plain<T, 8> {
    type Number = T;
    type Proof = ();

    #[inline(always)]
    fn splat((): (), value: T) -> Self {
        Self([value; 8])
    }
    #[inline(always)]
    fn load((): (), from: &[T; 8]) -> Self {
        Self(*from)
    }
    #[inline(always)]
    fn store(self, to: &mut [T; 8]) {
        *to = self.0;
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Vector::mul_add(self, factor, term)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(T::abs))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn next(mut self) -> Self {
        self.0.rotate_left(1);
        self
    }
    #[inline(always)]
    fn previous(mut self) -> Self {
        self.0.rotate_right(1);
        self
    }
}

/// Evidence of AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct HasAvx2(());

/// Evidence of AVX-512 (foundation), AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct HasAvx512(());

#[cfg(target_arch = "x86_64")]
impl From<HasAvx512> for HasAvx2 {
    fn from(_: HasAvx512) -> Self {
        Self(())
    }
}

/// One or two registers of AVX2.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct Avx2<R>(R);

/// A register of AVX-512.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(crate) struct Avx512<R>(R);

/// A pointer to part `c` of width `W` of an array, which must have it.
#[inline(always)]
fn part<T, const N: usize>(from: &[T; N], c: usize, width: usize) -> *const T {
    from[c * width..][..width].as_ptr()
}

/// The same, to write.
#[inline(always)]
fn part_mut<T, const N: usize>(to: &mut [T; N], c: usize, width: usize) -> *mut T {
    to[c * width..][..width].as_mut_ptr()
}

/// The arithmetic operators of a vector.
macro_rules! operators {
    ($vector:ty, $($trait:ident $method:ident $instruction:ident),*) => {$(
        #[cfg(target_arch = "x86_64")]
        impl $trait for $vector {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the vectors prove the instructions.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    )*};
}

operators!(Avx2<__m256d>, Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);
operators!(Avx2<__m256>, Add add _mm256_add_ps, Sub sub _mm256_sub_ps, Mul mul _mm256_mul_ps, Div div _mm256_div_ps);
operators!(Avx512<__m512d>, Add add _mm512_add_pd, Sub sub _mm512_sub_pd, Mul mul _mm512_mul_pd, Div div _mm512_div_pd);
operators!(Avx512<__m512>, Add add _mm512_add_ps, Sub sub _mm512_sub_ps, Mul mul _mm512_mul_ps, Div div _mm512_div_ps);

/// The operators of arrays and of pairs of registers, one by one.
macro_rules! operators_of_arrays {
    ($($trait:ident $method:ident $instruction:ident),*) => {$(
        impl<T: Number, const W: usize> $trait for Plain<T, W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, T::$method)
            }
        }
        #[cfg(target_arch = "x86_64")]
        impl $trait for Avx2<[__m256d; 2]> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ([a, b], [c, d]) = (self.0, other.0);
                // SAFETY: the vectors prove the instructions.
                Self(unsafe { [$instruction(a, c), $instruction(b, d)] })
            }
        }
    )*};
}

operators_of_arrays!(Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);

/// A vector that is one register.
macro_rules! vector {
    ($vector:ty, $proof:ty, $number:ty, $width:literal, $splat:ident, $load:ident, $store:ident, $fma:ident,
     |$it:ident, $sums:ident, $c:ident| $add:expr) => {
        // SAFETY of every block in this implementation: the vectors prove the instructions, and the parts of arrays have
        // the vector's size.
        #[cfg(target_arch = "x86_64")]
        impl Vector for $vector {
            type Number = $number;
            type Proof = $proof;
            const WIDTH: usize = $width;

            #[inline(always)]
            fn splat(_: $proof, value: $number) -> Self {
                Self(unsafe { $splat(value) })
            }
            #[inline(always)]
            fn load<const N: usize>(_: $proof, from: &[$number; N], c: usize) -> Self {
                Self(unsafe { $load(part(from, c, $width)) })
            }
            #[inline(always)]
            fn store<const N: usize>(self, to: &mut [$number; N], c: usize) {
                unsafe { $store(part_mut(to, c, $width), self.0) };
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, term: Self) -> Self {
                Self(unsafe { $fma(self.0, factor.0, term.0) })
            }
            #[inline(always)]
            fn add_to<const N: usize>(self, $sums: &mut [f64; N], $c: usize) {
                let $it = self.0;
                unsafe { $add };
            }
        }
    };
}

/// Adds a register of AVX2 to part `c` of sums.
///
/// # Safety
/// The processor has AVX2.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn add_avx2<const N: usize>(sums: &mut [f64; N], c: usize, v: __m256d) {
    let to = part_mut(sums, c, 4);
    // SAFETY: the part has four numbers.
    unsafe { _mm256_storeu_pd(to, _mm256_add_pd(_mm256_loadu_pd(to), v)) };
}

/// Adds a register of AVX-512 to part `c` of sums.
///
/// # Safety
/// The processor has AVX-512.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn add_avx512<const N: usize>(sums: &mut [f64; N], c: usize, v: __m512d) {
    let to = part_mut(sums, c, 8);
    // SAFETY: the part has eight numbers.
    unsafe { _mm512_storeu_pd(to, _mm512_add_pd(_mm512_loadu_pd(to), v)) };
}

vector!(
    Avx2<__m256d>,
    HasAvx2,
    f64,
    4,
    _mm256_set1_pd,
    _mm256_loadu_pd,
    _mm256_storeu_pd,
    _mm256_fmadd_pd,
    |v, sums, c| add_avx2(sums, c, v)
);
vector!(
    Avx2<__m256>,
    HasAvx2,
    f32,
    8,
    _mm256_set1_ps,
    _mm256_loadu_ps,
    _mm256_storeu_ps,
    _mm256_fmadd_ps,
    |v, sums, c| {
        add_avx2(sums, 2 * c, _mm256_cvtps_pd(_mm256_castps256_ps128(v)));
        add_avx2(sums, 2 * c + 1, _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(v)));
    }
);
vector!(
    Avx512<__m512d>,
    HasAvx512,
    f64,
    8,
    _mm512_set1_pd,
    _mm512_loadu_pd,
    _mm512_storeu_pd,
    _mm512_fmadd_pd,
    |v, sums, c| add_avx512(sums, c, v)
);
vector!(
    Avx512<__m512>,
    HasAvx512,
    f32,
    16,
    _mm512_set1_ps,
    _mm512_loadu_ps,
    _mm512_storeu_ps,
    _mm512_fmadd_ps,
    |v, sums, c| {
        let high = _mm256_castpd_ps(_mm512_extractf64x4_pd::<1>(_mm512_castps_pd(v)));
        add_avx512(sums, 2 * c, _mm512_cvtps_pd(_mm512_castps512_ps256(v)));
        add_avx512(sums, 2 * c + 1, _mm512_cvtps_pd(high));
    }
);

// SAFETY of every block in this implementation: the vectors prove the instructions, arrays have the vector's size.
#[cfg(target_arch = "x86_64")]
impl Octet for Avx512<__m512d> {
    type Number = f64;
    type Proof = HasAvx512;

    #[inline(always)]
    fn splat(proof: HasAvx512, value: f64) -> Self {
        Vector::splat(proof, value)
    }
    #[inline(always)]
    fn load(proof: HasAvx512, from: &[f64; 8]) -> Self {
        Vector::load(proof, from, 0)
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        Vector::store(self, to, 0);
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Vector::mul_add(self, factor, term)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn next(self) -> Self {
        Self(unsafe {
            let v = _mm512_castpd_si512(self.0);
            _mm512_castsi512_pd(_mm512_alignr_epi64::<1>(v, v))
        })
    }
    #[inline(always)]
    fn previous(self) -> Self {
        Self(unsafe {
            let v = _mm512_castpd_si512(self.0);
            _mm512_castsi512_pd(_mm512_alignr_epi64::<7>(v, v))
        })
    }
    #[inline(always)]
    fn expect(_: Self::Proof, soon: &[Self::Number; 8]) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(soon.as_ptr().cast()) };
    }
}

// SAFETY of every block in this implementation: the vectors prove the instructions, arrays have the vector's size.
#[cfg(target_arch = "x86_64")]
impl Octet for Avx2<[__m256d; 2]> {
    type Number = f64;
    type Proof = HasAvx2;

    #[inline(always)]
    fn splat(_: HasAvx2, value: f64) -> Self {
        Self([unsafe { _mm256_set1_pd(value) }; 2])
    }
    #[inline(always)]
    fn load(_: HasAvx2, from: &[f64; 8]) -> Self {
        Self(unsafe { [_mm256_loadu_pd(part(from, 0, 4)), _mm256_loadu_pd(part(from, 1, 4))] })
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        unsafe {
            _mm256_storeu_pd(part_mut(to, 0, 4), self.0[0]);
            _mm256_storeu_pd(part_mut(to, 1, 4), self.0[1]);
        }
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        let ([a, b], [c, d], [e, f]) = (self.0, factor.0, term.0);
        Self(unsafe { [_mm256_fmadd_pd(a, c, e), _mm256_fmadd_pd(b, d, f)] })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let [a, b] = self.0;
        Self(unsafe {
            let sign = _mm256_set1_pd(-0.0);
            [_mm256_andnot_pd(sign, a), _mm256_andnot_pd(sign, b)]
        })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.0, other.0);
        Self(unsafe { [_mm256_max_pd(a, c), _mm256_max_pd(b, d)] })
    }
    #[inline(always)]
    fn next(self) -> Self {
        let [a, b] = self.0;
        Self(unsafe {
            // The middle: a2 a3 b0 b1 and b2 b3 a0 a1.
            let (ab, ba) = (_mm256_permute2f128_pd::<0x21>(a, b), _mm256_permute2f128_pd::<0x21>(b, a));
            [_mm256_shuffle_pd::<0b0101>(a, ab), _mm256_shuffle_pd::<0b0101>(b, ba)]
        })
    }
    #[inline(always)]
    fn previous(self) -> Self {
        let [a, b] = self.0;
        Self(unsafe {
            // The middle: b2 b3 a0 a1 and a2 a3 b0 b1.
            let (ba, ab) = (_mm256_permute2f128_pd::<0x21>(b, a), _mm256_permute2f128_pd::<0x21>(a, b));
            [_mm256_shuffle_pd::<0b0101>(ba, a), _mm256_shuffle_pd::<0b0101>(ab, b)]
        })
    }
    #[inline(always)]
    fn expect(_: Self::Proof, soon: &[Self::Number; 8]) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(soon.as_ptr().cast()) };
    }
}

// SAFETY of every block in this implementation: the vectors prove the instructions, arrays have the vector's size.
#[cfg(target_arch = "x86_64")]
impl Octet for Avx2<__m256> {
    type Number = f32;
    type Proof = HasAvx2;

    #[inline(always)]
    fn splat(proof: HasAvx2, value: f32) -> Self {
        Vector::splat(proof, value)
    }
    #[inline(always)]
    fn load(proof: HasAvx2, from: &[f32; 8]) -> Self {
        Vector::load(proof, from, 0)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 8]) {
        Vector::store(self, to, 0);
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Vector::mul_add(self, factor, term)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn next(self) -> Self {
        Self(unsafe { _mm256_permutevar8x32_ps(self.0, _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 0)) })
    }
    #[inline(always)]
    fn previous(self) -> Self {
        Self(unsafe { _mm256_permutevar8x32_ps(self.0, _mm256_setr_epi32(7, 0, 1, 2, 3, 4, 5, 6)) })
    }
    #[inline(always)]
    fn expect(_: Self::Proof, soon: &[Self::Number; 8]) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(soon.as_ptr().cast()) };
    }
}

/// A hot loop, written once for the vectors of every level.
pub(crate) trait Task: Sized {
    /// What it computes with.
    type Number: Vectors;
    /// What it gives.
    type Output;
    /// How many lanes it has to fill vectors with.
    const LANES: usize = 16;

    /// The loop. `#[inline(always)]`, so that it is compiled for the level.
    fn work<P: Proven<Self::Number>>(self, proof: P) -> Self::Output;
}

/// The vectors of a level, where the processor has its instructions.
pub(crate) trait Proven<T>: Copy {
    /// As wide as the level has them.
    type Vector: Vector<Number = T>;
    /// Eight numbers of the level.
    type Octet: Octet<Number = T>;

    /// Evidence for the vector.
    fn vector(self) -> <Self::Vector as Vector>::Proof;
    /// Evidence for the octet.
    fn octet(self) -> <Self::Octet as Octet>::Proof;
}

/// No evidence is needed for what every processor has.
#[derive(Clone, Copy)]
struct NeedsNothing;

impl<T: Vectors> Proven<T> for NeedsNothing {
    type Vector = T::Baseline;
    type Octet = T::BaselineOctet;

    #[inline(always)]
    fn vector(self) {}
    #[inline(always)]
    fn octet(self) {}
}

#[cfg(target_arch = "x86_64")]
impl<T: Vectors> Proven<T> for HasAvx2 {
    type Vector = T::Avx2;
    type Octet = T::Avx2Octet;

    #[inline(always)]
    fn vector(self) -> Self {
        self
    }
    #[inline(always)]
    fn octet(self) -> Self {
        self
    }
}

#[cfg(target_arch = "x86_64")]
impl<T: Vectors> Proven<T> for HasAvx512 {
    type Vector = T::Avx512;
    type Octet = T::Avx512Octet;

    #[inline(always)]
    fn vector(self) -> Self {
        self
    }
    #[inline(always)]
    fn octet(self) -> <T::Avx512Octet as Octet>::Proof {
        self.into()
    }
}

impl Level {
    /// Does a task with the widest vectors of this level that its lanes fill.
    pub(crate) fn dispatch<K: Task>(self, task: K) -> K::Output {
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2,fma")]
        fn avx2<K: Task>(task: K) -> K::Output {
            task.work(HasAvx2(()))
        }
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx512f,avx2,fma")]
        fn avx512<K: Task>(task: K) -> K::Output {
            task.work(HasAvx512(()))
        }
        match self.0 {
            // SAFETY: the level exists only where the processor has the instructions.
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 if K::LANES.is_multiple_of(<K::Number as Vectors>::Avx512::WIDTH) => unsafe {
                avx512(task)
            },
            // SAFETY: as above; the wide level includes the narrow.
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 | Kind::Avx2 => unsafe { avx2(task) },
            Kind::Baseline => task.work(NeedsNothing),
        }
    }
}
