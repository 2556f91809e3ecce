//! The direction of a line at a point, without branches, so that the same arithmetic serves one line and several side
//! by side.
//!
//! An axis at the angle `a` has no sign, but the number `G` at the angle `2 a` is unique (the doubled angle of line
//! fields). With it, the reflection `R v = G conj(v) / |G|` leaves the axis as it is, so that `v + R v` is twice the
//! part of `v` along the axis: the direction of a line that arrives along `v` follows from `G` and `v` without an
//! angle, and with the sign of `v`.

use crate::{Axes, Family, Major, OrderedAxes};
use tigereye_core::Tensor2;

/// The numbers `E` and `F` of a tensor ([`tigereye_core::Conformal`]): `f.re`, `f.im`, `e.re`, `e.im`.
pub(crate) type Numbers = [f64; 4];

/// `E` and `F` of a tensor.
#[inline(always)]
pub(crate) fn numbers(t: &Tensor2) -> Numbers {
    let [xx, xy, yx, yy] = t.components();
    [xx - yy, xy + yx, xx + yy, yx - xy]
}

/// Sizes whose squares neither overflow nor underflow; others are scaled first ([`OrderedAxes::of`]).
const USUAL: [f64; 2] = [1e-60, 1e60];

/// The direction of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slope {
    /// Unit vector with the sign of the incoming direction.
    pub(crate) along: [f64; 2],
    /// [`crate::Frame::contrast`].
    pub(crate) contrast: f64,
    /// Half the sum of `|E|` and `|F|`, the longer semi-axis.
    pub(crate) longer: f64,
    /// The squares of `2 |G|` times the cosine between incoming and outgoing direction, and of `2 |G|`.
    cosine2: [f64; 2],
}

impl Slope {
    /// Whether the bend is no sharper than a given one, by the square of its cosine.
    #[inline(always)]
    pub(crate) fn bends_at_most(&self, least_cosine2: f64) -> bool {
        self.cosine2[0] >= least_cosine2 * self.cosine2[1]
    }

    /// Whether the arithmetic holds: the numbers are finite and of usual size.
    #[inline(always)]
    pub(crate) fn is_usual(&self) -> bool {
        (self.longer > USUAL[0]) & (self.longer < USUAL[1])
    }
}

/// How axes follow from `E` and `F`: which of them, and in which order.
pub(crate) trait Rule: Copy + Send + Sync {
    /// `G` for the major axis (`sign` 1) or the minor one (`sign` -1), its size, and the contrast of the axes, given
    /// `|F|` and `|E|`.
    fn doubled(numbers: Numbers, stretch: f64, rest: f64, sign: f64) -> ([f64; 2], f64, f64);
}

/// Semi-axes, the longer one major.
#[derive(Clone, Copy)]
pub(crate) struct SemiAxesByMagnitude;
/// Semi-axes, the one of the larger `u . T u` major.
#[derive(Clone, Copy)]
pub(crate) struct SemiAxesByValue;
/// Eigenvectors, the one of the larger eigenvalue major.
#[derive(Clone, Copy)]
pub(crate) struct EigenvectorsByValue;
/// Eigenvectors, the one of the eigenvalue of larger magnitude major.
#[derive(Clone, Copy)]
pub(crate) struct EigenvectorsByMagnitude;
/// Dual eigenvectors.
#[derive(Clone, Copy)]
pub(crate) struct Duals;

/// The smaller of two numbers: one instruction, unlike `f64::min`, which has to look for NaN.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl Rule for SemiAxesByMagnitude {
    #[inline(always)]
    fn doubled([fx, fy, ex, ey]: Numbers, stretch: f64, rest: f64, sign: f64) -> ([f64; 2], f64, f64) {
        let g = [sign * (fx * ex - fy * ey), sign * (fx * ey + fy * ex)];
        (g, stretch * rest, smaller(stretch, rest))
    }
}

