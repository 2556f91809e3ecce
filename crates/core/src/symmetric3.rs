//! Eigenvalues of symmetric 3x3 tensors, and the measures that diffusion imaging takes from them.

/// Sweeps of Jacobi rotations; convergence is quadratic and needs about six.
const MAX_SWEEPS: usize = 30;

/// Eigenvalues of the symmetric part of a 3x3 tensor given row by row, in descending order, in the tensor's unit.
///
/// Cyclic Jacobi rotations (Golub and Van Loan 2013, section 8.5). Every entry must be finite; otherwise the result is
/// not a number.
#[must_use]
pub fn symmetric_eigenvalues3(t: &[f64; 9]) -> [f64; 3] {
    let largest = t.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if !t.iter().all(|v| v.is_finite()) {
        return [f64::NAN; 3];
    }
    if largest == 0.0 {
        return [0.0; 3];
    }
    // A power of two keeps every digit and keeps squares from overflowing.
    let e = crate::math::binary_exponent(largest);
    let s = |i: usize, j: usize| {
        let scaled = |v| crate::math::scale_by_power_of_two(v, -e);
        0.5 * scaled(t[3 * i + j]) + 0.5 * scaled(t[3 * j + i])
    };
    let mut a = [0, 1, 2].map(|i| [0, 1, 2].map(|j| s(i, j)));
    for _ in 0..MAX_SWEEPS {
        if a[0][1] == 0.0 && a[0][2] == 0.0 && a[1][2] == 0.0 {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, p, q);
        }
    }
    let mut l = [a[0][0], a[1][1], a[2][2]];
    l.sort_by(|x, y| y.total_cmp(x));
    l.map(|v| crate::math::scale_by_power_of_two(v, e))
}

/// Makes entry (p, q) zero.
fn rotate(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let off = a[p][q];
    if off.abs() <= f64::EPSILON * f64::EPSILON * (a[p][p].abs() + a[q][q].abs()) {
        (a[p][q], a[q][p]) = (0.0, 0.0);
        return;
    }
    let theta = 0.5 * (a[q][q] - a[p][p]) / off;
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    let r = 3 - p - q;
    (a[p][p], a[q][q]) = (a[p][p] - t * off, a[q][q] + t * off);
    (a[p][q], a[q][p]) = (0.0, 0.0);
    let (rp, rq) = (a[r][p], a[r][q]);
    (a[r][p], a[r][q]) = (c * rp - s * rq, s * rp + c * rq);
    (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
}

/// Fractional anisotropy of three eigenvalues, from 0 to 1 if none is negative: the norm of the deviator over the
/// norm of the tensor, times sqrt(3/2) (Basser and Pierpaoli 1996). 0 for the zero tensor, NaN if an
/// eigenvalue is infinite or NaN.
#[must_use]
pub fn fractional_anisotropy3(l: [f64; 3]) -> f64 {
    if !l.iter().all(|v| v.is_finite()) {
        return f64::NAN;
    }
    let largest = l.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    let [a, b, c] = l.map(|v| v / largest);
    let deviator = (a - b) * (a - b) + (b - c) * (b - c) + (c - a) * (c - a);
    (0.5 * deviator / (a * a + b * b + c * c)).sqrt()
}

/// Mode of three eigenvalues, from -1 (one small, planar) over 0 (orthotropic) to 1 (one large, linear): the
/// determinant of the deviator of norm 1, times 3 sqrt(6) (Criscione et al. 2000; Ennis and Kindlmann 2006). 0 for
/// isotropic tensors, NaN if an eigenvalue is infinite or NaN.
#[must_use]
pub fn mode3(l: [f64; 3]) -> f64 {
    if !l.iter().all(|v| v.is_finite()) {
        return f64::NAN;
    }
    let largest = l.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    let scaled = l.map(|v| v / largest);
    let mean = (scaled[0] + scaled[1] + scaled[2]) / 3.0;
    let [a, b, c] = scaled.map(|v| v - mean);
    let norm = (a * a + b * b + c * c).sqrt();
    // The deviator of an isotropic tensor is a rounding error, which has no mode.
    if norm <= 8.0 * f64::EPSILON {
        return 0.0;
    }
    (3.0 * 6.0_f64.sqrt() * (a / norm) * (b / norm) * (c / norm)).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative to the largest eigenvalue.
    const TOLERANCE: f64 = 1e-14;

    fn near(t: [f64; 9], expected: [f64; 3]) {
        let found = symmetric_eigenvalues3(&t);
        let scale = expected.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() <= TOLERANCE * scale, "{found:?} instead of {expected:?}");
        }
    }

    #[test]
    fn eigenvalues_of_known_tensors() {
        near([2.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 3.0], [3.0, 2.0, -1.0]);
        near([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0], [3.0, 0.0, 0.0]);
        near([2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 2.0], [2.0 + 2f64.sqrt(), 2.0, 2.0 - 2f64.sqrt()]);
        near([0.0, -1.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0], [0.0; 3]);
        for scale in [1e-300, 1e200] {
            near([scale, scale, 0.0, scale, scale, 0.0, 0.0, 0.0, scale], [2.0 * scale, scale, 0.0]);
        }
        assert!(symmetric_eigenvalues3(&[f64::NAN; 9])[0].is_nan());
    }

    #[test]
    fn invariants_of_nan_are_nan() {
        for l in [[f64::NAN; 3], [1.0, f64::NAN, 0.0], [f64::INFINITY, 1.0, 0.0]] {
            assert!(fractional_anisotropy3(l).is_nan() && mode3(l).is_nan(), "{l:?}");
        }
    }

    #[test]
    fn mode_tells_linear_from_planar() {
        for (l, mode) in [
            ([3.0, 1.0, 1.0], 1.0),
            ([3.0, 3.0, 1.0], -1.0),
            ([3.0, 2.0, 1.0], 0.0),
            ([2.0; 3], 0.0),
            ([1.0 + f64::EPSILON, 1.0, 1.0], 0.0),
        ] {
            assert!((mode3(l) - mode).abs() < 1e-14 && (mode3(l.map(|v| v * 1e-200)) - mode).abs() < 1e-14);
        }
        assert_eq!(mode3([0.0; 3]), 0.0);
    }

    #[test]
    fn fractional_anisotropy_reaches_its_limits() {
        assert_eq!(fractional_anisotropy3([2.0; 3]), 0.0);
        assert_eq!(fractional_anisotropy3([0.0; 3]), 0.0);
        assert!((fractional_anisotropy3([5e-3, 0.0, 0.0]) - 1.0).abs() < 1e-15);
    }
}
