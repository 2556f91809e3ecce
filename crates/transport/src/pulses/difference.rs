//! L1 differences of distributions over all cells and angular samples.
//!
//! In the sector from direction k to k + 1 the eight lobes add up to a function of the form `P cos u + Q sin u`, so it
//! is known from its values `p_k` and `p_{k+1}` at both ends: `v(u) = (p_k sin(45 deg - u) + p_{k+1} sin u) / sin 45
//! deg`. Two samples i and n - i that lie symmetrically in the sector (n = S/8 samples a sector) need not be visited
//! one by one: `|v_i| + |v_{n-i}| = max(|v_i + v_{n-i}|, |v_i - v_{n-i}|)`, where the sum is a multiple of `p_k +
//! p_{k+1}` and the difference one of `p_k - p_{k+1}`.

use crate::real::Real;
use crate::scattering::Scattering;
use crate::window::Window;
use core::f64::consts::FRAC_1_SQRT_2;
use tigereye_core::Cell;
use tigereye_simd::Number;
use tigereye_simd::{Level, Octet, Proven, Task};

use super::PulseDistribution;
use super::sector_sums::SectorSums;

/// Prefetch distance in cells: the hardware prefetcher stops at the end of a page.
const AHEAD: usize = 32;

impl<T: Number> SectorSums<T> {
    /// `sum_cells sum_t |sum_j (a_j - b_j) c_j(t)|`, W/rad, over the cells of a window in a grid of `width` columns:
    /// each row alone, then rows in order. Dark cells add exactly 0, so windows that hold all light give the same bits.
    #[inline(always)]
    fn l1<O: Octet<Number = T>>(
        &self,
        proof: O::Proof,
        width: usize,
        window: Window,
        [a, b]: [&[[T; 8]]; 2],
    ) -> f64 {
        let diagonal = O::splat(proof, T::narrowed(FRAC_1_SQRT_2));
        let middle = O::splat(proof, self.middle);
        let mut total = 0.0;
        for y in window.y0..=window.y1 {
            let (next_a, next_b) = (&a[y * width + window.x0..], &b[y * width + window.x0..]);
            let columns = window.x1 - window.x0 + 1;
            let (a, b) = (&next_a[..columns], &next_b[..columns]);
            let mut row = O::splat(proof, T::default());
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                O::expect(proof, &next_a[(i + AHEAD).min(next_a.len() - 1)]);
                O::expect(proof, &next_b[(i + AHEAD).min(next_b.len() - 1)]);
                let d = O::load(proof, a) - O::load(proof, b);
                let p = (d.previous() + d.next()).mul_add(diagonal, d);
                let after = p.next();
                let (sum, difference) = ((p + after).abs(), (p - after).abs());
                // Apart from the row's sum, which would make every cell wait for the one before.
                let mut cell = sum.mul_add(middle, p.abs());
                for pair in &self.pairs {
                    let larger = sum.max(difference * O::splat(proof, pair.ratio));
                    cell = larger.mul_add(O::splat(proof, pair.weight), cell);
                }
                row = row + cell;
            }
            let mut sectors = [T::default(); 8];
            row.store(&mut sectors);
            let [s0, s1, s2, s3, s4, s5, s6, s7] = sectors.map(Number::widened);
            total += ((s0 + s4) + (s2 + s6)) + ((s1 + s5) + (s3 + s7));
        }
        total * self.scale
    }
}

/// `sum over cells and samples of |b1 - b2|`, W/rad. Pulse samples count as 0 in their own cells.
#[must_use]
pub fn l1_difference<T: Real>(
    field: &Scattering<'_>,
    level: Level,
    b1: &PulseDistribution<T>,
    b2: &PulseDistribution<T>,
) -> f64 {
    let Some(window) = b1.window.into_iter().chain(b2.window).reduce(Window::union) else {
        return 0.0;
    };
    let l1 = distance(field, level, window, [b1.lobes(), b2.lobes()]);
    l1 + source_correction(field, b1, b2)
}

/// The L1 difference of the lobes of two distributions over a window, W/rad.
pub(super) fn distance<T: Real>(
    field: &Scattering<'_>,
    level: Level,
    window: Window,
    lobes: [&[[T; 8]]; 2],
) -> f64 {
    level.dispatch(Distance { sums: T::sector_sums(field), width: field.grid().width(), window, lobes })
}

/// [`SectorSums::l1`] of two distributions.
struct Distance<'a, T> {
    sums: &'a SectorSums<T>,
    width: usize,
    window: Window,
    lobes: [&'a [[T; 8]]; 2],
}

impl<T: Real> Task for Distance<'_, T> {
    type Number = T;
    type Output = f64;

    #[inline(always)]
    fn work<P: Proven<T>>(self, proof: P) -> f64 {
        self.sums.l1::<P::Octet>(proof.octet(), self.width, self.window, self.lobes)
    }
}

/// Correction of the L1 difference for the zeroed pulse samples, W/rad.
fn source_correction<T: Real>(
    field: &Scattering<'_>,
    b1: &PulseDistribution<T>,
    b2: &PulseDistribution<T>,
) -> f64 {
    let scheme = field.scheme();
    let zeroed = [(b1.source(), b1.sample()), (b2.source(), b2.sample())];
    let distinct = if zeroed[0] == zeroed[1] { 1 } else { 2 };
    let correction_at = |&(cell, t): &(Cell, usize)| {
        let i = field.grid().index(cell);
        let plain = |b: &PulseDistribution<T>| scheme.intensity(&b.lobes()[i].map(Number::widened), t);
        let value = |b, own| if own == (cell, t) { 0.0 } else { plain(b) };
        let right = (value(b1, zeroed[0]) - value(b2, zeroed[1])).abs();
        right - (plain(b1) - plain(b2)).abs()
    };
    zeroed[..distinct].iter().map(correction_at).sum()
}
