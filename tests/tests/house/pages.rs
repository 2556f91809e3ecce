//! Pages of the documentation: every one is in the book, and every link leads somewhere.

use crate::root;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Files that end in `.md` in the root, `docs` and what is below it.
fn pages() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let below = ["", "docs", "docs/guide", "docs/reference", "interop", "browser", "findings", "data"];
    for folder in below.map(|folder| root().join(folder)) {
        let entries = std::fs::read_dir(&folder).expect("a readable folder").flatten().map(|e| e.path());
        found.extend(entries.filter(|p| p.extension().is_some_and(|e| e == "md")));
    }
    found.sort();
    found
}

fn text_of(page: &Path) -> String {
    std::fs::read_to_string(page).expect("a UTF-8 page")
}

/// The lines of a page outside of blocks of code.
fn prose(text: &str) -> Vec<&str> {
    let mut in_code = false;
    let is_prose = |line: &&str| {
        let is_fence = line.trim_start().starts_with("```");
        in_code ^= is_fence;
        !in_code && !is_fence
    };
    text.lines().filter(is_prose).collect()
}

/// What links and pictures point to, addresses on the web left out.
fn targets(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in prose(text) {
        for rest in line.split("](").skip(1) {
            let target = rest.split(')').next().unwrap_or_default();
            if !target.contains("://") {
                found.push(target.to_owned());
            }
        }
    }
    found
}

/// The anchors of a page's headings, as GitHub and mdBook make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text)
        .into_iter()
        .filter_map(|line| line.strip_prefix('#'))
        .map(|h| h.trim_start_matches('#').trim());
    let anchor = |heading: &str| {
        let kept = heading.to_lowercase().replace(' ', "-");
        kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_')).collect()
    };
    headings.map(anchor).collect()
}

/// The links of a page that lead nowhere.
fn dead_links(page: &Path) -> Vec<String> {
    let text = text_of(page);
    let folder = page.parent().expect("a folder");
    let leads = |target: &str| {
        let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
        let there = if path.is_empty() { page.to_path_buf() } else { folder.join(path) };
        there.exists() && (anchor.is_empty() || there.is_file() && anchors(&text_of(&there)).contains(anchor))
    };
    targets(&text).into_iter().filter(|t| !leads(t)).map(|t| format!("{}: {t}", page.display())).collect()
}

#[test]
fn links_lead_somewhere() {
    let dead: Vec<String> = pages().iter().flat_map(|page| dead_links(page)).collect();
    assert!(dead.is_empty(), "dead links:\n{}", dead.join("\n"));
}

#[test]
fn the_book_has_every_page_once() {
    let docs = root().join("docs");
    let summary = docs.join("SUMMARY.md");
    let mut listed: Vec<PathBuf> = targets(&text_of(&summary)).iter().map(|t| docs.join(t)).collect();
    listed.sort();
    let own: Vec<PathBuf> = pages().into_iter().filter(|p| p.starts_with(&docs) && *p != summary).collect();
    assert_eq!(listed, own);
}

#[test]
fn the_readme_is_a_first_look() {
    let lines = text_of(&root().join("README.md")).lines().count();
    assert!(lines < 150, "{lines} lines: what is not needed at first belongs to a page below docs/");
}

#[test]
fn dead_links_and_anchors_are_found() {
    let text = "# A title, with marks!\n\n[a](b.md#c) ![d](e.png) [f](https://g)\n```\n[h](i)\n# j\n```\n";
    assert_eq!(targets(text), ["b.md#c", "e.png"]);
    assert_eq!(anchors(text).into_iter().collect::<Vec<_>>(), ["a-title-with-marks"]);
}
