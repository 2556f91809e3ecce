//! Which cells are noise: a threshold for the normalisation `local-above`.

use crate::dip::dip;
use tigereye_core::{
    Directions, Field, Normalization, ProfileRule, Tensor2, TotalAnisotropy, TransmissionField,
};

/// Bars of the histogram.
const BARS: usize = 256;
/// Samples of the transmission profiles; their means hardly depend on it.
const SAMPLES: usize = 64;

/// The dip of a histogram of strengths from which it has two modes. Cells are no independent sample, so a significant
/// dip alone means little: smooth fields of one kind of tensor reach 0.032 (`cantilever`, the stress of a plate 0.010),
/// slices of a brain with the noise around it 0.039 and 0.055, a field of two strengths 0.245.
const TWO_MODES: f64 = 0.035;
/// Times the square root of the number of values: a dip that one sample in twenty of a single mode exceeds (Hartigan
/// and Hartigan, table 1).
const SIGNIFICANT: f64 = 0.52;
/// Least share of the cells on either side of a threshold.
const LEAST_CLASS: f64 = 0.05;
/// More values than these are thinned out: that changes a dip by less than 1e-4.
const MOST_VALUES: usize = 1 << 16;

/// The fraction of the largest mean transmission that separates weak cells, such as the noise around an object, from
/// strong ones: the threshold that maximises the variance between both classes (Otsu, A threshold selection method from
/// gray-level histograms, IEEE Transactions on Systems, Man, and Cybernetics 9, 1979), over a histogram of the cells
/// that transmit at all. `None` unless the histogram has two modes by Hartigan's dip, each with a twentieth of the
/// cells: any histogram has a best threshold, but that of a stress concentration, say, has a tail and no background.
#[must_use]
pub fn suggested_local_above(field: &Field<Tensor2>) -> Option<f64> {
    let directions = Directions::new(SAMPLES).ok()?;
    let transmission = TransmissionField::from_tensors(field, directions, Normalization::Global).ok()?;
    if !has_two_modes(field, directions)? {
        return None;
    }
    let mut bars = [0.0_f64; BARS];
    for &rate in transmission.rates().iter().filter(|&&r| r > 0.0) {
        bars[bar_of(rate)] += 1.0;
    }
    let centre = |bar: usize| (bar as f64 + 0.5) / BARS as f64;
    let total: f64 = bars.iter().sum();
    let moment: f64 = bars.iter().enumerate().map(|(bar, n)| n * centre(bar)).sum();
    // The largest variance and the first and last bar before which it parts: where bars between are empty, the middle
    // is taken.
    let (mut best, mut weak, mut weak_moment) = ((0.0, 0, 0), 0.0, 0.0);
    for bar in 0..BARS - 1 {
        weak += bars[bar];
        weak_moment += bars[bar] * centre(bar);
        let strong = total - weak;
        if weak == 0.0 || strong == 0.0 {
            continue;
        }
        let apart = weak_moment / weak - (moment - weak_moment) / strong;
        let variance = weak * strong * apart * apart;
        if variance > best.0 {
            best = (variance, bar + 1, bar + 1);
        } else if variance == best.0 {
            best.2 = bar + 1;
        }
    }
    let below: f64 = bars[..best.1].iter().sum();
    let classes = LEAST_CLASS * total..=(1.0 - LEAST_CLASS) * total;
    let threshold = 0.5 * (best.1 + best.2) as f64 / BARS as f64;
    (best.0 > 0.0 && classes.contains(&below)).then_some(threshold)
}

fn bar_of(rate: f64) -> usize {
    ((rate * BARS as f64) as usize).min(BARS - 1)
}

/// Whether the strengths of the cells that transmit at all have two modes. They are those without total anisotropy,
/// whose step would make two modes of one.
fn has_two_modes(field: &Field<Tensor2>, directions: Directions) -> Option<bool> {
    let rule = ProfileRule { normalization: Normalization::Global, total_anisotropy: TotalAnisotropy::NONE };
    let transmission = TransmissionField::from_tensors(field, directions, rule).ok()?;
    // In bars: equal cells differ by rounding.
    let mut values: Vec<f64> =
        transmission.rates().iter().filter(|&&r| r > 0.0).map(|&r| bar_of(r) as f64).collect();
    values.sort_by(f64::total_cmp);
    let every = values.len().div_ceil(MOST_VALUES).max(1);
    let cells = values.len() as f64;
    let values: Vec<f64> = values.into_iter().step_by(every).collect();
    Some(dip(&values) >= TWO_MODES.max(SIGNIFICANT / cells.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    fn of_strengths(strength: impl Fn(usize) -> f64) -> Option<f64> {
        let grid = Grid::new(400, 1).expect("a size");
        suggested_local_above(&Field::from_fn(grid, |c| {
            let s = strength(c.x);
            Tensor2::new(s, 0.0, 0.0, s)
        }))
    }

    #[test]
    fn noise_and_signal_are_parted_between_them() {
        let found = of_strengths(|i| if i < 250 { 0.01 + 2e-4 * i as f64 } else { 0.2 + 0.002 * i as f64 });
        assert!(found.is_some_and(|f| f > 0.1 && f < 0.7), "{found:?}");
    }

    /// Cells that fall off from a concentration have a tail; those of any strength up to the largest have neither.
    #[test]
    fn fields_of_one_mode_have_no_threshold() {
        assert_eq!(of_strengths(|i| 1.0 / (1.0 + i as f64)), None);
        assert_eq!(of_strengths(|i| 1.0 / (1.0 + 0.01 * i as f64)), None);
        assert_eq!(of_strengths(|i| 1.0 + i as f64), None);
        // A single strong cell is no class.
        assert_eq!(of_strengths(|i| if i == 7 { 100.0 } else { 1.0 }), None);
    }

    #[test]
    fn fields_of_one_strength_have_no_threshold() {
        assert_eq!(of_strengths(|_| 3.0), None);
        assert_eq!(of_strengths(|i| if i < 50 { 0.0 } else { 2.0 }), None);
        assert_eq!(of_strengths(|_| 0.0), None);
    }
}
