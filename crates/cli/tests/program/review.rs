//! `review`: two results, pending snapshots, and what cannot be compared.

use crate::support::{Place, has_keys};
use serde_json::{Value, json};

/// An experiment whose check and first figure depend on the anisotropy, its second figure on nothing.
fn experiment(anisotropy: &str, expect: &str) -> String {
    format!(
        r#"(
    format: 1, title: "Turning", source: "here", section: "1", claim: "c", look_for: "l",
    fields: {{
        "f": Generator(name: "inverse", parameters: {{"size": 7, "anisotropy": {anisotropy}}}),
        "g": Generator(name: "inverse", parameters: {{"size": 5}}),
    }},
    runs: {{ "light": Light(field: "f", directions: 16, lights: [()], stop: Steps(9)) }},
    figures: [
        (name: "moving", caption: "d", panels: [Glyphs(field: "f", title: "t")]),
        (name: "still", caption: "d", panels: [Glyphs(field: "g", title: "t")]),
    ],
    checks: [
        (name: "anisotropy", quantity: LargestAxis(field: "f"), expect: {expect}, basis: "b"),
        (name: "steps", quantity: Steps(run: "light"), expect: Near(9, 0), basis: "b"),
    ],
)
"#
    )
}

/// Runs both experiments of a folder into results of the same name.
fn results(place: &Place, name: &str, anisotropy: &str, expect: &str) {
    place.write(&format!("{name}-files/turning.ron"), experiment(anisotropy, expect));
    place.write(&format!("{name}-files/constant.ron"), experiment("4", "AtLeast(0)"));
    let folder = format!("{name}-files");
    let run = place.tigereye(&["reproduce", "--experiments", &folder, "--out", name]);
    assert!(run.code < 2, "{}", run.stderr);
}

fn page(place: &Place, name: &str) -> String {
    String::from_utf8(place.read(name)).unwrap()
}

#[test]
fn equal_results_end_with_0() {
    let place = Place::new();
    results(&place, "before", "10", "AtLeast(0)");
    results(&place, "after", "10", "AtLeast(0)");
    let run = place.succeeds(&["review", "before", "after"]);
    assert!(run.stdout.contains("2 experiments: 0 moved, 0 added, 0 gone, 2 unchanged"), "{}", run.stdout);
    assert!(run.stdout.contains("page: review/review.html"), "{}", run.stdout);
    let review = place.json("review/review.json");
    assert_eq!((&review["moved"], &review["base"]), (&json!(false), &json!("before")));
    let run = place.succeeds(&["review", "before", "after", "--only", "turning"]);
    assert!(run.stdout.contains("1 experiment: 0 moved, 0 added, 0 gone, 1 unchanged"), "{}", run.stdout);
    assert!(page(&place, "review/review.html").contains("Nothing moved."));
}

