//! The gradient from random receivers.
//!
//! With independent Cauchy numbers z, one for each cell and sample, `z . v` is a Cauchy number whose scale is the L1
//! norm of v (Indyk 2006). A sketch asks the whole field what each flux is worth to the receivers z: one solution of
//! the adjoint problem. The number `z . (b1 - b2)` of every difference in the gradient is then a sum of a few of these
//! worths. N sketches give each norm with the relative standard error `pi / (2 sqrt N)`.
//!
//! Only single precision is used: the errors of rounding are thousands of times smaller than those of sampling.

use super::estimate::{Layout, SketchShape, SketchSums};
use super::limits::{FEWEST_SKETCHES, MOST_SKETCHES};
use super::logarithms::{GROUPS, log2_of_groups};
use super::pool::Pool;
use super::pulses::{Comparisons, has_dark_samples};
use super::random::{BATCH, cauchy_numbers};
use crate::observer::Phase;
use crate::{LtgError, Shard};
use rayon::prelude::*;
use std::ops::ControlFlow;
use tigereye_core::{Cell, Grid};
use tigereye_transport::{
    ArrayLoop, Dissection, Lanes, Level, LinearScattering, Operator, Workspace, sector_lobes,
};

/// Settings of a sketched gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct SketchSettings {
    /// Number of sketches N, [`FEWEST_SKETCHES`] to [`MOST_SKETCHES`].
    pub sketches: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Half-width K of the angular central difference, in samples.
    pub omega_step: usize,
    /// Slices to compute, any order; `None`: all.
    pub slices: Option<Vec<usize>>,
    /// Upper bound on the memory, bytes.
    pub memory_bytes: u64,
    /// Instruction set of the hot loops; results do not depend on it.
    pub level: Level,
}

/// Watches a sketched gradient in the making.
pub trait SketchObserver: Sync {
    /// The calling thread turns to another phase, or to nothing.
    fn busy(&self, _with: Option<Phase>) {}
    /// Some batches more are in the sums. `Break` ends the work.
    fn finished(&self, _sums: &SketchSums) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// Asked often; `Break` ends the work without what is under way.
    fn pulse(&self) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl SketchObserver for () {}

/// A field, and what is asked of its gradient.
pub struct SketchedGradient<'a> {
    field: &'a LinearScattering<'a>,
    settings: SketchSettings,
    slices: Vec<usize>,
    every_sample: bool,
    comparisons: Comparisons,
    layout: Layout,
}

/// How the sketches are solved within the memory: so many lanes side by side, and so many arrays of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Plan {
    wide: bool,
    arrays: usize,
}

impl<'a> SketchedGradient<'a> {
    /// Checks the settings.
    ///
    /// # Errors
    /// [`LtgError`].
    pub fn new(field: &'a LinearScattering<'a>, settings: SketchSettings) -> Result<Self, LtgError> {
        if !(FEWEST_SKETCHES..=MOST_SKETCHES).contains(&settings.sketches) {
            return Err(LtgError::Sketches { sketches: settings.sketches.into() });
        }
        let mut slices =
            settings.slices.clone().unwrap_or_else(|| (0..field.scheme().directions().count()).collect());
        slices.sort_unstable();
        slices.dedup();
        let every_sample = has_dark_samples(field);
        let comparisons = Comparisons::new(field.scheme(), every_sample, &slices, settings.omega_step)?;
        let layout = Layout::new(&comparisons);
        let made = Self { field, settings, slices, every_sample, comparisons, layout };
        made.plan()?;
        Ok(made)
    }

    /// Sums of no sketch yet.
    #[must_use]
    pub fn sums(&self) -> SketchSums {
        SketchSums::empty(self.shape(), self.layout.clone())
    }

    /// What the sums are of.
    #[must_use]
    pub fn shape(&self) -> SketchShape {
        SketchShape {
            grid: self.field.grid(),
            directions: self.field.scheme().directions(),
            slices: self.slices.clone(),
            omega_step: self.settings.omega_step,
            every_sample: self.every_sample,
            sketches: self.settings.sketches,
            seed: self.settings.seed,
        }
    }

