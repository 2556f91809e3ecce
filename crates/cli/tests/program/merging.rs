//! Reports grow: experiments join the ones that are there, and nothing is replaced that was not run again.

use crate::support::Place;
use serde_json::Value;

/// A small experiment; `size` moves its check.
fn experiment(size: usize) -> String {
    format!(
        r#"(
    format: 1, title: "Field of {size}", source: "here", section: "1", claim: "c", look_for: "l",
    fields: {{ "f": Generator(name: "inverse", parameters: {{"size": {size}}}) }},
    figures: [(name: "glyphs", caption: "Glyphs of {size}.", panels: [Glyphs(field: "f", title: "t")])],
    checks: [(name: "zeros", quantity: ZeroShare(field: "f"), expect: AtMost(0), basis: "b")],
)
"#
    )
}

/// A place with a report `r` of `a`, `b` and `c`.
fn place_with_report() -> Place {
    let place = Place::new();
    for (name, size) in [("a", 5), ("b", 6), ("c", 7)] {
        place.write(&format!("files/{name}.ron"), experiment(size));
    }
    let run = place.tigereye(&["reproduce", "--experiments", "files", "--out", "r"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    place
}

fn slugs(place: &Place) -> Vec<String> {
    let summary = place.json("r/summary.json");
    let experiments = summary["experiments"].as_array().unwrap();
    experiments.iter().map(|e| e["slug"].as_str().unwrap().to_owned()).collect()
}

fn page(place: &Place) -> String {
    String::from_utf8(place.read("r/index.html")).unwrap()
}

/// The summary without times, and without the last command.
fn lasting(place: &Place) -> Value {
    let mut summary = place.json("r/summary.json");
    summary["seconds"] = Value::Null;
    summary["about"]["command"] = Value::Null;
    summary["about"]["added"] = Value::Null;
    for e in summary["experiments"].as_array_mut().unwrap() {
        e["seconds"] = Value::Null;
    }
    summary
}

#[test]
fn experiments_that_are_not_run_again_stay_on_the_page() {
    let place = place_with_report();
    let before = lasting(&place);
    let files = place.files();
    let run = place.tigereye(&["reproduce", "--experiments", "files", "--only", "b", "--out", "r"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("with 2 earlier experiments"), "{}", run.stdout);
    assert_eq!(slugs(&place), ["a", "b", "c"]);
    assert_eq!(lasting(&place)["experiments"], before["experiments"]);
    let page = page(&place);
    assert!(page.contains("3 experiments: 3 of 3 checks passed"), "{}", &page[..400]);
    for size in [5, 6, 7] {
        assert!(page.contains(&format!("Glyphs of {size}.")));
    }
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 3, "with every figure");
    let after = place.files();
    assert_eq!(files.keys().collect::<Vec<_>>(), after.keys().collect::<Vec<_>>());
    place.write("d.ron", experiment(8));
    assert_eq!(place.tigereye(&["run", "d.ron", "--out", "r"]).code, 0);
    assert_eq!(slugs(&place), ["a", "b", "c", "d"]);
}

#[test]
fn the_command_of_each_experiment_makes_its_figure_again_and_nothing_else() {
    let place = place_with_report();
    place.write("it's d.ron", experiment(8));
    assert_eq!(place.tigereye(&["run", "it's d.ron", "--out", "r"]).code, 0);
    let before = lasting(&place);
    for e in before["experiments"].as_array().unwrap() {
        let slug = e["slug"].as_str().unwrap();
        let figure = format!("r/{slug}/glyphs.png");
        let png = place.read(&figure);
        place.write(&figure, "spoilt");
        let words = shell_words(e["command"].as_str().unwrap());
        assert_eq!(words[0], "tigereye");
        let words: Vec<&str> = words[1..].iter().map(String::as_str).collect();
        let run = place.tigereye(&words);
        assert_eq!(run.code, 0, "{words:?}: {}", run.stderr);
        assert!(place.read(&figure) == png, "{words:?} makes the figure again");
        assert_eq!(lasting(&place), before, "{words:?}");
    }
}

/// The words of a command as a POSIX shell splits it, single quotes and backslashes only.
fn shell_words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let (mut quoted, mut escaped) = (false, false);
    for c in command.chars() {
        let word = words.last_mut().unwrap();
        match c {
            _ if escaped => {
                word.push(c);
                escaped = false;
            }
            '\\' if !quoted => escaped = true,
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            c => word.push(c),
        }
    }
    words
}

#[test]
fn a_larger_report_of_another_version_is_refused() {
    let place = place_with_report();
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    let summary = String::from_utf8(place.read("r/summary.json")).unwrap();
    place.write("r/summary.json", summary.replace(&version, "\"version\": \"0.0.7\""));
    let only = ["reproduce", "--experiments", "files", "--only", "b", "--out", "r"];
    place.refuses(&only, &["r: ", "version 0.0.7 with 3 experiments", "replace 1", "--out"]);
    place.refuses(&["run", "files/a.ron", "files/c.ron", "--out", "r"], &["replace 2"]);
    // All of them may be made anew.
    assert_eq!(place.tigereye(&["reproduce", "--experiments", "files", "--out", "r"]).code, 0);
    let summary = String::from_utf8(place.read("r/summary.json")).unwrap();
    assert!(summary.contains(&version) && !summary.contains("0.0.7"));
    // Older programs did not say their version.
    place.write("r/summary.json", summary.replace("\"version\"", "\"colour\""));
    place.refuses(&only, &["an earlier version", "--out"]);
}

#[test]
fn results_of_other_settings_are_refused() {
    let place = place_with_report();
    let full = ["reproduce", "--experiments", "files", "--full", "--out", "r"];
    place.refuses(&[&full[..], &["--only", "a"]].concat(), &["made without --full", "replace 1"]);
    assert_eq!(place.tigereye(&full).code, 0);
    let plain = ["reproduce", "--experiments", "files", "--out", "r"];
    place.refuses(&plain, &["holds a, made with --full", "--out"]);
    // Another experiment that happens to have the same name.
    place.write("others/a.ron", experiment(9));
    place.refuses(&["run", "others/a.ron", "--full", "--out", "r"], &["files/a.ron", "others/a.ron"]);
}

#[test]
fn what_is_no_report_is_not_replaced() {
    let place = place_with_report();
    place.write("site/index.html", "<p>My home page</p>");
    place.refuses(
        &["run", "files/a.ron", "--out", "site"],
        &["site/index.html: is not a tigereye report", "--out"],
    );
    place.write("odd/summary.json", "a diary");
    place.refuses(&["run", "files/a.ron", "--out", "odd"], &["odd/summary.json: ", "--out"]);
}
