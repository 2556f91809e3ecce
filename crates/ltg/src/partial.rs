//! Partially finished gradients.
//!
//! The x and y differences of a slice and its angular difference may belong to different sets of directions, which are
//! swept one after the other. A value is therefore kept as the sum of the squared differences that are finished: 0,
//! then `g_x^2 + g_y^2` or `g_w^2`, then both. Addition of two numbers is commutative, so the bits do not depend on the
//! order.

use crate::pass::Pass;
use crate::row::RowResults;
use crate::sets::{DirectionSet, direction_sets};
use crate::settings::check_slices;
use crate::{LtgError, Shard};
use tigereye_core::{Cell, Directions, Grid, LtgVolume, SweepWork};

/// The result of a complete sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct LtgOutcome {
    /// The gradient.
    pub volume: LtgVolume,
    /// Its work.
    pub work: SweepWork,
    /// Number of propagations that ended at the step limit instead of the stopping rule.
    pub limited: u64,
}

/// The numbers of a partial volume.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finished {
    /// Sum of the squared differences finished so far (W^2/rad^2), at `(i * height + y) * width + x` that of slice i.
    pub squares: Vec<f64>,
    /// For each set of directions and each inner cell, row by row, whether its differences are finished.
    pub done: Vec<bool>,
    /// Work of the pulses that belong to finished cells: each counts once in the whole sweep, however it is divided.
    pub work: SweepWork,
    /// Number of these propagations that ended at the step limit.
    pub limited: u64,
}

/// A gradient of which some cells and directions are finished.
#[derive(Clone, Debug, PartialEq)]
pub struct PartialVolume {
    grid: Grid,
    directions: Directions,
    slices: Vec<usize>,
    omega_step: usize,
    sets: Vec<DirectionSet>,
    finished: Finished,
}

impl PartialVolume {
    /// An empty volume of the slices (any order) of a gradient with angular step K.
    ///
    /// # Errors
    /// [`LtgError::OmegaStep`], [`LtgError::NoSlices`], [`LtgError::Slice`].
    pub fn empty(
        grid: Grid,
        directions: Directions,
        slices: Vec<usize>,
        omega_step: usize,
    ) -> Result<Self, LtgError> {
        let mut empty = Self::shaped(grid, directions, slices, omega_step)?;
        empty.finished.squares = vec![0.0; grid.cells() * empty.slices.len()];
        empty.finished.done = vec![false; empty.sets.len() * inner_cells(grid)];
        Ok(empty)
    }

    /// `start`, which must be of this gradient; without it, nothing finished.
    ///
    /// # Errors
    /// As [`Self::empty`], and [`LtgError::Unlike`].
    pub(crate) fn started(
        grid: Grid,
        directions: Directions,
        slices: Vec<usize>,
        omega_step: usize,
        start: Option<Self>,
    ) -> Result<Self, LtgError> {
        let empty = Self::empty(grid, directions, slices, omega_step)?;
        let Some(start) = start else { return Ok(empty) };
        empty.check_like(&start)?;
        Ok(start)
    }

    /// The finished part of an earlier run. Nothing is allocated for sizes that do not fit.
    ///
    /// # Errors
    /// As [`Self::empty`], and [`LtgError::Length`] for lists of other lengths than this gradient's,
    /// [`LtgError::Value`] for values it cannot have.
    pub fn restored(
        grid: Grid,
        directions: Directions,
        slices: Vec<usize>,
        omega_step: usize,
        finished: Finished,
    ) -> Result<Self, LtgError> {
        let mut volume = Self::shaped(grid, directions, slices, omega_step)?;
        let check = |what, found: usize, expected: u128| {
            if found as u128 == expected { Ok(()) } else { Err(LtgError::Length { what, found, expected }) }
        };
        check("values", finished.squares.len(), grid.cells() as u128 * volume.slices.len() as u128)?;
        check("marks", finished.done.len(), volume.sets.len() as u128 * inner_cells(grid) as u128)?;
        let rubbish = |v: &f64| !v.is_finite() || *v < 0.0;
        if let Some(index) = finished.squares.iter().position(rubbish) {
            return Err(LtgError::Value { index, value: finished.squares[index] });
        }
        volume.finished = finished;
        Ok(volume)
    }

