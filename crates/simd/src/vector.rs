//! Vectors of numbers, and the evidence that the processor has their instructions.

use crate::number::Number;
use core::ops::{Add, Div, Mul, Sub};

/// Several numbers that are computed with at once.
///
/// Methods of the wide vectors become single instructions only when inlined into a function compiled for their level:
/// everything between [`Level::dispatch`](crate::Level::dispatch) and them is `#[inline(always)]`.
pub trait Vector:
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
    /// Asks the compiler to compute these vectors before anything that follows from them. It changes no number.
    #[inline(always)]
    fn before_others(_these: &mut [Self; 8], _and: &mut Self) {}
}

/// Eight numbers, one for each direction.
pub trait Octet: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
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

/// Evidence of AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub struct HasAvx2(pub(crate) ());

/// Evidence of AVX-512 (foundation), AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub struct HasAvx512(pub(crate) ());

#[cfg(target_arch = "x86_64")]
impl From<HasAvx512> for HasAvx2 {
    fn from(_: HasAvx512) -> Self {
        Self(())
    }
}
