//! Numbers of light distributions.

use super::worst;
use crate::runs::{LightResult, energy_radius};
use crate::spec::Mirror;
use std::ops::RangeInclusive;
use tigereye_core::{Cell, Field, Grid, LightDistribution, math};

/// The distribution after a kept step; the last one where no step is named.
pub(crate) fn at_step(result: &LightResult, step: Option<usize>) -> Option<&LightDistribution> {
    match step {
        None => Some(&result.last),
        Some(n) => result.frames.get(&n).or_else(|| (n == result.work.steps).then_some(&result.last)),
    }
}

pub(super) fn energy_drift(result: &LightResult) -> Option<f64> {
    let start = *result.energies.first().filter(|e| **e > 0.0)?;
    Some(worst(result.energies.iter().map(|e| (e / start - 1.0).abs())))
}

/// The cell `distance` columns right of the first light.
fn right_of_light(result: &LightResult, distance: usize) -> Option<Cell> {
    let light = result.sources.first()?;
    let cell = Cell::new(light.x + distance, light.y);
    result.last.grid().contains(cell).then_some(cell)
}

/// Net flux in +x, relative to distance 1.
pub(crate) fn net_flux_ratio(result: &LightResult, distance: usize) -> Option<f64> {
    let flux = result.last.net_flux();
    let at = |d| Some(flux.at(right_of_light(result, d)?)[0]);
    Some(at(distance)? / at(1)?)
}

/// The lobe in +x, relative to distance 1.
pub(crate) fn lobe_ratio(result: &LightResult, distance: usize) -> Option<f64> {
    let at = |d| Some(result.last.incoming().at(right_of_light(result, d)?)[0]);
    Some(at(distance)? / at(1)?)
}

pub(super) fn energy_ratio(result: &LightResult, cell: (usize, usize), over: (usize, usize)) -> Option<f64> {
    let energy = result.last.energy();
    let at = |(x, y)| energy.grid().contains(Cell::new(x, y)).then(|| *energy.at(Cell::new(x, y)));
    Some(at(cell)? / at(over)?)
}

pub(super) fn energy_over(a: &LightResult, b: &LightResult, cell: (usize, usize)) -> Option<f64> {
    let cell = Cell::new(cell.0, cell.1);
    let at = |r: &LightResult| r.last.grid().contains(cell).then(|| *r.last.energy().at(cell));
    Some(at(a)? / at(b)?)
}

/// Energies with the lights' own cells dark.
fn without_sources(result: &LightResult) -> Field<f64> {
    let energy = result.last.energy();
    Field::from_fn(energy.grid(), |c| if result.sources.contains(&c) { 0.0 } else { *energy.at(c) })
}

fn share(energy: &Field<f64>, inside: impl Fn(Cell) -> bool) -> Option<f64> {
    let total: f64 = energy.values().iter().sum();
    let part: f64 = energy.iter().filter(|(c, _)| inside(*c)).map(|(_, e)| e).sum();
    (total > 0.0).then_some(part / total)
}

pub(super) fn ring_share(result: &LightResult, range: RangeInclusive<f64>) -> Option<f64> {
    let grid = result.last.grid();
    let centre = [(grid.width() - 1) as f64 / 2.0, (grid.height() - 1) as f64 / 2.0];
    let radius = |c: Cell| math::hypot(c.x as f64 - centre[0], c.y as f64 - centre[1]);
    share(&without_sources(result), |c| range.contains(&radius(c)))
}

pub(super) fn box_share(
    result: &LightResult,
    columns: RangeInclusive<usize>,
    rows: RangeInclusive<usize>,
) -> Option<f64> {
    share(&without_sources(result), |c| columns.contains(&c.x) && rows.contains(&c.y))
}

/// Where a cell goes under a symmetry; `None` where the grid does not have it.
pub(super) fn image_of(grid: Grid, c: Cell, under: Mirror) -> Option<Cell> {
    let (w, h) = (grid.width(), grid.height());
    match under {
        Mirror::LeftRight => Some(Cell::new(w - 1 - c.x, c.y)),
        Mirror::TopBottom => Some(Cell::new(c.x, h - 1 - c.y)),
        Mirror::HalfTurn => Some(Cell::new(w - 1 - c.x, h - 1 - c.y)),
        // Counter-clockwise: the right end of a row goes to the top of a column.
        Mirror::QuarterTurn => (w == h).then(|| Cell::new(c.y, w - 1 - c.x)),
    }
}

pub(super) fn symmetry_error(result: &LightResult, under: Mirror) -> Option<f64> {
    let energy = result.last.energy();
    let largest = energy.values().iter().fold(0.0, |m: f64, &e| m.max(e));
    let error = |(cell, e): (Cell, &f64)| Some((e - energy.at(image_of(energy.grid(), cell, under)?)).abs());
    let errors = energy.iter().map(error).collect::<Option<Vec<f64>>>()?;
    (largest > 0.0).then_some(worst(errors) / largest)
}

/// Mean radius of the energy within 22.5 degrees of the axes over that within 22.5 degrees of the diagonals.
pub(super) fn roundness(result: &LightResult, step: usize) -> Option<f64> {
    let energy = at_step(result, Some(step))?.energy();
    let grid = energy.grid();
    let centre = [(grid.width() - 1) as f64 / 2.0, (grid.height() - 1) as f64 / 2.0];
    let about_axes = |c: Cell| {
        let (dx, dy) = ((c.x as f64 - centre[0]).abs(), (c.y as f64 - centre[1]).abs());
        let (small, large) = (dx.min(dy), dx.max(dy));
        small < math::tan(math::radians(22.5)) * large
    };
    let sector = |axes: bool| {
        energy_radius(&Field::from_fn(grid, |c| if about_axes(c) == axes { *energy.at(c) } else { 0.0 })).0
    };
    Some(sector(true) / sector(false)).filter(|r| r.is_finite())
}

pub(super) fn difference(a: &LightResult, b: &LightResult) -> Option<f64> {
    let (a, b) = (a.last.samples(), b.last.samples());
    if a.len() != b.len() {
        return None;
    }
    let square = |x: f64| x * x;
    let off: f64 = a.iter().zip(b).map(|(a, b)| square(a - b)).sum();
    let norm: f64 = a.iter().map(|a| square(*a)).sum();
    (norm > 0.0).then(|| (off / norm).sqrt())
}