impl Rule for SemiAxesByValue {
    #[inline(always)]
    fn doubled([fx, fy, ex, ey]: Numbers, stretch: f64, rest: f64, sign: f64) -> ([f64; 2], f64, f64) {
        // If E vanishes, the tensor is symmetric up to rounding, and its semi-axes are its eigenvectors.
        let is_symmetric = rest <= f64::EPSILON * stretch;
        let signed = if ex < 0.0 { -sign } else { sign };
        let inverse = 1.0 / rest;
        let ex = if is_symmetric { sign } else { signed * ex * inverse };
        let ey = if is_symmetric { 0.0 } else { signed * ey * inverse };
        let contrast = stretch * if is_symmetric { 1.0 } else { ex.abs() };
        ([fx * ex - fy * ey, fx * ey + fy * ex], stretch, contrast)
    }
}

/// Eigenvectors lie at both sides of the direction of `F / 2`, at an angle whose double has the sine `|Im E| / |F|`;
/// pseudo-eigenvectors, with the two exchanged. The number `G` and its size.
#[inline(always)]
fn eigenvectors([fx, fy, _, ey]: Numbers, stretch: f64, sign: f64) -> ([f64; 2], f64) {
    let turning = ey.abs();
    let (sum, difference) = (stretch + turning, (stretch - turning).abs());
    let cosine = sign * (sum * difference).sqrt();
    let sine = 0.5 * (sum - difference);
    let sine = if ey < 0.0 { -sine } else { sine };
    ([fx * cosine - fy * sine, fx * sine + fy * cosine], stretch * (0.5 * (sum + difference)))
}

impl Rule for EigenvectorsByValue {
    #[inline(always)]
    fn doubled(numbers: Numbers, stretch: f64, _: f64, sign: f64) -> ([f64; 2], f64, f64) {
        let (g, size) = eigenvectors(numbers, stretch, sign);
        (g, size, stretch)
    }
}

impl Rule for EigenvectorsByMagnitude {
    #[inline(always)]
    fn doubled(numbers: Numbers, stretch: f64, _: f64, sign: f64) -> ([f64; 2], f64, f64) {
        let sign = if numbers[2] < 0.0 { -sign } else { sign };
        let (g, size) = eigenvectors(numbers, stretch, sign);
        (g, size, smaller(stretch, numbers[2].abs()))
    }
}

impl Rule for Duals {
    #[inline(always)]
    fn doubled([fx, fy, _, ey]: Numbers, stretch: f64, _: f64, sign: f64) -> ([f64; 2], f64, f64) {
        // A quarter turn of F rotates its axis by 45 degrees.
        let side = if ey < 0.0 { -sign } else { sign };
        ([-side * fy, side * fx], stretch, smaller(stretch, ey.abs()))
    }
}

/// The direction along an axis that is closest to `towards`, a unit vector. For symmetric tensors, whose E is real,
/// `SYMMETRIC` gives the same bits with fewer operations.
#[inline(always)]
pub(crate) fn slope<R: Rule, const SYMMETRIC: bool>(numbers: Numbers, sign: f64, towards: [f64; 2]) -> Slope {
    let [fx, fy, ex, ey] = numbers;
    let ey = if SYMMETRIC { 0.0 } else { ey };
    let numbers = [fx, fy, ex, ey];
    let stretch = (fx * fx + fy * fy).sqrt();
    let rest = if SYMMETRIC { ex.abs() } else { (ex * ex + ey * ey).sqrt() };
    let (g, size, contrast) = R::doubled(numbers, stretch, rest, sign);
    let [vx, vy] = towards;
    let w = [size * vx + (g[0] * vx + g[1] * vy), size * vy + (g[1] * vx - g[0] * vy)];
    let square = w[0] * w[0] + w[1] * w[1];
    let inverse = 1.0 / square.sqrt();
    Slope {
        along: [w[0] * inverse, w[1] * inverse],
        contrast,
        longer: 0.5 * (stretch + rest),
        cosine2: [square, 4.0 * size * size],
    }
}

/// Something to do with the rule of some axes, compiled for each.
pub(crate) trait WithRule {
    /// What it gives.
    type Output;
    /// What to do.
    fn with<R: Rule>(self) -> Self::Output;
}

