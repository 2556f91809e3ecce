//! Which two axes a tensor has.
//!
//! With the numbers `F = (xx - yy) + i (xy + yx)` and `E = (xx + yy) + i (yx - xy)` a tensor stretches by `|F| / 2`
//! along `arg F / 2`, turns by `Im E / 2` and scales by `Re E / 2`. Its semi-axes, eigenvectors and dual eigenvectors
//! are closed formulas of the two (Zheng and Pang, 2D asymmetric tensor analysis, 2005; Zhang, Yeh, Lin and Laramee,
//! Asymmetric tensor analysis for flow visualization, 2009).
//!
//! # Which axis is major
//!
//! Where an axis is stretched and the other squeezed there are two answers, and [`Major`] names the one that is meant:
//!
//! - **By value**, as in mechanics: of eigenvectors the one with the algebraically larger eigenvalue (its real part),
//!   of semi-axes the one along which `u . T u` is larger. Both agree for symmetric tensors: tension is major, whatever
//!   its size. With `u . T u = (Re E +- |F| Re E / |E|) / 2` along the longer and the shorter semi-axis, the longer one
//!   is major where the trace is positive and the shorter one where it is negative.
//! - **By magnitude**, as light sees it: the longer semi-axis, or the eigenvector whose eigenvalue is larger without
//!   its sign.
//!
//! Unless something else is said, eigenvectors are ordered by value and semi-axes by magnitude ([`Axes::by`]). Where
//! both eigenvalues are positive the orders agree.
//!
//! What tells the axes apart ([`Frame::contrast`]) depends on the order. Symmetric tensors by value have axes wherever
//! `F` is not zero, pure shear (2, -2) included; by magnitude pure shear has none, because both semi-axes are equally
//! long. Eigenvectors by magnitude, and semi-axes of tensors that are not symmetric by value, change places where the
//! trace is zero: their lines end there.

use tigereye_core::{Choice, Tensor2, choice, math};

/// Which of the two axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Family {
    /// The larger one, in the sense of [`Major`].
    #[default]
    Major,
    /// The other one.
    Minor,
}

choice!(Family {
    Major = "major": "The larger one, by value or by magnitude.",
    Minor = "minor": "The other one.",
});

impl Family {
    /// Its word as a choice.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.word()
    }
}

/// The axes that lines follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// The semi-axes of the ellipse that a tensor makes of the unit circle: its left singular vectors, which is what
    /// light sees.
    #[default]
    HalfAxes,
    /// Eigenvectors, the axes of classical tensor lines. Where eigenvalues are complex (the turning is stronger than
    /// the stretching) the pseudo-eigenvectors: the diagonals of the smallest rectangle around the ellipses along which
    /// the linear flow of the tensor turns.
    Eigenvectors,
    /// Dual eigenvectors: the directions halfway between the eigenvectors, and the axes of the ellipses along which the
    /// linear flow turns where eigenvalues are complex, the longer one major. Symmetric tensors have none, as they turn
    /// nothing.
    DualEigenvectors,
}

choice!(Axes {
    HalfAxes = "half": "Semi-axes of the ellipse: what light sees.",
    Eigenvectors = "eigen": "Eigenvectors; pseudo-eigenvectors where eigenvalues are complex.",
    DualEigenvectors = "dual":
        "Dual eigenvectors, halfway between the eigenvectors; only for tensors that are not symmetric.",
});

impl Axes {
    /// Its word as a choice.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.word()
    }
}

/// By what the major axis is the larger one; see the beginning of `axes.rs` for the rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Major {
    /// By the value with its sign: tension is major.
    Value,
    /// By the size of the value: the longer axis is major.
    Magnitude,
}

choice!(Major {
    Value = "value": "By the value with its sign, as in mechanics: tension before compression.",
    Magnitude = "magnitude": "By the size of the value, as light sees it: the longer one.",
});

impl Major {
    /// Its word as a choice.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.word()
    }
}

/// Axes with the order of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OrderedAxes {
    axes: Axes,
    major: Major,
}

