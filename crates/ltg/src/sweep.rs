//! The sweep itself.
//!
//! For each set of directions and each strip of columns it runs down the grid. A pulse of row y is compared with that
//! of row y-2, which it then replaces; a difference in x or in direction is taken when the second of its two pulses is
//! ready. Every pulse is thus compared while it is in memory, and each difference has its own slot, so the result does
//! not depend on the number of threads or on the tiles.
//!
//! Pulses in the lanes of one batch wait for the last one to stop. A cell's directions are therefore ordered by the
//! number of steps they took one row above, and divided into batches in that order.

use crate::observer::{Phase, SweepObserver};
use crate::partial::{LtgOutcome, PartialVolume};
use crate::pass::Pass;
use crate::plan::{self, Bounds};
use crate::ring::Ring;
use crate::row::RowResults;
use crate::{LtgError, LtgSettings, Precision, Shard};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use tigereye_core::{Cell, Directions, Grid};
use tigereye_transport::{PulseDistribution, PulseSolver, Real, Scattering, l1_difference};

/// Computes the gradient for every cell and the slices of `settings`. Border cells are 0. Runs on rayon's current
/// thread pool; the result does not depend on the number of threads, on the memory bound or on the instruction set.
///
/// # Errors
/// [`LtgError`], before any work except for [`LtgError::Interrupted`].
pub fn sweep(
    field: &Scattering<'_>,
    settings: &LtgSettings,
    observer: &dyn SweepObserver,
) -> Result<LtgOutcome, LtgError> {
    sweep_part(field, settings, Shard::WHOLE, None, observer)?.into_outcome()
}

/// Computes the part of the gradient that belongs to `shard` and is missing in `start`, the result of an earlier run.
/// The values and counters are those of an undivided sweep, regardless of interruptions and of the division.
///
/// # Errors
/// [`LtgError`], before any work except for [`LtgError::Interrupted`]; the observer has then received all finished
/// work.
pub fn sweep_part(
    field: &Scattering<'_>,
    settings: &LtgSettings,
    shard: Shard,
    start: Option<PartialVolume>,
    observer: &dyn SweepObserver,
) -> Result<PartialVolume, LtgError> {
    let (grid, directions) = (field.grid(), field.scheme().directions());
    let slices = settings.checked_slices(directions)?;
    check_fit(grid, directions, walls_of(field), settings)?;
    let volume = PartialVolume::started(grid, directions, slices, settings.omega_step, start)?;
    match settings.precision {
        Precision::F64 => run::<f64>(field, settings, shard, volume, observer),
        Precision::F32 => run::<f32>(field, settings, shard, volume, observer),
    }
}

/// Whether a sweep with these settings can run on rayon's current thread pool, before anything large is allocated.
/// `walls` is the number of reflecting cells.
///
/// # Errors
/// As [`sweep`].
pub fn check_fit(
    grid: Grid,
    directions: Directions,
    walls: usize,
    settings: &LtgSettings,
) -> Result<(), LtgError> {
    let slices = settings.checked_slices(directions)?;
    let bounds = bounds(settings, walls);
    match settings.precision {
        Precision::F64 => plan::check::<f64>(grid, directions, &slices, settings.omega_step, bounds),
        Precision::F32 => plan::check::<f32>(grid, directions, &slices, settings.omega_step, bounds),
    }
}

/// What a shard of a sweep takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needs {
    /// Sources it solves, those at its rim among them, which its neighbours solve, too.
    pub sources: u64,
    /// Bytes it allocates with the strips that fit into the bound.
    pub bytes: u128,
}

/// What `shard` takes on rayon's current thread pool, before anything is computed.
///
/// # Errors
/// As [`sweep`].
pub fn needs(field: &Scattering<'_>, settings: &LtgSettings, shard: Shard) -> Result<Needs, LtgError> {
    match settings.precision {
        Precision::F64 => needs_of::<f64>(field, settings, shard),
        Precision::F32 => needs_of::<f32>(field, settings, shard),
    }
}

