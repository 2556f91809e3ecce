//! The light transport gradient of a field.

use crate::form::{Chosen, DirectionCount, Finite, NormalizationRule, OmegaStep, Placed, Scope, Stop};
use crate::host::Host;
use crate::ids::MediumId;
use crate::lights::sample_of;
use crate::media::Media;
use crate::numerics::gradient::inner_cells;
use crate::runs::digest::{GradientDigest, quantiles, rounded};
use crate::runs::error::RunError;
use crate::runs::setup::{RunResolver, Setup};
use serde::Deserialize;
use serde_json::json;
use std::ops::ControlFlow;
use tigereye_core::{Field, LtgVolume, Surface};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{IoError, image_from_ltg, vti};
use tigereye_ltg::{
    LtgError, LtgOutcome, LtgSettings, Precision, SweepObserver, check_fit, omega_step_of_slices,
    omega_step_of_volumes, sweep,
};
use tigereye_report::DataFile;
use tigereye_transport::{Scattering, Scheme, SharedWeights, StoppingRule};
use tigereye_views::gradient::where_result;

/// The light transport gradient of a field.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Gradient {
    /// Name of the field.
    field: Placed<String>,
    /// Angular samples S, a multiple of 8.
    #[serde(default)]
    directions: DirectionCount,
    /// How profiles are scaled.
    #[serde(default)]
    normalization: NormalizationRule,
    /// Cone weights of the overlap.
    #[serde(default)]
    weights: Chosen<SharedWeights>,
    /// When each propagation ends.
    #[serde(default)]
    stop: Stop,
    /// Half-width of the angular difference.
    #[serde(default)]
    omega_step: OmegaStep,
    /// Angles to compute, degrees; all by default. Each must be a sample.
    #[serde(default)]
    slices_deg: Option<Vec<Finite>>,
    /// When it runs.
    #[serde(default)]
    pub(crate) scope: Scope,
}

/// A sweep, ready to start.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) setup: Setup,
    /// Half-width of the angular difference, samples.
    omega_step: usize,
    /// Sample indices; `None`: all.
    pub(crate) slices: Option<Vec<usize>>,
}

impl Gradient {
    pub(crate) fn resolve(&self, run: &mut RunResolver<'_, '_>) -> Option<Plan> {
        let setup = run.setup(&self.field, self.directions, self.normalization, self.weights, self.stop)?;
        let s = setup.directions.count();
        let omega_step = match self.omega_step {
            OmegaStep::Volumes => omega_step_of_volumes(setup.directions),
            OmegaStep::Slices => omega_step_of_slices(setup.directions),
            OmegaStep::Samples(k) => k,
        };
        if !(1..=s / 2).contains(&omega_step) {
            run.fault(&format!(": angular step {omega_step}: expected 1 to {}", s / 2));
            return None;
        }
        let mut slices = Vec::new();
        for deg in self.slices_deg.iter().flatten() {
            match sample_of(deg.get(), setup.directions) {
                Ok(t) => slices.push(t),
                Err(problem) => run.fault(&format!(": {problem}")),
            }
        }
        if setup.stopping.rule == StoppingRule::Steps(0) {
            run.fault(": a gradient of 0 steps: expected 1 or more");
            return None;
        }
        let slices = self.slices_deg.is_some().then_some(slices);
        Some(Plan { setup, omega_step, slices })
    }
}

/// A gradient with what is around it.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) outcome: LtgOutcome,
    /// What the cells are, in a scene.
    pub(crate) surfaces: Option<Field<Option<Surface>>>,
}

impl Plan {
    pub(crate) const fn medium(&self) -> MediumId {
        self.setup.medium
    }

    pub(crate) fn run(
        &self,
        name: &str,
        media: &Media,
        memory_bytes: u64,
        host: &dyn Host,
    ) -> Result<Outcome, RunError> {
        let medium = media.medium(self.setup.medium);
        let failed = |source| RunError::Sweep { run: name.to_owned(), source };
        let settings = LtgSettings {
            stopping: self.setup.stopping,
            omega_step: self.omega_step,
            slices: self.slices.clone(),
            memory_bytes,
            level: host.level(),
            precision: Precision::F64,
        };
        // Before anything large is made.
        let walls = medium.scene().map_or(0, |scene| scene.layout.reflecting());
        check_fit(medium.grid(), self.setup.directions, walls, &settings).map_err(failed)?;
        let transmission = self.setup.transmission(name, medium)?;
        let scheme = Scheme::new(self.setup.directions, self.setup.weights);
        let scattering = Scattering::new(&scheme, &transmission);
        let outcome =
            sweep(&scattering, &settings, &Watch { name, host }).map_err(|source| match source {
                LtgError::Interrupted { .. } => RunError::Interrupted,
                source => failed(source),
            })?;
        Ok(Outcome { outcome, surfaces: medium.scene().map(|scene| scene.layout.surfaces.clone()) })
    }
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

impl Outcome {
    pub(crate) const fn volume(&self) -> &LtgVolume {
        &self.outcome.volume
    }

    /// A scalar of the gradient where it is a result.
    pub(crate) fn where_result(&self, scalar: &Field<f64>) -> Field<f64> {
        where_result(scalar, self.surfaces.as_ref())
    }

    pub(crate) fn work(&self) -> Vec<(&'static str, u64)> {
        let work = &self.outcome.work;
        vec![
            ("sources", work.sources),
            ("steps of all sources", work.iterations_total),
            ("most steps of a source", work.iterations_max),
            ("cell updates", work.cell_updates),
        ]
    }

    pub(crate) fn digest(&self) -> GradientDigest {
        let (volume, work) = (self.volume(), &self.outcome.work);
        let values = volume.slices().iter().flat_map(|&t| {
            inner_cells(volume.grid()).filter_map(move |c| volume.value(c, t)).collect::<Vec<_>>()
        });
        GradientDigest {
            directions: volume.directions().count(),
            slices: volume.slices().len(),
            sources: work.sources,
            iterations_total: work.iterations_total,
            iterations_max: work.iterations_max,
            cell_updates: work.cell_updates,
            limited: self.outcome.limited,
            mean: rounded(volume.values().iter().sum::<f64>() / volume.values().len().max(1) as f64),
            quantiles: quantiles(values.collect()),
        }
    }

    /// The volume as image data.
    pub(crate) fn data(
        &self,
        plan: &Plan,
        name: &str,
        command: &str,
        media: &Media,
    ) -> Result<DataFile, IoError> {
        let own = json!({ "omega_step": plan.omega_step, "slices": plan.slices });
        let story = plan.setup.story(command, media, own);
        let image = image_from_ltg(self.volume(), &PlaneGeometry::UNPLACED, &story);
        Ok(DataFile { name: format!("{name}.vti"), bytes: vti::write(&image)? })
    }
}
