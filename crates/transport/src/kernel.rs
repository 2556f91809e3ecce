//! The reduced step for N independent lanes that share one field.
//!
//! The state is `[cell][8 directions][lane]` on a grid with a ring of ghost cells: every cell may pass light on to all
//! eight neighbours, and what reaches the ring is never read again (the absorbing rim). A slot (cell, k) has one writer,
//! the cell behind it, so the buffers need no clearing between steps.

use crate::scattering::{CellScattering, Scattering};
use crate::simd::{Plain, Vector};
use core::ops::{Add, Deref, DerefMut, Range};
use tigereye_core::{Cell, Grid, NEIGHBOUR_OFFSETS};

/// Eight fluxes (W) for each of N lanes.
pub(crate) type Lobes<const N: usize> = [[f64; N]; 8];

/// Columns `x0..=x1`, rows `y0..=y1` that may hold light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) x0: usize,
    pub(crate) x1: usize,
    pub(crate) y0: usize,
    pub(crate) y1: usize,
}

impl Window {
    /// The smallest window around `cells`.
    pub(crate) fn around(cells: impl IntoIterator<Item = Cell>) -> Option<Self> {
        cells.into_iter().fold(None, |window, c| {
            let w = window.unwrap_or(Self { x0: c.x, x1: c.x, y0: c.y, y1: c.y });
            Some(Self { x0: w.x0.min(c.x), x1: w.x1.max(c.x), y0: w.y0.min(c.y), y1: w.y1.max(c.y) })
        })
    }
    /// The window one step later: light moves one cell a step.
    pub(crate) fn grown(self, grid: Grid) -> Self {
        Self {
            x0: self.x0.saturating_sub(1),
            x1: (self.x1 + 1).min(grid.width() - 1),
            y0: self.y0.saturating_sub(1),
            y1: (self.y1 + 1).min(grid.height() - 1),
        }
    }
    pub(crate) const fn cells(&self) -> u64 {
        ((self.x1 - self.x0 + 1) * (self.y1 - self.y0 + 1)) as u64
    }
}

/// Where cells lie in a padded buffer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Padding {
    stride: usize,
    rows: usize,
}

impl Padding {
    pub(crate) const fn of(grid: Grid) -> Self {
        Self { stride: grid.width() + 2, rows: grid.height() + 2 }
    }
    pub(crate) const fn len(self) -> usize {
        self.stride * self.rows
    }
    pub(crate) const fn index(self, x: usize, y: usize) -> usize {
        (y + 1) * self.stride + x + 1
    }
    /// The cell above and to the left of (x, y), which may be a ghost.
    const fn ghost(self, x: usize, y: usize) -> usize {
        y * self.stride + x
    }
}

/// Fluxes of many cells, dark at first. Lanes that fill a cache line lie in one.
#[derive(Debug)]
pub(crate) struct State<const N: usize> {
    /// The cells begin where a cache line does; a line more than they need.
    values: Vec<f64>,
    start: usize,
    cells: usize,
}

impl<const N: usize> State<N> {
    const LINE_BYTES: usize = 64;

    pub(crate) fn dark(cells: usize) -> Self {
        let values = vec![0.0; cells * 8 * N + Self::LINE_BYTES / size_of::<f64>()];
        // Where alignment is unknown the numbers are the same, only slower to reach.
        let start = values.as_ptr().align_offset(Self::LINE_BYTES).min(Self::LINE_BYTES / size_of::<f64>());
        Self { values, start, cells }
    }
    #[inline(always)]
    fn range(&self) -> Range<usize> {
        self.start..self.start + self.cells * 8 * N
    }
}

impl<const N: usize> Deref for State<N> {
    type Target = [Lobes<N>];
    #[inline(always)]
    fn deref(&self) -> &[Lobes<N>] {
        self.values[self.range()].as_chunks().0.as_chunks().0
    }
}

impl<const N: usize> DerefMut for State<N> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [Lobes<N>] {
        let range = self.range();
        self.values[range].as_chunks_mut().0.as_chunks_mut().0
    }
}

impl<const N: usize> Clone for State<N> {
    fn clone(&self) -> Self {
        let mut state = Self::dark(self.cells);
        state.copy_from_slice(self);
        state
    }
}

