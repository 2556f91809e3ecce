//! What the sketches of a gradient add up to.
//!
//! Each sketch gives one Cauchy number per difference, whose scale is the L1 norm of that difference. The mean
//! logarithm of N of them estimates it: `exp(mean log |z . v|) cos(pi / (2 N))^N` is free of bias. All sums are of
//! whole numbers: the order in which sketches are added, and on which machine, leaves no trace.

use super::limits::{FEWEST_SKETCHES, MOST_SKETCHES};
use super::logarithms::{GROUPS, OF_ZERO, STEPS};
use super::pulses::Comparisons;
use super::random::BATCH;
use crate::{LtgError, Shard};
use core::f64::consts::{FRAC_PI_2, LN_2};
use tigereye_core::{Cell, Directions, Grid, LtgVolume, math};
use tigereye_transport::{Scheme, SharedWeights};

/// Logarithms are squared in coarser steps than they are added, so that sums fit into 53 bits: `2^SQUARED_SHIFT` of
/// them.
const SQUARED_SHIFT: u32 = 6;

/// A gradient estimated from sketches.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The gradient.
    pub volume: LtgVolume,
    /// Standard error of each of its values, measured from the scatter of the sketches; W/rad.
    pub error: LtgVolume,
    /// The root mean square of the relative standard errors of all values that are not 0.
    pub relative_error: f64,
    /// How many sketches it is made of.
    pub sketches: u32,
}

/// What one cell adds up, in this order: sums of the logarithms along x and along y of each moved class and of each
/// turn; their squares; products of those along x and y of each class; products of those along x and in direction, and
/// along y and in direction, of each value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    /// Moved classes, turns and distinct values of a cell.
    pub(crate) moved: usize,
    pub(crate) turns: usize,
    /// Place among the moved classes, and the turn, of each value.
    pub(crate) values: Vec<(usize, usize)>,
    /// Which value each slice has.
    pub(crate) of_slice: Vec<usize>,
}

impl Layout {
    pub(crate) fn new(comparisons: &Comparisons) -> Self {
        let moved = comparisons.moved();
        let place = |class: usize| moved.iter().position(|m| *m == class).unwrap_or(0);
        Self {
            values: comparisons.values.iter().map(|&(class, turn)| (place(class), turn)).collect(),
            of_slice: comparisons.of_slice.clone(),
            turns: comparisons.turns.len(),
            moved: moved.len(),
        }
    }

    /// Differences of a cell whose logarithms are added up.
    pub(crate) const fn differences(&self) -> usize {
        2 * self.moved + self.turns
    }

    /// Sums per cell.
    pub(crate) fn sums(&self) -> usize {
        2 * self.differences() + self.moved + 2 * self.values.len()
    }

    /// Adds the logarithms of a batch of so many sketches of a cell (in steps, by difference) to its sums. Where their
    /// number is odd, the group of the last one holds it alone. It then counts as its own partner, with half the weight
    /// of a pair: `1/2 (2 a) (2 b) = 2 a b`.
    #[inline(always)]
    pub(crate) fn add(&self, logarithms: &[[i32; GROUPS]], sketches: usize, sums: &mut [i64]) {
        let single = if sketches.is_multiple_of(2) { GROUPS } else { sketches / 2 };
        let n = self.differences();
        let (first, products) = sums.split_at_mut(2 * n);
        let (linear, squares) = first.split_at_mut(n);
        for ((log, sum), square) in logarithms.iter().zip(linear).zip(squares) {
            let mut total = 0;
            for g in 0..GROUPS {
                total += log[g];
            }
            *sum += i64::from(total);
            *square += product(log, log, single);
        }
        let (xy, turned) = products.split_at_mut(self.moved);
        for (class, sum) in xy.iter_mut().enumerate() {
            *sum += product(&logarithms[class], &logarithms[self.moved + class], single);
        }
        let (xw, yw) = turned.split_at_mut(self.values.len());
        for (((class, turn), xw), yw) in self.values.iter().zip(xw).zip(yw) {
            let turned = &logarithms[2 * self.moved + turn];
            *xw += product(&logarithms[*class], turned, single);
            *yw += product(&logarithms[self.moved + class], turned, single);
        }
    }
}

