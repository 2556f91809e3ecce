//! One digest per experiment file, compared with its snapshot; every check must pass.
//!
//! `experiments/FOLDER/NAME.ron` has its snapshot in `snapshots/`. After a change that is meant to move numbers, run
//! `cargo insta review` and note the change under "Numbers" in CHANGELOG.md.

use std::path::{Path, PathBuf};
use tigereye_experiments::library::is_experiment;
use tigereye_experiments::{Host, evaluate, load, plan};

/// Memory for gradients, bytes.
const MEMORY: u64 = 4 << 30;

/// Files beside the experiment and in its parent folders.
struct Folder(PathBuf);

impl Host for Folder {
    fn read(&self, path: &str) -> Result<Vec<u8>, String> {
        if let Some(name) = path.strip_prefix("reference/") {
            let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference");
            let folder = std::env::var_os("TIGEREYE_REFERENCE").map_or_else(beside, PathBuf::from);
            return std::fs::read(folder.join(name)).map_err(|e| e.to_string());
        }
        let found = self.0.ancestors().map(|a| a.join(path)).find(|p| p.is_file());
        let path = found.ok_or_else(|| format!("no file {path}"))?;
        std::fs::read(&path).map_err(|e| e.to_string())
    }
}

/// `None` where a file that the project does not have is needed and missing.
fn digest(path: &Path) -> Option<(String, tigereye_experiments::Digest, Vec<String>)> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).expect("a readable experiment");
    let host = Folder(path.parent().expect("a folder").to_path_buf());
    let experiment = load(&name, &text).unwrap_or_else(|e| panic!("{e}"));
    if let Some(missing) = experiment.needs.iter().find(|file| !host.has(file)) {
        println!("skipped: {name} needs {missing} (set TIGEREYE_REFERENCE)");
        return None;
    }
    let plan = plan(&name, &text, &experiment, false, &host).unwrap_or_else(|e| panic!("{e:?}"));
    let evaluation = evaluate(&plan, "test", MEMORY, &host).unwrap_or_else(|e| panic!("{e}"));
    let failed = evaluation.outcome.checks.iter().filter(|c| !c.passed);
    let failed = failed.map(|c| format!("{}: {} = {:?}", plan.slug, c.name, c.value)).collect();
    Some((plan.slug, evaluation.digest, failed))
}

#[test]
fn every_experiment_keeps_its_digest_and_passes_its_checks() {
    let mut failed_checks = Vec::new();
    insta::glob!("../../../experiments", "**/*.ron", |path| {
        if !is_experiment(&path.to_string_lossy()) {
            return;
        }
        let Some((slug, digest, failed)) = digest(path) else { return };
        failed_checks.extend(failed);
        insta::with_settings!({ snapshot_suffix => slug, prepend_module_to_snapshot => false, omit_expression => true }, {
            insta::assert_ron_snapshot!("digest", digest);
        });
    });
    assert!(failed_checks.is_empty(), "failed checks:\n{}", failed_checks.join("\n"));
}
