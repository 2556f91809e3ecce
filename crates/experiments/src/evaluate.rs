//! One experiment from settings to outcome.

use crate::Medium;
use crate::digest::{Digest, digest};
use crate::draw::{Drawn, draw_figure};
use crate::host::Host;
use crate::measure;
use crate::pulses::comma_separated;
use crate::runs::{Results, RunError, run_all};
use crate::settings::{RunSettings, Settings};
use crate::spec::PulseNumber;
use crate::tables;
use rayon::prelude::*;
use serde_json::{Value, json};
use thiserror::Error;
use tigereye_core::Normalization;
use tigereye_input::provenance::{provenance, with_rows};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{IoError, Rows};
use tigereye_report::{DataFile, ExperimentOutcome};
use tigereye_transport::StoppingRule;
use tigereye_views::Placement;

/// An experiment that could not be evaluated.
#[derive(Debug, Error)]
pub enum ExperimentError {
    /// A run, figure or check could not be made.
    #[error("experiment {slug}: {source}")]
    Run {
        /// Name of the experiment.
        slug: String,
        /// What went wrong.
        source: RunError,
    },
    /// A result could not be encoded.
    #[error("experiment {slug}, run \"{run}\": {source}")]
    Encoding {
        /// Name of the experiment.
        slug: String,
        /// Name of the run.
        run: String,
        /// What went wrong.
        source: Box<IoError>,
    },
}

/// An outcome with the digest that snapshot tests compare.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Figures, checks, data; its `seconds` are 0 until the caller sets them.
    pub outcome: ExperimentOutcome,
    /// The numbers worth remembering.
    pub digest: Digest,
}

/// Runs an experiment, draws its figures and judges its checks. Gradients use at most `memory_bytes`.
///
/// # Errors
/// [`ExperimentError`]; a failed check is no error but part of the outcome.
pub fn evaluate(
    settings: &Settings,
    command: &str,
    memory_bytes: u64,
    host: &dyn Host,
) -> Result<Evaluation, ExperimentError> {
    let slug = settings.slug.clone();
    let failed = |source| ExperimentError::Run { slug: settings.slug.clone(), source };
    let results = run_all(settings, memory_bytes, host).map_err(failed)?;
    let drawn: Vec<Drawn> = settings
        .experiment
        .figures
        .par_iter()
        .map(|f| draw_figure(f, settings, &results))
        .collect::<Result<_, _>>()
        .map_err(failed)?;
    let checks = settings
        .experiment
        .checks
        .iter()
        .map(|c| measure::check(c, settings, &results))
        .collect::<Result<Vec<_>, _>>()
        .map_err(failed)?;
    let mut data = data_files(settings, command, &results)?;
    let mut figures = Vec::new();
    for Drawn { figure, tables } in drawn {
        figures.push(figure);
        data.extend(tables);
    }
    let e = &settings.experiment;
    let outcome = ExperimentOutcome {
        slug,
        title: e.title.clone(),
        source: e.source.clone(),
        section: e.section.clone(),
        claim: e.claim.clone(),
        look_for: e.look_for.clone(),
        figures,
        tables: e.tables.iter().map(|t| tables::table(t, &results)).collect(),
        checks,
        work: work_of(settings, &results),
        data,
        seconds: 0.0,
        command: command.to_owned(),
    };
    let digest = digest(settings, &results, &outcome);
    Ok(Evaluation { outcome, digest })
}

fn work_of(settings: &Settings, results: &Results) -> Vec<(String, u64)> {
    let mut work = Vec::new();
    for (name, _) in &settings.runs {
        if let Some(r) = results.lights.get(name) {
            work.push((format!("{name}: steps"), r.work.steps as u64));
            work.push((format!("{name}: cell updates"), r.work.cell_updates));
        }
        if let Some(g) = results.gradients.get(name) {
            work.push((format!("{name}: sources"), g.work.sources));
            work.push((format!("{name}: steps of all sources"), g.work.iterations_total));
            work.push((format!("{name}: most steps of a source"), g.work.iterations_max));
            work.push((format!("{name}: cell updates"), g.work.cell_updates));
        }
        if let Some(f) = results.ftle.get(name) {
            let lines = f.larger.values().iter().filter(|v| v.is_finite()).count();
            work.push((format!("{name}: lines"), 2 * lines as u64));
        }
        if let Some(pulses) = results.pulses.get(name) {
            let settled = |number| pulses.iter().map(move |p| p.number(number)).filter(|n| n.is_finite());
            let sum = |number| settled(number).sum::<f64>() as u64;
            work.push((
                format!("{name}: plain steps of all pulses that settle"),
                sum(PulseNumber::PlainSteps),
            ));
            work.push((
                format!("{name}: evaluations of all pulses that settle"),
                sum(PulseNumber::Evaluations),
            ));
        }
    }
    work
}

