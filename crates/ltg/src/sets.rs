//! Directions that are swept together.
//!
//! The angular difference at t compares t-K with t+K, so directions that differ by 2K belong together; the differences
//! in x and y stay within one direction. A slice's own direction and its two partners may therefore lie in different
//! sets. The sets depend only on S, the slices and K, so that another run can resume on any machine.

use std::collections::BTreeMap;
use tigereye_core::Directions;

/// Sets are merged until they have at least this many directions: enough to sort them into batches that stop at about
/// the same step.
const LEAST: usize = 32;

/// A set of directions closed under the angular comparison.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DirectionSet {
    /// Samples, ascending.
    pub(crate) directions: Vec<usize>,
    /// For each of `directions` its index among the slices, if it is one.
    pub(crate) slice: Vec<Option<usize>>,
    /// For each of `directions` whether it takes part in an angular difference.
    pub(crate) is_partner: Vec<bool>,
    /// Angular differences.
    pub(crate) turns: Vec<Turn>,
}

/// An angular difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Turn {
    /// Index of t among the slices.
    pub(crate) slice: usize,
    /// Positions of t-K and t+K in the set.
    pub(crate) places: [usize; 2],
}

/// The sets for these slices (ascending), in ascending order of their first directions.
pub(crate) fn direction_sets(directions: Directions, slices: &[usize], k: usize) -> Vec<DirectionSet> {
    let s = directions.count();
    let mut merged: Vec<Vec<usize>> = Vec::new();
    for component in components(directions, slices, k) {
        match merged.last_mut() {
            Some(last) if last.len() < LEAST => last.extend(component),
            _ => merged.push(component),
        }
    }
    let of_directions = |mut directions: Vec<usize>| {
        directions.sort_unstable();
        let place = |t: usize| directions.binary_search(&(t % s)).ok();
        let turn =
            |(slice, &t): (usize, &usize)| Some(Turn { slice, places: [place(t + s - k)?, place(t + k)?] });
        let turns: Vec<Turn> = slices.iter().enumerate().filter_map(turn).collect();
        let mut is_partner = vec![false; directions.len()];
        turns.iter().flat_map(|t| t.places).for_each(|place| is_partner[place] = true);
        let slice = directions.iter().map(|t| slices.binary_search(t).ok()).collect();
        DirectionSet { directions, slice, is_partner, turns }
    };
    merged.into_iter().map(of_directions).collect()
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
        let sets = direction_sets(directions(32), &[0], 3);
        let turns = vec![Turn { slice: 0, places: [2, 1] }];
        let expected = DirectionSet {
            directions: vec![0, 3, 29],
            slice: vec![Some(0), None, None],
            is_partner: vec![false, true, true],
            turns,
        };
        assert_eq!(sets, [expected]);
    }

    #[test]
    fn sets_are_large_enough_to_sort_where_they_can_be() {
        let sizes = |s: usize, k: usize| -> Vec<usize> {
            let all: Vec<usize> = (0..s).collect();
            direction_sets(directions(s), &all, k).iter().map(|set| set.directions.len()).collect()
        };
        assert_eq!(sizes(64, 6), [32; 2]);
        assert_eq!(sizes(32, 3), [32]);
        assert_eq!(sizes(16, 2), [16]);
        assert_eq!(sizes(8, 1), [8]);
        assert_eq!(sizes(48, 3), [32, 16]);
    }

    #[test]
    fn every_difference_belongs_to_exactly_one_set() {
        for (s, k) in [(8, 1), (16, 2), (24, 2), (32, 3), (40, 20), (64, 6), (64, 64 / 2)] {
            for slices in [(0..s).collect(), vec![0], vec![1, 2, 3, 7], (0..s).step_by(3).collect::<Vec<_>>()]
            {
                let sets = direction_sets(directions(s), &slices, k);
                let mut along: Vec<usize> =
                    sets.iter().flat_map(|set| &set.slice).flatten().copied().collect();
                let mut turned: Vec<usize> =
                    sets.iter().flat_map(|set| &set.turns).map(|t| t.slice).collect();
                along.sort_unstable();
                turned.sort_unstable();
                let all: Vec<usize> = (0..slices.len()).collect();
                assert_eq!((&along, &turned), (&all, &all), "S = {s}, K = {k}, {slices:?}");
            }
        }
    }
}
