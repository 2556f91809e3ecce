//! Which two axes a tensor has.
//!
//! With the numbers `E` and `F` of [`Conformal`] a tensor stretches by `|F| / 2` along `arg F / 2`, rotates by `Im E /
//! 2` and scales by `Re E / 2`. Its semi-axes, eigenvectors and dual eigenvectors are closed formulas of the two (Zheng
//! and Pang, 2D asymmetric tensor analysis, 2005; Zhang, Yeh, Lin and Laramee, Asymmetric tensor analysis for flow
//! visualization, 2009).
//!
//! # Which axis is major
//!
//! If one axis is stretched and the other compressed, there are two conventions, and [`Major`] selects one:
//!
//! - **By value**, as in mechanics: of eigenvectors the one with the algebraically larger eigenvalue (its real part),
//!   of semi-axes the one along which `u . T u` is larger. Both agree for symmetric tensors: tension is major, whatever
//!   its size. With `u . T u = (Re E +- |F| Re E / |E|) / 2` along the longer and the shorter semi-axis, the longer one
//!   is major where the trace is positive and the shorter one where it is negative.
//! - **By magnitude**, as light sees it: the longer semi-axis, or the eigenvector whose eigenvalue has the larger
//!   absolute value.
//!
//! By default eigenvectors are ordered by value and semi-axes by magnitude ([`Axes::by`]). The two orders agree if both
//! eigenvalues are positive.
//!
//! How well the axes can be distinguished ([`Frame::contrast`]) depends on the order. By value, symmetric tensors have
//! axes wherever `F` is not zero, including pure shear (2, -2); by magnitude, pure shear is degenerate, because both
//! semi-axes are equally long. Eigenvectors by magnitude, and semi-axes of asymmetric tensors by value, swap roles
//! where the trace is zero, so their lines end there.

use tigereye_core::{Choice, Complex, Conformal, Tensor2, Vector, choice, math, quarter_turned};

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
    /// Its name as a choice.
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
    /// Eigenvectors, the axes of classical tensor lines. For complex eigenvalues (rotation stronger than stretching)
    /// the pseudo-eigenvectors: the diagonals of the smallest rectangle around the elliptical orbits of the tensor's
    /// linear flow.
    Eigenvectors,
    /// Dual eigenvectors: the bisectors of the eigenvectors or, for complex eigenvalues, the axes of the elliptical
    /// orbits of the linear flow, the longer one major. Undefined for symmetric tensors, which contain no rotation.
    DualEigenvectors,
}

choice!(Axes {
    HalfAxes = "half": "Semi-axes of the ellipse: what light sees.",
    Eigenvectors = "eigen": "Eigenvectors; pseudo-eigenvectors where eigenvalues are complex.",
    DualEigenvectors = "dual":
        "Dual eigenvectors, halfway between the eigenvectors; only for tensors that are not symmetric.",
});

impl Axes {
    /// Its name as a choice.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.word()
    }
}

/// How the two axes are compared; the rule stands at the beginning of `axes.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Major {
    /// By the signed value: tension is major.
    Value,
    /// By the absolute value: the longer axis is major.
    Magnitude,
}

choice!(Major {
    Value = "value": "By the value with its sign, as in mechanics: tension before compression.",
    Magnitude = "magnitude": "By the size of the value, as light sees it: the longer one.",
});

impl Major {
    /// Its name as a choice.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.word()
    }
}

/// Axes together with their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OrderedAxes {
    axes: Axes,
    major: Major,
}

impl From<Axes> for OrderedAxes {
    /// In the usual order.
    fn from(axes: Axes) -> Self {
        axes.by(axes.usual_major())
    }
}

impl OrderedAxes {
    /// A description in words.
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
    /// Two real eigenvalues: the tensor stretches at least as much as it rotates.
    Real,
    /// A complex-conjugate pair.
    Complex,
}

