//! The stationary light of one source, by sweeps: for fields too large to be taken apart, or too few questions to be
//! worth it.
//!
//! A sweep visits the cells in order and lets each pass on what it has received at once, so light crosses the field in
//! a single sweep that goes its way; a round sweeps from all four corners. Rounds alone need more and more sweeps as
//! fields grow (1000 and more for 256 x 256 cells), because light wanders. As the preconditioner of BiCGSTAB (van der
//! Vorst 1992) a round settles 512 x 512 cells to 1e-6 in 170 to 250 sweeps on the thesis's fields.

use super::cells::LinearScattering;
use super::dissection::Operator;
use crate::TransportError;
use std::ops::ControlFlow;
use tigereye_core::{Cell, NEIGHBOUR_OFFSETS, math};

/// Limit on the sweeps of one search: enough for fields of ten thousand cells per side to settle.
const MOST_SWEEPS: usize = 8000;
/// What a plain step may still change, as a part of what the sources inject: where light is trapped, it grows until any
/// change is a small part of it.
const BALANCE: f64 = 1e-3;
/// The order of the corners of a round: opposite ones follow each other.
const CORNERS: [[bool; 2]; 4] = [[false, false], [true, true], [true, false], [false, true]];

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// The eight lobes of each cell, W; in the numbering of [`super::Dissection`] for light followed back.
    pub lobes: Vec<[f64; 8]>,
    /// Sweeps and plain steps over the whole field.
    pub sweeps: usize,
    /// What a plain step would change, as a part of all light (L1).
    pub residual: f64,
}

/// Told the sweeps and the residual after each iteration; `Break` ends the search as if it had failed.
pub type Watch<'a> = dyn FnMut(usize, f64) -> ControlFlow<()> + 'a;

/// Solves `a = A a + q` (or the adjoint) until a plain step changes `a` by no more than `tolerance` (L1, relative), and
/// by no more than a thousandth of `q`. `watch` is told the sweeps and the residual after each iteration; `Break` ends
/// the search as if it had failed.
///
/// # Errors
/// [`TransportError::Unsettled`] where that is not reached: light that is trapped has no stationary state.
///
/// Panics where `q` has not one entry per cell.
pub fn stationary(
    field: &LinearScattering<'_>,
    operator: Operator,
    q: &[[f64; 8]],
    tolerance: f64,
    watch: &mut Watch<'_>,
) -> Result<Settled, TransportError> {
    let system = System::new(field, operator);
    assert_eq!(q.len(), system.matrices.len(), "a source in every cell");
    // A power of two, so that it changes no digit: squares of the faintest lights would vanish.
    let largest = q.as_flattened().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let scale = if largest > 0.0 { math::pow(2.0, math::log2(largest).floor()) } else { 1.0 };
    let scaled: Vec<[f64; 8]> = q.iter().map(|lobes| lobes.map(|v| v / scale)).collect();
    let mut settled = search(&system, &scaled, tolerance, watch)?;
    for v in settled.lobes.as_flattened_mut() {
        *v *= scale;
    }
    Ok(settled)
}

/// [`stationary`] for sources that are not extreme.
fn search(
    system: &System,
    q: &[[f64; 8]],
    tolerance: f64,
    watch: &mut Watch<'_>,
) -> Result<Settled, TransportError> {
    let breaks_down = |x: f64| x == 0.0 || !x.is_finite();
    let dark = || vec![[0.0; 8]; q.len()];
    let mut sweeps = CORNERS.len();
    let mut a = system.round(q);
    let mut r = system.residual(q, &a);
    let mut shadow = r.clone();
    let (mut rho, mut alpha, mut omega) = (1.0, 1.0, 1.0);
    let (mut v, mut p) = (dark(), dark());
    loop {
        let residual = relative(&r, &a);
        if watch(sweeps, residual).is_break() {
            return Err(TransportError::Unsettled { sweeps, residual });
        }
        if residual <= tolerance {
            // What the recurrence says of the residual is subject to rounding.
            let left = system.residual(q, &a);
            let residual = relative(&left, &a);
            if residual <= 2.0 * tolerance && relative(&left, q) <= BALANCE {
                return Ok(Settled { lobes: a, sweeps, residual });
            }
        }
        if !residual.is_finite() || sweeps >= MOST_SWEEPS {
            return Err(TransportError::Unsettled { sweeps, residual });
        }
        let goes_on = 'step: {
            let next = dot(&shadow, &r);
            let beta = next / rho * (alpha / omega);
            if breaks_down(next) || !beta.is_finite() {
                break 'step false;
            }
            rho = next;
            for ((p, r), v) in p.as_flattened_mut().iter_mut().zip(r.as_flattened()).zip(v.as_flattened()) {
                *p = r + beta * (*p - omega * v);
            }
            let y = system.round(&p);
            v = system.kept_from(&y);
            let along = dot(&shadow, &v);
            if breaks_down(along) {
                break 'step false;
            }
            alpha = rho / along;
            add(&mut r, -alpha, &v);
            add(&mut a, alpha, &y);
            let z = system.round(&r);
            let t = system.kept_from(&z);
            let square = dot(&t, &t);
            if breaks_down(square) {
                break 'step false;
            }
            omega = dot(&t, &r) / square;
            add(&mut a, omega, &z);
            add(&mut r, -omega, &t);
            !breaks_down(omega)
        };
        sweeps += 2 * CORNERS.len() + 2;
        if !goes_on {
            // The recurrence has nothing to divide by, as where all light is gone after a few steps: one plain round,
            // and a new start from there.
            let correction = system.round(&system.residual(q, &a));
            add(&mut a, 1.0, &correction);
            r = system.residual(q, &a);
            shadow.clone_from(&r);
            (rho, alpha, omega) = (1.0, 1.0, 1.0);
            (v, p) = (dark(), dark());
            sweeps += CORNERS.len() + 2;
        }
    }
}

