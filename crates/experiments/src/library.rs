//! The experiments and data that the program carries, so that an installed one works in any folder.

use include_dir::{Dir, include_dir};

static EXPERIMENTS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../experiments");
static DATA: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../data");

/// Every carried experiment as (path below `experiments/`, text), sorted by path.
#[must_use]
pub fn experiments() -> Vec<(String, &'static str)> {
    let mut found = Vec::new();
    collect(&EXPERIMENTS, &mut found);
    found.sort();
    found
}

fn collect(dir: &'static Dir<'static>, found: &mut Vec<(String, &'static str)>) {
    for file in dir.files().filter(|f| f.path().extension().is_some_and(|e| e == "ron")) {
        if let Some(text) = file.contents_utf8() {
            found.push((file.path().to_string_lossy().replace('\\', "/"), text));
        }
    }
    for sub in dir.dirs() {
        collect(sub, found);
    }
}

/// Bytes of a carried data file; `path` is `data/NAME` or `NAME`.
#[must_use]
pub fn data(path: &str) -> Option<&'static [u8]> {
    DATA.get_file(path.strip_prefix("data/").unwrap_or(path)).map(|f| f.contents())
}
