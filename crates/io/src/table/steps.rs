//! Positions in equal steps.

/// Largest distance of a position from its lattice, relative to the step: text has few digits.
const TOLERANCE: f64 = 0.02;
/// Gaps between positions below this part of the largest are rounding.
const GAP: f64 = 0.25;
/// Equal steps along an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    /// The least.
    pub(super) first: f64,
    pub(super) step: f64,
    pub(super) count: usize,
}

impl Steps {
    /// The steps between finite positions in any order, if they are equal; otherwise [`Self::index`] refuses some.
    pub(super) fn of(mut positions: Vec<f64>) -> Self {
        positions.sort_by(f64::total_cmp);
        let (first, last) = (positions[0], positions[positions.len() - 1]);
        let largest = positions.windows(2).map(|p| p[1] - p[0]).fold(0.0, f64::max);
        let gaps = positions.windows(2).filter(|p| largest > 0.0 && p[1] - p[0] > GAP * largest).count();
        let step = if gaps == 0 { 1.0 } else { last / gaps as f64 - first / gaps as f64 };
        Self { first, step, count: gaps + 1 }
    }

    pub(super) fn index(&self, position: f64) -> Option<usize> {
        let place = (position - self.first) / self.step;
        let near = (place - place.round()).abs() <= TOLERANCE;
        (near && place.round() < self.count as f64).then(|| place.round() as usize)
    }
}
