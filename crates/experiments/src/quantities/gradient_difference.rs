//! Differences of gradients.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::gradient::difference;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;

/// L2 difference of two gradients relative to the L2 norm of the first. Both need the same cells and slices.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientDifference {
    /// Name of a gradient run.
    run: Placed<String>,
    /// Name of the other run.
    from: Placed<String>,
}

impl QuantityKind for GradientDifference {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (gradient, from) = (names.gradient(&self.run)?, names.gradient(&self.from)?);
        let of = |id: crate::ids::GradientId| {
            Some((names.grid(id.0)?, names.directions(id.0)?, names.slices(id)))
        };
        if of(gradient)? != of(from)? {
            let problem =
                format!("\"{}\" and \"{}\" differ in cells, directions or slices", self.run, self.from);
            names.fault(self.from.place(), &problem);
            return None;
        }
        measure(move |results| {
            let (a, b) = (results[gradient].volume(), results[from].volume());
            difference(a, b).or_undefined("the first gradient is zero")
        })
    }
}
