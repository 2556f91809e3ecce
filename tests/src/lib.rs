//! Helpers shared by the cross-crate tests.

use tigereye_core::{Cell, Directions, Field, Grid, PolarProfile, Tensor2};

/// Largest absolute difference of two lists relative to the largest value of the second. Infinite where the lengths
/// differ or anything is not finite; 0 for two dark lists.
#[must_use]
pub fn difference_over_largest(found: &[f64], expected: &[f64]) -> f64 {
    if found.len() != expected.len() || found.iter().chain(expected).any(|v| !v.is_finite()) {
        return f64::INFINITY;
    }
    let largest = expected.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let difference = found.iter().zip(expected).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    if difference == 0.0 { 0.0 } else { difference / largest }
}

/// The symmetries of the grid that generate all eight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Left and right exchanged.
    MirrorX,
    /// Top and bottom exchanged.
    MirrorY,
    /// A quarter turn counter-clockwise.
    QuarterTurn,
}

impl Symmetry {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::MirrorX, Self::MirrorY, Self::QuarterTurn];

    /// The field moved.
    #[must_use]
    pub fn field(self, field: &Field<Tensor2>) -> Field<Tensor2> {
        match self {
            Self::MirrorX => field.mirrored_x(),
            Self::MirrorY => field.mirrored_y(),
            Self::QuarterTurn => field.quarter_turned(),
        }
    }

    /// Where a cell of `grid` goes.
    #[must_use]
    pub const fn cell(self, grid: Grid, cell: Cell) -> Cell {
        match self {
            Self::MirrorX => Cell::new(grid.width() - 1 - cell.x, cell.y),
            Self::MirrorY => Cell::new(cell.x, grid.height() - 1 - cell.y),
            Self::QuarterTurn => Cell::new(cell.y, grid.width() - 1 - cell.x),
        }
    }

    /// Where sample `t` of `samples` goes; with 8 samples these are the neighbour directions.
    #[must_use]
    pub const fn sample(self, samples: usize, t: usize) -> usize {
        match self {
            Self::MirrorX => (samples / 2 + samples - t) % samples,
            Self::MirrorY => (samples - t) % samples,
            Self::QuarterTurn => (t + samples / 4) % samples,
        }
    }

    /// A profile moved.
    #[must_use]
    pub fn profile(self, profile: &PolarProfile) -> PolarProfile {
        let directions: Directions = profile.directions();
        let mut moved = vec![0.0; directions.count()];
        for (t, &v) in profile.samples().iter().enumerate() {
            moved[self.sample(directions.count(), t)] = v;
        }
        PolarProfile::from_fn(directions, |t| moved[t])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symmetries_move_neighbours_as_they_move_directions() {
        let grid = Grid::new(9, 7).expect("a grid");
        let cell = Cell::new(3, 2);
        for symmetry in Symmetry::ALL {
            let target = if symmetry == Symmetry::QuarterTurn { grid.transposed() } else { grid };
            for k in 0..8 {
                let moved = grid.neighbour(cell, k).map(|n| symmetry.cell(grid, n));
                let there = target.neighbour(symmetry.cell(grid, cell), symmetry.sample(8, k));
                assert_eq!(moved, there, "{symmetry:?}, k = {k}");
            }
        }
    }

    #[test]
    fn difference_is_relative_to_the_largest() {
        assert_eq!(difference_over_largest(&[1.0, 4.5], &[1.0, 4.0]), 0.125);
        assert_eq!(difference_over_largest(&[0.0], &[0.0]), 0.0);
        assert_eq!(difference_over_largest(&[1.0], &[1.0, 1.0]), f64::INFINITY);
        assert_eq!(difference_over_largest(&[f64::NAN], &[1.0]), f64::INFINITY);
    }
}