/// Vector `c` of the lanes of eight fluxes.
#[inline(always)]
pub(crate) fn load8<const N: usize, const W: usize, V: Vector<W>>(
    proof: V::Proof,
    a: &Lobes<N>,
    c: usize,
) -> [V; 8] {
    let mut v = [V::splat(proof, 0.0); 8];
    for j in 0..8 {
        v[j] = V::load_part(proof, &a[j], c);
    }
    v
}

/// `M a`.
///
/// The order of the additions is symmetric under mirroring and quarter turns: symmetric light stays symmetric to the
/// last bit wherever the matrices are.
#[inline(always)]
pub(crate) fn scattered<const W: usize, V: Vector<W>>(
    proof: V::Proof,
    m: &CellScattering,
    a: &[V; 8],
) -> [V; 8] {
    let mut ma = *a;
    for k in 0..8 {
        let b = &m.band[k % 4];
        let b = |d: usize| V::splat(proof, b[d]);
        let near = b(1) * a[(k + 7) % 8] + b(3) * a[(k + 1) % 8];
        let far = b(0) * a[(k + 6) % 8] + b(4) * a[(k + 2) % 8];
        ma[k] = (b(2) * a[k] + near) + far;
    }
    ma
}

/// Sum over the eight directions, opposite ones first.
#[inline(always)]
pub(crate) fn sum_of_eight<V: Copy + Add<Output = V>>(a: &[V; 8]) -> V {
    ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]))
}

/// A cell that lets through less than this part of what arrives lets nothing through: the quotient that makes up for it
/// would overflow, and no light is left of it at this scale.
pub(crate) const NOTHING_PASSES: f64 = 1e-290;

/// `Phi = Tbar energy (M a) / sum(M a)`; nothing where nothing passes.
#[inline(always)]
pub(crate) fn normalized_to<const W: usize, V: Vector<W>>(
    proof: V::Proof,
    rate: f64,
    energy: V,
    ma: &[V; 8],
    sum_ma: V,
) -> [V; 8] {
    let quotient = V::splat(proof, rate) * energy / sum_ma;
    let passes = sum_ma - energy * V::splat(proof, NOTHING_PASSES);
    let factor = V::if_positive(passes, quotient, V::splat(proof, 0.0));
    let mut phi = *ma;
    for k in 0..8 {
        phi[k] = factor * ma[k];
    }
    phi
}

/// `M a`, its sum and the sum of `a` of one cell, lane by lane.
pub(crate) fn scatter<const N: usize>(m: &CellScattering, a: &Lobes<N>) -> (Lobes<N>, [f64; N], [f64; N]) {
    let a = a.map(Plain);
    let ma = scattered((), m, &a);
    (ma.map(|v| v.0), sum_of_eight(&ma).0, sum_of_eight(&a).0)
}

/// Sum over the eight directions, lane by lane.
pub(crate) fn sum8<const N: usize>(a: &Lobes<N>) -> [f64; N] {
    sum_of_eight(&a.map(Plain)).0
}

/// [`normalized_to`], lane by lane.
pub(crate) fn normalized<const N: usize>(
    rate: f64,
    energy: &[f64; N],
    ma: &Lobes<N>,
    sum_ma: &[f64; N],
) -> Lobes<N> {
    normalized_to((), rate, Plain(*energy), &ma.map(Plain), Plain(*sum_ma)).map(|v| v.0)
}

/// The current state and the one before.
pub(crate) struct Buffers<const N: usize> {
    pub(crate) from: State<N>,
    pub(crate) to: State<N>,
    pub(crate) padding: Padding,
    /// Where the current state begins in `from`: 0, or after every other [`Buffers::step_in_place`] two rows on.
    pub(crate) start: usize,
    /// The last step's flux to existing neighbours of each row.
    row_flux: Vec<[f64; N]>,
    grid: Grid,
}

/// What special cells (lights) pass on this step instead of their lobes' flux, in row-major order of the cells.
pub(crate) type Specials<const N: usize> = [(Cell, Lobes<N>)];

impl<const N: usize> Buffers<N> {
    pub(crate) fn new(grid: Grid) -> Self {
        let padding = Padding::of(grid);
        let state = || State::dark(Self::cells(grid));
        Self { from: state(), to: state(), padding, start: 0, row_flux: vec![[0.0; N]; grid.height()], grid }
    }

