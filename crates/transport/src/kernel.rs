//! The reduced step of one light distribution, in its plainest form.
//!
//! The state is eight fluxes a cell on a grid with a ring of ghost cells: every cell may pass light on to all eight
//! neighbours, and what reaches the ring is never read again (the absorbing rim). A slot (cell, k) has one writer, the
//! cell behind it, so the two states need no clearing between steps.

use crate::linear::{Band, banded};
use crate::scattering::{CellScattering, Lobes, NOTHING_PASSES, Scattering};
use crate::window::Window;
use tigereye_core::{Cell, Grid, NEIGHBOUR_OFFSETS};

/// Where cells lie in a padded buffer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Padding {
    stride: usize,
    rows: usize,
}

impl Padding {
    const fn of(grid: Grid) -> Self {
        Self { stride: grid.width() + 2, rows: grid.height() + 2 }
    }
    pub(crate) const fn index(self, x: usize, y: usize) -> usize {
        (y + 1) * self.stride + x + 1
    }
}

/// `M a`.
///
/// The order of the additions is symmetric under mirroring and quarter turns: symmetric light stays symmetric to the
/// last bit wherever the matrices are.
pub(crate) fn scattered(m: &CellScattering, a: &Lobes) -> Lobes {
    std::array::from_fn(|k| {
        let b = &m.band[k % 4];
        let near = b[1] * a[(k + 7) % 8] + b[3] * a[(k + 1) % 8];
        let far = b[0] * a[(k + 6) % 8] + b[4] * a[(k + 2) % 8];
        (b[2] * a[k] + near) + far
    })
}

/// Sum over the eight directions, opposite ones first.
pub(crate) fn sum_of_eight(a: &Lobes) -> f64 {
    ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]))
}

/// `Phi = Tbar energy (M a) / sum(M a)`; nothing where nothing passes.
pub(crate) fn normalized(rate: f64, energy: f64, ma: &Lobes) -> Lobes {
    let sum = sum_of_eight(ma);
    let factor = if sum > energy * NOTHING_PASSES { rate * energy / sum } else { 0.0 };
    ma.map(|v| factor * v)
}

/// The current state and the one before.
pub(crate) struct Buffers {
    pub(crate) from: Vec<Lobes>,
    pub(crate) to: Vec<Lobes>,
    pub(crate) padding: Padding,
    grid: Grid,
}

impl Buffers {
    pub(crate) fn new(grid: Grid) -> Self {
        let padding = Padding::of(grid);
        let dark = || vec![[0.0; 8]; padding.stride * padding.rows];
        Self { from: dark(), to: dark(), padding, grid }
    }

    /// Passes light on from every cell of `window` and makes the result the current state (`from`) and the one before
    /// `to`. `specials` (lights, in row-major order) pass on what they say instead of their lobes' flux. Returns the
    /// flux that went to existing neighbours: each row alone, then rows in order.
    ///
    /// With `bands`, every lobe is scattered by itself.
    pub(crate) fn step(
        &mut self,
        field: &Scattering<'_>,
        bands: Option<&[Band]>,
        window: Window,
        specials: &[(Cell, Lobes)],
    ) -> f64 {
        let mut total = 0.0;
        let mut specials = specials.iter().peekable();
        for y in window.y0..=window.y1 {
            let mut row = 0.0;
            for x in window.x0..=window.x1 {
                let cell = Cell::new(x, y);
                let phi = match specials.next_if(|(c, _)| *c == cell) {
                    Some((_, phi)) => *phi,
                    None => {
                        let i = self.grid.index(cell);
                        let (m, a) = (&field.cells[i], &self.from[self.padding.index(x, y)]);
                        match (field.transmission().reflection(cell), bands) {
                            (Some(wall), _) => wall.reflected(a),
                            (None, Some(bands)) => banded(&bands[i], a),
                            (None, None) => normalized(m.rate, sum_of_eight(a), &scattered(m, a)),
                        }
                    }
                };
                row += self.pass(cell, phi);
            }
            total += row;
        }
        std::mem::swap(&mut self.from, &mut self.to);
        total
    }

    /// Hands `phi` to the neighbours; the flux to those that exist.
    fn pass(&mut self, cell: Cell, mut phi: Lobes) -> f64 {
        for k in 0..8 {
            let (dx, dy) = NEIGHBOUR_OFFSETS[k];
            let there = self.padding.index(cell.x, cell.y) as isize + dy * self.padding.stride as isize + dx;
            self.to[there as usize][k] = phi[k];
            if self.grid.neighbour(cell, k).is_none() {
                phi[k] = 0.0;
            }
        }
        sum_of_eight(&phi)
    }
}
