//! Noise, as in measured tensors.

use tigereye_core::{Field, SplitMix64, Symmetry, Tensor2, math};

/// Adds to every tensor a random one whose expected square is `share` squared times the square of the tensor itself
/// (Frobenius norm), the same in every frame: independent normal components for tensors that are not symmetric, and the
/// Gaussian orthogonal ensemble (the shear component has half of the variance of the others) for symmetric ones, which
/// stay so; tensors of a symmetric field ([`Symmetry`]) count as symmetric despite rounding. Zero tensors stay zero.
/// The numbers of a seed are the same on every platform.
#[must_use]
pub fn with_noise(field: &Field<Tensor2>, share: f64, seed: u64) -> Field<Tensor2> {
    let mut random = Normal { uniform: SplitMix64::new(seed), second: None };
    let symmetric = Symmetry::of(field).is_symmetric();
    field.map(|t| {
        let [xx, xy, yx, yy] = t.components();
        // Always four numbers per cell, so that its noise does not depend on other cells.
        let n: [f64; 4] = core::array::from_fn(|_| random.next());
        let size = math::hypot(math::hypot(xx, xy), math::hypot(yx, yy));
        let noise = if symmetric || t.asymmetry() == 0.0 {
            // Three independent components whose squares add up to 3 of the diagonal's variance.
            let unit = share * size / 3.0_f64.sqrt();
            let shear = unit * n[1] / 2.0_f64.sqrt();
            Tensor2::new(unit * n[0], shear, shear, unit * n[3])
        } else {
            let unit = 0.5 * share * size;
            Tensor2::new(unit * n[0], unit * n[1], unit * n[2], unit * n[3])
        };
        *t + noise
    })
}

/// Normal numbers of mean 0 and variance 1 (Box and Muller, A note on the generation of random normal deviates, 1958).
struct Normal {
    uniform: SplitMix64,
    second: Option<f64>,
}

impl Normal {
    fn next(&mut self) -> f64 {
        if let Some(number) = self.second.take() {
            return number;
        }
        // In (0, 1]: ln 0 is not finite.
        let u = 0.5 * (1.0 - self.uniform.symmetric_unit());
        let angle = math::PI * self.uniform.symmetric_unit();
        let radius = (-2.0 * math::ln(u)).sqrt();
        self.second = Some(radius * math::sin(angle));
        radius * math::cos(angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    fn field(t: Tensor2) -> Field<Tensor2> {
        Field::from_fn(Grid::new(200, 200).expect("a size"), |_| t)
    }

    /// Root of the mean square of what was added, over the tensor's own size.
    fn strength(t: Tensor2, share: f64) -> f64 {
        let noisy = with_noise(&field(t), share, 7);
        let square = |t: &Tensor2| t.components().iter().map(|c| c * c).sum::<f64>();
        let added: f64 = noisy.values().iter().map(|n| square(&(*n + t.scaled(-1.0)))).sum();
        (added / noisy.values().len() as f64 / square(&t)).sqrt()
    }

    #[test]
    fn noise_is_as_strong_as_asked() {
        for t in [Tensor2::symmetric(1.0, 0.5, -2.0), Tensor2::new(1.0, 2.0, -1.0, 0.5)] {
            for share in [0.01, 0.1] {
                // 40 000 tensors of three or four numbers: the estimate is within 1 % of the truth.
                assert!((strength(t, share) / share - 1.0).abs() < 0.01, "{t:?} {share}");
            }
        }
    }

    /// Rotating the frame changes no variance: that of the shear component is that of half the difference of the
    /// others.
    #[test]
    fn noise_prefers_no_direction() {
        let t = Tensor2::symmetric(1.0, 0.0, 1.0);
        let noisy = with_noise(&field(t), 0.1, 3);
        let mean = |f: fn(&Tensor2) -> f64| {
            noisy.values().iter().map(|t| f(t) * f(t)).sum::<f64>() / noisy.values().len() as f64
        };
        let ratio = mean(|t| t.xy()) / mean(|t| 0.5 * (t.xx() - t.yy()));
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }

    #[test]
    fn symmetry_zeros_and_seeds_are_kept() {
        let symmetric = with_noise(&field(Tensor2::symmetric(1.0, 0.3, 2.0)), 0.1, 1);
        assert!(symmetric.values().iter().all(|t| t.asymmetry() == 0.0));
        assert!(with_noise(&field(Tensor2::ZERO), 0.1, 1).values().iter().all(Tensor2::is_zero));
        let t = field(Tensor2::new(1.0, 2.0, 3.0, 4.0));
        assert_eq!(with_noise(&t, 0.05, 9), with_noise(&t, 0.05, 9));
        assert_ne!(with_noise(&t, 0.05, 9), with_noise(&t, 0.05, 10));
        assert_eq!(with_noise(&t, 0.0, 9), t);
    }
}
