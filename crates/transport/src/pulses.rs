//! Delta pulses of one cell in N directions at once: what the light transport gradient is made of.
//!
//! The N propagations share the field and the window, so a cell's matrix is loaded once for all, and they stop at nearly
//! the same step. A lane that has stopped keeps computing unseen until the last one has; its result was taken when it
//! stopped, so the numbers are those of N separate propagations, bit for bit.

use crate::Stopping;
use crate::kernel::{Buffers, Lobes, Window, normalized, scatter, sum8};
use crate::scattering::Scattering;
use crate::sectors::Sectors;
use crate::simd::Level;
use crate::stopping::{StepMeasures, Verdict};
use tigereye_core::{Cell, StopReason, Work};

/// Distributions of N pulses from one cell: `lobes[cell][direction][lane]`, W, row-major.
///
/// Each lane's own pulse sample counts as 0 in its source cell; [`PulseBlock::source`] says where that is.
#[derive(Clone, Debug)]
pub struct PulseBlock<const N: usize> {
    pub(crate) lobes: Vec<Lobes<N>>,
    pub(crate) source: Cell,
    pub(crate) samples: [usize; N],
}

impl<const N: usize> PulseBlock<N> {
    /// A block for `cells` cells.
    #[must_use]
    pub fn dark(cells: usize) -> Self {
        Self { lobes: vec![[[0.0; N]; 8]; cells], source: Cell::new(0, 0), samples: [0; N] }
    }
    /// Bytes a block of `cells` cells takes.
    #[must_use]
    pub const fn bytes(cells: usize) -> u128 {
        (cells as u128) * (8 * N * size_of::<f64>()) as u128
    }
    /// The cell of the pulses.
    #[must_use]
    pub const fn source(&self) -> Cell {
        self.source
    }
    /// The sample of each lane's pulse.
    #[must_use]
    pub const fn samples(&self) -> &[usize; N] {
        &self.samples
    }
    /// Fluxes of one cell (row-major index), W.
    #[must_use]
    pub fn lobes(&self, index: usize) -> &[[f64; N]; 8] {
        &self.lobes[index]
    }
}

/// How one lane's propagation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneOutcome {
    /// Why.
    pub stop: StopReason,
    /// Steps, and cells passed through the scheme until this lane stopped.
    pub work: Work,
}

/// Solves pulses in one field, reusing its buffers.
pub struct PulseSolver<'a, const N: usize> {
    field: &'a Scattering<'a>,
    sectors: Sectors,
    level: Level,
    buffers: Buffers<N>,
}

/// The pulses' own terms: what one W/rad in the sample adds to `M a`, and the lobes' intensity there.
struct Injection<const N: usize> {
    inject: Lobes<N>,
    lobe_at_sample: Lobes<N>,
    height: f64,
    step_rad: f64,
}

impl<'a, const N: usize> PulseSolver<'a, N> {
    /// A solver for `field`, with buffers of 128 bytes per lane and cell. `level` must be one this processor has, as
    /// [`Level::detect`] gives it.
    #[must_use]
    pub fn new(field: &'a Scattering<'a>, level: Level) -> Self {
        Self { field, sectors: Sectors::new(field.scheme()), level, buffers: Buffers::new(field.grid()) }
    }

    /// Bytes of a solver's buffers for a grid.
    #[must_use]
    pub const fn bytes(grid: tigereye_core::Grid) -> u128 {
        2 * PulseBlock::<N>::bytes((grid.width() + 2) * (grid.height() + 2))
    }

