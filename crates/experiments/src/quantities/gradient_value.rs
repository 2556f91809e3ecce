//! Values of a gradient.

use crate::form::{Finite, Placed};
use crate::names::Names;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;

/// What a value is not defined for.
const NO_VALUE: &str = "the gradient has no value there";

/// Value of a gradient.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientAt {
    /// Name of the gradient run.
    run: Placed<String>,
    /// Column and row.
    cell: Placed<(usize, usize)>,
    /// Sample index.
    sample: Placed<usize>,
}

impl QuantityKind for GradientAt {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let gradient = names.gradient(&self.run)?;
        let cell = names.cell_of(gradient.0, &self.cell)?;
        let what = format!("sample {}", self.sample);
        let slice = names.sample(gradient, *self.sample, self.sample.key(), &what)?;
        measure(move |results| results[gradient].volume().value(cell, slice.sample).or_undefined(NO_VALUE))
    }
}

/// Value of a gradient relative to that at another cell.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientRatio {
    /// Name of the gradient run.
    run: Placed<String>,
    /// Direction, degrees.
    deg: Placed<Finite>,
    /// Column and row.
    cell: Placed<(usize, usize)>,
    /// Column and row of the cell it is divided by.
    over: Placed<(usize, usize)>,
}

impl QuantityKind for GradientRatio {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let slice = names.slice(&self.run, &self.deg)?;
        let cell = names.cell_of(slice.gradient.0, &self.cell)?;
        let over = names.cell_of(slice.gradient.0, &self.over)?;
        measure(move |results| {
            let volume = results[slice.gradient].volume();
            let at = |cell| volume.value(cell, slice.sample).or_undefined(NO_VALUE);
            Ok(at(cell)? / at(over)?)
        })
    }
}
