//! The eigenvector across a crest, and the slope along it.

use crate::shapes::{cross, dot};
use crate::spline::Jet;
use tigereye_core::math;

/// The crest through a point, from the jet there, in scaled lengths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crest {
    pub(crate) value: f64,
    /// Unit eigenvector of the smallest eigenvalue of the Hessian; its sign is arbitrary.
    pub(crate) across: [f64; 3],
    /// Derivative along it.
    pub(crate) slope: f64,
    /// Minus the smallest eigenvalue: how fast the value falls off to both sides.
    pub(crate) strength: f64,
    /// Distance of the next eigenvalue from the smallest.
    pub(crate) gap: f64,
}

impl Crest {
    /// From a jet in samples, where samples are `unit` long. If `planar`, the third axis is ignored.
    pub(crate) fn of(jet: &Jet, unit: [f64; 3], planar: bool) -> Self {
        let g = [0, 1, 2].map(|d| jet.gradient[d] / unit[d]);
        let [xx, xy, xz, yy, yz, zz] = jet.hessian;
        let [u, v, w] = unit;
        let h = [xx / (u * u), xy / (u * v), xz / (u * w), yy / (v * v), yz / (v * w), zz / (w * w)];
        let (smallest, gap, across) = if planar { smallest2(h[0], h[1], h[3]) } else { smallest3(h) };
        Self { value: jet.value, across, slope: dot(across, g), strength: -smallest, gap }
    }

    /// The same crest with the sign of its eigenvector that agrees with `side`.
    pub(crate) fn towards(self, side: [f64; 3]) -> Self {
        if dot(self.across, side) < 0.0 {
            Self { across: self.across.map(|v| -v), slope: -self.slope, ..self }
        } else {
            self
        }
    }
}

/// Smallest eigenvalue, its distance to the other and its eigenvector, of a symmetric 2x2 matrix; along x where both
/// eigenvalues are equal.
fn smallest2(a: f64, b: f64, c: f64) -> (f64, f64, [f64; 3]) {
    let half = 0.5 * (a - c);
    let radius = (half * half + b * b).sqrt();
    // The longer of two representations of the same direction: without cancellation.
    let v = if half >= 0.0 { [-b, half + radius, 0.0] } else { [radius - half, -b, 0.0] };
    let size = (v[0] * v[0] + v[1] * v[1]).sqrt();
    let v = if size > 0.0 { v.map(|x| x / size) } else { [1.0, 0.0, 0.0] };
    (0.5 * (a + c) - radius, 2.0 * radius, v)
}

/// Smallest eigenvalue, its distance to the next and its eigenvector, of a symmetric 3x3 matrix (xx, xy, xz, yy, yz,
/// zz): the root of the characteristic polynomial by its angle (Smith 1961), the vector as the longest cross product of
/// two rows of the matrix minus the eigenvalue. If the two smallest eigenvalues are equal, its direction is arbitrary.
fn smallest3(h: [f64; 6]) -> (f64, f64, [f64; 3]) {
    const ALONG_X: [f64; 3] = [1.0, 0.0, 0.0];
    let largest = h.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return (0.0, 0.0, ALONG_X);
    }
    let [xx, xy, xz, yy, yz, zz] = h.map(|v| v / largest);
    let mean = (xx + yy + zz) / 3.0;
    let (a, b, c) = (xx - mean, yy - mean, zz - mean);
    let off = xy * xy + xz * xz + yz * yz;
    let p = ((a * a + b * b + c * c + 2.0 * off) / 6.0).sqrt();
    if p <= f64::EPSILON {
        return (mean * largest, 0.0, ALONG_X);
    }
    let determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
    let r = (0.5 * determinant / (p * p * p)).clamp(-1.0, 1.0);
    let off_mean = 2.0 * p * math::cos((math::acos(r) + math::TAU) / 3.0);
    let smallest = mean + off_mean;
    // The other two follow from the trace and the sum of squares.
    let gap = -1.5 * off_mean - 0.5 * (12.0 * p * p - 3.0 * off_mean * off_mean).max(0.0).sqrt();
    let rows = [[xx - smallest, xy, xz], [xy, yy - smallest, yz], [xz, yz, zz - smallest]];
    let mut best = (0.0, ALONG_X);
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        let v = cross(rows[i], rows[j]);
        let size = dot(v, v);
        if size > best.0 {
            best = (size, v);
        }
    }
    let (size, v) = best;
    let across = if size > 0.0 { v.map(|x| x / size.sqrt()) } else { ALONG_X };
    (smallest * largest, gap * largest, across)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{SplitMix64, symmetric_eigenvalues3};

    fn residual(h: [f64; 6], l: f64, v: [f64; 3]) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = h;
        let product = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|row| dot(row, v));
        (0..3).map(|d| (product[d] - l * v[d]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn eigenvectors_are_eigenvectors() {
        let mut numbers = SplitMix64::new(7);
        let mut random = move || numbers.unit() - 0.5;
        for _ in 0..2000 {
            let h: [f64; 6] = core::array::from_fn(|_| random());
            let (l, gap, v) = smallest3(h);
            let [_, next, expected] =
                symmetric_eigenvalues3(&[h[0], h[1], h[2], h[1], h[3], h[4], h[2], h[4], h[5]]);
            // The square root of rounding, if the two other eigenvalues are close to each other.
            assert!((gap - (next - expected)).abs() < 1e-7, "{h:?}");
            // A cross product of rows loses digits if two eigenvalues are close: among random ones, three.
            assert!((l - expected).abs() < 1e-13 && residual(h, l, v) < 1e-11, "{h:?}");
            let (l, gap, v) = smallest2(h[0], h[1], h[3]);
            assert!(residual([h[0], h[1], 0.0, h[3], 0.0, 0.0], l, v) < 1e-15 && v[2] == 0.0, "{h:?}");
            assert!(l <= h[0].min(h[3]));
            assert!((2.0 * l + gap - h[0] - h[3]).abs() < 1e-14);
        }
    }

    /// A crest has one strong curvature and two weak ones: the case that matters is accurate to rounding.
    #[test]
    fn the_direction_across_a_crest_is_exact() {
        for v in [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.6, 0.0, 0.8],
            [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
        ] {
            for scale in [1e-200, 1.0, 1e200] {
                let h = [v[0] * v[0], v[0] * v[1], v[0] * v[2], v[1] * v[1], v[1] * v[2], v[2] * v[2]];
                let (l, _, w) = smallest3(h.map(|x| -scale * x));
                assert!((l / scale + 1.0).abs() < 1e-15 && (dot(v, w).abs() - 1.0).abs() < 1e-15, "{v:?}");
            }
        }
    }

    #[test]
    fn isotropic_and_broken_matrices_have_a_unit_vector() {
        for h in [[0.0; 6], [2.0, 0.0, 0.0, 2.0, 0.0, 2.0], [f64::NAN; 6], [f64::INFINITY; 6]] {
            let (_, _, v) = smallest3(h);
            assert_eq!(dot(v, v), 1.0);
        }
        assert_eq!(smallest2(-3.0, 0.0, -3.0), (-3.0, 0.0, [1.0, 0.0, 0.0]));
    }
}
