//! The stationary state of pulses, by far fewer evaluations of the scheme than stepping there takes.
//!
//! A slot (cell, direction) is written by one cell only, so the scheme can be swept through one state in place: each cell
//! passes on what has arrived so far, first in row-major order, then in exactly the reverse one (a nonlinear symmetric
//! Gauss-Seidel iteration). Its fixed points are those of the plain step. After every few such pairs of sweeps the states
//! are mixed so that the change, taken as linear in them, is least (Anderson acceleration of type II: Walker and Ni, SIAM J.
//! Numer. Anal. 49, 2011).
//!
//! A row-major sweep writes directions 0, 5, 6 and 7 of a cell before it reads them. So a pair of sweeps depends on the
//! other four alone: half of the state is all that is mixed and remembered. To choose the few weights one of these four
//! numbers per cell is enough.
//!
//! Every lane decides for itself, by sums in a fixed order: its light depends neither on the other lanes nor on the
//! processor.

use super::solver::Run;
use super::stream::{Lobes, Medium, Parity, Stream, load8, slot_mut};
use crate::Real;
use crate::real::Number;
use crate::simd::Vector;
use tigereye_core::{Cell, Grid, Work};

/// Pairs of sweeps between two mixings.
const PAIRS: usize = 3;
/// Rows that a sweep works on at once.
const ROWS: usize = 4;
/// Changes that are remembered.
const DEPTH: usize = 3;
/// Directions that a row-major sweep reads before it writes them.
const READ: [usize; 4] = [1, 2, 3, 4];
/// A mixed number below this part of the unmixed one rejects the mixing: light stays positive, and what is lit stays lit.
const FLOOR: f64 = 1.0 / 16.0;
/// A change so many times the smallest one so far empties the memory.
const GROWTH: f64 = 4.0;
/// A remembered change that depends on newer ones up to this part of its squared norm is not used.
const DEPENDENT: f64 = 1e-12;
/// By what part of it the light that leaves the grid or is absorbed in a step may differ from what the pulse injects. Light
/// that is caught in a loop away from the pulse grows for ever, while its relative change falls below any tolerance, and below
/// rounding. In a closed room nothing leaves, and the pulse injects less and less: there the difference itself must be below
/// the tolerance, as a part of [`INJECTED`], or below rounding.
const BALANCE: f64 = 1e-3;
/// What rounding of all light leaves of the balance, as a part of what it leaves of a change: errors of single cells cancel.
const ROUNDED: f64 = 0.1;
/// What a pulse injects in one step at most, W.
const INJECTED: f64 = core::f64::consts::TAU;
/// Evaluations after which the search is given up: some ten times what rings of light, the slowest of the published fields,
/// need on a grid of that size.
const fn patience(grid: Grid) -> usize {
    1000 + 20 * (grid.width() + grid.height())
}

/// How a lane's search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Settled {
    /// A plain step changes nothing more.
    Stationary(Work),
    /// Its light is caught, or the search took too long.
    Never,
}

/// One number for each lane.
type Lanes<T, const N: usize> = [T; N];

/// What is remembered of earlier mixings.
#[derive(Debug)]
pub(crate) struct Memory<T, const N: usize> {
    /// Unmixed halves of the state, newest first; one more than are used, to write the next one to.
    halves: [Vec<[Lanes<T, N>; 4]>; DEPTH + 1],
    /// Differences of consecutive changes of the samples, newest first.
    differences: [Vec<Lanes<T, N>>; DEPTH],
    /// Samples before the sweeps, their change by them, and by those before.
    before: Vec<Lanes<T, N>>,
    change: Vec<Lanes<T, N>>,
    last_change: Vec<Lanes<T, N>>,
    /// How many changes in a row a lane may look back on.
    remembered: [usize; N],
    /// The smallest change of the samples so far.
    smallest: [f64; N],
}

/// The weight of each remembered difference, newest first.
type Weights<T, const N: usize> = [Lanes<T, N>; DEPTH];

