//! The exact gradient of the linear scheme, from eight responses a cell.
//!
//! The sweep goes down the grid. The responses of a cell are compared with those of the cell two rows above, whose
//! place they then take, and with those two columns away; pulses of one cell in different directions need no other
//! cell.

use super::pool::Pool;
use super::pulses::{Comparisons, has_dark_samples};
use crate::observer::{Phase, SweepObserver};
use crate::partial::PartialVolume;
use crate::{LtgError, LtgSettings, Needs, Precision, Shard};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError, RwLock};
use tigereye_core::{Cell, Directions, Grid, SweepWork};
use tigereye_transport::{
    Combination, Dissection, Lanes, Level, LinearScattering, Operator, Real, Workspace, l1_norms,
};

/// Computes what `shard` has of the exact gradient of the linear scheme and `start` lacks; `settings.stopping` has no
/// say, for every pulse is solved to its stationary state. The counters of work hold one source per response.
///
/// # Errors
/// [`LtgError`]; [`LtgError::Stopping`] with [`tigereye_transport::TransportError::Trapped`] where there is no
/// stationary state.
pub fn linear_sweep_part(
    field: &LinearScattering<'_>,
    settings: &LtgSettings,
    shard: Shard,
    start: Option<PartialVolume>,
    observer: &dyn SweepObserver,
) -> Result<PartialVolume, LtgError> {
    let (grid, directions) = (field.grid(), field.scheme().directions());
    let slices = settings.checked_slices(directions)?;
    check_linear_fit(grid, directions, settings)?;
    let volume = PartialVolume::started(grid, directions, slices.clone(), settings.omega_step, start)?;
    match settings.precision {
        Precision::F64 => run::<f64, 32>(field, settings, &slices, shard, volume, observer),
        Precision::F32 => run::<f32, 64>(field, settings, &slices, shard, volume, observer),
    }
}

/// Whether an exact sweep of the linear scheme can run with these settings on rayon's current thread pool.
///
/// # Errors
/// What [`linear_sweep_part`] would refuse.
pub fn check_linear_fit(grid: Grid, directions: Directions, settings: &LtgSettings) -> Result<(), LtgError> {
    let slices = settings.checked_slices(directions)?;
    match settings.precision {
        Precision::F64 => strips::<f64, 32>(grid, directions, slices.len(), settings.memory_bytes),
        Precision::F32 => strips::<f32, 64>(grid, directions, slices.len(), settings.memory_bytes),
    }
    .map(drop)
}

/// What `shard` of an exact sweep of the linear scheme takes on rayon's current thread pool. Its sources are responses.
///
/// # Errors
/// As [`check_linear_fit`].
pub fn linear_needs(
    grid: Grid,
    directions: Directions,
    settings: &LtgSettings,
    shard: Shard,
) -> Result<Needs, LtgError> {
    let slices = settings.checked_slices(directions)?;
    let count = slices.len();
    let (bound, volume) =
        (settings.memory_bytes, PartialVolume::empty(grid, directions, slices, settings.omega_step)?);
    let (strips, bytes) = match settings.precision {
        Precision::F64 => {
            let strips = strips::<f64, 32>(grid, directions, count, bound)?;
            let bytes = strips_bytes::<f64, 32>(grid, directions, count, &strips);
            (strips, bytes)
        }
        Precision::F32 => {
            let strips = strips::<f32, 64>(grid, directions, count, bound)?;
            let bytes = strips_bytes::<f32, 64>(grid, directions, count, &strips);
            (strips, bytes)
        }
    };
    let targets = volume.all_targets(shard);
    let cells = strips.iter().map(|strip| solved_cells(grid, strip, &targets).count() as u64).sum::<u64>();
    Ok(Needs { sources: 8 * cells, bytes })
}

