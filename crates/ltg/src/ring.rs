//! Two rows of solved pulses.

use crate::pass::Pass;
use crate::plan::ROWS;
use std::ops::Range;
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};
use tigereye_transport::{PulseDistribution, Real};

/// A slot for every column and direction of a set, in an even and an odd row.
pub(crate) struct Ring<T> {
    places: Vec<RwLock<PulseDistribution<T>>>,
    columns: Range<usize>,
    directions: usize,
}

impl<T: Real> Ring<T> {
    /// A ring for a pass, which reuses the `spare` distributions.
    pub(crate) fn new(pass: &Pass<'_>, spare: &mut Vec<PulseDistribution<T>>) -> Self {
        let mut dark = || spare.pop().unwrap_or_else(|| PulseDistribution::dark(pass.grid.cells()));
        let directions = pass.set.directions.len();
        let places = (0..ROWS * pass.columns.len() * directions).map(|_| RwLock::new(dark())).collect();
        Self { places, columns: pass.columns.clone(), directions }
    }

    /// Its distributions, for reuse.
    pub(crate) fn into_spare(self) -> impl Iterator<Item = PulseDistribution<T>> {
        self.places.into_iter().map(|p| p.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    fn place(&self, x: usize, y: usize, direction: usize) -> &RwLock<PulseDistribution<T>> {
        let column = y % ROWS * self.columns.len() + x - self.columns.start;
        &self.places[column * self.directions + direction]
    }

    /// The pulse of a cell in the direction at a position of the set.
    pub(crate) fn read(
        &self,
        x: usize,
        y: usize,
        direction: usize,
    ) -> RwLockReadGuard<'_, PulseDistribution<T>> {
        self.place(x, y, direction).read().unwrap_or_else(PoisonError::into_inner)
    }

    /// The same, mutable.
    pub(crate) fn write(
        &self,
        x: usize,
        y: usize,
        direction: usize,
    ) -> RwLockWriteGuard<'_, PulseDistribution<T>> {
        self.place(x, y, direction).write().unwrap_or_else(PoisonError::into_inner)
    }
}
