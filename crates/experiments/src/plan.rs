//! An experiment file to its plan: fields made, names looked up, cells, steps and directions checked, expressions
//! parsed. After this nothing can be missing. All faults are reported at once.

use crate::experiment::{Animation, Experiment, Figure};
use crate::fault::{Faults, SpecError};
use crate::form::{FieldSource, Named, Placed, Scope};
use crate::host::Host;
use crate::ids::LightId;
use crate::media::{Media, NamedField};
use crate::names::{KnownRun, Names};
use crate::panels::{self, PlannedPanel, checked_style};
use crate::quantities::Measure;
use crate::runs::{RunPlan, RunResolver};
use crate::scene::{self, PreparedScene, is_scene_file};
use crate::sources::make_plane;
use crate::tables::PlannedRow;
use tigereye_core::CellShape;
use tigereye_render::Style;
use tigereye_report::{Column, Expected};

/// An experiment, ready to run.
pub struct Plan {
    /// Name: the file's without folder and extension.
    pub slug: String,
    /// When the whole experiment runs.
    pub scope: Scope,
    pub(crate) title: String,
    pub(crate) source: String,
    pub(crate) section: String,
    pub(crate) claim: String,
    pub(crate) look_for: String,
    pub(crate) media: Media,
    /// All runs of the file, by their ids.
    pub(crate) runs: Vec<PlannedRun>,
    pub(crate) figures: Vec<PlannedFigure>,
    pub(crate) tables: Vec<PlannedTable>,
    pub(crate) checks: Vec<PlannedCheck>,
}

/// A run with its name.
pub(crate) struct PlannedRun {
    pub(crate) name: String,
    /// `None` for a run of another scope, which is not made.
    pub(crate) plan: Option<RunPlan>,
    /// Whether its result becomes a file.
    pub(crate) is_written: bool,
}

/// A figure, ready to be drawn.
pub(crate) struct PlannedFigure {
    pub(crate) name: String,
    pub(crate) caption: String,
    /// Panels side by side, at least one.
    pub(crate) panels: Vec<PlannedPanel>,
    /// Panels per row.
    pub(crate) columns: usize,
    /// What its panels leave open.
    pub(crate) style: Style,
    pub(crate) animation: Option<PlannedAnimation>,
}

/// The steps of a run of light as an animation.
pub(crate) struct PlannedAnimation {
    pub(crate) light: LightId,
    /// Every how many steps there is a frame.
    pub(crate) every: usize,
    /// Decades shown below the brightest cell that is not a light.
    pub(crate) decades: Option<f64>,
}

/// A table, ready to be filled.
pub(crate) struct PlannedTable {
    pub(crate) title: String,
    pub(crate) caption: String,
    pub(crate) columns: Vec<Column>,
    /// At least one.
    pub(crate) rows: Vec<PlannedRow>,
}

/// A check, ready to be judged.
pub(crate) struct PlannedCheck {
    pub(crate) name: String,
    pub(crate) measure: Measure,
    pub(crate) expected: Expected,
    pub(crate) basis: String,
}

impl Plan {
    /// Names of the runs that are made.
    pub fn runs(&self) -> impl Iterator<Item = &str> {
        self.runs.iter().filter(|run| run.plan.is_some()).map(|run| run.name.as_str())
    }

    /// Names of the figures.
    pub fn figures(&self) -> impl Iterator<Item = &str> {
        self.figures.iter().map(|f| f.name.as_str())
    }

    /// Headings of the tables.
    pub fn tables(&self) -> impl Iterator<Item = &str> {
        self.tables.iter().map(|t| t.title.as_str())
    }

    /// Names of the checks.
    pub fn checks(&self) -> impl Iterator<Item = &str> {
        self.checks.iter().map(|c| c.name.as_str())
    }
}

