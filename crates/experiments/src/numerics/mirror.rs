//! Symmetries of the square.

use serde::Deserialize;
use tigereye_core::{Cell, Grid};

/// A symmetry of the square.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum Mirror {
    /// Left and right exchanged.
    LeftRight,
    /// Top and bottom exchanged.
    TopBottom,
    /// Rotated by 90 degrees.
    QuarterTurn,
    /// Rotated by 180 degrees.
    HalfTurn,
}

impl Mirror {
    /// Where a cell goes; `None` where the grid does not have it.
    pub(crate) fn cell(self, grid: Grid, c: Cell) -> Option<Cell> {
        let (w, h) = (grid.width(), grid.height());
        match self {
            Self::LeftRight => Some(Cell::new(w - 1 - c.x, c.y)),
            Self::TopBottom => Some(Cell::new(c.x, h - 1 - c.y)),
            Self::HalfTurn => Some(Cell::new(w - 1 - c.x, h - 1 - c.y)),
            // Counter-clockwise: the right end of a row goes to the top of a column.
            Self::QuarterTurn => (w == h).then(|| Cell::new(c.y, w - 1 - c.x)),
        }
    }

    /// Where a sample of `s` directions goes.
    pub(crate) const fn sample(self, t: usize, s: usize) -> usize {
        match self {
            Self::LeftRight => (s + s / 2 - t) % s,
            Self::TopBottom => (s - t) % s,
            Self::HalfTurn => (t + s / 2) % s,
            Self::QuarterTurn => (t + s / 4) % s,
        }
    }
}
