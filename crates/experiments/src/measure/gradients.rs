//! Numbers of light transport gradients.

use super::lights::image_of;
use super::worst;
use crate::settings::sample_of;
use crate::spec::Mirror;
use std::ops::RangeInclusive;
use tigereye_core::{Cell, Field, Grid, LtgVolume};

/// Cells that are not on the border, where the gradient is 0 by definition.
pub(crate) fn inner_cells(grid: Grid) -> impl Iterator<Item = Cell> {
    grid.iter().filter(move |c| !grid.is_border(*c))
}

fn slice_at(volume: &LtgVolume, deg: f64) -> Option<Field<f64>> {
    volume.slice(sample_of(deg, volume.directions()).ok()?)
}

/// Column of the largest value of each row, to a fraction of a column: the vertex of the parabola through the largest
/// value and its neighbours. `None` in rows without values above 0.
pub(crate) fn ridge_columns(slice: &Field<f64>) -> Vec<Option<f64>> {
    let (w, h) = (slice.grid().width(), slice.grid().height());
    (0..h)
        .map(|y| {
            let row = &slice.values()[y * w..(y + 1) * w];
            let (x, &v) = row.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
            if v <= 0.0 || x == 0 || x + 1 == w {
                return None;
            }
            let (left, right) = (row[x - 1], row[x + 1]);
            let curvature = left - 2.0 * v + right;
            let shift = if curvature < 0.0 { 0.5 * (left - right) / curvature } else { 0.0 };
            Some(x as f64 + shift)
        })
        .collect()
}

pub(super) fn ridge_column_error(
    volume: &LtgVolume,
    deg: f64,
    column: f64,
    rows: RangeInclusive<usize>,
) -> Option<f64> {
    let ridge = ridge_columns(&slice_at(volume, deg)?);
    let errors = rows.map(|y| Some(((*ridge.get(y)?)? - column).abs())).collect::<Option<Vec<f64>>>()?;
    Some(worst(errors))
}

pub(super) fn ridge_contrast(
    volume: &LtgVolume,
    deg: f64,
    column: usize,
    rows: RangeInclusive<usize>,
) -> Option<f64> {
    let slice = slice_at(volume, deg)?;
    let grid = slice.grid();
    let values: Vec<f64> = inner_cells(grid).map(|c| *slice.at(c)).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let count = rows.clone().count() as f64;
    let mut on_ridge = 0.0;
    for y in rows {
        let cell = Cell::new(column, y);
        if !grid.contains(cell) {
            return None;
        }
        on_ridge += slice.at(cell);
    }
    (mean > 0.0).then_some(on_ridge / count / mean)
}

/// Largest `|LTG(p, t) - LTG(image of p, image of t)|` over the largest value.
pub(super) fn symmetry_error(volume: &LtgVolume, under: Mirror) -> Option<f64> {
    let s = volume.directions().count();
    let turned = |t: usize| match under {
        Mirror::LeftRight => (s + s / 2 - t) % s,
        Mirror::TopBottom => (s - t) % s,
        Mirror::HalfTurn => (t + s / 2) % s,
        Mirror::QuarterTurn => (t + s / 4) % s,
    };
    let largest = volume.values().iter().fold(0.0, |m: f64, &v| m.max(v));
    let mut errors = Vec::new();
    for &t in volume.slices() {
        for cell in volume.grid().iter() {
            let here = volume.value(cell, t)?;
            let there = volume.value(image_of(volume.grid(), cell, under)?, turned(t))?;
            errors.push((here - there).abs());
        }
    }
    (largest > 0.0).then_some(worst(errors) / largest)
}