impl From<Axes> for OrderedAxes {
    /// In their usual order.
    fn from(axes: Axes) -> Self {
        axes.by(axes.usual_major())
    }
}

impl OrderedAxes {
    /// What they are, in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match (self.axes, self.major) {
            (Axes::HalfAxes, Major::Magnitude) => "semi-axes, major by magnitude (the longer one)",
            (Axes::HalfAxes, Major::Value) => "semi-axes, major by value (tension positive)",
            (Axes::Eigenvectors, Major::Magnitude) => "eigenvectors, major by magnitude (the larger size)",
            (Axes::Eigenvectors, Major::Value) => "eigenvectors, major by value (tension positive)",
            (Axes::DualEigenvectors, _) => "dual eigenvectors, the longer one major",
        }
    }
}

/// Whether eigenvalues are real.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// Two real eigenvalues: the tensor stretches at least as much as it turns.
    Real,
    /// A complex pair.
    Complex,
}

/// What a tensor does: scale, turn, and stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decomposition {
    /// Isotropic scaling, half the trace.
    pub scaling: f64,
    /// Rotation, half of `yx - xy`; counter-clockwise is positive.
    pub rotation: f64,
    /// Anisotropic stretching, at least 0.
    pub stretching: f64,
}

impl Decomposition {
    /// The three strengths of a tensor (eq. 3 of Zhang et al. 2009).
    #[must_use]
    pub fn of(t: &Tensor2) -> Self {
        let Numbers { f, e } = Numbers::of(t);
        Self { scaling: 0.5 * e[0], rotation: 0.5 * e[1], stretching: 0.5 * math::hypot(f[0], f[1]) }
    }

    /// Where the eigenvalues lie.
    #[must_use]
    pub fn domain(&self) -> Domain {
        if self.stretching >= self.rotation.abs() { Domain::Real } else { Domain::Complex }
    }
}

/// The axes of one tensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Unit vectors, major first, in the tensor's frame (y up), each with either sign.
    pub axes: [[f64; 2]; 2],
    /// Their lengths, never negative, in the order of the axes; for [`Axes::Eigenvectors`] the eigenvalues with their
    /// signs, or their real part where they are complex; for dual eigenvectors the semi-axes of the stretching and
    /// turning part.
    pub values: [f64; 2],
    /// What tells the axes apart, in the unit of the tensor: the difference of the semi-axes, or of `u . T u` along
    /// them where they are ordered by value; for eigenvectors that of the stretching (by magnitude the trace, where it
    /// is smaller), for dual ones the turning where it is smaller. It grows in proportion to the distance from where
    /// the axes cannot be told apart.
    pub contrast: f64,
}

struct Numbers {
    f: [f64; 2],
    e: [f64; 2],
}

impl Numbers {
    fn of(t: &Tensor2) -> Self {
        Self { f: [t.xx() - t.yy(), t.xy() + t.yx()], e: [t.xx() + t.yy(), t.yx() - t.xy()] }
    }

    /// The numbers of a tensor times a power of two, which is the second result, so that squares stay in range; most
    /// tensors need none. `None` where the tensor is zero or not finite.
    fn scaled(t: &Tensor2) -> Option<(Self, f64)> {
        let largest = t.max_abs();
        let scale = match largest {
            1e-60..=1e60 => 1.0,
            _ => math::scale_by_power_of_two(1.0, -math::binary_exponent(largest)),
        };
        let is_possible = t.is_finite() && largest > 0.0 && scale.is_finite() && scale > 0.0;
        is_possible.then(|| (Self::of(&t.scaled(scale)), scale))
    }
}

impl Axes {
    /// Their usual order: eigenvectors by value, semi-axes and dual eigenvectors by magnitude.
    #[must_use]
    pub const fn usual_major(self) -> Major {
        match self {
            Self::Eigenvectors => Major::Value,
            Self::HalfAxes | Self::DualEigenvectors => Major::Magnitude,
        }
    }

