//! Conservation of energy.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::worst;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;

/// Largest `|energy(n) / energy(0) - 1|` over the steps.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct EnergyDrift {
    /// Name of the light run.
    run: Placed<String>,
}

impl QuantityKind for EnergyDrift {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        measure(move |results| {
            let energies = &results[light].energies;
            let start = *energies.first().filter(|e| **e > 0.0).or_undefined("the run begins in the dark")?;
            Ok(worst(energies.iter().map(|e| (e / start - 1.0).abs())))
        })
    }
}
