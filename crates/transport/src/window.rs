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
    /// The smallest window around `cells`.
    pub(crate) fn around(cells: impl IntoIterator<Item = Cell>) -> Option<Self> {
        cells.into_iter().fold(None, |window, c| {
            let w = window.unwrap_or(Self { x0: c.x, x1: c.x, y0: c.y, y1: c.y });
            Some(Self { x0: w.x0.min(c.x), x1: w.x1.max(c.x), y0: w.y0.min(c.y), y1: w.y1.max(c.y) })
        })
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
