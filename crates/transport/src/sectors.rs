//! Sums over angular samples without visiting lobes one by one.
//!
//! Between 45k and 45(k+1) degrees only four lobes differ from 0 and their sum is `P cos + Q sin` of the angle from
//! 45k.

use crate::Scheme;
use core::f64::consts::FRAC_1_SQRT_2;

/// Samples of one 45-degree sector, the same for all eight.
#[derive(Clone, Debug)]
pub(crate) struct Sectors {
    /// `cos` and `sin` of the angle from the sector's start, over `L`: sample i of S/8.
    unit: Vec<[f64; 2]>,
}

impl Sectors {
    pub(crate) fn new(scheme: &Scheme) -> Self {
        let d = scheme.directions();
        let l = scheme.lobe_integral();
        Self { unit: (0..d.count() / 8).map(|i| d.unit(i).map(|v| v / l)).collect() }
    }

    /// `sum_t |sum_j a_j c_j(t)|`.
    pub(crate) fn l1(&self, a: &[f64; 8]) -> f64 {
        let mut sum = 0.0;
        for k in 0..8 {
            let (before, here, next, after) = (a[(k + 7) % 8], a[k], a[(k + 1) % 8], a[(k + 2) % 8]);
            let p = here + FRAC_1_SQRT_2 * (before + next);
            let q = after + FRAC_1_SQRT_2 * (next - before);
            for &[c, s] in &self.unit {
                sum += (p * c + q * s).abs();
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SharedWeights;
    use tigereye_core::Directions;

    #[test]
    fn sector_sums_equal_sample_sums() {
        for s in [8, 16, 32, 64, 360] {
            let scheme = Scheme::new(Directions::new(s).expect("directions"), SharedWeights::Thesis);
            let sectors = Sectors::new(&scheme);
            let a = [0.3, -1.0, 0.0, 2.0, -0.7, 0.1, 5.0, -0.2];
            let b = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
            let by_sample = |a: &[f64; 8]| (0..s).map(|t| scheme.intensity(a, t).abs()).sum::<f64>();
            for lobes in [a, b] {
                let (got, expected) = (sectors.l1(&lobes), by_sample(&lobes));
                assert!((got - expected).abs() < 1e-14 * s as f64, "S = {s}: {got} and {expected}");
            }
        }
    }
}
