//! The contents of an experiment file.

use crate::form::{FieldSource, Finite, Named, NonNegative, Placed, Positive, Scope, StyleSource};
use crate::panels::Panel;
use crate::quantities::Quantity;
use crate::runs::Run;
use crate::tables::TableRows;
use serde::Deserialize;
use std::num::NonZeroUsize;
use tigereye_report::Expected;

/// One experiment file.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// Version of the format, 1.
    pub(crate) format: Placed<u32>,
    /// Heading.
    pub(crate) title: String,
    /// What it reproduces, for example `Thesis, Fig. 4.8`.
    pub(crate) source: String,
    /// Section of the gallery; sections are sorted.
    pub(crate) section: String,
    /// The sentence that the figures support or examine.
    pub(crate) claim: String,
    /// What to look for, for readers who do not know the source.
    pub(crate) look_for: String,
    /// When the whole experiment runs.
    #[serde(default)]
    pub(crate) scope: Scope,
    /// Data files that are not part of the project; if one is missing, the experiment is skipped with a message.
    #[serde(default)]
    pub needs: Vec<String>,
    /// Tensor fields by name.
    #[serde(default)]
    pub(crate) fields: Named<FieldSource>,
    /// Scenes by name, each in a file `NAME.scene.ron` beside this one. Light runs accept them in place of fields.
    #[serde(default)]
    pub(crate) scenes: Named<Placed<String>>,
    /// Propagations, gradients, pulse studies and FTLE fields by name, in order.
    #[serde(default)]
    pub(crate) runs: Named<Run>,
    /// Runs whose results are not written to files, because only numbers of them are of interest.
    #[serde(default)]
    pub(crate) without_data: Vec<Placed<String>>,
    /// Pictures.
    pub(crate) figures: Vec<Figure>,
    /// Tables of results.
    #[serde(default)]
    pub(crate) tables: Vec<Table>,
    /// Statements that must hold.
    pub(crate) checks: Vec<Check>,
}

impl Experiment {
    /// Its heading.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// What it reproduces, or where its data comes from.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }
}

/// A picture with its caption.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// File name without extension.
    pub(crate) name: Placed<String>,
    /// What it shows, in one or two sentences.
    pub(crate) caption: String,
    /// Panels side by side; panels whose runs are not in scope are omitted.
    pub(crate) panels: Vec<Panel>,
    /// Panels per row.
    #[serde(default = "three")]
    pub(crate) columns: usize,
    /// How its panels look, where they do not say it themselves.
    #[serde(default)]
    pub(crate) style: Option<Placed<StyleSource>>,
    /// The steps of a light run, animated beside the picture.
    #[serde(default)]
    pub(crate) animation: Option<Animation>,
}

/// Energies after the steps of a light run on a common scale, as an animated PNG named after the figure.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Animation {
    /// Name of the light run.
    pub(crate) run: Placed<String>,
    /// Steps per frame; increased if there would be too many frames.
    #[serde(default = "one")]
    pub(crate) every: NonZeroUsize,
    /// Decades shown below the brightest cell that is not a light.
    #[serde(default)]
    pub(crate) decades: Option<Positive>,
}

const fn one() -> NonZeroUsize {
    NonZeroUsize::MIN
}

const fn three() -> usize {
    3
}

/// A table with its caption.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Heading.
    pub(crate) title: String,
    /// What it shows, in one or a few sentences.
    pub(crate) caption: String,
    /// What it shows.
    pub(crate) rows: TableRows,
}

/// A statement about a number in the results.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// The statement in words.
    pub(crate) name: String,
    /// The number.
    pub(crate) quantity: Quantity,
    /// The expected value.
    pub(crate) expect: Expectation,
    /// The reason for the expectation.
    pub(crate) basis: String,
}

/// The expected value of a number.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub enum Expectation {
    /// The first number, give or take the second (same unit).
    Near(Finite, NonNegative),
    /// The first number, give or take the second times its magnitude.
    NearRelative(Finite, NonNegative),
    /// At most this.
    AtMost(Finite),
    /// At least this.
    AtLeast(Finite),
}

impl Expectation {
    /// As the report has it.
    pub(crate) fn expected(self) -> Expected {
        match self {
            Self::Near(v, t) => Expected::Near { value: v.get(), tolerance: t.get() },
            Self::NearRelative(v, t) => Expected::Near { value: v.get(), tolerance: t.get() * v.get().abs() },
            Self::AtMost(v) => Expected::AtMost(v.get()),
            Self::AtLeast(v) => Expected::AtLeast(v.get()),
        }
    }
}
