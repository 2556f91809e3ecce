//! The constants of the scheme: cone weights and cosine lobes (thesis, sections 3.2 and 3.3).
//!
//! ```text
//!            k=2
//!       k=3   |   k=1        face cones    (k even): 90 degrees wide, full weight in the core of 36.87 degrees,
//!          \  |  /                          e1 outside of it, shared with the diagonal beside
//!   k=4 ----- + ----- k=0    diagonal cones (k odd): 53.13 degrees wide, weight e2
//!          /  |  \
//!       k=5   |   k=7        for S a multiple of 8 the eight weights of every sample add up to exactly 1
//!            k=6
//! ```

use tigereye_core::{Directions, choice, math};

/// How the light in the overlap of a face cone and a diagonal cone is shared (eqs. 3.1 and 3.2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SharedWeights {
    /// `e1 = 0.36229`, as printed and as used for every published result. (The printed value corresponds to a
    /// half-angle of beta - 1 degree.)
    #[default]
    Thesis,
    /// `e1 = 0.371201`: the value that eqs. 3.1 and 3.2 give for beta = atan(1/2).
    Geometric,
}

choice!(SharedWeights {
    Thesis = "thesis": "The printed constants.",
    Geometric = "geometric": "The values of their formula for beta = atan(1/2).",
});

impl SharedWeights {
    /// Weight of the face cone in the overlap.
    #[must_use]
    pub fn e1(self) -> f64 {
        match self {
            Self::Thesis => 0.362_290_990_872_258_4,
            Self::Geometric => {
                let beta_over_alpha_plus_2_beta = math::degrees(half_angle_beta_rad()) / 90.0;
                beta_over_alpha_plus_2_beta / (beta_over_alpha_plus_2_beta + 0.5)
            }
        }
    }
    /// Weight of the diagonal cone, `1 - e1`.
    #[must_use]
    pub fn e2(self) -> f64 {
        1.0 - self.e1()
    }
}

/// What a cell does to light that arrives from several sides at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ScatteringRule {
    /// The sum of all light in a cell is normalised at once (eqs. 3.12 to 3.14), as in every published result: light
    /// from one side changes what becomes of light from another.
    #[default]
    Joint,
    /// Every photon goes its own way (eq. 3.15): light superposes.
    Linear,
}

choice!(ScatteringRule {
    Joint = "joint": "All light in a cell is normalised at once, as in the thesis's results.",
    Linear = "linear": "Every photon goes its own way: light superposes.",
});

/// Half-angle of a diagonal cone, `beta = atan(1/2)`, radians.
#[must_use]
pub fn half_angle_beta_rad() -> f64 {
    math::atan(0.5)
}

/// Half of the core of a face cone, `alpha/2 = 45 degrees - beta`, radians.
#[must_use]
pub fn half_core_alpha_rad() -> f64 {
    math::FRAC_PI_4 - half_angle_beta_rad()
}

/// The tables that depend only on the number of directions: computed once, shared by every propagation.
#[derive(Clone, Debug, PartialEq)]
pub struct Scheme {
    directions: Directions,
    shared: SharedWeights,
    scattering: ScatteringRule,
    weights: Vec<[f64; 8]>,
    lobes: Vec<[f64; 8]>,
    lobe_integral: f64,
}

impl Scheme {
    /// The thesis's scheme for `directions`, with joint scattering.
    #[must_use]
    pub fn new(directions: Directions, shared: SharedWeights) -> Self {
        let n = directions.count();
        let lobe_integral = directions.step_rad() * (0..n).map(|t| directions.cos(t).max(0.0)).sum::<f64>();
        let per_neighbour = |f: &dyn Fn(usize, usize) -> f64| -> Vec<[f64; 8]> {
            (0..n).map(|t| std::array::from_fn(|k| f(k, t))).collect()
        };
        Self {
            directions,
            shared,
            scattering: ScatteringRule::Joint,
            weights: per_neighbour(&|k, t| cone_weight(directions, shared, k, t)),
            lobes: per_neighbour(&|k, t| {
                directions.cos(t + n - directions.of_neighbour(k)).max(0.0) / lobe_integral
            }),
            lobe_integral,
        }
    }

    /// The same weights and lobes with another rule of scattering.
    #[must_use]
    pub fn with_scattering(self, scattering: ScatteringRule) -> Self {
        Self { scattering, ..self }
    }
    /// The rule of scattering.
    #[must_use]
    pub const fn scattering(&self) -> ScatteringRule {
        self.scattering
    }
    /// The angular sampling.
    #[must_use]
    pub const fn directions(&self) -> Directions {
        self.directions
    }
    /// The sharing rule.
    #[must_use]
    pub const fn shared_weights(&self) -> SharedWeights {
        self.shared
    }
    /// `w_k(t)` for k = 0..8: the part of sample `t` that goes to neighbour `k`.
    #[must_use]
    pub fn weights(&self, t: usize) -> &[f64; 8] {
        &self.weights[t]
    }
    /// `c_k(t)` for k = 0..8: unit-flux cosine lobes, 1/rad (`h * sum_t c_k(t) = 1`).
    #[must_use]
    pub fn lobes(&self, t: usize) -> &[f64; 8] {
        &self.lobes[t]
    }
    /// `L = h * sum_t max(0, cos omega_t)`, close to 2 (eq. 3.9).
    #[must_use]
    pub const fn lobe_integral(&self) -> f64 {
        self.lobe_integral
    }
    /// Radiant intensity (W/rad) at sample `t` of the eight lobes with fluxes `a` (W).
    ///
    /// Only the four lobes of the 45-degree sector differ from 0.
    #[must_use]
    pub fn intensity(&self, a: &[f64; 8], t: usize) -> f64 {
        let sector = t * 8 / self.directions.count();
        let c = &self.lobes[t];
        let [j0, j1, j2, j3] = sector_lobes(sector);
        (a[j0] * c[j0] + a[j1] * c[j1]) + (a[j2] * c[j2] + a[j3] * c[j3])
    }
}

