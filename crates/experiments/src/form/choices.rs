//! Choices that runs, figures and checks share.

use super::numbers::{Fraction, NonNegative};
use serde::Deserialize;
use tigereye_core::{Below, Field, Normalization, Tensor2};
use tigereye_lines::{Axes, Family, Major, OrderedAxes, usual_axes};
use tigereye_transport::{SharedWeights, Stopping, StoppingRule};

/// When something runs.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum Scope {
    /// In every run.
    #[default]
    Always,
    /// Only with `--full`; figures and checks that need it are left out otherwise.
    Full,
}

/// How profiles are scaled against each other.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum NormalizationRule {
    /// By their own means: nothing absorbs.
    #[default]
    Local,
    /// By the largest mean (eq. 3.11).
    Global,
    /// Locally from this fraction of the largest mean, absorbing below.
    LocalAbove(Fraction),
    /// Locally from this fraction of the largest mean, globally below.
    LocalAboveGlobal(Fraction),
}

/// Cone weights of the overlap of face and diagonal cones.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum Weights {
    /// The printed constants.
    #[default]
    Thesis,
    /// The values their formula gives for beta = atan(1/2).
    Geometric,
}

/// When a propagation ends.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Stop {
    /// Change of the total flux below a threshold (the published programme).
    FluxChange {
        /// W.
        threshold: NonNegative,
        /// At most this many steps and one.
        #[serde(default = "thousand")]
        max_iterations: usize,
    },
    /// Change of the distribution below a threshold (the text of the thesis).
    DistributionChange {
        /// W.
        threshold: NonNegative,
        /// At most this many steps and one.
        #[serde(default = "thousand")]
        max_iterations: usize,
    },
    /// Relative change of the distribution at most 1e-10: the stationary state.
    Stationary,
    /// Exactly so many steps.
    Steps(usize),
}

fn thousand() -> usize {
    1000
}

impl Default for Stop {
    fn default() -> Self {
        Self::FluxChange { threshold: NonNegative::half(), max_iterations: thousand() }
    }
}

/// Half-width K of the angular difference, in samples.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum OmegaStep {
    /// ceil(S/12), as in most published volumes.
    #[default]
    Volumes,
    /// S/16, as in the published slices.
    Slices,
    /// This many samples.
    Samples(usize),
}
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

/// By what the major axis is the larger one; by default eigenvectors by value and semi-axes by magnitude. Dual
/// eigenvectors have but one order, the longer first.
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

impl NormalizationRule {
    /// What it means for transmission profiles.
    #[must_use]
    pub const fn normalization(self) -> Normalization {
        match self {
            Self::Local => Normalization::Local,
            Self::Global => Normalization::Global,
            Self::LocalAbove(f) => Normalization::LocalAbove { fraction: f.get(), below: Below::Absorb },
            Self::LocalAboveGlobal(f) => {
                Normalization::LocalAbove { fraction: f.get(), below: Below::Global }
            }
        }
    }
}

impl Weights {
    pub(crate) const fn shared(self) -> SharedWeights {
        match self {
            Self::Thesis => SharedWeights::Thesis,
            Self::Geometric => SharedWeights::Geometric,
        }
    }
}

impl Stop {
    pub(crate) const fn stopping(self) -> Stopping {
        match self {
            Self::FluxChange { threshold, max_iterations } => {
                Stopping { rule: StoppingRule::FluxChange { threshold: threshold.get() }, max_iterations }
            }
            Self::DistributionChange { threshold, max_iterations } => Stopping {
                rule: StoppingRule::DistributionChange { threshold: threshold.get() },
                max_iterations,
            },
            Self::Stationary => Stopping::STATIONARY,
            Self::Steps(n) => Stopping::steps(n),
        }
    }
}

impl AxesChoice {
    /// The axes for a field, in the order chosen or their usual one.
    pub(crate) fn ordered(self, major: Option<MajorChoice>, field: &Field<Tensor2>) -> OrderedAxes {
        let axes = match self {
            Self::Usual => usual_axes(field),
            Self::Half => Axes::HalfAxes,
            Self::Eigen => Axes::Eigenvectors,
            Self::Dual => Axes::DualEigenvectors,
        };
        match major {
            None => axes.into(),
            Some(MajorChoice::Value) => axes.by(Major::Value),
            Some(MajorChoice::Magnitude) => axes.by(Major::Magnitude),
        }
    }
}

impl FamilyChoice {
    pub(crate) const fn family(self) -> Family {
        match self {
            Self::Major => Family::Major,
            Self::Minor => Family::Minor,
        }
    }
}
