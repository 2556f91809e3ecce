//! Fields of another size.

use crate::FieldError;
use crate::limits::{MAX_RESAMPLED, MAX_RESAMPLED_CELLS};
use tigereye_core::{Cell, Field, Grid, Tensor2};

/// The same picture with another number of cells, component by component. Every new cell is a mean of the old ones
/// under a triangle around its centre, as wide as two cells of the coarser of both grids: linear interpolation where
/// the new grid is finer, an average where it is coarser. The same size gives the same field. Zero tensors, which stand
/// for cells without any (masked ones), are not mixed in: a new cell is the mean of those that there are, or zero where
/// they have less than half of its weight.
///
/// # Errors
/// [`FieldError::Grid`] and [`FieldError::ResampledSize`] for sizes that are invalid or too large.
pub fn resampled(field: &Field<Tensor2>, width: usize, height: usize) -> Result<Field<Tensor2>, FieldError> {
    let (wide, grid) = (Grid::new(width, field.grid().height())?, Grid::new(width, height)?);
    // The intermediate field has the new width and the old height.
    let cells = width.saturating_mul(height.max(field.grid().height()));
    if width.max(height) > MAX_RESAMPLED || cells > MAX_RESAMPLED_CELLS.max(field.grid().cells()) {
        return Err(FieldError::ResampledSize { width, height });
    }
    let (columns, rows) = (weights(field.grid().width(), width), weights(field.grid().height(), height));
    let wide = Field::from_fn(wide, |c| mean(&columns[c.x], |x| field.at(Cell::new(x, c.y))));
    let sums = Field::from_fn(grid, |c| mean(&rows[c.y], |y| wide.at(Cell::new(c.x, y))));
    if !field.values().iter().any(Tensor2::is_zero) {
        return Ok(sums);
    }
    let share = |c: Cell| -> f64 {
        let is_there = |x: usize, y: usize| f64::from(u8::from(!field.at(Cell::new(x, y)).is_zero()));
        let of_row = |y: usize| columns[c.x].iter().map(|&(x, w)| w * is_there(x, y)).sum::<f64>();
        rows[c.y].iter().map(|&(y, w)| w * of_row(y)).sum()
    };
    Ok(Field::from_fn(grid, |c| match share(c) {
        s if s < ENOUGH => Tensor2::ZERO,
        s if s > 1.0 - ROUNDING => *sums.at(c),
        s => sums.at(c).scaled(1.0 / s),
    }))
}

/// Share of its weight that a new cell must have from cells with a tensor.
const ENOUGH: f64 = 0.5;
/// Weights add up to 1 up to rounding.
const ROUNDING: f64 = 1e-9;

/// Indices and weights, of sum 1, for each new cell.
fn weights(old: usize, new: usize) -> Vec<Vec<(usize, f64)>> {
    let ratio = old as f64 / new as f64;
    let reach = ratio.max(1.0);
    let row = |i: usize| {
        let centre = (i as f64 + 0.5) * ratio - 0.5;
        let first = (centre - reach).ceil().max(0.0) as usize;
        let last = ((centre + reach).floor() as usize).min(old - 1);
        let weight = |j: usize| (j, (1.0 - (j as f64 - centre).abs() / reach).max(0.0));
        let mut row: Vec<(usize, f64)> = (first..=last).map(weight).filter(|w| w.1 > 0.0).collect();
        let sum: f64 = row.iter().map(|w| w.1).sum();
        row.iter_mut().for_each(|w| w.1 /= sum);
        row
    };
    (0..new).map(row).collect()
}

fn mean<'a>(weights: &[(usize, f64)], tensor: impl Fn(usize) -> &'a Tensor2) -> Tensor2 {
    let mut sum = [0.0; 4];
    for &(i, w) in weights {
        sum.iter_mut().zip(tensor(i).components()).for_each(|(s, v)| *s += w * v);
    }
    let [xx, xy, yx, yy] = sum;
    Tensor2::new(xx, xy, yx, yy)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(width: usize, height: usize) -> Field<Tensor2> {
        let place = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
        Field::from_fn(Grid::new(width, height).expect("a size"), |c| {
            let (x, y) = (place(c.x, width), place(c.y, height));
            Tensor2::new(x, y, 2.0 * x - y, 1.0)
        })
    }

    #[test]
    fn the_same_size_is_the_same_field() {
        let field = linear(7, 5);
        assert_eq!(resampled(&field, 7, 5), Ok(field));
    }

    /// Inside, where the triangle does not reach the border, linear fields stay linear on finer grids and on those
    /// coarser by a whole number.
    #[test]
    fn linear_fields_stay_linear() {
        for (width, height) in [(60, 60), (37, 41), (15, 10), (10, 4)] {
            let (found, expected) = (resampled(&linear(30, 20), width, height), linear(width, height));
            for (cell, t) in found.expect("a size").iter() {
                let inside = |i: usize, n: usize, old: usize| {
                    let (place, reach) = ((i as f64 + 0.5) / n as f64, 1.0 / (n.min(old) as f64));
                    place > 1.5 * reach && place < 1.0 - 1.5 * reach
                };
                if inside(cell.x, width, 30) && inside(cell.y, height, 20) {
                    let (found, expected) = (t.components(), expected.at(cell).components());
                    for i in 0..4 {
                        assert!((found[i] - expected[i]).abs() < 1e-12, "{width} x {height}: {cell:?}");
                    }
                }
            }
        }
    }

    /// Masked cells are not mixed in: a constant field stays constant around its hole.
    #[test]
    fn zero_tensors_are_not_mixed_in() {
        let t = Tensor2::new(1.0, 2.0, 3.0, 4.0);
        let grid = Grid::new(12, 9).expect("a size");
        let field = Field::from_fn(grid, |c| if c.x < 5 && c.y > 2 { Tensor2::ZERO } else { t });
        for (width, height) in [(24, 18), (17, 13), (5, 4)] {
            let found = resampled(&field, width, height).expect("a size");
            let near =
                |f: &Tensor2| f.components().iter().zip(t.components()).all(|(a, b)| (a - b).abs() < 1e-14);
            assert!(found.values().iter().all(|f| f.is_zero() || near(f)), "{width} x {height}");
            let holes =
                found.values().iter().filter(|f| f.is_zero()).count() as f64 / (width * height) as f64;
            assert!((holes - 30.0 / 108.0).abs() < 0.1, "{width} x {height}: {holes}");
        }
    }

    #[test]
    fn constants_stay_and_sizes_are_checked() {
        let field = Field::from_fn(Grid::new(4, 3).expect("a size"), |_| Tensor2::new(1.0, 2.0, 3.0, 4.0));
        let one = resampled(&field, 1, 1).expect("a size");
        let found = one.values()[0].components();
        assert!([1.0, 2.0, 3.0, 4.0].iter().zip(found).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}");
        assert!(resampled(&field, 0, 3).is_err());
    }
}
