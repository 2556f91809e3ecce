//! How pulses come to rest, a run a row.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::pulses::{Summary, summary};
use crate::runs::pulses::{PulseNumber as N, PulseRecord};
use crate::tables::entries::{percent, power, tenths, whole};
use crate::tables::kind::{PlannedRow, TableKind, columns, rows_of};
use serde::Deserialize;
use tigereye_report::Column;

/// What stands between the ends of a range.
const RANGE: &str = "\u{2013}";

/// One row per pulses run: steps, evaluations, and what the stopping rule misses. Runs that are not in scope are
/// omitted.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Pulses {
    /// Names of pulses runs.
    runs: Vec<Placed<String>>,
}

impl TableKind for Pulses {
    fn columns(&self) -> Vec<Column> {
        columns(&[
            "Run",
            "Pulses",
            "Plain steps",
            "Evaluations by the solver",
            "Times fewer",
            "Steps under the rule",
            "Distance of that state /\u{a0}%",
            "Energy it lacks /\u{a0}%",
            "Error of plain steps",
            "Error of the solver",
        ])
    }

    fn rows(&self, names: &mut Names<'_, '_>) -> Vec<PlannedRow> {
        rows_of(&self.runs, names, |run, names| {
            let (id, name) = (names.pulses(run)?, run.to_string());
            Some(Box::new(move |results| Ok((name.clone(), entries(&results[id].records)))))
        })
    }
}

fn entries(pulses: &[PulseRecord]) -> Vec<String> {
    let of = |number, over| summary(&[pulses], number, over);
    let range = |number, shown: fn(f64) -> String| {
        let [mean, least, most] =
            [Summary::Mean, Summary::Least, Summary::Most].map(|over| shown(of(number, over)));
        if least == most { mean } else { format!("{mean} ({least}{RANGE}{most})") }
    };
    vec![
        settled(pulses),
        range(N::PlainSteps, whole),
        range(N::Evaluations, whole),
        tenths(of(N::PlainSteps, Summary::Mean) / of(N::Evaluations, Summary::Mean)),
        range(N::StoppedSteps, whole),
        range(N::StoppedDistance, percent),
        range(N::MissingEnergy, percent),
        power(of(N::PlainError, Summary::Most)),
        power(of(N::SolverError, Summary::Most)),
    ]
}

/// How many pulses there are, and how many have no stationary state.
fn settled(pulses: &[PulseRecord]) -> String {
    let settled = pulses.iter().filter(|p| p.number(N::Settled) == 1.0).count();
    match pulses.len() - settled {
        0 => pulses.len().to_string(),
        trapped => format!("{} ({trapped} without end)", pulses.len()),
    }
}