impl<T: Real, const N: usize> Run<'_, '_, T, N> {
    /// Brings every lane to its stationary state and writes its light. The stream is dark before, and in need of clearing
    /// afterwards.
    #[inline(always)]
    pub(crate) fn settle<V: Vector<Number = T>>(
        &mut self,
        proof: V::Proof,
        tolerance: f64,
        limit: usize,
    ) -> [Settled; N] {
        let grid = self.field.grid();
        let tolerance = tolerance.max(T::SETTLED);
        let work = |steps: usize| Work { steps, cell_updates: (steps * grid.cells()) as u64 };
        let mut memory = self.stream.memory();
        let mut settled: [Option<Settled>; N] = [None; N];
        let mut trigger = [tolerance; N];
        let mut sweeps = 0;
        let mut asked = [0; N];
        let limit = limit.min(patience(grid));
        if limit <= 2 * PAIRS {
            self.stream.keep(memory);
            return [Settled::Never; N];
        }
        loop {
            self.stream.sample(&mut memory.before);
            for _ in 0..PAIRS {
                self.stream.relax::<false, V>(proof, &self.medium);
                self.stream.relax::<true, V>(proof, &self.medium);
                sweeps += 2;
            }
            self.stream.sample(&mut memory.change);
            let (lit, changed) = memory.compare();
            // The samples say when to ask; the plain step's own change decides.
            let asks: [bool; N] =
                std::array::from_fn(|l| settled[l].is_none() && changed[l] <= trigger[l] * lit[l]);
            if asks.contains(&true) {
                let found = self.balance::<V>(proof);
                for l in (0..N).filter(|&l| asks[l]) {
                    // Counted for those who asked: a lane's work does not depend on its neighbours.
                    asked[l] += 1;
                    // Not below what rounding leaves of a change.
                    trigger[l] = (0.25 * trigger[l]).max(0.25 * T::SETTLED);
                    if found.energy[l] > T::RESIDENCE * INJECTED {
                        settled[l] = Some(Settled::Never);
                    } else if found.change[l] <= tolerance * found.energy[l]
                        && (found.injected[l] - found.lost[l]).abs()
                            <= (BALANCE * found.injected[l])
                                .max(tolerance * INJECTED)
                                .max(ROUNDED * T::SETTLED * found.energy[l])
                    {
                        settled[l] = Some(Settled::Stationary(work(sweeps + asked[l])));
                    }
                }
                self.take_settled(&asks, &settled);
            }
            if settled.iter().all(Option::is_some) || sweeps + 2 * PAIRS >= limit {
                self.stream.keep(memory);
                return settled.map(|s| s.unwrap_or(Settled::Never));
            }
            let weights = memory.weigh(&changed);
            self.stream.mix(&mut memory, &weights);
        }
    }

    /// Writes the light of the lanes among `now` that have settled.
    fn take_settled(&mut self, now: &[bool; N], settled: &[Option<Settled>; N]) {
        let stationary = |l: &usize| matches!(settled[*l], Some(Settled::Stationary(_)));
        let lanes: Vec<usize> = (0..N).filter(|&l| now[l]).filter(stationary).collect();
        if !lanes.is_empty() {
            self.take(super::solver::whole(self.field.grid()), &lanes);
        }
    }

    /// One evaluation that changes nothing: what a plain step would change, and where the light of the pulses stays.
    #[inline(always)]
    fn balance<V: Vector<Number = T>>(&self, proof: V::Proof) -> Balance<N> {
        let mut found = Balance { change: [0.0; N], energy: [0.0; N], injected: [0.0; N], lost: [0.0; N] };
        for (i, cell) in self.field.grid().iter().enumerate() {
            let arriving = self.stream.cell(cell);
            let phi = self.stream.evaluate::<V>(proof, &self.medium, cell);
            let reached = self.stream.reached(cell);
            let (mut energy, mut passed) = ([0.0; N], [0.0; N]);
            for k in 0..8 {
                for l in 0..N {
                    energy[l] += arriving[k][l].widened();
                    passed[l] += phi[k][l].widened();
                }
                if reached[k] {
                    let there = &self.stream.beyond(cell, k)[k];
                    for l in 0..N {
                        found.change[l] += (phi[k][l] - there[l]).abs().widened();
                    }
                } else {
                    for l in 0..N {
                        found.lost[l] += phi[k][l].widened();
                    }
                }
            }
            if cell == self.medium.source.cell() {
                found.injected = self.medium.source.missing_energy(arriving);
                for l in 0..N {
                    energy[l] += found.injected[l];
                }
            }
            // By the rate, not by what is missing from `passed`: that would be rounding where nothing is absorbed.
            let absorbed = 1.0 - self.medium.cells[i].rate().widened();
            let wall = self.medium.walls.at(cell).filter(|_| cell != self.medium.source.cell());
            for l in 0..N {
                found.energy[l] += energy[l];
                if let Some(wall) = wall {
                    let part = |k: usize| wall.absorbed(k) * arriving[k][l].widened();
                    found.lost[l] += (0..8).map(part).sum::<f64>();
                    continue;
                }
                found.lost[l] += if passed[l] > 0.0 { absorbed * energy[l] } else { energy[l] };
            }
        }
        found
    }
}

/// Light of the lanes, W.
struct Balance<const N: usize> {
    /// `sum |F(a) - a|` over the fluxes that arrive anywhere.
    change: [f64; N],
    /// In the grid, the pulse among it.
    energy: [f64; N],
    /// What the pulse adds in a step.
    injected: [f64; N],
    /// What leaves the grid or is absorbed in a step.
    lost: [f64; N],
}

