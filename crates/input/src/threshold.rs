//! Which cells are noise: a threshold for the normalisation `local-above`.

use tigereye_core::{Directions, Field, Normalization, Tensor2, TransmissionField};

/// Bars of the histogram.
const BARS: usize = 256;
/// Samples of the transmission profiles; their means hardly depend on it.
const SAMPLES: usize = 64;

/// The fraction of the largest mean transmission that best parts the cells into weak and strong ones: the threshold
/// that maximises the variance between both classes (Otsu, A threshold selection method from gray-level histograms,
/// IEEE Transactions on Systems, Man, and Cybernetics 9, 1979), over a histogram of the cells that transmit at all.
/// `None` where all of them transmit alike.
#[must_use]
pub fn suggested_local_above(field: &Field<Tensor2>) -> Option<f64> {
    let directions = Directions::new(SAMPLES).ok()?;
    let transmission = TransmissionField::from_tensors(field, directions, Normalization::Global).ok()?;
    let mut bars = [0.0_f64; BARS];
    for &rate in transmission.rates().iter().filter(|&&r| r > 0.0) {
        bars[((rate * BARS as f64) as usize).min(BARS - 1)] += 1.0;
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
    (best.0 > 0.0).then(|| 0.5 * (best.1 + best.2) as f64 / BARS as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    fn of_strengths(strength: impl Fn(usize) -> f64) -> Option<f64> {
        let grid = Grid::new(40, 1).expect("a size");
        suggested_local_above(&Field::from_fn(grid, |c| {
            let s = strength(c.x);
            Tensor2::new(s, 0.0, 0.0, s)
        }))
    }

    #[test]
    fn noise_and_signal_are_parted_between_them() {
        let found = of_strengths(|i| if i < 25 { 0.01 + 0.002 * i as f64 } else { 0.6 + 0.01 * i as f64 });
        assert!(found.is_some_and(|f| f > 0.3 && f < 0.6), "{found:?}");
    }

    #[test]
    fn fields_of_one_strength_have_no_threshold() {
        assert_eq!(of_strengths(|_| 3.0), None);
        assert_eq!(of_strengths(|i| if i < 5 { 0.0 } else { 2.0 }), None);
        assert_eq!(of_strengths(|_| 0.0), None);
    }
}
