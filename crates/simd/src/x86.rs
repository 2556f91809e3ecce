//! Vectors in the registers of AVX2 and AVX-512.

use crate::vector::{HasAvx2, HasAvx512, Octet, Vector};
use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Sub};

/// One or two registers of AVX2.
#[derive(Clone, Copy)]
pub struct Avx2<R>(R);

/// A register of AVX-512.
#[derive(Clone, Copy)]
pub struct Avx512<R>(R);

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

/// The operators of pairs of registers, one by one.
macro_rules! operators_of_pairs {
    ($($trait:ident $method:ident $instruction:ident),*) => {$(
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

operators_of_pairs!(Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);

/// A vector that is one register.
macro_rules! vector {
    ($vector:ty, $proof:ty, $number:ty, $width:literal, $splat:ident, $load:ident, $store:ident, $fma:ident,
     |$it:ident, $sums:ident, $c:ident| $add:expr $(, $fence:ident)?) => {
        // SAFETY of every block in this implementation: the vectors prove the instructions, and the parts of arrays
        // have the vector's size.
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
            $(
                #[inline(always)]
                fn before_others(these: &mut [Self; 8], and: &mut Self) {
                    // SAFETY: the vectors prove the instructions.
                    unsafe { $fence(these.each_mut().map(|v| &mut v.0), &mut and.0) };
                }
            )?
        }
    };
}

/// Adds a register of AVX2 to part `c` of sums.
///
/// # Safety
/// The processor has AVX2.
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
#[inline(always)]
unsafe fn add_avx512<const N: usize>(sums: &mut [f64; N], c: usize, v: __m512d) {
    let to = part_mut(sums, c, 8);
    // SAFETY: the part has eight numbers.
    unsafe { _mm512_storeu_pd(to, _mm512_add_pd(_mm512_loadu_pd(to), v)) };
}

/// Nothing but the statement that the numbers in nine registers might change here: what they are computed from comes
/// before, what is computed from them comes after.
macro_rules! fence {
    ($name:ident, $register:ty) => {
        #[inline]
        #[target_feature(enable = "avx")]
        fn $name([a, b, c, d, e, f, g, h]: [&mut $register; 8], i: &mut $register) {
            // SAFETY: no instruction.
            unsafe {
                core::arch::asm!(
                    "/* {} {} {} {} {} {} {} {} {} */",
                    inout(ymm_reg) * a,
                    inout(ymm_reg) * b,
                    inout(ymm_reg) * c,
                    inout(ymm_reg) * d,
                    inout(ymm_reg) * e,
                    inout(ymm_reg) * f,
                    inout(ymm_reg) * g,
                    inout(ymm_reg) * h,
                    inout(ymm_reg) * i,
                    options(pure, nomem, nostack, preserves_flags),
                );
            }
        }
    };
}

fence!(fence_pd, __m256d);

vector!(
    Avx2<__m256d>,
    HasAvx2,
    f64,
    4,
    _mm256_set1_pd,
    _mm256_loadu_pd,
    _mm256_storeu_pd,
    _mm256_fmadd_pd,
    |v, sums, c| add_avx2(sums, c, v),
    fence_pd
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
