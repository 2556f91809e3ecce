//! Drawing of a curve into cells, point by point: each cell keeps the angle of the point nearest to its middle.

use tigereye_core::math::{cos, hypot, round_ties_even, sin};
use tigereye_core::{Cell, Field, Grid};

/// Cells by which the drawn square reaches beyond the field on each side.
pub(super) const MARGIN: usize = 25;

/// The best point of each cell so far: its distance from the cell's middle, in cells, and its angle.
pub(super) struct Curve {
    best: Field<Option<(f64, f64)>>,
}

impl Curve {
    /// No cell visited.
    pub(super) fn new(grid: Grid) -> Self {
        Self { best: Field::from_fn(grid, |_| None) }
    }

    /// Offers the point at polar coordinates `(r, theta)` about the centre, y up, with angle `phi`, to its cell. The
    /// first of equally near points stays.
    pub(super) fn visit(&mut self, r: f64, theta: f64, phi: f64) {
        let (px, py) = (r * cos(theta), r * sin(theta));
        let (x, y) = (round_ties_even(px), round_ties_even(py));
        let distance = hypot(x - px, y - py);
        let grid = self.best.grid();
        let centre = grid.centre();
        let column = centre.x.checked_add_signed(x as isize);
        let row = centre.y.checked_add_signed(-(y as isize));
        let Some(cell) = column.zip(row).map(|(x, y)| Cell::new(x, y)).filter(|c| grid.contains(*c)) else {
            return;
        };
        let best = &mut self.best.values_mut()[grid.index(cell)];
        if best.is_none_or(|(d, _)| distance < d) {
            *best = Some((distance, phi));
        }
    }

    /// The angle of a visited cell.
    pub(super) fn angle(&self, cell: Cell) -> Option<f64> {
        self.best.at(cell).map(|(_, phi)| phi)
    }
}
