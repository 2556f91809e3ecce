//! Interpolating quintic B-splines through samples on a lattice: four times continuously differentiable, evaluated
//! with all first and second derivatives (Unser, Splines: a perfect fit for signal and image processing, 1999).
//! Curvatures of cubic ones would be off by five per cent on crests two samples wide, and with them the direction
//! across a crest.

mod axis;
mod missing;

use axis::REACH;
pub(crate) use axis::{Axis, Taps};
pub(crate) use missing::Known;
use rayon::prelude::*;

/// Value, gradient (x, y, z) and second derivatives (xx, xy, xz, yy, yz, zz) at a point, per sample.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Jet {
    pub(crate) value: f64,
    pub(crate) gradient: [f64; 3],
    pub(crate) hessian: [f64; 6],
}

/// A spline through samples on a lattice, x fastest.
pub(crate) struct Spline {
    axes: [Axis; 3],
    coefficients: Vec<f64>,
    /// Coefficients along x and y.
    size: [usize; 2],
}

/// Of the products of derivatives along two axes those up to the second order.
const PARTS: [(usize, usize); 6] = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (0, 2)];

impl Spline {
    /// The spline through finite `values`, one for each sample of the axes.
    pub(crate) fn new(axes: [Axis; 3], values: &[f64]) -> Self {
        let mut size = axes.map(|a| a.samples);
        let mut coefficients = values.to_vec();
        for (d, axis) in axes.into_iter().enumerate() {
            let mut wider = size;
            wider[d] = axis.coefficients();
            coefficients = filtered(&coefficients, size, wider, d, axis);
            size = wider;
        }
        Self { axes, coefficients, size: [size[0], size[1]] }
    }

    pub(crate) const fn axes(&self) -> &[Axis; 3] {
        &self.axes
    }

    /// The jet at a point in samples.
    pub(crate) fn jet(&self, p: [f64; 3]) -> Jet {
        let [tx, ty, tz] = [0, 1, 2].map(|d| self.axes[d].taps(p[d]));
        // Sums along x, then y, then z; PARTS are orders in x and y here.
        let mut sums = [[0.0; 3]; PARTS.len()];
        for k in 0..tz.count {
            let mut in_plane = [0.0; PARTS.len()];
            for j in 0..REACH {
                let row = self.row(ty.index[j], tz.index[k]);
                let near = tx.index.map(|i| row[i]);
                let along_x = tx.weight.map(|w| (0..REACH).map(|i| w[i] * near[i]).sum::<f64>());
                for (sum, (x, y)) in in_plane.iter_mut().zip(PARTS) {
                    *sum += ty.weight[y][j] * along_x[x];
                }
            }
            for (sum, part) in sums.iter_mut().zip(in_plane) {
                for d in 0..3 {
                    sum[d] += tz.weight[d][k] * part;
                }
            }
        }
        let [plain, x, xx, y, xy, yy] = sums;
        Jet {
            value: plain[0],
            gradient: [x[0], y[0], plain[1]],
            hessian: [xx[0], xy[0], x[1], yy[0], y[1], plain[2]],
        }
    }

    /// The value at a point in samples.
    pub(crate) fn value(&self, p: [f64; 3]) -> f64 {
        let [tx, ty, tz] = [0, 1, 2].map(|d| self.axes[d].taps(p[d]));
        let along_x = |j: usize, k: usize| -> f64 {
            let row = self.row(ty.index[j], tz.index[k]);
            (0..REACH).map(|i| tx.weight[0][i] * row[tx.index[i]]).sum()
        };
        let in_plane = |k: usize| -> f64 { (0..REACH).map(|j| ty.weight[0][j] * along_x(j, k)).sum() };
        (0..tz.count).map(|k| tz.weight[0][k] * in_plane(k)).sum()
    }

    /// The coefficients along x.
    fn row(&self, y: usize, z: usize) -> &[f64] {
        let [width, height] = self.size;
        &self.coefficients[(z * height + y) * width..][..width]
    }

