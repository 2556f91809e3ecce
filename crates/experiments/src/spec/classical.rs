//! What the classical methods of an experiment may be told.

use super::{Finite, NonNegative};
use serde::Deserialize;

/// The axes that lines follow.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum AxesChoice {
    /// Eigenvectors where the field is symmetric, semi-axes otherwise.
    #[default]
    Usual,
    /// Semi-axes of the ellipse: what light sees.
    Half,
    /// Eigenvectors; pseudo-eigenvectors where eigenvalues are complex.
    Eigen,
    /// Dual eigenvectors.
    Dual,
}

/// By what the major axis is the larger one; by default eigenvectors by value and semi-axes by magnitude. Dual eigenvectors have but one
/// order, the longer first.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum MajorChoice {
    /// By the value with its sign: tension before compression.
    Value,
    /// By the size of the value: the longer one.
    Magnitude,
}

/// Which of the two axes.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum FamilyChoice {
    /// The larger one, in the sense of [`MajorChoice`].
    #[default]
    Major,
    /// The other one.
    Minor,
}

/// A scalar over the cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum MapSource {
    /// FTLE on tensor lines, at the cells.
    Ftle {
        /// Name of the FTLE run.
        run: String,
    },
    /// One direction of a gradient.
    Slice {
        /// Name of the gradient run.
        run: String,
        /// Direction, degrees.
        deg: Finite,
    },
    /// Mean of a gradient over its directions.
    Mean {
        /// Name of the gradient run.
        run: String,
    },
    /// Maximum of a gradient over its directions.
    Maximum {
        /// Name of the gradient run.
        run: String,
    },
}

impl MapSource {
    /// The name of the run.
    #[must_use]
    pub fn run(&self) -> &str {
        match self {
            Self::Ftle { run } | Self::Slice { run, .. } | Self::Mean { run } | Self::Maximum { run } => run,
        }
    }
}

/// Height ridges of scalars over the cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum RidgeSource {
    /// Those of one scalar.
    Of(MapSource),
    /// Those of every direction of a gradient, together.
    EverySlice {
        /// Name of the gradient run.
        run: String,
    },
}

impl RidgeSource {
    /// The name of the run.
    #[must_use]
    pub fn run(&self) -> &str {
        match self {
            Self::Of(map) => map.run(),
            Self::EverySlice { run } => run,
        }
    }
}

/// A number of the distances of one set of ridges from another, over the length of the first.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub enum DistanceNumber {
    /// Mean distance, cells.
    Mean,
    /// The distance below which 95 % lie, cells.
    Most,
    /// Share within so many cells.
    ShareWithin(NonNegative),
}
