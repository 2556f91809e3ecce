//! The light transport gradient of a field.

use crate::form::{
    Chosen, DirectionCount, Finite, NormalizationRule, OmegaStep, Placed, Scope, Stop, TotalAnisotropyRule,
};
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
use tigereye_core::{Cell, Field, LtgVolume, Surface, SweepWork};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{IoError, image_from_ltg, vti};
use tigereye_ltg::{
    FEWEST_SKETCHES, LtgError, LtgOutcome, LtgSettings, MOST_SKETCHES, Precision, Shard, SketchObserver,
    SketchSettings, SketchSums, SketchedGradient, SweepObserver, check_fit, check_linear_fit,
    linear_sweep_part, omega_step_of_slices, omega_step_of_volumes, sweep,
};
use tigereye_report::DataFile;
use tigereye_transport::{LinearScattering, Scattering, ScatteringRule, SharedWeights, StoppingRule};
use tigereye_views::gradient::where_result;
use tigereye_views::total_anisotropy::ThinCells;

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
    /// Which tensors transmit along one axis only.
    #[serde(default)]
    total_anisotropy: TotalAnisotropyRule,
    /// Whether pictures outline the totally anisotropic cells.
    #[serde(default = "yes")]
    outlined: bool,
    /// Cone weights of the overlap.
    #[serde(default)]
    weights: Chosen<SharedWeights>,
    /// How a cell scatters light that arrives from several sides. With linear scattering, every pulse is solved to its
    /// stationary
    /// state.
    #[serde(default)]
    scattering: Chosen<ScatteringRule>,
    /// Number of sketches, 16 to 1048576, that a gradient with linear scattering is estimated from; exact by default.
    #[serde(default)]
    estimate: Option<u32>,
    /// Seed of the sketches.
    #[serde(default)]
    seed: u32,
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

fn yes() -> bool {
    true
}

/// A sweep, ready to start.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) setup: Setup,
    /// Half-width of the angular difference, samples.
    omega_step: usize,
    /// Sample indices; `None`: all.
    pub(crate) slices: Option<Vec<usize>>,
    /// Number of sketches of an estimate.
    pub(crate) estimate: Option<u32>,
    seed: u32,
    outlined: bool,
}

impl Gradient {
    pub(crate) fn resolve(&self, run: &mut RunResolver<'_, '_>) -> Option<Plan> {
        let setup = run.setup(
            &self.field,
            self.directions,
            (self.normalization, self.total_anisotropy),
            self.weights,
            self.scattering,
            self.stop,
        )?;
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
        let is_linear = setup.scattering == ScatteringRule::Linear;
        if is_linear && !matches!(setup.stopping.rule, StoppingRule::Converged { .. }) {
            run.fault(
                ": gradients of linear scattering are those of the stationary state: expected no `stop`",
            );
            return None;
        }
        if let Some(sketches) = self.estimate {
            if !is_linear {
                run.fault(": only linear scattering can be estimated: expected `scattering: Linear`");
                return None;
            }
            if !(FEWEST_SKETCHES..=MOST_SKETCHES).contains(&sketches) {
                run.fault(&format!(": {sketches} sketches: expected {FEWEST_SKETCHES} to {MOST_SKETCHES}"));
                return None;
            }
        }
        let slices = self.slices_deg.is_some().then_some(slices);
        let (estimate, seed, outlined) = (self.estimate, self.seed, self.outlined);
        Some(Plan { setup, omega_step, slices, estimate, seed, outlined })
    }
}

/// A gradient with what is around it.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) outcome: LtgOutcome,
    /// The relative standard error of an estimate (root mean square over all values).
    pub(crate) relative_error: Option<f64>,
    /// What the cells are, in a scene.
    pub(crate) surfaces: Option<Field<Option<Surface>>>,
    /// The totally anisotropic cells of a field.
    pub(crate) thin: Option<ThinCells>,
    /// Cells without a tensor.
    pub(crate) masked: Vec<Cell>,
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
        let fits = match (self.setup.scattering, self.estimate) {
            (ScatteringRule::Joint, _) => check_fit(medium.grid(), self.setup.directions, walls, &settings),
            (ScatteringRule::Linear, None) => {
                check_linear_fit(medium.grid(), self.setup.directions, &settings)
            }
            (ScatteringRule::Linear, Some(_)) => Ok(()),
        };
        fits.map_err(failed)?;
        let transmission = self.setup.transmission(name, medium)?;
        let scheme = self.setup.scheme();
        let scattering = Scattering::new(&scheme, &transmission);
        let watch = Watch { name, host };
        let found = match self.setup.scattering {
            ScatteringRule::Joint => sweep(&scattering, &settings, &watch).map(|outcome| (outcome, None)),
            ScatteringRule::Linear => self.linear(&LinearScattering::new(&scattering), settings, &watch),
        };
        let (outcome, relative_error) = found.map_err(|source| match source {
            LtgError::Interrupted { .. } => RunError::Interrupted,
            source => failed(source),
        })?;
        let surfaces = medium.scene().map(|scene| scene.layout.surfaces.clone());
        let thin = self.setup.thin_cells(medium).filter(|_| self.outlined);
        Ok(Outcome { outcome, relative_error, surfaces, thin, masked: medium.masked() })
    }

    /// The gradient of linear scattering, exact or estimated.
    fn linear(
        &self,
        field: &LinearScattering<'_>,
        settings: LtgSettings,
        watch: &Watch<'_>,
    ) -> Result<(LtgOutcome, Option<f64>), LtgError> {
        let Some(sketches) = self.estimate else {
            let volume = linear_sweep_part(field, &settings, Shard::WHOLE, None, watch)?;
            return Ok((volume.into_outcome()?, None));
        };
        let LtgSettings { omega_step, slices, memory_bytes, level, .. } = settings;
        let settings =
            SketchSettings { sketches, seed: self.seed.into(), omega_step, slices, memory_bytes, level };
        let gradient = SketchedGradient::new(field, settings)?;
        let found = gradient.run(Shard::WHOLE, gradient.sums(), watch)?.estimate()?;
        let outcome = LtgOutcome { volume: found.volume, work: SweepWork::default(), limited: 0 };
        Ok((outcome, Some(found.relative_error)))
    }
}

impl SketchObserver for Watch<'_> {
    fn finished(&self, sums: &SketchSums) -> ControlFlow<()> {
        self.host.progress(self.name, sums.sketches().into(), sums.shape().sketches.into())
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
        let mut own = json!({ "omega_step": plan.omega_step, "slices": plan.slices });
        if plan.estimate.is_some() {
            own["estimate"] = json!(plan.estimate);
            own["seed"] = json!(plan.seed);
        }
        let story = plan.setup.story(command, media, own);
        let image = image_from_ltg(self.volume(), &PlaneGeometry::UNPLACED, &story);
        Ok(DataFile { name: format!("{name}.vti"), bytes: vti::write(&image)? })
    }
}