#[test]
fn a_number_that_moves_is_shown_with_its_figure() {
    let place = Place::new();
    results(&place, "before", "10", "AtLeast(0)");
    results(&place, "after", "12", "AtLeast(0)");
    let run = place.tigereye(&["review", "before", "after", "--out", "deep/er"]);
    assert_eq!((run.code, run.stderr.as_str()), (1, ""));
    assert!(run.stdout.contains("1 moved") && run.stdout.contains("check anisotropy"), "{}", run.stdout);
    assert!(run.stdout.lines().count() <= 25);
    let review = place.json("deep/er/review.json");
    has_keys(&review, &["base", "head", "tolerance", "moved", "experiments"]);
    let turning = &review["experiments"][0];
    has_keys(
        turning,
        &["slug", "state", "largest_change", "numbers", "figures", "base_seconds", "head_seconds"],
    );
    assert_eq!((&turning["slug"], &turning["state"]), (&json!("turning"), &json!("moved")));
    let names: Vec<&Value> = turning["numbers"].as_array().unwrap().iter().map(|n| &n["name"]).collect();
    assert_eq!(names, ["anisotropy"]);
    let number = &turning["numbers"][0];
    let summary = place.json("after/summary.json");
    let experiments = summary["experiments"].as_array().unwrap();
    let of_summary = experiments.iter().find(|e| e["slug"] == "turning").unwrap();
    assert_eq!(number["head"], of_summary["checks"][0]["value"]);
    assert_eq!(turning["head_seconds"], of_summary["seconds"]);
    let (a, b) = (number["base"].as_f64().unwrap(), number["head"].as_f64().unwrap());
    let change = number["relative_change"].as_f64().unwrap();
    assert!((change - (b - a).abs() / a.abs().max(b.abs())).abs() < 1e-12, "{change}");
    for figure in turning["figures"].as_array().unwrap() {
        has_keys(figure, &["name", "state", "pixels_differing", "largest_difference"]);
        let moved = figure["name"] == "moving";
        assert_eq!(figure["state"], if moved { "moved" } else { "unchanged" });
        assert_eq!(figure["pixels_differing"].as_u64().unwrap() > 0, moved);
    }
    assert_eq!(review["experiments"][1]["state"], "unchanged");
    let page = page(&place, "deep/er/review.html");
    assert_eq!(page.matches("<img ").count(), 3);
    for outside in ["http:", "https:", "url(", "<link", "<script src"] {
        assert!(!page.contains(outside), "{outside}");
    }
    // Figures count whatever the tolerance, numbers do not.
    let run = place.tigereye(&["review", "before", "after", "--tolerance", "10"]);
    assert_eq!(run.code, 1);
    assert!(run.stdout.contains("0 checks moved") && run.stdout.contains("1 figure moved"), "{}", run.stdout);
}

