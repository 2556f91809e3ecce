//! FTLE on tensor lines beside the gradient: how far they agree.

use crate::form::Placed;
use crate::ids::{FtleId, GradientId};
use crate::names::Names;
use crate::results::Results;
use crate::scalars::{Map, Ridges};
use crate::tables::entries::{NOTHING, hundredths, percent, tenths, whole};
use crate::tables::kind::{PlannedRow, TableKind, columns, rows_of};
use crate::unavailable::Unavailable;
use serde::Deserialize;
use tigereye_report::Column;

/// Ridges this near to each other, cells, meet.
pub(crate) const MEETING: f64 = 1.0;

/// FTLE on tensor lines compared with the gradient. Rows whose runs are not in scope are omitted.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Comparison {
    /// The rows.
    rows: Vec<ComparisonRow>,
}

/// An FTLE and a gradient of one field.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ComparisonRow {
    /// Heading of the row.
    label: String,
    /// Name of the FTLE run.
    ftle: Placed<String>,
    /// Name of the gradient run.
    gradient: Placed<String>,
}

impl TableKind for Comparison {
    fn columns(&self) -> Vec<Column> {
        columns(&[
            "Field",
            "Correlation of FTLE with mean LTG",
            "Correlation of FTLE with largest LTG",
            "Length of the FTLE ridges /\u{a0}cells",
            "FTLE ridges: met by LTG ridges of some direction /\u{a0}%",
            "FTLE ridges: met by chance /\u{a0}%",
            "FTLE ridges: mean distance to those that meet them /\u{a0}cells",
            "FTLE ridges: distance that 95\u{a0}% keep /\u{a0}cells",
            "Length of the LTG ridges of all directions /\u{a0}cells",
            "LTG ridges: met by FTLE ridges /\u{a0}%",
            "LTG ridges: met by chance /\u{a0}%",
            "LTG ridges: mean distance to those that meet them /\u{a0}cells",
            "LTG ridges: distance that 95\u{a0}% keep /\u{a0}cells",
            "Ridges of the largest LTG met by FTLE ridges /\u{a0}%",
        ])
    }

    fn rows(&self, names: &mut Names<'_, '_>) -> Vec<PlannedRow> {
        rows_of(&self.rows, names, |row, names| {
            let (ftle, gradient) = (names.ftle(&row.ftle)?, names.gradient(&row.gradient)?);
            let label = row.label.clone();
            Some(Box::new(move |results| Ok((label.clone(), entries(ftle, gradient, results)?))))
        })
    }
}

/// A correlation, or a dash without one.
pub(crate) fn correlation(a: Map, b: Map, results: &Results<'_>) -> String {
    a.correlation(b, results).map_or_else(|_| NOTHING.to_owned(), hundredths)
}

fn entries(ftle: FtleId, gradient: GradientId, results: &Results<'_>) -> Result<Vec<String>, Unavailable> {
    let ftle = Map::Ftle(ftle);
    let of_ftle = Ridges::Of(ftle);
    let every = Ridges::EverySlice(gradient);
    let forth = of_ftle.distances(every, results)?;
    let back = every.distances(of_ftle, results)?;
    let largest = Ridges::Of(Map::Maximum(gradient)).distances(of_ftle, results)?;
    let mut entries = vec![
        correlation(ftle, Map::Mean(gradient), results),
        correlation(ftle, Map::Maximum(gradient), results),
    ];
    for (found, met) in [(&forth, every), (&back, of_ftle)] {
        entries.extend([
            whole(found.length()),
            percent(found.share_within(MEETING)),
            percent(met.chance(MEETING, results)?),
            tenths(found.mean()),
            tenths(found.quantile(0.95)),
        ]);
    }
    entries.push(percent(largest.share_within(MEETING)));
    Ok(entries)
}
