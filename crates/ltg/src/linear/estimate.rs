//! What the sketches of a gradient add up to.
//!
//! Each sketch gives one Cauchy number per difference, whose scale is the L1 norm of that difference. The mean
//! logarithm of N of them estimates it: `exp(mean log |z . v|) cos(pi / (2 N))^N` is free of bias. All sums are of
//! whole numbers: the order in which sketches are added, and on which machine, leaves no trace.

use super::logarithms::{GROUPS, OF_ZERO, STEPS};
use super::pulses::Comparisons;
use super::random::BATCH;
use crate::{LtgError, Shard};
use core::f64::consts::{FRAC_PI_2, LN_2};
use tigereye_core::{Cell, Directions, Grid, LtgVolume, math};

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

    /// Adds a batch's logarithms of a cell (in steps, by difference) to its sums. Only the first `pairs` groups hold
    /// two sketches; others say nothing about the scatter.
    #[inline(always)]
    pub(crate) fn add(&self, logarithms: &mut [[i32; GROUPS]], pairs: usize, sums: &mut [i64]) {
        let n = self.differences();
        let (first, products) = sums.split_at_mut(2 * n);
        let (linear, squares) = first.split_at_mut(n);
        for ((log, sum), square) in logarithms.iter_mut().zip(linear).zip(squares) {
            let mut total = 0;
            for g in 0..GROUPS {
                total += log[g];
            }
            *sum += i64::from(total);
            if pairs < GROUPS {
                log[pairs..].fill(0);
            }
            *square += product(log, log);
        }
        let (xy, turned) = products.split_at_mut(self.moved);
        for (class, sum) in xy.iter_mut().enumerate() {
            *sum += product(&logarithms[class], &logarithms[self.moved + class]);
        }
        let (xw, yw) = turned.split_at_mut(self.values.len());
        for (((class, turn), xw), yw) in self.values.iter().zip(xw).zip(yw) {
            let turned = &logarithms[2 * self.moved + turn];
            *xw += product(&logarithms[*class], turned);
            *yw += product(&logarithms[self.moved + class], turned);
        }
    }
}

/// Sum of the products of two lists of logarithms, in squared coarse steps.
#[inline(always)]
fn product(a: &[i32; GROUPS], b: &[i32; GROUPS]) -> i64 {
    let mut sum = 0;
    for g in 0..GROUPS {
        sum += i64::from(a[g] >> SQUARED_SHIFT) * i64::from(b[g] >> SQUARED_SHIFT);
    }
    sum
}

/// The sums of some batches of sketches of a gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct SketchSums {
    grid: Grid,
    directions: Directions,
    slices: Vec<usize>,
    layout: Layout,
    seed: u64,
    /// How many sketches there are when all batches are done.
    sketches: u32,
    sums: Vec<i64>,
    done: Vec<bool>,
}

impl SketchSums {
    /// No sketch yet of `sketches` in all.
    pub(crate) fn empty(
        grid: Grid,
        directions: Directions,
        slices: Vec<usize>,
        layout: Layout,
        seed: u64,
        sketches: u32,
    ) -> Self {
        let cells = grid.width().saturating_sub(2) * grid.height().saturating_sub(2);
        let sums = vec![0; cells * layout.sums()];
        let done = vec![false; (sketches as usize).div_ceil(BATCH)];
        Self { grid, directions, slices, layout, seed, sketches, sums, done }
    }

    /// Bytes of the sums.
    pub(crate) fn bytes(grid: Grid, layout: &Layout) -> u128 {
        (grid.cells() * layout.sums() * size_of::<i64>()) as u128
    }

    /// Takes over what an earlier run has finished of the same sketches.
    ///
    /// # Errors
    /// [`LtgError::Length`] and [`LtgError::Value`] where the numbers are not those of such sums.
    pub fn restore(&mut self, values: &[f64], done: Vec<bool>) -> Result<(), LtgError> {
        let check = |what, found: usize, expected: usize| {
            let expected = expected as u128;
            if found as u128 == expected { Ok(()) } else { Err(LtgError::Length { what, found, expected }) }
        };
        check("values", values.len(), self.sums.len())?;
        check("marks", done.len(), self.done.len())?;
        let whole = |v: f64| v == v.trunc() && v.abs() <= (1_u64 << 53) as f64;
        if let Some(index) = values.iter().position(|v| !whole(*v)) {
            return Err(LtgError::Sum { index, value: values[index] });
        }
        self.sums = values.iter().map(|v| *v as i64).collect();
        self.done = done;
        Ok(())
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
    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.grid
    }
    /// How many sketches are in the sums.
    #[must_use]
    pub fn sketches(&self) -> u32 {
        (0..self.done.len()).filter(|&b| self.done[b]).map(|b| self.sketches_of(b as u32)).sum()
    }
    /// How many sketches there are in a batch: fewer than 32 in the last one, perhaps.
    pub(crate) const fn sketches_of(&self, batch: u32) -> u32 {
        let before = batch * BATCH as u32;
        let rest = self.sketches - before;
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
        let differs = [
            (self.grid != other.grid, "grids"),
            (self.directions != other.directions, "numbers of directions"),
            (self.slices != other.slices, "slices"),
            (self.layout != other.layout, "angular steps or fields"),
            (self.seed != other.seed, "seeds"),
            (self.sketches != other.sketches, "numbers of sketches"),
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
        self.seed
    }
    /// The sums of the inner cells of each inner row.
    pub(crate) fn rows_mut(&mut self) -> (&Layout, std::slice::ChunksMut<'_, i64>) {
        let row = (self.grid.width().saturating_sub(2) * self.layout.sums()).max(1);
        (&self.layout, self.sums.chunks_mut(row))
    }
    pub(crate) fn mark(&mut self, batch: u32) {
        self.done[batch as usize] = true;
    }
    /// Room for more sketches. Batches must be whole until then.
    pub(crate) fn extend_to(&mut self, sketches: u32) {
        debug_assert!((self.sketches as usize).is_multiple_of(BATCH), "whole batches");
        self.sketches = sketches;
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
        let (grid, cells) = (self.grid, self.grid.cells());
        let mut values = vec![0.0; cells * self.slices.len()];
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
        let volume = |values| LtgVolume::new(grid, self.directions, self.slices.clone(), values);
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
    // Pairs of sketches; an odd one has no partner.
    let groups = (count / 2.0).floor();
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
    let coarse_means = means.map(|mean| 2.0 * mean * coarse - 0.5);
    let covariance = |i: usize, j: usize| {
        let about_mean = sum_of_products(i, j) as f64 - groups * coarse_means[i] * coarse_means[j];
        about_mean / (groups - 1.0).max(1.0) / (coarse * coarse) * LN_2 * LN_2 / (4.0 * groups)
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
