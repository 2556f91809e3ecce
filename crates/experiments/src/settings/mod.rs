//! Experiment files to settings: names looked up, fields made, nothing optional left. All problems are reported at once.

mod lights;
mod sources;

pub(crate) use lights::cell_of;
pub(crate) use lights::sample_of;
pub use lights::{LightFault, lights_of, profile_of, profile_of_expression};
pub(crate) use sources::beside;
pub use sources::{defined_plane, is_field_file, make_field, make_plane};

use crate::Medium;
use crate::evaluate::file_name;
use crate::host::Host;
use crate::places::{Known, Misplaced};
use crate::scene::{self, PreparedScene, is_scene_file, light_fault};
use crate::spec::{self, Experiment, Run, Scope, SourceText, SpecError};
use crate::uses::{self, RunKind};
use std::collections::BTreeMap;
use tigereye_core::{Below, Cell, CellShape, Directions, Field, Grid, Normalization, Tensor2};
use tigereye_lines::{Axes, Family, Major, OrderedAxes};
use tigereye_lines::{Following, usual_axes};
use tigereye_ltg::{omega_step_of_slices, omega_step_of_volumes};
use tigereye_report::shortened;
use tigereye_transport::{Light, SharedWeights, Stopping, StoppingRule, TransportError};

/// An experiment, ready to run.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Name: the file's without folder and ending.
    pub slug: String,
    /// The file, with panels and checks of other scopes removed.
    pub experiment: Experiment,
    /// Fields by name.
    pub fields: BTreeMap<String, Field<Tensor2>>,
    /// The shape of their cells, by the same names.
    pub cells: BTreeMap<String, CellShape>,
    /// Scenes by name; none has the name of a field.
    pub scenes: BTreeMap<String, PreparedScene>,
    /// Runs in order.
    pub runs: Vec<(String, RunSettings)>,
}

impl Settings {
    /// The field or scene of a name.
    #[must_use]
    pub fn medium(&self, name: &str) -> Option<Medium<'_>> {
        medium(&self.fields, &self.scenes, name)
    }

    /// The shape of a field's cells.
    #[must_use]
    pub fn cell(&self, field: &str) -> CellShape {
        self.cells.get(field).copied().unwrap_or_default()
    }
}

fn medium<'a>(
    fields: &'a BTreeMap<String, Field<Tensor2>>,
    scenes: &'a BTreeMap<String, PreparedScene>,
    name: &str,
) -> Option<Medium<'a>> {
    fields.get(name).map(Medium::Tensors).or_else(|| scenes.get(name).map(Medium::Scene))
}

/// A run, ready to start.
#[derive(Clone, Debug)]
pub enum RunSettings {
    /// Light from some cells.
    Light(LightSettings),
    /// A gradient.
    Gradient(GradientSettings),
    /// Pulses and their stationary states.
    Pulses(PulsesSettings),
    /// FTLE on tensor lines.
    Ftle(FtleSettings),
}

impl RunSettings {
    /// Name of the field or scene.
    #[must_use]
    pub fn field(&self) -> &str {
        match self {
            Self::Light(l) => &l.setup.field,
            Self::Gradient(g) => &g.setup.field,
            Self::Pulses(p) => &p.setup.field,
            Self::Ftle(f) => &f.field,
        }
    }
}

/// FTLE on tensor lines, ready to start.
#[derive(Clone, Debug)]
pub struct FtleSettings {
    /// Name of the field.
    pub field: String,
    /// The axes that lines follow, over which cells.
    pub following: Following,
    /// Which of the two.
    pub family: Family,
    /// Length of the lines to each side, in the unit of the smaller side of a cell.
    pub length: f64,
    /// Samples a cell along each side.
    pub samples: usize,
}

/// What runs of all kinds share.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Name of the field.
    pub field: String,
    /// Angular sampling.
    pub directions: Directions,
    /// How profiles are scaled.
    pub normalization: Normalization,
    /// Cone weights of the overlap.
    pub weights: SharedWeights,
    /// When each propagation ends.
    pub stopping: Stopping,
}

/// A propagation, ready to start.
#[derive(Clone, Debug)]
pub struct LightSettings {
    /// Field and scheme.
    pub setup: Setup,
    /// The lights.
    pub lights: Vec<Light>,
    /// What computes it.
    pub engine: spec::EngineChoice,
    /// Steps to keep, ascending.
    pub frames: Vec<usize>,
    /// Whether the energy's radius is wanted for every step.
    pub trace_radius: bool,
    /// Every how many steps energies are kept for an animation; `None`: never.
    pub reel_every: Option<usize>,
}