/// The cells whose responses a strip needs: the targets and their four neighbours.
fn solved_cells<'a>(
    grid: Grid,
    strip: &Range<usize>,
    targets: &'a [bool],
) -> impl Iterator<Item = Cell> + 'a {
    let columns = strip.start - 1..strip.end + 1;
    let cells = (0..grid.height()).flat_map(move |y| columns.clone().map(move |x| Cell::new(x, y)));
    let is_target = move |cell: Cell| targets[grid.index(cell)];
    cells.filter(move |&cell| {
        is_target(cell) || [0, 2, 4, 6].iter().any(|&k| grid.neighbour(cell, k).is_some_and(is_target))
    })
}

/// Bytes of the responses of one cell.
fn response_bytes<T>(grid: Grid) -> u128 {
    (64 * grid.cells() * size_of::<T>()) as u128
}

/// Bytes that a sweep needs beside its two rows of responses.
fn fixed_bytes<T: Real, const N: usize>(grid: Grid, directions: Directions, slices: usize) -> u128 {
    let cells = grid.cells() as u128;
    let threads = rayon::current_num_threads() as u128;
    let prepared = cells * (directions.count() as u128 * 8 + 168 + 160) + cells * slices as u128 * 24;
    // Each thread solves N lanes and holds the responses that it reads off them.
    prepared + Dissection::<T, N>::bytes_for(grid) + threads * 2 * Dissection::<T, N>::solution_bytes(grid)
}

/// Bytes of a sweep in these strips.
fn strips_bytes<T: Real, const N: usize>(
    grid: Grid,
    directions: Directions,
    slices: usize,
    strips: &[Range<usize>],
) -> u128 {
    let columns = strips.iter().map(|strip| strip.len() + 2).max().unwrap_or(0);
    fixed_bytes::<T, N>(grid, directions, slices) + 2 * columns as u128 * response_bytes::<T>(grid)
}

/// The strips of inner columns, so that two rows of responses fit beside everything else.
fn strips<T: Real, const N: usize>(
    grid: Grid,
    directions: Directions,
    slices: usize,
    memory_bytes: u64,
) -> Result<Vec<Range<usize>>, LtgError> {
    if grid.width() < 3 || grid.height() < 3 {
        return Ok(Vec::new());
    }
    let fixed = fixed_bytes::<T, N>(grid, directions, slices);
    let needed = |columns: usize| fixed + 2 * columns as u128 * response_bytes::<T>(grid);
    if needed(3) > u128::from(memory_bytes) {
        return Err(LtgError::Memory { needed: needed(3), bound: memory_bytes });
    }
    let interior = grid.width() - 2;
    let widest = (1..=interior).rev().find(|n| needed(n + 2) <= u128::from(memory_bytes)).unwrap_or(1);
    let width = interior.div_ceil(interior.div_ceil(widest));
    Ok((0..interior).step_by(width).map(|first| 1 + first..1 + (first + width).min(interior)).collect())
}

/// The responses of one cell to its eight lobes, each eight lobes a cell (W): what a flux of 1 W that leaves towards
/// neighbour k makes of the whole field.
type Responses<T> = Vec<Vec<[T; 8]>>;

struct Sweep<'a, T, const N: usize> {
    field: &'a LinearScattering<'a>,
    level: Level,
    comparisons: &'a Comparisons,
    dissection: Dissection<T, N>,
    observer: &'a dyn SweepObserver,
    workers: Mutex<Vec<Worker<T, N>>>,
    done: AtomicU64,
    total: u64,
    interrupted: AtomicBool,
    skipped: AtomicBool,
}

struct Worker<T, const N: usize> {
    edges: Vec<Lanes<T, N>>,
    workspace: Workspace<T, N>,
    /// Where the next responses go.
    spare: Vec<Responses<T>>,
}

/// Responses of the columns of a strip in an even and an odd row.
struct Ring<T> {
    columns: Range<usize>,
    places: Vec<RwLock<Responses<T>>>,
}

