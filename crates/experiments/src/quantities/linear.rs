//! Laws of linear scattering.

use crate::form::Placed;
use crate::ids::RunId;
use crate::names::Names;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;

/// How far the light of a run is from the sum of others: L1 norm of the difference over that of the run.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct SuperpositionError {
    /// Name of a light run with several lights.
    run: Placed<String>,
    /// Names of light runs that have one of them each.
    parts: Vec<Placed<String>>,
}

impl QuantityKind for SuperpositionError {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let whole = names.light(&self.run)?;
        let shape = |names: &Names<'_, '_>, id: RunId| Some((names.grid(id)?, names.directions(id)?));
        let mut parts = Vec::new();
        for part in &self.parts {
            let id = names.light(part)?;
            if shape(names, id.0)? != shape(names, whole.0)? {
                let problem = format!("\"{}\" and \"{part}\" differ in cells or directions", self.run);
                names.fault(part.place(), &problem);
                return None;
            }
            parts.push(id);
        }
        measure(move |results| {
            let whole = results[whole].last.samples();
            let mut rest = whole.to_vec();
            for &part in &parts {
                rest.iter_mut().zip(results[part].last.samples()).for_each(|(rest, v)| *rest -= v);
            }
            let norm = |v: &[f64]| v.iter().map(|v| v.abs()).sum::<f64>();
            let whole = norm(whole);
            (whole > 0.0).then(|| norm(&rest) / whole).or_undefined("the run ends in the dark")
        })
    }
}

/// The relative difference between what a receiver gets of the lights of a run and what its importance says of them.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct AdjointError {
    /// Name of an importance run.
    importance: Placed<String>,
    /// Name of a light run in the same field, with linear scattering; none of its lights may be in the receiver's cell.
    light: Placed<String>,
}

impl QuantityKind for AdjointError {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (importance, light) = (names.importance(&self.importance)?, names.light(&self.light)?);
        let of = |id: RunId| Some((names.grid(id)?, names.directions(id)?));
        if of(importance.0)? != of(light.0)? {
            let problem =
                format!("\"{}\" and \"{}\" differ in cells or directions", self.importance, self.light);
            names.fault(self.light.place(), &problem);
            return None;
        }
        measure(move |results| {
            let (importance, light) = (&results[importance], &results[light]);
            let weighed = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let received = weighed(light.last.profile(importance.receiver), &importance.sensitivity);
            let emitted = light.emitted.iter().map(|(cell, profile)| {
                weighed(importance.importance.profile(*cell), profile)
            });
            let sent: f64 = emitted.sum();
            (sent > 0.0).then(|| (received - sent).abs() / sent).or_undefined("nothing arrives")
        })
    }
}

/// The relative standard error of an estimated gradient, as measured from its sketches: root mean square over all
/// values.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RelativeError {
    /// Name of a gradient run with `estimate`.
    run: Placed<String>,
}

impl QuantityKind for RelativeError {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let id = names.gradient(&self.run)?;
        measure(move |results| results[id].relative_error.or_undefined("the gradient is exact"))
    }
}
