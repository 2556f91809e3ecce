//! What a cell does to each lobe by itself.

use crate::scattering::{CellScattering, Lobes, NOTHING_PASSES, Scattering};
use crate::{Scheme, sector_lobes};
use tigereye_core::{Cell, Grid, TransmissionField};

/// `band[k % 4][d] = P[k][k + d - 2]`.
pub(crate) type Band = [[f64; 5]; 4];

/// Scattering of a field in which every photon goes its own way (thesis, eq. 3.15): the light that arrives as lobe j
/// leaves towards neighbour k as `P[k][j] = Tbar M[k][j] / sum_k' M[k'][j]`, whatever else arrives.
///
/// With `A` the matrix of one step, whose entries are these, the stationary light of a source that injects `q` per step
/// is `a = A a + q`.
#[derive(Clone, Debug)]
pub struct LinearScattering<'a> {
    field: &'a Scattering<'a>,
    /// By cell; unused in walls.
    bands: Vec<Band>,
    /// In which lobes light can arrive, a bit for each, by cell; empty without walls.
    lit: Vec<u8>,
}

impl<'a> LinearScattering<'a> {
    /// Normalises the columns of every cell's matrix.
    #[must_use]
    pub fn new(field: &'a Scattering<'a>) -> Self {
        Self { field, bands: bands(field), lit: lit_lobes(field.transmission()) }
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.field.grid()
    }
    /// Weights and lobes.
    #[must_use]
    pub const fn scheme(&self) -> &'a Scheme {
        self.field.scheme()
    }
    /// The transmission the matrices were made of.
    #[must_use]
    pub const fn transmission(&self) -> &'a TransmissionField {
        self.field.transmission()
    }
    /// The same field without the normalisation of columns.
    #[must_use]
    pub const fn scattering(&self) -> &'a Scattering<'a> {
        self.field
    }

    /// `P[k][j]` of a cell: the fraction of the light in lobe j that leaves towards neighbour k. Columns add up to
    /// `Tbar`,
    /// or to the reflectance of a wall; those of lobes in which no light can arrive, inside a wall, are 0.
    #[must_use]
    pub fn matrix(&self, cell: Cell) -> [[f64; 8]; 8] {
        if let Some(wall) = self.transmission().reflection(cell) {
            let lit = self.lit[self.grid().index(cell)];
            return wall
                .shares()
                .map(|row| std::array::from_fn(|j| if lit & (1 << j) == 0 { 0.0 } else { row[j] }));
        }
        let band = &self.bands[self.grid().index(cell)];
        let mut p = [[0.0; 8]; 8];
        for k in 0..8 {
            for d in 0..5 {
                p[k][(k + d + 6) % 8] = band[k % 4][d];
            }
        }
        p
    }

    /// `P a`: the flux towards each neighbour (W) where the lobes `a` (W) arrive.
    #[must_use]
    pub fn passed(&self, cell: Cell, a: &[f64; 8]) -> [f64; 8] {
        match self.transmission().reflection(cell) {
            Some(wall) => wall.reflected(a),
            None => banded(&self.bands[self.grid().index(cell)], a),
        }
    }

    /// `P^T b`: what light in each lobe would contribute if light leaving towards neighbour k contributes `b[k]`.
    #[must_use]
    pub fn passed_back(&self, cell: Cell, b: &[f64; 8]) -> [f64; 8] {
        let p = self.matrix(cell);
        std::array::from_fn(|j| (0..8).map(|k| p[k][j] * b[k]).sum())
    }

    /// The flux towards each neighbour (W) of a light in `cell` with the intensity `profile` (W/rad, S samples): each
    /// of its samples leaves with the cone weights and the cell's `Tbar`; samples that the cell transmits nothing of,
    /// and lights in walls, are lost.
    #[must_use]
    pub fn emitted(&self, cell: Cell, profile: &[f64]) -> [f64; 8] {
        emitted(self.scheme(), self.transmission(), cell, profile)
    }

    /// The flux towards each neighbour (W) of a pulse of height S in sample `t`: `2 pi Tbar w_k(t)`.
    #[must_use]
    pub fn emitted_by_pulse(&self, cell: Cell, t: usize) -> [f64; 8] {
        let energy = self.pulse_energy(cell, t);
        self.scheme().weights(t).map(|w| energy * w)
    }

    /// The total flux of such a pulse (W): `2 pi Tbar`, and 0 if the cell transmits nothing of the sample or is a wall.
    #[must_use]
    pub fn pulse_energy(&self, cell: Cell, t: usize) -> f64 {
        let transmission = self.transmission();
        let is_lost = transmission.reflection(cell).is_some() || transmission.shape(cell)[t] <= 0.0;
        if is_lost { 0.0 } else { tigereye_core::math::TAU * transmission.rate(cell) }
    }

    /// `sum_t v(t) c_j(t)`: the weights of the eight lobes in a weighted sum over the samples of a cell, `C^T v`.
    #[must_use]
    pub fn sampled_back(&self, v: &[f64]) -> [f64; 8] {
        let scheme = self.scheme();
        let mut lobes = [0.0; 8];
        for (t, v) in v.iter().enumerate() {
            for j in sector_lobes(t * 8 / scheme.directions().count()) {
                lobes[j] += scheme.lobes(t)[j] * v;
            }
        }
        lobes
    }
}

