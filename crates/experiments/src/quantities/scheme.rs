//! Constants of the scheme and of lights, of no run.

use crate::form::NonNegative;
use crate::names::Names;
use crate::numerics::fine_directions;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use serde::Deserialize;
use tigereye_core::{Directions, math};
use tigereye_transport::{Scheme as Cones, SharedWeights, emitter, half_core_alpha_rad};

/// A constant of the scheme.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub struct Scheme(SchemeConstant);

/// A constant of the scheme.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum SchemeConstant {
    /// Weight e1 of the face cone in the overlap (eq. 3.1).
    E1,
    /// Weight e2 of the diagonal cone in the overlap (eq. 3.2).
    E2,
    /// Core angle alpha, degrees.
    AlphaDeg,
    /// Largest deviation from 1 of the sum of all weights over all samples, S = 8, 16, ... 360.
    WeightSumError,
}

impl QuantityKind for Scheme {
    fn resolve(&self, _names: &mut Names<'_, '_>) -> Option<Measure> {
        let constant = self.0;
        measure(move |_| Ok(constant.value()))
    }
}

impl SchemeConstant {
    fn value(self) -> f64 {
        match self {
            Self::E1 => SharedWeights::Thesis.e1(),
            Self::E2 => SharedWeights::Thesis.e2(),
            Self::AlphaDeg => math::degrees(2.0 * half_core_alpha_rad()),
            Self::WeightSumError => (8..=360)
                .step_by(8)
                .filter_map(|s| Directions::new(s).ok())
                .map(|d| {
                    let scheme = Cones::new(d, SharedWeights::Thesis);
                    let error = |t| (scheme.weights(t).iter().sum::<f64>() - 1.0).abs();
                    (0..d.count()).map(error).fold(0.0, f64::max)
                })
                .fold(0.0, f64::max),
        }
    }
}

/// Flux of an emitter of this exponent, W (360 samples).
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub struct EmitterFlux(NonNegative);

impl QuantityKind for EmitterFlux {
    fn resolve(&self, _names: &mut Names<'_, '_>) -> Option<Measure> {
        let power = self.0.get();
        measure(move |_| Ok(emitter(fine_directions(), 0.0, power).integral()))
    }
}