/// A sweep, ready to start.
#[derive(Clone, Debug)]
pub struct GradientSettings {
    /// Field and scheme.
    pub setup: Setup,
    /// Half-width of the angular difference, samples.
    pub omega_step: usize,
    /// Sample indices; `None`: all.
    pub slices: Option<Vec<usize>>,
}

/// Pulses, ready to start.
#[derive(Clone, Debug)]
pub struct PulsesSettings {
    /// Field and scheme; its rule is the one compared with the stationary state.
    pub setup: Setup,
    /// Cell and sample of each pulse, in the order of the file: a cell's samples follow each other.
    pub pulses: Vec<(Cell, usize)>,
}

/// Resolves an experiment that was read from `text` in `file`.
///
/// # Errors
/// Every problem found, in the order of the file's sections.
pub fn resolve(
    file: &str,
    text: &str,
    experiment: Experiment,
    full: bool,
    host: &dyn Host,
) -> Result<Settings, Vec<SpecError>> {
    let slug = slug_of(file);
    let mut resolver =
        Resolver { file, source: SourceText::new(text), cells: BTreeMap::new(), problems: Vec::new() };
    let mut experiment = experiment;
    let mut fields = BTreeMap::new();
    for (name, source) in experiment.fields.iter() {
        match make_plane(source, host) {
            Ok((plane, _)) => {
                resolver.cells.insert(name.to_owned(), CellShape::of(plane.geometry.spacing()));
                fields.insert(name.to_owned(), plane.field);
            }
            Err(problem) => resolver.fault_at(&["fields:"], name, &format!("field \"{name}\": {problem}")),
        }
    }
    let mut scenes = BTreeMap::new();
    for (name, path) in experiment.scenes.iter() {
        if experiment.fields.get(name).is_some() {
            resolver.fault_at(
                &["scenes:"],
                name,
                &format!("\"{name}\" is the name of a field and of a scene"),
            );
        }
        if let Some(scene) = resolver.scene(path, host) {
            scenes.insert(name.to_owned(), scene);
        }
    }
    let mut runs = Vec::new();
    for (name, run) in experiment.runs.iter() {
        let medium_of = |name: &str| medium(&fields, &scenes, name);
        if let Some(settings) = resolver.run(&experiment, name, run, &medium_of) {
            runs.push((name.to_owned(), settings));
        }
    }
    resolver.references(&experiment);
    resolver.places(&experiment, &fields, &scenes, &runs);
    runs.retain(|(name, _)| full || experiment.runs.get(name).map(scope_of) == Some(Scope::Always));
    let runs_now: Vec<&str> = runs.iter().map(|(n, _)| n.as_str()).collect();
    if resolver.problems.is_empty() {
        for figure in &mut experiment.figures {
            figure.panels.retain(|p| uses::of_panel(p).iter().all(|(r, _)| runs_now.contains(r)));
            figure.animation = figure.animation.take().filter(|a| runs_now.contains(&a.run.as_str()));
        }
        experiment.figures.retain(|f| !f.panels.is_empty());
        experiment
            .checks
            .retain(|c| uses::of_quantity(&c.quantity).iter().all(|(r, _)| runs_now.contains(r)));
        for table in &mut experiment.tables {
            uses::keep_rows(table, &runs_now);
        }
        experiment.tables.retain(|t| !uses::is_empty(t));
        Ok(Settings { slug, experiment, fields, cells: resolver.cells, scenes, runs })
    } else {
        Err(resolver.problems)
    }
}

/// Name of an experiment: its file's without folder and ending.
#[must_use]
pub fn slug_of(file: &str) -> String {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.strip_suffix(".ron").unwrap_or(name).to_owned()
}

/// A figure, table or check that mentions something.
#[derive(Clone, Copy)]
struct User<'a> {
    kind: &'static str,
    name: &'a str,
}

const fn scope_of(run: &Run) -> Scope {
    match run {
        Run::Light { scope, .. }
        | Run::Gradient { scope, .. }
        | Run::Pulses { scope, .. }
        | Run::Ftle { scope, .. } => *scope,
    }
}

