//! Differences of light.

use crate::form::Placed;
use crate::names::Names;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;

/// L2 difference of two light runs relative to the L2 norm of the first.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct LightDifference {
    /// Name of a light run.
    run: Placed<String>,
    /// Name of the other run.
    from: Placed<String>,
}

impl QuantityKind for LightDifference {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (light, from) = (names.light(&self.run)?, names.light(&self.from)?);
        let of = |id: crate::ids::LightId| Some((names.grid(id.0)?, names.directions(id.0)?));
        if of(light)? != of(from)? {
            let problem = format!("\"{}\" and \"{}\" differ in cells or directions", self.run, self.from);
            names.fault(self.from.place(), &problem);
            return None;
        }
        measure(move |results| {
            let (a, b) = (results[light].last.samples(), results[from].last.samples());
            let square = |x: f64| x * x;
            let off: f64 = a.iter().zip(b).map(|(a, b)| square(a - b)).sum();
            let norm: f64 = a.iter().map(|a| square(*a)).sum();
            (norm > 0.0).then(|| (off / norm).sqrt()).or_undefined("the first run ends in the dark")
        })
    }
}