    /// These axes in an order. Dual eigenvectors have but one, the longer first.
    #[must_use]
    pub const fn by(self, major: Major) -> OrderedAxes {
        match self {
            Self::DualEigenvectors => OrderedAxes { axes: self, major: Major::Magnitude },
            Self::HalfAxes | Self::Eigenvectors => OrderedAxes { axes: self, major },
        }
    }

    /// The axes of a tensor in their usual order, see [`OrderedAxes::of`].
    #[must_use]
    pub fn of(self, t: &Tensor2, least: f64) -> Option<Frame> {
        OrderedAxes::from(self).of(t, least)
    }

    /// The [`Frame::values`] of a tensor in their usual order, see [`OrderedAxes::values`].
    #[must_use]
    pub fn values(self, t: &Tensor2) -> Option<[f64; 2]> {
        OrderedAxes::from(self).values(t)
    }
}

impl OrderedAxes {
    /// Which axes.
    #[must_use]
    pub const fn axes(self) -> Axes {
        self.axes
    }

    /// Their order.
    #[must_use]
    pub const fn major(self) -> Major {
        self.major
    }

    /// The axes of a tensor. `None` where it is not finite, and where it has none: its [`Frame::contrast`] is not more
    /// than the part `least` of the larger semi-axis.
    #[must_use]
    pub fn of(self, t: &Tensor2, least: f64) -> Option<Frame> {
        let (numbers, scale) = Numbers::scaled(t)?;
        let (axes, contrast) = match self.axes {
            Axes::HalfAxes => semi_axes(&numbers, self.major, least),
            Axes::Eigenvectors => eigenvectors(&numbers, self.major, least),
            Axes::DualEigenvectors => dual_eigenvectors(&numbers, least),
        }?;
        let values = self.values_of(&numbers);
        Some(Frame { axes, values: values.map(|v| v / scale), contrast: contrast / scale })
    }

    /// The [`Frame::values`] of a tensor, which there are without axes, too: both of the same size then. `None` where
    /// it is not finite.
    #[must_use]
    pub fn values(self, t: &Tensor2) -> Option<[f64; 2]> {
        if t.is_zero() {
            return Some([0.0; 2]);
        }
        let (numbers, scale) = Numbers::scaled(t)?;
        Some(self.values_of(&numbers).map(|v| v / scale))
    }

    fn values_of(self, numbers: &Numbers) -> [f64; 2] {
        let Numbers { f, e } = numbers;
        let stretch = size(*f);
        let ordered = |[a, b]: [f64; 2]| if self.is_turned(numbers) { [b, a] } else { [a, b] };
        match self.axes {
            Axes::HalfAxes => ordered(longer_and_shorter(stretch, size(*e))),
            Axes::DualEigenvectors => longer_and_shorter(stretch, e[1].abs()),
            Axes::Eigenvectors => {
                let middle = 0.5 * e[0];
                let off = 0.25 * ((stretch + e[1].abs()) * (stretch - e[1].abs())).max(0.0);
                ordered([middle + off.sqrt(), middle - off.sqrt()])
            }
        }
    }

    /// Whether the order is other than the usual one of the axes: both orders agree as long as the trace is not
    /// negative.
    fn is_turned(self, Numbers { e, .. }: &Numbers) -> bool {
        e[0] < 0.0 && self.major != self.axes.usual_major()
    }
}

fn longer_and_shorter(a: f64, b: f64) -> [f64; 2] {
    [0.5 * (a + b), 0.5 * (a - b).abs()]
}

/// Axes, and what tells them apart.
type AxesAndContrast = ([[f64; 2]; 2], f64);

fn semi_axes(numbers: &Numbers, by: Major, least: f64) -> Option<AxesAndContrast> {
    let Numbers { f, e } = numbers;
    let (stretch, rest) = (size(*f), size(*e));
    let sum = 0.5 * (stretch + rest);
    // What vanishes beside the rest has no direction, nor has its product with it.
    let least = least.max(f64::EPSILON * f64::EPSILON) * sum;
    let (e, contrast) = match by {
        Major::Magnitude => (*e, stretch.min(rest)),
        Major::Value => by_value(*e, stretch, rest),
    };
    if contrast <= least {
        return None;
    }
    let major = half_angle([f[0] * e[0] - f[1] * e[1], f[0] * e[1] + f[1] * e[0]]);
    Some(([major, quarter_turned(major)], contrast))
}