struct Resolver<'a> {
    file: &'a str,
    source: SourceText<'a>,
    /// The shape of the cells of every field.
    cells: BTreeMap<String, CellShape>,
    problems: Vec<SpecError>,
}

impl Resolver<'_> {
    /// Reports a problem at the first `"name"` behind the anchors, each looked for behind the one before.
    fn fault_at(&mut self, anchors: &[&str], name: &str, problem: &str) {
        let (line, column) = self.source.place_after(anchors, &format!("\"{name}\""));
        let problem = shortened(problem);
        self.problems.push(SpecError { file: self.file.to_owned(), line, column, problem });
    }

    /// Reports a problem of a run.
    fn fault(&mut self, run: &str, problem: String) {
        self.fault_at(&["runs:"], run, &problem);
    }

    /// The scene of a file.
    fn scene(&mut self, path: &str, host: &dyn Host) -> Option<PreparedScene> {
        if !is_scene_file(path) {
            self.fault_at(&["scenes:"], path, &format!("{path}: expected a file NAME{}", scene::ENDING));
            return None;
        }
        let text = match host.read(path).map(String::from_utf8) {
            Ok(Ok(text)) => text,
            Ok(Err(_)) => {
                self.fault_at(&["scenes:"], path, &format!("{path}: expected UTF-8 text"));
                return None;
            }
            Err(problem) => {
                self.fault_at(&["scenes:"], path, &problem);
                return None;
            }
        };
        match scene::prepare(path, &text, host) {
            Ok(scene) => {
                scene.remarks().iter().for_each(|words| host.remark(&format!("{path}: {words}")));
                Some(scene)
            }
            Err(problems) => {
                self.problems.extend(problems);
                None
            }
        }
    }

    fn run<'b>(
        &mut self,
        experiment: &Experiment,
        name: &str,
        run: &Run,
        medium_of: &dyn Fn(&str) -> Option<Medium<'b>>,
    ) -> Option<RunSettings> {
        let field_name = match run {
            Run::Light { field, .. }
            | Run::Gradient { field, .. }
            | Run::Pulses { field, .. }
            | Run::Ftle { field, .. } => field,
        };
        if experiment.fields.get(field_name).is_none() && experiment.scenes.get(field_name).is_none() {
            let known = [experiment.fields.names(), experiment.scenes.names()];
            let known =
                known.iter().filter(|names| !names.is_empty()).cloned().collect::<Vec<_>>().join(", ");
            self.fault(
                field_name,
                format!("run \"{name}\" names a field \"{field_name}\": expected one of {known}"),
            );
            return None;
        }
        let medium = medium_of(field_name)?;
        if let (Medium::Scene(_), Some(problem)) = (medium, unfit_for_scenes(run)) {
            self.fault(name, format!("run \"{name}\": {problem}"));
            return None;
        }
        let setup = |directions: spec::DirectionCount, normalization, weights, stop| Setup {
            field: field_name.clone(),
            directions: directions.0,
            normalization: normalization_of(normalization),
            weights: match weights {
                spec::Weights::Thesis => SharedWeights::Thesis,
                spec::Weights::Geometric => SharedWeights::Geometric,
            },
            stopping: stopping_of(stop),
        };
        match run {
            Run::Light { directions, normalization, weights, stop, lights, engine, frames, .. } => {
                let setup = setup(*directions, *normalization, *weights, *stop);
                self.light(name, setup, medium, lights, *engine, frames, experiment)
            }
            Run::Gradient { directions, normalization, weights, stop, omega_step, slices_deg, .. } => {
                let setup = setup(*directions, *normalization, *weights, *stop);
                self.gradient(name, setup, *omega_step, slices_deg.as_deref())
            }
            Run::Pulses { directions, normalization, weights, stop, cells, angles_deg, .. } => {
                let setup = setup(*directions, *normalization, *weights, *stop);
                self.pulses(name, setup, medium.grid(), cells, angles_deg)
            }
            Run::Ftle { axes, major, family, length, samples, .. } => {
                let field = medium.tensors()?;
                let axes = axes_of(*axes, *major, field);
                let cell = self.cells.get(field_name).copied().unwrap_or_default();
                let following = Following { axes, cell };
                let (field, family, length) = (field_name.clone(), family_of(*family), length.get());
                self.ftle(name, FtleSettings { field, following, family, length, samples: *samples })
            }
        }
    }

    fn ftle(&mut self, name: &str, settings: FtleSettings) -> Option<RunSettings> {
        let samples = settings.samples;
        if !(1..=MAX_SAMPLES_A_CELL).contains(&samples) {
            self.fault(
                name,
                format!("run \"{name}\": {samples} samples a cell: expected 1 to {MAX_SAMPLES_A_CELL}"),
            );
            return None;
        }
        Some(RunSettings::Ftle(settings))
    }

    #[expect(clippy::too_many_arguments, reason = "the parts of one variant of the file's Run")]
    fn light(
        &mut self,
        name: &str,
        setup: Setup,
        medium: Medium<'_>,
        sources: &[spec::LightSource],
        engine: spec::EngineChoice,
        frames: &[usize],
        experiment: &Experiment,
    ) -> Option<RunSettings> {
        let grid = medium.grid();
        let lights = match medium.scene() {
            Some(scene) if sources.is_empty() => {
                scene.lights_in(setup.directions).map_err(|faults| self.problems.extend(faults))
            }
            _ => lights_of(sources, grid, setup.directions).map_err(|faults| {
                for LightFault { problem, .. } in faults {
                    self.fault(name, format!("run \"{name}\": {problem}"));
                }
            }),
        };
        let lights = lights.ok()?;
        if lights.is_empty() {
            self.fault(name, format!("run \"{name}\": {}", TransportError::NoLight));
            return None;
        }
        let in_wall = |scene: &PreparedScene| lights.iter().find_map(|l| light_fault(&scene.layout, l.cell));
        if let Some(problem) = medium.scene().and_then(in_wall) {
            self.fault(name, format!("run \"{name}\": {problem}"));
            return None;
        }
        let mut frames = frames.to_vec();
        frames.sort_unstable();
        frames.dedup();
        if let StoppingRule::Steps(n) = setup.stopping.rule
            && let Some(&late) = frames.iter().find(|&&f| f > n)
        {
            self.fault(name, format!("run \"{name}\" keeps step {late} but ends after {n} steps"));
        }
        let trace_radius = uses::wants_radius(experiment, name);
        let reel_every = uses::wants_reel(experiment, name);
        Some(RunSettings::Light(LightSettings { setup, lights, engine, frames, trace_radius, reel_every }))
    }

    fn gradient(
        &mut self,
        name: &str,
        setup: Setup,
        omega_step: spec::OmegaStep,
        slices_deg: Option<&[spec::Finite]>,
    ) -> Option<RunSettings> {
        let s = setup.directions.count();
        let omega_step = match omega_step {
            spec::OmegaStep::Volumes => omega_step_of_volumes(setup.directions),
            spec::OmegaStep::Slices => omega_step_of_slices(setup.directions),
            spec::OmegaStep::Samples(k) => k,
        };
        if !(1..=s / 2).contains(&omega_step) {
            self.fault(name, format!("run \"{name}\": angular step {omega_step}: expected 1 to {}", s / 2));
            return None;
        }
        let mut slices = Vec::new();
        for deg in slices_deg.unwrap_or_default() {
            match sample_of(deg.get(), setup.directions) {
                Ok(t) => slices.push(t),
                Err(problem) => self.fault(name, format!("run \"{name}\": {problem}")),
            }
        }
        if setup.stopping.rule == StoppingRule::Steps(0) {
            self.fault(name, format!("run \"{name}\": a gradient of 0 steps: expected 1 or more"));
            return None;
        }
        let slices = slices_deg.is_some().then_some(slices);
        Some(RunSettings::Gradient(GradientSettings { setup, omega_step, slices }))
    }

    fn pulses(
        &mut self,
        name: &str,
        setup: Setup,
        grid: Grid,
        cells: &[(usize, usize)],
        angles_deg: &[spec::Finite],
    ) -> Option<RunSettings> {
        let before = self.problems.len();
        let mut samples = Vec::new();
        for deg in angles_deg {
            match sample_of(deg.get(), setup.directions) {
                Ok(t) if samples.contains(&t) => {
                    self.fault(name, format!("run \"{name}\": {} degrees stand twice", deg.get()));
                }
                Ok(t) => samples.push(t),
                Err(problem) => self.fault(name, format!("run \"{name}\": {problem}")),
            }
        }
        for (i, &(x, y)) in cells.iter().enumerate() {
            if !grid.contains(Cell::new(x, y)) {
                let (w, h) = (grid.width(), grid.height());
                self.fault(
                    name,
                    format!("run \"{name}\": cell ({x}, {y}) lies outside of the {w} x {h} cells"),
                );
            } else if cells[..i].contains(&(x, y)) {
                self.fault(name, format!("run \"{name}\": cell ({x}, {y}) stands twice"));
            }
        }
        if cells.is_empty() || angles_deg.is_empty() {
            self.fault(name, format!("run \"{name}\" has no pulse: expected cells and angles"));
        }
        let of_cell = |&(x, y): &(usize, usize)| samples.iter().map(move |&t| (Cell::new(x, y), t));
        let pulses = cells.iter().flat_map(of_cell).collect();
        (self.problems.len() == before).then_some(RunSettings::Pulses(PulsesSettings { setup, pulses }))
    }

    /// Reports a problem with the `word` that a figure, table or check mentions.
    fn fault_of(&mut self, user: User<'_>, word: &str, problem: &str) {
        let problem = format!("{} \"{}\" {problem}", user.kind, user.name);
        self.fault_at(&[&format!("{}s:", user.kind), &format!("\"{}\"", user.name)], word, &problem);
    }

    /// Reports something a figure or check mentions and that does not exist.
    fn misplaced(&mut self, user: User<'_>, what: &Misplaced) {
        let anchors = [format!("{}s:", user.kind), format!("\"{}\"", user.name)];
        let (line, column) = self.source.place_after(&[&anchors[0], &anchors[1]], &what.word);
        let problem = shortened(&format!("{} \"{}\": {}", user.kind, user.name, what.problem));
        self.problems.push(SpecError { file: self.file.to_owned(), line, column, problem });
    }

    /// Checks every name that figures, tables and checks mention.
    fn references(&mut self, experiment: &Experiment) {
        let mut runs: Vec<(User, &str, RunKind)> = Vec::new();
        let mut fields: Vec<(User, &str)> = Vec::new();
        for figure in &experiment.figures {
            let user = User { kind: "figure", name: &figure.name };
            for panel in &figure.panels {
                runs.extend(uses::of_panel(panel).into_iter().map(|(run, kind)| (user, run, kind)));
                fields.extend(uses::fields_of_panel(panel).into_iter().map(|f| (user, f)));
            }
            runs.extend(figure.animation.iter().map(|a| (user, a.run.as_str(), RunKind::Light)));
        }
        for check in &experiment.checks {
            let user = User { kind: "check", name: &check.name };
            runs.extend(uses::of_quantity(&check.quantity).into_iter().map(|(run, kind)| (user, run, kind)));
            fields.extend(uses::field_of_quantity(&check.quantity).map(|f| (user, f)));
        }
        for table in &experiment.tables {
            let user = User { kind: "table", name: &table.title };
            runs.extend(uses::of_table(table).into_iter().map(|(run, kind)| (user, run, kind)));
            self.runtimes(experiment, user, table);
        }
        for (user, run, kind) in runs {
            let found = experiment.runs.get(run).map(RunKind::of);
            if found.is_none() {
                let known = experiment.runs.names();
                self.fault_of(user, run, &format!("names a run \"{run}\": expected one of {known}"));
            } else if found != Some(kind) {
                self.fault_of(user, run, &format!("takes \"{run}\" for a {kind:?} run, which it is not"));
            }
        }
        for (user, field) in fields.into_iter().filter(|(_, f)| experiment.fields.get(f).is_none()) {
            let known = experiment.fields.names();
            self.fault_of(user, field, &format!("names a field \"{field}\": expected one of {known}"));
        }
        self.figure_names(experiment);
    }

    /// Checks the runs whose seconds a table shows: of any kind.
    fn runtimes(&mut self, experiment: &Experiment, user: User<'_>, table: &spec::Table) {
        let spec::TableRows::Runtimes { rows } = &table.rows else { return };
        let named = rows.iter().filter_map(|r| r.run.as_deref());
        for run in named.filter(|r| experiment.runs.get(r).is_none()) {
            let known = experiment.runs.names();
            self.fault_of(user, run, &format!("names a run \"{run}\": expected one of {known}"));
        }
    }

    /// Checks every step, slice and cell that figures and checks mention.
    fn places(
        &mut self,
        experiment: &Experiment,
        fields: &BTreeMap<String, Field<Tensor2>>,
        scenes: &BTreeMap<String, PreparedScene>,
        runs: &[(String, RunSettings)],
    ) {
        let known = Known {
            run: &|name| runs.iter().find(|(n, _)| n == name).map(|(_, r)| r),
            field: &|name| fields.get(name),
            medium: &|name| medium(fields, scenes, name),
        };
        for figure in &experiment.figures {
            let user = User { kind: "figure", name: &figure.name };
            for problem in figure.panels.iter().filter_map(|p| known.fault_of_panel(p)) {
                self.misplaced(user, &problem);
            }
        }
        for check in &experiment.checks {
            let user = User { kind: "check", name: &check.name };
            if let Some(problem) = known.fault_of_quantity(&check.quantity) {
                self.misplaced(user, &problem);
            }
        }
    }

    fn figure_names(&mut self, experiment: &Experiment) {
        let mut files: Vec<(String, &str)> = experiment.runs.iter().map(|(n, _)| (file_name(n), n)).collect();
        files.sort_unstable();
        if let Some(w) = files.windows(2).find(|w| w[0].0 == w[1].0) {
            self.fault(
                w[1].1,
                format!("runs \"{}\" and \"{}\" would share the file {}.vti", w[0].1, w[1].1, w[0].0),
            );
        }
        let mut names: Vec<&str> = experiment.figures.iter().map(|f| f.name.as_str()).collect();
        names.sort_unstable();
        if let Some(twice) = names.windows(2).find(|w| w[0] == w[1]) {
            self.fault_at(&["figures:"], twice[0], &format!("two figures are called \"{}\"", twice[0]));
        }
        for name in names {
            if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_') {
                self.fault(
                    name,
                    format!("figure \"{name}\": a name is a file's: expected letters, digits, - and _"),
                );
            }
        }
    }
}

