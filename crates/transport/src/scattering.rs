//! Every cell's scheme as an 8x8 matrix, the exact reduced form (method notes after eqs. 3.12 to 3.14).
//!
//! After one step every profile is a sum of eight lobes, `I = sum_j a_j c_j`, so a cell's state is eight fluxes. With
//! `M[k][j] = h sum_t w_k(t) T(t) c_j(t)` the step is `Phi = Tbar (sum a) (M a) / sum(M a)`, and `Phi_k` **is** the
//! neighbour's next `a_k`: collide and stream, as in a lattice Boltzmann method.
//!
//! A lobe is 180 degrees wide and a cone at most 90, so `M[k][j]` differs from 0 only for `|k - j| <= 2`: five of eight
//! entries a row. And T is the same in opposite directions, so row k+4 repeats row k: twenty numbers a cell.

use crate::Scheme;
use crate::pulses::{Passage, SectorSums, Walls};
use std::sync::OnceLock;
use tigereye_core::{Cell, Grid, TransmissionField};
use tigereye_simd::Number;

/// Eight fluxes, W.
pub(crate) type Lobes = [f64; 8];

/// A cell that lets through less than this part of what arrives lets nothing through: the quotient that makes up for it
/// would overflow, and no light is left of it at this scale.
pub(crate) const NOTHING_PASSES: f64 = 1e-290;

/// Scattering of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CellScattering {
    /// `band[k % 4][d] = M[k][k + d - 2]`.
    pub(crate) band: [[f64; 5]; 4],
    /// `Tbar`, 0 to 1.
    pub(crate) rate: f64,
}

/// Scattering of a whole transmission field, shared by all propagations in it.
#[derive(Clone, Debug)]
pub struct Scattering<'a> {
    scheme: &'a Scheme,
    transmission: &'a TransmissionField,
    pub(crate) cells: Vec<CellScattering>,
    /// The same in the form of the pulse lanes, made when first needed.
    passages_f64: OnceLock<Vec<Passage<f64>>>,
    passages_f32: OnceLock<Vec<Passage<f32>>>,
    /// The cells that send light back, likewise.
    walls_f64: OnceLock<Walls<f64>>,
    walls_f32: OnceLock<Walls<f32>>,
    /// What sums over the angular samples need.
    sums_f64: OnceLock<SectorSums<f64>>,
    sums_f32: OnceLock<SectorSums<f32>>,
}

/// Numbers that the parts of a field are kept in.
pub(crate) trait Stored: Number {
    /// How the cells of a field pass light on, row-major.
    fn passages<'f>(field: &'f Scattering<'_>) -> &'f [Passage<Self>];
    /// The cells that send light back.
    fn walls<'f>(field: &'f Scattering<'_>) -> &'f Walls<Self>;
    /// The field's angular sums.
    fn sector_sums<'f>(field: &'f Scattering<'_>) -> &'f SectorSums<Self>;
}

macro_rules! stored {
    ($type:ident, $passages:ident, $walls:ident, $sums:ident) => {
        impl Stored for $type {
            fn passages<'f>(field: &'f Scattering<'_>) -> &'f [Passage<Self>] {
                field.$passages.get_or_init(|| field.make_passages())
            }
            fn walls<'f>(field: &'f Scattering<'_>) -> &'f Walls<Self> {
                field.$walls.get_or_init(|| Walls::of(field.transmission()))
            }
            fn sector_sums<'f>(field: &'f Scattering<'_>) -> &'f SectorSums<Self> {
                field.$sums.get_or_init(|| SectorSums::new(field.scheme()))
            }
        }
    };
}

stored!(f64, passages_f64, walls_f64, sums_f64);
stored!(f32, passages_f32, walls_f32, sums_f32);

