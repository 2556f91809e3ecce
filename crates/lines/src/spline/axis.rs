//! Interpolating quintic B-splines along one axis.

/// Poles of the interpolating filter of degree 5 (Unser 1999, table 1).
const POLES: [f64; 2] = [-0.430_575_347_099_973_8, -0.043_096_288_203_264_65];
/// Number of samples in the support of a point.
pub(crate) const REACH: usize = 6;

/// Samples at 0, 1, 2, ... along an axis; on a periodic one, sample 0 follows the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(crate) samples: usize,
    pub(crate) periodic: bool,
}

/// The coefficients that contribute at a position, with their weights: six, or one if the axis has one sample (the
/// other weights are then zero).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taps {
    pub(crate) count: usize,
    pub(crate) index: [usize; REACH],
    /// Weights of the value, the first and the second derivative (per sample).
    pub(crate) weight: [[f64; REACH]; 3],
}

impl Axis {
    /// Number of coefficients: two more at either open end.
    pub(crate) const fn coefficients(self) -> usize {
        match (self.samples, self.periodic) {
            (1, _) => 1,
            (n, true) => n,
            (n, false) => n + 4,
        }
    }

    /// Coefficients of the spline through `f`. A periodic axis is closed exactly (Unser 1999). At open ends the
    /// coefficients continue as parabolas: quadratics are reproduced, so ramps and parabolas get no crests at the
    /// border. Conditions of higher order, such as "not a knot", overshoot for rough samples: by a factor of seven at
    /// order 6 for a single sample.
    pub(crate) fn filter(self, f: &[f64], out: &mut [f64]) {
        match (self.samples, self.periodic) {
            (1, _) => out[0] = f[0],
            (_, true) => closed(f, out),
            (_, false) => open(f, out),
        }
    }

    /// The taps at position `x` in samples. Beyond open ends the last polynomial is extrapolated.
    pub(crate) fn taps(self, x: f64) -> Taps {
        let n = self.samples;
        let cell = self.cell(x);
        if n == 1 {
            let mut weight = [[0.0; REACH]; 3];
            weight[0][0] = 1.0;
            return Taps { count: 1, index: [0; REACH], weight };
        }
        let (before, index) = if self.periodic {
            (x.floor(), core::array::from_fn(|k| (cell + k + 2 * n - 2) % n))
        } else {
            (cell as f64, core::array::from_fn(|k| cell + k))
        };
        Taps { count: REACH, index, weight: weights(x - before) }
    }

    /// The interval of a position: the index of the sample before it.
    pub(crate) fn cell(self, x: f64) -> usize {
        match (self.samples, self.periodic) {
            (1, _) => 0,
            (n, true) => x.floor().rem_euclid(n as f64) as usize % n,
            (n, false) => (x.max(0.0) as usize).min(n - 2),
        }
    }
}

/// Weights of the uniform quintic B-spline at the fraction `t` of an interval, and their derivatives.
fn weights(t: f64) -> [[f64; REACH]; 3] {
    let near = |x: f64| {
        let (x2, x3) = (x * x, x * x * x);
        [
            66.0 - 60.0 * x2 + 30.0 * x2 * x2 - 10.0 * x2 * x3,
            -120.0 * x + 120.0 * x3 - 50.0 * x2 * x2,
            -120.0 + 360.0 * x2 - 200.0 * x3,
        ]
    };
    let middle = |x: f64| {
        let (x2, x3) = (x * x, x * x * x);
        [
            51.0 + 75.0 * x - 210.0 * x2 + 150.0 * x3 - 45.0 * x2 * x2 + 5.0 * x2 * x3,
            75.0 - 420.0 * x + 450.0 * x2 - 180.0 * x3 + 25.0 * x2 * x2,
            -420.0 + 900.0 * x - 540.0 * x2 + 100.0 * x3,
        ]
    };
    let far = |x: f64| {
        let (u, u2) = (3.0 - x, (3.0 - x) * (3.0 - x));
        [u * u2 * u2, -5.0 * u2 * u2, 20.0 * u * u2]
    };
    let after = |w: [f64; 3]| [w[0], -w[1], w[2]];
    let all = [
        far(t + 2.0),
        middle(t + 1.0),
        near(t),
        after(near(1.0 - t)),
        after(middle(2.0 - t)),
        after(far(3.0 - t)),
    ];
    [0, 1, 2].map(|d| all.map(|w| w[d] / 120.0))
}

/// The causal and the anticausal filter of each pole, both initialised with the sum over all periods.
fn closed(f: &[f64], c: &mut [f64]) {
    let n = f.len();
    c.copy_from_slice(f);
    for pole in POLES {
        let (mut sum, mut power) = (0.0, 1.0);
        for k in 0..n {
            sum += power * c[(n - k) % n];
            power *= pole;
        }
        let turns = 1.0 / (1.0 - power);
        c[0] = sum * turns;
        for k in 1..n {
            c[k] += pole * c[k - 1];
        }
        (sum, power) = (0.0, 1.0);
        for k in 0..n {
            sum += power * c[(n - 1 + k) % n];
            power *= pole;
        }
        let gain = (1.0 - pole) * (1.0 - 1.0 / pole);
        let mut after = -pole * sum * turns;
        c[n - 1] = gain * after;
        for k in (0..n - 1).rev() {
            after = pole * (after - c[k]);
            c[k] = gain * after;
        }
    }
}

