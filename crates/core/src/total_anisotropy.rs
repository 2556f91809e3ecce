//! When a tensor counts as totally anisotropic, and what becomes of its profile there.

use crate::{CoreError, Field, Svd, Tensor2, math};
use core::fmt;
use core::str::FromStr;

/// Above this ratio of the semi-axes (or with a vanishing one) a tensor counts as totally anisotropic and its profile
/// is a bidirectional pulse (thesis, section 4.3; the value is the published program's).
pub const TOTAL_ANISOTROPY_RATIO: f64 = 20.0;

/// What becomes of tensors with a large ratio `s1/s2` of the semi-axes: a rule with a ratio R.
///
/// A step (the published program) turns ellipses into pulses at one ratio. At that ratio a small change of the tensor
/// changes the light by a finite amount, so the border of the region beyond is an edge in every gradient. A blend has
/// no such edge: between `R / width` and `R * width` the profile is `(1 - p)` times the ellipse plus `p` times
/// the pulse, where p is the smooth step `3 u^2 - 2 u^3` of the position u of `ln(s1/s2)` in the interval. Both have
/// the height s1 along the major axis. For both, a tensor with a vanishing axis is a pulse: its ellipse is a line.
///
/// A cap has no pulses at all: the minor axis counts as `s1 / R` at least.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TotalAnisotropy {
    ratio: f64,
    beyond: Beyond,
}

/// What becomes of the tensors beyond the ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Beyond {
    /// A pulse; gradually, if the width is above 1.
    Pulse { width: f64 },
    /// The ellipse of the ratio.
    Cap,
}

impl TotalAnisotropy {
    /// The published program's: a step at [`TOTAL_ANISOTROPY_RATIO`].
    pub const PUBLISHED: Self = Self { ratio: TOTAL_ANISOTROPY_RATIO, beyond: Beyond::Pulse { width: 1.0 } };
    /// Only tensors with an axis that vanishes within rounding.
    pub const NONE: Self = Self { ratio: Self::LARGEST_RATIO, beyond: Beyond::Pulse { width: 1.0 } };
    /// A blend from half to twice [`TOTAL_ANISOTROPY_RATIO`].
    pub const SMOOTH: Self = Self { ratio: TOTAL_ANISOTROPY_RATIO, beyond: Beyond::Pulse { width: 2.0 } };
    /// The ellipse of [`TOTAL_ANISOTROPY_RATIO`] for all beyond it.
    pub const CAPPED: Self = Self { ratio: TOTAL_ANISOTROPY_RATIO, beyond: Beyond::Cap };

    /// Beyond this ratio the shorter axis is rounding.
    const LARGEST_RATIO: f64 = 1e12;

    /// A blend from `ratio / width` to `ratio * width`; a step at `ratio` where the width is 1.
    ///
    /// # Errors
    /// [`CoreError::TotalAnisotropy`] unless `1 <= ratio / width` and `ratio * width <= 1e12` and `width >= 1`.
    pub fn new(ratio: f64, width: f64) -> Result<Self, CoreError> {
        let fits = width >= 1.0 && ratio / width >= 1.0 && ratio * width <= Self::LARGEST_RATIO;
        let beyond = Beyond::Pulse { width };
        if fits { Ok(Self { ratio, beyond }) } else { Err(CoreError::TotalAnisotropy { ratio, width }) }
    }

    /// A cap at `ratio`.
    ///
    /// # Errors
    /// [`CoreError::TotalAnisotropy`] unless `1 <= ratio <= 1e12`.
    pub fn capped(ratio: f64) -> Result<Self, CoreError> {
        Self::new(ratio, 1.0).map(|rule| Self { beyond: Beyond::Cap, ..rule })
    }

    /// The ratio of the semi-axes beyond which tensors are totally anisotropic; the middle of a blend.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        self.ratio
    }

    /// The ratios between which ellipses become pulses, if they do so gradually.
    #[must_use]
    pub fn blend(&self) -> Option<[f64; 2]> {
        match self.beyond {
            Beyond::Pulse { width } if width > 1.0 => Some([self.ratio / width, self.ratio * width]),
            Beyond::Pulse { .. } | Beyond::Cap => None,
        }
    }

    /// Whether tensors beyond the ratio have the ellipse of the ratio.
    #[must_use]
    pub fn is_cap(&self) -> bool {
        self.beyond == Beyond::Cap
    }

    /// The least ratio `s2/s1` that the axes of an ellipse count as having.
    #[must_use]
    pub fn least_axis_ratio(&self) -> f64 {
        if self.is_cap() { 1.0 / self.ratio } else { 0.0 }
    }

    /// The weight of the pulse in the profile of a tensor with the semi-axes `s1 >= s2`, 0 to 1.
    #[must_use]
    pub fn pulse_weight(&self, s1: f64, s2: f64) -> f64 {
        let Beyond::Pulse { width } = self.beyond else { return 0.0 };
        // A quotient of subnormal numbers may overflow; infinity compares as it should.
        let ratio = s1 / s2;
        let [lower, upper] = [self.ratio / width, self.ratio * width];
        if s1 == 0.0 || s2 == 0.0 || ratio > upper {
            return 1.0;
        }
        if ratio <= lower {
            return 0.0;
        }
        let u = math::ln(ratio / lower) / math::ln(upper / lower);
        u * u * (3.0 - 2.0 * u)
    }

    /// Whether a tensor counts as totally anisotropic: at least half of its profile is a pulse, or its ellipse is
    /// capped. So does the zero tensor, which transmits nothing.
    #[must_use]
    pub fn contains(&self, t: &Tensor2) -> bool {
        let [s1, s2] = Svd::of(t).s;
        s1 == 0.0 || s2 == 0.0 || s1 / s2 > self.ratio
    }

    /// The cells of a field that are totally anisotropic; zero tensors, which transmit nothing, are not among them.
    #[must_use]
    pub fn cells(&self, field: &Field<Tensor2>) -> Field<bool> {
        field.map(|t| !t.is_zero() && self.contains(t))
    }
}

