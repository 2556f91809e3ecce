//! Explicit points that form a lattice.

use crate::ImageData;

/// Largest distance of a point from its lattice, relative to the step: coordinates have six digits in text.
pub(crate) const TOLERANCE: f64 = 1e-3;
/// The same while counting, where steps are not yet known to the last digit.
const COARSE: f64 = 0.25;

/// The message about a plane of positions whose format does not state which way its vertical `axis` runs.
pub(crate) fn taken_upwards(axis: char) -> String {
    format!("{axis} taken to run upwards; where a file has {axis} downwards the picture is upside down")
}

/// Points along three axes, the steps along them, and the first point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PointLattice {
    pub(crate) size: [usize; 3],
    /// An axis of one point has no length.
    pub(crate) axes: [[f64; 3]; 3],
    pub(crate) origin: [f64; 3],
}

impl PointLattice {
    /// The lattice of `size`, the first axis fastest; possibly turned.
    ///
    /// # Errors
    /// The first point that is off; 0 where there are not as many points as `size` has.
    pub(crate) fn of(points: &[[f64; 3]], size: [usize; 3]) -> Result<Self, usize> {
        let [nx, ny, nz] = size;
        if points.is_empty() || points.len() as u128 != nx as u128 * ny as u128 * nz as u128 {
            return Err(0);
        }
        let strides = [1, nx, nx * ny];
        let first = points[0];
        let mut axes = [[0.0; 3]; 3];
        for a in 0..3 {
            let steps = size[a] - 1;
            if steps > 0 {
                let last = points[strides[a] * steps];
                axes[a] = [0, 1, 2].map(|i| (last[i] - first[i]) / steps as f64);
            }
        }
        let spacing = axes.map(length);
        let least = spacing.iter().copied().filter(|s| *s > 0.0).fold(f64::INFINITY, f64::min);
        let moves = (0..3).all(|a| size[a] == 1 || spacing[a] > 0.0);
        for (point, p) in points.iter().enumerate() {
            let at = [point % nx, point / nx % ny, point / (nx * ny)];
            let off = [0, 1, 2].map(|i| {
                let expected: f64 = (0..3).map(|a| at[a] as f64 * axes[a][i]).sum();
                p[i] - first[i] - expected
            });
            let near = length(off) <= TOLERANCE * least;
            if !(near || points.len() == 1) || !moves {
                return Err(point);
            }
        }
        Ok(Self { size, axes, origin: first })
    }