/// In which lobes light can arrive at each cell. Between the cells of a wall it is dark, but what they would send to
/// and fro there would look like trapped light.
fn lit_lobes(transmission: &TransmissionField) -> Vec<u8> {
    let grid = transmission.grid();
    let walls: Vec<Cell> = transmission.reflections().map(|(cell, _)| cell).collect();
    if walls.is_empty() {
        return Vec::new();
    }
    let mut lit = vec![u8::MAX; grid.cells()];
    walls.iter().for_each(|&wall| lit[grid.index(wall)] = 0);
    let mut next = Vec::new();
    for &wall in &walls {
        for j in 0..8 {
            let from = grid.neighbour(wall, (j + 4) % 8);
            if from.is_some_and(|from| transmission.reflection(from).is_none()) {
                lit[grid.index(wall)] |= 1 << j;
                next.push((wall, j));
            }
        }
    }
    while let Some((wall, j)) = next.pop() {
        let Some(reflection) = transmission.reflection(wall) else { continue };
        for (k, row) in reflection.shares().iter().enumerate() {
            if let Some(there) = grid.neighbour(wall, k)
                && row[j] > 0.0
                && lit[grid.index(there)] & (1 << k) == 0
            {
                lit[grid.index(there)] |= 1 << k;
                next.push((there, k));
            }
        }
    }
    lit
}

/// [`LinearScattering::emitted`], without the matrices.
pub(crate) fn emitted(
    scheme: &Scheme,
    transmission: &TransmissionField,
    cell: Cell,
    profile: &[f64],
) -> [f64; 8] {
    let mut flux = [0.0; 8];
    if transmission.reflection(cell).is_some() {
        return flux;
    }
    let scale = transmission.rate(cell) * scheme.directions().step_rad();
    for (t, (&f, &passes)) in profile.iter().zip(transmission.shape(cell)).enumerate() {
        if passes > 0.0 {
            for (flux, weight) in flux.iter_mut().zip(scheme.weights(t)) {
                *flux += scale * weight * f;
            }
        }
    }
    flux
}

/// The bands of `P` of a whole field.
pub(crate) fn bands(field: &Scattering<'_>) -> Vec<Band> {
    field.cells.iter().map(normalized_columns).collect()
}

/// The band of `P`; columns of which nothing passes are 0.
fn normalized_columns(cell: &CellScattering) -> Band {
    let m = &cell.band;
    // Column j has rows j-2 to j+2; it lies at place d = j - k + 2 of row k. The order of the additions is symmetric.
    let factor: [f64; 4] = std::array::from_fn(|j| {
        let entry = |d: usize| m[(j + 6 - d) % 4][d];
        let sum = entry(2) + (entry(1) + entry(3)) + (entry(0) + entry(4));
        if sum > NOTHING_PASSES { cell.rate / sum } else { 0.0 }
    });
    std::array::from_fn(|k| std::array::from_fn(|d| m[k][d] * factor[(k + d + 2) % 4]))
}

/// `P a`, in an order of additions that mirroring and quarter turns keep.
pub(crate) fn banded(p: &Band, a: &Lobes) -> Lobes {
    std::array::from_fn(|k| {
        let b = &p[k % 4];
        let near = b[1] * a[(k + 7) % 8] + b[3] * a[(k + 1) % 8];
        let far = b[0] * a[(k + 6) % 8] + b[4] * a[(k + 2) % 8];
        (b[2] * a[k] + near) + far
    })
}
