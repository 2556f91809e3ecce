//! N delta pulses of one cell, one in each lane.

use crate::Scheme;
use crate::pulses::passage::{Passage, sum_of_eight};
use tigereye_core::Cell;
use tigereye_simd::Number;
use tigereye_simd::Vector;

/// The pulses' own terms: each keeps one sample of the source cell at the value S.
pub(crate) struct Source<T, const N: usize> {
    cell: Cell,
    /// Contribution of one W/rad in the sample to `M a`, for each direction and lane.
    inject: [[T; N]; 8],
    /// The lobes' intensity at the sample, 1/rad.
    lobe_at_sample: [[T; N]; 8],
    height: T,
    step_rad: T,
}

impl<T: Number, const N: usize> Source<T, N> {
    /// `shape` is the cell's transmission profile, of mean 1.
    pub(crate) fn new(scheme: &Scheme, shape: &[f64], cell: Cell, samples: &[usize; N]) -> Self {
        let h = scheme.directions().step_rad();
        let inject = |k: usize, t: usize| T::narrowed(h * scheme.weights(t)[k] * shape[t]);
        Self {
            cell,
            inject: std::array::from_fn(|k| samples.map(|t| inject(k, t))),
            lobe_at_sample: std::array::from_fn(|j| samples.map(|t| T::narrowed(scheme.lobes(t)[j]))),
            height: T::narrowed(scheme.directions().count() as f64),
            step_rad: T::narrowed(h),
        }
    }

    pub(crate) const fn cell(&self) -> Cell {
        self.cell
    }

    /// The energy that the pulses add to the arriving light, W.
    pub(crate) fn missing_energy(&self, arriving: &[[T; N]; 8]) -> [f64; N] {
        std::array::from_fn(|l| {
            let at_sample = |k: usize| arriving[k][l].widened() * self.lobe_at_sample[k][l].widened();
            self.step_rad.widened() * (self.height.widened() - (0..8).map(at_sample).sum::<f64>())
        })
    }

    /// The light emitted in the `c`-th vector of lanes, given the arriving light `a`.
    #[inline(always)]
    pub(crate) fn passed<V: Vector<Number = T>>(
        &self,
        proof: V::Proof,
        c: usize,
        passage: &Passage<T>,
        a: &[V; 8],
    ) -> [V; 8] {
        let (mut inject, mut at_sample) = (*a, *a);
        for k in 0..8 {
            inject[k] = V::load(proof, &self.inject[k], c);
            at_sample[k] = a[k] * V::load(proof, &self.lobe_at_sample[k], c);
        }
        let missing = V::splat(proof, self.height) - sum_of_eight(&at_sample);
        passage.pass_with(proof, a, &inject, missing, V::splat(proof, self.step_rad) * missing)
    }
}
