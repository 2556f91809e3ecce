//! Tables an experiment may show.

use super::Positive;
use serde::Deserialize;

/// A table with its caption.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Heading.
    pub title: String,
    /// What is seen, in one or a few sentences.
    pub caption: String,
    /// What it shows.
    pub rows: TableRows,
}

/// What a table shows.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum TableRows {
    /// One row for each of these pulses runs: steps, evaluations, and what the stopping rule leaves out. Runs of another
    /// scope are left out.
    Pulses {
        /// Names of pulses runs.
        runs: Vec<String>,
    },
    /// Two gradients of one field, and their difference. Rows with a run of another scope are left out.
    Gradients {
        /// Heading of the first gradients.
        first: String,
        /// Heading of the second gradients.
        second: String,
        /// The rows.
        rows: Vec<GradientRow>,
    },
    /// FTLE on tensor lines beside the gradient: how far they agree. Rows with a run of another scope are left out.
    Comparison {
        /// The rows.
        rows: Vec<ComparisonRow>,
    },
    /// What noise changes of FTLE and gradient. Rows with a run of another scope are left out.
    Noise {
        /// The rows.
        rows: Vec<NoiseRow>,
    },
    /// Published runtimes beside those of this run. A row whose run is of another scope says so.
    Runtimes {
        /// The rows.
        rows: Vec<RuntimeRow>,
    },
}

/// Two gradients of one field.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientRow {
    /// What the row is called.
    pub label: String,
    /// Name of the first gradient run.
    pub first: String,
    /// Name of the second gradient run.
    pub second: String,
}

/// An FTLE and a gradient of one field.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ComparisonRow {
    /// What the row is called.
    pub label: String,
    /// Name of the FTLE run.
    pub ftle: String,
    /// Name of the gradient run.
    pub gradient: String,
}

/// FTLE and gradient of a field without and with noise.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct NoiseRow {
    /// What the row is called.
    pub label: String,
    /// Names of the FTLE runs, without and with noise.
    pub ftle: (String, String),
    /// Names of the gradient runs, without and with noise.
    pub gradient: (String, String),
}

/// A published runtime.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RuntimeRow {
    /// What the row is called.
    pub label: String,
    /// On how many cores it was measured.
    pub cores: usize,
    /// Seconds.
    pub published_s: Positive,
    /// Name of the run; left out where the data are not part of this project.
    #[serde(default)]
    pub run: Option<String>,
    /// What else is to say.
    #[serde(default)]
    pub remark: String,
}