    fn shaped(
        grid: Grid,
        directions: Directions,
        mut slices: Vec<usize>,
        omega_step: usize,
    ) -> Result<Self, LtgError> {
        slices.sort_unstable();
        slices.dedup();
        check_slices(directions, &slices, omega_step)?;
        let sets = direction_sets(directions, &slices, omega_step);
        Ok(Self { grid, directions, slices, omega_step, sets, finished: Finished::default() })
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.grid
    }
    /// The angular sampling.
    #[must_use]
    pub const fn directions(&self) -> Directions {
        self.directions
    }
    /// The slices, ascending.
    #[must_use]
    pub fn slices(&self) -> &[usize] {
        &self.slices
    }
    /// The numbers.
    #[must_use]
    pub const fn finished(&self) -> &Finished {
        &self.finished
    }
    /// Number of unfinished cells and sets that belong to `shard`.
    #[must_use]
    pub fn missing(&self, shard: Shard) -> usize {
        self.finished.done[shard.range(self.finished.done.len())].iter().filter(|done| !**done).count()
    }
    /// The shards, out of `count`, with unfinished work, ascending.
    #[must_use]
    pub fn missing_shards(&self, count: usize) -> Vec<usize> {
        let done = &self.finished.done;
        let marks = (0..done.len()).filter(|&mark| !done[mark]);
        let mut shards: Vec<usize> = marks.map(|mark| Shard::holding(mark, done.len(), count)).collect();
        shards.dedup();
        shards
    }

    /// Merges two partial volumes, in either order with the same bits.
    ///
    /// # Errors
    /// [`LtgError::Unlike`] for parts of different gradients, [`LtgError::DoneTwice`].
    pub fn merged(mut self, other: &Self) -> Result<Self, LtgError> {
        self.check_like(other)?;
        let (mine, theirs) = (&mut self.finished, &other.finished);
        let mut twice = (0..mine.done.len()).filter(|&i| mine.done[i] && theirs.done[i]);
        if let Some(first) = twice.next() {
            let count = 1 + twice.count();
            let (direction, Cell { x, y }) = self.place_of(first);
            return Err(LtgError::DoneTwice { x, y, direction, count });
        }
        mine.squares.iter_mut().zip(&theirs.squares).for_each(|(a, b)| *a += b);
        mine.done.iter_mut().zip(&theirs.done).for_each(|(a, b)| *a |= b);
        mine.work.add(theirs.work);
        mine.limited += theirs.limited;
        Ok(self)
    }

    /// The finished gradient.
    ///
    /// # Errors
    /// [`LtgError::Missing`].
    pub fn into_outcome(self) -> Result<LtgOutcome, LtgError> {
        if let Some(first) = self.finished.done.iter().position(|done| !done) {
            let (direction, Cell { x, y }) = self.place_of(first);
            let (count, total) = (self.missing(Shard::WHOLE), self.finished.done.len());
            return Err(LtgError::Missing { x, y, direction, count, total });
        }
        let Finished { mut squares, work, limited, .. } = self.finished;
        squares.iter_mut().for_each(|value| *value = value.sqrt());
        let volume = LtgVolume::new(self.grid, self.directions, self.slices, squares);
        Ok(LtgOutcome { volume, work, limited })
    }

    /// The gradient as far as it is finished: NaN where a difference is missing, 0 on the border as in the finished
    /// one.
    #[must_use]
    pub fn into_partial_volume(self) -> LtgVolume {
        let grid = self.grid;
        let mut values: Vec<f64> = self.finished.squares.iter().map(|square| square.sqrt()).collect();
        for (index, set) in self.sets.iter().enumerate() {
            let lacks =
                |cell: &Cell| !grid.is_border(*cell) && !self.finished.done[mark_of(grid, index, *cell)];
            for cell in grid.iter().filter(lacks) {
                let turned = set.turns.iter().map(|turn| turn.slice);
                for slice in set.slice.iter().flatten().copied().chain(turned) {
                    values[slice * grid.cells() + grid.index(cell)] = f64::NAN;
                }
            }
        }
        LtgVolume::new(grid, self.directions, self.slices, values)
    }

    /// First direction of the set and cell of a mark.
    fn place_of(&self, mark: usize) -> (usize, Cell) {
        let inner = inner_cells(self.grid);
        let (set, cell) = (mark / inner, mark % inner);
        let columns = self.grid.width() - 2;
        (self.sets[set].directions[0], Cell::new(1 + cell % columns, 1 + cell / columns))
    }

