//! `tigereye reproduce` and `tigereye run`: experiments to a report.

use crate::args::experiments::{ReproduceArgs, RunArgs};
use crate::args::light::Resources;
use crate::commands::{counted, print_text, quoted};
use crate::error::CliError;
use crate::host::{FileHost, REFERENCE};
use crate::{files, interrupt, system};
use std::path::{Path, PathBuf};
use std::time::Instant;
use tigereye_experiments::scene::is_scene_file;
use tigereye_experiments::{
    ExperimentError, Host, Plan, RunError, Scope, evaluate, field_file, library, load, plan, slug_of,
};
use tigereye_fields::{did_you_mean, nearest};
use tigereye_input::provenance;
use tigereye_report::{About, ExperimentOutcome};

/// Largest number of experiment files in a folder.
const MAX_FILES: usize = 10_000;

/// An experiment file, read.
pub(crate) struct Source {
    /// As messages name it.
    name: String,
    text: String,
    /// Its folder; `None` for a built-in one.
    folder: Option<PathBuf>,
}

impl Source {
    pub(crate) fn from_file(path: &Path) -> Result<Self, CliError> {
        let name = path.display().to_string();
        if name.ends_with(field_file::ENDING) {
            let problem = format!(
                "is a field file: expected an experiment; `tigereye field show {name}` shows it, experiments name it in \
                 `fields` as File(path: \"{name}\")"
            );
            return Err(CliError::input(&name, problem));
        }
        let folder = path
            .parent()
            .filter(|p| !p.as_os_str().is_empty())
            .map_or_else(|| PathBuf::from("."), PathBuf::from);
        Ok(Self { name: path.display().to_string(), text: files::read_text(path)?, folder: Some(folder) })
    }

    fn slug(&self) -> String {
        slug_of(&self.name)
    }
}

/// An experiment, ready to run, or the file that it cannot do without.
#[expect(clippy::large_enum_variant, reason = "there are a few dozen")]
pub(crate) enum Prepared {
    Ready(Plan),
    Lacks(String),
}

/// Parses and resolves an experiment; every fault is a line of its own.
pub(crate) fn prepare(source: &Source, full: bool) -> Result<Prepared, CliError> {
    let host = FileHost::new(source.folder.clone(), source.slug());
    let experiment = load(&source.name, &source.text).map_err(|e| CliError::Inputs(vec![e.to_string()]))?;
    if let Some(missing) = experiment.needs.iter().find(|file| !host.has(file)) {
        return Ok(Prepared::Lacks(missing.clone()));
    }
    plan(&source.name, &source.text, &experiment, full, &host)
        .map(Prepared::Ready)
        .map_err(|faults| CliError::Inputs(faults.iter().map(ToString::to_string).collect()))
}

pub(crate) fn reproduce(args: &ReproduceArgs) -> Result<u8, CliError> {
    let mut sources = match &args.experiments {
        None => library::experiments()
            .into_iter()
            .map(|(path, text)| Source {
                name: format!("experiments/{path}"),
                text: text.to_owned(),
                folder: None,
            })
            .collect(),
        Some(folder) => in_folder(folder)?,
    };
    check_slugs(&sources)?;
    choose(&mut sources, &args.only)?;
    if args.list {
        return list(&sources);
    }
    let again = |slug: &str| {
        let full = if args.full { " --full" } else { "" };
        let folder = args
            .experiments
            .as_ref()
            .map_or_else(String::new, |f| format!(" --experiments {}", quoted(&f.to_string_lossy())));
        format!("tigereye reproduce --only {}{full}{folder}", quoted(slug))
    };
    run_sources(&sources, &args.out, args.full, &args.resources, &again)
}

/// Keeps the experiments of the names, or those whose names begin so.
fn choose(sources: &mut Vec<Source>, only: &[String]) -> Result<(), CliError> {
    let mut slugs: Vec<String> = sources.iter().map(Source::slug).collect();
    slugs.sort_unstable();
    let is_meant = |slug: &str, name: &String| {
        slug == name || (slug.starts_with(name.as_str()) && !slugs.contains(name))
    };
    let unknown = only.iter().find(|name| name.is_empty() || !slugs.iter().any(|slug| is_meant(slug, name)));
    if let Some(unknown) = unknown {
        let suggestion = did_you_mean(nearest(unknown, slugs.iter().map(String::as_str)));
        return Err(CliError::Input(format!(
            "--only {unknown}: no such experiment{suggestion}; expected the beginning of one of {} (with titles: \
             `tigereye reproduce --list`)",
            slugs.join(", ")
        )));
    }
    sources.retain(|s| only.is_empty() || only.iter().any(|name| is_meant(&s.slug(), name)));
    Ok(())
}

