//! Division of a sweep into strips that fit into memory.
//!
//! Two rows of the pulses of one set of directions are in memory. If they are too large, the columns are cut into
//! strips; the columns beside a strip are then solved again for the next one.

use crate::LtgError;
use crate::sets::{DirectionSet, direction_sets};
use std::ops::Range;
use tigereye_core::{Directions, Grid};
use tigereye_transport::{PulseDistribution, PulseSolver, Real, Stopping};

/// Rows of pulses in memory. A pulse replaces the one two rows above as soon as it is compared with it.
pub(crate) const ROWS: usize = 2;

/// The resources of a sweep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) memory_bytes: u64,
    pub(crate) threads: usize,
    pub(crate) stopping: Stopping,
    /// Number of reflecting cells.
    pub(crate) walls: usize,
}

/// Bytes of two rows of `columns` cells with a pulse in each direction of a set.
fn ring_bytes<T: Real>(grid: Grid, columns: usize, set: &DirectionSet) -> u128 {
    PulseDistribution::<T>::bytes(grid.cells()) * (ROWS * columns * set.directions.len()) as u128
}

/// Bytes of a wall: its matrix in two forms.
const WALL_BYTES: u128 = 1200;
/// Bytes of a cell in the layout of a scene.
const LAYOUT_BYTES: u128 = 64;

/// Bytes that a sweep needs independently of its strips.
fn fixed_bytes<T: Real>(grid: Grid, directions: Directions, slices: usize, bounds: Bounds) -> u128 {
    let (cells, samples) = (grid.cells() as u128, directions.count() as u128);
    // Transmission profiles and matrices in two forms.
    let prepared = cells * (samples * 8 + 168 + 136);
    // The gradient itself, and twice its bytes while a checkpoint is read or written.
    let values = cells * slices as u128 * 3 * 8;
    let solver = PulseSolver::<T>::bytes(grid, &bounds.stopping)
        + PulseDistribution::<T>::bytes(grid.cells()) * T::LANES as u128;
    let walls = if bounds.walls > 0 { cells * LAYOUT_BYTES + bounds.walls as u128 * WALL_BYTES } else { 0 };
    prepared + values + walls + solver * bounds.threads as u128
}

/// The strips of inner columns for each set of directions, so that everything fits together.
pub(crate) fn strips<T: Real>(
    grid: Grid,
    directions: Directions,
    sets: &[DirectionSet],
    slices: usize,
    bounds: Bounds,
) -> Result<Vec<Vec<Range<usize>>>, LtgError> {
    if grid.width() < 3 || grid.height() < 3 {
        return Ok(vec![Vec::new(); sets.len()]);
    }
    let fixed = fixed_bytes::<T>(grid, directions, slices, bounds);
    let needed = |columns: usize, set: &DirectionSet| fixed + ring_bytes::<T>(grid, columns, set);
    let bound = bounds.memory_bytes;
    let least = sets.iter().map(|set| needed(3, set)).max().unwrap_or(fixed);
    if least > u128::from(bound) {
        return Err(LtgError::Memory { needed: least, bound });
    }
    let interior = grid.width() - 2;
    let of_set = |set: &DirectionSet| {
        let fits = |&columns: &usize| needed(columns + 2, set) <= u128::from(bound);
        let widest = (1..=interior).rev().find(fits).unwrap_or(1);
        // Strips of equal width, rather than a thin remainder.
        let width = interior.div_ceil(interior.div_ceil(widest));
        (0..interior).step_by(width).map(|start| 1 + start..1 + (start + width).min(interior)).collect()
    };
    Ok(sets.iter().map(of_set).collect())
}

/// Bytes of a sweep in these strips.
pub(crate) fn bytes<T: Real>(
    grid: Grid,
    directions: Directions,
    sets: &[DirectionSet],
    strips: &[Vec<Range<usize>>],
    slices: usize,
    bounds: Bounds,
) -> u128 {
    let widest = |strips: &[Range<usize>]| strips.iter().map(|strip| strip.len() + 2).max().unwrap_or(0);
    let rings = sets.iter().zip(strips).map(|(set, strips)| ring_bytes::<T>(grid, widest(strips), set));
    fixed_bytes::<T>(grid, directions, slices, bounds) + rings.max().unwrap_or(0)
}

/// Whether a sweep with these slices fits.
pub(crate) fn check<T: Real>(
    grid: Grid,
    directions: Directions,
    slices: &[usize],
    omega_step: usize,
    bounds: Bounds,
) -> Result<(), LtgError> {
    let sets = direction_sets(directions, slices, omega_step);
    strips::<T>(grid, directions, &sets, slices.len(), bounds).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sets(s: usize, k: usize) -> (Directions, Vec<DirectionSet>) {
        let directions = Directions::new(s).expect("directions");
        let slices: Vec<usize> = (0..s).collect();
        (directions, direction_sets(directions, &slices, k))
    }

    #[test]
    fn small_memory_means_strips_then_refusal() {
        let grid = Grid::new(21, 21).expect("a grid");
        let (directions, sets) = sets(64, 6);
        let strips = |memory_bytes| {
            strips::<f64>(
                grid,
                directions,
                &sets,
                64,
                Bounds { memory_bytes, threads: 2, stopping: Stopping::REFERENCE, walls: 0 },
            )
        };
        let row = ring_bytes::<f64>(grid, 21, &sets[0]) as u64;
        assert_eq!(strips(4 * row).expect("whole rows"), vec![Vec::from([1..20; 1]); 2]);
        let narrow = strips(row).expect("strips");
        assert!(
            narrow.iter().all(|s| s.len() > 1 && s.iter().map(Range::len).sum::<usize>() == 19),
            "{narrow:?}"
        );
        assert!(narrow.iter().all(|s| s.windows(2).all(|w| w[0].end == w[1].start)), "{narrow:?}");
        let Err(LtgError::Memory { needed, bound: 1000 }) = strips(1000) else { panic!("no refusal") };
        assert!(strips(needed as u64).is_ok() && strips(needed as u64 - 1).is_err());
    }

    #[test]
    fn the_largest_published_field_fits_into_two_gigabytes() {
        let grid = Grid::new(101, 101).expect("a grid");
        let (directions, sets) = sets(64, 6);
        for threads in [2, 64] {
            let bounds =
                Bounds { memory_bytes: 2_000_000_000, threads, stopping: Stopping::REFERENCE, walls: 0 };
            let strips = strips::<f64>(grid, directions, &sets, 64, bounds).expect("strips");
            assert!(strips.iter().all(|s| s.len() <= 5), "{threads} threads: {strips:?}");
        }
    }

    #[test]
    fn grids_without_interior_need_nothing() {
        let grid = Grid::new(2, 9).expect("a grid");
        let (directions, sets) = sets(8, 1);
        let none = strips::<f64>(
            grid,
            directions,
            &sets,
            8,
            Bounds { memory_bytes: 1, threads: 2, stopping: Stopping::REFERENCE, walls: 0 },
        );
        assert_eq!(none, Ok(vec![Vec::new(); sets.len()]));
    }
}
