//! Distance of the energy from the centre.

use crate::form::Placed;
use crate::names::Names;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::runs::light::Outcome;
use crate::unavailable::Unavailable;
use serde::Deserialize;

/// Mean distance of the energy from the centre after a step, cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RadiusMean {
    /// Name of the light run.
    run: Placed<String>,
    /// Step.
    step: Placed<usize>,
}

impl QuantityKind for RadiusMean {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light_with_radii(&self.run)?;
        names.step(light, &self.step)?;
        let step = *self.step;
        measure(move |results| Ok(radius_at(&results[light], step)?.0))
    }
}

/// Standard deviation of the energy's distance from the centre after a step, cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RadiusSpread {
    /// Name of the light run.
    run: Placed<String>,
    /// Step.
    step: Placed<usize>,
}

impl QuantityKind for RadiusSpread {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light_with_radii(&self.run)?;
        names.step(light, &self.step)?;
        let step = *self.step;
        measure(move |results| Ok(radius_at(&results[light], step)?.1))
    }
}

fn radius_at(light: &Outcome, wanted: usize) -> Result<(f64, f64), Unavailable> {
    let steps = light.work.steps;
    light.radii.get(wanted).copied().ok_or(Unavailable::BeforeStep { wanted, steps })
}