impl Default for TotalAnisotropy {
    fn default() -> Self {
        Self::PUBLISHED
    }
}

/// As in options: `none`, `R`, `R:WIDTH` or `cap:R`.
impl fmt::Display for TotalAnisotropy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NONE => f.write_str("none"),
            Self { ratio, beyond: Beyond::Pulse { width: 1.0 } } => write!(f, "{ratio}"),
            Self { ratio, beyond: Beyond::Pulse { width } } => write!(f, "{ratio}:{width}"),
            Self { ratio, beyond: Beyond::Cap } => write!(f, "cap:{ratio}"),
        }
    }
}

impl FromStr for TotalAnisotropy {
    type Err = CoreError;

    /// `none`, `smooth`, `R`, `R:WIDTH`, `cap` or `cap:R`.
    fn from_str(text: &str) -> Result<Self, CoreError> {
        let number =
            |t: &str| t.trim().parse().map_err(|_| CoreError::TotalAnisotropyWord { text: text.to_owned() });
        match text.split_once(':') {
            None if text == "none" => Ok(Self::NONE),
            None if text == "smooth" => Ok(Self::SMOOTH),
            None if text == "cap" => Ok(Self::CAPPED),
            None => Self::new(number(text)?, 1.0),
            Some(("cap", ratio)) => Self::capped(number(ratio)?),
            Some((ratio, width)) => Self::new(number(ratio)?, number(width)?),
        }
    }
}

/// Whether the published program makes the transmission of `t` a pulse (or nothing) instead of an ellipse.
#[must_use]
pub fn is_totally_anisotropic(t: &Tensor2) -> bool {
    TotalAnisotropy::PUBLISHED.contains(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_as_they_are_written() {
        for text in ["none", "20", "12.5", "20:2", "1", "cap:20", "cap:5.5"] {
            assert_eq!(text.parse::<TotalAnisotropy>().expect(text).to_string(), text);
        }
        assert_eq!("20".parse(), Ok(TotalAnisotropy::PUBLISHED));
        // Written as a proportion.
        assert_eq!("20:1".parse(), Ok(TotalAnisotropy::PUBLISHED));
        assert_eq!("smooth".parse(), Ok(TotalAnisotropy::SMOOTH));
        assert_eq!("20:2".parse(), Ok(TotalAnisotropy::SMOOTH));
        assert_eq!("cap".parse(), Ok(TotalAnisotropy::CAPPED));
    }

    #[test]
    fn other_words_and_ratios_are_refused() {
        for wrong in ["", "all", "20:", ":2", "x:2", "20:2:1", "cap:", "cap:x", "20:cap"] {
            let fault = wrong.parse::<TotalAnisotropy>().expect_err(wrong).to_string();
            assert!(fault.contains("`none`") && fault.contains("R:WIDTH"), "{wrong}: {fault}");
        }
        for wrong in ["0.5", "-1", "nan", "inf", "1e13", "20:0.5", "20:21", "20:nan", "1e12:2", "cap:0.5"] {
            assert!(wrong.parse::<TotalAnisotropy>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_step_is_a_step_at_its_ratio() {
        let published = TotalAnisotropy::PUBLISHED;
        assert_eq!([20.0, 20.1].map(|s1| published.pulse_weight(s1, 1.0)), [0.0, 1.0]);
        assert_eq!(TotalAnisotropy::NONE.pulse_weight(1e11, 1.0), 0.0);
        for rule in [published, TotalAnisotropy::NONE, TotalAnisotropy::SMOOTH] {
            assert_eq!([rule.pulse_weight(1.0, 0.0), rule.pulse_weight(1e300, 1e-300)], [1.0; 2]);
        }
    }

    /// From 10 to 40: half at 20, flat at both ends, and without a step anywhere.
    #[test]
    fn a_blend_changes_gradually() {
        let weight = |ratio| TotalAnisotropy::SMOOTH.pulse_weight(ratio, 1.0);
        assert_eq!([weight(10.0), weight(40.0), weight(41.0)], [0.0, 1.0, 1.0]);
        assert!((weight(20.0) - 0.5).abs() < 1e-15);
        let mut before = 0.0;
        for i in 0..=1000 {
            let now = weight(9.0 + 0.033 * f64::from(i));
            assert!((0.0..0.005).contains(&(now - before)), "at {i}: {before} to {now}");
            before = now;
        }
    }

    #[test]
    fn cells_are_counted_from_half_a_pulse_upwards() {
        for (rule, contained) in [
            (TotalAnisotropy::PUBLISHED, 21.0),
            (TotalAnisotropy::SMOOTH, 21.0),
            (TotalAnisotropy::NONE, 2e12),
        ] {
            assert!(rule.contains(&Tensor2::symmetric(contained, 0.0, 1.0)), "{rule}");
            assert!(!rule.contains(&Tensor2::symmetric(19.0, 0.0, 1.0)), "{rule}");
            assert!(rule.contains(&Tensor2::symmetric(1.0, 0.0, 0.0)), "{rule}");
        }
    }
}
