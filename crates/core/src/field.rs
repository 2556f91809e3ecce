//! A value per cell.

use crate::{Cell, CoreError, Grid, Tensor2};

/// One `T` per cell of a grid, row-major, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<T> {
    grid: Grid,
    values: Vec<T>,
}

impl<T> Field<T> {
    /// A field from its values in row-major order.
    ///
    /// # Errors
    /// [`CoreError::ValueCount`] unless there is one value per cell.
    pub fn from_values(grid: Grid, values: Vec<T>) -> Result<Self, CoreError> {
        if values.len() == grid.cells() {
            Ok(Self { grid, values })
        } else {
            Err(CoreError::ValueCount { values: values.len(), width: grid.width(), height: grid.height() })
        }
    }

    /// A field whose value at each cell is computed from it.
    pub fn from_fn(grid: Grid, value: impl FnMut(Cell) -> T) -> Self {
        Self { grid, values: grid.iter().map(value).collect() }
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.grid
    }
    /// All values in row-major order.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }
    /// All values in row-major order, to change.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }
    /// The value at `cell`. Panics if the cell lies outside the grid.
    #[must_use]
    pub fn at(&self, cell: Cell) -> &T {
        assert!(self.grid.contains(cell), "cell {cell:?} outside {:?}", self.grid);
        &self.values[self.grid.index(cell)]
    }
    /// A field on the same grid with `f` applied to every value.
    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Field<U> {
        Field { grid: self.grid, values: self.values.iter().map(f).collect() }
    }
    /// Cells with their values in row-major order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (Cell, &T)> {
        self.grid.iter().zip(&self.values)
    }
}

impl Field<Tensor2> {
    /// The first cell in row-major order with a component that is not finite.
    #[must_use]
    pub fn first_non_finite(&self) -> Option<Cell> {
        self.iter().find(|(_, t)| !t.is_finite()).map(|(c, _)| c)
    }

    /// The field rotated by a quarter turn counter-clockwise, cells and tensors together.
    #[must_use]
    pub fn quarter_turned(&self) -> Self {
        let w = self.grid.width();
        let grid = self.grid.transposed();
        // The new cell (x, y) shows what lay at (w-1-y, x).
        Self::from_fn(grid, |c| self.at(Cell::new(w - 1 - c.y, c.x)).quarter_turned())
    }

    /// The field mirrored top to bottom, cells and tensors together.
    #[must_use]
    pub fn mirrored_y(&self) -> Self {
        let h = self.grid.height();
        Self::from_fn(self.grid, |c| self.at(Cell::new(c.x, h - 1 - c.y)).mirrored_y())
    }

    /// The field mirrored left to right, cells and tensors together.
    #[must_use]
    pub fn mirrored_x(&self) -> Self {
        let w = self.grid.width();
        // Mirroring x is mirroring y and turning by 180 degrees; tensors do not see the half turn.
        Self::from_fn(self.grid, |c| self.at(Cell::new(w - 1 - c.x, c.y)).mirrored_y())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_counts_are_refused() {
        let g = Grid::new(2, 2).expect("a grid");
        assert_eq!(
            Field::from_values(g, vec![0.0; 3]),
            Err(CoreError::ValueCount { values: 3, width: 2, height: 2 })
        );
    }

    #[test]
    fn quarter_turn_moves_right_to_top() {
        let g = Grid::new(3, 2).expect("a grid");
        let f = Field::from_fn(g, |c| Tensor2::symmetric(c.x as f64, 0.5, c.y as f64));
        let t = f.quarter_turned();
        assert_eq!((t.grid().width(), t.grid().height()), (2, 3));
        // The right end of the top row becomes the top of the left column.
        assert_eq!(*t.at(Cell::new(0, 0)), f.at(Cell::new(2, 0)).quarter_turned());
        let four = t.quarter_turned().quarter_turned().quarter_turned();
        assert_eq!(four, f);
    }
}
