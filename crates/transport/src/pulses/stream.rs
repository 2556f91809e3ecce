//! N lanes of light that share one field, stepping in place.
//!
//! The state is `[cell][slot][lane]`, eight slots per cell, on a grid with a ring of ghost cells. Steps alternate (the
//! AA pattern of lattice Boltzmann methods: Bailey et al., ICPP 2009), so that each step reads and writes the same
//! slots and no second state is needed:
//!
//! - an **even** step reads the flux arriving in direction k from slot k of the cell itself and writes the flux emitted
//!   in direction k to its own opposite slot k + 4;
//! - an **odd** step reads the flux arriving in direction k from slot k + 4 of the neighbour it comes from, and writes
//!   the flux emitted in direction k to slot k of the neighbour it goes to: the same eight slots.
//!
//! No light enters from outside (the border absorbs): slots that a cell outside would have filled stay 0.
//!
//! Several steps may be **fused**: step s of a fused run handles row `r - s` and columns one to the left of those of
//! the step before, strip after strip, so that a cell's slots stay in the cache from one step to the next. The numbers
//! do not depend on it: every cell's step is the same, and flux is summed along each row from left to right, then over
//! the rows.

use crate::aligned::Aligned;
use crate::pulses::memory::Memory;
use crate::pulses::passage::Passage;
use crate::pulses::source::Source;
use crate::pulses::walls::Walls;
use crate::window::Window;
use core::ops::Range;
use tigereye_core::{Cell, Grid, NEIGHBOUR_OFFSETS};
use tigereye_simd::Number;
use tigereye_simd::Vector;

/// Eight numbers for each of N lanes.
pub(crate) type Lobes<T, const N: usize> = [[T; N]; 8];

/// Largest number of fused steps: ten rows of a strip then fit into a second-level cache of 1 MB.
pub(crate) const MAX_FUSED: usize = 8;

/// Bytes of a strip's row.
const STRIP_BYTES: usize = 96 << 10;

/// The two kinds of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parity {
    Even,
    Odd,
}

impl Parity {
    pub(crate) const fn other(self) -> Self {
        match self {
            Self::Even => Self::Odd,
            Self::Odd => Self::Even,
        }
    }
}

/// Light of N lanes.
#[derive(Debug)]
pub(crate) struct Stream<T, const N: usize> {
    numbers: Aligned<T>,
    grid: Grid,
    /// Cells from one row to the next.
    stride: usize,
    /// The kind of the next step.
    parity: Parity,
    /// Flux to existing neighbours, per fused step and row.
    row_flux: Vec<[f64; N]>,
    /// For stationary states, created on first use.
    memory: Option<Box<Memory<T, N>>>,
}

/// The inputs shared by all steps of a run.
pub(crate) struct Medium<'a, T, const N: usize> {
    /// Passages of the cells, row-major.
    pub(crate) cells: &'a [Passage<T>],
    /// The reflecting cells; their passages transmit nothing.
    pub(crate) walls: &'a Walls<T>,
    /// The pulses.
    pub(crate) source: Source<T, N>,
}

impl<T: Number, const N: usize> Medium<'_, T, N> {
    /// The light emitted by a cell of any kind in the `c`-th vector of lanes, given the arriving light `a`.
    ///
    /// The source is checked first: a pulse inside a wall emits nothing.
    #[inline(always)]
    pub(crate) fn passed<V: Vector<Number = T>>(
        &self,
        proof: V::Proof,
        c: usize,
        index: usize,
        cell: Cell,
        a: &[V; 8],
    ) -> [V; 8] {
        let passage = &self.cells[index];
        if cell == self.source.cell() {
            return self.source.passed(proof, c, passage, a);
        }
        match self.walls.at(cell) {
            Some(wall) => wall.pass(proof, a),
            None => passage.pass(proof, a).phi,
        }
    }
}

impl<T: Number, const N: usize> Stream<T, N> {
    pub(crate) fn dark(grid: Grid) -> Self {
        let numbers = Aligned::zeros(Self::cells(grid) * 8 * N);
        let row_flux = vec![[0.0; N]; MAX_FUSED * grid.height()];
        Self { numbers, grid, stride: Self::stride(grid), parity: Parity::Even, row_flux, memory: None }
    }

    pub(crate) const fn grid(&self) -> Grid {
        self.grid
    }
    pub(crate) const fn parity(&self) -> Parity {
        self.parity
    }

    /// The slots of a cell.
    #[inline(always)]
    pub(crate) fn cell(&self, cell: Cell) -> &Lobes<T, N> {
        &self.slots()[self.index(cell.x, cell.y)]
    }
    #[inline(always)]
    pub(crate) fn cell_mut(&mut self, cell: Cell) -> &mut Lobes<T, N> {
        let here = self.index(cell.x, cell.y);
        &mut self.slots_mut()[here]
    }

