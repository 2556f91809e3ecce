//! Energies of cells over each other.

use crate::form::Placed;
use crate::names::Names;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use serde::Deserialize;

/// Energy of a cell relative to that of another.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct EnergyRatio {
    /// Name of the light run.
    run: Placed<String>,
    /// Column and row.
    cell: Placed<(usize, usize)>,
    /// Column and row.
    over: Placed<(usize, usize)>,
}

impl QuantityKind for EnergyRatio {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        let cell = names.cell_of(light.0, &self.cell)?;
        let over = names.cell_of(light.0, &self.over)?;
        measure(move |results| {
            let energy = results[light].last.energy();
            Ok(energy.at(cell) / energy.at(over))
        })
    }
}

/// Energy of a cell relative to that in another run.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct EnergyOver {
    /// Name of the light run.
    run: Placed<String>,
    /// Name of the light run it is divided by.
    over: Placed<String>,
    /// Column and row.
    cell: Placed<(usize, usize)>,
}

impl QuantityKind for EnergyOver {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        let over = names.light(&self.over)?;
        let cell = names.cell_of(light.0, &self.cell)?;
        names.cell_of(over.0, &self.cell)?;
        measure(move |results| {
            let energy = |id: crate::ids::LightId| *results[id].last.energy().at(cell);
            Ok(energy(light) / energy(over))
        })
    }
}