/// Half the L1 differences at one cell: by place of the class among the moved ones, or by turn.
#[derive(Clone, Default)]
struct Differences {
    along_x: Vec<f64>,
    along_y: Vec<f64>,
    turned: Vec<f64>,
}

fn run<T: Real, const N: usize>(
    field: &LinearScattering<'_>,
    settings: &LtgSettings,
    slices: &[usize],
    shard: Shard,
    mut volume: PartialVolume,
    observer: &dyn SweepObserver,
) -> Result<PartialVolume, LtgError> {
    let grid = field.grid();
    let comparisons = Comparisons::new(field.scheme(), has_dark_samples(field), slices, settings.omega_step)?;
    let strips = strips::<T, N>(grid, field.scheme().directions(), slices.len(), settings.memory_bytes)?;
    let targets = volume.all_targets(shard);
    let wanted = |x: usize, y: usize| targets[y * grid.width() + x];
    if !targets.contains(&true) {
        return Ok(volume);
    }
    observer.busy(Some(Phase::Propagation));
    let dissection = Dissection::new(field, Operator::Forward, settings.level, &Pool)?;
    observer.busy(None);
    let before = volume.finished().work.sources;
    let needed = |x: usize, y: usize| {
        let near = [(0, 0), (1, 0), (0, 1)]
            .map(|(dx, dy)| [(x.checked_sub(dx), y.checked_sub(dy)), (Some(x + dx), Some(y + dy))]);
        near.into_iter().flatten().any(|(x, y)| match (x, y) {
            (Some(x), Some(y)) => x < grid.width() && y < grid.height() && wanted(x, y),
            _ => false,
        })
    };
    let of_strip = |strip: &Range<usize>| {
        let columns = strip.start - 1..strip.end + 1;
        let rows = 0..grid.height();
        rows.flat_map(|y| columns.clone().map(move |x| (x, y))).filter(|&(x, y)| needed(x, y)).count() as u64
    };
    let sweep = Sweep::<T, N> {
        field,
        level: settings.level,
        comparisons: &comparisons,
        dissection,
        observer,
        workers: Mutex::new(Vec::new()),
        done: AtomicU64::new(before),
        total: before + 8 * strips.iter().map(of_strip).sum::<u64>(),
        interrupted: AtomicBool::new(false),
        skipped: AtomicBool::new(false),
    };
    for strip in &strips {
        let columns = strip.start - 1..strip.end + 1;
        let ring = Ring {
            places: (0..2 * columns.len()).map(|_| RwLock::new(Vec::new())).collect(),
            columns: columns.clone(),
        };
        let is_target = |x: usize, y: usize| strip.contains(&x) && wanted(x, y);
        let mut above: Vec<Differences> = vec![Differences::default(); columns.len()];
        for y in 0..grid.height() {
            let solved: Vec<usize> = columns.clone().filter(|&x| needed(x, y)).collect();
            let here = sweep.row(&ring, y, &solved, &is_target, &mut above);
            if sweep.skipped.load(Ordering::Relaxed) {
                let _ = observer.finished(&volume);
                let done = sweep.done.load(Ordering::Relaxed);
                return Err(LtgError::Interrupted { done, total: sweep.total });
            }
            if let Some(last) = y.checked_sub(1) {
                let mut any = false;
                for x in strip.clone().filter(|&x| is_target(x, last)) {
                    let differences = &above[x - columns.start];
                    finish(&mut volume, &comparisons, shard, Cell::new(x, last), differences);
                    any = true;
                }
                if any && observer.finished(&volume).is_break() {
                    sweep.interrupted.store(true, Ordering::Relaxed);
                }
            }
            above = here;
        }
    }
    Ok(volume)
}

