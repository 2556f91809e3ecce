//! Products and inverses of dense matrices, with the same bits at every level.
//!
//! A product `C += A B` adds up the terms of each number in order of the inner index, fused, whatever the width of the
//! vectors: `B` and `C` are cut into tiles of N columns, `A` into panels of six rows.

use super::parallel::Parallel;
use crate::real::Real;
use std::cmp::Ordering;
use std::ops::Range;
use std::sync::Mutex;
use tigereye_simd::{Level, Proven, Task, Vector};

/// Heights of the panels that `A` is cut into, the largest that fits first. Six rows with four vectors of AVX-512, or
/// with two of narrower levels, fill the registers.
const PANELS: [usize; 4] = [6, 4, 2, 1];

/// The rows of each panel of a matrix, from the first row on.
fn panels(rows: usize) -> impl Iterator<Item = Range<usize>> {
    let mut next = 0;
    std::iter::from_fn(move || {
        let height = PANELS.into_iter().find(|p| *p <= rows - next)?;
        next += height;
        Some(next - height..next)
    })
}

/// N numbers side by side, one for each lane, where vectors never straddle two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Lanes<T, const N: usize>(pub [T; N]);

impl<T: Real, const N: usize> Lanes<T, N> {
    /// 0 in every lane.
    #[must_use]
    pub fn zero() -> Self {
        Self([T::from_f64(0.0); N])
    }
}

/// A matrix in tiles of N columns; the columns of the last one that the matrix lacks are 0.
#[derive(Clone, Debug)]
pub(super) struct Tiles<T, const N: usize> {
    rows: usize,
    columns: usize,
    data: Vec<Lanes<T, N>>,
}

impl<T: Real, const N: usize> Tiles<T, N> {
    pub(super) fn zero(rows: usize, columns: usize) -> Self {
        Self { rows, columns, data: vec![Lanes::zero(); rows * columns.div_ceil(N)] }
    }

    pub(super) fn from_fn(rows: usize, columns: usize, value: impl Fn(usize, usize) -> T) -> Self {
        let mut m = Self::zero(rows, columns);
        for (i, lanes) in m.data.iter_mut().enumerate() {
            let (tile, row) = (i / rows, i % rows);
            for (lane, v) in lanes.0.iter_mut().enumerate().take(columns - tile * N) {
                *v = value(row, tile * N + lane);
            }
        }
        m
    }

    pub(super) fn at(&self, row: usize, column: usize) -> T {
        self.data[column / N * self.rows + row].0[column % N]
    }

    /// The rows and columns of a list each.
    pub(super) fn part(&self, rows: &[u32], columns: &[u32]) -> Self {
        Self::from_fn(rows.len(), columns.len(), |r, c| self.at(rows[r] as usize, columns[c] as usize))
    }

    /// `self += a b`.
    fn add_product(&mut self, a: &Packed<T>, b: &Self, level: Level, parallel: &dyn Parallel) {
        assert!(self.rows == a.rows && self.columns == b.columns && a.depth == b.rows, "matrices that fit");
        if self.data.is_empty() || b.rows == 0 {
            return;
        }
        let tiles: Vec<_> = self.data.chunks_mut(self.rows).map(Mutex::new).collect();
        let one = |tile: usize| {
            let c = &mut *tiles[tile].lock().expect("a product does not panic");
            level.dispatch(Product { a, b: &b.data[tile * b.rows..(tile + 1) * b.rows], c });
        };
        parallel.for_each(tiles.len(), &one);
    }

    /// `self + a b`.
    pub(super) fn plus_product(
        mut self,
        a: &Packed<T>,
        b: &Self,
        level: Level,
        parallel: &dyn Parallel,
    ) -> Self {
        self.add_product(a, b, level, parallel);
        self
    }
}

/// The left factor of products, panel by panel, each column by column.
#[derive(Clone, Debug)]
pub(super) struct Packed<T> {
    rows: usize,
    depth: usize,
    data: Vec<T>,
}

