//! Parameters of generators: names, defaults, ranges.

use core::fmt;

/// Largest number of cells along a side of a generated field.
pub const MAX_SIDE: usize = 4096;

/// One parameter of a generator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Key, as in `inverse:size=51`.
    pub name: &'static str,
    /// Default value: the number, 0 or 1 for a flag, the index for a choice.
    pub default: f64,
    /// Type and range.
    pub kind: ParameterKind,
    /// One line: meaning and unit.
    pub help: &'static str,
}

/// Type and range of a parameter. Its `Display` says what is expected: "an integer from 1 to 4096".
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterKind {
    /// A whole number, both ends included; at most 2^53 in size, so that `f64` holds it exactly.
    Integer {
        /// Smallest value.
        min: i64,
        /// Largest value.
        max: i64,
    },
    /// A finite number, both ends included.
    Real {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// Yes or no: `true`, `false`, `1` or `0`.
    Flag,
    /// One of these words.
    Choice(&'static [&'static str]),
}

impl ParameterKind {
    /// The value `text` stands for: the number, 0 or 1 for a flag, the index for a choice. `None` if it is invalid or
    /// out of range; infinities and NaN are.
    #[must_use]
    pub fn parse(&self, text: &str) -> Option<f64> {
        let number = || text.parse::<f64>().ok().filter(|v| v.is_finite());
        match *self {
            Self::Integer { min, max } => {
                number().filter(|v| v.fract() == 0.0 && (min as f64..=max as f64).contains(v))
            }
            Self::Real { min, max } => number().filter(|v| (min..=max).contains(v)),
            Self::Flag => match text {
                "true" | "1" => Some(1.0),
                "false" | "0" => Some(0.0),
                _ => None,
            },
            Self::Choice(words) => words.iter().position(|w| *w == text).map(|k| k as f64),
        }
    }

    /// A value of this kind as it would be written: the inverse of [`Self::parse`].
    #[must_use]
    pub fn format(&self, value: f64) -> String {
        match self {
            Self::Integer { .. } | Self::Real { .. } => value.to_string(),
            Self::Flag => (value != 0.0).to_string(),
            Self::Choice(words) => words.get(value as usize).copied().unwrap_or_default().to_owned(),
        }
    }
}

impl fmt::Display for ParameterKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer { min, max } => write!(f, "an integer from {min} to {max}"),
            Self::Real { min, max } => write!(f, "a number from {min} to {max}"),
            Self::Flag => f.write_str("true or false"),
            Self::Choice(words) => write!(f, "one of {}", words.join(", ")),
        }
    }
}

impl Parameter {
    /// A number.
    pub(crate) const fn real(
        name: &'static str,
        default: f64,
        min: f64,
        max: f64,
        help: &'static str,
    ) -> Self {
        Self { name, default, kind: ParameterKind::Real { min, max }, help }
    }

    /// A whole number.
    pub(crate) const fn integer(
        name: &'static str,
        default: i64,
        min: i64,
        max: i64,
        help: &'static str,
    ) -> Self {
        Self { name, default: default as f64, kind: ParameterKind::Integer { min, max }, help }
    }

    /// A flag, off by default.
    pub(crate) const fn flag(name: &'static str, help: &'static str) -> Self {
        Self { name, default: 0.0, kind: ParameterKind::Flag, help }
    }

    /// A choice, the first word by default.
    pub(crate) const fn choice(
        name: &'static str,
        words: &'static [&'static str],
        help: &'static str,
    ) -> Self {
        Self { name, default: 0.0, kind: ParameterKind::Choice(words), help }
    }

    /// The default as it would be written.
    #[must_use]
    pub fn default_text(&self) -> String {
        self.kind.format(self.default)
    }
}

/// `size`, `width` and `height`, which every generator has. Without `width` or `height` that side has `size` cells.
pub(crate) const SIZES: [Parameter; 3] = [
    Parameter::integer("size", 51, 1, MAX_SIDE as i64, "cells along both sides"),
    Parameter::integer("width", 51, 1, MAX_SIDE as i64, "columns; as many as size where not given"),
    Parameter::integer("height", 51, 1, MAX_SIDE as i64, "rows; as many as size where not given"),
];

/// Ratio of the axes, major to minor, of the fields with determinant 1.
pub(crate) const ANISOTROPY: Parameter = anisotropy(10);

/// [`ANISOTROPY`] with another default.
pub(crate) const fn anisotropy(default: i64) -> Parameter {
    Parameter::real("anisotropy", default as f64, 1.0, 1e6, "ratio of the major to the minor axis")
}