/// Plans an experiment that was read from `text` in `file`; `full`: with the runs that only `--full` makes.
///
/// # Errors
/// Every fault found, in the order of the file's sections.
pub fn plan(
    file: &str,
    text: &str,
    experiment: &Experiment,
    full: bool,
    host: &dyn Host,
) -> Result<Plan, Vec<SpecError>> {
    let mut faults = Faults::new(file, text);
    let media = Media {
        fields: fields(&experiment.fields, host, &mut faults),
        scenes: scenes(experiment, host, &mut faults),
    };
    let declared = |names: &Named<FieldSource>| names.iter().map(|(n, _)| n.to_string()).collect();
    let fields_declared: Vec<String> = declared(&experiment.fields);
    let media_declared: Vec<String> =
        fields_declared.iter().cloned().chain(experiment.scenes.iter().map(|(n, _)| n.to_string())).collect();
    let runs: Vec<KnownRun> = experiment
        .runs
        .iter()
        .map(|(name, run)| {
            let mut resolver =
                RunResolver { name, media: &media, declared: &media_declared, faults: &mut faults };
            let is_made = full || run.scope() == Scope::Always;
            KnownRun { name: name.to_string(), plan: run.resolve(&mut resolver), is_made }
        })
        .collect();
    check_files(experiment, &mut faults);
    for name in experiment.without_data.iter().filter(|name| !runs.iter().any(|run| run.name == ***name)) {
        faults.at(name.place(), &format!("there is no run \"{name}\""));
    }
    let mut names = Names::new(&media, &runs, &fields_declared, &mut faults);
    let mut figures: Vec<PlannedFigure> =
        experiment.figures.iter().filter_map(|f| figure(f, &mut names)).collect();
    panels::series_styles(figures.iter_mut().flat_map(|f| &mut f.panels));
    let tables = experiment.tables.iter().filter_map(|table| {
        // Rows are left out one by one.
        let rows = names.item("table", &table.title, |names| Some(table.rows.rows(names)))?;
        let (title, caption) = (table.title.clone(), table.caption.clone());
        (!rows.is_empty()).then(|| PlannedTable { title, caption, columns: table.rows.columns(), rows })
    });
    let tables = tables.collect();
    let checks = experiment.checks.iter().filter_map(|check| {
        let measure = names.item("check", &check.name, |names| check.quantity.resolve(names))?;
        let (name, basis) = (check.name.clone(), check.basis.clone());
        Some(PlannedCheck { name, measure, expected: check.expect.expected(), basis })
    });
    let checks = checks.collect();
    let kept = names.into_kept();
    if !faults.is_empty() {
        return Err(faults.into_errors());
    }
    let mut runs: Vec<PlannedRun> = runs
        .into_iter()
        .map(|run| PlannedRun {
            is_written: !experiment.without_data.iter().any(|name| **name == run.name),
            plan: run.plan.filter(|_| run.is_made),
            name: run.name,
        })
        .collect();
    for (LightId(id), kept) in kept {
        if let Some(RunPlan::Light(plan)) = &mut runs[id.0].plan {
            plan.kept.merge(&kept);
        }
    }
    let e = experiment;
    let (title, source, section) = (e.title.clone(), e.source.clone(), e.section.clone());
    let (claim, look_for) = (e.claim.clone(), e.look_for.clone());
    let (slug, scope) = (slug_of(file), e.scope);
    Ok(Plan { slug, scope, title, source, section, claim, look_for, media, runs, figures, tables, checks })
}

/// Name of an experiment: its file's without folder and extension.
#[must_use]
pub fn slug_of(file: &str) -> String {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.strip_suffix(".ron").unwrap_or(name).to_owned()
}

fn fields(sources: &Named<FieldSource>, host: &dyn Host, faults: &mut Faults<'_>) -> Vec<NamedField> {
    let made = sources.iter().filter_map(|(name, source)| match make_plane(source, host) {
        Ok((plane, _)) => {
            let (geometry, cell) = (plane.geometry, CellShape::of(plane.geometry.spacing()));
            let (field, unit) = (plane.field, plane.unit);
            Some(NamedField { name: name.to_string(), field, cell, geometry, unit })
        }
        Err(fault) => {
            let place = fault.place.unwrap_or(name.place());
            faults.at(place, &format!("field \"{name}\": {fault}"));
            None
        }
    });
    made.collect()
}