/// A [`Packed`] matrix whose numbers lie elsewhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct PackedSlice<'a, T> {
    rows: usize,
    depth: usize,
    data: &'a [T],
}

impl<T: Real> Packed<T> {
    pub(super) fn from_fn(rows: usize, depth: usize, value: impl Fn(usize, usize) -> T) -> Self {
        let mut data = Vec::with_capacity(rows * depth);
        for panel in panels(rows) {
            for column in 0..depth {
                data.extend(panel.clone().map(|row| value(row, column)));
            }
        }
        Self { rows, depth, data }
    }

    pub(super) fn of<const N: usize>(m: &Tiles<T, N>) -> Self {
        Self::from_fn(m.rows, m.columns, |r, c| m.at(r, c))
    }

    fn negative_of<const N: usize>(m: &Tiles<T, N>) -> Self {
        Self::from_fn(m.rows, m.columns, |r, c| T::default() - m.at(r, c))
    }

    /// The numbers, to be kept beside those of other matrices.
    pub(super) fn numbers(&self) -> &[T] {
        &self.data
    }

    pub(super) fn as_slice(&self) -> PackedSlice<'_, T> {
        PackedSlice { rows: self.rows, depth: self.depth, data: &self.data }
    }
}

impl<'a, T: Real> PackedSlice<'a, T> {
    /// The first `rows * depth` of `numbers` as a matrix, and the numbers after them.
    #[inline(always)]
    pub(super) fn split_from(numbers: &'a [T], [rows, depth]: [usize; 2]) -> (Self, &'a [T]) {
        let (data, rest) = numbers.split_at(rows * depth);
        (Self { rows, depth, data }, rest)
    }

    /// `c += self b`, with as many rows of `b` as columns and of `c` as rows.
    #[inline(always)]
    pub(super) fn add_to<P: Proven<T>, const N: usize>(
        &self,
        proof: P,
        b: &[Lanes<T, N>],
        c: &mut [Lanes<T, N>],
    ) {
        let b = &b[..self.depth];
        let mut rest = self.data;
        for rows in panels(self.rows) {
            let (panel, after) = rest.split_at(rows.len() * self.depth);
            rest = after;
            let c = &mut c[rows];
            match c.len() {
                1 => add_panel::<P::Vector, N, 1>(proof.vector(), panel, b, c),
                2 => add_panel::<P::Vector, N, 2>(proof.vector(), panel, b, c),
                4 => add_panel::<P::Vector, N, 4>(proof.vector(), panel, b, c),
                _ => add_panel::<P::Vector, N, 6>(proof.vector(), panel, b, c),
            }
        }
    }
}

/// One panel, in groups of as many vectors as there are registers for.
#[inline(always)]
fn add_panel<V: Vector, const N: usize, const R: usize>(
    proof: V::Proof,
    a: &[V::Number],
    b: &[Lanes<V::Number, N>],
    c: &mut [Lanes<V::Number, N>],
) {
    let wide = V::WIDTH * size_of::<V::Number>() >= 64;
    if wide && N.is_multiple_of(4 * V::WIDTH) {
        for group in 0..N / (4 * V::WIDTH) {
            add_group::<V, N, R, 4>(proof, a, b, c, group);
        }
    } else {
        for group in 0..N / (2 * V::WIDTH) {
            add_group::<V, N, R, 2>(proof, a, b, c, group);
        }
    }
}

