//! The layering and the house rules, checked.

use crate::root;
use cargo_metadata::{DependencyKind, MetadataCommand};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tigereye_experiments::library::is_experiment;
use tigereye_fields::generators;

/// Which crates of the project each crate may use. A new arrow is a decision: change this table in the same commit and
/// say why in ARCHITECTURE.md.
const ALLOWED: &[(&str, &[&str])] = &[
    ("tigereye-core", &[]),
    ("tigereye-fields", &["tigereye-core"]),
    ("tigereye-simd", &[]),
    ("tigereye-transport", &["tigereye-core", "tigereye-simd"]),
    ("tigereye-ltg", &["tigereye-core", "tigereye-transport"]),
    ("tigereye-lines", &["tigereye-core", "tigereye-simd"]),
    ("tigereye-scenes", &["tigereye-core"]),
    ("tigereye-render", &["tigereye-core"]),
    ("tigereye-io", &["tigereye-core"]),
    ("tigereye-report", &[]),
    ("tigereye-input", &["tigereye-core", "tigereye-fields", "tigereye-lines", "tigereye-io"]),
    ("tigereye-views", &["tigereye-core", "tigereye-lines", "tigereye-render", "tigereye-io"]),
    (
        "tigereye-experiments",
        &[
            "tigereye-core",
            "tigereye-fields",
            "tigereye-transport",
            "tigereye-ltg",
            "tigereye-lines",
            "tigereye-scenes",
            "tigereye-render",
            "tigereye-io",
            "tigereye-report",
            "tigereye-input",
            "tigereye-views",
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
            "tigereye-scenes",
            "tigereye-render",
            "tigereye-io",
            "tigereye-report",
            "tigereye-input",
            "tigereye-views",
            "tigereye-experiments",
        ],
    ),
    (
        "tigereye-python",
        &[
            "tigereye-core",
            "tigereye-fields",
            "tigereye-transport",
            "tigereye-ltg",
            "tigereye-lines",
            "tigereye-scenes",
            "tigereye-render",
            "tigereye-io",
            "tigereye-report",
            "tigereye-input",
            "tigereye-views",
            "tigereye-experiments",
        ],
    ),
    ("xtask", &["tigereye-report"]),
    // What tests share: in no other row, because no crate may be built with it.
    ("tigereye-test-support", &["tigereye-core", "tigereye-fields"]),
];

