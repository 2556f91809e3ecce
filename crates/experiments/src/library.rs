//! The experiments and data that the program carries, so that an installed one works in any folder.

use crate::{field_file, scene};
use include_dir::{Dir, File, include_dir};

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
    for file in dir.files().filter(|f| is_experiment(&f.path().to_string_lossy())) {
        if let Some(text) = file.contents_utf8() {
            found.push((file.path().to_string_lossy().replace('\\', "/"), text));
        }
    }
    for sub in dir.dirs() {
        collect(sub, found);
    }
}

/// Whether a file in a folder of experiments is one: fields and scenes may lie beside them.
#[must_use]
pub fn is_experiment(path: &str) -> bool {
    path.ends_with(".ron") && !path.ends_with(field_file::EXTENSION) && !scene::is_scene_file(path)
}

/// Bytes of a carried data file; `path` is `data/NAME` or `NAME`, or the name of a field, scene or picture beside any
/// experiment.
#[must_use]
pub fn data(path: &str) -> Option<&'static [u8]> {
    let carried = DATA.get_file(path.strip_prefix("data/").unwrap_or(path));
    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
    let beside = || {
        let is_known = [field_file::EXTENSION, scene::EXTENSION, ".png"]
            .iter()
            .any(|extension| name.ends_with(extension));
        is_known.then(|| file_below(&EXPERIMENTS, name)).flatten()
    };
    carried.or_else(beside).map(File::contents)
}

/// A file by its name, in a folder or those below it.
fn file_below(dir: &'static Dir<'static>, name: &str) -> Option<&'static File<'static>> {
    let is_named = |f: &&File<'_>| f.path().file_name().is_some_and(|n| n.to_string_lossy() == name);
    dir.files().find(is_named).or_else(|| dir.dirs().find_map(|sub| file_below(sub, name)))
}
