//! Numbers of pulses, summed up.

use crate::numerics::worst;
use crate::runs::pulses::{PulseNumber, PulseRecord};
use serde::Deserialize;

/// One number that summarises many.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum Summary {
    /// The smallest.
    Least,
    /// Their mean.
    Mean,
    /// The largest.
    Most,
    /// The largest difference between consecutive pulses of a run, which are neighbours if its cells are and it has one
    /// angle.
    Jump,
}

/// One number for the pulses of some runs; not a number where it is not one for any of them, or where there are too
/// few.
pub(crate) fn summary(runs: &[&[PulseRecord]], number: PulseNumber, over: Summary) -> f64 {
    let values: Vec<Vec<f64>> = runs.iter().map(|r| r.iter().map(|p| p.number(number)).collect()).collect();
    of_values(&values, over)
}

fn of_values(runs: &[Vec<f64>], over: Summary) -> f64 {
    let all = || runs.iter().flatten().copied();
    match over {
        Summary::Least => -worst(all().map(|v| -v)),
        Summary::Mean => all().sum::<f64>() / all().count() as f64,
        Summary::Most => worst(all()),
        Summary::Jump => worst(runs.iter().flat_map(|r| r.windows(2).map(|w| (w[1] - w[0]).abs()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Summary; 4] = [Summary::Least, Summary::Mean, Summary::Most, Summary::Jump];

    #[test]
    fn runs_are_summed_up_as_one_but_do_not_jump_into_each_other() {
        assert_eq!(ALL.map(|over| of_values(&[vec![2.0, 7.0, 3.0]], over)), [2.0, 4.0, 7.0, 5.0]);
        assert_eq!(
            ALL.map(|over| of_values(&[vec![1.0, 2.0], vec![12.0, 9.0]], over)),
            [1.0, 6.0, 12.0, 3.0]
        );
    }

    #[test]
    fn what_is_not_a_number_is_not_passed_over() {
        for over in ALL {
            assert!(of_values(&[vec![1.0, f64::NAN, 2.0]], over).is_nan());
            assert!(of_values(&[], over).is_nan() && of_values(&[Vec::new()], over).is_nan());
        }
        assert!(of_values(&[vec![1.0], vec![2.0]], Summary::Jump).is_nan());
    }
}
