//! Completions and manual pages.

use crate::support::Place;
use std::collections::BTreeSet;

/// Commands of the program, and those inside them, as `tigereye-field-show`.
fn commands() -> BTreeSet<String> {
    let pages = include_str!("../../../../docs/reference/commands.md");
    let headings = pages.lines().filter_map(|line| line.strip_prefix("## "));
    headings.map(|words| format!("tigereye-{}", words.replace(' ', "-"))).collect()
}

#[test]
fn every_shell_completes_every_command() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = place.succeeds(&["completions", shell]).stdout;
        for command in commands() {
            let word = command.rsplit('-').next().unwrap().to_owned();
            assert!(script.contains(&word), "{shell} does not know {word}");
        }
        assert!(script.contains("normalization"), "{shell} does not know the options of ltg");
    }
    place.refuses(&["completions", "csh"], &["csh", "bash", "zsh", "fish"]);
}

#[test]
fn every_command_has_a_manual_page_with_its_options() {
    let place = Place::new();
    place.tigereye(&["man", "--out", "pages"]);
    let pages = place.path("pages");
    let found: BTreeSet<String> = std::fs::read_dir(&pages)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let mut expected: BTreeSet<String> = commands().iter().map(|c| format!("{c}.1")).collect();
    expected.extend(["tigereye.1".to_owned()]);
    assert_eq!(found, expected);
    let page = std::fs::read_to_string(pages.join("tigereye-ltg.1")).unwrap();
    assert!(page.contains("normalization") && page.contains("tigereye\\-ltg"), "{page}");
}

#[test]
fn archives_have_the_names_that_installers_expect() {
    let script = include_str!("../../../../dist/run");
    let manifest = include_str!("../../Cargo.toml");
    assert!(script.contains("name=tigereye-$version-$target") && script.contains("archive=$name.tar.gz"));
    assert!(manifest.contains("tigereye-{ version }-{ target }.tar.gz"));
    assert!(script.contains("archive=$name.zip") && manifest.contains("tigereye-{ version }-{ target }.zip"));
}