    /// Jets at all combinations of positions in `x` and `y`, given as taps, at `z`; x fastest, changed by `f`.
    pub(crate) fn plane<T: Send>(
        &self,
        x: &[Taps],
        y: &[Taps],
        z: f64,
        f: impl Fn(usize, usize, Jet) -> T + Sync,
    ) -> Vec<T> {
        let tz = self.axes[2].taps(z);
        let [width, height] = self.size;
        let plane = width * height;
        let along_z: [Vec<f64>; 3] = [0, 1, 2].map(|d| {
            let at = |i: usize| {
                (0..tz.count).map(|k| tz.weight[d][k] * self.coefficients[tz.index[k] * plane + i]).sum()
            };
            (0..plane).map(at).collect()
        });
        y.par_iter()
            .enumerate()
            .flat_map_iter(|(j, ty)| {
                let rows = PARTS.map(|(dy, dz)| {
                    let at = |i: usize| {
                        (0..ty.count).map(|k| ty.weight[dy][k] * along_z[dz][ty.index[k] * width + i]).sum()
                    };
                    (0..width).map(at).collect::<Vec<f64>>()
                });
                let f = &f;
                x.iter()
                    .enumerate()
                    .map(move |(i, tx)| f(i, j, combine(tx, |part, k| rows[part][tx.index[k]])))
            })
            .collect()
    }
}

/// The last step along x, from the six parts known at its taps.
fn combine(tx: &Taps, at: impl Fn(usize, usize) -> f64) -> Jet {
    let sum = |part: usize, d: usize| -> f64 { (0..tx.count).map(|k| tx.weight[d][k] * at(part, k)).sum() };
    Jet {
        value: sum(0, 0),
        gradient: [sum(0, 1), sum(1, 0), sum(3, 0)],
        hessian: [sum(0, 2), sum(1, 1), sum(3, 1), sum(2, 0), sum(4, 0), sum(5, 0)],
    }
}

/// Replaces the samples along axis `d` by coefficients, line by line.
fn filtered(values: &[f64], size: [usize; 3], wider: [usize; 3], d: usize, axis: Axis) -> Vec<f64> {
    let mut out = vec![0.0; wider.iter().product()];
    let stride: usize = size[..d].iter().product();
    let lines_after: usize = size[d + 1..].iter().product();
    let mut line = vec![0.0; size[d]];
    let mut coefficients = vec![0.0; wider[d]];
    for after in 0..lines_after {
        for before in 0..stride {
            for (i, v) in line.iter_mut().enumerate() {
                *v = values[(after * size[d] + i) * stride + before];
            }
            axis.filter(&line, &mut coefficients);
            for (i, c) in coefficients.iter().enumerate() {
                out[(after * wider[d] + i) * stride + before] = *c;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A product of parabolas has all derivatives exactly; both ways to evaluate agree.
    #[test]
    fn derivatives_of_parabolas_are_exact() {
        let p = |x: f64| [1.0 + x - 0.5 * x * x, 1.0 - x, -1.0];
        let q = |y: f64| [2.0 - y + 0.2 * y * y, -1.0 + 0.4 * y, 0.4];
        let r = |z: f64| [0.5 + z - 0.2 * z * z, 1.0 - 0.4 * z, -0.4];
        let axes = [6, 5, 4].map(|samples| Axis { samples, periodic: false });
        let mut values = Vec::new();
        for k in 0..4 {
            for j in 0..5 {
                values.extend((0..6).map(|i| p(f64::from(i))[0] * q(f64::from(j))[0] * r(f64::from(k))[0]));
            }
        }
        let spline = Spline::new(axes, &values);
        let (x, y, z) = (2.3, 3.6, 1.7);
        let taps = |d: usize, v: f64| [spline.axes()[d].taps(v)];
        let in_plane = spline.plane(&taps(0, x), &taps(1, y), z, |_, _, jet| jet);
        let (p, q, r) = (p(x), q(y), r(z));
        assert!((spline.value([x, y, z]) - in_plane[0].value).abs() < 1e-12);
        for jet in [spline.jet([x, y, z]), in_plane[0]] {
            let expected = [
                (jet.value, p[0] * q[0] * r[0]),
                (jet.gradient[0], p[1] * q[0] * r[0]),
                (jet.gradient[1], p[0] * q[1] * r[0]),
                (jet.gradient[2], p[0] * q[0] * r[1]),
                (jet.hessian[0], p[2] * q[0] * r[0]),
                (jet.hessian[1], p[1] * q[1] * r[0]),
                (jet.hessian[2], p[1] * q[0] * r[1]),
                (jet.hessian[3], p[0] * q[2] * r[0]),
                (jet.hessian[4], p[0] * q[1] * r[1]),
                (jet.hessian[5], p[0] * q[0] * r[2]),
            ];
            // Rounding of sums of numbers below 100.
            assert!(expected.iter().all(|(a, b)| (a - b).abs() < 1e-12), "{expected:?}");
        }
    }
}