    /// Cells of each of the two states: those of the grid, the ring and two more rows.
    pub(crate) const fn cells(grid: Grid) -> usize {
        let padding = Padding::of(grid);
        padding.len() + 2 * padding.stride
    }

    /// Makes both states dark again after a propagation that reached `window`.
    pub(crate) fn clear(&mut self, window: Window) {
        // Passed-on light may lie one cell outside of the window that passed it on, in the ghost ring too, and after
        // steps in place two rows on.
        for y in window.y0..window.y1 + 5 {
            let row = self.padding.ghost(window.x0, y)..self.padding.ghost(window.x1 + 3, y);
            self.from[row.clone()].fill([[0.0; N]; 8]);
            self.to[row].fill([[0.0; N]; 8]);
        }
        self.start = 0;
    }

    /// [`Buffers::step_with`] on any processor.
    pub(crate) fn step(
        &mut self,
        field: &Scattering<'_>,
        window: Window,
        specials: &Specials<N>,
    ) -> [f64; N] {
        self.step_with::<N, Plain<N>>((), field, window, specials)
    }

    /// Passes light on from every cell of `window` and makes the result the current state (`from`) and the one before
    /// `to`. Returns the flux that went to existing neighbours: each row alone, then rows in order.
    #[inline(always)]
    pub(crate) fn step_with<const W: usize, V: Vector<W>>(
        &mut self,
        proof: V::Proof,
        field: &Scattering<'_>,
        window: Window,
        specials: &Specials<N>,
    ) -> [f64; N] {
        for y in window.y0..=window.y1 {
            let from = &self.from[self.padding.index(0, y)..];
            let to = &mut self.to[self.padding.ghost(0, y)..];
            let mut row = Row { grid: self.grid, y, from, to, flux: [0.0; N] };
            row.pass::<W, V>(proof, field, window, specials);
            self.row_flux[y] = row.flux;
        }
        std::mem::swap(&mut self.from, &mut self.to);
        self.total_flux(window)
    }

    /// The same without keeping the state before: half the memory to move.
    ///
    /// The new state lies two rows before or after the old one in the same buffer, and rows are passed on in the order
    /// that overwrites only what has been read (a compressed grid: Pohl et al., Parallel Processing Letters 13, 2003).
    #[inline(always)]
    pub(crate) fn step_in_place<const W: usize, V: Vector<W>>(
        &mut self,
        proof: V::Proof,
        field: &Scattering<'_>,
        window: Window,
        specials: &Specials<N>,
    ) -> [f64; N] {
        let two_rows = 2 * self.padding.stride;
        let forth = self.start == 0;
        let new_start = if forth { two_rows } else { 0 };
        for n in 0..=window.y1 - window.y0 {
            let y = if forth { window.y1 - n } else { window.y0 + n };
            // What the old state left in the last three rows of the new one goes: two are not written whole, and the
            // third not at all.
            if n + 1 >= window.y1 - window.y0 {
                self.darken(window, y + 2);
            }
            let old = self.start + self.padding.index(0, y);
            let new = new_start + self.padding.ghost(0, y);
            let (from, to) = if forth {
                let (from, to) = self.from.split_at_mut(new);
                (&from[old..], to)
            } else {
                let (to, from) = self.from.split_at_mut(old);
                (&*from, &mut to[new..])
            };
            let mut row = Row { grid: self.grid, y, from, to, flux: [0.0; N] };
            row.pass::<W, V>(proof, field, window, specials);
            self.row_flux[y] = row.flux;
        }
        self.darken(window, if forth { window.y0 + 1 } else { window.y1 + 3 });
        self.start = new_start;
        self.total_flux(window)
    }

    /// Makes one row of the buffer dark where light of `window` reaches. Row 0 is the ghost row of a state that starts
    /// at 0, row 2 that of one that starts two rows on.
    fn darken(&mut self, window: Window, row: usize) {
        let row = self.padding.ghost(window.x0, row)..self.padding.ghost(window.x1 + 3, row);
        self.from[row].fill([[0.0; N]; 8]);
    }

    fn total_flux(&self, window: Window) -> [f64; N] {
        let mut total = [0.0; N];
        for row in &self.row_flux[window.y0..=window.y1] {
            for l in 0..N {
                total[l] += row[l];
            }
        }
        total
    }
}

