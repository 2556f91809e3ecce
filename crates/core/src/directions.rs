//! Angular sampling of the circle.

use crate::{CoreError, math};

/// `S` equally spaced directions, `omega_t = t * 2 pi / S`, counter-clockwise from +x with y pointing up.
///
/// S is a multiple of 8 so that all eight neighbour directions are samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Directions(usize);

impl Directions {
    /// Largest number of samples.
    pub const MAX: usize = crate::limits::MAX_DIRECTIONS;

    /// `samples` directions.
    ///
    /// # Errors
    /// [`CoreError::Directions`] unless `samples` is a multiple of 8 from 8 to [`Self::MAX`].
    pub const fn new(samples: usize) -> Result<Self, CoreError> {
        if samples >= 8 && samples <= Self::MAX && samples.is_multiple_of(8) {
            Ok(Self(samples))
        } else {
            Err(CoreError::Directions { samples })
        }
    }

    /// Number of samples S.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.0
    }
    /// Angle between two samples, `h = 2 pi / S`, in radians.
    #[must_use]
    pub fn step_rad(&self) -> f64 {
        math::TAU / self.0 as f64
    }
    /// Angle of sample `t` in radians.
    #[must_use]
    pub fn angle_rad(&self, t: usize) -> f64 {
        t as f64 * self.step_rad()
    }
    /// Angle of sample `t` in degrees.
    #[must_use]
    pub fn angle_deg(&self, t: usize) -> f64 {
        t as f64 * 360.0 / self.0 as f64
    }
    /// Sample of neighbour direction `k` (0..8).
    #[must_use]
    pub const fn of_neighbour(&self, k: usize) -> usize {
        k * self.0 / 8 % self.0
    }
    /// Number of samples between `a` and `b` the shorter way round, 0 to S/2.
    #[must_use]
    pub const fn circular_distance(&self, a: usize, b: usize) -> usize {
        let d = a.abs_diff(b) % self.0;
        if d > self.0 - d { self.0 - d } else { d }
    }
    /// The sample nearest to `degrees`, ties to even.
    #[must_use]
    pub fn nearest(&self, degrees: f64) -> usize {
        let turns = degrees / 360.0;
        let t = math::round_ties_even((turns - turns.floor()) * self.0 as f64) as usize;
        t % self.0
    }

    /// `cos(omega_t)`; exactly symmetric under mirroring and quarter turns, and exactly 0 at 90 and 270 degrees.
    ///
    /// Every value is taken from the first octant. Symmetric fields then give symmetric light to the last bit, and a
    /// lobe does not leak 6e-17 of its light sideways.
    #[must_use]
    pub fn cos(&self, t: usize) -> f64 {
        let s = self.0;
        let t = t % s;
        let folded = if t > s / 2 { s - t } else { t };
        if folded <= s / 4 {
            self.cos_first_quadrant(folded)
        } else {
            -self.cos_first_quadrant(s / 2 - folded)
        }
    }

    /// `sin(omega_t)`, with the exactness of [`Self::cos`].
    #[must_use]
    pub fn sin(&self, t: usize) -> f64 {
        // sin(w) = cos(w - 90 degrees)
        self.cos(t + self.0 - self.0 / 4)
    }

    fn cos_first_quadrant(&self, t: usize) -> f64 {
        let s = self.0;
        if t == s / 4 {
            0.0
        } else if t <= s / 8 {
            math::cos(self.angle_rad(t))
        } else {
            math::sin(self.angle_rad(s / 4 - t))
        }
    }

    /// Unit vector `(cos, sin)` of sample `t`.
    #[must_use]
    pub fn unit(&self, t: usize) -> [f64; 2] {
        [self.cos(t), self.sin(t)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_multiples_of_eight_are_directions() {
        for s in [0, 4, 7, 12, 36, 7208] {
            assert_eq!(Directions::new(s), Err(CoreError::Directions { samples: s }));
        }
        assert!(Directions::new(8).is_ok() && Directions::new(7200).is_ok());
    }

    #[test]
    fn cosines_are_right_and_exactly_symmetric() {
        for s in [8, 16, 32, 40, 64, 360] {
            let d = Directions::new(s).expect("directions");
            for t in 0..s {
                // The angle itself is rounded, by up to 9e-16 near 2 pi.
                assert!((d.cos(t) - math::cos(d.angle_rad(t))).abs() < 1e-15, "S = {s}, t = {t}");
                assert!((d.sin(t) - math::sin(d.angle_rad(t))).abs() < 1e-15, "S = {s}, t = {t}");
                assert_eq!(d.cos(t), d.cos(s - t));
                assert_eq!(d.cos(t), d.sin(t + s / 4));
                assert_eq!(d.cos(t).abs(), d.sin((s / 4 + s - t) % s).abs());
            }
            assert_eq!((d.cos(s / 4), d.cos(3 * s / 4), d.sin(0), d.sin(s / 2)), (0.0, 0.0, 0.0, 0.0));
        }
    }

    #[test]
    fn nearest_wraps() {
        let d = Directions::new(8).expect("directions");
        assert_eq!([0.0, 44.0, -45.0, 359.9, 720.0, -1e-17].map(|a| d.nearest(a)), [0, 1, 7, 0, 0, 0]);
    }

    #[test]
    fn circular_distance_takes_the_shorter_way() {
        let d = Directions::new(16).expect("directions");
        assert_eq!([(0, 15), (3, 11), (5, 5), (15, 1)].map(|(a, b)| d.circular_distance(a, b)), [1, 8, 0, 2]);
    }
}
