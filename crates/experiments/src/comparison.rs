//! FTLE beside gradients: their maps, ridges, and numbers.

use crate::runs::Results;
use crate::settings::sample_of;
use crate::spec::{DistanceNumber, MapSource, RidgeSource};
use tigereye_core::{Cell, Field, Grid, LtgVolume};
use tigereye_lines::agreement::{COMPARED, Distances, append, chance, correlation};
use tigereye_lines::{Ftle, Polylines, RidgeOptions, ridge_lines};

/// A scalar at the cells; of a gradient where it is a result.
pub(crate) fn map(source: &MapSource, results: &Results) -> Option<Field<f64>> {
    let gradient = |run: &str| results.gradients.get(run).map(|g| &g.volume);
    match source {
        MapSource::Ftle { run } => results.ftle.get(run).map(at_cells),
        MapSource::Slice { run, deg } => {
            let volume = gradient(run)?;
            Some(results.inner(run, &volume.slice(sample_of(deg.get(), volume.directions()).ok()?)?))
        }
        MapSource::Mean { run } => gradient(run).map(|v| results.inner(run, &v.mean_over_directions())),
        MapSource::Maximum { run } => gradient(run).map(|v| results.inner(run, &v.max_over_directions())),
    }
}

/// The sides of a cell: light takes cells as squares, and so do gradients.
fn cell_of(source: &MapSource, results: &Results) -> [f64; 3] {
    let of_run = |run: &String| results.ftle.get(run).map(|f| f.cell.sides());
    let sides = match source {
        MapSource::Ftle { run } => of_run(run),
        MapSource::Slice { .. } | MapSource::Mean { .. } | MapSource::Maximum { .. } => None,
    };
    let [dx, dy] = sides.unwrap_or([1.0; 2]);
    [dx, dy, 1.0]
}

/// The cells' own samples.
fn at_cells(found: &Ftle) -> Field<f64> {
    let fine = found.larger.grid();
    let n = |v: usize| (v - 1) / found.samples + 1;
    match Grid::new(n(fine.width()), n(fine.height())) {
        Ok(grid) => {
            Field::from_fn(grid, |c| *found.larger.at(Cell::new(found.samples * c.x, found.samples * c.y)))
        }
        Err(_) => found.larger.clone(),
    }
}

/// The ridges of a source, in cells; `None` where there is no such run, or its ridges have too many samples.
pub(crate) fn ridges(source: &RidgeSource, results: &Results) -> Option<Polylines> {
    let mut all = Polylines::default();
    match source {
        RidgeSource::Of(source) => {
            let options = RidgeOptions { cell: cell_of(source, results), ..COMPARED };
            append(&mut all, &ridge_lines(&map(source, results)?, &options).ok()?.shape);
        }
        RidgeSource::EverySlice { run } => {
            let volume: &LtgVolume = &results.gradients.get(run)?.volume;
            for slice in volume.slices().iter().filter_map(|&t| volume.slice(t)) {
                append(&mut all, &ridge_lines(&results.inner(run, &slice), &COMPARED).ok()?.shape);
            }
        }
    }
    Some(all)
}

/// Cells of a run's field.
fn grid(run: &str, results: &Results) -> Option<Grid> {
    let of_gradient = || results.gradients.get(run).map(|g| g.volume.grid());
    results.ftle.get(run).map(|f| at_cells(f).grid()).or_else(of_gradient)
}

/// Distances of ridges from others.
pub(crate) fn distances(of: &RidgeSource, from: &RidgeSource, results: &Results) -> Option<Distances> {
    Some(Distances::between(&ridges(of, results)?, &ridges(from, results)?, grid(of.run(), results)?))
}

/// How much of anything would meet ridges by chance.
pub(crate) fn chance_of(source: &RidgeSource, within: f64, results: &Results) -> Option<f64> {
    Some(chance(&ridges(source, results)?, grid(source.run(), results)?, within))
}

/// A number of them.
pub(crate) fn distance_number(distances: &Distances, number: DistanceNumber) -> f64 {
    match number {
        DistanceNumber::Mean => distances.mean(),
        DistanceNumber::Most => distances.quantile(0.95),
        DistanceNumber::ShareWithin(cells) => distances.share_within(cells.get()),
    }
}

/// Correlation of two scalars.
pub(crate) fn map_correlation(a: &MapSource, b: &MapSource, results: &Results) -> Option<f64> {
    correlation(&map(a, results)?, &map(b, results)?)
}