impl<T: Number, const N: usize> Stream<T, N> {
    /// One sweep in place, in row-major order or `BACK`.
    ///
    /// Every cell waits for the one before it. So a few rows run at once, each two cells behind the one before: far enough
    /// for all that it depends on, and the result is that of one row after the other, to the last bit.
    #[inline(always)]
    fn relax<const BACK: bool, V: Vector<Number = T>>(&mut self, proof: V::Proof, medium: &Medium<'_, T, N>) {
        debug_assert_eq!(self.parity(), Parity::Even);
        let (width, height) = (self.grid().width(), self.grid().height());
        for first in (0..height).step_by(ROWS) {
            let rows = ROWS.min(height - first);
            for i in 0..width + 2 * (rows - 1) {
                for r in 0..rows {
                    let Some(j) = i.checked_sub(2 * r).filter(|&j| j < width) else { continue };
                    let (x, y) = (j, first + r);
                    let cell = if BACK { Cell::new(width - 1 - x, height - 1 - y) } else { Cell::new(x, y) };
                    self.relax_cell::<V>(proof, medium, cell);
                }
            }
        }
    }

    #[inline(always)]
    fn relax_cell<V: Vector<Number = T>>(&mut self, proof: V::Proof, medium: &Medium<'_, T, N>, cell: Cell) {
        let index = self.grid().index(cell);
        let mut around = self.three_rows(cell, 1);
        for c in 0..N / V::WIDTH {
            let a: [V; 8] = load8(proof, c, |k| &around[1][1][k]);
            let phi = medium.passed(proof, c, index, cell, &a);
            // What has nowhere to go ends in the ring of ghost cells, from where nothing is read.
            for k in 0..8 {
                phi[k].store(slot_mut(&mut around, k), c);
            }
        }
    }

    /// What a cell would pass on.
    #[inline(always)]
    fn evaluate<V: Vector<Number = T>>(
        &self,
        proof: V::Proof,
        medium: &Medium<'_, T, N>,
        cell: Cell,
    ) -> Lobes<T, N> {
        let slots = self.cell(cell);
        let index = self.grid().index(cell);
        let mut passed = *slots;
        for c in 0..N / V::WIDTH {
            let a: [V; 8] = load8(proof, c, |k| &slots[k]);
            let phi = medium.passed(proof, c, index, cell, &a);
            for k in 0..8 {
                phi[k].store(&mut passed[k], c);
            }
        }
        passed
    }

    /// The number of each cell that stands for it: the four directions in turn.
    #[inline(always)]
    fn sample(&self, to: &mut [Lanes<T, N>]) {
        for (to, cell) in to.iter_mut().zip(self.grid().iter()) {
            *to = self.cell(cell)[READ[(cell.x + 2 * cell.y) % 4]];
        }
    }

    /// Mixes the halves with these weights, and remembers the unmixed one.
    #[inline(always)]
    fn mix(&mut self, memory: &mut Memory<T, N>, weights: &Weights<T, N>) {
        let grid = self.grid();
        memory.halves.rotate_right(1);
        let (unmixed, older) = memory.halves.split_at_mut(1);
        let unmixed = &mut unmixed[0];
        let floor = T::narrowed(FLOOR);
        let mut accepted = [true; N];
        for (i, cell) in grid.iter().enumerate() {
            let slots = self.cell_mut(cell);
            for (half, &k) in READ.iter().enumerate() {
                let here = slots[k];
                let (mut mixed, mut newer) = (here, here);
                for (older, weight) in older.iter().zip(weights) {
                    let older = older[i][half];
                    for l in 0..N {
                        mixed[l] = mixed[l] - weight[l] * (newer[l] - older[l]);
                    }
                    newer = older;
                }
                for l in 0..N {
                    // Not a number rejects too.
                    accepted[l] &= mixed[l] >= floor * here[l];
                }
                unmixed[i][half] = here;
                slots[k] = mixed;
            }
        }
        if !accepted.contains(&false) {
            return;
        }
        for (i, cell) in grid.iter().enumerate() {
            let slots = self.cell_mut(cell);
            for (half, &k) in READ.iter().enumerate() {
                for l in 0..N {
                    slots[k][l] = if accepted[l] { slots[k][l] } else { unmixed[i][half][l] };
                }
            }
        }
    }
}

impl<T: Number, const N: usize> Memory<T, N> {
    /// Numbers it takes.
    pub(crate) const fn numbers(cells: usize) -> usize {
        cells * N * (4 * (DEPTH + 1) + DEPTH + 3)
    }

    pub(crate) fn new(cells: usize) -> Self {
        let lanes = || vec![[T::default(); N]; cells];
        Self {
            halves: std::array::from_fn(|_| vec![[[T::default(); N]; 4]; cells]),
            differences: std::array::from_fn(|_| lanes()),
            before: lanes(),
            change: lanes(),
            last_change: lanes(),
            remembered: [0; N],
            smallest: [f64::INFINITY; N],
        }
    }

