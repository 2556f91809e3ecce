//! One pass over the grid: a set of directions in a strip of columns, and its unfinished cells.

use crate::sets::DirectionSet;
use std::ops::Range;
use tigereye_core::{Cell, Grid};

/// One pass.
pub(crate) struct Pass<'a> {
    pub(crate) grid: Grid,
    /// Index of the set.
    pub(crate) index: usize,
    pub(crate) set: &'a DirectionSet,
    /// Columns whose pulses may be solved: those of the strip and one on each side.
    pub(crate) columns: Range<usize>,
    /// For each cell whether its differences are requested.
    targets: Vec<bool>,
    /// For each row whether there is any such cell.
    rows: Vec<bool>,
}

/// Pulses of a cell that a pass solves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Wanted {
    /// Pulses of the slices.
    pub(crate) slices: bool,
    /// Pulses of angular differences.
    pub(crate) partners: bool,
    /// Whether their work is counted here: every pulse belongs to one inner cell, its own or the nearest one.
    pub(crate) counted: bool,
}

impl<'a> Pass<'a> {
    /// A pass over the inner columns `strip`; `targets` as for the whole grid.
    pub(crate) fn new(
        grid: Grid,
        (index, set): (usize, &'a DirectionSet),
        strip: &Range<usize>,
        mut targets: Vec<bool>,
    ) -> Self {
        let width = grid.width();
        for row in targets.chunks_mut(width) {
            row[..strip.start].fill(false);
            row[strip.end..].fill(false);
        }
        let rows = targets.chunks(width).map(|row| row.contains(&true)).collect();
        Self { grid, index, set, columns: strip.start - 1..strip.end + 1, targets, rows }
    }

    /// Whether the differences of a cell are requested.
    pub(crate) fn is_target(&self, x: usize, y: usize) -> bool {
        self.targets[y * self.grid.width() + x]
    }

    /// The columns of a row whose differences are requested.
    pub(crate) fn target_columns(&self, y: usize) -> impl Iterator<Item = usize> + '_ {
        self.columns.clone().filter(move |&x| self.is_target(x, y))
    }

    /// Whether a row has cells whose differences are requested.
    pub(crate) fn has_targets(&self, y: usize) -> bool {
        self.rows[y]
    }

    /// The rows in which there may be something to solve, ascending.
    pub(crate) fn solved_rows(&self) -> impl Iterator<Item = usize> + '_ {
        let is_wanted =
            |&y: &usize| self.rows[y.saturating_sub(1)..(y + 2).min(self.rows.len())].contains(&true);
        (0..self.rows.len()).filter(is_wanted)
    }

    /// Pulses of a cell that a requested difference needs, or that are counted here.
    pub(crate) fn wanted(&self, cell: Cell) -> Wanted {
        let neighbours = [0, 2, 4, 6].map(|k| self.grid.neighbour(cell, k));
        let any = |test: &dyn Fn(Cell) -> bool| neighbours.iter().flatten().any(|&n| test(n));
        let own = self.is_target(cell.x, cell.y);
        Wanted {
            // A slice's pulse is used only by the differences of neighbouring cells. Even if none of them is requested
            // here, it counts as work of this cell.
            slices: any(&|n| self.is_target(n.x, n.y)) || own && any(&|n| !self.grid.is_border(n)),
            partners: own,
            counted: self
                .is_target(cell.x.clamp(1, self.grid.width() - 2), cell.y.clamp(1, self.grid.height() - 2)),
        }
    }

    /// Whether the pulse in the direction at `place` is among those requested.
    pub(crate) fn is_wanted(&self, wanted: Wanted, place: usize) -> bool {
        wanted.slices && self.set.slice[place].is_some() || wanted.partners && self.set.is_partner[place]
    }

    /// Number of pulses to solve.
    pub(crate) fn sources(&self) -> u64 {
        let places = 0..self.set.directions.len();
        let of_cell = |wanted| places.clone().filter(|&p| self.is_wanted(wanted, p)).count() as u64;
        let counts = [(false, false), (false, true), (true, false), (true, true)]
            .map(|(slices, partners)| of_cell(Wanted { slices, partners, counted: false }));
        let cells = self.solved_rows().flat_map(|y| self.columns.clone().map(move |x| Cell::new(x, y)));
        cells
            .map(|cell| {
                let wanted = self.wanted(cell);
                counts[2 * usize::from(wanted.slices) + usize::from(wanted.partners)]
            })
            .sum()
    }
}