fn needs_of<T: Real>(
    field: &Scattering<'_>,
    settings: &LtgSettings,
    shard: Shard,
) -> Result<Needs, LtgError> {
    let (grid, directions) = (field.grid(), field.scheme().directions());
    let slices = settings.checked_slices(directions)?;
    let bounds = bounds(settings, walls_of(field));
    let volume = PartialVolume::empty(grid, directions, slices, settings.omega_step)?;
    let sets = volume.sets();
    let strips = plan::strips::<T>(grid, directions, sets, volume.slices().len(), bounds)?;
    let mut sources = 0;
    for (index, strips) in strips.iter().enumerate() {
        let targets = volume.targets(index, shard);
        let of_strip = |strip| Pass::new(grid, (index, &sets[index]), strip, targets.clone()).sources();
        sources += strips.iter().map(of_strip).sum::<u64>();
    }
    let bytes = plan::bytes::<T>(grid, directions, sets, &strips, volume.slices().len(), bounds);
    Ok(Needs { sources, bytes })
}

fn walls_of(field: &Scattering<'_>) -> usize {
    field.transmission().reflections().count()
}

fn bounds(settings: &LtgSettings, walls: usize) -> Bounds {
    Bounds {
        memory_bytes: settings.memory_bytes,
        threads: rayon::current_num_threads(),
        stopping: settings.stopping,
        walls,
    }
}

fn run<T: Real>(
    field: &Scattering<'_>,
    settings: &LtgSettings,
    shard: Shard,
    mut volume: PartialVolume,
    observer: &dyn SweepObserver,
) -> Result<PartialVolume, LtgError> {
    let grid = field.grid();
    let sets = volume.sets().to_vec();
    let strips = plan::strips::<T>(
        grid,
        volume.directions(),
        &sets,
        volume.slices().len(),
        bounds(settings, walls_of(field)),
    )?;
    let passes: Vec<(usize, &Range<usize>)> =
        strips.iter().enumerate().flat_map(|(set, strips)| strips.iter().map(move |s| (set, s))).collect();
    let pass = |(set, strip): (usize, &Range<usize>), volume: &PartialVolume| {
        Pass::new(grid, (set, &sets[set]), strip, volume.targets(set, shard))
    };
    let before = volume.finished().work.sources;
    let sweep = Sweep::<T> {
        field,
        settings,
        observer,
        workers: Mutex::new(Vec::new()),
        done: AtomicU64::new(before),
        total: before + passes.iter().map(|&p| pass(p, &volume).sources()).sum::<u64>(),
        interrupted: AtomicBool::new(false),
        skipped: AtomicBool::new(false),
    };
    let mut spare = Vec::new();
    for p in passes {
        let pass = pass(p, &volume);
        let ring = Ring::new(&pass, &mut spare);
        sweep.run_pass(&pass, &ring, &mut volume)?;
        spare.extend(ring.into_spare());
    }
    Ok(volume)
}

struct Sweep<'a, T> {
    field: &'a Scattering<'a>,
    settings: &'a LtgSettings,
    observer: &'a dyn SweepObserver,
    workers: Mutex<Vec<Worker<'a, T>>>,
    done: AtomicU64,
    total: u64,
    /// The observer ended the sweep.
    interrupted: AtomicBool,
    /// Some pulses were not solved because of that.
    skipped: AtomicBool,
}

/// The buffers of a thread for solving a batch.
struct Worker<'a, T> {
    solver: PulseSolver<'a, T>,
    scratch: Vec<PulseDistribution<T>>,
}

/// A row under computation.
struct Row<'r, T> {
    pass: &'r Pass<'r>,
    ring: &'r Ring<T>,
    y: usize,
    here: &'r RowResults,
    above: &'r RowResults,
    /// The row whose work it counts as: border rows count for the rows inside.
    owner: &'r RowResults,
    /// Number of ready pulses, out of two, of each difference, by column and position of the direction or the angular
    /// difference.
    ready_beside: Vec<AtomicUsize>,
    ready_turned: Vec<AtomicUsize>,
    /// Steps of each pulse, by column and position.
    steps: Vec<AtomicUsize>,
}