/// Every run's result: VTK image data with its provenance, or a list of pulses.
fn data_files(
    settings: &Settings,
    command: &str,
    results: &Results,
) -> Result<Vec<DataFile>, ExperimentError> {
    let mut files = Vec::new();
    for (name, run) in &settings.runs {
        if let Some(pulses) = results.pulses.get(name) {
            let bytes = comma_separated(pulses).into_bytes();
            files.push(DataFile { name: format!("{}.pulses.csv", file_name(name)), bytes });
            continue;
        }
        let story = story_of(settings, command, run);
        let image = if let Some(r) = results.lights.get(name) {
            tigereye_io::image_from_light(&r.last, &PlaneGeometry::UNPLACED, &story)
        } else if let Some(g) = results.gradients.get(name) {
            tigereye_io::image_from_ltg(&g.volume, &PlaneGeometry::UNPLACED, &story)
        } else if let (Some(f), Some(field)) = (results.ftle.get(name), settings.fields.get(run.field())) {
            let placement =
                Placement::new(PlaneGeometry::UNPLACED.with_spacing(f.cell.sides()), field.grid());
            let arrays = [("FTLE", &f.larger), ("FTLE_smaller", &f.smaller)];
            tigereye_views::image(&arrays, [f.samples; 2], &placement, &story)
        } else {
            continue;
        };
        let bytes = tigereye_io::vti::write(&image).map_err(|source| ExperimentError::Encoding {
            slug: settings.slug.clone(),
            run: name.clone(),
            source: Box::new(source),
        })?;
        files.push(DataFile { name: format!("{}.vti", file_name(name)), bytes });
    }
    Ok(files)
}

/// A run's name as part of a file name: what shells and links treat specially becomes `-`.
pub(crate) fn file_name(run: &str) -> String {
    run.chars().map(|c| if c.is_alphanumeric() || c == '_' || c == '-' { c } else { '-' }).collect()
}

fn story_of(settings: &Settings, command: &str, run: &RunSettings) -> String {
    let hash = settings.medium(run.field()).map(Medium::blake3).unwrap_or_default();
    let (setup, own) = match run {
        RunSettings::Ftle(f) => {
            let parameters = json!({
                "field": f.field,
                "axes": f.following.axes.axes().name(),
                "major": f.following.axes.major().name(),
                "family": f.family.name(),
                "length": f.length,
                "samples": f.samples,
            });
            return provenance(command, &with_rows(parameters, Rows::Upwards), &hash);
        }
        RunSettings::Light(l) => {
            let lights: Vec<_> = l.lights.iter().map(|l| (l.cell.x, l.cell.y)).collect();
            (&l.setup, json!({ "lights": lights, "engine": format!("{:?}", l.engine) }))
        }
        RunSettings::Gradient(g) => (&g.setup, json!({ "omega_step": g.omega_step, "slices": g.slices })),
        RunSettings::Pulses(p) => (&p.setup, json!({ "pulses": p.pulses.len() })),
    };
    let stop = match setup.stopping.rule {
        StoppingRule::FluxChange { .. } => "flux",
        StoppingRule::DistributionChange { .. } => "distribution",
        StoppingRule::Converged { .. } => "stationary",
        StoppingRule::Steps(_) => "steps",
    };
    let normalization = match settings.medium(&setup.field) {
        Some(Medium::Scene(_)) => "scene".to_owned(),
        _ => normalization_name(setup.normalization),
    };
    let mut parameters = json!({
        "field": setup.field,
        "directions": setup.directions.count(),
        "normalization": normalization,
        "stop": stop,
        "threshold": setup.stopping.rule.threshold(),
        "max_iterations": setup.stopping.max_iterations,
        "weights": format!("{:?}", setup.weights),
    });
    if let (Some(all), Value::Object(own)) = (parameters.as_object_mut(), own) {
        all.extend(own);
    }
    provenance(command, &with_rows(parameters, Rows::of_results(&PlaneGeometry::UNPLACED)), &hash)
}

/// The name of a normalisation as options spell it.
#[must_use]
pub fn normalization_name(normalization: Normalization) -> String {
    match normalization {
        Normalization::Global => "global".to_owned(),
        Normalization::Local => "local".to_owned(),
        Normalization::LocalAbove { fraction, below: tigereye_core::Below::Absorb } => {
            format!("local-above:{fraction}")
        }
        Normalization::LocalAbove { fraction, below: tigereye_core::Below::Global } => {
            format!("local-above-global:{fraction}")
        }
    }
}