    /// Propagates pulses from `cell` in the samples of each lane until every lane has stopped; lane results go to
    /// `block`. Panics where a sample or the cell does not exist, or the block has another size: the sweep chose them.
    pub fn solve(
        &mut self,
        cell: Cell,
        samples: [usize; N],
        stopping: &Stopping,
        block: &mut PulseBlock<N>,
    ) -> [LaneOutcome; N] {
        assert_eq!(block.lobes.len(), self.field.grid().cells(), "a block of the field's size");
        block.source = cell;
        block.samples = samples;
        let injection = Injection::new(self.field, cell, &samples);
        let mut window = Window { x0: cell.x, x1: cell.x, y0: cell.y, y1: cell.y };
        let mut outcomes: [Option<LaneOutcome>; N] = [None; N];
        let mut previous = [0.0; N];
        let mut work = Work::default();
        loop {
            let special = [(cell, injection.flux(self.field, cell, self.state_at(cell)))];
            let passed = window;
            let total = crate::simd::step(self.level, &mut self.buffers, self.field, window, &special);
            work.steps += 1;
            work.cell_updates += window.cells();
            window = window.grown(self.field.grid());
            let (change, energy) = self.distribution_change(stopping, window, cell, &injection);
            for l in 0..N {
                let measures = StepMeasures {
                    step: work.steps,
                    total_flux: total[l],
                    previous_total_flux: previous[l],
                    distribution_change: change[l],
                    energy: energy[l],
                };
                let stop = match stopping.verdict(&measures) {
                    _ if outcomes[l].is_some() => continue,
                    Verdict::Continue => continue,
                    Verdict::Converged => StopReason::Converged,
                    Verdict::StepLimit => StopReason::StepLimit,
                };
                outcomes[l] = Some(LaneOutcome { stop, work });
                self.take(l, block);
            }
            previous = total;
            if outcomes.iter().all(Option::is_some) {
                self.buffers.clear(passed);
                return outcomes.map(|o| o.unwrap_or(LaneOutcome { stop: StopReason::StepLimit, work }));
            }
        }
    }

    fn state_at(&self, cell: Cell) -> &Lobes<N> {
        &self.buffers.from[self.buffers.padding.index(cell.x, cell.y)]
    }

    /// Copies one lane's state to the block.
    fn take(&self, lane: usize, block: &mut PulseBlock<N>) {
        let grid = self.field.grid();
        for y in 0..grid.height() {
            let start = self.buffers.padding.index(0, y);
            let row = &self.buffers.from[start..start + grid.width()];
            for (to, from) in block.lobes[y * grid.width()..].iter_mut().zip(row) {
                for j in 0..8 {
                    to[j][lane] = from[j][lane];
                }
            }
        }
    }

    /// L1 change and energy of every lane, where the stopping rule asks for them.
    fn distribution_change(
        &self,
        stopping: &Stopping,
        window: Window,
        source: Cell,
        injection: &Injection<N>,
    ) -> ([f64; N], [f64; N]) {
        let (mut change, mut energy) = ([0.0; N], [0.0; N]);
        if !stopping.needs_distribution_change() {
            return (change, energy);
        }
        let h = injection.step_rad;
        for y in window.y0..=window.y1 {
            let (mut row_change, mut row_energy) = ([0.0; N], [0.0; N]);
            for x in window.x0..=window.x1 {
                let i = self.buffers.padding.index(x, y);
                let (now, before) = (&self.buffers.from[i], &self.buffers.to[i]);
                let difference = std::array::from_fn(|j| std::array::from_fn(|l| now[j][l] - before[j][l]));
                let mut l1 = self.sectors.l1(&difference);
                let mut sum = sum8(now);
                if (Cell { x, y }) == source {
                    // The pulse's own sample holds S before and after.
                    let own = injection.intensity(&difference);
                    let missing = injection.missing(now);
                    for l in 0..N {
                        l1[l] -= own[l].abs();
                        sum[l] += h * missing[l];
                    }
                }
                for l in 0..N {
                    row_change[l] += l1[l];
                    row_energy[l] += sum[l];
                }
            }
            for l in 0..N {
                change[l] += h * row_change[l];
                energy[l] += row_energy[l];
            }
        }
        (change, energy)
    }
}

impl<const N: usize> Injection<N> {
    fn new(field: &Scattering<'_>, cell: Cell, samples: &[usize; N]) -> Self {
        let scheme = field.scheme();
        let h = scheme.directions().step_rad();
        let shape = field.transmission().shape(cell);
        Self {
            inject: std::array::from_fn(|k| samples.map(|t| h * scheme.weights(t)[k] * shape[t])),
            lobe_at_sample: std::array::from_fn(|j| samples.map(|t| scheme.lobes(t)[j])),
            height: scheme.directions().count() as f64,
            step_rad: h,
        }
    }