#[inline(always)]
fn add_group<V: Vector, const N: usize, const R: usize, const G: usize>(
    proof: V::Proof,
    a: &[V::Number],
    b: &[Lanes<V::Number, N>],
    c: &mut [Lanes<V::Number, N>],
    group: usize,
) {
    let mut sums = [[V::splat(proof, V::Number::default()); G]; R];
    for (r, sums) in sums.iter_mut().enumerate() {
        for (g, sum) in sums.iter_mut().enumerate() {
            *sum = V::load(proof, &c[r].0, group * G + g);
        }
    }
    for (a, b) in a.as_chunks::<R>().0.iter().zip(b) {
        let mut row = [V::splat(proof, V::Number::default()); G];
        for (g, v) in row.iter_mut().enumerate() {
            *v = V::load(proof, &b.0, group * G + g);
        }
        for r in 0..R {
            let factor = V::splat(proof, a[r]);
            for g in 0..G {
                sums[r][g] = row[g].mul_add(factor, sums[r][g]);
            }
        }
    }
    for (r, sums) in sums.iter().enumerate() {
        for (g, sum) in sums.iter().enumerate() {
            sum.store(&mut c[r].0, group * G + g);
        }
    }
}

struct Product<'a, T, const N: usize> {
    a: &'a Packed<T>,
    b: &'a [Lanes<T, N>],
    c: &'a mut [Lanes<T, N>],
}

impl<T: Real, const N: usize> Task for Product<'_, T, N> {
    type Number = T;
    type Output = ();

    #[inline(always)]
    fn work<P: Proven<T>>(self, proof: P) {
        self.a.as_slice().add_to(proof, self.b, self.c);
    }
}

/// A pivot below its limit: of the light that goes there, next to nothing ever leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SmallPivot;

/// The inverse of `I - x`, where `x` passes light on and never more than there is: a diagonally dominant matrix, which
/// needs no exchange of rows. Fails where a pivot is not above `smallest`.
pub(super) fn inverse_of_one_minus<T: Real, const N: usize>(
    x: &Tiles<T, N>,
    smallest: T,
    level: Level,
    parallel: &dyn Parallel,
) -> Result<Tiles<T, N>, SmallPivot> {
    let one = T::from_f64(1.0);
    let m = Tiles::from_fn(
        x.rows,
        x.rows,
        |r, c| {
            if r == c { one - x.at(r, c) } else { T::default() - x.at(r, c) }
        },
    );
    inverse(m, smallest, level, parallel)
}

/// Rows of matrices that are inverted by elimination. The same for all numbers of lanes, so that the bits are, too.
const SMALL: usize = 32;

/// By halves: with `[[a, b], [c, d]]` and `s = d - c a^-1 b`, the inverse is
/// `[[a^-1 + a^-1 b s^-1 c a^-1, -a^-1 b s^-1], [-s^-1 c a^-1, s^-1]]`.
fn inverse<T: Real, const N: usize>(
    m: Tiles<T, N>,
    smallest: T,
    level: Level,
    parallel: &dyn Parallel,
) -> Result<Tiles<T, N>, SmallPivot> {
    let n = m.rows;
    if n <= SMALL {
        return small_inverse(m, smallest, level);
    }
    let half = (n / 2).div_ceil(SMALL) * SMALL;
    let block = |r0: usize, r1: usize, c0: usize, c1: usize| {
        Tiles::<T, N>::from_fn(r1 - r0, c1 - c0, |r, c| m.at(r0 + r, c0 + c))
    };
    let (b, c, d) = (block(0, half, half, n), block(half, n, 0, half), block(half, n, half, n));
    let a_inverse = inverse(block(0, half, 0, half), smallest, level, parallel)?;
    let packed = Packed::of(&a_inverse);
    let zero = Tiles::zero;
    let a_b = zero(half, n - half).plus_product(&packed, &b, level, parallel);
    let c_a = zero(n - half, half).plus_product(&Packed::of(&c), &a_inverse, level, parallel);
    let s = d.plus_product(&Packed::negative_of(&c), &a_b, level, parallel);
    let s_inverse = inverse(s, smallest, level, parallel)?;
    let minus_s = Packed::negative_of(&s_inverse);
    let lower = zero(n - half, half).plus_product(&minus_s, &c_a, level, parallel);
    let minus_a_b = Packed::negative_of(&a_b);
    let right = zero(half, n - half).plus_product(&minus_a_b, &s_inverse, level, parallel);
    let upper = a_inverse.plus_product(&minus_a_b, &lower, level, parallel);
    Ok(Tiles::from_fn(n, n, |r, c| match (r < half, c < half) {
        (true, true) => upper.at(r, c),
        (true, false) => right.at(r, c - half),
        (false, true) => lower.at(r - half, c),
        (false, false) => s_inverse.at(r - half, c - half),
    }))
}

