//! A function of direction, sampled.

use crate::{CoreError, Directions};

/// Values at the `S` samples of [`Directions`]: radiant intensity (W/rad) or transmission (1).
#[derive(Clone, Debug, PartialEq)]
pub struct PolarProfile {
    directions: Directions,
    samples: Vec<f64>,
}

impl PolarProfile {
    /// A profile from its samples, sample `t` at `omega_t`.
    ///
    /// # Errors
    /// [`CoreError::ProfileLength`] or, for the first sample that is not finite, [`CoreError::ProfileValue`].
    pub fn from_samples(directions: Directions, samples: Vec<f64>) -> Result<Self, CoreError> {
        if samples.len() != directions.count() {
            return Err(CoreError::ProfileLength { samples: samples.len(), expected: directions.count() });
        }
        match samples.iter().position(|v| !v.is_finite()) {
            Some(sample) => Err(CoreError::ProfileValue { sample, value: samples[sample] }),
            None => Ok(Self { directions, samples }),
        }
    }

    /// A profile whose sample is computed from its index; values that are not finite become 0.
    pub fn from_fn(directions: Directions, mut value: impl FnMut(usize) -> f64) -> Self {
        let samples = (0..directions.count())
            .map(|t| Some(value(t)).filter(|v| v.is_finite()).unwrap_or(0.0))
            .collect();
        Self { directions, samples }
    }

    /// The same value in every direction.
    #[must_use]
    pub fn constant(directions: Directions, value: f64) -> Self {
        Self::from_fn(directions, |_| value)
    }

    /// The sampling.
    #[must_use]
    pub const fn directions(&self) -> Directions {
        self.directions
    }
    /// The samples.
    #[must_use]
    pub fn samples(&self) -> &[f64] {
        &self.samples
    }
    /// `h * sum`: the integral over the circle (radiant flux, W, for an intensity).
    #[must_use]
    pub fn integral(&self) -> f64 {
        self.directions.step_rad() * self.samples.iter().sum::<f64>()
    }
    /// Mean over the samples.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.samples.iter().sum::<f64>() / self.samples.len() as f64
    }
    /// The profile with negative values set to 0, as lights are (thesis, section 3.2, subscript +).
    #[must_use]
    pub fn clipped(mut self) -> Self {
        for v in &mut self.samples {
            *v = v.max(0.0);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_one_integrates_to_the_circle() {
        let d = Directions::new(32).expect("directions");
        let p = PolarProfile::constant(d, 1.0);
        assert!((p.integral() - crate::math::TAU).abs() < 1e-15);
        assert_eq!(p.mean(), 1.0);
    }

    #[test]
    fn bad_samples_are_refused() {
        let d = Directions::new(8).expect("directions");
        assert!(PolarProfile::from_samples(d, vec![0.0; 7]).is_err());
        let e = PolarProfile::from_samples(d, vec![0.0, 1.0, f64::INFINITY, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(e, Err(CoreError::ProfileValue { sample: 2, value: f64::INFINITY }));
    }

    #[test]
    fn clipping_removes_negative_light() {
        let d = Directions::new(8).expect("directions");
        let p = PolarProfile::from_fn(d, |t| d.cos(t)).clipped();
        assert!(p.samples().iter().all(|&v| v >= 0.0) && p.samples()[0] == 1.0);
    }
}
