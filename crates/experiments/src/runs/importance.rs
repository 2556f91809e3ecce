//! Where the light at a receiver comes from.

use crate::form::{
    Chosen, DirectionCount, NormalizationRule, Placed, ProfileShape, Scope, Stop, TotalAnisotropyRule,
};
use crate::host::Host;
use crate::ids::MediumId;
use crate::lights::profile_of;
use crate::media::Media;
use crate::runs::digest::{ImportanceDigest, quantiles};
use crate::runs::error::RunError;
use crate::runs::setup::{RunResolver, Setup};
use crate::scene::light_fault;
use serde::Deserialize;
use serde_json::json;
use tigereye_core::{Cell, Field, LightDistribution, Surface, Work};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{IoError, image_from_light, vti};
use tigereye_report::DataFile;
use tigereye_transport::{LinearScattering, Scattering, ScatteringRule, SharedWeights, Stopping, importance};
use tigereye_views::total_anisotropy::ThinCells;

/// How much of what each cell emits in each direction arrives at a receiver, with linear scattering: one solution of
/// the adjoint problem.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Importance {
    /// Name of the field.
    field: Placed<String>,
    /// Column and row of the receiver, (0, 0) at the upper left.
    receiver: Placed<(usize, usize)>,
    /// Its sensitivity by direction; uniform by default.
    #[serde(default)]
    sensitivity: Option<Placed<ProfileShape>>,
    /// Angular samples S, a multiple of 8.
    #[serde(default)]
    directions: DirectionCount,
    /// How profiles are scaled.
    #[serde(default)]
    normalization: NormalizationRule,
    /// Which tensors transmit along one axis only.
    #[serde(default)]
    total_anisotropy: TotalAnisotropyRule,
    /// Cone weights of the overlap.
    #[serde(default)]
    weights: Chosen<SharedWeights>,
    /// When it runs.
    #[serde(default)]
    pub(crate) scope: Scope,
}

/// An importance, ready to be solved for.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) setup: Setup,
    receiver: Cell,
    sensitivity: Vec<f64>,
}

impl Importance {
    pub(crate) fn resolve(&self, run: &mut RunResolver<'_, '_>) -> Option<Plan> {
        let linear = Chosen(ScatteringRule::Linear);
        let setup = run.setup(
            &self.field,
            self.directions,
            (self.normalization, self.total_anisotropy),
            self.weights,
            linear,
            Stop::Stationary,
        )?;
        let medium = run.media.medium(setup.medium);
        let (x, y) = *self.receiver;
        let receiver = Cell::new(x, y);
        let grid = medium.grid();
        if !grid.contains(receiver) {
            run.fault(&format!(
                ": the receiver ({x}, {y}) lies outside the field of {} x {} cells",
                grid.width(),
                grid.height()
            ));
            return None;
        }
        if let Some(problem) = medium.scene().and_then(|scene| light_fault(&scene.layout, receiver)) {
            run.fault(&format!(": {problem}"));
            return None;
        }
        let usual = ProfileShape::default();
        let shape = self.sensitivity.as_ref().map_or(&usual, |shape| &**shape);
        match profile_of(shape, setup.directions) {
            Ok(profile) => Some(Plan { setup, receiver, sensitivity: profile.clipped().samples().to_vec() }),
            Err(fault) => {
                run.fault_at(fault.place, &format!(": {fault}"));
                None
            }
        }
    }
}

/// An importance with what is around it.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) receiver: Cell,
    pub(crate) sensitivity: Vec<f64>,
    /// The part of a flux emitted in a cell and direction that arrives.
    pub(crate) importance: LightDistribution,
    pub(crate) work: Work,
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
        _memory_bytes: u64,
        host: &dyn Host,
    ) -> Result<Outcome, RunError> {
        let medium = media.medium(self.setup.medium);
        let transmission = self.setup.transmission(name, medium)?;
        let scheme = self.setup.scheme();
        let scattering = Scattering::new(&scheme, &transmission);
        let field = LinearScattering::new(&scattering);
        let tolerance = Stopping::STATIONARY.rule.threshold();
        let mut interrupted = false;
        let watch = &mut |sweeps: usize, _| {
            let progress = host.progress(name, sweeps as u64, 0);
            interrupted |= progress.is_break();
            progress
        };
        let found = importance(&field, self.receiver, &self.sensitivity, tolerance, watch);
        if interrupted {
            return Err(RunError::Interrupted);
        }
        let (importance, work) =
            found.map_err(|source| RunError::Propagation { run: name.to_owned(), source })?;
        Ok(Outcome {
            receiver: self.receiver,
            sensitivity: self.sensitivity.clone(),
            importance,
            work,
            surfaces: medium.scene().map(|scene| scene.layout.surfaces.clone()),
            thin: self.setup.thin_cells(medium),
            masked: medium.masked(),
        })
    }
}

impl Outcome {
    pub(crate) fn work(&self) -> Vec<(&'static str, u64)> {
        vec![("sweeps", self.work.steps as u64), ("cell updates", self.work.cell_updates)]
    }

    pub(crate) fn digest(&self) -> ImportanceDigest {
        ImportanceDigest {
            directions: self.importance.directions().count(),
            sweeps: self.work.steps,
            quantiles: quantiles(self.importance.samples().to_vec()),
        }
    }

    /// The importance as image data.
    pub(crate) fn data(
        &self,
        plan: &Plan,
        name: &str,
        command: &str,
        media: &Media,
    ) -> Result<DataFile, IoError> {
        let own = json!({ "receiver": [self.receiver.x, self.receiver.y] });
        let story = plan.setup.story(command, media, own);
        let image = image_from_light(&self.importance, &PlaneGeometry::UNPLACED, &story);
        Ok(DataFile { name: format!("{name}.vti"), bytes: vti::write(&image)? })
    }
}
