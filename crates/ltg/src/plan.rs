//! How a sweep is cut so that it fits into memory and every pulse is solved once.
//!
//! The angular difference at t compares t-K with t+K, so directions that differ by 2K belong together; the differences in
//! x and y stay within one direction. Directions are therefore swept in **groups** closed under steps of 2K, row by row
//! with three rows in memory. Where even one such group is too large, the columns are cut into **strips**; the columns
//! beside a strip are then solved again for the next one.

use crate::LtgError;
use std::collections::BTreeMap;
use std::ops::Range;
use tigereye_core::{Directions, Grid};
use tigereye_transport::{PulseBlock, PulseSolver};

/// Rows of pulses in memory: the one being solved and its two predecessors.
pub(crate) const ROWS: usize = 3;

/// One pass over the grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Group {
    /// Directions of the group, N per batch, the last one repeated to fill a batch.
    pub(crate) directions: Vec<usize>,
    /// Interior columns for which differences are taken; one more on each side is solved.
    pub(crate) columns: Range<usize>,
}

/// Directions that must be compared with each other: the connected sets of {(t-K, t+K)}, ascending.
fn components(directions: Directions, slices: &[usize], k: usize) -> Vec<Vec<usize>> {
    let s = directions.count();
    let mut parent: BTreeMap<usize, usize> = BTreeMap::new();
    fn root(parent: &BTreeMap<usize, usize>, mut t: usize) -> usize {
        while parent[&t] != t {
            t = parent[&t];
        }
        t
    }
    for &t in slices {
        let (a, b) = ((t + s - k) % s, (t + k) % s);
        for t in [t, a, b] {
            parent.entry(t).or_insert(t);
        }
        let (a, b) = (root(&parent, a), root(&parent, b));
        parent.insert(a.max(b), a.min(b));
    }
    let mut sets: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for &t in parent.keys() {
        sets.entry(root(&parent, t)).or_default().push(t);
    }
    sets.into_values().collect()
}

/// Bytes of three rows of `columns` solved cells with `batches` blocks each.
fn ring_bytes<const N: usize>(grid: Grid, columns: usize, batches: usize) -> u128 {
    PulseBlock::<N>::bytes(grid.cells()) * (ROWS * columns * batches) as u128
}

/// Groups and strips that fit into `memory_bytes` together with one solver per thread and the result.
pub(crate) fn plan<const N: usize>(
    grid: Grid,
    directions: Directions,
    slices: &[usize],
    omega_step: usize,
    memory_bytes: u64,
    threads: usize,
) -> Result<Vec<Group>, LtgError> {
    if grid.width() < 3 || grid.height() < 3 {
        return Ok(Vec::new());
    }
    // Transmission profiles (twice while they are made) and matrices per cell; three gradient components and the result
    // per value.
    let prepared = grid.cells() as u128 * (2 * directions.count() * 8 + 168) as u128;
    let fixed = prepared
        + PulseSolver::<N>::bytes(grid) * threads as u128
        + (grid.cells() * slices.len() * 4 * 8) as u128;
    let bound = u128::from(memory_bytes);
    let fits = |columns: usize, directions: usize| {
        fixed + ring_bytes::<N>(grid, columns, directions.div_ceil(N)) <= bound
    };
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for set in components(directions, slices, omega_step) {
        match sets.last_mut() {
            Some(last) if fits(grid.width(), last.len() + set.len()) => last.extend(set),
            _ => sets.push(set),
        }
    }
    let mut groups = Vec::new();
    for mut set in sets {
        set.sort_unstable();
        let interior = grid.width() - 2;
        let widest = (1..=interior).rev().find(|&w| fits(w + 2, set.len()));
        let Some(widest) = widest else {
            let needed = fixed + ring_bytes::<N>(grid, 3, set.len().div_ceil(N));
            return Err(LtgError::Memory { needed, bound: memory_bytes });
        };
        // Strips of equal width rather than one thin rest.
        let strips = interior.div_ceil(widest);
        let width = interior.div_ceil(strips);
        for start in (0..interior).step_by(width) {
            let columns = 1 + start..1 + (start + width).min(interior);
            groups.push(Group { directions: set.clone(), columns });
        }
    }
    Ok(groups)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions(s: usize) -> Directions {
        Directions::new(s).expect("directions")
    }

    #[test]
    fn directions_two_k_apart_stay_together() {
        let all: Vec<usize> = (0..16).collect();
        let sets = components(directions(16), &all, 2);
        assert_eq!(sets, [vec![0, 4, 8, 12], vec![1, 5, 9, 13], vec![2, 6, 10, 14], vec![3, 7, 11, 15]]);
    }

    #[test]
    fn one_slice_needs_three_directions() {
        assert_eq!(components(directions(32), &[8], 3), [vec![5, 11], vec![8]]);
        // Wrapped.
        assert_eq!(components(directions(32), &[0], 3), [vec![0], vec![3, 29]]);
    }

    #[test]
    fn small_memory_means_groups_then_strips_then_refusal() {
        let grid = Grid::new(21, 21).expect("a grid");
        let all: Vec<usize> = (0..32).collect();
        let groups = |bytes| plan::<8>(grid, directions(32), &all, 3, bytes, 2);
        let row = ring_bytes::<8>(grid, 21, 1) as u64;
        assert_eq!(groups(40 * row).expect("one group").len(), 1);
        // Two components of 16 directions, two batches each.
        let two = groups(3 * row).expect("two groups");
        assert_eq!(
            two.iter().map(|g| (g.directions.len(), g.columns.clone())).collect::<Vec<_>>(),
            [(16, 1..20), (16, 1..20)]
        );
        let strips = groups(row + row / 2).expect("strips");
        assert!(strips.len() > 2 && strips.iter().all(|g| g.directions.len() == 16));
        let covered: usize = strips.iter().map(|g| g.columns.len()).sum();
        assert_eq!(covered, 2 * 19);
        assert!(matches!(groups(1000), Err(LtgError::Memory { bound: 1000, .. })));
    }

    #[test]
    fn grids_without_interior_need_nothing() {
        let grid = Grid::new(2, 9).expect("a grid");
        assert_eq!(plan::<8>(grid, directions(8), &[0], 1, 1 << 30, 2), Ok(Vec::new()));
    }
}
