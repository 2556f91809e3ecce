//! Light from some cells.

use crate::form::{
    Chosen, DirectionCount, EngineChoice, LightSource, NormalizationRule, Placed, Scope, Stop,
    TotalAnisotropyRule,
};
use crate::host::Host;
use crate::ids::MediumId;
use crate::lights::{LightFault, lights_of};
use crate::media::Media;
use crate::numerics::light::energy_radius;
use crate::runs::digest::{LightDigest, quantiles, rounded};
use crate::runs::error::RunError;
use crate::runs::setup::{RunResolver, Setup};
use crate::scene::{PreparedScene, light_fault};
use serde::Deserialize;
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use tigereye_core::{Cell, Field, LightDistribution, StopReason, Surface, TransmissionField, Work};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{IoError, ScalarType, image_from_light, vti};
use tigereye_report::DataFile;
use tigereye_transport::{Problem, ScatteringRule, SharedWeights, StepView, StoppingRule, TransportError};
use tigereye_views::Reel;
use tigereye_views::total_anisotropy::ThinCells;

/// Propagation of light from one or more cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Light {
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
    /// How a cell scatters light that arrives from several sides.
    #[serde(default)]
    scattering: Chosen<ScatteringRule>,
    /// The lights; by default those of the scene.
    #[serde(default)]
    lights: Vec<LightSource>,
    /// When the propagation ends.
    #[serde(default)]
    stop: Stop,
    /// The engine that computes it.
    #[serde(default)]
    engine: EngineChoice,
    /// Steps whose distribution is kept in addition to the last one and those that figures and checks use; 0 is the
    /// state before the first step.
    #[serde(default)]
    frames: Vec<usize>,
    /// When it runs.
    #[serde(default)]
    pub(crate) scope: Scope,
}

fn yes() -> bool {
    true
}

/// A propagation, ready to start.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) setup: Setup,
    pub(crate) lights: Vec<tigereye_transport::Light>,
    outlined: bool,
    engine: EngineChoice,
    /// What is kept of its steps.
    pub(crate) kept: Kept,
}

/// What figures, tables and checks need of the steps of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Kept {
    /// Steps whose distribution is kept.
    pub(crate) frames: BTreeSet<usize>,
    /// Whether the energy's radius is kept for every step.
    pub(crate) radii: bool,
    /// Every how many steps energies are kept for an animation; `None`: never.
    pub(crate) reel_every: Option<usize>,
}

impl Kept {
    /// Keeps what another needs, too. An animation finds its frames where the steps between those that are kept divide
    /// its own.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.frames.extend(&other.frames);
        self.radii |= other.radii;
        self.reel_every = match (self.reel_every, other.reel_every) {
            (Some(a), Some(b)) => Some(common_divisor(a, b)),
            (a, b) => a.or(b),
        };
    }
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

impl Light {
    pub(crate) fn resolve(&self, run: &mut RunResolver<'_, '_>) -> Option<Plan> {
        let setup = run.setup(
            &self.field,
            self.directions,
            (self.normalization, self.total_anisotropy),
            self.weights,
            self.scattering,
            self.stop,
        )?;
        let medium = run.media.medium(setup.medium);
        let lights = match medium.scene() {
            Some(scene) if self.lights.is_empty() => {
                scene.lights_in(setup.directions).map_err(|faults| run.faults.extend(faults))
            }
            _ => lights_of(&self.lights, medium.grid(), setup.directions).map_err(|faults| {
                for LightFault { problem, place, .. } in faults {
                    run.fault_at(place, &format!(": {problem}"));
                }
            }),
        };
        let lights = lights.ok()?;
        if lights.is_empty() {
            run.fault(&format!(": {}", TransportError::NoLight));
            return None;
        }
        let in_wall = |scene: &PreparedScene| lights.iter().find_map(|l| light_fault(&scene.layout, l.cell));
        if let Some(problem) = medium.scene().and_then(in_wall) {
            run.fault(&format!(": {problem}"));
            return None;
        }
        if let StoppingRule::Steps(n) = setup.stopping.rule
            && let Some(&late) = self.frames.iter().filter(|&&f| f > n).min()
        {
            run.fault(&format!(" keeps step {late} but ends after {n} steps"));
        }
        let kept = Kept { frames: self.frames.iter().copied().collect(), ..Kept::default() };
        Some(Plan { setup, lights, outlined: self.outlined, engine: self.engine, kept })
    }
}

