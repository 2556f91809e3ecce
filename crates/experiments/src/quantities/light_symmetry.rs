//! Symmetry of light.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::mirror::Mirror;
use crate::numerics::worst;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;
use tigereye_core::Cell;

/// Largest difference of energies under a symmetry, relative to the largest energy.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct LightSymmetry {
    /// Name of the light run.
    run: Placed<String>,
    /// Symmetry.
    under: Mirror,
}

impl QuantityKind for LightSymmetry {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        let under = self.under;
        measure(move |results| {
            let energy = results[light].last.energy();
            let grid = energy.grid();
            let largest = energy.values().iter().fold(0.0, |m: f64, &e| m.max(e));
            let error = |(cell, e): (Cell, &f64)| Some((e - energy.at(under.cell(grid, cell)?)).abs());
            let errors = energy.iter().map(error).collect::<Option<Vec<f64>>>();
            let errors = errors.or_undefined("only a square has quarter turns")?;
            (largest > 0.0).then(|| worst(errors) / largest).or_undefined("there is no light")
        })
    }
}
