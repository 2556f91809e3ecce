//! The light transport gradient.

use crate::error::Fault;
use crate::picture::encoded;
use crate::plane::TensorPlane;
use crate::scheme::SchemeOptions;
use crate::{words, work};
use numpy::{PyArray3, PyArrayMethods, ToPyArray};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;
use std::ops::ControlFlow;
use tigereye_core::{Choice, LtgVolume, SweepWork};
use tigereye_experiments::lights::sample_of;
use tigereye_io::{npy, vti};
use tigereye_ltg::{
    LtgError, LtgSettings, Precision, Shard, SweepObserver, check_fit, check_linear_fit, linear_sweep_part,
    omega_step_of_volumes, sweep_part,
};
use tigereye_render::{HeatOptions, Scene};
use tigereye_transport::{Level, LinearScattering, Scattering, ScatteringRule, StopMeasure};
use tigereye_views::{gradient, masked};

/// What the sweep tells, for Python.
struct Observer<'a>(&'a work::Watch);

impl SweepObserver for Observer<'_> {
    fn progress(&self, done: u64, total: u64) -> ControlFlow<()> {
        if self.0.told(done, total) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// The options of the sweep alone, from a mapping.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct SweepOptions {
    omega_step: Option<usize>,
    slices: Option<Vec<usize>>,
    slices_deg: Option<Vec<f64>>,
    precision: Option<String>,
    threads: Option<usize>,
    memory: u64,
}

/// A gradient, and what it is of.
#[pyclass(frozen, name = "Gradient", module = "tigereye._native")]
#[derive(Debug)]
pub(crate) struct GradientResult {
    plane: TensorPlane,
    volume: LtgVolume,
    work: SweepWork,
    story: String,
}

/// Computes the gradient.
#[pyfunction]
pub(crate) fn ltg(
    py: Python<'_>,
    plane: &TensorPlane,
    options: SchemeOptions,
    sweep: SweepOptions,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<GradientResult> {
    let options = options.checked()?;
    let directions = options.directions;
    let is_linear = options.scattering == ScatteringRule::Linear;
    if is_linear && options.stop.is_some_and(|stop| stop != StopMeasure::Stationary) {
        let words = "gradients of linear scattering are those of the stationary state: expected stationary";
        return Err(Fault::option("stop", words).into());
    }
    let slices = match (&sweep.slices, &sweep.slices_deg) {
        (Some(_), Some(_)) => {
            return Err(Fault::option("slices_deg", "expected either slices or slices_deg").into());
        }
        (slices, None) => slices.clone(),
        (None, Some(degrees)) => {
            let samples = degrees.iter().map(|deg| sample_of(*deg, directions)).collect::<Result<_, _>>();
            Some(samples.map_err(|e| Fault::option("slices_deg", e))?)
        }
    };
    let precision = words::optional("precision", sweep.precision.as_deref())?.unwrap_or(Precision::F64);
    let mut settings = LtgSettings {
        stopping: options.stopping,
        omega_step: sweep.omega_step.unwrap_or_else(|| omega_step_of_volumes(directions)),
        slices,
        memory_bytes: sweep.memory,
        level: Level::detect(),
        precision,
    };
    settings.slices = Some(settings.checked_slices(directions).map_err(Fault::sweep)?);
    let outcome = work::run(py, sweep.threads, progress, |watch| {
        let fits = match is_linear {
            true => check_linear_fit(plane.grid(), directions, &settings),
            false => check_fit(plane.grid(), directions, 0, &settings),
        };
        fits.map_err(Fault::sweep)?;
        let transmission = options.transmission(plane)?;
        let scheme = options.scheme();
        let scattering = Scattering::new(&scheme, &transmission);
        let observer = Observer(watch);
        let part = match is_linear {
            true => {
                let linear = LinearScattering::new(&scattering);
                linear_sweep_part(&linear, &settings, Shard::WHOLE, None, &observer)
            }
            false => sweep_part(&scattering, &settings, Shard::WHOLE, None, &observer),
        };
        part.and_then(|part| part.into_outcome()).map_err(|e: LtgError| Fault::sweep(e))
    })?;
    let mut parameters = options.parameters();
    parameters["omega_step"] = json!(settings.omega_step);
    parameters["slices"] = json!(settings.slices);
    parameters["precision"] = json!(settings.precision.word());
    let story = plane.story("ltg", parameters, false);
    Ok(GradientResult { plane: plane.clone(), volume: outcome.volume, work: outcome.work, story })
}

#[pymethods]
impl GradientResult {
    /// The gradient, shape (T, H, W), W/rad; a copy.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let grid = self.volume.grid();
        let shape = [self.volume.slices().len(), grid.height(), grid.width()];
        self.volume.values().to_pyarray(py).reshape(shape)
    }

    #[getter]
    fn slices(&self) -> Vec<usize> {
        self.volume.slices().to_vec()
    }

    #[getter]
    fn directions(&self) -> usize {
        self.volume.directions().count()
    }

    #[getter]
    fn sources(&self) -> u64 {
        self.work.sources
    }

    #[getter]
    fn story(&self) -> &str {
        &self.story
    }

    /// The bytes of a file in this format.
    fn encoded<'py>(&self, py: Python<'py>, format: &str) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = work::run_single(py, None, |_| match format {
            "npy" => Ok(npy::write_ltg(&self.volume)),
            "vti" => {
                let image =
                    tigereye_io::image_from_ltg(&self.volume, &self.plane.plane.geometry, &self.story);
                vti::write(&image).map_err(|e| Fault::Value(e.to_string()))
            }
            _ => encoded(&self.picture(), format),
        })?;
        Ok(PyBytes::new(py, &bytes))
    }
}

impl GradientResult {
    /// The only slice, or the mean over the slices.
    fn picture(&self) -> Scene {
        let volume = &self.volume;
        let (slice, scalar) = match volume.slices() {
            [t] => (volume.slice(*t), gradient::Scalar::SliceAt(volume.directions().angle_deg(*t))),
            _ => (None, gradient::Scalar::Mean),
        };
        let field = slice.unwrap_or_else(|| volume.mean_over_directions());
        let options = HeatOptions {
            title: self.plane.name.clone(),
            cell: self.plane.cell(),
            masked: masked(self.plane.field()),
            style: self.plane.style(),
            ..HeatOptions::default()
        };
        gradient::picture(&field, scalar, options)
    }
}