/// One row that passes its light on.
struct Row<'a, const N: usize> {
    grid: Grid,
    y: usize,
    /// The current state from column 0 of the row on.
    from: &'a [Lobes<N>],
    /// The new state from the ghost column of the row above on.
    to: &'a mut [Lobes<N>],
    /// Flux to existing neighbours.
    flux: [f64; N],
}

impl<const N: usize> Row<'_, N> {
    #[inline(always)]
    fn pass<const W: usize, V: Vector<W>>(
        &mut self,
        proof: V::Proof,
        field: &Scattering<'_>,
        window: Window,
        specials: &Specials<N>,
    ) {
        let (y, mut x) = (self.y, window.x0);
        for (cell, phi) in specials.iter().filter(|(c, _)| c.y == y) {
            self.pass_span::<W, V>(proof, field, x..cell.x);
            self.pass_special(cell.x, phi);
            x = cell.x + 1;
        }
        self.pass_span::<W, V>(proof, field, x..window.x1 + 1);
    }

    /// Cells `span`: borders apart, so that the inner loop asks nothing.
    #[inline(always)]
    fn pass_span<const W: usize, V: Vector<W>>(
        &mut self,
        proof: V::Proof,
        field: &Scattering<'_>,
        span: Range<usize>,
    ) {
        let first = span.start.max(1).min(span.end);
        let last = span.end.min(self.grid.width() - 1).max(first);
        for part in [span.start..first, first..last, last..span.end] {
            if part.is_empty() {
                continue;
            }
            let reached = self.reached(part.start);
            if reached == [true; 8] {
                self.pass_cells::<true, W, V>(proof, field, part, &reached);
            } else {
                self.pass_cells::<false, W, V>(proof, field, part, &reached);
            }
        }
    }

    /// Which neighbours of a cell exist.
    fn reached(&self, x: usize) -> [bool; 8] {
        std::array::from_fn(|k| self.grid.neighbour(Cell::new(x, self.y), k).is_some())
    }

    /// Cells `span`, of which the neighbours `reached` exist: all of them if `INNER`.
    #[inline(always)]
    fn pass_cells<const INNER: bool, const W: usize, V: Vector<W>>(
        &mut self,
        proof: V::Proof,
        field: &Scattering<'_>,
        span: Range<usize>,
        reached: &[bool; 8],
    ) {
        let cell = self.grid.index(Cell::new(span.start, self.y));
        let matrices = &field.cells[cell..cell + span.len()];
        let from = &self.from[span.clone()];
        let (above, rest) = self.to[span.start..].split_at_mut(self.grid.width() + 2);
        let (here, below) = rest.split_at_mut(self.grid.width() + 2);
        for (j, (a, m)) in from.iter().zip(matrices).enumerate() {
            let to = [&mut above[j..j + 3], &mut here[j..j + 3], &mut below[j..j + 3]];
            for c in 0..N / W {
                let a = load8::<N, W, V>(proof, a, c);
                let ma = scattered(proof, m, &a);
                let mut phi = normalized_to(proof, m.rate, sum_of_eight(&a), &ma, sum_of_eight(&ma));
                for k in 0..8 {
                    let (dx, dy) = NEIGHBOUR_OFFSETS[k];
                    phi[k].store_part(&mut to[(dy + 1) as usize][(dx + 1) as usize][k], c);
                    if !INNER && !reached[k] {
                        phi[k] = V::splat(proof, 0.0);
                    }
                }
                sum_of_eight(&phi).add_to(proof, &mut self.flux, c);
            }
        }
    }

    /// One cell that passes on `phi`.
    #[inline(always)]
    fn pass_special(&mut self, x: usize, phi: &Lobes<N>) {
        let reached = self.reached(x);
        let mut passed = *phi;
        for k in 0..8 {
            let (dx, dy) = NEIGHBOUR_OFFSETS[k];
            let row = (dy + 1) as usize * (self.grid.width() + 2);
            self.to[row + x + (dx + 1) as usize][k] = phi[k];
            if !reached[k] {
                passed[k] = [0.0; N];
            }
        }
        let passed = sum8(&passed);
        for l in 0..N {
            self.flux[l] += passed[l];
        }
    }
}