/// The strengths of the three parts of a tensor: scaling, rotation and stretching.
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
        let Conformal { f, e } = Conformal::of(t);
        Self { scaling: 0.5 * e.re, rotation: 0.5 * e.im, stretching: 0.5 * math::hypot(f.re, f.im) }
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
    /// Unit vectors, major first, each with either sign.
    pub axes: [Vector; 2],
    /// In the order of the axes: the lengths of semi-axes; for [`Axes::Eigenvectors`] the signed eigenvalues, or their
    /// real part if they are complex; for dual eigenvectors the semi-axes of the tensor without its isotropic part.
    pub values: [f64; 2],
    /// How well the axes can be distinguished, in the unit of the tensor: the difference of the semi-axes (of `u . T u`
    /// along them, if they are ordered by value); for eigenvectors the stretching `|F|` (by magnitude the trace, if
    /// smaller), for dual eigenvectors the rotation, if smaller. It grows linearly with the distance from a degenerate
    /// point.
    pub contrast: f64,
}

/// The numbers of a tensor scaled by a power of two, which is the second result, so that squares stay in range; for
/// most tensors it is 1. `None` if the tensor is zero or not finite.
fn scaled(t: &Tensor2) -> Option<(Conformal, f64)> {
    let largest = t.max_abs();
    let scale = match largest {
        1e-60..=1e60 => 1.0,
        _ => math::scale_by_power_of_two(1.0, -math::binary_exponent(largest)),
    };
    let is_possible = t.is_finite() && largest > 0.0 && scale.is_finite() && scale > 0.0;
    is_possible.then(|| (Conformal::of(&t.scaled(scale)), scale))
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

    /// These axes in a given order. Dual eigenvectors have only one order, the longer first.
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

    /// The axes of a tensor. `None` if it is not finite or degenerate: if its [`Frame::contrast`] is at most the
    /// fraction `least` of the larger semi-axis.
    #[must_use]
    pub fn of(self, t: &Tensor2, least: f64) -> Option<Frame> {
        let (numbers, scale) = scaled(t)?;
        let (axes, contrast) = match self.axes {
            Axes::HalfAxes => semi_axes(&numbers, self.major, least),
            Axes::Eigenvectors => eigenvectors(&numbers, self.major, least),
            Axes::DualEigenvectors => dual_eigenvectors(&numbers, least),
        }?;
        let values = self.values_of(&numbers);
        Some(Frame { axes, values: values.map(|v| v / scale), contrast: contrast / scale })
    }

    /// The [`Frame::values`] of a tensor. They are also defined for a degenerate tensor, where both have the same
    /// magnitude. `None` if it is not finite.
    #[must_use]
    pub fn values(self, t: &Tensor2) -> Option<[f64; 2]> {
        if t.is_zero() {
            return Some([0.0; 2]);
        }
        let (numbers, scale) = scaled(t)?;
        Some(self.values_of(&numbers).map(|v| v / scale))
    }

    fn values_of(self, numbers: &Conformal) -> [f64; 2] {
        let Conformal { f, e } = numbers;
        let stretch = size(*f);
        let ordered = |[a, b]: [f64; 2]| if self.is_swapped(numbers) { [b, a] } else { [a, b] };
        match self.axes {
            Axes::HalfAxes => ordered(longer_and_shorter(stretch, size(*e))),
            Axes::DualEigenvectors => longer_and_shorter(stretch, e.im.abs()),
            Axes::Eigenvectors => {
                let middle = 0.5 * e.re;
                let off = 0.25 * ((stretch + e.im.abs()) * (stretch - e.im.abs())).max(0.0);
                ordered([middle + off.sqrt(), middle - off.sqrt()])
            }
        }
    }

    /// Whether the axes are swapped relative to their usual order. The two orders agree unless the trace is negative.
    fn is_swapped(self, Conformal { e, .. }: &Conformal) -> bool {
        e.re < 0.0 && self.major != self.axes.usual_major()
    }
}

fn longer_and_shorter(a: f64, b: f64) -> [f64; 2] {
    [0.5 * (a + b), 0.5 * (a - b).abs()]
}

/// Both axes and their [`Frame::contrast`].
type AxesAndContrast = ([Vector; 2], f64);

fn semi_axes(numbers: &Conformal, by: Major, least: f64) -> Option<AxesAndContrast> {
    let Conformal { f, e } = numbers;
    let (stretch, rest) = (size(*f), size(*e));
    let sum = 0.5 * (stretch + rest);
    // A number that vanishes beside the other one has no direction, nor does their product.
    let least = least.max(f64::EPSILON * f64::EPSILON) * sum;
    let (e, contrast) = match by {
        Major::Magnitude => (*e, stretch.min(rest)),
        Major::Value => by_value(*e, stretch, rest),
    };
    if contrast <= least {
        return None;
    }
    let major = half_angle(f * e);
    Some(([major, quarter_turned(major)], contrast))
}