/// Pulses that are propagated together: a column and positions of directions.
type Batch = (usize, Vec<usize>);

impl<'a, T: Real> Sweep<'a, T> {
    fn run_pass(&self, pass: &Pass<'_>, ring: &Ring<T>, volume: &mut PartialVolume) -> Result<(), LtgError> {
        let mut results = [RowResults::new(pass), RowResults::new(pass)];
        let places = pass.set.directions.len();
        let mut orders: Vec<Vec<usize>> = vec![(0..places).collect(); pass.columns.len()];
        for y in pass.solved_rows() {
            self.run_row(pass, ring, y, &results, &mut orders);
            if self.skipped.load(Ordering::Relaxed) {
                // The sweep ends anyway, whatever the observer answers now.
                let _ = self.observer.finished(volume);
                let done = self.done.load(Ordering::Relaxed);
                return Err(LtgError::Interrupted { done, total: self.total });
            }
            let Some(above) = y.checked_sub(1).filter(|&above| pass.has_targets(above)) else { continue };
            volume.finish_row(pass, above, &results[above % 2]);
            results[above % 2] = RowResults::new(pass);
            if self.observer.finished(volume).is_break() {
                self.interrupted.store(true, Ordering::Relaxed);
            }
        }
        Ok(())
    }

    /// Solves row `y` and takes all differences that become possible. `orders` holds each column's directions by the
    /// number of steps they took: in the row above before the call, in this row afterwards.
    fn run_row(
        &self,
        pass: &Pass<'_>,
        ring: &Ring<T>,
        y: usize,
        results: &[RowResults; 2],
        orders: &mut [Vec<usize>],
    ) {
        let (places, turns) = (pass.set.directions.len(), pass.set.turns.len());
        let counters = |n: usize| (0..n * pass.columns.len()).map(|_| AtomicUsize::new(0)).collect();
        let row = Row {
            pass,
            ring,
            y,
            here: &results[y % 2],
            above: &results[(y + 1) % 2],
            owner: &results[y.clamp(1, pass.grid.height() - 2) % 2],
            ready_beside: counters(places),
            ready_turned: counters(turns),
            steps: counters(places),
        };
        let batches: Vec<Batch> =
            pass.columns.clone().zip(&*orders).flat_map(|(x, order)| row.batches(x, order)).collect();
        batches.par_iter().with_max_len(1).for_each(|(x, places)| {
            self.run_batch(&row, *x, places);
            self.observer.busy(None);
        });
        for (order, steps) in orders.iter_mut().zip(row.steps.chunks(places)) {
            order.sort_by_key(|&place| steps[place].load(Ordering::Relaxed));
        }
    }

    /// Solves one batch at one cell, replaces the pulses two rows above, and takes every difference whose other pulse
    /// is ready.
    fn run_batch(&self, row: &Row<'_, T>, x: usize, places: &[usize]) {
        if self.interrupted.load(Ordering::Relaxed) {
            self.skipped.store(true, Ordering::Relaxed);
            return;
        }
        let (pass, set) = (row.pass, row.pass.set);
        let samples: Vec<usize> = places.iter().map(|&place| set.directions[place]).collect();
        let mut worker = self.take_worker();
        self.observer.busy(Some(Phase::Propagation));
        let cell = Cell::new(x, row.y);
        let scratch = &mut worker.scratch[..places.len()];
        let outcomes = worker.solver.solve(cell, &samples, &self.settings.stopping, scratch);
        if pass.wanted(cell).counted {
            row.owner.work.add(&outcomes);
        }
        self.observer.busy(Some(Phase::Difference));
        let compared = row.y > 0 && pass.is_target(x, row.y - 1);
        for ((solved, outcome), &place) in scratch.iter_mut().zip(outcomes).zip(places) {
            row.steps[row.at(x, place)].store(outcome.work.steps, Ordering::Relaxed);
            let mut two_above = row.ring.write(x, row.y, place);
            if compared && set.slice[place].is_some() {
                row.above.along_y.set(place, x, self.half_difference(&two_above, solved));
            }
            std::mem::swap(&mut *two_above, solved);
            drop(two_above);
            self.compare_beside(row, x, place);
            self.compare_turned(row, x, place);
        }
        self.put_worker(worker);
        let solved = places.len() as u64;
        let done = self.done.fetch_add(solved, Ordering::Relaxed) + solved;
        if self.observer.progress(done, self.total).is_break() {
            self.interrupted.store(true, Ordering::Relaxed);
        }
    }

