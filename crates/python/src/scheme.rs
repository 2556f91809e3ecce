//! What determines a propagation, from the words of its options.

use crate::error::Fault;
use crate::plane::TensorPlane;
use crate::words;
use pyo3::FromPyObject;
use serde_json::{Value, json};
use tigereye_core::{
    Choice, CoreError, Directions, Normalization, ProfileRule, TotalAnisotropy, TransmissionField,
};
use tigereye_transport::{ScatteringRule, Scheme, SharedWeights, StopMeasure, Stopping};

/// The options as they are given, from a mapping.
#[derive(Clone, Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct SchemeOptions {
    directions: usize,
    scattering: String,
    threshold: Option<f64>,
    max_iterations: Option<usize>,
    stop: Option<String>,
    normalization: Option<String>,
    total_anisotropy: Option<String>,
}

/// What they mean.
#[derive(Debug)]
pub(crate) struct Scheming {
    pub(crate) directions: Directions,
    pub(crate) scattering: ScatteringRule,
    pub(crate) stop: Option<StopMeasure>,
    pub(crate) stopping: Stopping,
    pub(crate) rule: ProfileRule,
}

impl SchemeOptions {
    /// The values, checked.
    pub(crate) fn checked(&self) -> Result<Scheming, Fault> {
        let directions = Directions::new(self.directions).map_err(|e| Fault::option("directions", e))?;
        let scattering: ScatteringRule = words::choice("scattering", &self.scattering)?;
        let stop = words::optional::<StopMeasure>("stop", self.stop.as_deref())?;
        if self.threshold.is_some_and(|t| !t.is_finite() || t < 0.0) {
            return Err(Fault::option("threshold", "expected a finite number from 0"));
        }
        let usual = Stopping::REFERENCE;
        let measure = stop.unwrap_or(match scattering {
            ScatteringRule::Joint => StopMeasure::Flux,
            ScatteringRule::Linear => StopMeasure::Stationary,
        });
        let stopping = measure.stopping(
            self.threshold.unwrap_or(usual.rule.threshold()),
            self.max_iterations.unwrap_or(usual.max_iterations),
        );
        let mut rule =
            ProfileRule { normalization: Normalization::Local, total_anisotropy: TotalAnisotropy::default() };
        if let Some(text) = &self.normalization {
            rule.normalization = text.parse().map_err(|e: CoreError| Fault::option("normalization", e))?;
        }
        if let Some(text) = &self.total_anisotropy {
            rule.total_anisotropy =
                text.parse().map_err(|e: CoreError| Fault::option("total_anisotropy", e))?;
        }
        Ok(Scheming { directions, scattering, stop, stopping, rule })
    }
}

impl Scheming {
    /// Weights, lobes and scattering.
    pub(crate) fn scheme(&self) -> Scheme {
        Scheme::new(self.directions, SharedWeights::Thesis).with_scattering(self.scattering)
    }

    /// Shapes and rates of the cells.
    pub(crate) fn transmission(&self, plane: &TensorPlane) -> Result<TransmissionField, Fault> {
        TransmissionField::from_tensors(plane.field(), self.directions, self.rule)
            .map_err(|e| Fault::Value(format!("{}: {e}", plane.name)))
    }

    /// For the provenance.
    pub(crate) fn parameters(&self) -> Value {
        json!({
            "directions": self.directions.count(),
            "scattering": self.scattering.word(),
            "threshold": self.stopping.rule.threshold(),
            "max_iterations": self.stopping.max_iterations,
            "normalization": self.rule.normalization.to_string(),
            "total_anisotropy": self.rule.total_anisotropy.to_string(),
        })
    }
}
