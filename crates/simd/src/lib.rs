//! Vectors of several instruction sets behind two traits, and the hot loops compiled for each, chosen once at run time.
//!
//! The loops are written once. Products and sums are fused (`fma`) at every level, in the same places, and lanes never
//! mix: every level and every number of lanes gives the same bits. A processor without the instruction pays for it with
//! a function call; all that have AVX2 in fact have it too.
//!
//! The project's only `unsafe` is here and in `x86`. Its invariants:
//! - [`Level`]'s field cannot be set from outside, and [`Level::available`] lists a level only where the processor has
//!   its instructions. So a function compiled for a level may be called once a `Level` says so.
//! - A vector of a level is only made from that level's proof (`HasAvx2`, `HasAvx512`), and a proof is only made
//!   where a `Level` says so. So whoever holds a vector may use its instructions.
//! - Loads and stores take references to whole arrays, check that the part they want lies inside, and ask for no
//!   alignment. So they never leave them.
#![allow(unsafe_code)]

mod number;
mod plain;
mod vector;
#[cfg(target_arch = "x86_64")]
mod x86;

#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::{__m256, __m256d, __m512, __m512d};
pub use number::Number;
use plain::Plain;
#[cfg(target_arch = "x86_64")]
use vector::{HasAvx2, HasAvx512};
pub use vector::{Octet, Vector};
#[cfg(target_arch = "x86_64")]
use x86::{Avx2, Avx512};

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

/// Vectors and octets of a number type at every level.
pub trait Vectors: Number {
    /// The vector of every processor.
    type Baseline: Vector<Number = Self, Proof = ()>;
    /// The octet of every processor.
    type BaselineOctet: Octet<Number = Self, Proof = ()>;
    /// The vector of AVX2.
    #[cfg(target_arch = "x86_64")]
    type Avx2: Vector<Number = Self, Proof = HasAvx2>;
    /// The octet of AVX2.
    #[cfg(target_arch = "x86_64")]
    type Avx2Octet: Octet<Number = Self, Proof = HasAvx2>;
    /// The vector of AVX-512.
    #[cfg(target_arch = "x86_64")]
    type Avx512: Vector<Number = Self, Proof = HasAvx512>;
    /// The octet of AVX-512.
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

/// A hot loop, written once for the vectors of every level.
pub trait Task: Sized {
    /// What it computes with.
    type Number: Vectors;
    /// What it gives.
    type Output;
    /// How many lanes it has to fill vectors with.
    const LANES: usize = 16;

    /// The loop. `#[inline(always)]`, so that it is compiled for the level.
    fn work<P: Proven<Self::Number>>(self, proof: P) -> Self::Output;
}

/// A loop over arrays that the compiler itself turns into vectors.
pub trait ArrayLoop {
    /// What it gives.
    type Output;

    /// The loop. `#[inline(always)]`, so that it is compiled for the level.
    fn run(self) -> Self::Output;
}

/// An array loop as a task; it asks for no vectors.
struct Compiled<L>(L);

impl<L: ArrayLoop> Task for Compiled<L> {
    type Number = f32;
    type Output = L::Output;

    #[inline(always)]
    fn work<P: Proven<f32>>(self, _: P) -> L::Output {
        self.0.run()
    }
}

/// The vectors of a level, where the processor has its instructions.
pub trait Proven<T>: Copy {
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
    /// Runs a loop compiled for this level. Fused products are rounded once at every level, so the bits are the same.
    pub fn compiled<L: ArrayLoop>(self, array_loop: L) -> L::Output {
        self.dispatch(Compiled(array_loop))
    }

    /// Does a task with the widest vectors of this level that its lanes fill.
    pub fn dispatch<K: Task>(self, task: K) -> K::Output {
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
