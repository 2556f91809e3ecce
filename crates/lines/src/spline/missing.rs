//! Splines through volumes with missing values.
//!
//! A spline needs all samples: its coefficients depend on every one, with weights that decay by 0.43 per sample. Open
//! axes are therefore first cut to the bounding box of the finite values (which excludes the outermost ring, where a
//! light transport gradient is undefined), and missing samples inside it are filled from their surroundings. The spline
//! is never evaluated at a point with a missing sample among the six by six (by six) samples around it.

use super::{Axis, Spline};
use crate::Volume;
use tigereye_core::math;

/// The spline of a volume, cut to its finite values.
pub(crate) struct Known {
    /// The spline of the values times 2 to the `-exponent`, of magnitude at most 1.
    pub(crate) spline: Spline,
    /// Position of its first sample in the volume's samples.
    pub(crate) first: [usize; 3],
    pub(crate) exponent: i32,
    /// Least and largest value, scaled alike.
    pub(crate) range: [f64; 2],
    /// For each cell whether a sample around it is missing; empty if none is.
    blocked: Vec<bool>,
}

impl Known {
    /// `None` if no value is finite.
    pub(crate) fn new(volume: &Volume<'_>) -> Option<Self> {
        let (first, size) = finite_box(volume)?;
        let mut values = Vec::with_capacity(size.iter().product());
        for k in first[2]..first[2] + size[2] {
            for j in first[1]..first[1] + size[1] {
                let row = (k * volume.size()[1] + j) * volume.size()[0] + first[0];
                values.extend_from_slice(&volume.values()[row..row + size[0]]);
            }
        }
        let largest = values.iter().filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
        let exponent = math::binary_exponent(largest);
        let missing: Vec<bool> = values.iter().map(|v| !v.is_finite()).collect();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for v in values.iter_mut().filter(|v| v.is_finite()) {
            *v = math::scale_by_power_of_two(*v, -exponent);
            range = [range[0].min(*v), range[1].max(*v)];
        }
        let axes = [0, 1, 2].map(|d| Axis { samples: size[d], periodic: volume.periodic()[d] });
        let mut blocked = Vec::new();
        if missing.contains(&true) {
            fill(&mut values, &missing, axes);
            blocked = around(missing, axes);
        }
        Some(Self { spline: Spline::new(axes, &values), first, exponent, range, blocked })
    }

    /// Whether all samples around the cell of a point (in samples of the spline) are known.
    pub(crate) fn is_known(&self, p: [f64; 3]) -> bool {
        let axes = self.spline.axes();
        let [i, j, k] = [0, 1, 2].map(|d| axes[d].cell(p[d]));
        self.blocked.is_empty() || !self.blocked[(k * axes[1].samples + j) * axes[0].samples + i]
    }
}

/// First sample and size of the bounding box of the finite values; periodic axes are kept whole.
fn finite_box(volume: &Volume<'_>) -> Option<([usize; 3], [usize; 3])> {
    let size = volume.size();
    let (mut low, mut high) = (size, [0; 3]);
    for (i, _) in volume.values().iter().enumerate().filter(|(_, v)| v.is_finite()) {
        let at = [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])];
        for d in 0..3 {
            (low[d], high[d]) = (low[d].min(at[d]), high[d].max(at[d]));
        }
    }
    for d in (0..3).filter(|&d| volume.periodic()[d]) {
        (low[d], high[d]) = (0, size[d] - 1);
    }
    volume.values().iter().any(|v| v.is_finite()).then(|| (low, [0, 1, 2].map(|d| high[d] + 1 - low[d])))
}

/// The sample `steps` further along axis `d`, if it exists.
fn neighbour(axes: [Axis; 3], index: usize, d: usize, steps: isize) -> Option<usize> {
    let stride: usize = axes[..d].iter().map(|a| a.samples).product();
    let (n, at) = (axes[d].samples as isize, (index / stride % axes[d].samples) as isize);
    let to = if axes[d].periodic { (at + steps).rem_euclid(n) } else { at + steps };
    (0..n).contains(&to).then(|| (index as isize + (to - at) * stride as isize) as usize)
}

/// Number of layers beside known values that are extrapolated linearly; later ones repeat the mean of the previous.
const STRAIGHT_LAYERS: usize = 2;

