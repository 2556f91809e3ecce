//! The sweep itself.

use crate::plan::{Group, ROWS, plan};
use crate::{LtgError, LtgSettings};
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use tigereye_core::{Cell, Directions, Grid, LtgVolume, StopReason, SweepWork};
use tigereye_transport::{
    LaneOf, LaneOutcome, PulseBlock, PulseSolver, Scattering, l1_difference, l1_difference_of_lanes,
};

/// What the sweep is busy with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Pulses are being solved.
    Propagation,
    /// Distributions are being compared.
    Difference,
}

/// Somebody who watches a sweep. Called from its threads.
pub trait SweepObserver: Sync {
    /// A phase begins; the one before has ended. Always called from the thread that called [`sweep`].
    fn phase(&self, _phase: Phase) {}
    /// `done` of `total` sources are solved. `Break` ends the sweep at the next source.
    fn progress(&self, _done: u64, _total: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Watches nothing.
impl SweepObserver for () {}

/// What a sweep leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct LtgOutcome {
    /// The gradient.
    pub volume: LtgVolume,
    /// What it cost.
    pub work: SweepWork,
    /// How many propagations met the step limit instead of the stopping rule.
    pub limited: u64,
}

/// Computes the gradient for every cell and the slices of `settings`. Border cells are 0. Runs on rayon's current thread
/// pool; the result does not depend on the number of threads, on the memory bound or on the instruction set.
///
/// # Errors
/// [`LtgError`], before any work except for [`LtgError::Interrupted`].
pub fn sweep(
    field: &Scattering<'_>,
    settings: &LtgSettings,
    observer: &dyn SweepObserver,
) -> Result<LtgOutcome, LtgError> {
    let slices = settings.checked_slices(field.scheme().directions())?;
    // Fewer lanes where a narrow selection would leave most of them empty.
    match slices.len() {
        1 => sweep_lanes::<4>(field, settings, slices, observer),
        _ => sweep_lanes::<8>(field, settings, slices, observer),
    }
}

/// Whether a sweep with these settings can run on rayon's current thread pool, asked before anything large is made.
///
/// # Errors
/// What [`sweep`] would refuse.
pub fn check_fit(grid: Grid, directions: Directions, settings: &LtgSettings) -> Result<(), LtgError> {
    let slices = settings.checked_slices(directions)?;
    let (k, memory, threads) = (settings.omega_step, settings.memory_bytes, rayon::current_num_threads());
    match slices.len() {
        1 => plan::<4>(grid, directions, &slices, k, memory, threads),
        _ => plan::<8>(grid, directions, &slices, k, memory, threads),
    }
    .map(drop)
}

struct Sweep<'a, const N: usize> {
    field: &'a Scattering<'a>,
    settings: &'a LtgSettings,
    slices: &'a [usize],
    observer: &'a dyn SweepObserver,
    solvers: Mutex<Vec<PulseSolver<'a, N>>>,
    done: AtomicU64,
    total: u64,
    interrupted: AtomicBool,
}

/// The three components of the gradient: per slice and cell `[g_x, g_y, g_w]`.
type Components = Vec<[f64; 3]>;

fn sweep_lanes<const N: usize>(
    field: &Scattering<'_>,
    settings: &LtgSettings,
    slices: Vec<usize>,
    observer: &dyn SweepObserver,
) -> Result<LtgOutcome, LtgError> {
    let (grid, directions) = (field.grid(), field.scheme().directions());
    let threads = rayon::current_num_threads();
    let groups = plan::<N>(grid, directions, &slices, settings.omega_step, settings.memory_bytes, threads)?;
    let mut sweep = Sweep::<N> {
        field,
        settings,
        slices: &slices,
        observer,
        solvers: Mutex::new(Vec::new()),
        done: AtomicU64::new(0),
        total: 0,
        interrupted: AtomicBool::new(false),
    };
    sweep.total = groups.iter().map(|g| sweep.sources_of(g)).sum();
    let mut components = vec![[0.0; 3]; grid.cells() * slices.len()];
    let (mut work, mut limited) = (SweepWork::default(), 0);
    for group in &groups {
        let (w, l) = sweep.run_group(group, &mut components)?;
        work.add(w);
        limited += l;
    }
    let values = components.iter().map(|[x, y, w]| (x * x + y * y + w * w).sqrt()).collect();
    drop(sweep);
    Ok(LtgOutcome { volume: LtgVolume::new(grid, directions, slices, values), work, limited })
}