/// Prints the experiments, a line each: name, title and source.
fn list(sources: &[Source]) -> Result<u8, CliError> {
    let width = sources.iter().map(|s| s.slug().len()).max().unwrap_or(0);
    let mut lines = Vec::new();
    for source in sources {
        let experiment =
            load(&source.name, &source.text).map_err(|e| CliError::Inputs(vec![e.to_string()]))?;
        let slug = source.slug();
        lines.push(format!("{slug:<width$}  {} ({})\n", experiment.title(), experiment.source()));
    }
    lines.sort_unstable();
    print_text(&lines.concat())?;
    Ok(0)
}

pub(crate) fn run(args: &RunArgs) -> Result<u8, CliError> {
    let scene = args.files.iter().map(|f| f.display().to_string()).find(|name| is_scene_file(name));
    if let Some(name) = scene {
        let problem = "is a scene: expected an experiment; `propagate` and `ltg` show scenes";
        return Err(CliError::input(&name, problem));
    }
    let sources = args.files.iter().map(|f| Source::from_file(f)).collect::<Result<Vec<_>, _>>()?;
    check_slugs(&sources)?;
    let again = |slug: &str| {
        let file = sources.iter().find(|s| s.slug() == slug).map_or(slug, |s| s.name.as_str());
        format!("tigereye run {}{}", quoted(file), if args.full { " --full" } else { "" })
    };
    run_sources(&sources, &args.out, args.full, &args.resources, &again)
}

/// Every experiment file below a folder, sorted.
fn in_folder(folder: &Path) -> Result<Vec<Source>, CliError> {
    let fault =
        |path: &Path, source| CliError::File { path: path.display().to_string(), action: "listing", source };
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(here) = folders.pop() {
        for entry in std::fs::read_dir(&here).map_err(|e| fault(&here, e))? {
            let entry = entry.map_err(|e| fault(&here, e))?;
            let kind = entry.file_type().map_err(|e| fault(&entry.path(), e))?;
            if kind.is_dir() {
                folders.push(entry.path());
            } else if library::is_experiment(&entry.path().to_string_lossy()) {
                found.push(entry.path());
            }
            if found.len() > MAX_FILES {
                return Err(CliError::input(
                    &folder.display().to_string(),
                    "holds more than 10000 experiment files",
                ));
            }
        }
    }
    found.sort();
    if found.is_empty() {
        return Err(CliError::input(
            &folder.display().to_string(),
            "holds no experiment files: expected *.ron",
        ));
    }
    found.iter().map(|p| Source::from_file(p)).collect()
}

/// Two files of one name would share a folder of results.
fn check_slugs(sources: &[Source]) -> Result<(), CliError> {
    let mut slugs: Vec<(String, &str)> = sources.iter().map(|s| (s.slug(), s.name.as_str())).collect();
    slugs.sort();
    match slugs.windows(2).find(|w| w[0].0 == w[1].0) {
        Some(w) => {
            Err(CliError::Input(format!("{} and {} are both called {}: rename one", w[0].1, w[1].1, w[0].0)))
        }
        None => Ok(()),
    }
}