/// Why a run cannot take a scene.
fn unfit_for_scenes(run: &Run) -> Option<&'static str> {
    match run {
        Run::Ftle { .. } => Some("a scene has no tensors: expected the name of a field"),
        Run::Light { normalization, .. }
        | Run::Gradient { normalization, .. }
        | Run::Pulses { normalization, .. } => (*normalization != spec::NormalizationRule::default())
            .then_some("a scene's crystals have a normalisation of their own, in the scene's file"),
    }
}

/// Most samples a cell along each side: more show nothing.
const MAX_SAMPLES_A_CELL: usize = 16;

/// The axes of a choice, in the order chosen or their usual one.
pub(crate) fn axes_of(
    choice: spec::AxesChoice,
    major: Option<spec::MajorChoice>,
    field: &Field<Tensor2>,
) -> OrderedAxes {
    let axes = match choice {
        spec::AxesChoice::Usual => usual_axes(field),
        spec::AxesChoice::Half => Axes::HalfAxes,
        spec::AxesChoice::Eigen => Axes::Eigenvectors,
        spec::AxesChoice::Dual => Axes::DualEigenvectors,
    };
    match major {
        None => axes.into(),
        Some(spec::MajorChoice::Value) => axes.by(Major::Value),
        Some(spec::MajorChoice::Magnitude) => axes.by(Major::Magnitude),
    }
}