    fn plan(&self) -> Result<Plan, LtgError> {
        let (grid, bound) = (self.field.grid(), self.settings.memory_bytes);
        let cells = grid.cells() as u128;
        let samples = self.field.scheme().directions().count() as u128;
        let prepared = cells * (samples * 8 + 168 + 160 + 4 * self.comparisons.classes.len() as u128);
        // The sums, and their bytes once more while a checkpoint is written.
        let values = 2 * SketchSums::bytes(grid, &self.layout) + 16 * cells * self.slices.len() as u128;
        let threads = rayon::current_num_threads().max(1);
        let needed = |wide: bool, arrays: usize| {
            let (matrices, array) = if wide {
                (Dissection::<f32, 64>::bytes_for(grid), Dissection::<f32, 64>::solution_bytes(grid))
            } else {
                (Dissection::<f32, 32>::bytes_for(grid), Dissection::<f32, 32>::solution_bytes(grid))
            };
            prepared + values + matrices + arrays as u128 * array
        };
        let plans = [true, false]
            .into_iter()
            .flat_map(|wide| (1..=threads).rev().map(move |arrays| Plan { wide, arrays }));
        // As many threads as fit come before wide arrays.
        let fits = |plan: &Plan| needed(plan.wide, plan.arrays) <= u128::from(bound);
        let best = plans.filter(fits).max_by_key(|plan| (plan.arrays, plan.wide));
        best.ok_or_else(|| LtgError::Memory { needed: needed(false, 1), bound })
    }

    /// Adds the sketches of `shard` that `sums` lacks. The result does not depend on threads, memory or interruptions.
    ///
    /// # Errors
    /// [`LtgError::Interrupted`] if the observer requested it, with `done` and `total` counting sketches;
    /// [`LtgError::Stopping`] with
    /// [`tigereye_transport::TransportError::Trapped`] where there is no stationary state.
    pub fn run(
        &self,
        shard: Shard,
        sums: SketchSums,
        observer: &dyn SketchObserver,
    ) -> Result<SketchSums, LtgError> {
        let plan = self.plan()?;
        if plan.wide {
            self.run_with::<64>(shard, sums, plan.arrays, observer, None)
        } else {
            self.run_with::<32>(shard, sums, plan.arrays, observer, None)
        }
    }

    /// Adds as many sketches as are needed for a relative error of `target`, 0 to 1, those of `settings.sketches` at
    /// least.
    ///
    /// # Errors
    /// As [`Self::run`], and [`LtgError::Sketches`] where that would be more than [`MOST_SKETCHES`].
    pub fn run_to_error(&self, target: f64, observer: &dyn SketchObserver) -> Result<SketchSums, LtgError> {
        let plan = self.plan()?;
        let mut sums = self.sums();
        sums.extend_to(self.settings.sketches.next_multiple_of(BATCH as u32));
        if plan.wide {
            self.run_with::<64>(Shard::WHOLE, sums, plan.arrays, observer, Some(target))
        } else {
            self.run_with::<32>(Shard::WHOLE, sums, plan.arrays, observer, Some(target))
        }
    }

    fn run_with<const N: usize>(
        &self,
        shard: Shard,
        mut sums: SketchSums,
        arrays: usize,
        observer: &dyn SketchObserver,
        target: Option<f64>,
    ) -> Result<SketchSums, LtgError> {
        let mut batches = sums.missing_batches(shard);
        if batches.is_empty() || self.field.grid().width() < 3 || self.field.grid().height() < 3 {
            batches.iter().for_each(|&batch| sums.mark(batch));
            return Ok(sums);
        }
        observer.busy(Some(Phase::Propagation));
        let dissection =
            Dissection::<f32, N>::new(self.field, Operator::Adjoint, self.settings.level, &Pool)?;
        observer.busy(None);
        let energies = self.energies();
        let mut workers: Vec<Worker<N>> = Vec::new();
        let interrupted = |sums: &SketchSums| LtgError::Interrupted {
            done: sums.sketches().into(),
            total: (sums.done().len() * BATCH) as u64,
        };
        loop {
            for round in batches.chunks(arrays * (N / BATCH)) {
                let batches: Vec<&[u32]> = round.chunks(N / BATCH).collect();
                while workers.len() < batches.len() {
                    workers.push(Worker::new(&dissection));
                }
                let jobs = workers.par_iter_mut().zip(&batches).with_max_len(1);
                jobs.for_each(|(worker, batches)| {
                    if observer.pulse().is_continue() {
                        observer.busy(Some(Phase::Propagation));
                        let receivers = Receivers {
                            field: self.field,
                            seed: sums.seed(),
                            batches,
                            edges: &mut worker.edges,
                        };
                        self.settings.level.compiled(receivers);
                        dissection.solve(&mut worker.edges, &mut worker.workspace);
                        observer.busy(None);
                    }
                });
                if observer.pulse().is_break() {
                    return Err(interrupted(&sums));
                }
                for (worker, batches) in workers.iter().zip(&batches) {
                    self.look_up(&worker.edges, batches, &energies, &mut sums, observer);
                }
                round.iter().for_each(|&batch| sums.mark(batch));
                if observer.finished(&sums).is_break() {
                    return Err(interrupted(&sums));
                }
            }
            let Some(target) = target else { return Ok(sums) };
            let found = sums.estimate()?.relative_error;
            if found <= target || found == 0.0 {
                return Ok(sums);
            }
            // The error falls with the root of the number; two per cent more, since it is itself measured.
            let ratio = found / target;
            let wanted = (f64::from(sums.sketches()) * (ratio * ratio) * 1.02).ceil();
            if wanted > f64::from(MOST_SKETCHES) {
                return Err(LtgError::Sketches { sketches: wanted as u64 });
            }
            sums.extend_to((wanted as u32).next_multiple_of(BATCH as u32));
            batches = sums.missing_batches(Shard::WHOLE);
        }
    }

