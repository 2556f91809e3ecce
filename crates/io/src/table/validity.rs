//! Columns that say which points of a table hold no measurement.

use crate::volume::HIDDEN_POINT;

/// What a column says of the points beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Validity {
    /// Values that were replaced or doubted; they stay.
    Flags,
    /// Left out where not 0.
    Mask,
    /// Left out below 1.
    Valid,
    /// VTK's flags of points: left out where hidden.
    Ghost,
}

impl Validity {
    /// What a column says by its name, in any case and with its unit: `isValid`, `CHC`, `Vector type [-]`, `mask`.
    pub(super) fn of(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let mut words = name.split([' ', '[', '(', '"']).filter(|w| !w.is_empty());
        let first = words.next()?;
        // `vector type [-]` says what a vector is; `vector direction [degrees]` and the like say nothing of it.
        let word = match (first, words.next()) {
            ("vector", None | Some("type")) => "vector",
            ("vector", Some(_)) => return None,
            ("is", Some(second)) => second,
            _ => first,
        };
        match word.replace(['_', ':', '-', '.'], "").as_str() {
            "flags" | "flag" => Some(Self::Flags),
            "mask" => Some(Self::Mask),
            "chc" | "vector" | "vectortype" | "isvalid" | "valid" | "validity" | "vtkvalidpointmask" => {
                Some(Self::Valid)
            }
            "vtkghosttype" => Some(Self::Ghost),
            _ => None,
        }
    }

    /// Whether a point with this value holds no measurement.
    pub(super) fn leaves_out(self, value: f64) -> bool {
        match self {
            Self::Flags => false,
            Self::Mask => value != 0.0,
            Self::Valid => value.is_nan() || value < 1.0,
            Self::Ghost => value as u8 & HIDDEN_POINT != 0,
        }
    }

    /// The column and its convention.
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Flags => "flags",
            Self::Mask => "mask (left out where not 0)",
            Self::Valid => "validity (left out below 1)",
            Self::Ghost => "flags of VTK (left out where hidden)",
        }
    }

    /// The message about a column of this name whose `values` leave out or flag points; `what` names the points.
    pub(super) fn said(self, name: &str, values: &[f64], what: &str) -> Option<String> {
        let all = values.len();
        let (convention, count) = match self {
            Self::Flags => {
                let flagged = values.iter().filter(|v| **v != 0.0).count();
                return (flagged > 0)
                    .then(|| format!("{flagged} {what} with a flag other than 0, taken as they stand"));
            }
            Self::Mask => ("is not 0", self.count(values)),
            Self::Valid => ("is below 1", self.count(values)),
            Self::Ghost => ("marks hidden points", self.count(values)),
        };
        (count > 0).then(|| {
            format!("{count} of {all} {what} left out by the column `{name}`, where it {convention}")
        })
    }

    fn count(self, values: &[f64]) -> usize {
        values.iter().filter(|v| self.leaves_out(**v)).count()
    }
}

/// A value of such a column: a number, or `true`, `false`, `yes` and `no` in any case, possibly in quotes.
pub(super) fn parsed_validity(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?.trim_matches('"').to_ascii_lowercase();
    match text.as_str() {
        "true" | "yes" => Some(1.0),
        "false" | "no" => Some(0.0),
        _ => super::text::parsed(word),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_known_by_name() {
        for (name, expected) in [
            ("isValid", Some(Validity::Valid)),
            ("is_valid", Some(Validity::Valid)),
            ("Is Valid", Some(Validity::Valid)),
            ("CHC", Some(Validity::Valid)),
            ("Vector type [-]", Some(Validity::Valid)),
            ("vector direction [degrees]", None),
            ("Mask (0 or 1)", Some(Validity::Mask)),
            ("flags", Some(Validity::Flags)),
            ("vtkValidPointMask", Some(Validity::Valid)),
            ("\"vtkGhostType\"", Some(Validity::Ghost)),
            ("Status", None),
            ("S11", None),
            ("", None),
        ] {
            assert_eq!(Validity::of(name), expected, "{name}");
        }
    }

    #[test]
    fn words_and_numbers_are_values() {
        for (word, value) in [("True", 1.0), ("\"false\"", 0.0), ("YES", 1.0), ("no", 0.0), ("-2", -2.0)] {
            assert_eq!(parsed_validity(word.as_bytes()), Some(value), "{word}");
        }
        assert_eq!(parsed_validity(b"good"), None);
        let out = |validity: Validity| [0.0, 1.0, 4.0, -2.0, f64::NAN].map(|v| validity.leaves_out(v));
        assert_eq!(out(Validity::Mask), [false, true, true, true, true]);
        assert_eq!(out(Validity::Valid), [true, false, false, true, true]);
        assert_eq!(out(Validity::Flags), [false; 5]);
        let hidden = [0.0, 1.0, 2.0, 3.0, f64::NAN].map(|v| Validity::Ghost.leaves_out(v));
        assert_eq!(hidden, [false, false, true, true, false], "duplicates are data");
    }
}
