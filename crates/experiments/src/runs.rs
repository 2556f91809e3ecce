//! Runs settings and keeps what figures and checks ask for.

use crate::host::Host;
use crate::pulses::{PulseRecord, run_pulses};
use crate::scene::where_result;
use crate::settings::{GradientSettings, LightSettings, RunSettings, Settings};
use crate::spec::EngineChoice;
use crate::{Medium, Reel};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use thiserror::Error;
use tigereye_core::{Cell, Field, LightDistribution, StopReason, Surface, TransmissionField, Work, math};
use tigereye_lines::{Ftle, FtleOptions, SamplingError};
use tigereye_ltg::{LtgError, LtgOutcome, LtgSettings, Precision, SweepObserver, check_fit, sweep};
use tigereye_render::RenderError;
use tigereye_scenes::SceneError;
use tigereye_transport::{
    EightLobe, Engine, Problem, SampleSpace, Scattering, Scheme, StepView, TransportError,
};
use tigereye_views::ftle::exponents;

/// A run that could not be made, although its settings were in order.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RunError {
    /// A field that cannot transmit light.
    #[error("run \"{run}\": {source}")]
    Field {
        /// Name of the run.
        run: String,
        /// What is wrong with the field or scene.
        source: SceneError,
    },
    /// A propagation that cannot start.
    #[error("run \"{run}\": {source}")]
    Propagation {
        /// Name of the run.
        run: String,
        /// What is wrong with it.
        source: TransportError,
    },
    /// A sweep that cannot start.
    #[error("run \"{run}\": {source}")]
    Sweep {
        /// Name of the run.
        run: String,
        /// What is wrong with it.
        source: LtgError,
    },
    /// Exponents that cannot be computed.
    #[error("run \"{run}\": {source}")]
    Ftle {
        /// Name of the run.
        run: String,
        /// What is wrong with it.
        source: SamplingError,
    },
    /// The host asked to end.
    #[error("interrupted")]
    Interrupted,
    /// A picture that cannot be drawn.
    #[error("figure \"{figure}\": {source}")]
    Figure {
        /// Name of the figure.
        figure: String,
        /// What is wrong with it.
        source: RenderError,
    },
    /// A panel without anything to show.
    #[error("figure \"{figure}\", panel \"{panel}\" has nothing to show: the run ended before its step")]
    Panel {
        /// Name of the figure.
        figure: String,
        /// Heading of the panel.
        panel: String,
    },
    /// An expression in a figure or check that cannot be read.
    #[error("`{expression}`: {problem}")]
    Expression {
        /// The expression.
        expression: String,
        /// What is wrong with it.
        problem: String,
    },
}

/// Results of all runs of an experiment.
#[derive(Debug, Default)]
pub(crate) struct Results {
    pub(crate) lights: BTreeMap<String, LightResult>,
    pub(crate) gradients: BTreeMap<String, LtgOutcome>,
    pub(crate) pulses: BTreeMap<String, Vec<PulseRecord>>,
    pub(crate) ftle: BTreeMap<String, Ftle>,
    /// What the cells are, for runs of scenes.
    pub(crate) surfaces: BTreeMap<String, Field<Option<Surface>>>,
    /// Seconds each run took.
    pub(crate) seconds: BTreeMap<String, f64>,
}

impl Results {
    /// A gradient's scalar where it is a result.
    pub(crate) fn inner(&self, run: &str, field: &Field<f64>) -> Field<f64> {
        where_result(field, self.surfaces.get(run))
    }
}

/// What a propagation leaves for figures and checks.
#[derive(Debug)]
pub(crate) struct LightResult {
    pub(crate) transmission: TransmissionField,
    pub(crate) sources: Vec<Cell>,
    pub(crate) last: LightDistribution,
    pub(crate) frames: BTreeMap<usize, LightDistribution>,
    /// Energy in the grid before the first step and after each, W.
    pub(crate) energies: Vec<f64>,
    /// Mean and standard deviation of the energy's distance from the centre, after each step (index 0: before the first);
    /// empty unless asked for.
    pub(crate) radii: Vec<(f64, f64)>,
    /// Steps for an animation, where one is asked for.
    pub(crate) reel: Option<Reel>,
    pub(crate) stop: StopReason,
    pub(crate) work: Work,
}

pub(crate) fn run_all(settings: &Settings, memory_bytes: u64, host: &dyn Host) -> Result<Results, RunError> {
    let mut results = Results::default();
    for (name, run) in &settings.runs {
        let Some(medium) = settings.medium(run.field()) else { continue };
        if let Some(scene) = medium.scene() {
            results.surfaces.insert(name.clone(), scene.layout.surfaces.clone());
        }
        let start = host.seconds();
        match run {
            RunSettings::Light(light) => {
                let result = run_light(name, light, medium, host)?;
                results.lights.insert(name.clone(), result);
            }
            RunSettings::Gradient(gradient) => {
                let result = run_gradient(name, gradient, medium, memory_bytes, host)?;
                results.gradients.insert(name.clone(), result);
            }
            RunSettings::Pulses(pulses) => {
                let result = run_pulses(name, pulses, medium, host)?;
                results.pulses.insert(name.clone(), result);
            }
            RunSettings::Ftle(ftle) => {
                let Some(field) = medium.tensors() else { continue };
                if host.progress(name, 0, 0).is_break() {
                    return Err(RunError::Interrupted);
                }
                let options =
                    FtleOptions { length: ftle.length, samples: ftle.samples, ..FtleOptions::default() };
                let result = exponents(field, ftle.following, ftle.family, &options)
                    .map_err(|source| RunError::Ftle { run: name.clone(), source })?;
                results.ftle.insert(name.clone(), result);
            }
        }
        results.seconds.insert(name.clone(), host.seconds() - start);
    }
    Ok(results)
}

