//! One light distribution.

use crate::error::Fault;
use crate::picture::encoded;
use crate::plane::TensorPlane;
use crate::scheme::SchemeOptions;
use crate::work;
use numpy::{PyArray2, PyArray3, PyArrayMethods, ToPyArray};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;
use std::ops::ControlFlow;
use tigereye_core::{Cell, PolarProfile, StopReason, TransmissionField};
use tigereye_experiments::lights::profile_of_expression;
use tigereye_io::{npy, vti};
use tigereye_render::{HeatOptions, PolarOptions, TransmissionScale, heat_map, polar_overlay};
use tigereye_transport::{
    EightLobe, Emission, Engine, Light, Outcome, Problem, ScatteringRule, Stopping, StoppingRule,
    TransportError, stationary_light,
};
use tigereye_views::{light as light_view, masked};

/// Light, and what it ran through.
#[pyclass(frozen, name = "Light", module = "tigereye._native")]
#[derive(Debug)]
pub(crate) struct LightResult {
    plane: TensorPlane,
    transmission: TransmissionField,
    outcome: Outcome,
    sources: Vec<Cell>,
    story: String,
}

/// The brightness of a lamp over the direction.
#[derive(Debug, FromPyObject)]
pub(crate) enum ProfileOption {
    /// An expression in `theta`.
    Expression(String),
    /// A value for every direction.
    Samples(Vec<f64>),
}

/// A lamp: column, row and profile, 1 in every direction where there is none.
type Lamp = (usize, usize, Option<ProfileOption>);

/// Propagates the light of lamps.
#[pyfunction]
#[pyo3(signature = (plane, lights, impulse, steps, options, progress))]
pub(crate) fn propagate(
    py: Python<'_>,
    plane: &TensorPlane,
    lights: Vec<Lamp>,
    impulse: bool,
    steps: Option<usize>,
    options: SchemeOptions,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<LightResult> {
    let options = options.checked()?;
    let stopping = steps.map_or(options.stopping, Stopping::steps);
    let made = |(x, y, profile): &Lamp| -> Result<Light, Fault> {
        let fault = |problem: String| Fault::Value(format!("light {x},{y}: {problem}"));
        let profile = match profile {
            None => PolarProfile::constant(options.directions, 1.0),
            Some(ProfileOption::Expression(text)) => {
                profile_of_expression(text, options.directions).map_err(fault)?
            }
            Some(ProfileOption::Samples(samples)) => {
                PolarProfile::from_samples(options.directions, samples.clone())
                    .map_err(|e| fault(e.to_string()))?
            }
        };
        let cell = Cell::new(*x, *y);
        Ok(if impulse { Light::impulse(cell, profile) } else { Light::continuous(cell, profile) })
    };
    let lamps = lights.iter().map(made).collect::<Result<Vec<_>, Fault>>()?;
    let sources = lamps.iter().map(|l| l.cell).collect();
    let mut parameters = options.parameters();
    parameters["light"] = json!(lights.iter().map(|(x, y, _)| format!("{x},{y}")).collect::<Vec<_>>());
    parameters["impulse"] = json!(impulse);
    parameters["steps"] = json!(steps);
    let (transmission, outcome) = work::run_single(py, progress, |watch| {
        let transmission = options.transmission(plane)?;
        let scheme = options.scheme();
        let problem = Problem { scheme: &scheme, transmission: &transmission, lights: &lamps, stopping };
        problem.check().map_err(|e| Fault::option("light", e))?;
        let mut is_stopped = false;
        let total = if let StoppingRule::Steps(n) = stopping.rule { n as u64 } else { 0 };
        let mut told = |done: usize| {
            is_stopped = watch.told(done as u64, total);
            if is_stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let has_flashes = lamps.iter().any(|light| matches!(light.emission, Emission::Impulse(_)));
        let is_solved = scheme.scattering() == ScatteringRule::Linear
            && matches!(stopping.rule, StoppingRule::Converged { .. })
            && !has_flashes;
        let outcome: Result<Outcome, TransportError> = if is_solved {
            stationary_light(&problem, stopping.rule.threshold(), &mut |sweeps, _| told(sweeps))
        } else {
            EightLobe.propagate_observed(&problem, &mut |view| told(view.step()))
        };
        if is_stopped {
            return Err(Fault::Interrupted);
        }
        let outcome = outcome.map_err(|e| Fault::option("light", e))?;
        Ok((transmission, outcome))
    })?;
    let story = plane.story("propagate", parameters, false);
    Ok(LightResult { plane: plane.clone(), transmission, outcome, sources, story })
}

#[pymethods]
impl LightResult {
    /// Intensity, shape (H, W, S), W/rad; a copy.
    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let light = &self.outcome.distribution;
        let (grid, s) = (light.grid(), light.directions().count());
        light.samples().to_pyarray(py).reshape([grid.height(), grid.width(), s])
    }

    /// Energy of every cell, shape (H, W), W.
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let grid = self.outcome.distribution.grid();
        let energy = self.outcome.distribution.energy();
        energy.values().to_pyarray(py).reshape([grid.height(), grid.width()])
    }

    #[getter]
    fn steps(&self) -> usize {
        self.outcome.work.steps
    }

    #[getter]
    fn converged(&self) -> bool {
        self.outcome.stop == StopReason::Converged
    }

    #[getter]
    fn story(&self) -> &str {
        &self.story
    }

    /// The bytes of a file in this format.
    fn encoded<'py>(&self, py: Python<'py>, format: &str, picture: &str) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = work::run_single(py, None, |_| {
            let light = &self.outcome.distribution;
            match format {
                "npy" => Ok(npy::write_light(light)),
                "vti" => {
                    let image = tigereye_io::image_from_light(light, &self.plane.plane.geometry, &self.story);
                    vti::write(&image).map_err(|e| Fault::Value(e.to_string()))
                }
                _ => encoded(&self.picture(picture)?, format),
            }
        })?;
        Ok(PyBytes::new(py, &bytes))
    }
}

impl LightResult {
    fn picture(&self, kind: &str) -> Result<tigereye_render::Scene, Fault> {
        let light = &self.outcome.distribution;
        let (title, sources) = (self.plane.name.clone(), self.sources.clone());
        let (cell, style) = (self.plane.cell(), self.plane.style());
        let masked = masked(self.plane.field());
        match kind {
            "energy" => {
                let usual = light_view::options(Some(light_view::DECADES));
                let options = HeatOptions { title, sources, cell, masked, style, ..usual };
                Ok(heat_map(&light.energy(), &options))
            }
            "overlay" => {
                let transmission = TransmissionScale::Rate;
                let usual = PolarOptions::default();
                let options = PolarOptions { title, sources, transmission, cell, masked, style, ..usual };
                Ok(polar_overlay(Some(&self.transmission), Some(light), &options))
            }
            other => Err(Fault::option("picture", format!("`{other}`: expected overlay or energy"))),
        }
    }
}
