//! Numbers of pulses.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::pulses::{Summary, summary};
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::runs::pulses::{PulseNumber, PulseRecord};
use serde::Deserialize;

/// A number of all pulses of some runs, summarised.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct OfPulses {
    /// Names of pulses runs.
    runs: Vec<Placed<String>>,
    /// The number.
    number: PulseNumber,
    /// How pulses are summarised.
    over: Summary,
}

impl QuantityKind for OfPulses {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let runs = self.runs.iter().map(|run| names.pulses(run)).collect::<Option<Vec<_>>>()?;
        let (number, over) = (self.number, self.over);
        measure(move |results| {
            let pulses: Vec<&[PulseRecord]> =
                runs.iter().map(|&id| results[id].records.as_slice()).collect();
            Ok(summary(&pulses, number, over))
        })
    }
}