/// Fills missing samples layer by layer, each with the mean of the extrapolations from its neighbours.
fn fill(values: &mut [f64], missing: &[bool], axes: [Axis; 3]) {
    let mut known: Vec<bool> = missing.iter().map(|m| !m).collect();
    let sides = || (0..3).flat_map(|d| [(d, -1), (d, 1)]);
    let touches =
        |known: &[bool], i: usize| sides().any(|(d, s)| neighbour(axes, i, d, s).is_some_and(|n| known[n]));
    let mut layer: Vec<usize> = (0..values.len()).filter(|&i| missing[i] && touches(&known, i)).collect();
    let mut round = 0;
    while !layer.is_empty() {
        let filled: Vec<f64> = layer
            .iter()
            .map(|&i| {
                let (mut sum, mut count) = (0.0, 0.0);
                for (d, s) in sides() {
                    let Some(a) = neighbour(axes, i, d, s).filter(|&n| known[n]) else { continue };
                    let further =
                        neighbour(axes, i, d, 2 * s).filter(|&n| known[n] && round < STRAIGHT_LAYERS);
                    sum += further.map_or(values[a], |b| 2.0 * values[a] - values[b]);
                    count += 1.0;
                }
                sum / count
            })
            .collect();
        for (&i, v) in layer.iter().zip(filled) {
            (values[i], known[i]) = (v, true);
        }
        let mut next: Vec<usize> = layer
            .iter()
            .flat_map(|&i| sides().filter_map(move |(d, s)| neighbour(axes, i, d, s)))
            .filter(|&n| !known[n])
            .collect();
        next.sort_unstable();
        next.dedup();
        layer = next;
        round += 1;
    }
}

/// For each cell (named by its first sample) whether one of the samples from the second before it to the third after
/// it is missing.
fn around(missing: Vec<bool>, axes: [Axis; 3]) -> Vec<bool> {
    let mut blocked = missing;
    for d in 0..3 {
        let near = |i: usize| (-2..=3).any(|s| neighbour(axes, i, d, s).is_some_and(|n| blocked[n]));
        blocked = (0..blocked.len()).map(near).collect();
    }
    blocked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_border_is_cut_off() {
        let value = |i: usize| {
            let (x, y) = (i % 6, i / 6);
            if x == 0 || y == 0 || x == 5 || y == 4 { f64::NAN } else { (x * x + y) as f64 }
        };
        let values: Vec<f64> = (0..30).map(value).collect();
        let volume = Volume::new(&values, [6, 5, 1], [false; 3]).expect("a volume");
        let known = Known::new(&volume).expect("finite values");
        assert_eq!((known.first, known.spline.axes().map(|a| a.samples)), ([1, 1, 0], [4, 3, 1]));
        let jet = known.spline.jet([1.5, 0.5, 0.0]);
        // Three operations on numbers up to 1.
        assert!((math::scale_by_power_of_two(jet.value, known.exponent) - 7.75).abs() < 1e-13);
        assert!(known.is_known([0.0, 0.0, 0.0]));
    }

    #[test]
    fn holes_are_filled_linearly_and_avoided() {
        let value = |i: usize| {
            let (x, y) = (i % 20, i / 20);
            if (8..11).contains(&x) && y == 10 { f64::NAN } else { 2.0 * x as f64 - y as f64 }
        };
        let values: Vec<f64> = (0..400).map(value).collect();
        let volume = Volume::new(&values, [20, 20, 1], [false; 3]).expect("a volume");
        let known = Known::new(&volume).expect("finite values");
        for (p, is) in [([5.0, 10.0], false), ([4.9, 10.0], true), ([9.0, 7.5], false), ([9.0, 13.0], true)] {
            assert_eq!(known.is_known([p[0], p[1], 0.0]), is, "{p:?}");
        }
        let jet = known.spline.jet([4.5, 9.2, 0.0]);
        // A ramp continues through the hole; rounding of numbers up to 1.
        assert!((math::scale_by_power_of_two(jet.value, known.exponent) + 0.2).abs() < 1e-13);
    }

    #[test]
    fn a_volume_without_values_has_no_spline() {
        for bad in [f64::NAN, f64::INFINITY] {
            let volume_values = [bad; 4];
            let volume = Volume::new(&volume_values, [2, 2, 1], [true; 3]).expect("a volume");
            assert!(Known::new(&volume).is_none());
        }
    }
}