/// Pearson correlation of the means over directions at the inner cells of the coarser grid; the finer mean is
/// interpolated bilinearly at the same relative place.
pub(super) fn correlation(a: &LtgVolume, b: &LtgVolume) -> Option<f64> {
    let (coarse, fine) = if a.grid().cells() <= b.grid().cells() { (a, b) } else { (b, a) };
    let (coarse_mean, fine_mean) = (coarse.mean_over_directions(), fine.mean_over_directions());
    let (g, f) = (coarse.grid(), fine.grid());
    let relative = |k: usize, n: usize, m: usize| k as f64 * (m - 1) as f64 / (n.max(2) - 1) as f64;
    let pairs: Vec<(f64, f64)> = inner_cells(g)
        .map(|c| {
            let (x, y) = (relative(c.x, g.width(), f.width()), relative(c.y, g.height(), f.height()));
            (*coarse_mean.at(c), bilinear(&fine_mean, x, y))
        })
        .collect();
    tigereye_core::pearson(&pairs)
}

/// L2 difference of two gradients over the L2 norm of `a`, at the same cells and slices.
pub(crate) fn difference(a: &LtgVolume, b: &LtgVolume) -> Option<f64> {
    if a.grid() != b.grid() || a.directions() != b.directions() || a.slices() != b.slices() {
        return None;
    }
    let off: f64 = a.values().iter().zip(b.values()).map(|(a, b)| (a - b) * (a - b)).sum();
    let norm: f64 = a.values().iter().map(|a| a * a).sum();
    (norm > 0.0).then(|| (off / norm).sqrt())
}

fn bilinear(field: &Field<f64>, x: f64, y: f64) -> f64 {
    let grid = field.grid();
    let (x0, y0) = (x.floor() as usize, y.floor() as usize);
    let (x1, y1) = ((x0 + 1).min(grid.width() - 1), (y0 + 1).min(grid.height() - 1));
    let (u, v) = (x - x0 as f64, y - y0 as f64);
    let at = |x, y| *field.at(Cell::new(x, y));
    (1.0 - v) * ((1.0 - u) * at(x0, y0) + u * at(x1, y0)) + v * ((1.0 - u) * at(x0, y1) + u * at(x1, y1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Directions;

    #[test]
    fn ridge_is_found_between_columns() {
        let grid = Grid::new(7, 1).expect("a grid");
        // A parabola with its vertex at 3.25.
        let slice = Field::from_fn(grid, |c| 10.0 - (c.x as f64 - 3.25) * (c.x as f64 - 3.25));
        let columns = ridge_columns(&slice);
        assert!((columns[0].expect("a ridge") - 3.25).abs() < 1e-12);
        assert_eq!(ridge_columns(&Field::from_fn(grid, |_| 0.0)), [None]);
    }

    #[test]
    fn volumes_differ_relative_to_the_first() {
        let grid = Grid::new(2, 1).expect("a grid");
        let directions = Directions::new(8).expect("directions");
        let volume = |slice, values: [f64; 2]| LtgVolume::new(grid, directions, vec![slice], values.to_vec());
        let (a, b) = (volume(0, [3.0, 4.0]), volume(0, [3.0, 3.0]));
        assert_eq!((difference(&a, &b), difference(&a, &a)), (Some(0.2), Some(0.0)));
        assert_eq!(difference(&a, &volume(1, [3.0, 4.0])), None);
        assert_eq!(difference(&volume(0, [0.0; 2]), &a), None);
    }

    #[test]
    fn a_volume_correlates_with_itself_and_breaks_symmetry_when_lopsided() {
        let grid = Grid::new(5, 5).expect("a grid");
        let directions = Directions::new(8).expect("directions");
        let values: Vec<f64> = (0..8 * 25).map(|i| f64::from(i % 25)).collect();
        let volume = LtgVolume::new(grid, directions, (0..8).collect(), values);
        assert!((correlation(&volume, &volume).expect("defined") - 1.0).abs() < 1e-12);
        assert!(symmetry_error(&volume, Mirror::LeftRight).expect("defined") > 0.1);
        let even = LtgVolume::new(grid, directions, (0..8).collect(), vec![1.0; 200]);
        assert_eq!(symmetry_error(&even, Mirror::QuarterTurn), Some(0.0));
    }
}
