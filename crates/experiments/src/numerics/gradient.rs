//! Numbers of light transport gradients.

use tigereye_core::{Cell, Field, Grid, LtgVolume};

/// Cells that are not on the border, where the gradient is 0 by definition.
pub(crate) fn inner_cells(grid: Grid) -> impl Iterator<Item = Cell> {
    grid.iter().filter(move |c| !grid.is_border(*c))
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

/// L2 difference of two gradients over the L2 norm of `a`, at the same cells and slices.
pub(crate) fn difference(a: &LtgVolume, b: &LtgVolume) -> Option<f64> {
    if a.grid() != b.grid() || a.directions() != b.directions() || a.slices() != b.slices() {
        return None;
    }
    let off: f64 = a.values().iter().zip(b.values()).map(|(a, b)| (a - b) * (a - b)).sum();
    let norm: f64 = a.values().iter().map(|a| a * a).sum();
    (norm > 0.0).then(|| (off / norm).sqrt())
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
}