/// Adds the differences of a cell to the sets of directions that `shard` lacks there.
fn finish(
    volume: &mut PartialVolume,
    comparisons: &Comparisons,
    shard: Shard,
    cell: Cell,
    found: &Differences,
) {
    let moved = comparisons.moved();
    let value = |slice: usize| {
        let (class, turn) = comparisons.values[comparisons.of_slice[slice]];
        let place = moved.iter().position(|m| *m == class).unwrap_or(0);
        [found.along_x[place], found.along_y[place], found.turned[turn]]
    };
    let grid = volume.grid();
    // The responses of the rim belong to the cells inside of it.
    let own = |i: usize, n: usize| {
        if n == 3 {
            3
        } else if i == 1 || i == n - 2 {
            2
        } else {
            1
        }
    };
    let (columns, rows) = (own(cell.x, grid.width()), own(cell.y, grid.height()));
    // Nothing is compared with the corners.
    let owned = columns * rows - (columns - 1) * (rows - 1);
    let work = SweepWork { sources: 8 * owned as u64, ..SweepWork::default() };
    volume.finish_cell(shard, cell, work, &value);
}

impl<T: Real, const N: usize> Sweep<'_, T, N> {
    /// Solves the cells of a row and takes the differences that become possible: along y in `above`, along x and in
    /// direction in what is returned.
    fn row(
        &self,
        ring: &Ring<T>,
        y: usize,
        solved: &[usize],
        is_target: &(dyn Fn(usize, usize) -> bool + Sync),
        above: &mut [Differences],
    ) -> Vec<Differences> {
        let columns = &ring.columns;
        let here: Vec<Mutex<Differences>> =
            columns.clone().map(|_| Mutex::new(Differences::default())).collect();
        let last: Vec<Mutex<&mut Differences>> = above.iter_mut().map(Mutex::new).collect();
        solved.par_chunks(N / 8).with_max_len(1).for_each(|batch| {
            if self.interrupted.load(Ordering::Relaxed) {
                self.skipped.store(true, Ordering::Relaxed);
                return;
            }
            self.observer.busy(Some(Phase::Propagation));
            let mut worker = self.take_worker();
            self.solve(&mut worker, y, batch);
            self.observer.busy(Some(Phase::Difference));
            for (&x, responses) in batch.iter().zip(&mut worker.spare) {
                let cell = Cell::new(x, y);
                let mut place = ring.places[ring.at(x, y)].write().unwrap_or_else(PoisonError::into_inner);
                let two_above = (y > 1 && is_target(x, y - 1)).then(|| (Cell::new(x, y - 2), &*place));
                let [moved, turned] = self.differences((cell, responses), two_above, is_target(x, y));
                if is_target(x, y) {
                    here[x - columns.start].lock().unwrap_or_else(PoisonError::into_inner).turned = turned;
                }
                if two_above.is_some() {
                    last[x - columns.start].lock().unwrap_or_else(PoisonError::into_inner).along_y = moved;
                }
                std::mem::swap(&mut *place, responses);
            }
            self.workers.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
            self.observer.busy(None);
            let solved = 8 * batch.len() as u64;
            let done = self.done.fetch_add(solved, Ordering::Relaxed) + solved;
            if self.observer.progress(done, self.total).is_break() {
                self.interrupted.store(true, Ordering::Relaxed);
            }
        });
        if !self.skipped.load(Ordering::Relaxed) {
            let targets: Vec<usize> = columns.clone().filter(|&x| is_target(x, y)).collect();
            targets.par_iter().with_max_len(1).for_each(|&x| {
                self.observer.busy(Some(Phase::Difference));
                let read =
                    |x: usize| ring.places[ring.at(x, y)].read().unwrap_or_else(PoisonError::into_inner);
                let (left, right) = (read(x - 1), read(x + 1));
                let (left, right) = ((Cell::new(x - 1, y), &*left), (Cell::new(x + 1, y), &*right));
                let [along_x, _] = self.differences(right, Some(left), false);
                here[x - columns.start].lock().unwrap_or_else(PoisonError::into_inner).along_x = along_x;
                self.observer.busy(None);
            });
        }
        here.into_iter().map(|d| d.into_inner().unwrap_or_else(PoisonError::into_inner)).collect()
    }

    fn take_worker(&self) -> Worker<T, N> {
        let waiting = self.workers.lock().unwrap_or_else(PoisonError::into_inner).pop();
        waiting.unwrap_or_else(|| Worker {
            edges: vec![Lanes::zero(); 8 * self.field.grid().cells()],
            workspace: self.dissection.workspace(),
            spare: vec![Vec::new(); N / 8],
        })
    }

    /// Leaves the responses of up to N / 8 cells of a row in `worker.spare`.
    fn solve(&self, worker: &mut Worker<T, N>, y: usize, columns: &[usize]) {
        let grid = self.field.grid();
        let lit: Vec<Cell> = columns.iter().map(|&x| Cell::new(x, y)).collect();
        let mut sources = Vec::new();
        for (i, &cell) in lit.iter().enumerate() {
            for k in 0..8 {
                if let Some(there) = grid.neighbour(cell, k) {
                    sources.push((8 * grid.index(there) + k, 8 * i + k, T::from_f64(1.0)));
                }
            }
        }
        self.dissection.solve_near(&lit, &sources, &mut worker.edges, &mut worker.workspace);
        for responses in worker.spare.iter_mut().take(columns.len()) {
            responses.resize_with(8, Vec::new);
            for response in responses {
                response.resize(grid.cells(), [T::from_f64(0.0); 8]);
            }
        }
        for (cell, edges) in worker.edges.as_chunks::<8>().0.iter().enumerate() {
            for (i, responses) in worker.spare.iter_mut().enumerate().take(columns.len()) {
                for (k, response) in responses.iter_mut().enumerate() {
                    let lane = 8 * i + k;
                    let lobes = &mut response[cell];
                    for (lobe, edge) in lobes.iter_mut().zip(edges) {
                        *lobe = edge.0[lane];
                    }
                }
            }
        }
    }

    /// Half the L1 differences between the pulses of each moved class in two cells, and between those of each turn in
    /// the first: both read its responses, which come from far away.
    fn differences(
        &self,
        (own, responses): (Cell, &Responses<T>),
        other: Option<(Cell, &Responses<T>)>,
        turns: bool,
    ) -> [Vec<f64>; 2] {
        let comparisons = self.comparisons;
        let energies = comparisons.energies(self.field, own);
        let lit = |class: usize| (0..8).filter(move |k| comparisons.classes[class][*k] != 0.0);
        let half = |energy: f64, class: usize, k: usize| 0.5 * energy * comparisons.classes[class][k];
        let mut distributions: Vec<&[[T; 8]]> = responses.iter().map(|r| &**r).collect();
        let mut combinations: Vec<Combination<T>> = Vec::new();
        if let Some((cell, responses)) = other {
            distributions.extend(responses.iter().map(|r| &**r));
            let others = comparisons.energies(self.field, cell);
            for class in comparisons.moved() {
                let here = lit(class).map(|k| (k, half(energies[class], class, k)));
                let there = lit(class).map(|k| (8 + k, -half(others[class], class, k)));
                combinations.push(here.chain(there).map(|(i, f)| (i, T::from_f64(f))).collect());
            }
        }
        let moved = combinations.len();
        for &[before, after] in comparisons.turns.iter().filter(|_| turns) {
            let factor = |k| half(energies[after], after, k) - half(energies[before], before, k);
            let changed = (0..8).map(|k| (k, factor(k))).filter(|(_, factor)| *factor != 0.0);
            combinations.push(changed.map(|(k, factor)| (k, T::from_f64(factor))).collect());
        }
        let mut norms = l1_norms(self.field.scattering(), self.level, &distributions, &combinations);
        let turned = norms.split_off(moved);
        [norms, turned]
    }
}

impl<T> Ring<T> {
    const fn at(&self, x: usize, y: usize) -> usize {
        y % 2 * (self.columns.end - self.columns.start) + x - self.columns.start
    }
}
