//! The transmission of a cell, in the form computed by the pulse lanes.
//!
//! Within 45 degrees of direction k, where the cone of direction k lies, the eight lobes add up to `p_k cos u + (sqrt 2
//! p_{k+-1} - p_k) |sin u|`, with u the angle from direction k, the sign that of u, and `p_k = a_k + (a_{k-1} +
//! a_{k+1}) / sqrt 2`, the intensity at direction k (times `L`). So `(M a)_k = B_- p_{k-1} + B_0 p_k + B_+ p_{k+1}`
//! with `B_0 = h sum w T (cos u - |sin u|) / L` and `B_+- = sqrt 2 h sum_{+-u > 0} w T |sin u| / L`. All terms are
//! positive, nothing cancels, and the matrix is the same for opposite directions: twelve numbers per cell, and for the
//! sum over k four more.

use crate::Scheme;
use core::f64::consts::{FRAC_1_SQRT_2, SQRT_2};
use tigereye_simd::Number;
use tigereye_simd::Vector;

/// One cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Passage<T> {
    /// `B_-`, `B_0`, `B_+` of rows k and k + 4.
    rows: [[T; 3]; 4],
    /// `sum_k (M a)_k = sum_m columns[m] (p_m + p_{m+4})`.
    columns: [T; 4],
    /// `Tbar`, 0 to 1.
    rate: T,
}

/// The light that leaves a cell.
pub(crate) struct Passed<V> {
    /// To each neighbour, W.
    pub(crate) phi: [V; 8],
    /// In total, W.
    pub(crate) total: V,
}

impl<T: Number> Passage<T> {
    /// The passage of a cell whose transmission profile is `rate` times `shape`, of mean 1.
    pub(crate) fn new(scheme: &Scheme, shape: &[f64], rate: f64) -> Self {
        let directions = scheme.directions();
        let s = shape.len();
        let scale = directions.step_rad() / scheme.lobe_integral();
        let mut rows = [[0.0; 3]; 4];
        for (k, row) in rows.iter_mut().enumerate() {
            for i in 0..=s / 8 {
                let [cos, sin] = directions.unit(i);
                let weighed = |t: usize| scale * scheme.weights(t % s)[k] * shape[t % s];
                let (after, before) = (weighed(k * s / 8 + i), weighed(k * s / 8 + s - i));
                row[1] += (cos - sin) * if i == 0 { after } else { after + before };
                row[2] += SQRT_2 * sin * after;
                row[0] += SQRT_2 * sin * before;
            }
        }
        let column = |m: usize| rows[m][1] + (rows[(m + 3) % 4][2] + rows[(m + 1) % 4][0]);
        Self {
            rows: rows.map(|row| row.map(T::narrowed)),
            columns: std::array::from_fn(|m| T::narrowed(column(m))),
            rate: T::narrowed(rate),
        }
    }

    /// `Tbar`, 0 to 1.
    pub(crate) const fn rate(&self) -> T {
        self.rate
    }

    /// `Phi = Tbar E (M a) / sum(M a)` with `E = sum a`; 0 if nothing is transmitted.
    ///
    /// Sixty-two operations and a division: 8 + 8 for p, 24 for M a, 7 for E and the sums of opposite p, 4 for sum(M
    /// a), 11 for the rest.
    #[inline(always)]
    pub(crate) fn pass<V: Vector<Number = T>>(&self, proof: V::Proof, a: &[V; 8]) -> Passed<V> {
        let (sides, mut p) = intensities(proof, a);
        // Sides 0 and 4 hold the odd directions, 1 and 5 the even ones.
        let energy = (sides[0] + sides[4]) + (sides[1] + sides[5]);
        let column = |m: usize| V::splat(proof, self.columns[m]);
        let pair = |m: usize| p[m] + p[m + 4];
        let mut sum = pair(0) * column(0);
        for m in 1..4 {
            sum = pair(m).mul_add(column(m), sum);
        }
        let mut factor = V::splat(proof, self.rate) * energy / (sum + V::splat(proof, T::TINY));
        // The division takes about as long as the products below. Where registers are few, compilers put it behind them
        // and its operands into memory.
        V::before_others(&mut p, &mut factor);
        let mut phi = self.scattered(proof, &p);
        for k in 0..8 {
            phi[k] = factor * phi[k];
        }
        Passed { phi, total: factor * sum }
    }

    /// The same with more light in one sample: `inject[k] * missing` is added to `(M a)_k`, `extra` to the energy.
    #[inline(always)]
    pub(crate) fn pass_with<V: Vector<Number = T>>(
        &self,
        proof: V::Proof,
        a: &[V; 8],
        inject: &[V; 8],
        missing: V,
        extra: V,
    ) -> [V; 8] {
        let (sides, p) = intensities(proof, a);
        let energy = (sides[0] + sides[4]) + (sides[1] + sides[5]) + extra;
        let mut ma = self.scattered(proof, &p);
        for k in 0..8 {
            ma[k] = inject[k].mul_add(missing, ma[k]);
        }
        let factor = V::splat(proof, self.rate) * energy / (sum_of_eight(&ma) + V::splat(proof, T::TINY));
        for k in 0..8 {
            ma[k] = factor * ma[k];
        }
        ma
    }

    /// `M a`.
    #[inline(always)]
    fn scattered<V: Vector<Number = T>>(&self, proof: V::Proof, p: &[V; 8]) -> [V; 8] {
        let mut ma = *p;
        for k in 0..8 {
            let row = &self.rows[k % 4];
            let b = |d: usize| V::splat(proof, row[d]);
            ma[k] = p[(k + 7) % 8].mul_add(b(0), p[(k + 1) % 8].mul_add(b(2), p[k] * b(1)));
        }
        ma
    }
}

/// `a_{k-1} + a_{k+1}` and `p_k` for each k.
#[inline(always)]
fn intensities<V: Vector>(proof: V::Proof, a: &[V; 8]) -> ([V; 8], [V; 8]) {
    let diagonal = V::splat(proof, V::Number::narrowed(FRAC_1_SQRT_2));
    let (mut sides, mut p) = (*a, *a);
    for k in 0..8 {
        sides[k] = a[(k + 7) % 8] + a[(k + 1) % 8];
        p[k] = sides[k].mul_add(diagonal, a[k]);
    }
    (sides, p)
}

/// Sum over the eight directions, opposite ones first.
#[inline(always)]
pub(crate) fn sum_of_eight<V: Vector>(a: &[V; 8]) -> V {
    ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]))
}