/// What a propagation leaves for figures and checks.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) transmission: TransmissionField,
    pub(crate) sources: Vec<Cell>,
    /// What each light emits, W/rad.
    pub(crate) emitted: Vec<(Cell, Vec<f64>)>,
    pub(crate) last: LightDistribution,
    pub(crate) frames: BTreeMap<usize, LightDistribution>,
    /// Energy in the grid before the first step and after each, W.
    pub(crate) energies: Vec<f64>,
    /// Mean and standard deviation of the energy's distance from the centre, after each step (index 0: before the
    /// first); empty unless asked for.
    pub(crate) radii: Vec<(f64, f64)>,
    /// Steps for an animation, where one is asked for.
    pub(crate) reel: Option<Reel>,
    pub(crate) stop: StopReason,
    pub(crate) work: Work,
    /// What the cells are, in a scene.
    pub(crate) surfaces: Option<Field<Option<Surface>>>,
    /// The totally anisotropic cells of a field.
    pub(crate) thin: Option<ThinCells>,
    /// Cells without a tensor.
    pub(crate) masked: Vec<Cell>,
    /// Cells that pass light on, in a scene.
    pub(crate) open: Option<Field<bool>>,
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
        let problem = Problem {
            scheme: &scheme,
            transmission: &transmission,
            lights: &self.lights,
            stopping: self.setup.stopping,
        };
        let kept = &self.kept;
        let start = problem.before_first_step();
        let mut frames = BTreeMap::new();
        let mut energies = vec![start.total_energy()];
        let mut radii = if kept.radii { vec![energy_radius(&start.energy())] } else { Vec::new() };
        let mut reel = kept.reel_every.map(|every| Reel::new(medium.grid().cells(), every));
        if let Some(reel) = &mut reel {
            reel.add(|| start.energy());
        }
        if kept.frames.contains(&0) {
            frames.insert(0, start);
        }
        let mut interrupted = false;
        let mut observe = |view: &dyn StepView| {
            energies.push(view.energy());
            if kept.radii {
                radii.push(energy_radius(&view.distribution().energy()));
            }
            if let Some(reel) = &mut reel {
                reel.add(|| view.energies());
            }
            if kept.frames.contains(&view.step()) {
                frames.insert(view.step(), view.distribution());
            }
            if view.step().is_multiple_of(64) && host.progress(name, view.step() as u64, 0).is_break() {
                interrupted = true;
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        };
        let engine = self.engine.engine();
        // Where nobody looks at the steps, a stationary state may be solved for.
        let outcome = if self.setup.scattering == ScatteringRule::Linear && *kept == Kept::default() {
            engine.propagate(&problem)
        } else {
            engine.propagate_observed(&problem, &mut observe)
        };
        let outcome = outcome.map_err(|source| RunError::Propagation { run: name.to_owned(), source })?;
        if energies.len() == 1 {
            energies.push(outcome.distribution.total_energy());
        }
        if interrupted {
            return Err(RunError::Interrupted);
        }
        let scene = medium.scene();
        Ok(Outcome {
            sources: self.lights.iter().map(|l| l.cell).collect(),
            emitted: self
                .lights
                .iter()
                .map(|l| (l.cell, l.initial_profile(self.setup.directions).samples().to_vec()))
                .collect(),
            last: outcome.distribution,
            frames,
            energies,
            radii,
            reel,
            stop: outcome.stop,
            work: outcome.work,
            transmission,
            surfaces: scene.map(|scene| scene.layout.surfaces.clone()),
            thin: self.setup.thin_cells(medium).filter(|_| self.outlined),
            masked: medium.masked(),
            open: scene.map(PreparedScene::open),
        })
    }
}

impl Outcome {
    pub(crate) fn work(&self) -> Vec<(&'static str, u64)> {
        vec![("steps", self.work.steps as u64), ("cell updates", self.work.cell_updates)]
    }

    pub(crate) fn digest(&self) -> LightDigest {
        LightDigest {
            directions: self.last.directions().count(),
            steps: self.work.steps,
            stop: format!("{:?}", self.stop),
            cell_updates: self.work.cell_updates,
            total_energy: rounded(self.last.total_energy()),
            energy_quantiles: quantiles(self.last.energy().values().to_vec()),
        }
    }

    /// The last distribution as image data.
    pub(crate) fn data(
        &self,
        plan: &Plan,
        name: &str,
        command: &str,
        media: &Media,
    ) -> Result<DataFile, IoError> {
        let lights: Vec<_> = plan.lights.iter().map(|l| (l.cell.x, l.cell.y)).collect();
        let own = json!({ "lights": lights, "engine": format!("{:?}", plan.engine) });
        let story = plan.setup.story(command, media, own);
        let mut image = image_from_light(&self.last, &PlaneGeometry::UNPLACED, &story);
        // For the eye: the profiles of all cells are most of what a folder of results holds.
        image.point_arrays.iter_mut().for_each(|array| array.scalar = ScalarType::Float32);
        Ok(DataFile { name: format!("{name}.vti"), bytes: vti::write(&image)? })
    }
}
