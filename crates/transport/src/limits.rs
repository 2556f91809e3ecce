//! What bounds the speed of the pulse lanes on a machine: work without memory, and memory without work.
//!
//! This crate reads no clocks: whoever wants a rate times these functions.

use crate::Real;
use crate::aligned::Aligned;
use core::hint::black_box;
use core::marker::PhantomData;
use tigereye_core::Grid;
use tigereye_simd::{Level, Proven, Task, Vector};

/// Multiplications, fused or not, of one update of one cell in one lane ([`PulseSolver`](crate::PulseSolver)).
const PRODUCTS: usize = 46;
/// Additions of the same.
const SUMS: usize = 16;
/// Chains of operations that do not wait for each other: enough to hide latencies, few enough for sixteen registers.
const PRODUCT_CHAINS: usize = 10;
const SUM_CHAINS: usize = 3;

/// Does the arithmetic of at least `updates` updates of a cell, and nothing else: as many fused multiply-adds,
/// additions and divisions, all in registers. Returns how many updates it was.
///
/// Their rate is the arithmetic limit.
#[must_use]
pub fn arithmetic<T: Real>(level: Level, updates: u64) -> u64 {
    level.dispatch(Arithmetic::<T> { updates, number: PhantomData })
}

struct Arithmetic<T> {
    updates: u64,
    number: PhantomData<T>,
}

impl<T: Real> Task for Arithmetic<T> {
    type Number = T;
    type Output = u64;

    #[inline(always)]
    fn work<P: Proven<T>>(self, proof: P) -> u64 {
        arithmetic_with::<P::Vector>(proof.vector(), self.updates)
    }
}

#[inline(always)]
fn arithmetic_with<V: Vector>(proof: V::Proof, updates: u64) -> u64 {
    let number = |x: f64| V::splat(proof, tigereye_simd::Number::narrowed(black_box(x)));
    let (factor, term) = (number(0.999), number(1e-3));
    let mut products = [term; PRODUCT_CHAINS];
    let mut sums = [term; SUM_CHAINS];
    let mut quotient = term;
    let rounds = updates.div_ceil(V::WIDTH as u64);
    for _ in 0..rounds {
        // Written so that all of it is unrolled: every chain stays in its register.
        for turn in 0..PRODUCTS.div_ceil(PRODUCT_CHAINS) {
            for (i, product) in products.iter_mut().enumerate() {
                if turn * PRODUCT_CHAINS + i < PRODUCTS {
                    *product = product.mul_add(factor, term);
                }
            }
        }
        for turn in 0..SUMS.div_ceil(SUM_CHAINS) {
            for (i, sum) in sums.iter_mut().enumerate() {
                if turn * SUM_CHAINS + i < SUMS {
                    *sum = *sum + term;
                }
            }
        }
        quotient = term / quotient;
    }
    let all = products.into_iter().chain(sums).fold(quotient, |a, b| a + b);
    let mut sink = [0.0; 16];
    if V::WIDTH <= 16 {
        all.add_to(&mut sink, 0);
    }
    black_box(sink);
    rounds * V::WIDTH as u64
}

/// The memory that the light of full lanes takes on a grid.
pub struct Traffic<T> {
    numbers: Aligned<T>,
    cells: u64,
}

impl<T: Real> Traffic<T> {
    /// Memory for `grid`.
    #[must_use]
    pub fn new(grid: Grid) -> Self {
        // The ring of ghost cells around them is hardly touched by a step.
        Self { numbers: Aligned::zeros(grid.cells() * 8 * T::LANES), cells: grid.cells() as u64 }
    }

    /// Reads and writes every number once, as a step does, and nothing else. Returns how many updates of a cell in a
    /// lane would have moved as much.
    ///
    /// Their rate is the limit of moving the state once a step; fused steps may pass it.
    pub fn pass(&mut self, level: Level) -> u64 {
        level.dispatch(Touch(self.numbers.as_mut_slice()));
        black_box(self.numbers.as_slice());
        self.cells * T::LANES as u64
    }
}

struct Touch<'a, T>(&'a mut [T]);

impl<T: Real> Task for Touch<'_, T> {
    type Number = T;
    type Output = ();

    #[inline(always)]
    fn work<P: Proven<T>>(self, proof: P) {
        touch_with::<P::Vector>(proof.vector(), self.0);
    }
}

#[inline(always)]
fn touch_with<V: Vector>(proof: V::Proof, numbers: &mut [V::Number]) {
    let one = V::splat(proof, tigereye_simd::Number::narrowed(black_box(1.0)));
    for line in numbers.as_chunks_mut::<16>().0 {
        for c in 0..16 / V::WIDTH {
            (V::load(proof, line, c) + one).store(line, c);
        }
    }
}
