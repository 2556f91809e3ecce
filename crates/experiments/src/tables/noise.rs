//! What noise changes of FTLE and gradient.

use crate::form::Placed;
use crate::names::Names;
use crate::results::Results;
use crate::scalars::{Map, Ridges};
use crate::tables::comparison::{MEETING, correlation};
use crate::tables::entries::percent;
use crate::tables::kind::{PlannedRow, TableKind, columns, rows_of};
use crate::unavailable::Unavailable;
use serde::Deserialize;
use tigereye_report::Column;

/// The effect of noise on FTLE and gradient. Rows whose runs are not in scope are omitted.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// The rows.
    rows: Vec<NoiseRow>,
}

/// FTLE and gradient of a field without and with noise.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct NoiseRow {
    /// Heading of the row.
    label: String,
    /// Names of the FTLE runs, without and with noise.
    ftle: (Placed<String>, Placed<String>),
    /// Names of the gradient runs, without and with noise.
    gradient: (Placed<String>, Placed<String>),
}

impl TableKind for Noise {
    fn columns(&self) -> Vec<Column> {
        columns(&[
            "Field and noise",
            "FTLE: correlation with that without noise",
            "its ridges without noise still met /\u{a0}%",
            "its ridges with noise that were there before /\u{a0}%",
            "Largest LTG: correlation",
            "ridges still met /\u{a0}%",
            "ridges there before /\u{a0}%",
        ])
    }

    fn rows(&self, names: &mut Names<'_, '_>) -> Vec<PlannedRow> {
        rows_of(&self.rows, names, |row, names| {
            let ftle = [names.ftle(&row.ftle.0)?, names.ftle(&row.ftle.1)?].map(Map::Ftle);
            let gradient = [names.gradient(&row.gradient.0)?, names.gradient(&row.gradient.1)?];
            let pairs = [ftle, gradient.map(Map::Maximum)];
            let label = row.label.clone();
            Some(Box::new(move |results| Ok((label.clone(), entries(&pairs, results)?))))
        })
    }
}

/// Of each pair, the first without noise: correlation, and the ridges that meet.
fn entries(pairs: &[[Map; 2]], results: &Results<'_>) -> Result<Vec<String>, Unavailable> {
    let mut entries = Vec::new();
    for &[clean, noisy] in pairs {
        entries.push(correlation(clean, noisy, results));
        let (clean, noisy) = (Ridges::Of(clean), Ridges::Of(noisy));
        entries.extend([
            percent(clean.distances(noisy, results)?.share_within(MEETING)),
            percent(noisy.distances(clean, results)?.share_within(MEETING)),
        ]);
    }
    Ok(entries)
}