    /// Forgets everything: weights that are 0 do not make what is not a number harmless.
    pub(crate) fn clear(&mut self) {
        self.halves.iter_mut().for_each(|half| half.fill([[T::default(); N]; 4]));
        self.remembered = [0; N];
        self.smallest = [f64::INFINITY; N];
    }

    /// Turns the samples after the sweeps into their change; the sum of the samples and of the absolute changes.
    #[inline(always)]
    fn compare(&mut self) -> ([f64; N], [f64; N]) {
        let (mut lit, mut changed) = ([0.0; N], [0.0; N]);
        for (change, before) in self.change.iter_mut().zip(&self.before) {
            for l in 0..N {
                lit[l] += change[l].widened();
                change[l] = change[l] - before[l];
                changed[l] += change[l].abs().widened();
            }
        }
        (lit, changed)
    }

    /// The weights of the remembered differences that make the newest change least, which it takes in.
    #[inline(always)]
    fn weigh(&mut self, changed: &[f64; N]) -> Weights<T, N> {
        self.differences.rotate_right(1);
        for (difference, (now, before)) in
            self.differences[0].iter_mut().zip(self.change.iter().zip(&self.last_change))
        {
            for l in 0..N {
                difference[l] = now[l] - before[l];
            }
        }
        // Sums of products of the differences with each other and with the change, each lane apart.
        let mut products = [[[0.0; N]; DEPTH + 1]; DEPTH];
        for (i, change) in self.change.iter().enumerate() {
            for c in 0..DEPTH {
                let d = &self.differences[c][i];
                for r in c..DEPTH {
                    let e = &self.differences[r][i];
                    for l in 0..N {
                        products[c][r][l] += d[l].widened() * e[l].widened();
                    }
                }
                for l in 0..N {
                    products[c][DEPTH][l] += d[l].widened() * change[l].widened();
                }
            }
        }
        core::mem::swap(&mut self.change, &mut self.last_change);
        let mut weights = [[T::default(); N]; DEPTH];
        for l in 0..N {
            if changed[l] > GROWTH * self.smallest[l] {
                (self.remembered[l], self.smallest[l]) = (0, f64::INFINITY);
            }
            self.smallest[l] = self.smallest[l].min(changed[l]);
            let of_lane = products.map(|row| row.map(|p| p[l]));
            let found = least_squares(of_lane, self.remembered[l].min(DEPTH));
            self.remembered[l] += 1;
            for (weight, found) in weights.iter_mut().zip(found) {
                weight[l] = T::narrowed(found);
            }
        }
        weights
    }
}

/// Solves the normal equations of the first `n` unknowns, of which the upper triangle and the right-hand side are given.
/// Unknowns that depend on those before them are 0, and all are where they are not finite.
fn least_squares(mut m: [[f64; DEPTH + 1]; DEPTH], n: usize) -> [f64; DEPTH] {
    let norms: [f64; DEPTH] = std::array::from_fn(|c| m[c][c]);
    for r in 0..DEPTH {
        for c in 0..r {
            m[r][c] = m[c][r];
        }
    }
    let mut used = [false; DEPTH];
    for c in 0..n {
        used[c] = norms[c] > 0.0 && m[c][c] > DEPENDENT * norms[c];
        if used[c] {
            for r in c + 1..n {
                let q = m[r][c] / m[c][c];
                for j in c + 1..=DEPTH {
                    m[r][j] -= q * m[c][j];
                }
            }
        }
    }
    let mut weights = [0.0; DEPTH];
    for c in (0..n).rev().filter(|&c| used[c]) {
        let known: f64 = (c + 1..n).map(|j| m[c][j] * weights[j]).sum();
        weights[c] = (m[c][DEPTH] - known) / m[c][c];
    }
    if weights.iter().all(|w| w.is_finite()) { weights } else { [0.0; DEPTH] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_squares_solve_and_leave_out_what_depends() {
        // Differences (1, 0, 1), (0, 2, 0) and their sum; change 3 (1, 0, 1) - (0, 2, 0).
        let m = [[2.0, 0.0, 2.0, 6.0], [0.0, 4.0, 4.0, -4.0], [0.0, 0.0, 6.0, 2.0]];
        assert_eq!(least_squares(m, 3), [3.0, -1.0, 0.0]);
        assert_eq!(least_squares(m, 1), [3.0, 0.0, 0.0]);
        assert_eq!(least_squares(m, 0), [0.0; 3]);
        assert_eq!(least_squares([[0.0; 4]; 3], 3), [0.0; 3]);
        assert_eq!(least_squares([[f64::NAN; 4]; 3], 3), [0.0; 3]);
    }
}
