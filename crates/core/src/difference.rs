//! The difference of two lists of numbers.

/// The difference of two lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The largest difference.
    pub largest: f64,
    /// Its index.
    pub at: usize,
    /// The largest difference relative to the largest magnitude of the first list.
    pub largest_relative: f64,
    /// L2 norm of the difference relative to that of the first list.
    pub l2_relative: f64,
    /// Number of values that are NaN on one side only; NaN on both sides counts as equal.
    pub unmatched: usize,
}

impl Difference {
    /// The difference of two lists of the same length.
    #[must_use]
    pub fn between(a: &[f64], b: &[f64]) -> Self {
        let (mut largest, mut at, mut unmatched) = (0.0, 0, 0);
        let (mut square, mut norm, mut top): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for (i, (&x, &y)) in a.iter().zip(b).enumerate() {
            if x.is_nan() || y.is_nan() {
                unmatched += usize::from(x.is_nan() != y.is_nan());
                continue;
            }
            let off = if x == y { 0.0 } else { (x - y).abs() };
            if off > largest {
                (largest, at) = (off, i);
            }
            square += off * off;
            norm += x * x;
            top = top.max(x.abs());
        }
        let relative = |x: f64, y: f64| match (x, y) {
            (0.0, _) => 0.0,
            (_, 0.0) => f64::INFINITY,
            _ => x / y,
        };
        let l2_relative = relative(square.sqrt(), norm.sqrt());
        Self { largest, at, largest_relative: relative(largest, top), l2_relative, unmatched }
    }

    /// Whether both relative differences are at most `tolerance` and nothing is unmatched.
    #[must_use]
    pub fn is_within(&self, tolerance: f64) -> bool {
        self.unmatched == 0 && self.l2_relative <= tolerance && self.largest_relative <= tolerance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_found_and_placed() {
        let a = [1.0, 2.0, 3.0, 4.0];
        let d = Difference::between(&a, &[1.0, 2.0, 3.5, 4.0]);
        assert_eq!((d.largest, d.at, d.largest_relative), (0.5, 2, 0.125));
        assert!(!d.is_within(0.01) && d.is_within(0.2));
        assert!(Difference::between(&a, &a).is_within(0.0));
    }

    #[test]
    fn a_missing_number_is_never_within() {
        let a = [1.0, f64::NAN];
        assert!(!Difference::between(&a, &[1.0, 2.0]).is_within(1e9));
        assert!(Difference::between(&a, &a).is_within(0.0));
    }

    #[test]
    fn zero_against_something_is_infinitely_far() {
        assert!(!Difference::between(&[0.0, 0.0], &[0.0, 1e-300]).is_within(1.0));
    }
}