fn scenes(experiment: &Experiment, host: &dyn Host, faults: &mut Faults<'_>) -> Vec<(String, PreparedScene)> {
    let mut made = Vec::new();
    for (name, path) in experiment.scenes.iter() {
        if experiment.fields.get(name).is_some() {
            faults.at(name.place(), &format!("\"{name}\" is the name of a field and of a scene"));
        }
        made.extend(scene_of(path, host, faults).map(|scene| (name.to_string(), scene)));
    }
    made
}

/// The scene of a file.
fn scene_of(path: &Placed<String>, host: &dyn Host, faults: &mut Faults<'_>) -> Option<PreparedScene> {
    if !is_scene_file(path) {
        faults.at(path.place(), &format!("{path}: expected a file NAME{}", scene::EXTENSION));
        return None;
    }
    let text = match host.read(path).map(String::from_utf8) {
        Ok(Ok(text)) => text,
        Ok(Err(_)) => {
            faults.at(path.place(), &format!("{path}: expected UTF-8 text"));
            return None;
        }
        Err(problem) => {
            faults.at(path.place(), &problem);
            return None;
        }
    };
    match scene::prepare(path, &text, host) {
        Ok(scene) => {
            scene.remarks().iter().for_each(|words| host.remark(&format!("{path}: {words}")));
            Some(scene)
        }
        Err(found) => {
            faults.extend(found);
            None
        }
    }
}

fn figure(figure: &Figure, names: &mut Names<'_, '_>) -> Option<PlannedFigure> {
    let style =
        names.item("figure", &figure.name, |names| checked_style(figure.style.as_ref(), None, names))?;
    let resolve =
        |panel: &crate::panels::Panel| names.item("figure", &figure.name, |names| panel.resolve(names));
    let panels: Vec<PlannedPanel> = figure.panels.iter().filter_map(resolve).collect();
    let animation = figure.animation.as_ref().and_then(|animation| {
        let Animation { run, every, decades } = animation;
        let every = every.get();
        let light = names.item("figure", &figure.name, |names| names.light_with_reel(run, every))?;
        Some(PlannedAnimation { light, every, decades: decades.map(crate::form::Positive::get) })
    });
    let (name, caption) = (figure.name.to_string(), figure.caption.clone());
    (!panels.is_empty()).then_some(PlannedFigure {
        name,
        caption,
        panels,
        columns: figure.columns,
        style,
        animation,
    })
}

/// Checks that the files of runs and figures can be told apart, and that names of figures are names of files.
fn check_files(experiment: &Experiment, faults: &mut Faults<'_>) {
    let mut files: Vec<(String, &Placed<String>)> =
        experiment.runs.iter().map(|(name, _)| (file_name(name), name)).collect();
    files.sort_by(|a, b| a.0.cmp(&b.0));
    if let Some(w) = files.windows(2).find(|w| w[0].0 == w[1].0) {
        let problem = format!("runs \"{}\" and \"{}\" would share the file {}.vti", w[0].1, w[1].1, w[0].0);
        faults.at(w[1].1.place(), &problem);
    }
    for (i, figure) in experiment.figures.iter().enumerate() {
        let name = &figure.name;
        if experiment.figures[..i].iter().any(|before| before.name == *name) {
            faults.at(name.place(), &format!("two figures are called \"{name}\""));
        }
        if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_') {
            let problem = format!("figure \"{name}\": a name is a file's: expected letters, digits, - and _");
            faults.at(name.place(), &problem);
        }
    }
}

/// A run's name as part of a file name: what shells and links treat specially becomes `-`.
pub(crate) fn file_name(run: &str) -> String {
    run.chars().map(|c| if c.is_alphanumeric() || c == '_' || c == '-' { c } else { '-' }).collect()
}
