//! The ridge of a gradient's slice along a column.

use crate::form::{Finite, Placed};
use crate::names::Names;
use crate::numerics::gradient::{inner_cells, ridge_columns};
use crate::numerics::worst;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;
use tigereye_core::Cell;

/// Largest distance (columns) of a row's maximum from a column, over rows (both ends included).
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RidgeColumnError {
    /// Name of the gradient run.
    run: Placed<String>,
    /// Direction, degrees.
    deg: Placed<Finite>,
    /// Column expected.
    column: Finite,
    /// First and last row.
    rows: Placed<(usize, usize)>,
}

impl QuantityKind for RidgeColumnError {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let slice = names.slice(&self.run, &self.deg)?;
        let rows = names.range(&self.rows)?;
        names.cell(names.grid(slice.gradient.0)?, (0, *rows.end()), self.rows.place())?;
        let column = self.column.get();
        measure(move |results| {
            let ridge = ridge_columns(&results.slice(slice)?);
            let error = |y: usize| Some(((*ridge.get(y)?)? - column).abs());
            let errors = rows.clone().map(error).collect::<Option<Vec<f64>>>();
            Ok(worst(errors.or_undefined("one of the rows has no maximum inside")?))
        })
    }
}

/// Mean of a column over a range of rows (both ends included), divided by the mean over the slice's inner cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RidgeContrast {
    /// Name of the gradient run.
    run: Placed<String>,
    /// Direction, degrees.
    deg: Placed<Finite>,
    /// Column.
    column: usize,
    /// First and last row.
    rows: Placed<(usize, usize)>,
}

impl QuantityKind for RidgeContrast {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let slice = names.slice(&self.run, &self.deg)?;
        let rows = names.range(&self.rows)?;
        names.cell(names.grid(slice.gradient.0)?, (self.column, *rows.end()), self.rows.place())?;
        let column = self.column;
        measure(move |results| {
            let slice = results.slice(slice)?;
            let values: Vec<f64> = inner_cells(slice.grid()).map(|c| *slice.at(c)).collect();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let count = rows.clone().count() as f64;
            let mut on_ridge = 0.0;
            for y in rows.clone() {
                on_ridge += slice.at(Cell::new(column, y));
            }
            (mean > 0.0).then(|| on_ridge / count / mean).or_undefined("the slice is zero")
        })
    }
}
