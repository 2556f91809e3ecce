//! The stationary state of pulses, with far fewer evaluations of the scheme than plain steps need.
//!
//! A slot (cell, direction) is written by one cell only, so the scheme can be swept through one state in place: each
//! cell passes on the light that has arrived so far, first in row-major order, then in exactly the reverse one (a
//! nonlinear symmetric Gauss-Seidel iteration). Its fixed points are those of the plain step. After every few such
//! pairs of sweeps the states are mixed such that the change, linearised in them, is minimal (Anderson acceleration of
//! type II: Walker and Ni, SIAM J. Numer. Anal. 49, 2011).
//!
//! A row-major sweep writes directions 0, 5, 6 and 7 of a cell before it reads them. A pair of sweeps therefore depends
//! only on the other four, and only this half of the state is mixed and remembered. One of these four numbers per cell
//! suffices to determine the few weights.
//!
//! Every lane decides for itself, by sums in a fixed order: its light depends neither on the other lanes nor on the
//! processor.

use super::memory::{Lanes, Memory, Weights};
use super::run::{Run, whole};
use super::stream::{Lobes, Medium, Parity, Stream, load8, slot_mut};
use crate::Real;
use tigereye_core::{Cell, Grid, Work};
use tigereye_simd::Number;
use tigereye_simd::Vector;

/// Number of pairs of sweeps between two mixings.
const PAIRS: usize = 3;
/// Number of rows that a sweep processes at once.
const ROWS: usize = 4;
/// Directions that a row-major sweep reads before it writes them.
const READ: [usize; 4] = [1, 2, 3, 4];
/// A mixing is rejected if a mixed number is below this fraction of the unmixed one: light stays positive, and lit
/// cells stay lit.
const FLOOR: f64 = 1.0 / 16.0;
/// Relative tolerance of the energy balance: of the light that leaves the grid or is absorbed in a step against the
/// injected light. The relative change of the state is no criterion for light trapped in a loop away from the pulse: it
/// grows without bound while its relative change falls below any tolerance. In a closed room no light leaves and the
/// pulse injects less and less; there the difference itself must be below this fraction of [`INJECTED`], or below
/// rounding.
const BALANCE: f64 = 1e-3;
/// Rounding error of the energy balance, relative to that of a change: the errors of single cells cancel.
const ROUNDED: f64 = 0.1;
/// Largest energy that a pulse injects in one step, W.
const INJECTED: f64 = core::f64::consts::TAU;
/// Number of evaluations after which the search gives up: about ten times as many as the slowest published fields,
/// rings of light, need on a grid of that size.
const fn patience(grid: Grid) -> usize {
    1000 + 20 * (grid.width() + grid.height())
}

/// The end of a lane's search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Settled {
    /// A plain step changes nothing any more.
    Stationary(Work),
    /// Its light is trapped, or the search took too long.
    Never,
}

impl<T: Real, const N: usize> Run<'_, '_, T, N> {
    /// Brings every lane to its stationary state and writes its light. The stream is dark before and must be cleared
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
            // The samples indicate when to check; the change of the plain step decides.
            let asks: [bool; N] =
                std::array::from_fn(|l| settled[l].is_none() && changed[l] <= trigger[l] * lit[l]);
            if asks.contains(&true) {
                let found = self.balance::<V>(proof);
                for l in (0..N).filter(|&l| asks[l]) {
                    // Counted only for the lanes that check, so that a lane's work does not depend on its neighbours.
                    asked[l] += 1;
                    // Not below the rounding error of a change.
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
            self.take(whole(self.field.grid()), &lanes);
        }
    }

    /// One evaluation without effect: the change that a plain step would make, and the energy balance of the pulses.
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
            // From the rate, not from the difference to `passed`, which would be rounding where nothing is absorbed.
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
    /// In the grid, including the pulse.
    energy: [f64; N],
    /// Injected by the pulse in a step.
    injected: [f64; N],
    /// Leaves the grid or is absorbed in a step.
    lost: [f64; N],
}

impl<T: Number, const N: usize> Stream<T, N> {
    /// One sweep in place, in row-major order or `BACK`.
    ///
    /// Every cell depends on the one before it, which is slow. So a few rows run at once, each two cells behind the
    /// previous: far enough for all its dependencies, and the result is that of one row after the other, to the last
    /// bit.
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

    /// The light that a cell would pass on.
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

    /// The number sampled in each cell: its four directions in turn.
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
                    // NaN rejects as well.
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
