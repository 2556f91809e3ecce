//! Choices that runs, figures and checks share.

use super::numbers::{Fraction, NonNegative, Ratio};
use serde::Deserialize;
use tigereye_core::{Below, Normalization, TotalAnisotropy};
use tigereye_transport::{ScatteringRule, Stopping, StoppingRule};

/// When something runs.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum Scope {
    /// In every run.
    #[default]
    Always,
    /// Only with `--full`; figures and checks that need it are omitted otherwise.
    Full,
}

/// How profiles are scaled against each other.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum NormalizationRule {
    /// Each by its own mean: nothing absorbs.
    #[default]
    Local,
    /// All by the largest mean (eq. 3.11).
    Global,
    /// Locally from this fraction of the largest mean upwards; weaker cells absorb.
    LocalAbove(Fraction),
    /// Locally from this fraction of the largest mean upwards; weaker cells globally.
    LocalAboveGlobal(Fraction),
}

/// Which tensors transmit along one axis only.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum TotalAnisotropyRule {
    /// Those whose semi-axes have a ratio above 20 (the published program).
    #[default]
    Published,
    /// Those above this ratio.
    Above(Ratio),
    /// A gradual change from half to twice the published ratio.
    Smooth,
    /// A gradual change.
    Blend {
        /// The ratio of the semi-axes at which half of a profile is a pulse.
        ratio: Ratio,
        /// The profile is an ellipse up to `ratio / width`, and a pulse from `ratio * width` on.
        width: Ratio,
    },
    /// None: beyond this ratio a tensor has the ellipse of the ratio.
    Cap(Ratio),
    /// Only those with a vanishing axis.
    Never,
}

/// When a propagation ends.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Stop {
    /// The published program's rule (`FluxChange` with threshold 0.5) for joint scattering, the stationary state for
    /// linear.
    #[default]
    Usual,
    /// Change of the total flux below a threshold (the published program).
    FluxChange {
        /// W.
        threshold: NonNegative,
        /// At most one step more than this.
        #[serde(default = "thousand")]
        max_iterations: usize,
    },
    /// Change of the distribution below a threshold (the text of the thesis).
    DistributionChange {
        /// W.
        threshold: NonNegative,
        /// At most one step more than this.
        #[serde(default = "thousand")]
        max_iterations: usize,
    },
    /// Relative change of the distribution at most 1e-10: the stationary state.
    Stationary,
    /// Exactly this many steps.
    Steps(usize),
}

fn thousand() -> usize {
    1000
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

impl TotalAnisotropyRule {
    /// What it means for transmission profiles, or why it cannot be.
    pub(crate) fn rule(self) -> Result<TotalAnisotropy, String> {
        let made = match self {
            Self::Published => return Ok(TotalAnisotropy::PUBLISHED),
            Self::Smooth => return Ok(TotalAnisotropy::SMOOTH),
            Self::Never => return Ok(TotalAnisotropy::NONE),
            Self::Cap(ratio) => TotalAnisotropy::capped(ratio.get()),
            Self::Above(ratio) => TotalAnisotropy::new(ratio.get(), 1.0),
            Self::Blend { ratio, width } => TotalAnisotropy::new(ratio.get(), width.get()),
        };
        made.map_err(|e| e.to_string())
    }
}

impl Stop {
    pub(crate) const fn stopping(self, scattering: ScatteringRule) -> Stopping {
        match self {
            Self::Usual => match scattering {
                ScatteringRule::Joint => Stopping::REFERENCE,
                ScatteringRule::Linear => Stopping::STATIONARY,
            },
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