fn run_light(
    name: &str,
    settings: &LightSettings,
    medium: Medium<'_>,
    host: &dyn Host,
) -> Result<LightResult, RunError> {
    let setup = &settings.setup;
    let transmission = medium
        .transmission(setup.directions, setup.normalization)
        .map_err(|source| RunError::Field { run: name.to_owned(), source })?;
    let scheme = Scheme::new(setup.directions, setup.weights);
    let problem = Problem {
        scheme: &scheme,
        transmission: &transmission,
        lights: &settings.lights,
        stopping: setup.stopping,
    };
    let start = problem.before_first_step();
    let mut frames = BTreeMap::new();
    let mut energies = vec![start.total_energy()];
    let mut radii = if settings.trace_radius { vec![energy_radius(&start.energy())] } else { Vec::new() };
    let mut reel = settings.reel_every.map(|every| Reel::new(medium.grid().cells(), every));
    if let Some(reel) = &mut reel {
        reel.add(|| start.energy());
    }
    if settings.frames.contains(&0) {
        frames.insert(0, start);
    }
    let mut interrupted = false;
    let mut observe = |view: &dyn StepView| {
        energies.push(view.energy());
        if settings.trace_radius {
            radii.push(energy_radius(&view.distribution().energy()));
        }
        if let Some(reel) = &mut reel {
            reel.add(|| view.energies());
        }
        if settings.frames.binary_search(&view.step()).is_ok() {
            frames.insert(view.step(), view.distribution());
        }
        if view.step().is_multiple_of(64) && host.progress(name, view.step() as u64, 0).is_break() {
            interrupted = true;
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    };
    let engine: &dyn Engine = match settings.engine {
        EngineChoice::EightLobe => &EightLobe,
        EngineChoice::SampleSpace => &SampleSpace,
    };
    let outcome = engine
        .propagate_observed(&problem, &mut observe)
        .map_err(|source| RunError::Propagation { run: name.to_owned(), source })?;
    if interrupted {
        return Err(RunError::Interrupted);
    }
    Ok(LightResult {
        sources: settings.lights.iter().map(|l| l.cell).collect(),
        last: outcome.distribution,
        frames,
        energies,
        radii,
        reel,
        stop: outcome.stop,
        work: outcome.work,
        transmission,
    })
}

/// Mean and standard deviation of the distance (cells) of energy from the centre of the grid; 0 in the dark.
pub(crate) fn energy_radius(energy: &Field<f64>) -> (f64, f64) {
    let grid = energy.grid();
    let centre = [(grid.width() - 1) as f64 / 2.0, (grid.height() - 1) as f64 / 2.0];
    let radius = |c: Cell| math::hypot(c.x as f64 - centre[0], c.y as f64 - centre[1]);
    let total: f64 = energy.values().iter().sum();
    if total <= 0.0 {
        return (0.0, 0.0);
    }
    let mean = energy.iter().map(|(c, e)| radius(c) * e).sum::<f64>() / total;
    let variance =
        energy.iter().map(|(c, e)| (radius(c) - mean) * (radius(c) - mean) * e).sum::<f64>() / total;
    (mean, variance.sqrt())
}

struct Watch<'a> {
    name: &'a str,
    host: &'a dyn Host,
}

impl SweepObserver for Watch<'_> {
    fn progress(&self, done: u64, total: u64) -> ControlFlow<()> {
        self.host.progress(self.name, done, total)
    }
}

fn run_gradient(
    name: &str,
    settings: &GradientSettings,
    medium: Medium<'_>,
    memory_bytes: u64,
    host: &dyn Host,
) -> Result<LtgOutcome, RunError> {
    let setup = &settings.setup;
    let failed = |source| RunError::Sweep { run: name.to_owned(), source };
    let ltg = LtgSettings {
        stopping: setup.stopping,
        omega_step: settings.omega_step,
        slices: settings.slices.clone(),
        memory_bytes,
        level: host.level(),
        precision: Precision::F64,
    };
    // Before anything large is made.
    let walls = medium.scene().map_or(0, |scene| scene.layout.reflecting());
    check_fit(medium.grid(), setup.directions, walls, &ltg).map_err(failed)?;
    let transmission = medium
        .transmission(setup.directions, setup.normalization)
        .map_err(|source| RunError::Field { run: name.to_owned(), source })?;
    let scheme = Scheme::new(setup.directions, setup.weights);
    let scattering = Scattering::new(&scheme, &transmission);
    sweep(&scattering, &ltg, &Watch { name, host }).map_err(|source| match source {
        LtgError::Interrupted { .. } => RunError::Interrupted,
        source => failed(source),
    })
}
