//! Symmetry of a gradient.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::mirror::Mirror;
use crate::numerics::worst;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;
use tigereye_core::LtgVolume;

/// Largest difference of a gradient under a symmetry of cells and directions, relative to its largest value.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientSymmetry {
    /// Name of the gradient run.
    run: Placed<String>,
    /// Symmetry.
    under: Mirror,
}

impl QuantityKind for GradientSymmetry {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let gradient = names.gradient(&self.run)?;
        let under = self.under;
        measure(move |results| symmetry_error(results[gradient].volume(), under)
            .or_undefined("the gradient is zero, or lacks the directions that the symmetry needs"))
    }
}

/// Largest `|LTG(p, t) - LTG(image of p, image of t)|` over the largest value.
fn symmetry_error(volume: &LtgVolume, under: Mirror) -> Option<f64> {
    let s = volume.directions().count();
    let largest = volume.values().iter().fold(0.0, |m: f64, &v| m.max(v));
    let mut errors = Vec::new();
    for &t in volume.slices() {
        for cell in volume.grid().iter() {
            let here = volume.value(cell, t)?;
            let there = volume.value(under.cell(volume.grid(), cell)?, under.sample(t, s))?;
            errors.push((here - there).abs());
        }
    }
    (largest > 0.0).then_some(worst(errors) / largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Directions, Grid};

    #[test]
    fn a_lopsided_volume_breaks_symmetry() {
        let grid = Grid::new(5, 5).expect("a grid");
        let directions = Directions::new(8).expect("directions");
        let values: Vec<f64> = (0..8 * 25).map(|i| f64::from(i % 25)).collect();
        let volume = LtgVolume::new(grid, directions, (0..8).collect(), values);
        assert!(symmetry_error(&volume, Mirror::LeftRight).expect("defined") > 0.1);
        let even = LtgVolume::new(grid, directions, (0..8).collect(), vec![1.0; 200]);
        assert_eq!(symmetry_error(&even, Mirror::QuarterTurn), Some(0.0));
    }
}