    /// The slots of the cell in direction `k`, which may be a ghost.
    #[inline(always)]
    pub(crate) fn beyond(&self, cell: Cell, k: usize) -> &Lobes<T, N> {
        let (dx, dy) = NEIGHBOUR_OFFSETS[k];
        let here = self.index(cell.x, cell.y) as isize;
        &self.slots()[(here + dx + dy * self.stride as isize) as usize]
    }

    /// A cleared history.
    pub(crate) fn memory(&mut self) -> Box<Memory<T, N>> {
        let mut memory = self.memory.take().unwrap_or_else(|| Box::new(Memory::new(self.grid.cells())));
        memory.clear();
        memory
    }
    /// Keeps a history for reuse.
    pub(crate) fn keep(&mut self, memory: Box<Memory<T, N>>) {
        self.memory = Some(memory);
    }

    #[inline(always)]
    fn slots(&self) -> &[Lobes<T, N>] {
        self.numbers.as_slice().as_chunks().0.as_chunks().0
    }

    #[inline(always)]
    fn slots_mut(&mut self) -> &mut [Lobes<T, N>] {
        self.numbers.as_mut_slice().as_chunks_mut().0.as_chunks_mut().0
    }

    /// Number of cells in memory.
    pub(crate) const fn cells(grid: Grid) -> usize {
        Self::stride(grid) * (grid.height() + 2)
    }

    /// Rows are an odd number of cells apart: rows a multiple of 4096 bytes apart would conflict in the cache.
    const fn stride(grid: Grid) -> usize {
        (grid.width() + 2) | 1
    }

    const fn index(&self, x: usize, y: usize) -> usize {
        (y + 1) * self.stride + x + 1
    }

    /// Makes the state dark again after a propagation that reached `window`.
    pub(crate) fn clear(&mut self, window: Window) {
        for y in window.y0..=window.y1 + 2 {
            let start = y * self.stride + window.x0;
            self.slots_mut()[start..start + window.x1 - window.x0 + 3].fill([[T::default(); N]; 8]);
        }
        self.parity = Parity::Even;
    }

    /// Copies the lanes `lanes` of the cells of `window` to distributions, `to[i][cell][direction]` for lane
    /// `lanes[i]`.
    pub(crate) fn copy_lanes(&self, window: Window, lanes: &[usize], to: &mut [&mut [[T; 8]]]) {
        let width = window.x1 - window.x0 + 1;
        for y in window.y0..=window.y1 {
            let first = Cell::new(window.x0, y);
            let from: [&[Lobes<T, N>]; 8] = std::array::from_fn(|k| &self.arriving(first, k)[..width]);
            let slot: [usize; 8] = std::array::from_fn(|k| self.slot_of(k));
            let at = self.grid.index(first);
            for (to, &l) in to.iter_mut().zip(lanes) {
                for (x, to) in to[at..at + width].iter_mut().enumerate() {
                    *to = std::array::from_fn(|k| from[k][x][slot[k]][l]);
                }
            }
        }
    }

    /// The cells that hold the flux arriving in direction `k`, from that of `cell` on.
    fn arriving(&self, cell: Cell, k: usize) -> &[Lobes<T, N>] {
        let here = self.index(cell.x, cell.y);
        let (dx, dy) = NEIGHBOUR_OFFSETS[k];
        match self.parity {
            Parity::Even => &self.slots()[here..],
            Parity::Odd => &self.slots()[(here as isize - dx - dy * self.stride as isize) as usize..],
        }
    }

    /// Its slot there.
    const fn slot_of(&self, k: usize) -> usize {
        match self.parity {
            Parity::Even => k,
            Parity::Odd => opposite(k),
        }
    }

