//! What an experiment leaves: figures, checks, counters. The report and the summary are made of these.

use serde::{Deserialize, Serialize};

use crate::json::{not_a_number, nullable};
use crate::numbers::plain;

/// Everything one experiment produced.
#[derive(Clone, Debug, PartialEq)]
pub struct ExperimentOutcome {
    /// Name of the experiment: its file without folder and extension.
    pub slug: String,
    /// Heading.
    pub title: String,
    /// What it reproduces, for example `Thesis, Fig. 4.8`.
    pub source: String,
    /// Section of the gallery, for example `4.5 Light transport gradient`. Sections are shown in ascending order.
    pub section: String,
    /// The sentence of the source that the figures support, or the claim examined.
    pub claim: String,
    /// What to look for in the figures, for someone who has not read the source.
    pub look_for: String,
    /// Figures in the order of the file.
    pub figures: Vec<Figure>,
    /// Tables in the order of the file.
    pub tables: Vec<Table>,
    /// Checks in the order of the file.
    pub checks: Vec<CheckOutcome>,
    /// Work done, as (label, number) in the order of the runs.
    pub work: Vec<(String, u64)>,
    /// Data files beside the figures.
    pub data: Vec<DataFile>,
    /// Wall-clock seconds; not part of any snapshot.
    pub seconds: f64,
    /// The command that redoes exactly this experiment.
    pub command: String,
}

impl ExperimentOutcome {
    /// Whether every check passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.checks.iter().all(|c| c.passed)
    }
}

/// A picture in both formats.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// File name without extension, unique in the experiment.
    pub name: String,
    /// What is seen, in one or two sentences under the picture.
    pub caption: String,
    /// Alternative text for those who cannot see it.
    pub alt: String,
    /// Width at scale 1, pixels.
    pub width_px: f64,
    /// Height at scale 1, pixels.
    pub height_px: f64,
    /// Whether it draws seconds, which are others in every run.
    pub timed: bool,
    /// Frames of the animation beside it, `NAME.apng` among the data; 0 for none.
    pub frames: usize,
    /// Where its panels are; empty for a single one.
    pub panels: Vec<PanelPlace>,
    /// The picture as PNG.
    pub png: Vec<u8>,
    /// The picture as SVG.
    pub svg: String,
}

/// A panel of a picture: where it is, pixels at scale 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PanelPlace {
    /// Left edge.
    pub x_px: f64,
    /// Upper edge.
    pub y_px: f64,
    /// Width.
    pub width_px: f64,
    /// Height.
    pub height_px: f64,
    /// Alternative text.
    pub alt: String,
}

/// A table of results for readers; what is compared with expectations stands in the checks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Heading.
    pub title: String,
    /// What is seen, in a few sentences.
    pub caption: String,
    /// The columns, that of the rows' names first.
    pub columns: Vec<Column>,
    /// Rows: the name and an entry for each further column.
    pub rows: Vec<(String, Vec<String>)>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Heading, with the unit.
    pub heading: String,
    /// Whether it holds words; numbers otherwise.
    pub words: bool,
}

/// A file of data.
#[derive(Clone, Debug, PartialEq)]
pub struct DataFile {
    /// File name with extension, unique in the experiment.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// A check after its run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "CheckForm", into = "CheckForm")]
pub struct CheckOutcome {
    /// What is checked.
    pub name: String,
    /// The value of this run.
    pub value: f64,
    /// What was expected.
    pub expected: Expected,
    /// Where the expectation comes from: the thesis, the method, geometry, an independent run.
    pub basis: String,
    /// Whether the value meets the expectation.
    pub passed: bool,
    /// Why there is no value, where it could not be measured.
    pub reason: Option<String>,
}

/// An expectation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// This value, give or take `tolerance` (same unit).
    Near {
        /// Value expected.
        value: f64,
        /// Largest absolute deviation accepted.
        tolerance: f64,
    },
    /// At most this.
    AtMost(f64),
    /// At least this.
    AtLeast(f64),
}

impl Expected {
    /// Whether `value` meets it; a value that is not a number never does.
    #[must_use]
    pub fn is_met_by(&self, value: f64) -> bool {
        match *self {
            Self::Near { value: expected, tolerance } => (value - expected).abs() <= tolerance,
            Self::AtMost(bound) => value <= bound,
            Self::AtLeast(bound) => value >= bound,
        }
    }
}

