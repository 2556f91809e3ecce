//! Bilinear interpolation between the centres of cells.

use crate::{Cell, Grid, Point};

/// The four cells around a point and their weights, of sum 1: upper left, upper right, lower left, lower right. A point
/// beyond the centres of the outermost cells is moved to them; on a grid one cell wide or high, cells repeat.
#[must_use]
pub fn bilinear(grid: Grid, p: Point) -> [(Cell, f64); 4] {
    let along = |v: f64, cells: usize| {
        let last = (cells - 1) as f64;
        let v = v.clamp(0.0, last);
        let before = v.floor().min((last - 1.0).max(0.0));
        (before as usize, v - before)
    };
    let ((i, u), (j, v)) = (along(p.x, grid.width()), along(p.y, grid.height()));
    let cell =
        |di: usize, dj: usize| Cell::new((i + di).min(grid.width() - 1), (j + dj).min(grid.height() - 1));
    [
        (cell(0, 0), (1.0 - u) * (1.0 - v)),
        (cell(1, 0), u * (1.0 - v)),
        (cell(0, 1), (1.0 - u) * v),
        (cell(1, 1), u * v),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_linear_functions_are_reproduced() {
        for (width, height) in [(5, 4), (1, 4), (5, 1), (1, 1)] {
            let grid = Grid::new(width, height).expect("a size");
            let f = |x: f64, y: f64| 1.0 + x - 2.0 * y + 0.5 * x * y;
            let (right, bottom) = ((width - 1) as f64, (height - 1) as f64);
            for (x, y) in [(0.0, 0.0), (1.25, 2.75), (right, bottom), (3.999, 0.5)] {
                let (x, y) = (f64::min(x, right), f64::min(y, bottom));
                let found = bilinear(grid, Point::new(x, y));
                let value: f64 = found.iter().map(|(c, w)| w * f(c.x as f64, c.y as f64)).sum();
                assert!((value - f(x, y)).abs() < 1e-14, "{width} x {height}: {x} {y}");
            }
        }
    }
}