impl<'a, const N: usize> Sweep<'a, N> {
    /// Whether the distribution of a pulse at `cell` in direction `t` is compared with anything in `group`.
    fn is_needed(&self, group: &Group, cell: Cell, t: usize) -> bool {
        let grid = self.field.grid();
        let inside = group.columns.contains(&cell.x);
        let inner_row = cell.y > 0 && cell.y + 1 < grid.height();
        let in_slices = self.slices.binary_search(&t).is_ok();
        // Neighbours in x and y are compared within a slice, directions only at inner cells.
        (in_slices && (inside || inner_row)) || (inside && inner_row)
    }

    fn sources_of(&self, group: &Group) -> u64 {
        let rows = 0..self.field.grid().height();
        let cells = rows.flat_map(|y| solved_columns(group).map(move |x| Cell::new(x, y)));
        cells.map(|c| group.directions.iter().filter(|&&t| self.is_needed(group, c, t)).count() as u64).sum()
    }

    fn run_group(&self, group: &Group, components: &mut Components) -> Result<(SweepWork, u64), LtgError> {
        let grid = self.field.grid();
        let batches = group.directions.len().div_ceil(N);
        let columns = solved_columns(group).len();
        let mut rows: [Vec<PulseBlock<N>>; ROWS] = std::array::from_fn(|_| Vec::new());
        let (mut work, mut limited) = (SweepWork::default(), 0);
        for y in 0..grid.height() {
            self.observer.phase(Phase::Propagation);
            let row = &mut rows[y % ROWS];
            if row.is_empty() {
                row.resize_with(columns * batches, || PulseBlock::dark(grid.cells()));
            }
            let (row_work, row_limited) = self.solve_row(group, y, row)?;
            work.add(row_work);
            limited += row_limited;
            self.observer.phase(Phase::Difference);
            if y >= 1 && y + 1 < grid.height() {
                self.difference_in_row(group, y, &rows[y % ROWS], components);
            }
            if y >= 2 {
                self.difference_across_rows(group, y - 1, &rows[y % ROWS], &rows[(y + 1) % ROWS], components);
            }
        }
        Ok((work, limited))
    }

    /// Solves every pulse of row `y` that is needed.
    fn solve_row(
        &self,
        group: &Group,
        y: usize,
        row: &mut [PulseBlock<N>],
    ) -> Result<(SweepWork, u64), LtgError> {
        let batches = group.directions.len().div_ceil(N);
        let first = group.columns.start - 1;
        let outcomes: Vec<(SweepWork, u64)> = row
            .par_iter_mut()
            .enumerate()
            .map(|(i, block)| {
                let cell = Cell::new(first + i / batches, y);
                self.solve_batch(group, cell, i % batches, block)
            })
            .collect();
        if self.interrupted.load(Ordering::Relaxed) {
            return Err(LtgError::Interrupted { done: self.done.load(Ordering::Relaxed), total: self.total });
        }
        let mut work = SweepWork::default();
        let mut limited = 0;
        for (w, l) in outcomes {
            work.add(w);
            limited += l;
        }
        Ok((work, limited))
    }

    /// Solves one batch of directions at one cell.
    fn solve_batch(
        &self,
        group: &Group,
        cell: Cell,
        batch: usize,
        block: &mut PulseBlock<N>,
    ) -> (SweepWork, u64) {
        let samples = batch_samples::<N>(group, batch);
        let lanes = (group.directions.len() - batch * N).min(N);
        let needed: [bool; N] = std::array::from_fn(|l| l < lanes && self.is_needed(group, cell, samples[l]));
        if needed.iter().all(|n| !n) || self.interrupted.load(Ordering::Relaxed) {
            return (SweepWork::default(), 0);
        }
        let mut solver = self.take_solver();
        let outcomes = solver.solve(cell, samples, &self.settings.stopping, block);
        self.put_solver(solver);
        let (work, limited) = counted(&outcomes, &needed);
        let done = self.done.fetch_add(work.sources, Ordering::Relaxed) + work.sources;
        if self.observer.progress(done, self.total).is_break() {
            self.interrupted.store(true, Ordering::Relaxed);
        }
        (work, limited)
    }

