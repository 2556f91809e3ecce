//! Scalars on a lattice of three axes, any of which may be periodic.

use crate::ExtractionError;
use tigereye_core::{Field, LtgVolume};

/// A borrowed volume of scalars, x fastest, then y, then the third axis. NaN and infinite values are missing.
///
/// A sample (i, j, k) lies at `(i, j, start + step k)`, and results use the same coordinates: x and y in cells, the
/// third coordinate in the unit of `start` and `step` (samples of direction for a light transport gradient). On a
/// periodic axis of n samples, sample 0 follows the last one, and positions run from that of sample 0 to that of sample
/// n.
#[derive(Clone, Copy, Debug)]
pub struct Volume<'a> {
    values: &'a [f64],
    size: [usize; 3],
    periodic: [bool; 3],
    start: f64,
    step: f64,
}

impl<'a> Volume<'a> {
    /// Largest number of samples of a volume.
    pub const MAX_SAMPLES: usize = crate::extraction_error::MAX_SAMPLES;

    /// A volume of `size` samples along x, y and the third axis.
    ///
    /// # Errors
    /// [`ExtractionError::VolumeSize`] for an empty or too large volume, [`ExtractionError::ValueCount`] unless there
    /// is one value per sample.
    pub fn new(values: &'a [f64], size: [usize; 3], periodic: [bool; 3]) -> Result<Self, ExtractionError> {
        let samples = size.iter().try_fold(1_usize, |n, &s| n.checked_mul(s));
        match samples {
            Some(n) if (1..=Self::MAX_SAMPLES).contains(&n) => {
                if n != values.len() {
                    return Err(ExtractionError::ValueCount { values: values.len(), samples: n });
                }
                Ok(Self { values, size, periodic, start: 0.0, step: 1.0 })
            }
            _ => Err(ExtractionError::VolumeSize { size }),
        }
    }

    /// A light transport gradient: axes x, y and direction, the third coordinate in samples of direction. The direction
    /// is periodic if the slices cover the full circle.
    ///
    /// # Errors
    /// [`ExtractionError::UnevenSlices`] if the slices are not equally spaced, [`ExtractionError::VolumeSize`] if there
    /// are none or too many.
    pub fn of_ltg(ltg: &'a LtgVolume) -> Result<Self, ExtractionError> {
        let (grid, slices) = (ltg.grid(), ltg.slices());
        let step = slices.windows(2).map(|w| w[1] - w[0]).next().unwrap_or(1);
        if let Some(w) = slices.windows(2).find(|w| w[1] - w[0] != step) {
            return Err(ExtractionError::UnevenSlices { slice: w[1], expected: w[0] + step });
        }
        let round = slices.len() > 1 && slices.len() * step == ltg.directions().count();
        let size = [grid.width(), grid.height(), slices.len()];
        let volume = Self::new(ltg.values(), size, [false, false, round])?;
        Ok(Self { start: slices[0] as f64, step: step as f64, ..volume })
    }

    /// A field as a volume with one sample along the third axis.
    pub(crate) fn of_field(field: &'a Field<f64>) -> Self {
        let size = [field.grid().width(), field.grid().height(), 1];
        Self { values: field.values(), size, periodic: [false; 3], start: 0.0, step: 1.0 }
    }

    /// All values.
    #[must_use]
    pub const fn values(&self) -> &'a [f64] {
        self.values
    }
    /// Samples along each axis.
    #[must_use]
    pub const fn size(&self) -> [usize; 3] {
        self.size
    }
    /// Which axes are periodic.
    #[must_use]
    pub const fn periodic(&self) -> [bool; 3] {
        self.periodic
    }
    /// Distance between samples along each axis, in the unit of positions.
    pub(crate) const fn steps(&self) -> [f64; 3] {
        [1.0, 1.0, self.step]
    }
    /// The coordinates of a point in samples.
    pub(crate) const fn position(&self, p: [f64; 3]) -> [f64; 3] {
        [p[0], p[1], self.start + self.step * p[2]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Directions, Grid};

    #[test]
    fn slices_of_the_full_circle_are_periodic() {
        let grid = Grid::new(2, 1).expect("a size");
        let directions = Directions::new(8).expect("a count");
        let of = |slices: Vec<usize>| {
            LtgVolume::new(grid, directions, slices.clone(), vec![0.0; 2 * slices.len()])
        };
        for (slices, round) in [
            ((0..8).collect::<Vec<_>>(), Some(true)),
            (vec![1, 3, 5, 7], Some(true)),
            (vec![1, 3, 5], Some(false)),
            (vec![4], Some(false)),
            (vec![0, 1, 3], None),
            (vec![], None),
        ] {
            let ltg = of(slices.clone());
            assert_eq!(Volume::of_ltg(&ltg).ok().map(|v| v.periodic()[2]), round, "{slices:?}");
        }
        let ltg = of(vec![1, 3, 5, 7]);
        let volume = Volume::of_ltg(&ltg).expect("a volume");
        assert_eq!(volume.position([1.0, 0.0, 2.5]), [1.0, 0.0, 6.0]);
    }

    #[test]
    fn impossible_volumes_are_refused() {
        for size in [[0, 1, 1], [usize::MAX, 2, 1], [1 << 20, 1 << 20, 1]] {
            assert!(matches!(Volume::new(&[], size, [false; 3]), Err(ExtractionError::VolumeSize { .. })));
        }
        assert!(matches!(
            Volume::new(&[1.0], [2, 1, 1], [false; 3]),
            Err(ExtractionError::ValueCount { values: 1, samples: 2 })
        ));
    }
}