/// The matrices of all cells, along one operator.
struct System {
    matrices: Vec<[[f64; 8]; 8]>,
    width: usize,
    height: usize,
}

impl System {
    fn new(field: &LinearScattering<'_>, operator: Operator) -> Self {
        let grid = field.grid();
        let matrix = |cell: Cell| {
            let p = field.matrix(cell);
            match operator {
                Operator::Forward => p,
                Operator::Adjoint => {
                    std::array::from_fn(|k| std::array::from_fn(|j| p[(j + 4) % 8][(k + 4) % 8]))
                }
            }
        };
        Self { matrices: grid.iter().map(matrix).collect(), width: grid.width(), height: grid.height() }
    }

    /// What a cell passes on.
    fn passed(&self, cell: usize, a: &[f64; 8]) -> [f64; 8] {
        let mut phi = [0.0; 8];
        for (phi, row) in phi.iter_mut().zip(&self.matrices[cell]) {
            for (share, a) in row.iter().zip(a) {
                *phi += share * a;
            }
        }
        phi
    }

    /// Calls `put(neighbour, k)` for each neighbour that the cell in column x and row y has.
    fn to_neighbours(&self, x: usize, y: usize, mut put: impl FnMut(usize, usize)) {
        for (k, (dx, dy)) in NEIGHBOUR_OFFSETS.into_iter().enumerate() {
            if let (Some(x), Some(y)) = (x.checked_add_signed(dx), y.checked_add_signed(dy))
                && x < self.width
                && y < self.height
            {
                put(y * self.width + x, k);
            }
        }
    }

    /// One round of sweeps from nothing, for the source `q`.
    fn round(&self, q: &[[f64; 8]]) -> Vec<[f64; 8]> {
        let mut a = q.to_vec();
        for [from_right, from_below] in CORNERS {
            for row in 0..self.height {
                let y = if from_below { self.height - 1 - row } else { row };
                for column in 0..self.width {
                    let x = if from_right { self.width - 1 - column } else { column };
                    let i = y * self.width + x;
                    let phi = self.passed(i, &a[i]);
                    self.to_neighbours(x, y, |there, k| a[there][k] = q[there][k] + phi[k]);
                }
            }
        }
        a
    }

    /// `a - A a`.
    fn kept_from(&self, a: &[[f64; 8]]) -> Vec<[f64; 8]> {
        let mut kept = a.to_vec();
        for y in 0..self.height {
            for x in 0..self.width {
                let i = y * self.width + x;
                let phi = self.passed(i, &a[i]);
                self.to_neighbours(x, y, |there, k| kept[there][k] -= phi[k]);
            }
        }
        kept
    }

    /// `q - (a - A a)`.
    fn residual(&self, q: &[[f64; 8]], a: &[[f64; 8]]) -> Vec<[f64; 8]> {
        let mut r = q.to_vec();
        add(&mut r, -1.0, &self.kept_from(a));
        r
    }
}

fn dot(a: &[[f64; 8]], b: &[[f64; 8]]) -> f64 {
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a * b).sum()
}

fn add(a: &mut [[f64; 8]], factor: f64, b: &[[f64; 8]]) {
    for (a, b) in a.as_flattened_mut().iter_mut().zip(b.as_flattened()) {
        *a += factor * b;
    }
}

/// The L1 norm of `r` as a part of that of `a`; 0 in the dark.
fn relative(r: &[[f64; 8]], a: &[[f64; 8]]) -> f64 {
    let norm = |v: &[[f64; 8]]| v.as_flattened().iter().map(|v| v.abs()).sum::<f64>();
    let (r, a) = (norm(r), norm(a));
    if r == 0.0 { 0.0 } else { r / a }
}
