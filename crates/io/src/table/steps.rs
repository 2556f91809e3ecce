//! Positions in equal steps.

/// Largest distance of a position from its lattice, relative to the step: text has few digits.
const TOLERANCE: f64 = 0.02;
/// Gaps between positions below this fraction of the largest gap are rounding.
const GAP: f64 = 0.25;
/// Difference of a gap from whole steps, in steps, that is rounding.
const MULTIPLE: f64 = 0.1;

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
        let gaps = positions.windows(2).map(|p| p[1] - p[0]).filter(|gap| *gap > GAP * largest && *gap > 0.0);
        let gaps: Vec<f64> = gaps.collect();
        // Where a whole row or column is missing, a gap is twice the others.
        let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let multiples = gaps.iter().map(|gap| (gap / least).round());
        let are_multiples =
            gaps.iter().zip(multiples.clone()).all(|(gap, n)| (gap / least - n).abs() <= MULTIPLE);
        let steps = if are_multiples { multiples.sum::<f64>() as usize } else { gaps.len() };
        let step = if steps == 0 { 1.0 } else { last / steps as f64 - first / steps as f64 };
        Self { first, step, count: steps + 1 }
    }

    pub(super) fn index(&self, position: f64) -> Option<usize> {
        let place = (position - self.first) / self.step;
        let near = (place - place.round()).abs() <= TOLERANCE;
        (near && place.round() < self.count as f64).then(|| place.round() as usize)
    }
}
