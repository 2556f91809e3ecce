//! How the time of gradients grows with the number of cells.

use crate::form::Placed;
use crate::ids::{GradientId, RunId};
use crate::names::Names;
use crate::results::Results;
use crate::tables::entries::{NOTHING, grouped, hundredths, seconds, tenths};
use crate::tables::kind::{PlannedRow, TableKind, columns};
use serde::Deserialize;
use tigereye_core::math;
use tigereye_report::Column;

/// Computation time of the gradient, in seconds, for fields of increasing size, one series per method. Rows whose runs
/// are not in scope are omitted.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Growth {
    /// The methods.
    methods: Vec<GrowthMethod>,
}

/// Gradients of growing fields by one method.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GrowthMethod {
    /// Heading of its rows.
    label: String,
    /// Names of gradient runs, by number of cells.
    runs: Vec<Placed<String>>,
}

/// A gradient, and its run to ask for the time.
type Timed = (GradientId, RunId);

impl TableKind for Growth {
    fn columns(&self) -> Vec<Column> {
        columns(&[
            "Method",
            "Cells",
            "Directions",
            "This run /\u{a0}s",
            "Per cell and direction /\u{a0}µs",
            "Grows with cells to the power of",
        ])
    }

    fn rows(&self, names: &mut Names<'_, '_>) -> Vec<PlannedRow> {
        let mut rows = Vec::new();
        for method in &self.methods {
            for (i, run) in method.runs.iter().enumerate() {
                let smaller = i.checked_sub(1).map(|i| &method.runs[i]);
                rows.extend(names.part(|names| {
                    let smaller = match smaller {
                        Some(name) => Some(timed(names, name)?),
                        None => None,
                    };
                    let (run, label) = (timed(names, run)?, method.label.clone());
                    let row = move |results: &Results<'_>| Ok((label.clone(), entries(results, run, smaller)));
                    Some(Box::new(row) as PlannedRow)
                }));
            }
        }
        rows
    }
}

fn timed(names: &mut Names<'_, '_>, run: &Placed<String>) -> Option<Timed> {
    Some((names.gradient(run)?, names.run(run)?))
}

fn entries(results: &Results<'_>, (gradient, run): Timed, smaller: Option<Timed>) -> Vec<String> {
    let volume = &results[gradient].outcome.volume;
    let (grid, directions) = (volume.grid(), volume.directions().count());
    let taken = results.seconds(run);
    let measured = |taken: f64| Measured { cells: grid.cells() as f64, seconds: taken };
    let power = smaller.and_then(|(gradient, run)| {
        let cells = results[gradient].outcome.volume.grid().cells() as f64;
        let smaller = Measured { cells, seconds: results.seconds(run)? };
        Some(hundredths(measured(taken?).power_from(smaller)))
    });
    vec![
        format!("{}\u{a0}\u{d7}\u{a0}{}", grid.width(), grid.height()),
        grouped(&directions.to_string()),
        taken.map_or(NOTHING.to_owned(), seconds),
        taken.map_or(NOTHING.to_owned(), |s| tenths(1e6 * s / (grid.cells() * directions) as f64)),
        power.unwrap_or_else(|| NOTHING.to_owned()),
    ]
}

/// How long a field took.
#[derive(Clone, Copy)]
struct Measured {
    cells: f64,
    seconds: f64,
}

impl Measured {
    /// The exponent p of a time that grows with `cells^p` from a smaller field to this one.
    fn power_from(self, smaller: Self) -> f64 {
        math::log2(self.seconds / smaller.seconds) / math::log2(self.cells / smaller.cells)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_that_grow_with_the_square_of_the_cells_have_the_power_two() {
        let smaller = Measured { cells: 100.0, seconds: 0.5 };
        let larger = Measured { cells: 400.0, seconds: 8.0 };
        assert!((larger.power_from(smaller) - 2.0).abs() < 1e-15);
    }
}
