//! The rectangle that light has reached.

use tigereye_core::{Cell, Grid};

/// Columns `x0..=x1`, rows `y0..=y1` that may hold light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) x0: usize,
    pub(crate) x1: usize,
    pub(crate) y0: usize,
    pub(crate) y1: usize,
}

impl Window {
    /// One cell.
    pub(crate) const fn of(cell: Cell) -> Self {
        Self { x0: cell.x, x1: cell.x, y0: cell.y, y1: cell.y }
    }
    /// The smallest window around `cells`.
    pub(crate) fn around(cells: impl IntoIterator<Item = Cell>) -> Option<Self> {
        cells.into_iter().map(Self::of).reduce(Self::union)
    }
    /// The smallest window around two.
    pub(crate) fn union(self, other: Self) -> Self {
        Self {
            x0: self.x0.min(other.x0),
            x1: self.x1.max(other.x1),
            y0: self.y0.min(other.y0),
            y1: self.y1.max(other.y1),
        }
    }
    /// The window one step later: light moves one cell a step.
    pub(crate) fn grown(self, grid: Grid) -> Self {
        Self {
            x0: self.x0.saturating_sub(1),
            x1: (self.x1 + 1).min(grid.width() - 1),
            y0: self.y0.saturating_sub(1),
            y1: (self.y1 + 1).min(grid.height() - 1),
        }
    }
    pub(crate) const fn cells(&self) -> u64 {
        ((self.x1 - self.x0 + 1) * (self.y1 - self.y0 + 1)) as u64
    }
}