impl<'a> Scattering<'a> {
    /// Computes every cell's matrix. Panics where the samplings differ ([`crate::Problem::check`] reports it).
    #[must_use]
    pub fn new(scheme: &'a Scheme, transmission: &'a TransmissionField) -> Self {
        assert_eq!(scheme.directions(), transmission.directions(), "one sampling");
        let cells = transmission
            .grid()
            .iter()
            .map(|cell| cell_scattering(scheme, transmission.shape(cell), transmission.rate(cell)))
            .collect();
        Self {
            scheme,
            transmission,
            cells,
            passages_f64: OnceLock::new(),
            passages_f32: OnceLock::new(),
            walls_f64: OnceLock::new(),
            walls_f32: OnceLock::new(),
            sums_f64: OnceLock::new(),
            sums_f32: OnceLock::new(),
        }
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.transmission.grid()
    }
    /// The scheme the matrices belong to.
    #[must_use]
    pub const fn scheme(&self) -> &'a Scheme {
        self.scheme
    }
    /// The transmission the matrices were made of.
    #[must_use]
    pub const fn transmission(&self) -> &'a TransmissionField {
        self.transmission
    }
    pub(crate) fn make_passages<T: Number>(&self) -> Vec<Passage<T>> {
        let passage =
            |cell| Passage::new(self.scheme, self.transmission.shape(cell), self.transmission.rate(cell));
        self.grid().iter().map(passage).collect()
    }
    /// The full matrix `M[k][j]` of a cell, for a transmission profile of mean 1.
    #[must_use]
    pub fn matrix(&self, cell: Cell) -> [[f64; 8]; 8] {
        let band = &self.cells[self.grid().index(cell)].band;
        let mut m = [[0.0; 8]; 8];
        for k in 0..8 {
            for d in 0..5 {
                m[k][(k + d + 6) % 8] = band[k % 4][d];
            }
        }
        m
    }
}

fn cell_scattering(scheme: &Scheme, shape: &[f64], rate: f64) -> CellScattering {
    let h = scheme.directions().step_rad();
    let band = std::array::from_fn(|k| {
        std::array::from_fn(|d| {
            let j = (k + d + 6) % 8;
            h * (0..shape.len()).map(|t| scheme.weights(t)[k] * shape[t] * scheme.lobes(t)[j]).sum::<f64>()
        })
    });
    CellScattering { band, rate }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SharedWeights;
    use tigereye_core::{Directions, Field, Normalization, Tensor2};

    #[test]
    fn band_holds_every_entry_that_is_not_zero() {
        for s in [8, 16, 32, 40, 64] {
            let directions = Directions::new(s).expect("directions");
            let scheme = Scheme::new(directions, SharedWeights::Thesis);
            let grid = Grid::new(3, 1).expect("a grid");
            let field = Field::from_fn(grid, |c| {
                [Tensor2::from_axes(0.3, 3.0, 0.4), Tensor2::symmetric(1.0, 0.0, 0.0), Tensor2::IDENTITY][c.x]
            });
            let t =
                TransmissionField::from_tensors(&field, directions, Normalization::Local).expect("a field");
            let scattering = Scattering::new(&scheme, &t);
            for cell in grid.iter() {
                let m = scattering.matrix(cell);
                let h = directions.step_rad();
                for k in 0..8 {
                    for j in 0..8 {
                        let shape = t.shape(cell);
                        let full: f64 = h
                            * (0..s)
                                .map(|i| scheme.weights(i)[k] * shape[i] * scheme.lobes(i)[j])
                                .sum::<f64>();
                        assert!((m[k][j] - full).abs() < 1e-15, "S = {s}, k = {k}, j = {j}");
                    }
                }
            }
        }
    }

    #[test]
    fn isotropic_cell_passes_every_lobe_on_whole() {
        let directions = Directions::new(32).expect("directions");
        let scheme = Scheme::new(directions, SharedWeights::Thesis);
        let field = Field::from_fn(Grid::new(1, 1).expect("a grid"), |_| Tensor2::IDENTITY);
        let t = TransmissionField::from_tensors(&field, directions, Normalization::Local).expect("a field");
        let m = Scattering::new(&scheme, &t).matrix(Cell::new(0, 0));
        for j in 0..8 {
            let column: f64 = (0..8).map(|k| m[k][j]).sum();
            assert!((column - 1.0).abs() < 2e-15);
        }
    }
}