/// Sum of the products of two lists of logarithms, in squared coarse steps; that of the group `single`, if there is
/// one, counts twice.
#[inline(always)]
fn product(a: &[i32; GROUPS], b: &[i32; GROUPS], single: usize) -> i64 {
    let mut sum = 0;
    for g in 0..GROUPS {
        sum += i64::from(a[g] >> SQUARED_SHIFT) * i64::from(b[g] >> SQUARED_SHIFT);
    }
    if single < GROUPS {
        sum += i64::from(a[single] >> SQUARED_SHIFT) * i64::from(b[single] >> SQUARED_SHIFT);
    }
    sum
}

/// What sums of sketches are of: everything that determines their number and meaning but the field itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SketchShape {
    /// The grid.
    pub grid: Grid,
    /// The angular sampling.
    pub directions: Directions,
    /// The slices, ascending, each once.
    pub slices: Vec<usize>,
    /// Half-width K of the angular central difference, in samples.
    pub omega_step: usize,
    /// Whether pulses of all samples are told apart: needed where cells transmit nothing in some samples.
    pub every_sample: bool,
    /// How many sketches there are when all batches are done.
    pub sketches: u32,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// The sums of some batches of sketches of a gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct SketchSums {
    shape: SketchShape,
    layout: Layout,
    sums: Vec<i64>,
    done: Vec<bool>,
}

impl SketchSums {
    /// No sketch yet.
    pub(crate) fn empty(shape: SketchShape, layout: Layout) -> Self {
        let cells = shape.grid.width().saturating_sub(2) * shape.grid.height().saturating_sub(2);
        let sums = vec![0; cells * layout.sums()];
        let done = vec![false; (shape.sketches as usize).div_ceil(BATCH)];
        Self { shape, layout, sums, done }
    }

    /// What an earlier run has finished: as many numbers as the shape needs, whole ones.
    ///
    /// # Errors
    /// [`LtgError::Length`] and [`LtgError::Sum`] where the numbers are not those of such sums; [`LtgError::Sketches`],
    /// [`LtgError::OmegaStep`], [`LtgError::NoSlices`] and [`LtgError::Slice`] where there is no such shape. Nothing is
    /// allocated for sizes that do not fit.
    pub fn restored(mut shape: SketchShape, values: &[f64], done: Vec<bool>) -> Result<Self, LtgError> {
        if !(FEWEST_SKETCHES..=MOST_SKETCHES).contains(&shape.sketches) {
            return Err(LtgError::Sketches { sketches: shape.sketches.into() });
        }
        // As they are computed: a file may have them in any order.
        shape.slices.sort_unstable();
        shape.slices.dedup();
        let scheme = Scheme::new(shape.directions, SharedWeights::Thesis);
        let comparisons = Comparisons::new(&scheme, shape.every_sample, &shape.slices, shape.omega_step)?;
        let layout = Layout::new(&comparisons);
        let cells = shape.grid.width().saturating_sub(2) * shape.grid.height().saturating_sub(2);
        let check = |what, found: usize, expected: u128| {
            if found as u128 == expected { Ok(()) } else { Err(LtgError::Length { what, found, expected }) }
        };
        check("values", values.len(), cells as u128 * layout.sums() as u128)?;
        check("marks", done.len(), (shape.sketches as usize).div_ceil(BATCH) as u128)?;
        let whole = |v: f64| v == v.trunc() && v.abs() <= (1_u64 << 53) as f64;
        if let Some(index) = values.iter().position(|v| !whole(*v)) {
            return Err(LtgError::Sum { index, value: values[index] });
        }
        Ok(Self { shape, layout, sums: values.iter().map(|v| *v as i64).collect(), done })
    }

    /// Bytes of the sums.
    pub(crate) fn bytes(grid: Grid, layout: &Layout) -> u128 {
        (grid.cells() * layout.sums() * size_of::<i64>()) as u128
    }