/// E with the sign that makes the axis of the larger `u . T u` major, and the difference of the two. Where E vanishes
/// the tensor is symmetric as far as anybody can tell, and has eigenvectors.
fn by_value(e: [f64; 2], stretch: f64, rest: f64) -> ([f64; 2], f64) {
    if rest <= f64::EPSILON * stretch {
        return ([1.0, 0.0], stretch);
    }
    let sign = if e[0] < 0.0 { -1.0 } else { 1.0 };
    // Divided by its size: the product with F must not vanish.
    (e.map(|v| sign * v / rest), stretch * e[0].abs() / rest)
}

fn eigenvectors(Numbers { f, e }: &Numbers, by: Major, least: f64) -> Option<AxesAndContrast> {
    let (stretch, rest) = (size(*f), size(*e));
    let contrast = match by {
        Major::Value => stretch,
        // Real parts of opposite signs and the same size.
        Major::Magnitude => stretch.min(e[0].abs()),
    };
    if contrast <= least * 0.5 * (stretch + rest) {
        return None;
    }
    let (stretching, turning) = (0.5 * stretch, 0.5 * e[1].abs());
    // Rotated from the bisector by 45 degrees less, and more, the angle whose tangent is sqrt(|difference| / sum).
    let (c, s) = ((stretching + turning).sqrt(), (stretching - turning).abs().sqrt());
    let (c, s) = (c / size([c, s]), s / size([c, s]));
    let side = if e[1] < 0.0 { -1.0 } else { 1.0 };
    let bisector = half_angle(*f);
    let diagonal = core::f64::consts::FRAC_1_SQRT_2;
    let about = |cos: f64, sin: f64| {
        [bisector[0] * cos - side * bisector[1] * sin, bisector[1] * cos + side * bisector[0] * sin]
    };
    let major = about(diagonal * (c + s), diagonal * (c - s));
    let minor = about(diagonal * (c - s), diagonal * (c + s));
    let is_turned = by == Major::Magnitude && e[0] < 0.0;
    Some((if is_turned { [minor, major] } else { [major, minor] }, contrast))
}

fn dual_eigenvectors(Numbers { f, e }: &Numbers, least: f64) -> Option<AxesAndContrast> {
    let (stretch, rest) = (size(*f), size(*e));
    let contrast = stretch.min(e[1].abs());
    if contrast <= least * 0.5 * (stretch + rest) {
        return None;
    }
    // A quarter turn of F is an eighth turn of its axis.
    let turned = if e[1] < 0.0 { [f[1], -f[0]] } else { [-f[1], f[0]] };
    let major = half_angle(turned);
    Some(([major, quarter_turned(major)], contrast))
}

/// Components are scaled: their squares neither overflow nor vanish beside each other.
fn size(z: [f64; 2]) -> f64 {
    (z[0] * z[0] + z[1] * z[1]).sqrt()
}

/// The unit vector at half the angle of a number, without the angle.
fn half_angle(z: [f64; 2]) -> [f64; 2] {
    let r = size(z);
    if z[0] >= 0.0 {
        let c = (0.5 * (r + z[0])).sqrt();
        let s = 0.5 * z[1] / c;
        let n = r.sqrt();
        [c / n, s / n]
    } else {
        let s = (0.5 * (r - z[0])).sqrt();
        let c = 0.5 * z[1] / s;
        let n = r.sqrt();
        [c / n, s / n]
    }
}

