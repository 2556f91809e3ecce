//! Parts of the energy, the lights excluded.

use crate::form::{NonNegative, Placed};
use crate::names::Names;
use crate::numerics::light::{radius, share};
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;
use tigereye_core::Cell;

/// What a share is not defined for.
const DARK: &str = "there is no energy outside of the lights";

/// Share of the energy within a range of distances from the centre, cells; lights excluded.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RingShare {
    /// Name of the light run.
    run: Placed<String>,
    /// Smallest and largest distance, cells.
    range: Placed<(NonNegative, NonNegative)>,
}

impl QuantityKind for RingShare {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        let (from, to) = (self.range.0.get(), self.range.1.get());
        if from > to {
            names.fault(self.range.key(), &format!("the range from {from} to {to} is empty"));
            return None;
        }
        let range = from..=to;
        measure(move |results| {
            let light = &results[light];
            let grid = light.last.grid();
            share(&light.last, &light.sources, |c| range.contains(&radius(grid, c))).or_undefined(DARK)
        })
    }
}

/// Share of the energy within columns and rows (both ends included); lights excluded.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct BoxShare {
    /// Name of the light run.
    run: Placed<String>,
    /// First and last column.
    columns: Placed<(usize, usize)>,
    /// First and last row.
    rows: Placed<(usize, usize)>,
}

impl QuantityKind for BoxShare {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light(&self.run)?;
        let (columns, rows) = (names.range(&self.columns)?, names.range(&self.rows)?);
        names.cell(names.grid(light.0)?, (*columns.end(), *rows.end()), self.columns.place())?;
        measure(move |results| {
            let light = &results[light];
            let inside = |c: Cell| columns.contains(&c.x) && rows.contains(&c.y);
            share(&light.last, &light.sources, inside).or_undefined(DARK)
        })
    }
}
