//! Reflecting cells, in the form computed by the pulse lanes.

use tigereye_core::{Cell, Reflection, TransmissionField};
use tigereye_simd::Number;
use tigereye_simd::Vector;

/// All walls of a field.
#[derive(Clone, Debug)]
pub(crate) struct Walls<T> {
    /// Columns and matrices, row-major.
    cells: Vec<(usize, Wall<T>)>,
    /// The start of each row in `cells`, and the end of the last one.
    rows: Vec<usize>,
}

/// One wall: `shares[k][j]` of the flux arriving in direction j leaves in direction k.
#[derive(Clone, Debug)]
pub(crate) struct Wall<T> {
    shares: [[T; 8]; 8],
    /// The share of each direction that is not reflected.
    absorbed: [f64; 8],
}

impl<T: Number> Walls<T> {
    pub(crate) fn of(field: &TransmissionField) -> Self {
        let mut walls = Self { cells: Vec::new(), rows: vec![0] };
        for (cell, reflection) in field.reflections() {
            walls.rows.resize(cell.y + 1, walls.cells.len());
            walls.cells.push((cell.x, Wall::new(reflection)));
        }
        walls.rows.resize(field.grid().height() + 1, walls.cells.len());
        walls
    }

    /// The walls of row `y` from column `x` on, with their columns.
    #[inline(always)]
    pub(crate) fn right_of(&self, y: usize, x: usize) -> &[(usize, Wall<T>)] {
        let row = &self.cells[self.rows[y]..self.rows[y + 1]];
        // Most rows have none.
        if row.is_empty() { row } else { &row[row.partition_point(|(column, _)| *column < x)..] }
    }

    /// The wall in a cell.
    #[inline(always)]
    pub(crate) fn at(&self, cell: Cell) -> Option<&Wall<T>> {
        match self.right_of(cell.y, cell.x) {
            [(x, wall), ..] if *x == cell.x => Some(wall),
            _ => None,
        }
    }
}

impl<T: Number> Wall<T> {
    fn new(reflection: &Reflection) -> Self {
        Self {
            shares: reflection.shares().map(|row| row.map(T::narrowed)),
            absorbed: std::array::from_fn(|j| reflection.absorbed(j)),
        }
    }

    /// The share of the flux arriving in direction `j` that is not reflected.
    pub(crate) const fn absorbed(&self, j: usize) -> f64 {
        self.absorbed[j]
    }

    /// The reflected light, for arriving light `a`.
    #[inline(always)]
    pub(crate) fn pass<V: Vector<Number = T>>(&self, proof: V::Proof, a: &[V; 8]) -> [V; 8] {
        let mut phi = [V::splat(proof, T::default()); 8];
        for k in 0..8 {
            for j in 0..8 {
                phi[k] = a[j].mul_add(V::splat(proof, self.shares[k][j]), phi[k]);
            }
        }
        phi
    }
}
