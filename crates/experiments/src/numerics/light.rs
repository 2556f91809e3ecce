//! Numbers of light distributions.

use tigereye_core::{Cell, Field, Grid, LightDistribution, math};

/// The cell `distance` columns right of a light.
fn right_of(light: Cell, distance: usize, grid: Grid) -> Option<Cell> {
    let cell = Cell::new(light.x + distance, light.y);
    grid.contains(cell).then_some(cell)
}

/// Net flux in +x that far right of a light, relative to distance 1; `None` outside of the grid.
pub(crate) fn net_flux_ratio(light: &LightDistribution, source: Cell, distance: usize) -> Option<f64> {
    let flux = light.net_flux();
    let at = |d| Some(flux.at(right_of(source, d, light.grid())?).x);
    Some(at(distance)? / at(1)?)
}

/// The lobe in +x that far right of a light, relative to distance 1; `None` outside of the grid.
pub(crate) fn lobe_ratio(light: &LightDistribution, source: Cell, distance: usize) -> Option<f64> {
    let at = |d| Some(light.incoming().at(right_of(source, d, light.grid())?)[0]);
    Some(at(distance)? / at(1)?)
}

/// The part of the energy in some cells, those of the lights themselves dark; `None` in the dark.
pub(crate) fn share(
    light: &LightDistribution,
    sources: &[Cell],
    inside: impl Fn(Cell) -> bool,
) -> Option<f64> {
    let all = light.energy();
    let energy = Field::from_fn(all.grid(), |c| if sources.contains(&c) { 0.0 } else { *all.at(c) });
    let total: f64 = energy.values().iter().sum();
    let part: f64 = energy.iter().filter(|(c, _)| inside(*c)).map(|(_, e)| e).sum();
    (total > 0.0).then_some(part / total)
}

/// Distance of a cell from the centre of its grid, cells.
pub(crate) fn radius(grid: Grid, cell: Cell) -> f64 {
    let centre = [(grid.width() - 1) as f64 / 2.0, (grid.height() - 1) as f64 / 2.0];
    math::hypot(cell.x as f64 - centre[0], cell.y as f64 - centre[1])
}

/// Mean and standard deviation of the distance (cells) of energy from the centre of the grid; 0 in the dark.
pub(crate) fn energy_radius(energy: &Field<f64>) -> (f64, f64) {
    let grid = energy.grid();
    let total: f64 = energy.values().iter().sum();
    if total <= 0.0 {
        return (0.0, 0.0);
    }
    let mean = energy.iter().map(|(c, e)| radius(grid, c) * e).sum::<f64>() / total;
    let off = |c| radius(grid, c) - mean;
    let variance = energy.iter().map(|(c, e)| off(c) * off(c) * e).sum::<f64>() / total;
    (mean, variance.sqrt())
}
