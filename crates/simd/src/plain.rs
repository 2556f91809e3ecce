//! Vectors that every processor has: arrays.

use crate::number::Number;
use crate::vector::{Octet, Vector};
use core::ops::{Add, Div, Mul, Sub};

/// The vector of every processor.
#[derive(Clone, Copy, Debug)]
pub struct Plain<T, const W: usize>([T; W]);

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

macro_rules! operators {
    ($($trait:ident $method:ident),*) => {$(
        impl<T: Number, const W: usize> $trait for Plain<T, W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, T::$method)
            }
        }
    )*};
}

operators!(Add add, Sub sub, Mul mul, Div div);
