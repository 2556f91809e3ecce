//! Statistics of samples.

/// Pearson's correlation of pairs; `None` if one of the two is constant or there are no pairs.
#[must_use]
pub fn pearson(pairs: &[(f64, f64)]) -> Option<f64> {
    let n = pairs.len() as f64;
    let (ma, mb) = (pairs.iter().map(|p| p.0).sum::<f64>() / n, pairs.iter().map(|p| p.1).sum::<f64>() / n);
    let sum = |f: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(f).sum::<f64>();
    let covariance = sum(&|p| (p.0 - ma) * (p.1 - mb));
    let spread = (sum(&|p| (p.0 - ma) * (p.0 - ma)) * sum(&|p| (p.1 - mb) * (p.1 - mb))).sqrt();
    (spread > 0.0).then_some(covariance / spread)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn correlation_is_of_the_deviations_from_the_means() {
        let line: Vec<(f64, f64)> = (0..5).map(|i| (f64::from(i), 7.0 - 2.0 * f64::from(i))).collect();
        assert_eq!(pearson(&line), Some(-1.0));
        assert_eq!(pearson(&[(1.0, 2.0), (1.0, 3.0)]), None);
        assert_eq!(pearson(&[]), None);
    }
}