fn run_sources(
    sources: &[Source],
    out: &Path,
    full: bool,
    resources: &Resources,
    again: &(dyn Fn(&str) -> String + Sync),
) -> Result<u8, CliError> {
    let start = Instant::now();
    // All files are checked before the first hour is spent.
    let mut prepared = Vec::new();
    let mut faults = Vec::new();
    let mut left_out = Vec::new();
    for source in sources {
        match prepare(source, full) {
            Ok(Prepared::Ready(plan)) => prepared.push((source, plan)),
            Ok(Prepared::Lacks(file)) => {
                let slug = source.slug();
                let where_to =
                    if file.starts_with(REFERENCE) { " (TIGEREYE_REFERENCE names the folder)" } else { "" };
                left_out.push(format!("{slug} needs {file}, which is not there{where_to}"));
            }
            Err(CliError::Inputs(found)) => faults.extend(found),
            Err(e) => faults.push(e.to_string()),
        }
    }
    if !faults.is_empty() {
        return Err(CliError::Inputs(faults));
    }
    if !full {
        prepared.retain(|(_, s)| s.scope == Scope::Always);
    }
    left_out.iter().for_each(|words| eprintln!("left out: {words}"));
    if prepared.is_empty() && !left_out.is_empty() {
        return Err(CliError::Input("no experiment is left to run".to_owned()));
    }
    if prepared.is_empty() {
        return Err(CliError::Input("every experiment named runs only with --full".to_owned()));
    }
    files::make_folder(out)?;
    let memory = resources.memory.unwrap_or_else(system::half_of_memory);
    let outcomes = system::on_threads(resources.threads, || {
        let count = prepared.len();
        let mut outcomes = Vec::with_capacity(count);
        for (i, (source, plan)) in prepared.iter().enumerate() {
            let outcome = run_one(source, plan, &again(&plan.slug), memory, &format!("[{}/{count}]", i + 1))?;
            write_outcome(out, &outcome)?;
            outcomes.push(outcome);
        }
        Ok(outcomes)
    })?;
    let seconds = start.elapsed().as_secs_f64();
    let about = About {
        version: provenance::VERSION.to_owned(),
        seconds,
        command: super::command_line(),
        full,
        threads: resources.threads.unwrap_or_else(rayon::current_num_threads),
        left_out,
    };
    files::write(&out.join("summary.json"), tigereye_report::summary_json(&outcomes, seconds).as_bytes())?;
    files::write(&out.join("index.html"), tigereye_report::html(&outcomes, &about).as_bytes())?;
    conclude(&outcomes, out, seconds)
}

fn run_one(
    source: &Source,
    plan: &Plan,
    command: &str,
    memory: u64,
    prefix: &str,
) -> Result<ExperimentOutcome, CliError> {
    interrupt::check()?;
    let start = Instant::now();
    let host = FileHost::new(source.folder.clone(), format!("{prefix} {}", plan.slug));
    let evaluation = evaluate(plan, command, memory, &host).map_err(|e| match e {
        ExperimentError::Run { source: RunError::Interrupted, .. } => CliError::Interrupted,
        e => CliError::input(&source.name, e),
    })?;
    host.finish();
    let mut outcome = evaluation.outcome;
    outcome.seconds = start.elapsed().as_secs_f64();
    let failed = outcome.checks.iter().filter(|c| !c.passed).count();
    let verdict = match failed {
        0 => format!("{} passed", counted(outcome.checks.len(), "check")),
        n => format!("{n} of {} FAILED", counted(outcome.checks.len(), "check")),
    };
    eprintln!("{prefix} {}: {verdict}, {:.1} s", plan.slug, outcome.seconds);
    Ok(outcome)
}

/// Figures and data of one experiment, each file replaced as a whole.
fn write_outcome(out: &Path, outcome: &ExperimentOutcome) -> Result<(), CliError> {
    let folder = out.join(&outcome.slug);
    files::make_folder(&folder)?;
    for figure in &outcome.figures {
        files::write(&folder.join(format!("{}.png", figure.name)), &figure.png)?;
        files::write(&folder.join(format!("{}.svg", figure.name)), figure.svg.as_bytes())?;
    }
    for data in &outcome.data {
        files::write(&folder.join(&data.name), &data.bytes)?;
    }
    Ok(())
}

/// Says how it went; the exit code.
fn conclude(outcomes: &[ExperimentOutcome], out: &Path, seconds: f64) -> Result<u8, CliError> {
    let experiments = counted(outcomes.len(), "experiment");
    let checks = counted(outcomes.iter().map(|o| o.checks.len()).sum(), "check");
    let failed: Vec<String> = outcomes
        .iter()
        .flat_map(|o| {
            o.checks.iter().filter(|c| !c.passed).map(move |c| {
                let why = c.reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
                format!("  {}: {} = {:.6e}{why}, expected {}", o.slug, c.name, c.value, c.expected)
            })
        })
        .collect();
    let page = out.join("index.html");
    let report = page.display();
    if failed.is_empty() {
        print_text(&format!("{experiments}, {checks}, all passed in {seconds:.0} s\nreport: {report}\n"))?;
        Ok(0)
    } else {
        print_text(&format!(
            "{experiments}, {checks}, {} failed in {seconds:.0} s\n{}\nreport: {report}\n",
            failed.len(),
            failed.join("\n")
        ))?;
        Ok(1)
    }
}
