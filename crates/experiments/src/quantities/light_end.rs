//! How a run of light ends.

use crate::form::Placed;
use crate::names::Names;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use serde::Deserialize;
use tigereye_core::StopReason;

/// Steps of a light run.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Steps {
    /// Name of the light run.
    run: Placed<String>,
}

impl QuantityKind for Steps {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        measure(move |results| Ok(results[light].work.steps as f64))
    }
}

/// 1 if a light run met its stopping rule, 0 if it reached the step limit.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Stopped {
    /// Name of the light run.
    run: Placed<String>,
}

impl QuantityKind for Stopped {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        measure(move |results| Ok(f64::from(results[light].stop == StopReason::Converged)))
    }
}

/// Energy in the grid at the end, W.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct TotalEnergy {
    /// Name of the light run.
    run: Placed<String>,
}

impl QuantityKind for TotalEnergy {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        measure(move |results| Ok(results[light].last.total_energy()))
    }
}