/// A check as it stands in a summary.
#[derive(Serialize, Deserialize)]
struct CheckForm {
    name: String,
    #[serde(deserialize_with = "nullable")]
    value: f64,
    #[serde(default = "not_a_number", deserialize_with = "nullable")]
    expected: f64,
    #[serde(default)]
    tolerance: f64,
    passed: bool,
    #[serde(default)]
    kind: ExpectedKind,
    #[serde(default)]
    basis: String,
    /// Why there is no value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
enum ExpectedKind {
    #[default]
    #[serde(rename = "near")]
    Near,
    #[serde(rename = "at most")]
    AtMost,
    #[serde(rename = "at least")]
    AtLeast,
}

impl From<CheckOutcome> for CheckForm {
    fn from(check: CheckOutcome) -> Self {
        let (kind, expected, tolerance) = match check.expected {
            Expected::Near { value, tolerance } => (ExpectedKind::Near, value, tolerance),
            Expected::AtMost(bound) => (ExpectedKind::AtMost, bound, 0.0),
            Expected::AtLeast(bound) => (ExpectedKind::AtLeast, bound, 0.0),
        };
        let CheckOutcome { name, value, passed, basis, reason, .. } = check;
        Self { name, value, expected, tolerance, passed, kind, basis, reason }
    }
}

impl From<CheckForm> for CheckOutcome {
    fn from(form: CheckForm) -> Self {
        let CheckForm { name, value, expected, tolerance, passed, kind, basis, reason } = form;
        let expected = match kind {
            ExpectedKind::Near => Expected::Near { value: expected, tolerance },
            ExpectedKind::AtMost => Expected::AtMost(expected),
            ExpectedKind::AtLeast => Expected::AtLeast(expected),
        };
        Self { name, value, expected, basis, passed, reason }
    }
}

impl CheckOutcome {
    /// How far the value is outside of what is accepted; none if it lies inside or is not a number.
    #[must_use]
    pub fn excess(&self) -> Option<f64> {
        let beyond = match self.expected {
            Expected::Near { value, tolerance } => (self.value - value).abs() - tolerance,
            Expected::AtMost(bound) => self.value - bound,
            Expected::AtLeast(bound) => bound - self.value,
        };
        (beyond > 0.0).then_some(beyond)
    }
}

impl Expected {
    /// For readers of plain text: six significant digits.
    #[must_use]
    pub fn words(&self) -> String {
        match *self {
            Self::Near { value, tolerance: 0.0 } => format!("exactly {}", plain(value)),
            Self::Near { value, tolerance } => format!("{} ± {}", plain(value), plain(tolerance)),
            Self::AtMost(bound) => format!("at most {}", plain(bound)),
            Self::AtLeast(bound) => format!("at least {}", plain(bound)),
        }
    }
}

/// With all digits, as snapshots have it.
impl std::fmt::Display for Expected {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::Near { value, tolerance } => write!(f, "{value} +- {tolerance}"),
            Self::AtMost(bound) => write!(f, "at most {bound}"),
            Self::AtLeast(bound) => write!(f, "at least {bound}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checks_can_fail() {
        let near = Expected::Near { value: 1.0, tolerance: 0.1 };
        assert!(near.is_met_by(1.05) && !near.is_met_by(1.2) && !near.is_met_by(f64::NAN));
        assert!(Expected::AtMost(1.0).is_met_by(1.0) && !Expected::AtMost(1.0).is_met_by(f64::NAN));
        assert!(Expected::AtLeast(1.0).is_met_by(2.0) && !Expected::AtLeast(1.0).is_met_by(0.5));
    }

    #[test]
    fn expectations_are_readable() {
        assert_eq!(Expected::AtMost(1e-13).words(), "at most 1e-13");
        let value = 425.514_550_643_004_2;
        let near = Expected::Near { value, tolerance: value * 1e-11 };
        assert_eq!(near.words(), "425.515 ± 4.25515e-9");
        assert_eq!(Expected::Near { value: 3.0, tolerance: 0.0 }.words(), "exactly 3");
    }
}
