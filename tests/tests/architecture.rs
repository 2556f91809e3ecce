//! The layering and the house rules, checked.

use cargo_metadata::{DependencyKind, MetadataCommand};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Which crates of the project each crate may use. A new arrow is a decision: change this table in the same commit and
/// say why in ARCHITECTURE.md.
const ALLOWED: &[(&str, &[&str])] = &[
    ("tigereye-core", &[]),
    ("tigereye-fields", &["tigereye-core"]),
    ("tigereye-transport", &["tigereye-core"]),
    ("tigereye-ltg", &["tigereye-core", "tigereye-transport"]),
    ("tigereye-lines", &["tigereye-core"]),
    ("tigereye-render", &["tigereye-core"]),
    ("tigereye-io", &["tigereye-core"]),
    (
        "tigereye-experiments",
        &[
            "tigereye-core",
            "tigereye-fields",
            "tigereye-transport",
            "tigereye-ltg",
            "tigereye-lines",
            "tigereye-render",
            "tigereye-io",
        ],
    ),
    (
        "tigereye-cli",
        &[
            "tigereye-core",
            "tigereye-fields",
            "tigereye-transport",
            "tigereye-ltg",
            "tigereye-lines",
            "tigereye-render",
            "tigereye-io",
            "tigereye-experiments",
        ],
    ),
];

/// Outside crates that the lower layers must not touch, with what that keeps out of them.
const FORBIDDEN: &[(&str, &[&str])] = &[
    ("tigereye-core", &["serde", "rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-fields", &["serde", "rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-transport", &["serde", "rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-ltg", &["serde", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-lines", &["serde", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-render", &["serde", "rayon", "clap", "ron"]),
    ("tigereye-io", &["rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-experiments", &["clap", "indicatif"]),
];

/// Words no path may carry: history is git's business.
const STALE_WORDS: &[&str] = &["old", "alt", "final", "copy", "new", "tmp", "bak"];

/// Generators are called as the literature calls them, stale words included.
const NAMED_BY_THE_THESIS: &[&str] = &["drain_old.rs", "drain_alt.rs"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").to_path_buf()
}

fn tracked_files() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a readable folder").flatten() {
            let path = entry.path();
            let name = entry.file_name().to_string_lossy().into_owned();
            let ignored = name.starts_with("target")
                || name == "results"
                || name == "book"
                || name == ".git"
                || name == ".venv";
            match path.is_dir() {
                true if !ignored => folders.push(path),
                false if !name.ends_with(".snap.new") => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

#[test]
fn arrows_point_downwards_only() {
    let metadata = MetadataCommand::new()
        .manifest_path(root().join("Cargo.toml"))
        .no_deps()
        .exec()
        .expect("cargo metadata");
    let mut seen = BTreeSet::new();
    for package in &metadata.packages {
        let name = package.name.as_str();
        if name == "tigereye-tests" {
            continue;
        }
        let Some((_, allowed)) = ALLOWED.iter().find(|(n, _)| *n == name) else {
            panic!(
                "crate {name} is not in the table of allowed arrows: add it to ALLOWED in tests/tests/architecture.rs"
            )
        };
        seen.insert(name.to_owned());
        let forbidden = FORBIDDEN.iter().find(|(n, _)| *n == name).map_or(&[][..], |(_, f)| f);
        for dependency in package.dependencies.iter().filter(|d| d.kind != DependencyKind::Development) {
            let to = dependency.name.as_str();
            assert!(!to.starts_with("tigereye-") || allowed.contains(&to), "{name} must not depend on {to}");
            assert!(!forbidden.contains(&to), "{name} must not depend on {to}");
        }
    }
    for (name, _) in ALLOWED {
        assert!(seen.contains(*name), "the table names {name}, which does not exist");
    }
}

#[test]
fn every_source_file_says_what_it_is() {
    for path in tracked_files().iter().filter(|p| p.extension().is_some_and(|e| e == "rs")) {
        let text = std::fs::read_to_string(path).expect("UTF-8 source");
        assert!(text.starts_with("//!"), "{} does not open with a //! comment", path.display());
    }
}

#[test]
fn no_path_tells_history() {
    for path in tracked_files() {
        let relative = path.strip_prefix(root()).expect("inside").to_string_lossy().into_owned();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if NAMED_BY_THE_THESIS.contains(&name.as_str()) {
            continue;
        }
        let words: Vec<&str> = relative.split(['/', '_', '-', '.']).collect();
        let stale = words.iter().find(|w| STALE_WORDS.contains(w));
        assert!(stale.is_none(), "{relative}: a path must not say `{}`", stale.unwrap_or(&""));
    }
}

/// Folders below which code may open files, read clocks or own threads. Everything else works on bytes and values.
#[test]
fn only_the_edge_touches_the_world() {
    for path in tracked_files().iter().filter(|p| p.extension().is_some_and(|e| e == "rs")) {
        let relative = path.strip_prefix(root().join("crates")).unwrap_or(Path::new(""));
        let mut parts = relative.iter().map(|p| p.to_string_lossy().into_owned());
        let (Some(krate), Some(folder)) = (parts.next(), parts.next()) else { continue };
        if krate == "cli" || folder != "src" {
            continue;
        }
        let text = std::fs::read_to_string(path).expect("UTF-8 source");
        let code = text.split("#[cfg(test)]").next().unwrap_or(&text);
        for word in
            ["std::fs", "File::open", "Instant::now", "SystemTime", "std::env", "thread::spawn", "println!"]
        {
            assert!(!code.contains(word), "crates/{}: `{word}` belongs to the cli crate", relative.display());
        }
    }
}
