//! Gradients of different resolution.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::gradient::inner_cells;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;
use tigereye_core::{LtgVolume, Point, bilinear, pearson};

/// Correlation of the mean over directions of two gradients, the coarser one sampled at the finer one's cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GradientCorrelation {
    /// Name of a gradient run.
    run: Placed<String>,
    /// Name of the other run.
    with: Placed<String>,
}

impl QuantityKind for GradientCorrelation {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (gradient, with) = (names.gradient(&self.run)?, names.gradient(&self.with)?);
        measure(move |results| {
            let (a, b) = (results[gradient].volume(), results[with].volume());
            correlation(a, b).or_undefined("one of the gradients is constant")
        })
    }
}

/// Pearson correlation of the means over directions at the inner cells of the coarser grid; the finer mean is
/// interpolated bilinearly at the same relative place.
fn correlation(a: &LtgVolume, b: &LtgVolume) -> Option<f64> {
    let (coarse, fine) = if a.grid().cells() <= b.grid().cells() { (a, b) } else { (b, a) };
    let (coarse_mean, fine_mean) = (coarse.mean_over_directions(), fine.mean_over_directions());
    let (g, f) = (coarse.grid(), fine.grid());
    let relative = |k: usize, n: usize, m: usize| k as f64 * (m - 1) as f64 / (n.max(2) - 1) as f64;
    let pairs: Vec<(f64, f64)> = inner_cells(g)
        .map(|c| {
            let (x, y) = (relative(c.x, g.width(), f.width()), relative(c.y, g.height(), f.height()));
            let fine = bilinear(f, Point::new(x, y)).iter().map(|(c, w)| w * fine_mean.at(*c)).sum();
            (*coarse_mean.at(c), fine)
        })
        .collect();
    pearson(&pairs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Directions, Grid};

    #[test]
    fn a_volume_correlates_with_itself() {
        let grid = Grid::new(5, 5).expect("a grid");
        let directions = Directions::new(8).expect("directions");
        let values: Vec<f64> = (0..8 * 25).map(|i| f64::from(i % 25)).collect();
        let volume = LtgVolume::new(grid, directions, (0..8).collect(), values);
        assert!((correlation(&volume, &volume).expect("defined") - 1.0).abs() < 1e-12);
    }
}
