//! One test an experiment file, by its name: its digest is that of its snapshot, and every check passes.
//!
//! `cargo test -p tigereye-experiments --test snapshots gyre` runs those with `gyre` in their names.
//!
//! `experiments/FOLDER/NAME.ron` has its snapshot in `snapshots/`. After a change that is meant to move numbers, run
//! `cargo insta review` and note the change under "Numbers" in CHANGELOG.md.

use libtest_mimic::{Arguments, Failed, Trial};
use std::path::{Path, PathBuf};
use tigereye_experiments::library::is_experiment;
use tigereye_experiments::{Host, evaluate, load, plan, slug_of};
use tigereye_test_support::{reference_file, skipped};

/// Memory for the gradients of one experiment, bytes.
const MEMORY: u64 = 4 << 30;

/// Files beside the experiment and in its parent folders.
fn around(folder: &Path) -> impl Host {
    move |path: &str| {
        let file = match path.strip_prefix("reference/") {
            Some(name) => reference_file(name),
            None => {
                let found = folder.ancestors().map(|above| above.join(path)).find(|p| p.is_file());
                found.ok_or_else(|| format!("no file {path}"))?
            }
        };
        std::fs::read(&file).map_err(|e| e.to_string())
    }
}

/// `None` where a file that the project does not have is needed and missing.
fn digest(path: &Path) -> Option<(String, tigereye_experiments::Digest, Vec<String>)> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).expect("a readable experiment");
    let host = around(path.parent().expect("a folder"));
    let experiment = load(&name, &text).unwrap_or_else(|e| panic!("{e}"));
    if let Some(missing) = experiment.needs.iter().find(|file| !host.has(file)) {
        skipped(&format!("{name} needs {missing} (set TIGEREYE_REFERENCE)"));
        return None;
    }
    let plan = plan(&name, &text, &experiment, false, &host).unwrap_or_else(|e| panic!("{e:?}"));
    let evaluation = evaluate(&plan, "test", MEMORY, &host).unwrap_or_else(|e| panic!("{e}"));
    let failed = evaluation.outcome.checks.iter().filter(|c| !c.passed);
    let failed = failed.map(|c| format!("{}: {} = {:?}", plan.slug, c.name, c.value)).collect();
    Some((plan.slug, evaluation.digest, failed))
}

/// Compares an experiment with its snapshot and its checks with what they expect.
fn judge(path: &Path) -> Result<(), Failed> {
    let Some((slug, digest, failed)) = digest(path) else { return Ok(()) };
    insta::with_settings!({
        snapshot_suffix => slug,
        input_file => path,
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, {
        insta::assert_ron_snapshot!("digest", digest);
    });
    if failed.is_empty() { Ok(()) } else { Err(format!("failed checks:\n{}", failed.join("\n")).into()) }
}

/// The experiments below `folder`, in the order of their paths.
fn experiments(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a readable folder").map(|e| e.expect("an entry").path());
    let mut found: Vec<PathBuf> = entries
        .flat_map(|path| if path.is_dir() { experiments(&path) } else { vec![path] })
        .filter(|path| is_experiment(&path.to_string_lossy()))
        .collect();
    found.sort();
    found
}

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../experiments");
    let folder = folder.canonicalize().expect("the experiments");
    let trial = |path: PathBuf| {
        let name = slug_of(&path.to_string_lossy());
        Trial::test(name, move || judge(&path))
    };
    let trials: Vec<Trial> = experiments(&folder).into_iter().map(trial).collect();
    assert!(!trials.is_empty(), "no experiments below {}", folder.display());
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
