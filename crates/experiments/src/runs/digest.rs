//! The numbers of runs that snapshot tests remember.

use serde::Serialize;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct LightDigest {
    pub(crate) directions: usize,
    pub(crate) steps: usize,
    pub(crate) stop: String,
    pub(crate) cell_updates: u64,
    pub(crate) total_energy: String,
    /// Smallest, quartiles and largest energy of a cell.
    pub(crate) energy_quantiles: [String; 5],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct GradientDigest {
    pub(crate) directions: usize,
    pub(crate) slices: usize,
    pub(crate) sources: u64,
    pub(crate) iterations_total: u64,
    pub(crate) iterations_max: u64,
    pub(crate) cell_updates: u64,
    pub(crate) limited: u64,
    pub(crate) mean: String,
    /// Smallest, quartiles and largest value of an inner cell.
    pub(crate) quantiles: [String; 5],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct ImportanceDigest {
    pub(crate) directions: usize,
    pub(crate) sweeps: usize,
    /// Smallest, quartiles and largest importance of a cell and direction.
    pub(crate) quantiles: [String; 5],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct PulsesDigest {
    pub(crate) pulses: usize,
    pub(crate) settled: usize,
    /// Steps or evaluations of all pulses.
    pub(crate) stopped_steps: String,
    pub(crate) plain_steps: String,
    pub(crate) evaluations: String,
    /// Smallest, quartiles and largest of the pulses.
    pub(crate) stopped_distance: [String; 5],
    pub(crate) missing_energy: [String; 5],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct FtleDigest {
    pub(crate) samples: usize,
    pub(crate) lines: usize,
    pub(crate) left: String,
    /// Smallest, quartiles and largest of the larger exponents.
    pub(crate) quantiles: [String; 5],
}

/// Smallest value, quartiles and largest value.
pub(crate) fn quantiles(mut values: Vec<f64>) -> [String; 5] {
    values.sort_unstable_by(f64::total_cmp);
    std::array::from_fn(|i| match values.len() {
        0 => "none".to_owned(),
        n => rounded(values[i * (n - 1) / 4]),
    })
}

/// Nine digits, or `~0` for rounding noise.
pub(crate) fn rounded(x: f64) -> String {
    if x == 0.0 {
        "0".to_owned()
    } else if x.abs() < 1e-9 {
        "~0".to_owned()
    } else {
        format!("{x:.8e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_keeps_nine_digits_and_hides_noise() {
        assert_eq!(rounded(std::f64::consts::PI), "3.14159265e0");
        assert_eq!(
            (rounded(-3e-14), rounded(0.0), rounded(f64::NAN)),
            ("~0".into(), "0".into(), "NaN".into())
        );
    }

    #[test]
    fn quantiles_are_order_statistics() {
        let q = quantiles(vec![4.0, 0.0, 3.0, 1.0, 2.0]);
        assert_eq!(q[2], "2.00000000e0");
        assert_eq!(quantiles(Vec::new())[0], "none");
    }
}
