//! `tigereye reproduce` and `tigereye run`: experiments to a report.

use crate::args::experiments::{DEFAULT_OUT, ReproduceArgs, RunArgs};
use crate::args::light::Resources;
use crate::commands::{counted, print_text, quoted};
use crate::error::CliError;
use crate::host::{FileHost, REFERENCE};
use crate::results_folder::ResultsFolder;
use crate::{files, interrupt, system};
use std::path::{Path, PathBuf};
use std::time::Instant;
use tigereye_experiments::scene::is_scene_file;
use tigereye_experiments::{
    ExperimentError, Host, Plan, RunError, Scope, evaluate, field_file, library, load, plan, slug_of,
};
use tigereye_fields::{did_you_mean, nearest};
use tigereye_input::provenance;
use tigereye_report::{About, CheckOutcome, ExperimentOutcome, LeftOut, plain};

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
        if name.ends_with(field_file::EXTENSION) {
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
        format!("tigereye reproduce --only {}{full}{folder}{}", quoted(slug), out_option(&args.out))
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
        let full = if args.full { " --full" } else { "" };
        format!("tigereye run {}{full}{}", quoted(file), out_option(&args.out))
    };
    run_sources(&sources, &args.out, args.full, &args.resources, &again)
}

/// The option that names a folder of results, with a blank before it; nothing for the default one.
fn out_option(out: &Path) -> String {
    if out == Path::new(DEFAULT_OUT) {
        String::new()
    } else {
        format!(" --out {}", quoted(&out.to_string_lossy()))
    }
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
    let (prepared, left_out) = prepared(sources, full)?;
    let about = About {
        version: provenance::VERSION.to_owned(),
        command: super::command_line(),
        full,
        threads: resources.threads.unwrap_or_else(rayon::current_num_threads),
        added: 0,
        left_out,
    };
    let names: Vec<_> = prepared.iter().map(|(s, plan)| (plan.slug.clone(), s.name.clone())).collect();
    let mut folder = ResultsFolder::open(out, about, &names)?;
    files::make_folder(out)?;
    let memory = resources.memory.unwrap_or_else(system::half_of_memory);
    let verdicts = system::on_threads(resources.threads, || {
        let count = prepared.len();
        let mut verdicts = Vec::with_capacity(count);
        for (i, (source, plan)) in prepared.iter().enumerate() {
            let outcome = run_one(source, plan, &again(&plan.slug), memory, &format!("[{}/{count}]", i + 1));
            let outcome = outcome.inspect_err(|_| {
                if i > 0 {
                    // What is finished is kept; that this one ended is the message.
                    let _ = folder.finish_early();
                }
            })?;
            folder.add(&outcome, &source.name)?;
            verdicts.push(Verdict { slug: outcome.slug, checks: outcome.checks });
        }
        Ok(verdicts)
    })?;
    let there = folder.finish()?;
    conclude(&verdicts, &folder, there, start.elapsed().as_secs_f64())
}

/// Everything that is to run, and what is left out. All files are checked before the first hour is spent.
fn prepared(sources: &[Source], full: bool) -> Result<(Vec<Ready<'_>>, Vec<LeftOut>), CliError> {
    let mut prepared = Vec::new();
    let mut faults = Vec::new();
    let mut left_out = Vec::new();
    for source in sources {
        match prepare(source, full) {
            Ok(Prepared::Ready(plan)) => prepared.push((source, plan)),
            Ok(Prepared::Lacks(needs)) => left_out.push(LeftOut { slug: source.slug(), needs }),
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
    for LeftOut { slug, needs } in &left_out {
        let where_to =
            if needs.starts_with(REFERENCE) { " (TIGEREYE_REFERENCE names the folder)" } else { "" };
        eprintln!("skipped: {slug} needs {needs}, which is missing{where_to}");
    }
    if prepared.is_empty() && !left_out.is_empty() {
        return Err(CliError::Input("no experiment is left to run".to_owned()));
    }
    if prepared.is_empty() {
        return Err(CliError::Input("every experiment named runs only with --full".to_owned()));
    }
    Ok((prepared, left_out))
}

/// An experiment that is to run, with its file.
type Ready<'a> = (&'a Source, Plan);

/// How an experiment went.
struct Verdict {
    slug: String,
    checks: Vec<CheckOutcome>,
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

/// Says how it went; the exit code.
fn conclude(
    verdicts: &[Verdict],
    folder: &ResultsFolder,
    there: usize,
    seconds: f64,
) -> Result<u8, CliError> {
    let experiments = counted(verdicts.len(), "experiment");
    let checks = counted(verdicts.iter().map(|o| o.checks.len()).sum(), "check");
    let failed: Vec<String> = verdicts
        .iter()
        .flat_map(|o| {
            o.checks.iter().filter(|c| !c.passed).map(move |c| {
                let why = c.reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
                let off = c.excess().map(|e| format!(", off by {}", plain(e))).unwrap_or_default();
                format!(
                    "  {}: {} = {}{why}, expected {}{off}",
                    o.slug,
                    c.name,
                    plain(c.value),
                    c.expected.words()
                )
            })
        })
        .collect();
    let page = folder.page();
    let mut report = page.display().to_string();
    if there > verdicts.len() {
        let others = counted(there - verdicts.len(), "earlier experiment");
        report.push_str(&format!(", with {others}"));
    }
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