    /// The energy of a pulse of each class in each cell, W.
    fn energies(&self) -> Vec<f32> {
        let grid = self.field.grid();
        let of_cell = |cell| self.comparisons.energies(self.field, cell);
        grid.iter().flat_map(of_cell).map(|energy| energy as f32).collect()
    }

    /// Adds the logarithms of solved batches to the sums, row by row.
    fn look_up<const N: usize>(
        &self,
        edges: &[Lanes<f32, N>],
        batches: &[u32],
        energies: &[f32],
        sums: &mut SketchSums,
        observer: &dyn SketchObserver,
    ) {
        let sketches: Vec<u32> = batches.iter().map(|&batch| sums.sketches_of(batch)).collect();
        let (layout, rows) = sums.rows_mut();
        let grid = self.field.grid();
        let pulses: Vec<Vec<(usize, f32)>> = self.comparisons.classes.iter().map(leaving).collect();
        let moved = self.comparisons.moved();
        let rows: Vec<_> = rows.enumerate().collect();
        rows.into_par_iter().with_max_len(1).for_each(|(row, sums)| {
            observer.busy(Some(Phase::Difference));
            self.settings.level.compiled(LookUps {
                grid,
                y: row + 1,
                edges,
                sketches: &sketches,
                energies,
                pulses: &pulses,
                moved: &moved,
                turns: &self.comparisons.turns,
                layout,
                sums,
            });
            observer.busy(None);
        });
    }
}

/// The edges that a pulse of a class enters when its light is followed back, each with its cone weight.
fn leaving(weights: &[f64; 8]) -> Vec<(usize, f32)> {
    let lit = weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
    lit.map(|(k, weight)| ((k + 4) % 8, *weight as f32)).collect()
}

struct Worker<const N: usize> {
    edges: Vec<Lanes<f32, N>>,
    workspace: Workspace<f32, N>,
}

impl<const N: usize> Worker<N> {
    fn new(dissection: &Dissection<f32, N>) -> Self {
        let edges = vec![Lanes::zero(); 8 * dissection.grid().cells()];
        Self { edges, workspace: dissection.workspace() }
    }
}

/// Puts random receivers on every edge: those of a cell's lobe j on the edge that light followed back leaves by.
struct Receivers<'r, const N: usize> {
    field: &'r LinearScattering<'r>,
    seed: u64,
    batches: &'r [u32],
    edges: &'r mut [Lanes<f32, N>],
}

