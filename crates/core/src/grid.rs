//! Cells, their order and their neighbours.

use crate::{CoreError, Point};

/// One cell: column `x` to the right, row `y` downwards, both from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    /// Column.
    pub x: usize,
    /// Row, 0 on top.
    pub y: usize,
}

impl Cell {
    /// Cell in column `x`, row `y`.
    #[must_use]
    pub const fn new(x: usize, y: usize) -> Self {
        Self { x, y }
    }

    /// The centre of the cell.
    #[must_use]
    pub const fn centre(self) -> Point {
        Point::new(self.x as f64, self.y as f64)
    }
}

/// Offsets (dx, dy) of the eight neighbours k = 0..8 at 45k degrees, counter-clockwise from +x. Rows run downwards, so
/// 90 degrees leads to row y-1.
pub const NEIGHBOUR_OFFSETS: [(isize, isize); 8] =
    [(1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1)];

/// A rectangle of `width` x `height` cells in row-major order, row 0 on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Grid {
    width: usize,
    height: usize,
}

impl Grid {
    /// Largest number of cells a grid may have.
    pub const MAX_CELLS: usize = crate::limits::MAX_CELLS;

    /// A grid of `width` x `height` cells.
    ///
    /// # Errors
    /// [`CoreError::GridSize`] for an empty or too large grid.
    pub fn new(width: usize, height: usize) -> Result<Self, CoreError> {
        match width.checked_mul(height) {
            Some(1..=Self::MAX_CELLS) => Ok(Self { width, height }),
            _ => Err(CoreError::GridSize { width, height }),
        }
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }
    /// Rows.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height
    }
    /// Number of cells.
    #[must_use]
    pub const fn cells(&self) -> usize {
        self.width * self.height
    }
    /// The grid with width and height exchanged.
    #[must_use]
    pub const fn transposed(&self) -> Self {
        Self { width: self.height, height: self.width }
    }
    /// Index of a cell, `y * width + x`.
    #[must_use]
    pub const fn index(&self, cell: Cell) -> usize {
        cell.y * self.width + cell.x
    }
    /// Cell of an index.
    #[must_use]
    pub const fn cell(&self, index: usize) -> Cell {
        Cell { x: index % self.width, y: index / self.width }
    }
    /// Whether the cell lies in the grid.
    #[must_use]
    pub const fn contains(&self, cell: Cell) -> bool {
        cell.x < self.width && cell.y < self.height
    }
    /// Whether the cell lies in the outermost ring.
    #[must_use]
    pub const fn is_border(&self, cell: Cell) -> bool {
        cell.x == 0 || cell.y == 0 || cell.x + 1 >= self.width || cell.y + 1 >= self.height
    }
    /// The cell in the middle; for an even side, the one to the left of or above it.
    #[must_use]
    pub const fn centre(&self) -> Cell {
        Cell { x: (self.width - 1) / 2, y: (self.height - 1) / 2 }
    }
    /// The neighbour in direction `k` (0..8), if it exists.
    #[must_use]
    pub fn neighbour(&self, cell: Cell, k: usize) -> Option<Cell> {
        let (dx, dy) = NEIGHBOUR_OFFSETS[k];
        let next = Cell { x: cell.x.checked_add_signed(dx)?, y: cell.y.checked_add_signed(dy)? };
        self.contains(next).then_some(next)
    }
    /// All cells in row-major order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Cell> + use<> {
        let grid = *self;
        (0..self.cells()).map(move |i| grid.cell(i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_is_towards_row_zero() {
        let g = Grid::new(3, 4).expect("a grid");
        let c = Cell::new(1, 1);
        assert_eq!(g.neighbour(c, 2), Some(Cell::new(1, 0)));
        assert_eq!(g.neighbour(c, 1), Some(Cell::new(2, 0)));
        assert_eq!(g.neighbour(Cell::new(0, 0), 4), None);
        assert_eq!(g.neighbour(Cell::new(2, 3), 7), None);
    }

    #[test]
    fn index_and_cell_are_inverse() {
        let g = Grid::new(5, 3).expect("a grid");
        assert!(g.iter().enumerate().all(|(i, c)| g.index(c) == i && g.cell(i) == c));
    }

    #[test]
    fn impossible_grids_are_refused() {
        for (w, h) in [(0, 3), (3, 0), (usize::MAX, 2), (1 << 20, 1 << 20)] {
            assert_eq!(Grid::new(w, h), Err(CoreError::GridSize { width: w, height: h }));
        }
    }
}