    /// The sums as numbers: whole, below 2^53.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        self.sums.iter().map(|v| *v as f64).collect()
    }
    /// Which batches of 32 sketches are in the sums.
    #[must_use]
    pub fn done(&self) -> &[bool] {
        &self.done
    }
    /// What the sums are of.
    #[must_use]
    pub const fn shape(&self) -> &SketchShape {
        &self.shape
    }
    /// How many sketches are in the sums.
    #[must_use]
    pub fn sketches(&self) -> u32 {
        (0..self.done.len()).filter(|&b| self.done[b]).map(|b| self.sketches_of(b as u32)).sum()
    }
    /// How many sketches there are in a batch: fewer than 32 in the last one, perhaps.
    pub(crate) const fn sketches_of(&self, batch: u32) -> u32 {
        let before = batch * BATCH as u32;
        let rest = self.shape.sketches - before;
        if rest < BATCH as u32 { rest } else { BATCH as u32 }
    }
    /// How many batches of `shard` are missing.
    #[must_use]
    pub fn missing(&self, shard: Shard) -> usize {
        self.done[shard.range(self.done.len())].iter().filter(|done| !**done).count()
    }
    /// The shards of `count` that lack something, ascending.
    #[must_use]
    pub fn missing_shards(&self, count: usize) -> Vec<usize> {
        let batches = (0..self.done.len()).filter(|&batch| !self.done[batch]);
        let mut shards: Vec<usize> = batches.map(|b| Shard::holding(b, self.done.len(), count)).collect();
        shards.dedup();
        shards
    }

    /// Adds the sketches of another part of the same gradient.
    ///
    /// # Errors
    /// [`LtgError::Unlike`] for parts of different gradients or seeds, [`LtgError::SketchedTwice`].
    pub fn merged(mut self, other: &Self) -> Result<Self, LtgError> {
        let (a, b) = (&self.shape, &other.shape);
        let differs = [
            (a.grid != b.grid, "grids"),
            (a.directions != b.directions, "numbers of directions"),
            (a.slices != b.slices, "slices"),
            (a.omega_step != b.omega_step, "angular steps"),
            (a.seed != b.seed, "seeds"),
            (a.sketches != b.sketches, "numbers of sketches"),
            (a != b, "fields"),
        ];
        if let Some(&(_, what)) = differs.iter().find(|(differs, _)| *differs) {
            return Err(LtgError::Unlike { what });
        }
        let twice = self.done.iter().zip(&other.done).position(|(a, b)| *a && *b);
        if let Some(batch) = twice {
            return Err(LtgError::SketchedTwice { first: batch * BATCH, last: batch * BATCH + BATCH - 1 });
        }
        self.sums.iter_mut().zip(&other.sums).for_each(|(a, b)| *a += b);
        self.done.iter_mut().zip(&other.done).for_each(|(a, b)| *a |= b);
        Ok(self)
    }

    /// The batches of `shard` that are missing, ascending.
    pub(crate) fn missing_batches(&self, shard: Shard) -> Vec<u32> {
        shard.range(self.done.len()).filter(|&b| !self.done[b]).map(|b| b as u32).collect()
    }
    pub(crate) const fn seed(&self) -> u64 {
        self.shape.seed
    }
    /// The sums of the inner cells of each inner row.
    pub(crate) fn rows_mut(&mut self) -> (&Layout, std::slice::ChunksMut<'_, i64>) {
        let row = (self.shape.grid.width().saturating_sub(2) * self.layout.sums()).max(1);
        (&self.layout, self.sums.chunks_mut(row))
    }
    pub(crate) fn mark(&mut self, batch: u32) {
        self.done[batch as usize] = true;
    }
    /// Room for more sketches. Batches must be whole until then.
    pub(crate) fn extend_to(&mut self, sketches: u32) {
        debug_assert!(
            self.done.is_empty() || (self.shape.sketches as usize).is_multiple_of(BATCH),
            "whole batches"
        );
        self.shape.sketches = sketches;
        self.done.resize((sketches as usize).div_ceil(BATCH), false);
    }

    /// The gradient as far as the sketches go, and how far it is to be trusted.
    ///
    /// # Errors
    /// [`LtgError::NoSketches`] where there is none yet.
    pub fn estimate(&self) -> Result<Estimate, LtgError> {
        let sketches = self.sketches();
        if sketches == 0 {
            return Err(LtgError::NoSketches);
        }
        let SketchShape { grid, directions, slices, .. } = &self.shape;
        let (grid, cells) = (*grid, grid.cells());
        let mut values = vec![0.0; cells * slices.len()];
        let mut errors = values.clone();
        let (mut squares, mut lit) = (0.0, 0_u64);
        let columns = grid.width().saturating_sub(2);
        for (i, sums) in self.sums.chunks(self.layout.sums()).enumerate() {
            let cell = Cell::new(1 + i % columns, 1 + i / columns);
            let found: Vec<[f64; 2]> = (0..self.layout.values.len())
                .map(|v| value_and_error(&self.layout, sums, v, sketches))
                .collect();
            for (slice, &v) in self.layout.of_slice.iter().enumerate() {
                let [value, error] = found[v];
                let at = slice * cells + grid.index(cell);
                (values[at], errors[at]) = (value, error);
                if value > 0.0 {
                    squares += (error / value) * (error / value);
                    lit += 1;
                }
            }
        }
        let volume = |values| LtgVolume::new(grid, *directions, slices.clone(), values);
        let relative_error = if lit > 0 { (squares / lit as f64).sqrt() } else { 0.0 };
        Ok(Estimate { volume: volume(values), error: volume(errors), relative_error, sketches })
    }
}