    /// `steps` fused steps. `window` is where light is before them. Returns for each step the flux to existing
    /// neighbours, W, and the window it passed on from.
    #[inline(always)]
    pub(crate) fn advance<V: Vector<Number = T>>(
        &mut self,
        proof: V::Proof,
        medium: &Medium<'_, T, N>,
        window: Window,
        steps: usize,
    ) -> ([[f64; N]; MAX_FUSED], [Window; MAX_FUSED]) {
        let mut windows = [window; MAX_FUSED];
        for s in 1..steps {
            windows[s] = windows[s - 1].grown(self.grid);
        }
        let height = self.grid.height();
        self.row_flux[..steps * height].fill([0.0; N]);
        // In skewed coordinates x + s and y + s every step follows the one before.
        let columns = windows[..steps].iter().enumerate().map(|(s, w)| w.x1 + s).max().unwrap_or(0);
        let rows = windows[..steps].iter().enumerate().map(|(s, w)| w.y1 + s).max().unwrap_or(0);
        let strip = STRIP_BYTES / size_of::<Lobes<T, N>>();
        let mut start = window.x0;
        while start <= columns {
            // The last strip absorbs a thin remainder.
            let end = if start + strip + strip / 2 > columns { columns + 1 } else { start + strip };
            for row in window.y0..=rows {
                let mut parity = self.parity;
                for s in 0..steps.min(row + 1) {
                    let (w, y) = (windows[s], row - s);
                    if y >= w.y0 && y <= w.y1 {
                        let span = start.saturating_sub(s).max(w.x0)..(end - s.min(end)).min(w.x1 + 1);
                        if !span.is_empty() {
                            let mut flux = self.row_flux[s * height + y];
                            self.pass_row::<V>(proof, medium, parity, y, span, &mut flux);
                            self.row_flux[s * height + y] = flux;
                        }
                    }
                    parity = parity.other();
                }
            }
            start = end;
        }
        if steps % 2 == 1 {
            self.parity = self.parity.other();
        }
        let mut totals = [[0.0; N]; MAX_FUSED];
        for s in 0..steps {
            for row in &self.row_flux[s * height + windows[s].y0..=s * height + windows[s].y1] {
                for l in 0..N {
                    totals[s][l] += row[l];
                }
            }
        }
        (totals, windows)
    }

    /// Cells `span` of row `y`: borders, walls and the source separately, so that the inner loop has no branches.
    #[inline(always)]
    fn pass_row<V: Vector<Number = T>>(
        &mut self,
        proof: V::Proof,
        medium: &Medium<'_, T, N>,
        parity: Parity,
        y: usize,
        span: Range<usize>,
        flux: &mut [f64; N],
    ) {
        let source = medium.source.cell();
        let last = self.grid.width() - 1;
        let border_row = y == 0 || y + 1 == self.grid.height();
        let mut walls = medium.walls.right_of(y, span.start);
        let mut x = span.start;
        while x < span.end {
            let mut end = span.end;
            if let [(column, _), rest @ ..] = walls {
                if *column == x {
                    walls = rest;
                }
                end = end.min(*column);
            }
            // An end at x itself: a wall.
            if end == x || (Cell { x, y }) == source {
                self.pass_single::<V>(proof, medium, parity, Cell { x, y }, flux);
                x += 1;
                continue;
            }
            if x == 0 {
                end = end.min(1);
            } else if x < last {
                end = end.min(last);
            }
            if y == source.y && source.x > x {
                end = end.min(source.x);
            }
            let inner = !border_row && x > 0 && x < last;
            match (parity, inner) {
                (Parity::Even, true) => self.even::<true, V>(proof, medium, y, x..end, flux),
                (Parity::Even, false) => self.even::<false, V>(proof, medium, y, x..end, flux),
                (Parity::Odd, true) => self.odd::<true, V>(proof, medium, y, x..end, flux),
                (Parity::Odd, false) => self.odd::<false, V>(proof, medium, y, x..end, flux),
            }
            x = end;
        }
    }

    /// The existing neighbours of a cell.
    pub(crate) fn reached(&self, cell: Cell) -> [bool; 8] {
        std::array::from_fn(|k| self.grid.neighbour(cell, k).is_some())
    }

    #[inline(always)]
    fn even<const INNER: bool, V: Vector<Number = T>>(
        &mut self,
        proof: V::Proof,
        medium: &Medium<'_, T, N>,
        y: usize,
        span: Range<usize>,
        flux: &mut [f64; N],
    ) {
        let first = Cell::new(span.start, y);
        let kept: [V; 8] = kept(proof, &if INNER { [true; 8] } else { self.reached(first) });
        let cell = self.grid.index(first);
        let here = self.index(span.start, y);
        let passages = &medium.cells[cell..cell + span.len()];
        for (slots, passage) in self.slots_mut()[here..here + span.len()].iter_mut().zip(passages) {
            for c in 0..N / V::WIDTH {
                let a: [V; 8] = load8(proof, c, |k| &slots[k]);
                let phi = left::<INNER, V, N>(proof, passage, &a, &kept, flux, c);
                for k in 0..8 {
                    phi[k].store(&mut slots[opposite(k)], c);
                }
            }
        }
    }

    #[inline(always)]
    fn odd<const INNER: bool, V: Vector<Number = T>>(
        &mut self,
        proof: V::Proof,
        medium: &Medium<'_, T, N>,
        y: usize,
        span: Range<usize>,
        flux: &mut [f64; N],
    ) {
        let first = Cell::new(span.start, y);
        let kept: [V; 8] = kept(proof, &if INNER { [true; 8] } else { self.reached(first) });
        let cell = self.grid.index(first);
        let passages = &medium.cells[cell..cell + span.len()];
        let mut rows = self.three_rows(first, span.len());
        for (j, passage) in passages.iter().enumerate() {
            let mut around = rows.each_mut().map(|row| &mut row[j..j + 3]);
            for c in 0..N / V::WIDTH {
                let a: [V; 8] = load8(proof, c, |k| slot(&around, opposite(k)));
                let phi = left::<INNER, V, N>(proof, passage, &a, &kept, flux, c);
                for k in 0..8 {
                    phi[k].store(slot_mut(&mut around, k), c);
                }
            }
        }
    }

