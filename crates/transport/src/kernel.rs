//! The reduced step for N independent lanes that share one field.
//!
//! The state is `[cell][8 directions][lane]` on a grid with a ring of ghost cells: every cell may pass light on to all
//! eight neighbours, and what reaches the ring is never read again (the absorbing rim). A slot (cell, k) has one writer,
//! the cell behind it, so the buffers need no clearing between steps.

use crate::scattering::{CellScattering, Scattering};
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
    /// The padded cell that the light of padded cell `i` in direction `k` reaches.
    #[inline(always)]
    pub(crate) const fn towards(self, i: usize, k: usize) -> usize {
        let (dx, dy) = NEIGHBOUR_OFFSETS[k];
        (i as isize + dy * self.stride as isize + dx) as usize
    }
}

/// `M a`, its sum and the sum of `a` of one cell.
///
/// The order of the additions is symmetric under mirroring and quarter turns: symmetric light stays symmetric to the
/// last bit wherever the matrices are.
#[inline(always)]
pub(crate) fn scatter<const N: usize>(m: &CellScattering, a: &Lobes<N>) -> (Lobes<N>, [f64; N], [f64; N]) {
    let mut ma = [[0.0; N]; 8];
    for k in 0..8 {
        let b = &m.band[k % 4];
        let (left2, left1, here) = (&a[(k + 6) % 8], &a[(k + 7) % 8], &a[k]);
        let (right1, right2) = (&a[(k + 1) % 8], &a[(k + 2) % 8]);
        for l in 0..N {
            let near = b[1] * left1[l] + b[3] * right1[l];
            let far = b[0] * left2[l] + b[4] * right2[l];
            ma[k][l] = (b[2] * here[l] + near) + far;
        }
    }
    (ma, sum8(&ma), sum8(a))
}

/// Sum over the eight directions, opposite ones first.
#[inline(always)]
pub(crate) fn sum8<const N: usize>(a: &Lobes<N>) -> [f64; N] {
    let mut sum = [0.0; N];
    for l in 0..N {
        sum[l] = ((a[0][l] + a[4][l]) + (a[2][l] + a[6][l])) + ((a[1][l] + a[5][l]) + (a[3][l] + a[7][l]));
    }
    sum
}

/// `Phi = Tbar energy (M a) / sum(M a)`; nothing where nothing passes.
#[inline(always)]
pub(crate) fn normalized<const N: usize>(
    rate: f64,
    energy: &[f64; N],
    ma: &Lobes<N>,
    sum_ma: &[f64; N],
) -> Lobes<N> {
    let mut factor = [0.0; N];
    for l in 0..N {
        let quotient = rate * energy[l] / sum_ma[l];
        factor[l] = if sum_ma[l] > 0.0 { quotient } else { 0.0 };
    }
    let mut phi = [[0.0; N]; 8];
    for k in 0..8 {
        for l in 0..N {
            phi[k][l] = factor[l] * ma[k][l];
        }
    }
    phi
}

/// Two states and where they differ from 0.
pub(crate) struct Buffers<const N: usize> {
    pub(crate) from: Vec<Lobes<N>>,
    pub(crate) to: Vec<Lobes<N>>,
    pub(crate) padding: Padding,
    grid: Grid,
}

/// What special cells (lights) pass on this step instead of their lobes' flux, in row-major order of the cells.
pub(crate) type Specials<const N: usize> = [(Cell, Lobes<N>)];

impl<const N: usize> Buffers<N> {
    pub(crate) fn new(grid: Grid) -> Self {
        let padding = Padding::of(grid);
        let dark = vec![[[0.0; N]; 8]; padding.len()];
        Self { from: dark.clone(), to: dark, padding, grid }
    }

    /// Makes both states dark again after a propagation that reached `window`.
    pub(crate) fn clear(&mut self, window: Window) {
        // Passed-on light may lie one cell outside of the window that passed it on, in the ghost ring too.
        for y in 0..=(window.y1 - window.y0 + 2) {
            let start =
                self.padding.index(window.x0, window.y0) + y * self.padding.stride - self.padding.stride - 1;
            let row = start..start + window.x1 - window.x0 + 3;
            self.from[row.clone()].fill([[0.0; N]; 8]);
            self.to[row].fill([[0.0; N]; 8]);
        }
    }

    /// Passes light on from every cell of `window` and makes the result the current state (`from`). Returns the flux
    /// that went to existing neighbours: each row alone, then rows in order.
    #[inline(always)]
    pub(crate) fn step(
        &mut self,
        field: &Scattering<'_>,
        window: Window,
        specials: &Specials<N>,
    ) -> [f64; N] {
        let mut total = [0.0; N];
        let mut specials = specials.iter().peekable();
        for y in window.y0..=window.y1 {
            let mut row = [0.0; N];
            let mut x = window.x0;
            while x <= window.x1 {
                let special = specials.next_if(|(c, _)| c.y == y);
                let end = special.map_or(window.x1 + 1, |(c, _)| c.x);
                self.pass_span(field, y, x, end, &mut row);
                if let Some((cell, phi)) = special {
                    self.pass_border(*cell, phi, &mut row);
                }
                x = end + 1;
            }
            for l in 0..N {
                total[l] += row[l];
            }
        }
        std::mem::swap(&mut self.from, &mut self.to);
        total
    }

    /// Cells `x..end` of row `y`.
    #[inline(always)]
    fn pass_span(&mut self, field: &Scattering<'_>, y: usize, x: usize, end: usize, row: &mut [f64; N]) {
        let (w, h) = (self.grid.width(), self.grid.height());
        let inner_row = y > 0 && y + 1 < h;
        for x in x..end {
            let m = &field.cells[y * w + x];
            let i = self.padding.index(x, y);
            let (ma, sum_ma, energy) = scatter(m, &self.from[i]);
            let phi = normalized(m.rate, &energy, &ma, &sum_ma);
            if inner_row && x > 0 && x + 1 < w {
                for k in 0..8 {
                    self.to[self.padding.towards(i, k)][k] = phi[k];
                }
                let passed = sum8(&phi);
                for l in 0..N {
                    row[l] += passed[l];
                }
            } else {
                self.pass_border(Cell::new(x, y), &phi, row);
            }
        }
    }

    /// One cell whose neighbours may be missing.
    #[inline(always)]
    fn pass_border(&mut self, cell: Cell, phi: &Lobes<N>, row: &mut [f64; N]) {
        let i = self.padding.index(cell.x, cell.y);
        let mut passed = *phi;
        for k in 0..8 {
            self.to[self.padding.towards(i, k)][k] = phi[k];
            if self.grid.neighbour(cell, k).is_none() {
                passed[k] = [0.0; N];
            }
        }
        let passed = sum8(&passed);
        for l in 0..N {
            row[l] += passed[l];
        }
    }
}