/// Gauss and Jordan's elimination in place, for a matrix of one tile.
fn small_inverse<T: Real, const N: usize>(
    mut m: Tiles<T, N>,
    smallest: T,
    level: Level,
) -> Result<Tiles<T, N>, SmallPivot> {
    level.dispatch(Elimination { rows: &mut m.data, smallest })?;
    Ok(m)
}

struct Elimination<'a, T, const N: usize> {
    rows: &'a mut [Lanes<T, N>],
    smallest: T,
}

impl<T: Real, const N: usize> Task for Elimination<'_, T, N> {
    type Number = T;
    type Output = Result<(), SmallPivot>;

    #[inline(always)]
    fn work<P: Proven<T>>(self, _: P) -> Result<(), SmallPivot> {
        let (zero, one) = (T::default(), T::from_f64(1.0));
        for p in 0..self.rows.len() {
            let pivot = self.rows[p].0[p];
            // Not `<=`: NaN is refused, too.
            if pivot.partial_cmp(&self.smallest) != Some(Ordering::Greater) {
                return Err(SmallPivot);
            }
            // The pivot's row is divided by it; the column of the inverse takes the place of the one eliminated.
            self.rows[p].0[p] = one;
            let inverse = one / pivot;
            for v in &mut self.rows[p].0 {
                *v = *v * inverse;
            }
            let row = self.rows[p];
            for (r, other) in self.rows.iter_mut().enumerate() {
                if r == p {
                    continue;
                }
                let factor = zero - other.0[p];
                other.0[p] = zero;
                for (v, w) in other.0.iter_mut().zip(&row.0) {
                    *v = w.mul_add(factor, *v);
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::parallel::Serial;

    /// Columns that add up to less than 1, as those of passages do.
    fn passage(n: usize) -> Tiles<f64, 32> {
        let raw = |r: usize, c: usize| ((r * 37 + c * 101 + r * c) % 17) as f64;
        Tiles::from_fn(n, n, |r, c| 0.95 * raw(r, c) / (0..n).map(|r| raw(r, c)).sum::<f64>().max(1.0))
    }

    #[test]
    fn inverse_times_matrix_is_one() {
        for n in [1, 5, 31, 32, 33, 100, 133] {
            let x = passage(n);
            let inverse =
                inverse_of_one_minus(&x, 1e-13, Level::detect(), &Serial).expect("light that leaves");
            for r in 0..n {
                for c in 0..n {
                    let product = (0..n)
                        .map(|k| inverse.at(r, k) * (f64::from(u8::from(k == c)) - x.at(k, c)))
                        .sum::<f64>();
                    let expected = f64::from(u8::from(r == c));
                    assert!((product - expected).abs() < 1e-13, "n = {n}, {r}, {c}: {product}");
                }
            }
        }
    }

    #[test]
    fn every_level_gives_the_same_bits() {
        let x = passage(77);
        let inverses: Vec<_> = Level::available()
            .into_iter()
            .map(|level| inverse_of_one_minus(&x, 1e-13, level, &Serial).expect("light that leaves"))
            .collect();
        for inverse in &inverses {
            for r in 0..77 {
                for c in 0..77 {
                    assert_eq!(inverse.at(r, c).to_bits(), inverses[0].at(r, c).to_bits());
                }
            }
        }
    }

    #[test]
    fn closed_rooms_have_no_inverse() {
        let x = Tiles::<f64, 32>::from_fn(2, 2, |r, c| f64::from(u8::from(r != c)));
        assert_eq!(inverse_of_one_minus(&x, 1e-13, Level::detect(), &Serial).err(), Some(SmallPivot));
    }
}