/// The family of a choice.
pub(crate) const fn family_of(choice: spec::FamilyChoice) -> Family {
    match choice {
        spec::FamilyChoice::Major => Family::Major,
        spec::FamilyChoice::Minor => Family::Minor,
    }
}

pub(crate) fn normalization_of(rule: spec::NormalizationRule) -> Normalization {
    use spec::NormalizationRule as Rule;
    match rule {
        Rule::Local => Normalization::Local,
        Rule::Global => Normalization::Global,
        Rule::LocalAbove(f) => Normalization::LocalAbove { fraction: f.get(), below: Below::Absorb },
        Rule::LocalAboveGlobal(f) => Normalization::LocalAbove { fraction: f.get(), below: Below::Global },
    }
}

fn stopping_of(stop: spec::Stop) -> Stopping {
    match stop {
        spec::Stop::FluxChange { threshold, max_iterations } => {
            Stopping { rule: StoppingRule::FluxChange { threshold: threshold.get() }, max_iterations }
        }
        spec::Stop::DistributionChange { threshold, max_iterations } => {
            Stopping { rule: StoppingRule::DistributionChange { threshold: threshold.get() }, max_iterations }
        }
        spec::Stop::Stationary => Stopping::STATIONARY,
        spec::Stop::Steps(n) => Stopping::steps(n),
    }
}