/// E with the sign that makes the axis of the larger `u . T u` major, and the difference of the two. If E vanishes, the
/// tensor is symmetric up to rounding, and its semi-axes are its eigenvectors.
fn by_value(e: Complex<f64>, stretch: f64, rest: f64) -> (Complex<f64>, f64) {
    if rest <= f64::EPSILON * stretch {
        return (Complex::new(1.0, 0.0), stretch);
    }
    let sign = if e.re < 0.0 { -1.0 } else { 1.0 };
    // Normalised, so that the product with F does not underflow.
    (e * sign / rest, stretch * e.re.abs() / rest)
}

fn eigenvectors(Conformal { f, e }: &Conformal, by: Major, least: f64) -> Option<AxesAndContrast> {
    let (stretch, rest) = (size(*f), size(*e));
    let contrast = match by {
        Major::Value => stretch,
        // Where the trace vanishes, the eigenvalues have the same magnitude.
        Major::Magnitude => stretch.min(e.re.abs()),
    };
    if contrast <= least * 0.5 * (stretch + rest) {
        return None;
    }
    let (stretching, turning) = (0.5 * stretch, 0.5 * e.im.abs());
    // Both lie at 45 degrees to the bisector, minus and plus the angle whose tangent is sqrt(|difference| / sum).
    let (c, s) = ((stretching + turning).sqrt(), (stretching - turning).abs().sqrt());
    let size = size(Complex::new(c, s));
    let (c, s) = (c / size, s / size);
    let side = if e.im < 0.0 { -1.0 } else { 1.0 };
    let bisector = half_angle(*f);
    let diagonal = core::f64::consts::FRAC_1_SQRT_2;
    let about = |cos: f64, sin: f64| {
        Vector::new(bisector.x * cos - side * bisector.y * sin, bisector.y * cos + side * bisector.x * sin)
    };
    let major = about(diagonal * (c + s), diagonal * (c - s));
    let minor = about(diagonal * (c - s), diagonal * (c + s));
    let is_swapped = by == Major::Magnitude && e.re < 0.0;
    Some((if is_swapped { [minor, major] } else { [major, minor] }, contrast))
}

fn dual_eigenvectors(Conformal { f, e }: &Conformal, least: f64) -> Option<AxesAndContrast> {
    let (stretch, rest) = (size(*f), size(*e));
    let contrast = stretch.min(e.im.abs());
    if contrast <= least * 0.5 * (stretch + rest) {
        return None;
    }
    // A quarter turn of F rotates its axis by 45 degrees.
    let turned = if e.im < 0.0 { Complex::new(f.im, -f.re) } else { Complex::new(-f.im, f.re) };
    let major = half_angle(turned);
    Some(([major, quarter_turned(major)], contrast))
}

/// Magnitude of a complex number. Components are scaled, so their squares neither overflow nor underflow.
fn size(z: Complex<f64>) -> f64 {
    (z.re * z.re + z.im * z.im).sqrt()
}