impl<const N: usize> ArrayLoop for Receivers<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let scheme = self.field.scheme();
        let grid = self.field.grid();
        let s = scheme.directions().count();
        let lobes: Vec<[(usize, f32); 4]> =
            (0..s).map(|t| sector_lobes(t * 8 / s).map(|j| (j, scheme.lobes(t)[j] as f32))).collect();
        for cell in grid.iter() {
            let first = (grid.index(cell) * s) as u64;
            for (place, &batch) in self.batches.iter().enumerate() {
                let mut receivers = [[0.0_f32; BATCH]; 8];
                for (t, lobes) in lobes.iter().enumerate() {
                    let numbers = cauchy_numbers(self.seed, batch, first + t as u64);
                    for &(j, lobe) in lobes {
                        let sums = &mut receivers[j];
                        for l in 0..BATCH {
                            sums[l] = f32::mul_add(lobe, numbers[l], sums[l]);
                        }
                    }
                }
                for (j, receivers) in receivers.iter().enumerate() {
                    let back = (j + 4) % 8;
                    if let Some(behind) = grid.neighbour(cell, back) {
                        let edge = &mut self.edges[8 * grid.index(behind) + back].0;
                        edge.as_chunks_mut::<BATCH>().0[place] = *receivers;
                    }
                }
            }
        }
    }
}

/// Adds the logarithms of all differences in a row to its sums.
struct LookUps<'r, const N: usize> {
    grid: Grid,
    y: usize,
    edges: &'r [Lanes<f32, N>],
    /// Number of sketches in each batch of the lanes.
    sketches: &'r [u32],
    /// By cell and class, W.
    energies: &'r [f32],
    /// Edges and cone weights of each class.
    pulses: &'r [Vec<(usize, f32)>],
    moved: &'r [usize],
    turns: &'r [[usize; 2]],
    layout: &'r Layout,
    sums: &'r mut [i64],
}

impl<const N: usize> LookUps<'_, N> {
    /// What a pulse of a class in a cell is worth to the receivers of a batch.
    #[inline(always)]
    fn worth(&self, batch: usize, cell: usize, class: usize) -> [f32; BATCH] {
        let mut worth = [0.0; BATCH];
        for &(edge, weight) in &self.pulses[class] {
            let row = &self.edges[8 * cell + edge].0.as_chunks::<BATCH>().0[batch];
            for l in 0..BATCH {
                worth[l] = f32::mul_add(weight, row[l], worth[l]);
            }
        }
        let energy = self.energies[cell * self.pulses.len() + class];
        for l in 0..BATCH {
            worth[l] *= energy;
        }
        worth
    }
}

impl<const N: usize> ArrayLoop for LookUps<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        let (layout, moved) = (self.layout, self.moved.len());
        let mut logarithms = vec![[0; GROUPS]; layout.differences()];
        let mut own = vec![[0.0; BATCH]; self.pulses.len()];
        let sums = std::mem::take(&mut self.sums);
        for (x, sums) in sums.chunks_mut(layout.sums()).enumerate() {
            let at = |x: usize, y: usize| self.grid.index(Cell::new(x, y));
            let (x, y) = (x + 1, self.y);
            for (batch, &sketches) in self.sketches.iter().enumerate() {
                let neighbours = [[at(x - 1, y), at(x + 1, y)], [at(x, y - 1), at(x, y + 1)]];
                for (along, [before, after]) in neighbours.into_iter().enumerate() {
                    for (place, &class) in self.moved.iter().enumerate() {
                        let (a, b) = (self.worth(batch, before, class), self.worth(batch, after, class));
                        logarithms[along * moved + place] = logarithm(&a, &b, sketches as usize);
                    }
                }
                for (class, own) in own.iter_mut().enumerate() {
                    *own = self.worth(batch, at(x, y), class);
                }
                for (turn, [before, after]) in self.turns.iter().enumerate() {
                    logarithms[2 * moved + turn] = logarithm(&own[*before], &own[*after], sketches as usize);
                }
                layout.add(&logarithms, sketches as usize, sums);
            }
        }
    }
}

/// The logarithms of the first `sketches` differences.
#[inline(always)]
fn logarithm(a: &[f32; BATCH], b: &[f32; BATCH], sketches: usize) -> [i32; GROUPS] {
    let mut difference = [0.0; BATCH];
    for l in 0..BATCH {
        difference[l] = b[l] - a[l];
    }
    if sketches < BATCH {
        keep(&mut difference, sketches);
    }
    log2_of_groups(&difference)
}

/// Keeps so many sketches of a batch, in pairs as far as they go; the others get the logarithm 0.
#[inline(always)]
fn keep(values: &mut [f32; BATCH], sketches: usize) {
    let (pairs, odd) = (sketches / 2, sketches % 2);
    values[pairs + odd..GROUPS].fill(1.0);
    values[GROUPS + pairs..].fill(1.0);
}