/// Starts from the coefficients of the periodic axis and adds homogeneous solutions, which change no sample: powers of
/// the poles from either end, such that two third differences of the coefficients vanish at each end. Two samples are
/// joined by a straight line instead.
fn open(f: &[f64], out: &mut [f64]) {
    let n = f.len();
    let mut round = vec![0.0; n];
    closed(f, &mut round);
    for (j, c) in out.iter_mut().enumerate() {
        *c = round[(j + 2 * n - 2) % n];
    }
    let count = n + 4;
    let order = n.min(3);
    let places = [0, 1, count - order - 2, count - order - 1];
    // The powers have decayed to zero before the other end.
    let fading = |pole: f64, from: usize| {
        (0..from).try_fold(1.0, |p: f64, _| (p != 0.0).then_some(p * pole)).unwrap_or(0.0)
    };
    let added = |j: usize, h: usize| fading(POLES[h % 2], if h < 2 { j } else { count - 1 - j });
    let difference = |at: usize, value: &dyn Fn(usize) -> f64| -> f64 {
        let (mut sum, mut binomial) = (0.0, 1.0);
        for i in 0..=order {
            sum += binomial * value(at + i);
            binomial *= -((order - i) as f64) / (i + 1) as f64;
        }
        sum
    };
    let rows = places.map(|at| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|h| difference(at, &|j| added(j, h)));
        [a, b, c, d, -difference(at, &|j| out[j])]
    });
    let amounts = solved(rows);
    for (h, amount) in amounts.into_iter().enumerate() {
        let mut power = amount;
        for k in 0..count {
            out[if h < 2 { k } else { count - 1 - k }] += power;
            power *= POLES[h % 2];
        }
    }
}

/// Solves four linear equations, right-hand sides last, with pivoting.
fn solved(mut rows: [[f64; 5]; 4]) -> [f64; 4] {
    for p in 0..4 {
        let best = (p..4).max_by(|&a, &b| rows[a][p].abs().total_cmp(&rows[b][p].abs())).unwrap_or(p);
        rows.swap(p, best);
        for r in p + 1..4 {
            let factor = rows[r][p] / rows[p][p];
            for c in p..5 {
                rows[r][c] -= factor * rows[p][c];
            }
        }
    }
    let mut x = [0.0; 4];
    for p in (0..4).rev() {
        let known: f64 = (p + 1..4).map(|c| rows[p][c] * x[c]).sum();
        x[p] = (rows[p][4] - known) / rows[p][p];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::math;

    fn spline(f: &[f64], periodic: bool) -> impl Fn(f64) -> [f64; 3] {
        let axis = Axis { samples: f.len(), periodic };
        let mut c = vec![0.0; axis.coefficients()];
        axis.filter(f, &mut c);
        move |x| {
            let taps = axis.taps(x);
            taps.weight.map(|w| (0..taps.count).map(|k| w[k] * c[taps.index[k]]).sum())
        }
    }

    /// Rounding of a few operations on numbers below 100.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn samples_are_interpolated() {
        let f = [3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0, -6.0];
        for periodic in [false, true] {
            for n in 1..=f.len() {
                let s = spline(&f[..n], periodic);
                assert!((0..n).all(|i| (s(i as f64)[0] - f[i]).abs() < ROUNDING), "{n} {periodic}");
            }
        }
    }

    #[test]
    fn lines_and_parabolas_are_reproduced() {
        for n in 2..12_usize {
            let degree = (n - 1).min(2);
            let h = 1.0 / n as f64;
            // The sum of (x / n)^k and its derivatives.
            let p = |x: f64| {
                let mut sums = [0.0; 3];
                let mut powers = [0.0, 0.0, 1.0];
                for k in 0..=degree {
                    let k = k as f64;
                    sums[0] += powers[2];
                    sums[1] += k * h * powers[1];
                    sums[2] += k * (k - 1.0) * h * h * powers[0];
                    powers = [powers[1], powers[2], powers[2] * x * h];
                }
                sums
            };
            let f: Vec<f64> = (0..n).map(|i| p(i as f64)[0]).collect();
            let s = spline(&f, false);
            for i in 0..=10 * (n - 1) {
                let x = 0.1 * i as f64;
                assert!(
                    (0..3).all(|d| (s(x)[d] - p(x)[d]).abs() < ROUNDING),
                    "{n} {x}: {:?} {:?}",
                    s(x),
                    p(x)
                );
            }
        }
    }

    #[test]
    fn a_periodic_axis_has_no_seam() {
        let f = [3.0, -1.0, 4.0, 1.0, -5.0];
        let turned = [-5.0, 3.0, -1.0, 4.0, 1.0];
        let (s, t) = (spline(&f, true), spline(&turned, true));
        for i in 0..=50 {
            let x = 0.1 * f64::from(i);
            assert!((0..3).all(|d| (s(x)[d] - t(x + 1.0)[d]).abs() < ROUNDING), "{x}");
        }
        assert_eq!(s(0.0), s(5.0));
    }

    #[test]
    fn errors_fall_with_the_sixth_power() {
        let error = |n: usize| {
            let h = 1.0 / n as f64;
            let f: Vec<f64> = (0..n).map(|i| math::sin(math::TAU * h * i as f64)).collect();
            let s = spline(&f, true);
            let at =
                |i: usize| (s((i as f64 + 0.5) * 1.0)[0] - math::sin(math::TAU * h * (i as f64 + 0.5))).abs();
            (0..n).map(at).fold(0.0, f64::max)
        };
        assert!(error(16) / error(32) > 55.0);
    }
}