/// The unit vector at half the argument of a number. Lines ask for it at every stage of a step, so it does without the
/// scaling of the decompositions in `core`.
fn half_angle(z: Complex<f64>) -> Vector {
    let r = size(z);
    if z.re >= 0.0 {
        let c = (0.5 * (r + z.re)).sqrt();
        let s = 0.5 * z.im / c;
        let n = r.sqrt();
        Vector::new(c / n, s / n)
    } else {
        let s = (0.5 * (r - z.re)).sqrt();
        let c = 0.5 * z.im / s;
        let n = r.sqrt();
        Vector::new(c / n, s / n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Eigenvalues, SplitMix64, Svd};

    /// Tensors of all kinds, from a fixed sequence.
    fn tensors() -> Vec<Tensor2> {
        let mut numbers = SplitMix64::new(5);
        let mut random = move || numbers.symmetric_unit();
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

    fn sine_between(a: Vector, b: Vector) -> f64 {
        a.cross(b).abs()
    }

    fn applied(t: &Tensor2, v: Vector) -> Vector {
        Vector::new(t.xx() * v.x + t.xy() * v.y, t.yx() * v.x + t.yy() * v.y)
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
                let off = (applied(&t, axis) - axis * value).abs();
                let off = off.x.max(off.y);
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
        assert_eq!((frame.values, frame.axes[0].x.abs()), ([-1.0, -3.0], 1.0));
        let half = Axes::HalfAxes.of(&t, 0.0).expect("axes");
        assert_eq!((half.values, half.axes[0].y.abs()), ([3.0, 1.0], 1.0));
        assert_eq!(Axes::DualEigenvectors.of(&t, 1e-12), None, "no rotation");
    }

    #[test]
    fn dual_eigenvectors_lie_between_the_eigenvectors() {
        for t in tensors() {
            let Some(dual) = Axes::DualEigenvectors.of(&t, 1e-6) else { continue };
            let frame = Axes::Eigenvectors.of(&t, 0.0).expect("axes");
            let [a, b] = frame.axes;
            let cosine = |v: Vector| v.dot(dual.axes[0]).abs();
            assert!((cosine(a) - cosine(b)).abs() < 1e-12, "{t:?}");
        }
    }

    /// The linear flow of a tensor with complex eigenvalues runs along ellipses: the speed is extremal on their axes.
    #[test]
    fn dual_eigenvectors_are_the_axes_of_elliptic_flow() {
        // x' = -2 y, y' = x keeps x^2 + 2 y^2: the longer axis lies along x.
        let flat = Axes::DualEigenvectors.of(&Tensor2::new(0.0, -2.0, 1.0, 0.0), 0.0).expect("axes");
        assert!(sine_between(flat.axes[0], Vector::new(1.0, 0.0)) < 1e-15);
        // The same for clockwise rotation.
        let back = Axes::DualEigenvectors.of(&Tensor2::new(0.0, 2.0, -1.0, 0.0), 0.0).expect("axes");
        assert!(sine_between(back.axes[0], Vector::new(1.0, 0.0)) < 1e-15);
        // The rectangle around that ellipse has sides sqrt(2) : 1.
        let frame = Axes::Eigenvectors.of(&Tensor2::new(0.0, -2.0, 1.0, 0.0), 0.0).expect("axes");
        for axis in frame.axes {
            assert!((axis.x.abs() / axis.y.abs() - 2.0_f64.sqrt()).abs() < 1e-14, "{axis:?}");
        }
    }

    /// Where real eigenvalues become complex, the two eigenvectors merge.
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

    /// Values are those of the axes, and are also defined for degenerate tensors.
    #[test]
    fn degenerate_tensors_have_values() {
        let all = [Axes::HalfAxes, Axes::Eigenvectors, Axes::DualEigenvectors];
        for axes in all {
            for t in tensors() {
                let Some(frame) = axes.of(&t, 0.0) else { continue };
                assert_eq!(axes.values(&t), Some(frame.values));
            }
            assert_eq!(axes.values(&Tensor2::ZERO), Some([0.0; 2]));
            assert_eq!(axes.values(&Tensor2::isotropic(f64::NAN)), None);
        }
        // Scaling by 3 and rotation by 4: semi-axes of 5, real parts of 3, and circular orbits of the flow.
        let turning = Tensor2::new(3.0, -4.0, 4.0, 3.0);
        assert!(all.iter().all(|axes| axes.of(&turning, 0.0).is_none()));
        assert_eq!(all.map(|axes| axes.values(&turning)), [[5.0; 2], [3.0; 2], [4.0; 2]].map(Some));
        assert_eq!(Axes::HalfAxes.values(&Tensor2::symmetric(2.0, 0.0, -2.0)), Some([2.0; 2]));
    }

    #[test]
    fn degenerate_tensors_have_no_axes() {
        let degenerate = [
            Tensor2::ZERO,
            Tensor2::IDENTITY,
            Tensor2::isotropic(f64::NAN),
            Tensor2::isotropic(f64::INFINITY),
        ];
        for axes in [Axes::HalfAxes, Axes::Eigenvectors, Axes::DualEigenvectors] {
            for t in &degenerate {
                assert_eq!(axes.of(t, 1e-9), None, "{axes:?} {t:?}");
            }
        }
        assert_eq!(Axes::HalfAxes.of(&Tensor2::symmetric(1.0, 0.0, -1.0), 1e-9), None, "equally long");
        assert!(Axes::Eigenvectors.of(&Tensor2::symmetric(1.0, 0.0, -1.0), 1e-9).is_some());
    }
}
