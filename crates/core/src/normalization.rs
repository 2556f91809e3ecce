//! The normalisation of a field's profiles, and its names.

use crate::CoreError;
use core::fmt;
use core::str::FromStr;

/// The normalisation of a field's profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Normalization {
    /// Every profile divided by the largest mean of the field (eq. 3.11): weaker cells absorb the rest.
    Global,
    /// Every profile divided by its own mean: nothing absorbs. The published synthetic results use this one.
    Local,
    /// Cells whose mean reaches `fraction` of the largest are normalised locally; noise below is treated as `below`
    /// says.
    LocalAbove {
        /// Fraction of the field's largest mean, 0 to 1.
        fraction: f64,
        /// What becomes of the weaker cells.
        below: Below,
    },
}

/// What [`Normalization::LocalAbove`] makes of the cells under its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Below {
    /// They absorb everything (the published program).
    Absorb,
    /// They keep the transmission eq. 3.11 gives them (the text of the thesis, which leaves them out of the local
    /// normalisation).
    Global,
}

/// As in options: `global`, `local`, `local-above:F` or `local-above-global:F`.
impl fmt::Display for Normalization {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Global => f.write_str("global"),
            Self::Local => f.write_str("local"),
            Self::LocalAbove { fraction, below: Below::Absorb } => write!(f, "local-above:{fraction}"),
            Self::LocalAbove { fraction, below: Below::Global } => write!(f, "local-above-global:{fraction}"),
        }
    }
}

impl FromStr for Normalization {
    type Err = CoreError;

    fn from_str(text: &str) -> Result<Self, CoreError> {
        let unknown = || CoreError::NormalizationWord { text: text.to_owned() };
        let (below, fraction) = match text.split_once(':') {
            None if text == "global" => return Ok(Self::Global),
            None if text == "local" => return Ok(Self::Local),
            Some(("local-above", fraction)) => (Below::Absorb, fraction),
            Some(("local-above-global", fraction)) => (Below::Global, fraction),
            _ => return Err(unknown()),
        };
        let fraction: f64 = fraction.parse().map_err(|_| unknown())?;
        match (0.0..=1.0).contains(&fraction) {
            true => Ok(Self::LocalAbove { fraction, below }),
            false => Err(CoreError::Fraction { fraction }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_as_they_are_written() {
        for text in ["global", "local", "local-above:0.25", "local-above-global:1"] {
            assert_eq!(text.parse::<Normalization>().expect(text).to_string(), text);
        }
        let above = Normalization::LocalAbove { fraction: 0.25, below: Below::Absorb };
        assert_eq!("local-above:0.25".parse(), Ok(above));
    }

    #[test]
    fn other_words_and_fractions_are_refused() {
        for wrong in ["", "nothing", "Local", "local-above", "local-above:", "local-above:x", "local:0.1"] {
            let fault = wrong.parse::<Normalization>().expect_err(wrong).to_string();
            assert!(fault.contains("local-above-global:F"), "{wrong}: {fault}");
        }
        for wrong in ["local-above:2", "local-above:-1", "local-above-global:nan", "local-above:inf"] {
            let fault = wrong.parse::<Normalization>().expect_err(wrong).to_string();
            assert!(fault.contains("expected 0 to 1"), "{wrong}: {fault}");
        }
    }
}
