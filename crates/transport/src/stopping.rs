//! When a propagation ends.

use crate::TransportError;
use tigereye_core::{Choice, choice};

/// A rule and a limit. The rule is asked after every step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopping {
    /// What is compared.
    pub rule: StoppingRule,
    /// The published program's `ctrLimit`: a propagation makes at most `max_iterations + 1` steps.
    pub max_iterations: usize,
}

/// What a propagation waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoppingRule {
    /// `|Phi_total(n) - Phi_total(n-1)| < threshold` (W), with `Phi_total(0) = 0`. The published volumes use it with
    /// 0.5, which is loose next to the 2 pi injected per step: such results depend on the threshold. 0 never stops.
    FluxChange {
        /// Threshold in W.
        threshold: f64,
    },
    /// `sum_cells h sum_t |I_n - I_(n-1)| < threshold` (W): the criterion in the text of the thesis (section 3.2).
    DistributionChange {
        /// Threshold in W.
        threshold: f64,
    },
    /// The same sum divided by the energy in the grid: the stationary state, free of the threshold.
    Converged {
        /// Relative tolerance.
        tolerance: f64,
    },
    /// Exactly this many steps.
    Steps(usize),
}

/// The quantity that ends a propagation, by its name in options.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StopMeasure {
    /// See [`StoppingRule::FluxChange`].
    #[default]
    Flux,
    /// See [`StoppingRule::DistributionChange`].
    Distribution,
    /// See [`StoppingRule::Converged`].
    Stationary,
}

choice!(StopMeasure {
    Flux = "flux": "Change of the total transported flux between two steps, W.",
    Distribution = "distribution": "Sum of the changes of all profiles, W.",
    Stationary = "stationary":
        "That sum at most 1e-10 of the energy, regardless of threshold and iteration limit.",
});

impl StopMeasure {
    /// The rule for this measure; the stationary state ignores both arguments.
    #[must_use]
    pub const fn stopping(self, threshold: f64, max_iterations: usize) -> Stopping {
        let rule = match self {
            Self::Flux => StoppingRule::FluxChange { threshold },
            Self::Distribution => StoppingRule::DistributionChange { threshold },
            Self::Stationary => return Stopping::STATIONARY,
        };
        Stopping { rule, max_iterations }
    }
}

impl StoppingRule {
    /// Its name for provenance: that of its measure, or `steps`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::FluxChange { .. } => StopMeasure::Flux.word(),
            Self::DistributionChange { .. } => StopMeasure::Distribution.word(),
            Self::Converged { .. } => StopMeasure::Stationary.word(),
            Self::Steps(_) => "steps",
        }
    }

    /// Threshold in W, or the relative tolerance; 0 for a number of steps.
    #[must_use]
    pub const fn threshold(&self) -> f64 {
        match *self {
            Self::FluxChange { threshold } | Self::DistributionChange { threshold } => threshold,
            Self::Converged { tolerance } => tolerance,
            Self::Steps(_) => 0.0,
        }
    }
}

impl Stopping {
    /// The published program's rule: threshold 0.5 on the flux change, at most 1001 steps.
    pub const REFERENCE: Self =
        Self { rule: StoppingRule::FluxChange { threshold: 0.5 }, max_iterations: 1000 };
    /// The stationary state to ten digits.
    pub const STATIONARY: Self =
        Self { rule: StoppingRule::Converged { tolerance: 1e-10 }, max_iterations: 1_000_000 };

    /// Exactly `n` steps.
    #[must_use]
    pub const fn steps(n: usize) -> Self {
        Self { rule: StoppingRule::Steps(n), max_iterations: n }
    }

    /// Checks the threshold.
    ///
    /// # Errors
    /// [`TransportError::Threshold`] where it is negative or not finite.
    pub fn check(&self) -> Result<(), TransportError> {
        let threshold = self.rule.threshold();
        if threshold >= 0.0 && threshold.is_finite() {
            Ok(())
        } else {
            Err(TransportError::Threshold { threshold })
        }
    }

    /// Whether the rule looks at the change of the distribution.
    pub(crate) const fn needs_distribution_change(&self) -> bool {
        matches!(self.rule, StoppingRule::DistributionChange { .. } | StoppingRule::Converged { .. })
    }
}

/// What a stopping rule sees of step `n`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct StepMeasures {
    /// Number of the step, from 1.
    pub(crate) step: usize,
    /// Total flux of this step and of the one before, W.
    pub(crate) total_flux: f64,
    pub(crate) previous_total_flux: f64,
    /// L1 change of the distribution, W; only where the rule needs it.
    pub(crate) distribution_change: f64,
    /// Energy in the grid, W; only where the rule needs it.
    pub(crate) energy: f64,
}

/// What to do after a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Continue,
    Converged,
    StepLimit,
}

impl Stopping {
    pub(crate) fn verdict(&self, m: &StepMeasures) -> Verdict {
        let met = match self.rule {
            StoppingRule::FluxChange { threshold } => {
                (m.total_flux - m.previous_total_flux).abs() < threshold
            }
            StoppingRule::DistributionChange { threshold } => m.distribution_change < threshold,
            // A dark grid is stationary.
            StoppingRule::Converged { tolerance } => m.distribution_change <= tolerance * m.energy,
            StoppingRule::Steps(n) => {
                return if m.step >= n { Verdict::StepLimit } else { Verdict::Continue };
            }
        };
        if met {
            Verdict::Converged
        } else if m.step > self.max_iterations {
            Verdict::StepLimit
        } else {
            Verdict::Continue
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limit_admits_one_step_more_than_its_number() {
        let stopping = Stopping { rule: StoppingRule::FluxChange { threshold: 0.0 }, max_iterations: 2 };
        let at = |step| stopping.verdict(&StepMeasures { step, ..StepMeasures::default() });
        assert_eq!([1, 2, 3].map(at), [Verdict::Continue, Verdict::Continue, Verdict::StepLimit]);
    }

    #[test]
    fn threshold_is_strict_and_compares_with_the_step_before() {
        let stopping = Stopping { rule: StoppingRule::FluxChange { threshold: 0.5 }, max_iterations: 10 };
        let with = |total_flux, previous_total_flux| {
            stopping.verdict(&StepMeasures { step: 1, total_flux, previous_total_flux, ..Default::default() })
        };
        assert_eq!(with(1.0, 0.5), Verdict::Continue);
        assert_eq!(with(1.0, 1.25), Verdict::Converged);
    }

    #[test]
    fn impossible_thresholds_are_refused() {
        for threshold in [-0.1, f64::NAN, f64::INFINITY] {
            let s = Stopping { rule: StoppingRule::FluxChange { threshold }, max_iterations: 1 };
            assert!(s.check().is_err());
        }
        assert!(Stopping::REFERENCE.check().is_ok() && Stopping::STATIONARY.check().is_ok());
    }
}