    /// From the cell up and to the left of `first` on: `length` and two more cells of three rows.
    #[inline(always)]
    pub(crate) fn three_rows(&mut self, first: Cell, length: usize) -> [&mut [Lobes<T, N>]; 3] {
        let stride = self.stride;
        let (above, rest) = self.slots_mut()[first.y * stride + first.x..].split_at_mut(stride);
        let (here, below) = rest.split_at_mut(stride);
        [&mut above[..length + 2], &mut here[..length + 2], &mut below[..length + 2]]
    }

    /// The cell of the pulses, or a wall.
    #[inline(always)]
    fn pass_single<V: Vector<Number = T>>(
        &mut self,
        proof: V::Proof,
        medium: &Medium<'_, T, N>,
        parity: Parity,
        cell: Cell,
        flux: &mut [f64; N],
    ) {
        let kept: [V; 8] = kept(proof, &self.reached(cell));
        let index = self.grid.index(cell);
        let mut a = [[T::default(); N]; 8];
        let mut rows = self.three_rows(cell, 1);
        for k in 0..8 {
            a[k] = match parity {
                Parity::Even => rows[1][1][k],
                Parity::Odd => *slot(&rows, opposite(k)),
            };
        }
        for c in 0..N / V::WIDTH {
            let a: [V; 8] = load8(proof, c, |k| &a[k]);
            let mut phi = medium.passed(proof, c, index, cell, &a);
            keep(&mut phi, &kept);
            super::passage::sum_of_eight(&phi).add_to(flux, c);
            for k in 0..8 {
                match parity {
                    Parity::Even => phi[k].store(&mut rows[1][1][opposite(k)], c),
                    Parity::Odd => phi[k].store(slot_mut(&mut rows, k), c),
                }
            }
        }
    }
}

/// The light that a cell passes on, with its flux added to the sum. Light towards the outside is lost: its slot is set
/// to 0, so that it does not return.
#[inline(always)]
fn left<const INNER: bool, V: Vector, const N: usize>(
    proof: V::Proof,
    passage: &Passage<V::Number>,
    a: &[V; 8],
    kept: &[V; 8],
    flux: &mut [f64; N],
    c: usize,
) -> [V; 8] {
    let mut passed = passage.pass(proof, a);
    if INNER {
        passed.total.add_to(flux, c);
    } else {
        keep(&mut passed.phi, kept);
        super::passage::sum_of_eight(&passed.phi).add_to(flux, c);
    }
    passed.phi
}

/// 1 in every lane for directions towards existing neighbours, 0 for the others: factors that change no bit of what is
/// kept.
#[inline(always)]
fn kept<V: Vector>(proof: V::Proof, reached: &[bool; 8]) -> [V; 8] {
    let mut kept = [V::splat(proof, V::Number::default()); 8];
    for k in 0..8 {
        if reached[k] {
            kept[k] = V::splat(proof, V::Number::narrowed(1.0));
        }
    }
    kept
}

#[inline(always)]
fn keep<V: Vector>(phi: &mut [V; 8], kept: &[V; 8]) {
    for k in 0..8 {
        phi[k] = phi[k] * kept[k];
    }
}

/// Slot k of the neighbour in direction k, of three cells of three rows.
#[inline(always)]
fn slot<'a, T, const N: usize>(rows: &'a [&mut [Lobes<T, N>]; 3], k: usize) -> &'a [T; N] {
    let (dx, dy) = NEIGHBOUR_OFFSETS[k];
    &rows[(dy + 1) as usize][(dx + 1) as usize][k]
}

/// The same, mutable.
#[inline(always)]
pub(crate) fn slot_mut<'a, T, const N: usize>(
    rows: &'a mut [&mut [Lobes<T, N>]; 3],
    k: usize,
) -> &'a mut [T; N] {
    let (dx, dy) = NEIGHBOUR_OFFSETS[k];
    &mut rows[(dy + 1) as usize][(dx + 1) as usize][k]
}

#[inline(always)]
const fn opposite(k: usize) -> usize {
    (k + 4) % 8
}

/// Part `c` of eight arrays.
#[inline(always)]
pub(crate) fn load8<'a, V: Vector, const N: usize>(
    proof: V::Proof,
    c: usize,
    of: impl Fn(usize) -> &'a [V::Number; N],
) -> [V; 8]
where
    V::Number: 'a,
{
    let mut v = [V::splat(proof, V::Number::default()); 8];
    for k in 0..8 {
        v[k] = V::load(proof, of(k), c);
    }
    v
}
