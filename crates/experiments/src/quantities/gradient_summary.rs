//! One number for a whole gradient.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::worst;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use serde::Deserialize;

/// Largest value of a gradient.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientMax {
    /// Name of the gradient run.
    run: Placed<String>,
}

impl QuantityKind for GradientMax {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let gradient = names.gradient(&self.run)?;
        measure(move |results| Ok(worst(results[gradient].volume().values().iter().copied())))
    }
}

/// Mean of a gradient, the zero border included.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientMean {
    /// Name of the gradient run.
    run: Placed<String>,
}

impl QuantityKind for GradientMean {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let gradient = names.gradient(&self.run)?;
        measure(move |results| {
            let values = results[gradient].volume().values();
            Ok(values.iter().sum::<f64>() / values.len() as f64)
        })
    }
}

/// Share of sources that reached the step limit.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientLimited {
    /// Name of the gradient run.
    run: Placed<String>,
}

impl QuantityKind for GradientLimited {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let gradient = names.gradient(&self.run)?;
        measure(move |results| {
            let outcome = &results[gradient].outcome;
            Ok(outcome.limited as f64 / outcome.work.sources.max(1) as f64)
        })
    }
}
