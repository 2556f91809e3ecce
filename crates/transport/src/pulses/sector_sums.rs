//! The samples of a sector between two directions in symmetric pairs; [`super::difference`] has the derivation.

use crate::Scheme;
use core::f64::consts::FRAC_1_SQRT_2;
use tigereye_simd::Number;

/// Two symmetric samples of a sector: `|v_i| + |v_{n-i}| = weight * max(|p_k + p_{k+1}|, ratio * |p_k - p_{k+1}|)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<T> {
    pub(crate) weight: T,
    pub(crate) ratio: T,
}

/// Samples of a sector, the same for all eight.
#[derive(Clone, Debug)]
pub(crate) struct SectorSums<T> {
    pub(crate) pairs: Vec<Pair<T>>,
    /// Weight of `|p_k + p_{k+1}|`: the sample in the middle, if there is one.
    pub(crate) middle: T,
    /// `1/L`.
    pub(crate) scale: f64,
}

impl<T: Number> SectorSums<T> {
    pub(crate) fn new(scheme: &Scheme) -> Self {
        let directions = scheme.directions();
        let n = directions.count() / 8;
        let sine = |i: usize| directions.sin(i) / FRAC_1_SQRT_2;
        let pair = |i: usize| {
            let weight = sine(n - i) + sine(i);
            Pair { weight: T::narrowed(weight), ratio: T::narrowed((sine(n - i) - sine(i)) / weight) }
        };
        Self {
            pairs: (1..n.div_ceil(2)).map(pair).collect(),
            middle: T::narrowed(if n.is_multiple_of(2) { sine(n / 2) } else { 0.0 }),
            scale: 1.0 / scheme.lobe_integral(),
        }
    }
}