    /// The lattice of points whose numbers along the axes nobody tells: rows are as long as the first step repeats.
    /// Points of a single row lie along the axis of the lattice that they follow most, so that a column stays one.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub(crate) fn find(points: &[[f64; 3]]) -> Result<Self, usize> {
        let row = repeats(points, 1);
        let layer = row * repeats(points, row);
        if points.is_empty() || !points.len().is_multiple_of(layer) {
            return Err(points.len().min(layer));
        }
        let mut size = [row, layer / row, points.len() / layer];
        if row == points.len() && row > 1 {
            let step = [0, 1, 2].map(|i| (points[row - 1][i] - points[0][i]).abs());
            let along = (0..3).fold(0, |best, a| if step[a] > step[best] { a } else { best });
            size.swap(0, along);
        }
        Self::of(points, size)
    }

    /// The lattice along the world's axes of points in any order, and which point is at each of its places, x fastest.
    ///
    /// # Errors
    /// The first point that is off the lattice, or shares its place with one before.
    pub(crate) fn scattered(points: &[[f64; 3]]) -> Result<(Self, Vec<usize>), usize> {
        let mut size = [1; 3];
        let (mut first, mut step) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            let mut sorted: Vec<f64> = points.iter().map(|p| p[axis]).collect();
            sorted.sort_unstable_by(f64::total_cmp);
            let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else { return Err(0) };
            let largest_gap = sorted.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
            if !(largest_gap.is_finite() && low.is_finite() && high.is_finite()) {
                return Err(0);
            }
            // Smaller gaps are rounding.
            let is_step = |w: &&[f64]| largest_gap > 0.0 && w[1] - w[0] > COARSE * largest_gap;
            let steps = sorted.windows(2).filter(is_step).count();
            size[axis] = steps + 1;
            (first[axis], step[axis]) = (low, if steps > 0 { (high - low) / steps as f64 } else { 0.0 });
        }
        if size.iter().map(|&n| n as u128).product::<u128>() != points.len() as u128 {
            return Err(0);
        }
        let mut order = vec![usize::MAX; points.len()];
        for (point, p) in points.iter().enumerate() {
            let at = [0, 1, 2].map(|a| if step[a] > 0.0 { (p[a] - first[a]) / step[a] } else { 0.0 });
            let [x, y, z] = at.map(|v| v.round() as usize);
            let place = order.get_mut((z * size[1] + y) * size[0] + x).ok_or(point)?;
            if at.iter().any(|v| (v - v.round()).abs() > TOLERANCE) || *place != usize::MAX {
                return Err(point);
            }
            *place = point;
        }
        let axes = [0, 1, 2].map(|a| [0, 1, 2].map(|i| if i == a { step[a] } else { 0.0 }));
        Ok((Self { size, axes, origin: first }, order))
    }

    /// Gives an image the lattice's size, spacing, directions and origin; axes of one point get the directions that are
    /// left.
    pub(crate) fn place(&self, image: &mut ImageData) {
        let mut units = [None; 3];
        for a in 0..3 {
            let spacing = length(self.axes[a]);
            if spacing > 0.0 {
                image.spacing[a] = spacing;
                units[a] = Some(self.axes[a].map(|v| v / spacing));
            }
        }
        for a in 0..3 {
            if units[a].is_none() {
                units[a] = Some(completing(units, a));
            }
        }
        let direction: [f64; 9] = std::array::from_fn(|i| units[i % 3].unwrap_or_default()[i / 3]);
        image.dimensions = self.size;
        image.origin = self.origin;
        let turned = (0..9).any(|i| direction[i] != if i % 4 == 0 { 1.0 } else { 0.0 });
        image.direction = turned.then_some(direction);
    }
}

/// A unit vector at right angles to the axes that are known, for axis `a`: the one that makes a right-handed frame
/// where two are known, else the nearest to a coordinate axis, its own first.
fn completing(units: [Option<[f64; 3]>; 3], a: usize) -> [f64; 3] {
    if let (Some(u), Some(v)) = (units[(a + 1) % 3], units[(a + 2) % 3]) {
        return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    }
    let known = units.into_iter().flatten().next().unwrap_or_default();
    // One known axis lies along at most one coordinate axis, so of any two a good part of one is left.
    let left = |i: usize| [0, 1, 2].map(|k| f64::from(u8::from(k == i)) - known[i] * known[k]);
    let best = if length(left(a)) > 0.5 { left(a) } else { left((a + 1) % 3) };
    let size = length(best);
    best.map(|v| v / size)
}