impl OrderedAxes {
    /// Does something with the rule of these axes.
    #[inline(always)]
    pub(crate) fn with_rule<W: WithRule>(self, what: W) -> W::Output {
        match (self.axes(), self.major()) {
            (Axes::HalfAxes, Major::Magnitude) => what.with::<SemiAxesByMagnitude>(),
            (Axes::HalfAxes, Major::Value) => what.with::<SemiAxesByValue>(),
            (Axes::Eigenvectors, Major::Value) => what.with::<EigenvectorsByValue>(),
            (Axes::Eigenvectors, Major::Magnitude) => what.with::<EigenvectorsByMagnitude>(),
            (Axes::DualEigenvectors, _) => what.with::<Duals>(),
        }
    }

    /// The least contrast of axes that count as distinct, as a fraction of the longer semi-axis: `least`, and above
    /// rounding.
    #[inline(always)]
    pub(crate) fn least_contrast(self, least: f64) -> f64 {
        match self.axes() {
            // A number that vanishes beside the other one has no direction, nor does their product.
            Axes::HalfAxes => least.max(f64::EPSILON * f64::EPSILON),
            Axes::Eigenvectors | Axes::DualEigenvectors => least,
        }
    }

    /// The direction along an axis that is closest to a unit vector. `None` if the tensor's numbers are not finite, or
    /// so large or small that they have to be scaled ([`OrderedAxes::of`]).
    #[inline]
    pub(crate) fn slope(self, numbers: Numbers, family: Family, towards: [f64; 2]) -> Option<Slope> {
        struct One(Numbers, f64, [f64; 2]);
        impl WithRule for One {
            type Output = Slope;
            #[inline(always)]
            fn with<R: Rule>(self) -> Slope {
                slope::<R, false>(self.0, self.1, self.2)
            }
        }
        let found = self.with_rule(One(numbers, family.sign(), towards));
        found.is_usual().then_some(found)
    }
}

impl Family {
    /// 1 for the major family, -1 for the minor one.
    #[inline(always)]
    pub(crate) const fn sign(self) -> f64 {
        match self {
            Self::Major => 1.0,
            Self::Minor => -1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{SplitMix64, Vector};

    /// The axis of the closed formulas, with the sign of the incoming direction, for every choice of axes.
    #[test]
    fn slopes_are_the_axes_of_the_tensor() {
        let mut numbers_of = SplitMix64::new(7);
        let mut random = move || 2.0 * numbers_of.unit() - 1.0;
        let mut compared = 0;
        for n in 0..4000 {
            let t = match n % 4 {
                0 => Tensor2::symmetric(random(), random(), random()),
                1 => Tensor2::new(random(), random(), random(), random()).scaled(1e30),
                2 => Tensor2::new(random(), 0.0, 0.0, random()),
                _ => Tensor2::new(random(), random(), random(), random()),
            };
            let towards = Vector::new(random(), random()).normalize();
            for axes in [Axes::HalfAxes, Axes::Eigenvectors, Axes::DualEigenvectors] {
                for major in [Major::Value, Major::Magnitude] {
                    let axes = axes.by(major);
                    let Some(frame) = axes.of(&t, 1e-6) else { continue };
                    for family in [Family::Major, Family::Minor] {
                        let along = frame.axes[family as usize];
                        let cosine = along.dot(towards);
                        if cosine.abs() < 0.1 {
                            continue;
                        }
                        let found = axes.slope(numbers(&t), family, towards.into()).expect("a slope");
                        let expected = along * cosine.signum();
                        let off = (Vector::from(found.along) - expected).length();
                        assert!(off < 1e-9, "{axes:?} {family:?} {t:?}: {off}");
                        assert!((found.contrast - frame.contrast).abs() <= 1e-12 * found.longer);
                        let cosine2 = found.cosine2[0] / found.cosine2[1];
                        assert!((cosine2 - cosine * cosine).abs() < 1e-9);
                        compared += 1;
                    }
                }
            }
        }
        assert!(compared > 10_000, "{compared}");
    }

    #[test]
    fn unusual_sizes_have_no_slope() {
        for t in [Tensor2::ZERO, Tensor2::isotropic(f64::NAN), Tensor2::symmetric(1e200, 0.0, 1.0)] {
            let axes = OrderedAxes::from(Axes::HalfAxes);
            assert!(axes.slope(numbers(&t), Family::Major, [1.0, 0.0]).is_none(), "{t:?}");
        }
    }
}