    fn take_solver(&self) -> PulseSolver<'a, N> {
        let waiting = self.solvers.lock().ok().and_then(|mut s| s.pop());
        waiting.unwrap_or_else(|| PulseSolver::new(self.field, self.settings.level))
    }

    fn put_solver(&self, solver: PulseSolver<'a, N>) {
        if let Ok(mut solvers) = self.solvers.lock() {
            solvers.push(solver);
        }
    }

    /// `g_x` and `g_w` of the inner cells of row `y`.
    fn difference_in_row(&self, group: &Group, y: usize, row: &[PulseBlock<N>], components: &mut Components) {
        let batches = group.directions.len().div_ceil(N);
        let found: Vec<Vec<(usize, usize, f64)>> = group
            .columns
            .clone()
            .into_par_iter()
            .map(|x| {
                let i = (x + 1 - group.columns.start) * batches;
                let mut found = Vec::new();
                for batch in 0..batches {
                    let (right, left) = (&row[i + batches + batch], &row[i - batches + batch]);
                    self.along_axis(group, batch, 0, left, right, &mut found);
                }
                let here: Vec<&PulseBlock<N>> = row[i..i + batches].iter().collect();
                self.along_direction(group, &here, &mut found);
                found
            })
            .collect();
        self.store(group, y, &found, components);
    }

    /// `g_y` of the inner cells of row `y` from the rows below and above it.
    fn difference_across_rows(
        &self,
        group: &Group,
        y: usize,
        below: &[PulseBlock<N>],
        above: &[PulseBlock<N>],
        components: &mut Components,
    ) {
        let batches = group.directions.len().div_ceil(N);
        let found: Vec<Vec<(usize, usize, f64)>> = group
            .columns
            .clone()
            .into_par_iter()
            .map(|x| {
                let i = (x + 1 - group.columns.start) * batches;
                let mut found = Vec::new();
                for batch in 0..batches {
                    self.along_axis(group, batch, 1, &above[i + batch], &below[i + batch], &mut found);
                }
                found
            })
            .collect();
        self.store(group, y, &found, components);
    }

    /// Half the L1 difference of two cells' pulses for each direction of a batch that is a slice: (slice index,
    /// component, value).
    fn along_axis(
        &self,
        group: &Group,
        batch: usize,
        component: usize,
        a: &PulseBlock<N>,
        b: &PulseBlock<N>,
        found: &mut Vec<(usize, usize, f64)>,
    ) {
        let directions = &group.directions[batch * N..((batch + 1) * N).min(group.directions.len())];
        if !directions.iter().any(|t| self.slices.binary_search(t).is_ok()) {
            return;
        }
        let l1 = l1_difference(self.field, self.settings.level, a, b);
        for (l, t) in directions.iter().enumerate() {
            if let Ok(slice) = self.slices.binary_search(t) {
                found.push((slice, component, 0.5 * l1[l]));
            }
        }
    }

    /// Half the L1 difference of the directions t+K and t-K at one cell for every slice t whose partners are in the group.
    fn along_direction(&self, group: &Group, here: &[&PulseBlock<N>], found: &mut Vec<(usize, usize, f64)>) {
        let s = self.field.scheme().directions().count();
        let k = self.settings.omega_step;
        let place = |t: usize| {
            let i = group.directions.binary_search(&(t % s)).ok()?;
            Some(LaneOf { block: i / N, lane: i % N })
        };
        let pairs: Vec<(usize, (LaneOf, LaneOf))> = (self.slices.iter().enumerate())
            .filter_map(|(slice, &t)| Some((slice, (place(t + k)?, place(t + s - k)?))))
            .collect();
        for chunk in pairs.chunks(N) {
            let lanes = std::array::from_fn(|l| chunk[l.min(chunk.len() - 1)].1);
            let l1 = l1_difference_of_lanes(self.field, self.settings.level, here, &lanes);
            for (l, (slice, _)) in chunk.iter().enumerate() {
                found.push((*slice, 2, 0.5 * l1[l]));
            }
        }
    }

    fn store(
        &self,
        group: &Group,
        y: usize,
        found: &[Vec<(usize, usize, f64)>],
        components: &mut Components,
    ) {
        let grid: Grid = self.field.grid();
        for (x, values) in group.columns.clone().zip(found) {
            for &(slice, component, value) in values {
                components[slice * grid.cells() + y * grid.width() + x][component] = value;
            }
        }
    }
}

/// The columns whose pulses a group solves: its own and one on each side.
fn solved_columns(group: &Group) -> std::ops::Range<usize> {
    group.columns.start - 1..group.columns.end + 1
}

fn batch_samples<const N: usize>(group: &Group, batch: usize) -> [usize; N] {
    let last = group.directions.len() - 1;
    std::array::from_fn(|l| group.directions[(batch * N + l).min(last)])
}

/// Work of the lanes that were asked for.
fn counted<const N: usize>(outcomes: &[LaneOutcome; N], needed: &[bool; N]) -> (SweepWork, u64) {
    let (mut work, mut limited) = (SweepWork::default(), 0);
    for (o, _) in outcomes.iter().zip(needed).filter(|(_, needed)| **needed) {
        work.sources += 1;
        work.iterations_total += o.work.steps as u64;
        work.iterations_max = work.iterations_max.max(o.work.steps as u64);
        work.cell_updates += o.work.cell_updates;
        limited += u64::from(o.stop == StopReason::StepLimit);
    }
    (work, limited)
}