/// The estimate of one value of a cell's gradient and its standard error, W/rad.
fn value_and_error(layout: &Layout, sums: &[i64], value: usize, sketches: u32) -> [f64; 2] {
    let (class, turn) = layout.values[value];
    let n = layout.differences();
    let at = [class, layout.moved + class, 2 * layout.moved + turn];
    let count = f64::from(sketches);
    // Pairs of sketches, an odd one by itself with half the weight of a pair.
    let groups = (count / 2.0).ceil();
    let weights = count / 2.0;
    // Mean logarithm of a sketch, octaves.
    let means = at.map(|i| sums[i] as f64 / (f64::from(STEPS) * count));
    let bias = math::pow(math::cos(FRAC_PI_2 / count), count);
    let norms = means.map(|mean| {
        // Nothing but zeros.
        if mean < f64::from(OF_ZERO) + 1.0 { 0.0 } else { 0.5 * math::exp(LN_2 * mean) * bias }
    });
    let square = norms.iter().map(|g| g * g).sum::<f64>();
    if square == 0.0 {
        return [0.0, 0.0];
    }
    // Covariances of the means: logarithms of groups (two sketches each) scatter around twice the mean.
    let products = 2 * n + layout.moved;
    let sum_of_products = |i: usize, j: usize| match (i, j) {
        (0, 1) => sums[2 * n + class],
        (0, 2) => sums[products + value],
        (1, 2) => sums[products + layout.values.len() + value],
        (i, _) => sums[n + at[i]],
    };
    let coarse = f64::from(STEPS) / f64::from(1_u32 << SQUARED_SHIFT);
    // `v >> SHIFT` rounds down: half a coarse step on average.
    let coarse_means = means.map(|mean| 2.0 * mean * coarse - 0.5 * groups / weights);
    let covariance = |i: usize, j: usize| {
        let about_mean = sum_of_products(i, j) as f64 - weights * coarse_means[i] * coarse_means[j];
        about_mean / (groups - 1.0).max(1.0) / (coarse * coarse) * LN_2 * LN_2 / (4.0 * weights)
    };
    let share = norms.map(|g| g * g / square);
    let mut variance = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            if share[i] > 0.0 && share[j] > 0.0 {
                variance += share[i] * share[j] * covariance(i.min(j), i.max(j));
            }
        }
    }
    let value = square.sqrt();
    [value, value * variance.max(0.0).sqrt()]
}
