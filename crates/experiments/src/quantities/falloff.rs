//! How light falls off with the distance.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::light::{lobe_ratio, net_flux_ratio};
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::runs::light::Outcome;
use crate::unavailable::{OrUndefined, Unavailable};
use serde::Deserialize;
use tigereye_core::{Cell, LightDistribution};

/// Net outward flux right of the light at a distance, relative to distance 1.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct NetFluxRatio {
    /// Name of the light run.
    run: Placed<String>,
    /// Distance, cells.
    distance: usize,
}

impl QuantityKind for NetFluxRatio {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        let distance = self.distance;
        measure(move |results| at_distance(&results[light], distance, net_flux_ratio))
    }
}

/// Outward lobe right of the light at a distance, relative to distance 1.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct LobeRatio {
    /// Name of the light run.
    run: Placed<String>,
    /// Distance, cells.
    distance: usize,
}

impl QuantityKind for LobeRatio {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        let distance = self.distance;
        measure(move |results| at_distance(&results[light], distance, lobe_ratio))
    }
}

fn at_distance(
    light: &Outcome,
    distance: usize,
    ratio: fn(&LightDistribution, Cell, usize) -> Option<f64>,
) -> Result<f64, Unavailable> {
    let source = *light.sources.first().or_undefined("the run has no light")?;
    ratio(&light.last, source, distance).or_undefined("that far right of the light there is no cell")
}