/// The lobes that differ from 0 between 45k and 45(k+1) degrees: k-1, k, k+1 and k+2.
#[must_use]
pub const fn sector_lobes(k: usize) -> [usize; 4] {
    [(k + 7) % 8, k % 8, (k + 1) % 8, (k + 2) % 8]
}

fn cone_weight(directions: Directions, shared: SharedWeights, k: usize, t: usize) -> f64 {
    let h = directions.step_rad();
    let d = directions.circular_distance(t, directions.of_neighbour(k));
    if k.is_multiple_of(2) {
        let core = (half_core_alpha_rad() / h).floor() as usize;
        let edge = directions.count() / 8;
        match d {
            d if d <= core && d < edge => 1.0,
            d if d < edge => shared.e1(),
            d if d == edge => 0.5 * shared.e1(),
            _ => 0.0,
        }
    } else if d <= (half_angle_beta_rad() / h).floor() as usize {
        shared.e2()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scheme(s: usize, shared: SharedWeights) -> Scheme {
        Scheme::new(Directions::new(s).expect("directions"), shared)
    }

    #[test]
    fn weights_sum_to_one_at_every_sample() {
        for shared in [SharedWeights::Thesis, SharedWeights::Geometric] {
            for s in (8..=360).step_by(8) {
                let scheme = scheme(s, shared);
                for t in 0..s {
                    let w = scheme.weights(t);
                    // The sum is exactly 1: e2 is computed as 1 - e1, and where two overlaps meet each face cone has e1
                    // / 2.
                    assert_eq!(w.iter().sum::<f64>(), 1.0, "S = {s}, t = {t}: {w:?}");
                }
            }
        }
    }

    #[test]
    fn shared_weights_are_the_printed_ones() {
        assert!((SharedWeights::Thesis.e1() - 0.362291).abs() < 5e-7);
        assert!((SharedWeights::Thesis.e2() - 0.63771).abs() < 5e-6);
        assert!((SharedWeights::Geometric.e1() - 0.371_201).abs() < 5e-7);
    }

    #[test]
    fn core_and_diagonal_cones_meet() {
        let degrees = math::degrees(2.0 * half_core_alpha_rad() + 2.0 * half_angle_beta_rad());
        assert!((degrees - 90.0).abs() < 1e-13);
        assert!((math::degrees(2.0 * half_core_alpha_rad()) - 36.8699).abs() < 1e-4);
    }

    #[test]
    fn lobe_integral_is_the_printed_number() {
        // The thesis prints it for S = 36, which the scheme itself does not admit (no multiple of 8).
        let h = math::TAU / 36.0;
        let l36 = h * (0..36).map(|t| math::cos(f64::from(t) * h).max(0.0)).sum::<f64>();
        assert!((l36 - 1.994_920_463_583_451_7).abs() < 1e-15);
        // In closed form L = h cot(h/2) for S a multiple of 4.
        for s in [8, 32, 360] {
            let h = math::TAU / s as f64;
            let exact = h / math::tan(0.5 * h);
            assert!(
                (scheme(s, SharedWeights::Thesis).lobe_integral() - exact).abs() < 2e-15 * exact,
                "S = {s}"
            );
        }
        let l36_closed = h / math::tan(0.5 * h);
        assert!((l36 - l36_closed).abs() < 1e-15);
    }

    #[test]
    fn lobes_carry_unit_flux_and_do_not_leak_sideways() {
        for s in [8, 32, 64] {
            let scheme = scheme(s, SharedWeights::Thesis);
            let h = scheme.directions().step_rad();
            for k in 0..8 {
                let flux = h * (0..s).map(|t| scheme.lobes(t)[k]).sum::<f64>();
                assert!((flux - 1.0).abs() < 1e-15);
                let lit = (0..s).filter(|&t| scheme.lobes(t)[k] > 0.0).count();
                assert_eq!(lit, s / 2 - 1, "S = {s}, k = {k}: nothing at or beyond 90 degrees");
            }
        }
    }

    #[test]
    fn four_lobes_make_every_sample() {
        let scheme = scheme(40, SharedWeights::Thesis);
        let a = [0.3, 1.0, 0.0, 2.0, 0.7, 0.1, 5.0, 0.2];
        for t in 0..40 {
            let all: f64 = (0..8).map(|j| a[j] * scheme.lobes(t)[j]).sum();
            assert!((scheme.intensity(&a, t) - all).abs() < 1e-15);
        }
    }
}