const fn quarter_turned(v: [f64; 2]) -> [f64; 2] {
    [-v[1], v[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Eigenvalues, Svd};
    use tigereye_test_support::Random;

    /// Tensors of all kinds, from a fixed sequence.
    fn tensors() -> Vec<Tensor2> {
        let mut numbers = Random::seeded(5);
        let mut random = move || numbers.signed();
        let mut all: Vec<Tensor2> =
            (0..500).map(|_| Tensor2::new(random(), random(), random(), random())).collect();
        all.extend((0..500).map(|_| Tensor2::symmetric(random(), random(), random())));
        all.extend([
            Tensor2::from_axes(0.0, 3.0, 1.0),
            Tensor2::from_axes(core::f64::consts::FRAC_PI_2, 3.0, 1.0),
            Tensor2::symmetric(-1.0, 0.0, -3.0),
            Tensor2::new(0.0, -2.0, 1.0, 0.0),
            Tensor2::new(0.0, 1.0, -2.0, 0.0),
            Tensor2::new(1e-200, 2e-200, 0.0, 1e-200),
            Tensor2::new(1e200, 2e200, 0.0, 1e200),
        ]);
        all
    }

    fn sine_between(a: [f64; 2], b: [f64; 2]) -> f64 {
        (a[0] * b[1] - a[1] * b[0]).abs()
    }

    fn applied(t: &Tensor2, v: [f64; 2]) -> [f64; 2] {
        [t.xx() * v[0] + t.xy() * v[1], t.yx() * v[0] + t.yy() * v[1]]
    }

    #[test]
    fn semi_axes_are_the_singular_vectors() {
        for t in tensors() {
            let (frame, svd) = (Axes::HalfAxes.of(&t, 0.0).expect("axes"), Svd::of(&t));
            let tolerance = 1e-14 * svd.s[0] / (svd.s[0] - svd.s[1]);
            assert!(sine_between(frame.axes[0], svd.major()) < tolerance, "{t:?}");
            for (a, b) in frame.values.iter().zip(svd.s) {
                assert!((a - b).abs() < 1e-14 * svd.s[0], "{t:?}");
            }
        }
    }

    #[test]
    fn eigenvectors_keep_their_direction() {
        let mut real = 0;
        for t in tensors().into_iter().filter(|t| Decomposition::of(t).domain() == Domain::Real) {
            let (frame, values) = (Axes::Eigenvectors.of(&t, 0.0).expect("axes"), Eigenvalues::of(&t));
            for (axis, value) in frame.axes.into_iter().zip(frame.values) {
                let image = applied(&t, axis);
                let off = (0..2).map(|i| (image[i] - value * axis[i]).abs()).fold(0.0, f64::max);
                // Eigenvectors are as uncertain as the square root of what separates their eigenvalues.
                assert!(off < 1e-13 * t.max_abs(), "{t:?}: {off}");
            }
            let mut known = values.real_parts();
            known.sort_by(|a, b| b.total_cmp(a));
            assert!(known.iter().zip(frame.values).all(|(a, b)| (a - b).abs() < 1e-7 * t.max_abs()), "{t:?}");
            real += 1;
        }
        assert!(real > 600);
    }

    /// Symmetric tensors: the classical axes, the larger eigenvalue first whatever its size.
    #[test]
    fn symmetric_tensors_are_ordered_with_their_signs() {
        let t = Tensor2::symmetric(-1.0, 0.0, -3.0);
        let frame = Axes::Eigenvectors.of(&t, 0.0).expect("axes");
        assert_eq!((frame.values, frame.axes[0][0].abs()), ([-1.0, -3.0], 1.0));
        let half = Axes::HalfAxes.of(&t, 0.0).expect("axes");
        assert_eq!((half.values, half.axes[0][1].abs()), ([3.0, 1.0], 1.0));
        assert_eq!(Axes::DualEigenvectors.of(&t, 1e-12), None, "nothing turns");
    }

    #[test]
    fn dual_eigenvectors_lie_between_the_eigenvectors() {
        for t in tensors() {
            let Some(dual) = Axes::DualEigenvectors.of(&t, 1e-6) else { continue };
            let frame = Axes::Eigenvectors.of(&t, 0.0).expect("axes");
            let [a, b] = frame.axes;
            let cosine = |v: [f64; 2]| (v[0] * dual.axes[0][0] + v[1] * dual.axes[0][1]).abs();
            assert!((cosine(a) - cosine(b)).abs() < 1e-12, "{t:?}");
        }
    }

    /// The linear flow of a turning tensor runs along ellipses: the square of the speed is extremal on their axes.
    #[test]
    fn dual_eigenvectors_are_the_axes_of_elliptic_flow() {
        // x' = -2 y, y' = x keeps x^2 + 2 y^2: the longer axis lies along x.
        let flat = Axes::DualEigenvectors.of(&Tensor2::new(0.0, -2.0, 1.0, 0.0), 0.0).expect("axes");
        assert!(sine_between(flat.axes[0], [1.0, 0.0]) < 1e-15);
        // Clockwise the same.
        let back = Axes::DualEigenvectors.of(&Tensor2::new(0.0, 2.0, -1.0, 0.0), 0.0).expect("axes");
        assert!(sine_between(back.axes[0], [1.0, 0.0]) < 1e-15);
        // The rectangle around that ellipse has sides sqrt(2) : 1.
        let frame = Axes::Eigenvectors.of(&Tensor2::new(0.0, -2.0, 1.0, 0.0), 0.0).expect("axes");
        for axis in frame.axes {
            assert!((axis[0].abs() / axis[1].abs() - 2.0_f64.sqrt()).abs() < 1e-14, "{axis:?}");
        }
    }

    /// Where real eigenvalues become complex both axes go over into one.
    #[test]
    fn axes_do_not_jump_between_the_domains() {
        let at = |rotation: f64| Tensor2::new(1.0 + 0.6, 0.8 - rotation, 0.8 + rotation, 1.0 - 0.6);
        for side in [1.0, -1.0] {
            let [inside, outside] =
                [0.999_999, 1.000_001].map(|r| Axes::Eigenvectors.of(&at(side * r), 0.0).expect("axes"));
            for (a, b) in inside.axes.into_iter().zip(outside.axes) {
                assert!(sine_between(a, b) < 3e-3, "{a:?} {b:?}");
            }
            assert!(sine_between(inside.axes[0], inside.axes[1]) < 3e-3);
        }
    }

    /// Values are those of the axes, and there where these are none.
    #[test]
    fn values_do_not_need_axes() {
        let all = [Axes::HalfAxes, Axes::Eigenvectors, Axes::DualEigenvectors];
        for axes in all {
            for t in tensors() {
                let Some(frame) = axes.of(&t, 0.0) else { continue };
                assert_eq!(axes.values(&t), Some(frame.values));
            }
            assert_eq!(axes.values(&Tensor2::ZERO), Some([0.0; 2]));
            assert_eq!(axes.values(&Tensor2::isotropic(f64::NAN)), None);
        }
        // Scaling by 3 and a turn of size 4: semi-axes of 5, real parts of 3, and an ellipse of flow that is a circle.
        let turning = Tensor2::new(3.0, -4.0, 4.0, 3.0);
        assert!(all.iter().all(|axes| axes.of(&turning, 0.0).is_none()));
        assert_eq!(all.map(|axes| axes.values(&turning)), [[5.0; 2], [3.0; 2], [4.0; 2]].map(Some));
        assert_eq!(Axes::HalfAxes.values(&Tensor2::symmetric(2.0, 0.0, -2.0)), Some([2.0; 2]));
    }

    #[test]
    fn tensors_without_axes_have_none() {
        let none = [
            Tensor2::ZERO,
            Tensor2::IDENTITY,
            Tensor2::isotropic(f64::NAN),
            Tensor2::isotropic(f64::INFINITY),
        ];
        for axes in [Axes::HalfAxes, Axes::Eigenvectors, Axes::DualEigenvectors] {
            for t in &none {
                assert_eq!(axes.of(t, 1e-9), None, "{axes:?} {t:?}");
            }
        }
        assert_eq!(Axes::HalfAxes.of(&Tensor2::symmetric(1.0, 0.0, -1.0), 1e-9), None, "equally long");
        assert!(Axes::Eigenvectors.of(&Tensor2::symmetric(1.0, 0.0, -1.0), 1e-9).is_some());
    }
}
