//! Data outside the project, and tests that run only on demand.

use std::path::{Path, PathBuf};

/// A folder of the thesis author's published data (`.` for all of it), in the folder that `TIGEREYE_REFERENCE` names or
/// else in `shared/reference` beside the project. If it is missing, a line is printed and the result is `None`.
#[must_use]
pub fn reference_folder(part: &str) -> Option<PathBuf> {
    outside("TIGEREYE_REFERENCE", "reference", part)
}

/// The path of a file of the published data, whether or not it exists.
#[must_use]
pub fn reference_file(path: &str) -> PathBuf {
    root("TIGEREYE_REFERENCE", "reference").join(path)
}

/// A folder of example files of other tools (`.` for all of them), in the folder that `TIGEREYE_DATA` names or else in
/// `shared/data` beside the project. If it is missing, a line is printed and the result is `None`.
#[must_use]
pub fn data_folder(part: &str) -> Option<PathBuf> {
    outside("TIGEREYE_DATA", "data", part)
}

fn root(variable: &str, beside: &str) -> PathBuf {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared").join(beside);
    std::env::var_os(variable).map_or_else(beside, PathBuf::from)
}

fn outside(variable: &str, beside: &str, part: &str) -> Option<PathBuf> {
    let folder = root(variable, beside).join(part);
    if folder.is_dir() {
        return Some(folder);
    }
    skipped(&format!("no folder {} (set {variable})", folder.display()));
    None
}

/// Reports that this test, or a part of it, did not run.
pub fn skipped(reason: &str) {
    // Tests run in threads that bear their names.
    let thread = std::thread::current();
    println!("skipped: {}: {reason}", thread.name().unwrap_or("a test"));
}

/// Whether tests that take minutes are to run: `TIGEREYE_FULL=1`.
#[must_use]
pub fn full_run() -> bool {
    std::env::var_os("TIGEREYE_FULL").is_some_and(|v| v == "1")
}