fn length(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// How many points, `stride` apart, follow the first in equal steps, the first among them: at least 1, even where it is
/// no number.
fn repeats(points: &[[f64; 3]], stride: usize) -> usize {
    let (Some(first), Some(second)) = (points.first(), points.get(stride)) else { return 1 };
    let step = [0, 1, 2].map(|i| second[i] - first[i]);
    let follows = |(i, p): (usize, &[f64; 3])| {
        let off = [0, 1, 2].map(|k| p[k] - first[k] - i as f64 * step[k]);
        length(off) <= COARSE * length(step)
    };
    points.iter().step_by(stride).enumerate().take_while(|&p| follows(p)).count().max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(size: [usize; 3], axes: [[f64; 3]; 3]) -> Vec<[f64; 3]> {
        let at = |i: usize| [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])];
        let place = |n: [usize; 3], k: usize| 5.0 + (0..3).map(|a| n[a] as f64 * axes[a][k]).sum::<f64>();
        (0..size.iter().product()).map(|i| [0, 1, 2].map(|k| place(at(i), k))).collect()
    }

    #[test]
    fn lattices_are_found_without_their_size() {
        let turned = [[0.0, 0.5, 0.1], [-0.5, 0.0, 0.0], [0.0, 0.2, -1.0]];
        // Single rows along x, y and z of the world.
        for (along, size) in [(1, [1, 5, 1]), (0, [5, 1, 1]), (2, [1, 1, 5])] {
            let axes = [[0, 1, 2].map(|i| if i == along { -0.5 } else { 0.1 }), [0.0; 3], [0.0; 3]];
            assert_eq!(PointLattice::find(&grid([5, 1, 1], axes)).map(|l| l.size), Ok(size));
        }
        for size in [[4, 3, 2], [1, 1, 1], [7, 2, 1]] {
            let points = grid(size, turned);
            let found = PointLattice::find(&points).map(|l| (l.size, l.origin));
            assert_eq!(found, Ok((size, [5.0; 3])));
        }
    }

    #[test]
    fn axes_of_one_point_are_at_right_angles_to_the_others() {
        let step = |axis: usize, size: f64| [0, 1, 2].map(|i| if i == axis { size } else { 0.0 });
        let slanted = [0.6, -0.64, 0.48];
        for along in [step(0, 2.0), step(1, -1.0), step(2, 0.5), slanted] {
            for place in 0..3 {
                let mut axes = [[0.0; 3]; 3];
                axes[place] = along;
                let mut size = [1; 3];
                size[place] = 4;
                let lattice = PointLattice { size, axes, origin: [1.0; 3] };
                let mut image = ImageData::empty(size);
                lattice.place(&mut image);
                let d = image.direction.unwrap_or([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
                for (a, b) in [(0, 1), (0, 2), (1, 2), (0, 0), (1, 1), (2, 2)] {
                    let dot: f64 = (0..3).map(|i| d[3 * i + a] * d[3 * i + b]).sum();
                    assert!((dot - f64::from(u8::from(a == b))).abs() < 1e-12, "{along:?} at {place}");
                }
                let kept = (0..3).map(|i| image.spacing[place] * d[3 * i + place] - along[i]);
                assert!(kept.into_iter().all(|off| off.abs() < 1e-12), "{along:?} at {place}");
            }
        }
    }

    #[test]
    fn points_in_any_order_are_put_in_theirs() {
        let points = grid([4, 3, 2], [[0.5, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]);
        // 7 and 24 have no common factor.
        let shuffled: Vec<[f64; 3]> = (0..24).map(|i| points[7 * i % 24]).collect();
        let (lattice, order) = PointLattice::scattered(&shuffled).expect("a lattice");
        assert_eq!((lattice.size, lattice.origin), ([4, 3, 2], [5.0; 3]));
        assert!(order.iter().zip(&points).all(|(&at, p)| shuffled[at] == *p));
        let mut twice = shuffled.clone();
        twice[3] = twice[2];
        assert!(PointLattice::scattered(&twice).is_err());
        let mut off = shuffled;
        off[3][1] += 0.01;
        assert!(PointLattice::scattered(&off).is_err());
        for odd in [f64::NAN, f64::INFINITY, 1e300] {
            assert!(PointLattice::scattered(&[[0.0; 3], [odd, 0.0, 0.0], [1.0, 0.0, 0.0]]).is_err());
        }
        assert!(PointLattice::scattered(&[]).is_err());
    }

    #[test]
    fn points_off_the_lattice_are_named() {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut points = grid([4, 3, 1], axes);
        points[6][1] += 0.1;
        assert_eq!(PointLattice::find(&points), Err(6));
        assert_eq!(PointLattice::find(&grid([4, 3, 1], axes)[..11]), Err(11));
        assert_eq!(PointLattice::find(&[[1.0; 3]; 4]), Err(0));
        assert_eq!(PointLattice::find(&[]), Err(0));
        for bad in [f64::NAN, f64::INFINITY] {
            for place in 0..4 {
                let mut points = grid([2, 2, 1], axes);
                points[place][0] = bad;
                assert!(PointLattice::find(&points).is_err(), "{bad} at {place}");
            }
        }
    }
}