/// Outside crates that the lower layers must not touch, with what that keeps out of them.
const FORBIDDEN: &[(&str, &[&str])] = &[
    ("tigereye-core", &["serde", "rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-fields", &["serde", "rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-transport", &["serde", "rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-ltg", &["serde", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-lines", &["serde", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-scenes", &["serde", "rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-render", &["serde", "rayon", "clap", "ron"]),
    ("tigereye-io", &["rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-report", &["rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-input", &["rayon", "clap", "plotters", "tiny-skia", "ron"]),
    ("tigereye-views", &["clap", "ron"]),
    ("tigereye-experiments", &["clap", "indicatif"]),
];

/// Words no path may carry: history is git's business.
const STALE_WORDS: &[&str] = &["old", "alt", "final", "copy", "new", "tmp", "bak"];

/// Generators are called as the literature calls them, stale words included.
const NAMED_BY_THE_THESIS: &[&str] = &["drain_old.rs", "drain_alt.rs"];

/// Where the snapshots of experiments lie.
const SNAPSHOTS: &str = "crates/experiments/tests/snapshots";

/// Everything but what programs wrote: `.gitignore` names the same.
fn tracked_files() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a readable folder").flatten() {
            let path = entry.path();
            let name = entry.file_name().to_string_lossy().into_owned();
            let ignored = name.starts_with("target")
                || name == "results"
                || folder == root() && (name == "review" || name.ends_with("-results"))
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
                "crate {name} is not in the table of allowed arrows: add it to ALLOWED in tests/tests/house/architecture.rs"
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

/// Longest line of a comment, characters: what fits beside another file on a screen. `rustfmt` keeps code within 110.
const WIDEST_COMMENT: usize = 120;

#[test]
fn comments_fit_on_a_screen() {
    let mut wide = Vec::new();
    for path in tracked_files().iter().filter(|p| p.extension().is_some_and(|e| e == "rs")) {
        let text = std::fs::read_to_string(path).expect("UTF-8 source");
        for (i, line) in text.lines().enumerate() {
            // Rows of tables cannot be broken.
            let is_row = line.trim_start().trim_start_matches(['/', '!']).trim_start().starts_with('|');
            if line.trim_start().starts_with("//") && !is_row && line.chars().count() > WIDEST_COMMENT {
                wide.push(format!("{}:{}", path.display(), i + 1));
            }
        }
    }
    assert!(wide.is_empty(), "comments wider than {WIDEST_COMMENT} characters:\n{}", wide.join("\n"));
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
        if ["cli", "python"].contains(&krate.as_str()) || folder != "src" {
            continue;
        }
        let text = std::fs::read_to_string(path).expect("UTF-8 source");
        let code = text.split("#[cfg(test)]").next().unwrap_or(&text);
        for word in
            ["std::fs", "File::open", "Instant::now", "SystemTime", "std::env", "thread::spawn", "println!"]
        {
            assert!(!code.contains(word), "crates/{}: `{word}` belongs to the edges", relative.display());
        }
    }
}

/// The `.ron` files of experiments, (path from the workspace, text).
fn experiments() -> Vec<(String, String)> {
    let folder = root().join("experiments");
    let files =
        tracked_files().into_iter().filter(|p| p.starts_with(&folder) && is_experiment(&p.to_string_lossy()));
    let path = |p: &Path| p.strip_prefix(root()).expect("inside").to_string_lossy().replace('\\', "/");
    files.map(|p| (path(&p), std::fs::read_to_string(&p).expect("a UTF-8 experiment"))).collect()
}

/// The generators that no experiment shows, a sentence each.
fn unshown_generators(names: &[&str], experiments: &[(String, String)]) -> Vec<String> {
    let shown = |name: &&&str| {
        let named = format!("name: \"{name}\"");
        let calls =
            |text: &str| text.split("Generator(").skip(1).any(|rest| rest.trim_start().starts_with(&named));
        experiments.iter().any(|(_, text)| calls(text))
    };
    let unshown = names.iter().filter(|name| !shown(name));
    unshown
        .map(|name| {
            format!(
                "no experiment shows the generator `{name}`: `cargo run -- field new {name} --experiment --folder \
                 experiments/fields` begins one, or add `\"{name}\": Generator(name: \"{name}\"),` and a figure of it to \
                 experiments/fields/known-answers.ron"
            )
        })
        .collect()
}

/// The experiments without a snapshot and the snapshots without an experiment, a sentence each. Snapshots are named
/// `digest@SLUG.snap`.
fn snapshot_faults(experiments: &[(String, String)], snapshots: &[String]) -> Vec<String> {
    let slug = |path: &str| path.rsplit('/').next().unwrap_or(path).trim_end_matches(".ron").to_owned();
    let slugs: BTreeSet<String> = experiments.iter().map(|(path, _)| slug(path)).collect();
    let lacking =
        experiments.iter().filter(|(path, _)| !snapshots.contains(&format!("digest@{}.snap", slug(path))));
    let lacking = lacking.map(|(path, _)| {
        format!(
            "{path} has no snapshot: run `INSTA_UPDATE=always cargo test -p tigereye-experiments --test snapshots`, read \
             {SNAPSHOTS}/digest@{}.snap, and commit it",
            slug(path)
        )
    });
    let left = snapshots.iter().filter_map(|file| {
        let slug = file.strip_prefix("digest@")?.strip_suffix(".snap")?;
        let path = format!("{SNAPSHOTS}/{file}");
        (!slugs.contains(slug))
            .then(|| format!("{path} belongs to no experiment: `git rm {path}`, or rename it with its file"))
    });
    lacking.chain(left).collect()
}

#[test]
fn every_generator_is_shown_in_an_experiment() {
    let names: Vec<&str> = generators().iter().map(|g| g.name).collect();
    let faults = unshown_generators(&names, &experiments());
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

#[test]
fn every_experiment_has_its_snapshot() {
    let entries = std::fs::read_dir(root().join(SNAPSHOTS)).expect("the snapshots").flatten();
    let mut snapshots: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    snapshots.sort();
    let faults = snapshot_faults(&experiments(), &snapshots);
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

/// Sections are the thesis's chapters 2 to 4, or have a letter that no other section has.
fn section_faults(experiments: &[(String, String)]) -> Vec<String> {
    let mut titles: BTreeMap<&str, &str> = BTreeMap::new();
    let mut faults = Vec::new();
    for (path, text) in experiments {
        let Some((_, rest)) = text.split_once("section: \"") else { continue };
        let title = rest.split('"').next().unwrap_or(rest);
        let mark = title.split(' ').next().unwrap_or(title);
        let is_letter = mark.len() == 1 && mark.starts_with(|c: char| c.is_ascii_uppercase());
        if !(is_letter || ["2.", "3.", "4."].iter().any(|chapter| mark.starts_with(chapter))) {
            faults.push(format!(
                "{path}: section \"{title}\" looks like a chapter of the thesis: begin it with a letter"
            ));
        }
        let known = titles.entry(mark).or_insert(title);
        if *known != title {
            faults.push(format!("{path}: sections \"{title}\" and \"{known}\" have the same mark"));
        }
    }
    faults
}

#[test]
fn sections_do_not_collide_with_those_of_the_thesis() {
    let faults = section_faults(&experiments());
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
    let file = |section: &str| ("a.ron".to_owned(), format!("section: \"{section}\","));
    assert_eq!(section_faults(&[file("6 Beyond"), file("A Data"), file("A Scenes")]).len(), 2);
}

#[test]
fn missing_experiments_and_snapshots_are_told_with_what_to_do() {
    let text = "fields: {\n \"f\": Generator(name: \"gyre\"),\n}, figures: [(name: \"fan\")]";
    let files = [("experiments/fields/gyre.ron".to_owned(), text.to_owned())];
    assert_eq!(unshown_generators(&["gyre"], &files), [""; 0]);
    let told = unshown_generators(&["fan", "gyre"], &files);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("generator `fan`") && told[0].contains("Generator(name: \"fan\")"), "{told:?}");

    assert_eq!(snapshot_faults(&files, &["digest@gyre.snap".to_owned()]), [""; 0]);
    let told = snapshot_faults(&files, &["digest@bow.snap".to_owned(), "digest@bow.snap.new".to_owned()]);
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("gyre.ron has no snapshot") && told[0].contains("digest@gyre.snap"), "{told:?}");
    assert!(told[1].contains("git rm crates/experiments/tests/snapshots/digest@bow.snap`"), "{told:?}");
}