#[test]
fn verdicts_and_experiments_that_come_and_go_are_movement() {
    let place = Place::new();
    results(&place, "before", "10", "AtLeast(0)");
    results(&place, "after", "10", "AtLeast(5)");
    std::fs::remove_file(place.path("after-files/constant.ron")).unwrap();
    place.write("after-files/fresh.ron", experiment("4", "AtLeast(0)"));
    std::fs::remove_dir_all(place.path("after")).unwrap();
    assert_eq!(place.tigereye(&["reproduce", "--experiments", "after-files", "--out", "after"]).code, 1);
    let run = place.tigereye(&["review", "before", "after"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(run.stdout.contains("1 moved, 1 added, 1 gone, 0 unchanged"), "{}", run.stdout);
    assert!(run.stdout.contains("1 verdict changed"), "{}", run.stdout);
    let review = place.json("review/review.json");
    let states: Vec<_> =
        review["experiments"].as_array().unwrap().iter().map(|e| [&e["slug"], &e["state"]]).collect();
    assert_eq!(json!(states), json!([["turning", "moved"], ["constant", "gone"], ["fresh", "added"]]));
    let number = &review["experiments"][0]["numbers"][0];
    assert_eq!((&number["base_passed"], &number["head_passed"]), (&json!(true), &json!(false)));
}

#[test]
fn what_is_no_result_is_refused() {
    let place = Place::new();
    results(&place, "good", "10", "AtLeast(0)");
    place.write("garbage/summary.json", "not json");
    place.write(
        "odd/summary.json",
        r#"{"experiments": [{"slug": "a", "checks": [{"name": "n", "value": "x"}]}]}"#,
    );
    place.write("bytes/summary.json", [0xff, 0xfe]);
    place.write(
        "escape/summary.json",
        r#"{"experiments": [{"slug": "a", "checks": [], "figures": ["../a.png"]}]}"#,
    );
    place.write(
        "lacking/summary.json",
        r#"{"experiments": [{"slug": "a", "checks": [], "figures": ["a/b.png"]}]}"#,
    );
    place.write("empty/readme", "no results");
    place.refuses(
        &["review", "good", "missing"],
        &["missing", "missing/summary.json", "expected a folder of results"],
    );
    place.refuses(
        &["review", "empty", "good"],
        &["empty", "empty/summary.json", "expected a folder of results"],
    );
    place.refuses(&["review", "good", "garbage"], &["garbage/summary.json", "expected the JSON"]);
    place.refuses(&["review", "odd", "good"], &["odd/summary.json", "experiments[0].checks[0]"]);
    place.refuses(&["review", "good", "bytes"], &["bytes/summary.json", "UTF-8"]);
    place.refuses(&["review", "escape", "good"], &["escape/summary.json", "experiments[0].figures[0]"]);
    place.refuses(&["review", "lacking", "good"], &["lacking/a/b.png", "No such file"]);
    place.refuses(&["review", "good"], &["<HEAD>"]);
    place.refuses(&["review"], &["<BASE>"]);
    place.refuses(&["review", "good", "good", "--tolerance", "-1"], &["--tolerance", "from 0"]);
    place.refuses(&["review", "good", "good", "--snapshots"], &["--snapshots", "cannot be used"]);
    place.write("file", "a file");
    place.refuses(&["review", "good", "good", "--out", "file"], &["file: "]);
    place
        .refuses(&["review", "good", "good", "--only", "nothing"], &["--only nothing", "no such experiment"]);
    place.refuses(&["review", "--snapshots", "--only", "turning"], &["--only", "cannot be used"]);
    // A figure that is no picture.
    let mut files = place.files().into_keys();
    let figure = files.find(|p| p.ends_with("good/turning/moving.png")).unwrap();
    for (name, bytes) in place.files() {
        if let Ok(inside) = name.strip_prefix(place.path("good")) {
            let bytes = if name == figure { b"junk".to_vec() } else { bytes };
            place.write(&format!("broken/{}", inside.display()), bytes);
        }
    }
    place.refuses(&["review", "good", "broken"], &["broken/turning/moving.png"]);
}

const SNAPSHOT: &str = "---\nsource: a.rs\n---\nDigest(\n  slug: \"a\",\n  mean: \"1.00000000e0\",\n  figures: [\n    \"f 10x10\",\n  ],\n)\n";

#[test]
fn pending_snapshots_are_compared() {
    let place = Place::new();
    place.write("snaps/digest@a.snap", SNAPSHOT);
    place.write("snaps/digest@b.snap", SNAPSHOT);
    let run = place.succeeds(&["review", "--snapshots", "snaps"]);
    assert!(
        run.stdout.contains("0 snapshots pending") && run.stdout.contains("2 snapshots without"),
        "{}",
        run.stdout
    );
    place.write(
        "snaps/digest@a.snap.new",
        SNAPSHOT.replace("1.00000000", "1.50000000").replace("10x10", "10x20"),
    );
    place.write("snaps/digest@c.snap.new", SNAPSHOT);
    let run = place.tigereye(&["review", "--snapshots", "snaps", "--out", "out"]);
    assert_eq!((run.code, run.stderr.as_str()), (1, ""), "{}", run.stdout);
    assert!(run.stdout.contains("2 snapshots pending: 1 moved, 1 added"), "{}", run.stdout);
    let review = place.json("out/review.json");
    let states: Vec<_> =
        review["experiments"].as_array().unwrap().iter().map(|e| [&e["slug"], &e["state"]]).collect();
    assert_eq!(json!(states), json!([["digest@a", "moved"], ["digest@c", "added"]]));
    let numbers = &review["experiments"][0]["numbers"];
    assert_eq!((&numbers[0]["name"], &numbers[0]["head"]), (&json!("mean"), &json!(1.5)));
    assert_eq!((&numbers[1]["name"], &numbers[1]["head"]), (&json!("figures[0]"), &json!("f 10x20")));
    assert!(page(&place, "out/review.html").contains("figures[0]"));
    // The folder of the project is looked for where no other is named.
    place.refuses(&["review", "--snapshots"], &["crates/experiments/tests/snapshots", "No such file"]);
    place.refuses(&["review", "--snapshots", "nowhere"], &["nowhere", "No such file"]);
}
