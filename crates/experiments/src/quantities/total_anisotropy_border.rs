//! Large gradients and the border of total anisotropy.

use crate::form::{Fraction, Placed};
use crate::names::Names;
use crate::numerics::gradient::inner_cells;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::Unavailable;
use serde::Deserialize;
use tigereye_core::{Cell, Field, TotalAnisotropy};

/// Of the inner cells with the largest gradients, mean over direction, the share that lies beside the border of total
/// anisotropy by the published ratio of 20, whatever rule the run has.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct BesideTotalAnisotropy {
    /// Name of the gradient run.
    run: Placed<String>,
    /// Name of its field.
    field: Placed<String>,
    /// Which part of the inner cells: 1 for all of them.
    part: Fraction,
}

impl QuantityKind for BesideTotalAnisotropy {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (gradient, field, part) = (names.gradient(&self.run)?, names.field(&self.field)?, self.part.get());
        measure(move |results| {
            let thin = TotalAnisotropy::PUBLISHED.cells(&results.field(field).field);
            let mean = results[gradient].volume().mean_over_directions();
            if mean.grid() != thin.grid() {
                return Err(Unavailable::Undefined("the gradient and the field differ in cells"));
            }
            Ok(share_beside(&mean, &thin, part))
        })
    }
}

/// Of the `part` of the inner cells with the largest values, the share beside the border of a set; of equal ones the
/// first count.
fn share_beside(values: &Field<f64>, set: &Field<bool>, part: f64) -> f64 {
    let grid = values.grid();
    let mut cells: Vec<Cell> = inner_cells(grid).collect();
    cells.sort_by(|a, b| values.at(*b).total_cmp(values.at(*a)));
    cells.truncate((part * cells.len() as f64).ceil() as usize);
    let is_beside = |cell: &&Cell| {
        let mut beside = [0, 2, 4, 6].iter().filter_map(|&k| grid.neighbour(**cell, k));
        beside.any(|other| set.at(other) != set.at(**cell))
    };
    cells.iter().filter(is_beside).count() as f64 / cells.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    /// A set of columns 3 and more: columns 2 and 3 lie beside its border.
    #[test]
    fn cells_beside_a_border_are_on_both_sides_of_it() {
        let grid = Grid::new(8, 5).expect("a grid");
        let set = Field::from_fn(grid, |c| c.x >= 3);
        let falling = Field::from_fn(grid, |c| -(c.x as f64));
        // Inner columns 1 to 6: a sixth is column 1, a half columns 1 to 3.
        let share = |part| share_beside(&falling, &set, part);
        assert_eq!([share(1.0 / 6.0), share(0.5), share(1.0)], [0.0, 2.0 / 3.0, 1.0 / 3.0]);
    }
}
