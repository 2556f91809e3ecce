//! Experiment files to settings: names looked up, fields made, nothing optional left. All problems are reported at once.

use crate::Medium;
use crate::classical::usual_axes;
use crate::evaluate::file_name;
use crate::host::Host;
use crate::input::{self, Derivation, Derived, PlaneField, Reading};
use crate::places::{Known, Misplaced};
use crate::scene::{self, PreparedScene, is_scene_file, light_fault};
use crate::shortened;
use crate::spec::{
    self, DeriveRule, Experiment, FieldSource, Named, ProfileShape, Run, Scope, Sigma, SpecError,
};
use crate::uses::{self, RunKind};
use std::collections::BTreeMap;
use tigereye_core::{Below, Cell, Directions, Field, Grid, Normalization, PolarProfile, Tensor2};
use tigereye_fields::{Arguments, Expression, ExpressionField, Form, with_noise};
use tigereye_io::volume::{Crop, Frame, Plane, PlaneChoice, parse_slice};
use tigereye_lines::{Axes, Family};
use tigereye_ltg::{omega_step_of_slices, omega_step_of_volumes};
use tigereye_transport::{Light, SharedWeights, Stopping, StoppingRule, emitter};

/// An experiment, ready to run.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Name: the file's without folder and ending.
    pub slug: String,
    /// The file, with panels and checks of other scopes removed.
    pub experiment: Experiment,
    /// Fields by name.
    pub fields: BTreeMap<String, Field<Tensor2>>,
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
    /// The axes that lines follow.
    pub axes: Axes,
    /// Which of the two.
    pub family: Family,
    /// Length of the lines to each side, cells.
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
    let mut resolver = Resolver { file, text, problems: Vec::new() };
    let mut experiment = experiment;
    let mut fields = BTreeMap::new();
    for (name, source) in experiment.fields.iter() {
        match make_field(source, host) {
            Ok(field) => _ = fields.insert(name.to_owned(), field),
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
        Ok(Settings { slug, experiment, fields, scenes, runs })
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
    text: &'a str,
    problems: Vec<SpecError>,
}

impl Resolver<'_> {
    /// Reports a problem at the first `"name"` behind the anchors, each looked for behind the one before.
    fn fault_at(&mut self, anchors: &[&str], name: &str, problem: &str) {
        let (line, column) = spec::place_after(self.text, anchors, &format!("\"{name}\""));
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
            Run::Ftle { axes, family, length, samples, .. } => {
                self.ftle(name, (field_name, medium.tensors()?), *axes, *family, length.get(), *samples)
            }
        }
    }

    fn ftle(
        &mut self,
        name: &str,
        (field_name, field): (&str, &Field<Tensor2>),
        axes: spec::AxesChoice,
        family: spec::FamilyChoice,
        length: f64,
        samples: usize,
    ) -> Option<RunSettings> {
        if !(1..=MAX_SAMPLES_A_CELL).contains(&samples) {
            self.fault(
                name,
                format!("run \"{name}\": {samples} samples a cell: expected 1 to {MAX_SAMPLES_A_CELL}"),
            );
            return None;
        }
        let (axes, family) = (axes_of(axes, field), family_of(family));
        Some(RunSettings::Ftle(FtleSettings { field: field_name.to_owned(), axes, family, length, samples }))
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
        let sources = match medium.scene() {
            Some(scene) if sources.is_empty() => &scene.lights,
            _ => sources,
        };
        let (lights, faults) = lights_of(sources, grid, setup.directions);
        for problem in faults {
            self.fault(name, format!("run \"{name}\", {problem}"));
        }
        // A light without a profile has been reported.
        if lights.len() < sources.len() {
            return None;
        }
        if let Err(e) = tigereye_transport::check_lights(&lights, grid, setup.directions) {
            self.fault(name, format!("run \"{name}\": {e}"));
            return None;
        }
        let in_wall = |scene: &PreparedScene| lights.iter().find_map(|l| light_fault(&scene.built, l.cell));
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
        let (line, column) = spec::place_after(self.text, &[&anchors[0], &anchors[1]], &what.word);
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

/// The axes of a choice.
pub(crate) fn axes_of(choice: spec::AxesChoice, field: &Field<Tensor2>) -> Axes {
    match choice {
        spec::AxesChoice::Usual => usual_axes(field),
        spec::AxesChoice::Half => Axes::HalfAxes,
        spec::AxesChoice::Eigen => Axes::Eigenvectors,
        spec::AxesChoice::Dual => Axes::DualEigenvectors,
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

/// The sample at an angle, which must be one.
pub(crate) fn sample_of(degrees: f64, directions: Directions) -> Result<usize, String> {
    let t = directions.nearest(degrees);
    let off = (directions.angle_deg(t) - degrees).rem_euclid(360.0);
    if off.min(360.0 - off) < 1e-9 {
        Ok(t)
    } else {
        let step = 360.0 / directions.count() as f64;
        Err(format!(
            "{degrees} degrees is no sample of {}: expected a multiple of {step} degrees",
            directions.count()
        ))
    }
}

/// Lights with their profiles, and a sentence for each whose profile cannot be made. Lights without a cell stand in the centre.
#[must_use]
pub fn lights_of(
    sources: &[spec::LightSource],
    grid: Grid,
    directions: Directions,
) -> (Vec<Light>, Vec<String>) {
    let (mut lights, mut faults) = (Vec::new(), Vec::new());
    for source in sources {
        let cell = source.cell.map_or(grid.centre(), |(x, y)| Cell::new(x, y));
        match profile_of(&source.profile, directions) {
            Ok(profile) => lights.push(match source.emission {
                spec::EmissionKind::Continuous => Light::continuous(cell, profile),
                spec::EmissionKind::Impulse => Light::impulse(cell, profile),
            }),
            Err(problem) => faults.push(format!("light at ({}, {}): {problem}", cell.x, cell.y)),
        }
    }
    (lights, faults)
}

/// Samples of a light's profile.
///
/// # Errors
/// A sentence for an expression that cannot be read, or an angle that is no sample.
pub fn profile_of(shape: &ProfileShape, directions: Directions) -> Result<PolarProfile, String> {
    match shape {
        ProfileShape::Isotropic(i) => Ok(PolarProfile::constant(directions, i.get())),
        ProfileShape::Emitter { theta_deg, power, intensity } => {
            let theta = tigereye_core::math::radians(theta_deg.get());
            let unit = emitter(directions, theta, power.get());
            Ok(PolarProfile::from_fn(directions, |t| intensity.get() * unit.samples()[t]))
        }
        ProfileShape::Pulse { theta_deg } => {
            let sample = sample_of(theta_deg.get(), directions)?;
            Ok(PolarProfile::from_fn(
                directions,
                |t| if t == sample { directions.count() as f64 } else { 0.0 },
            ))
        }
        ProfileShape::Expression(text) => profile_of_expression(text, directions),
    }
}

/// Samples of an expression in `theta` (radians), negative values clipped.
///
/// # Errors
/// A sentence naming the place in the expression, or the sample that is not finite.
pub fn profile_of_expression(text: &str, directions: Directions) -> Result<PolarProfile, String> {
    let expression = Expression::parse(text, &["theta"]).map_err(|e| format!("`{text}`: {e}"))?;
    let samples = (0..directions.count()).map(|t| expression.eval(&[directions.angle_rad(t)])).collect();
    PolarProfile::from_samples(directions, samples)
        .map(PolarProfile::clipped)
        .map_err(|e| format!("`{text}`: {e}"))
}

/// The field of a source.
///
/// # Errors
/// A sentence saying what is wrong with it.
pub fn make_field(source: &FieldSource, host: &dyn Host) -> Result<Field<Tensor2>, String> {
    make_plane(source, host).map(|(plane, _)| plane.field)
}

/// The field of a source with where it lies and what was read, and the format of its data file, where it has one.
///
/// # Errors
/// A sentence saying what is wrong with it.
pub fn make_plane(
    source: &FieldSource,
    host: &dyn Host,
) -> Result<(PlaneField, Option<&'static str>), String> {
    let made = |field| {
        let story = vec!["made by a generator or formulas, row 0 on top, x right, y up".to_owned()];
        (PlaneField::new(field, story), None)
    };
    match source {
        FieldSource::Generator { name, parameters } => {
            let arguments = arguments_of(parameters)?;
            tigereye_fields::generate(name, &arguments).map(made).map_err(|e| e.to_string())
        }
        FieldSource::Axes { width, height, phi, s1, s2 } => {
            let form = Form::Axes { phi: phi.clone(), s1: s1.clone(), s2: s2.clone() };
            let field = ExpressionField { width: *width, height: *height, form }.build();
            field.map(made).map_err(|e| e.to_string())
        }
        FieldSource::Components { width, height, xx, xy, yx, yy } => {
            let form = Form::Components { xx: xx.clone(), xy: xy.clone(), yx: yx.clone(), yy: yy.clone() };
            let field = ExpressionField { width: *width, height: *height, form }.build();
            field.map(made).map_err(|e| e.to_string())
        }
        FieldSource::Noisy { of, share, seed } => {
            let (mut plane, kind) = make_plane(of, host)?;
            plane.field = with_noise(&plane.field, share.get(), *seed);
            plane.story.push(format!("noise of {} % of each tensor added", 100.0 * share.get()));
            Ok((plane, kind))
        }
        FieldSource::File { path, stride, .. } => {
            let fault = |e: &dyn std::fmt::Display| format!("{path}: {e}");
            let reading = reading_of(source).map_err(|e| fault(&e))?;
            let (mut plane, kind) = if is_field_file(path) {
                let (plane, kind) = plane_in_file(path, host)?;
                (defined_plane(plane, &reading).map_err(|e| fault(&e))?, kind)
            } else {
                let file = input::open(path, &reading, &mut |name| host.read(name)).map_err(|e| fault(&e))?;
                let plane = file.plane(&reading).map_err(|e| fault(&e))?;
                file.remarks()
                    .iter()
                    .chain(&plane.oblong())
                    .for_each(|words| host.remark(&format!("{path}: {words}")));
                (plane, Some(file.kind))
            };
            plane.field = strided(&plane.field, *stride).map_err(|e| fault(&e))?;
            plane.spacing = plane.spacing.map(|s| s * *stride as f64);
            Ok((plane, kind))
        }
    }
}

/// Whether a file's name says that it holds a [`spec::FieldFile`].
#[must_use]
pub fn is_field_file(name: &str) -> bool {
    input::format_of(name) == "ron"
}

/// The field that a file of its own defines.
fn plane_in_file(path: &str, host: &dyn Host) -> Result<(PlaneField, Option<&'static str>), String> {
    let text = String::from_utf8(host.read(path)?).map_err(|_| format!("{path}: expected UTF-8 text"))?;
    let mut file = spec::load_field(path, &text).map_err(|e| e.to_string())?;
    let mut source = &mut file.field;
    while let FieldSource::Noisy { of, .. } = source {
        source = of;
    }
    if let FieldSource::File { path: other, mask, .. } = source {
        // One might lead back to the first.
        if is_field_file(other) {
            return Err(format!(
                "{path}: its field is in {other}: expected a generator, formulas or a data file"
            ));
        }
        for name in std::iter::once(other).chain(mask) {
            *name = beside(path, name, host);
        }
    }
    make_plane(&file.field, host).map_err(|e| format!("{path}: {e}"))
}

/// What a file at `path` calls `name`: the file beside it, where there is one.
pub(crate) fn beside(path: &str, name: &str, host: &dyn Host) -> String {
    let beside = path.rfind(['/', '\\']).map(|folder| format!("{}{name}", &path[..=folder]));
    beside.filter(|path| host.has(path)).unwrap_or_else(|| name.to_owned())
}

/// A field that needs no reading, cropped and resampled.
///
/// # Errors
/// [`input::InputError::Needless`] for what only data files have, and as [`PlaneField::cropped`] and [`PlaneField::resampled`].
pub fn defined_plane(plane: PlaneField, reading: &Reading) -> Result<PlaneField, input::InputError> {
    let grid = plane.field.grid();
    let choice = reading.choice.resolve([grid.width(), grid.height(), 1])?;
    let of_files = [
        (choice.0 != Plane::Xy, "--plane"),
        (reading.order.is_some(), "--order"),
        (reading.frame.is_some(), "--frame"),
        (reading.array.is_some(), "--array"),
        (reading.derive.is_some(), "--derive"),
        (reading.mask.is_some(), "--mask"),
        (reading.mask_above != 0.0, "--mask-above"),
        (reading.zero_not_finite, "--not-finite"),
        (reading.limit.is_some(), "--limit"),
    ];
    if let Some((_, option)) = of_files.into_iter().find(|(is_given, _)| *is_given) {
        let why = "the field is made by a generator or a field file and lies in the plane xy";
        return Err(input::InputError::Needless { option, why });
    }
    plane.cropped(reading)?.resampled(reading)
}

/// What an experiment says about a file; nothing for other sources.
fn reading_of(source: &FieldSource) -> Result<Reading, String> {
    let FieldSource::File {
        array,
        order,
        frame,
        slice,
        plane,
        crop,
        resample,
        derive,
        mask,
        mask_above,
        not_finite,
        ..
    } = source
    else {
        return Ok(Reading::default());
    };
    let zero_not_finite = match not_finite.as_deref() {
        None | Some("refuse") => false,
        Some("zero") => true,
        Some(other) => return Err(format!("not_finite `{other}`: expected refuse or zero")),
    };
    if !mask_above.is_finite() || *mask_above < 0.0 {
        return Err(format!("mask_above {mask_above}: expected a finite number from 0"));
    }
    let frame = frame.as_ref().map(|name| {
        Frame::from_name(name).ok_or_else(|| format!("frame `{name}`: expected voxel, world or measurement"))
    });
    let plane = plane
        .as_ref()
        .map(|name| Plane::from_name(name).ok_or_else(|| format!("plane `{name}`: expected xy, xz or yz")));
    let slice = slice.as_ref().map(|text| parse_slice(text).map_err(|e| format!("slice `{text}`: {e}")));
    let crop = crop.as_ref().map(|text| Crop::parse(text).map_err(|e| format!("crop `{text}`: {e}")));
    Ok(Reading {
        array: array.clone(),
        order: order.clone(),
        frame: frame.transpose()?,
        choice: PlaneChoice { plane: plane.transpose()?, slice: slice.transpose()? },
        crop: crop.transpose()?,
        resample: resample.map(|(width, height)| [width, height]),
        derive: derive.map(derivation),
        mask: mask.clone(),
        mask_above: *mask_above,
        zero_not_finite,
        limit: None,
    })
}

fn derivation(rule: DeriveRule) -> Derivation {
    let (kind, sigma, window) = match rule {
        DeriveRule::Gradient { sigma } => (Derived::Gradient, sigma, None),
        DeriveRule::Hessian { sigma } => (Derived::Hessian, sigma, None),
        DeriveRule::Structure { sigma, window } => (Derived::Structure, sigma, window),
    };
    Derivation {
        kind,
        sigma: sigma.map_or_else(|| kind.usual_sigma(), Sigma::get),
        window: window.map(Sigma::get),
    }
}

fn arguments_of(parameters: &Named<spec::Parameter>) -> Result<Arguments, String> {
    let mut arguments = Arguments::new();
    for (key, value) in parameters.iter() {
        arguments.insert(key, &value.0).map_err(|e| e.to_string())?;
    }
    Ok(arguments)
}

/// Every `stride`-th cell of both directions.
fn strided(field: &Field<Tensor2>, stride: usize) -> Result<Field<Tensor2>, String> {
    if stride == 0 {
        return Err("a stride of 0 keeps no cell: expected 1 or more".to_owned());
    }
    let grid = field.grid();
    let kept = Grid::new(grid.width().div_ceil(stride), grid.height().div_ceil(stride))
        .map_err(|e| e.to_string())?;
    Ok(Field::from_fn(kept, |c| *field.at(Cell::new(c.x * stride, c.y * stride))))
}