    /// `g_x` at the cells on both sides of a ready pulse, if the pulse beyond is also ready.
    fn compare_beside(&self, row: &Row<'_, T>, x: usize, place: usize) {
        if row.pass.set.slice[place].is_none() {
            return;
        }
        for centre in [x.wrapping_sub(1), x + 1] {
            if row.pass.columns.contains(&centre)
                && row.pass.is_target(centre, row.y)
                && row.ready_beside[row.at(centre, place)].fetch_add(1, Ordering::AcqRel) == 1
            {
                let (left, right) =
                    (row.ring.read(centre - 1, row.y, place), row.ring.read(centre + 1, row.y, place));
                row.here.along_x.set(place, centre, self.half_difference(&left, &right));
            }
        }
    }

    /// `g_w` for the angular differences of a ready pulse, if the other pulse is also ready.
    fn compare_turned(&self, row: &Row<'_, T>, x: usize, place: usize) {
        if !row.pass.is_target(x, row.y) {
            return;
        }
        let turns = &row.pass.set.turns;
        for (i, turn) in turns.iter().enumerate().filter(|(_, turn)| turn.places.contains(&place)) {
            let ready = &row.ready_turned[(x - row.pass.columns.start) * turns.len() + i];
            // For K = S/2 both directions are the same pulse.
            let pulses = if turn.places[0] == turn.places[1] { 1 } else { 2 };
            if ready.fetch_add(1, Ordering::AcqRel) + 1 == pulses {
                let [before, after] = turn.places.map(|place| row.ring.read(x, row.y, place));
                row.here.turned.set(i, x, self.half_difference(&before, &after));
            }
        }
    }

    fn half_difference(&self, a: &PulseDistribution<T>, b: &PulseDistribution<T>) -> f64 {
        0.5 * l1_difference(self.field, self.settings.level, a, b)
    }

    fn take_worker(&self) -> Worker<'a, T> {
        let waiting = self.workers.lock().unwrap_or_else(PoisonError::into_inner).pop();
        waiting.unwrap_or_else(|| {
            let dark = || PulseDistribution::dark(self.field.grid().cells());
            Worker {
                solver: PulseSolver::new(self.field, self.settings.level),
                scratch: (0..T::LANES).map(|_| dark()).collect(),
            }
        })
    }

    fn put_worker(&self, worker: Worker<'a, T>) {
        self.workers.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
    }
}

impl<T> Row<'_, T> {
    /// Index by column and position.
    const fn at(&self, x: usize, place: usize) -> usize {
        (x - self.pass.columns.start) * self.pass.set.directions.len() + place
    }

    /// The requested pulses of column `x` in batches, in the given order of positions.
    fn batches(&self, x: usize, order: &[usize]) -> Vec<Batch>
    where
        T: Real,
    {
        let wanted = self.pass.wanted(Cell::new(x, self.y));
        let places: Vec<usize> =
            order.iter().copied().filter(|&place| self.pass.is_wanted(wanted, place)).collect();
        places.chunks(T::LANES).map(|places| (x, places.to_vec())).collect()
    }
}