    /// Whether `other` belongs to the same gradient.
    pub(crate) fn check_like(&self, other: &Self) -> Result<(), LtgError> {
        let differs = [
            (self.grid != other.grid, "grids"),
            (self.directions != other.directions, "numbers of directions"),
            (self.slices != other.slices, "slices"),
            (self.omega_step != other.omega_step, "angular steps"),
        ];
        match differs.iter().find(|(differs, _)| *differs) {
            Some(&(_, what)) => Err(LtgError::Unlike { what }),
            None => Ok(()),
        }
    }

    pub(crate) fn sets(&self) -> &[DirectionSet] {
        &self.sets
    }

    /// For each cell of the grid whether `shard` has to compute it in a set.
    pub(crate) fn targets(&self, set: usize, shard: Shard) -> Vec<bool> {
        let (done, grid) = (&self.finished.done, self.grid);
        let range = shard.range(done.len());
        let is_target = |cell: Cell| {
            !grid.is_border(cell) && {
                let mark = mark_of(grid, set, cell);
                range.contains(&mark) && !done[mark]
            }
        };
        grid.iter().map(is_target).collect()
    }

    /// For each cell of the grid whether `shard` has to compute it in any set.
    pub(crate) fn all_targets(&self, shard: Shard) -> Vec<bool> {
        let mut all = vec![false; self.grid.cells()];
        for set in 0..self.sets.len() {
            all.iter_mut().zip(self.targets(set, shard)).for_each(|(all, of_set)| *all |= of_set);
        }
        all
    }

    /// Takes the differences (along x, along y, in direction) of each slice at a cell over where `shard` lacks them.
    pub(crate) fn finish_cell(
        &mut self,
        shard: Shard,
        cell: Cell,
        work: SweepWork,
        differences: &dyn Fn(usize) -> [f64; 3],
    ) {
        let (grid, finished) = (self.grid, &mut self.finished);
        let at = |slice: usize| slice * grid.cells() + grid.index(cell);
        let range = shard.range(finished.done.len());
        for (index, set) in self.sets.iter().enumerate() {
            let mark = mark_of(grid, index, cell);
            if !range.contains(&mark) || finished.done[mark] {
                continue;
            }
            for slice in set.slice.iter().flatten() {
                let [g_x, g_y, _] = differences(*slice);
                finished.squares[at(*slice)] += g_x * g_x + g_y * g_y;
            }
            for turn in &set.turns {
                let [_, _, g_w] = differences(turn.slice);
                finished.squares[at(turn.slice)] += g_w * g_w;
            }
            finished.done[mark] = true;
            // Counted with the first set: shards that cut between the sets of a cell solve it twice.
            if index == 0 {
                finished.work.add(work);
            }
        }
    }

    /// Stores the results of a pass for the targets of row `y`.
    pub(crate) fn finish_row(&mut self, pass: &Pass<'_>, y: usize, results: &RowResults) {
        let (grid, finished) = (self.grid, &mut self.finished);
        for x in pass.target_columns(y) {
            let cell = Cell::new(x, y);
            let at = |slice: usize| slice * grid.cells() + grid.index(cell);
            for (place, slice) in pass.set.slice.iter().enumerate() {
                let Some(slice) = *slice else { continue };
                let (g_x, g_y) = (results.along_x.get(place, x), results.along_y.get(place, x));
                finished.squares[at(slice)] += g_x * g_x + g_y * g_y;
            }
            for (i, turn) in pass.set.turns.iter().enumerate() {
                let g_w = results.turned.get(i, x);
                finished.squares[at(turn.slice)] += g_w * g_w;
            }
            finished.done[mark_of(grid, pass.index, cell)] = true;
        }
        let (work, limited) = results.work.total();
        finished.work.add(work);
        finished.limited += limited;
    }
}

/// Number of cells that are not on the border.
fn inner_cells(grid: Grid) -> usize {
    grid.width().saturating_sub(2) * grid.height().saturating_sub(2)
}

/// The index of an inner cell's mark.
fn mark_of(grid: Grid, set: usize, cell: Cell) -> usize {
    set * inner_cells(grid) + (cell.y - 1) * (grid.width() - 2) + cell.x - 1
}
