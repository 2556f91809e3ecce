//! L1 norms of linear combinations of distributions, over all cells and angular samples.

use crate::pulses::SectorSums;
use crate::real::Real;
use crate::scattering::Scattering;
use core::f64::consts::FRAC_1_SQRT_2;
use std::ops::Range;
use tigereye_simd::Number;
use tigereye_simd::{Level, Octet, Proven, Task};

/// A linear combination of distributions: which ones, each with its factor.
pub type Combination<T> = Vec<(usize, T)>;

/// `sum_cells sum_t |sum_i f_i I_i(cell, t)|` (W/rad) of each of `combinations`, where `I_i` is the light of
/// `distributions[i]`, eight lobes a cell (W).
///
/// Panics where a distribution has not the size of the field or a combination names one that there is not.
#[must_use]
pub fn l1_norms<T: Real>(
    field: &Scattering<'_>,
    level: Level,
    distributions: &[&[[T; 8]]],
    combinations: &[Combination<T>],
) -> Vec<f64> {
    let cells = field.grid().cells();
    assert!(distributions.iter().all(|d| d.len() == cells), "distributions of the field's size");
    let width = field.grid().width();
    level.dispatch(Norms { sums: T::sector_sums(field), width, distributions, combinations })
}

struct Norms<'a, T> {
    sums: &'a SectorSums<T>,
    width: usize,
    distributions: &'a [&'a [[T; 8]]],
    combinations: &'a [Combination<T>],
}

impl<T: Real> Task for Norms<'_, T> {
    type Number = T;
    type Output = Vec<f64>;

    #[inline(always)]
    fn work<P: Proven<T>>(self, proof: P) -> Vec<f64> {
        let Self { sums, width, distributions, combinations } = self;
        let proof = proof.octet();
        let zero = [T::default(); 8];
        let mut totals = vec![0.0; combinations.len()];
        let mut rows = vec![zero; combinations.len()];
        let cells = distributions.first().map_or(0, |d| d.len());
        for first in (0..cells).step_by(width) {
            rows.fill(zero);
            // What all combinations read stays in the cache from one to the next.
            for start in (first..first + width).step_by(NEAR) {
                let near = start..(start + NEAR).min(first + width);
                for (row, terms) in rows.iter_mut().zip(combinations) {
                    let sum = <P::Octet as Octet>::load(proof, row);
                    let sum = match terms.len() {
                        2 => sum_near::<T, P::Octet, 2>(sums, proof, distributions, terms, near.clone(), sum),
                        3 => sum_near::<T, P::Octet, 3>(sums, proof, distributions, terms, near.clone(), sum),
                        4 => sum_near::<T, P::Octet, 4>(sums, proof, distributions, terms, near.clone(), sum),
                        6 => sum_near::<T, P::Octet, 6>(sums, proof, distributions, terms, near.clone(), sum),
                        _ => sum_near::<T, P::Octet, 0>(sums, proof, distributions, terms, near.clone(), sum),
                    };
                    sum.store(row);
                }
            }
            for (total, row) in totals.iter_mut().zip(&rows) {
                let [s0, s1, s2, s3, s4, s5, s6, s7] = row.map(Number::widened);
                *total += ((s0 + s4) + (s2 + s6)) + ((s1 + s5) + (s3 + s7));
            }
        }
        totals.iter().map(|total| total * sums.scale).collect()
    }
}

/// Cells whose distributions fit into the innermost cache together.
const NEAR: usize = 16;

/// Adds the sums of a combination in some cells of a row to `sum`. `K` is its number of terms, or 0 for any.
#[inline(always)]
fn sum_near<T: Number, O: Octet<Number = T>, const K: usize>(
    sums: &SectorSums<T>,
    proof: O::Proof,
    distributions: &[&[[T; 8]]],
    terms: &[(usize, T)],
    near: Range<usize>,
    mut sum: O,
) -> O {
    if K == 0 {
        for cell in near {
            let mut light = O::splat(proof, T::default());
            for &(i, factor) in terms {
                let lobes = O::load(proof, &distributions[i][cell]);
                light = lobes.mul_add(O::splat(proof, factor), light);
            }
            sum = sum + norm::<T, O>(sums, proof, light);
        }
        return sum;
    }
    let mut lobes: [&[[T; 8]]; K] = [&[]; K];
    let mut factors = [O::splat(proof, T::default()); K];
    for k in 0..K {
        lobes[k] = &distributions[terms[k].0][near.clone()];
        factors[k] = O::splat(proof, terms[k].1);
    }
    for cell in 0..near.len() {
        let mut light = O::splat(proof, T::default());
        for k in 0..K {
            light = O::load(proof, &lobes[k][cell]).mul_add(factors[k], light);
        }
        sum = sum + norm::<T, O>(sums, proof, light);
    }
    sum
}

/// The sums of one cell's samples, sector by sector, times `L` ([`SectorSums`] says how).
#[inline(always)]
fn norm<T: Number, O: Octet<Number = T>>(sums: &SectorSums<T>, proof: O::Proof, lobes: O) -> O {
    let diagonal = O::splat(proof, T::narrowed(FRAC_1_SQRT_2));
    let p = (lobes.previous() + lobes.next()).mul_add(diagonal, lobes);
    let after = p.next();
    let (sum, difference) = ((p + after).abs(), (p - after).abs());
    let mut norm = sum.mul_add(O::splat(proof, sums.middle), p.abs());
    for pair in &sums.pairs {
        let larger = sum.max(difference * O::splat(proof, pair.ratio));
        norm = larger.mul_add(O::splat(proof, pair.weight), norm);
    }
    norm
}
