//! Two gradients of one field, and their difference.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::gradient::difference;
use crate::tables::entries::{percent, tenths};
use crate::tables::kind::{PlannedRow, TableKind, columns, rows_of};
use serde::Deserialize;
use tigereye_ltg::LtgOutcome;
use tigereye_report::Column;

/// Two gradients of one field, and their difference. Rows whose runs are not in scope are omitted.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Gradients {
    /// Heading of the first gradients.
    first: String,
    /// Heading of the second gradients.
    second: String,
    /// The rows.
    rows: Vec<GradientRow>,
}

/// Two gradients of one field.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientRow {
    /// Heading of the row.
    label: String,
    /// Name of the first gradient run.
    first: Placed<String>,
    /// Name of the second gradient run.
    second: Placed<String>,
}

impl TableKind for Gradients {
    fn columns(&self) -> Vec<Column> {
        let of = |name: &str| [format!("Mean /\u{a0}(W/rad), {name}"), format!("Steps per pulse, {name}")];
        let [mean, steps] = of(&self.first);
        let [other_mean, other_steps] = of(&self.second);
        columns(&[
            "Field",
            &mean,
            &steps,
            &other_mean,
            &other_steps,
            "Mean lower by /\u{a0}%",
            "L2 difference /\u{a0}%",
        ])
    }

    fn rows(&self, names: &mut Names<'_, '_>) -> Vec<PlannedRow> {
        rows_of(&self.rows, names, |row, names| {
            let (first, second) = (names.gradient(&row.first)?, names.gradient(&row.second)?);
            let label = row.label.clone();
            Some(Box::new(move |results| {
                Ok((label.clone(), entries(&results[first].outcome, &results[second].outcome)))
            }))
        })
    }
}

fn entries(first: &LtgOutcome, second: &LtgOutcome) -> Vec<String> {
    let mean = |g: &LtgOutcome| g.volume.values().iter().sum::<f64>() / g.volume.values().len() as f64;
    let steps = |g: &LtgOutcome| g.work.iterations_total as f64 / g.work.sources as f64;
    vec![
        tenths(mean(first)),
        tenths(steps(first)),
        tenths(mean(second)),
        tenths(steps(second)),
        percent(1.0 - mean(first) / mean(second)),
        percent(difference(&second.volume, &first.volume).unwrap_or(f64::NAN)),
    ]
}