    /// Intensity of the lobes `a` at each lane's sample, W/rad.
    fn intensity(&self, a: &Lobes<N>) -> [f64; N] {
        let products = std::array::from_fn(|j| std::array::from_fn(|l| a[j][l] * self.lobe_at_sample[j][l]));
        sum8(&products)
    }

    /// What the pulse adds to its sample so that it holds the value S, W/rad.
    fn missing(&self, a: &Lobes<N>) -> [f64; N] {
        self.intensity(a).map(|i| self.height - i)
    }

    /// What the source cell passes on.
    fn flux(&self, field: &Scattering<'_>, cell: Cell, a: &Lobes<N>) -> Lobes<N> {
        let m = &field.cells[field.grid().index(cell)];
        let missing = self.missing(a);
        let (mut ma, _, mut energy) = scatter(m, a);
        for l in 0..N {
            energy[l] += self.step_rad * missing[l];
            for k in 0..8 {
                ma[k][l] += self.inject[k][l] * missing[l];
            }
        }
        normalized(m.rate, &energy, &ma, &sum8(&ma))
    }
}

/// One side of a comparison for lane `l`: lane `lane` of block `block`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneOf {
    /// Index into the blocks given.
    pub block: usize,
    /// Lane of that block.
    pub lane: usize,
}

/// `sum over cells and samples of |b1 - b2|` (W/rad) between two blocks, lane by lane. Pulse samples count as 0 in their
/// own cells.
#[must_use]
pub fn l1_difference<const N: usize>(
    field: &Scattering<'_>,
    level: Level,
    b1: &PulseBlock<N>,
    b2: &PulseBlock<N>,
) -> [f64; N] {
    let sectors = Sectors::new(field.scheme());
    let mut total = crate::simd::l1_blocks(level, &sectors, field.grid().width(), b1, b2);
    for l in 0..N {
        total[l] += source_correction(field, (b1, l), (b2, l));
    }
    total
}

/// The same between any lanes of `blocks`: `pairs[l]` names the two sides of sum `l`.
#[must_use]
pub fn l1_difference_of_lanes<const N: usize>(
    field: &Scattering<'_>,
    level: Level,
    blocks: &[&PulseBlock<N>],
    pairs: &[(LaneOf, LaneOf); N],
) -> [f64; N] {
    let sectors = Sectors::new(field.scheme());
    let mut total = crate::simd::l1_lanes(level, &sectors, field.grid().width(), blocks, pairs);
    for l in 0..N {
        let side = |of: LaneOf| (blocks[of.block], of.lane);
        total[l] += source_correction(field, side(pairs[l].0), side(pairs[l].1));
    }
    total
}

/// What the zeroed pulse samples change in the L1 difference of two lanes, W/rad.
fn source_correction<const N: usize>(
    field: &Scattering<'_>,
    (b1, l1): (&PulseBlock<N>, usize),
    (b2, l2): (&PulseBlock<N>, usize),
) -> f64 {
    let scheme = field.scheme();
    let zeroed = [(b1.source, b1.samples[l1]), (b2.source, b2.samples[l2])];
    let distinct = if zeroed[0] == zeroed[1] { 1 } else { 2 };
    let correction_at = |&(cell, t): &(Cell, usize)| {
        let i = field.grid().index(cell);
        let plain = |b: &PulseBlock<N>, l: usize| scheme.intensity(&b.lobes[i].map(|v| v[l]), t);
        let value = |b, l, own| if own == (cell, t) { 0.0 } else { plain(b, l) };
        let right = (value(b1, l1, zeroed[0]) - value(b2, l2, zeroed[1])).abs();
        right - (plain(b1, l1) - plain(b2, l2)).abs()
    };
    zeroed[..distinct].iter().map(correction_at).sum()
}
