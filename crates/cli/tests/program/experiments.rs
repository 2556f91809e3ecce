//! `reproduce`, `run` and `check`: reports, exit codes, and experiment files that are wrong.

use crate::support::{Place, has_keys};
use serde_json::Value;

/// A small experiment of one light and one check.
fn experiment(check: &str) -> String {
    format!(
        r#"// A small experiment.
(
    format: 1, title: "Small", source: "here", section: "1", claim: "c", look_for: "l",
    fields: {{ "f": Generator(name: "inverse", parameters: {{"size": 7}}) }},
    runs: {{
        "light": Light(field: "f", directions: 16, lights: [()], stop: Steps(3)),
        "gradient": Gradient(field: "f", directions: 8),
    }},
    figures: [(name: "glyphs", caption: "d", panels: [Glyphs(field: "f", title: "t")])],
    checks: [(name: "steps", quantity: Steps(run: "light"), expect: {check}, basis: "b")],
)
"#
    )
}

#[track_caller]
fn has_the_agreed_shape(place: &Place, out: &str) -> Value {
    let summary = place.json(&format!("{out}/summary.json"));
    assert!(summary["passed"].is_boolean() && summary["seconds"].is_number(), "{summary:#}");
    for experiment in summary["experiments"].as_array().unwrap() {
        has_keys(experiment, &["slug", "title", "source", "seconds", "passed", "figures", "checks"]);
        assert!(experiment["passed"].is_boolean() && experiment["seconds"].is_number(), "{experiment:#}");
        let slug = experiment["slug"].as_str().unwrap();
        for figure in experiment["figures"].as_array().unwrap() {
            let path = figure.as_str().unwrap();
            assert!(path.starts_with(&format!("{slug}/")), "{path}");
            assert!(!place.read(&format!("{out}/{path}")).is_empty(), "{path}");
        }
        for check in experiment["checks"].as_array().unwrap() {
            has_keys(check, &["name", "value", "expected", "tolerance", "passed"]);
            assert!(check["expected"].is_number() && check["tolerance"].is_number(), "{check:#}");
        }
    }
    let page = String::from_utf8(place.read(&format!("{out}/index.html"))).unwrap();
    assert!(page.to_lowercase().starts_with("<!doctype html>"), "{}", &page[..80]);
    // One self-contained page.
    for outside in ["<script src", "<link", "src=\"http", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    summary
}

#[test]
fn one_built_in_experiment_leaves_page_summary_and_figures() {
    let place = Place::new();
    let run = place.tigereye(&["reproduce", "--only", "fig-3-1-emitters", "--out", "results/here"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("all passed") && run.stdout.contains("index.html"), "{}", run.stdout);
    let summary = has_the_agreed_shape(&place, "results/here");
    assert_eq!(summary["passed"], true);
    let experiments = summary["experiments"].as_array().unwrap();
    assert_eq!(experiments.len(), 1);
    assert_eq!(experiments[0]["slug"], "fig-3-1-emitters");
    assert!(!experiments[0]["figures"].as_array().unwrap().is_empty());
    assert!(!experiments[0]["checks"].as_array().unwrap().is_empty());
    let leftovers: Vec<_> =
        place.files().into_keys().filter(|p| p.to_string_lossy().contains(".tigereye-")).collect();
    assert!(leftovers.is_empty(), "{leftovers:?}");
}

#[test]
fn several_experiments_share_a_report() {
    let place = Place::new();
    let args = [
        "reproduce",
        "--only",
        "fig-3-1-emitters",
        "--only",
        "fig-3-2-cones",
        "--out",
        "r",
        "--threads",
        "1",
    ];
    assert_eq!(place.tigereye(&args).code, 0);
    let summary = has_the_agreed_shape(&place, "r");
    assert_eq!(summary["experiments"].as_array().unwrap().len(), 2);
}

#[test]
fn a_given_file_is_run_and_its_data_written() {
    let place = Place::new();
    place.write("small.ron", experiment("Near(3, 0)"));
    let run = place.tigereye(&["run", "small.ron", "--out", "r"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let summary = has_the_agreed_shape(&place, "r");
    assert_eq!(summary["experiments"][0]["slug"], "small");
    assert_eq!(summary["experiments"][0]["checks"][0]["value"], 3.0);
    assert_eq!(place.image("r/small/gradient.vti").dimensions, [7, 7, 8]);
    assert_eq!(place.image("r/small/light.vti").dimensions, [7, 7, 1]);
    let story: Value =
        serde_json::from_str(place.image("r/small/gradient.vti").text("tigereye").unwrap()).unwrap();
    has_keys(&story, &["version", "command", "parameters", "input_blake3"]);
    has_keys(
        &story["parameters"],
        &["directions", "threshold", "max_iterations", "omega_step", "normalization"],
    );
}

#[test]
fn a_failed_check_makes_the_exit_code_1() {
    let place = Place::new();
    place.write("small.ron", experiment("Near(4, 0.5)"));
    let run = place.tigereye(&["run", "small.ron", "--out", "r"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(run.stdout.contains("1 failed") && run.stdout.contains("small: steps"), "{}", run.stdout);
    let summary = has_the_agreed_shape(&place, "r");
    assert_eq!(summary["passed"], false);
    assert_eq!(summary["experiments"][0]["passed"], false);
    assert_eq!(summary["experiments"][0]["checks"][0]["passed"], false);
}

#[test]
fn what_cannot_be_measured_fails() {
    let place = Place::new();
    let text =
        experiment("Near(3, 0)").replace("Steps(run: \"light\")", "RadiusMean(run: \"light\", step: 99999)");
    // A step that the run cannot reach is a fault of the file.
    place.write("small.ron", &text);
    place.refuses(
        &["run", "small.ron", "--out", "r"],
        &["check \"steps\"", "step 99999", "ends after 3 steps"],
    );
    // Whether it does by its rule shows when it runs.
    place.write("small.ron", text.replace("stop: Steps(3)", "stop: FluxChange(threshold: 0.5)"));
    let run = place.tigereye(&["run", "small.ron", "--out", "r"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(run.stdout.contains("before step 99999"), "{}", run.stdout);
    let page = String::from_utf8(place.read("r/index.html")).unwrap();
    assert!(page.contains("no value: the run ended after"), "the report says why");
    let summary = has_the_agreed_shape(&place, "r");
    assert_eq!(summary["passed"], false);
    let check = &summary["experiments"][0]["checks"][0];
    assert!(check["value"].is_null() && check["reason"].as_str().unwrap().contains("before step 99999"));
}

#[test]
fn a_folder_replaces_the_built_in_experiments() {
    let place = Place::new();
    place.write("mine/deep/small.ron", experiment("Near(3, 0)"));
    place.write("mine/notes.txt", "no experiment");
    let run = place.tigereye(&["reproduce", "--experiments", "mine", "--out", "r"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let summary = has_the_agreed_shape(&place, "r");
    let experiments = summary["experiments"].as_array().unwrap();
    assert_eq!(experiments.len(), 1);
    assert_eq!(experiments[0]["slug"], "small");
    let args = ["reproduce", "--experiments", "mine", "--only", "fig-3-1-emitters", "--out", "r"];
    place.refuses(&args, &["fig-3-1-emitters", "small"]);
}

#[test]
fn files_of_one_name_are_refused() {
    let place = Place::new();
    for path in ["a/small.ron", "b/small.ron"] {
        place.write(path, experiment("Near(3, 0)"));
    }
    place.refuses(
        &["run", "a/small.ron", "b/small.ron", "--out", "r"],
        &["a/small.ron", "b/small.ron", "rename"],
    );
    place.refuses(
        &["reproduce", "--experiments", ".", "--out", "r"],
        &["a/small.ron", "b/small.ron", "rename"],
    );
    place.refuses(&["run", "a/small.ron", "a/small.ron", "--out", "r"], &["a/small.ron"]);
}

#[test]
fn unknown_experiments_are_refused_with_the_known_ones() {
    let place = Place::new();
    place.refuses(&["reproduce", "--only", "fig-9-9", "--out", "r"], &["--only fig-9-9", "fig-3-1-emitters"]);
    let both = ["reproduce", "--only", "fig-3-1-emitters", "--only", "x", "--out", "r"];
    place.refuses(&both, &["--only x"]);
    // None is cut out of the middle, and a slip is recognised.
    place
        .refuses(&["reproduce", "--only", "fig-3-1-emiters"], &["did you mean `fig-3-1-emitters`", "--list"]);
    let run = place.tigereye(&["reproduce", "--only", "nothing"]);
    assert!(!run.stderr.contains("[..."), "{}", run.stderr);
}

/// The beginning of a name stands for all names with it, and a whole name for itself.
#[test]
fn experiments_are_listed_and_chosen_by_the_beginning_of_their_names() {
    let place = Place::new();
    let listed = |args: &[&str]| {
        let text = place.succeeds(&[&["reproduce", "--list"], args].concat()).stdout;
        text.lines().map(|l| l.split_whitespace().next().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert!(listed(&[]).len() > 50);
    assert_eq!(listed(&["--only", "fig-4-5"]), ["fig-4-5-star"]);
    assert_eq!(listed(&["--only", "fig-2"]).len(), 6);
    assert_eq!(listed(&["--only", "stationary", "--only", "stopping"]), ["stationary", "stopping"]);
    assert!(place.succeeds(&["reproduce", "--list"]).stdout.contains("Light in star (Thesis, Fig. 4.5)"));
    assert!(!place.path("results").exists());
    let small = |title: &str| {
        format!(
            r#"(format: 1, title: "{title}", source: "s", section: "x", claim: "c", look_for: "l", figures: [], checks: [])"#
        )
    };
    place.write("mine/a.ron", small("one"));
    place.write("mine/a-b.ron", small("two"));
    assert_eq!(listed(&["--experiments", "mine", "--only", "a"]), ["a"]);
    assert_eq!(listed(&["--experiments", "mine", "--only", "a-"]), ["a-b"]);
}

#[test]
fn files_of_another_kind_are_named() {
    let place = Place::new();
    place.write(
        "f.field.ron",
        r#"(format: 1, title: "t", field: Axes(width: 3, height: 3, phi: "0", s1: "1", s2: "1"))"#,
    );
    for command in ["check", "run"] {
        place.refuses(&[command, "f.field.ron"], &["f.field.ron: is a field file", "tigereye field show"]);
    }
    place.write("e.ron", r#"(format: 1, title: "t", source: "s", section: "x", claim: "c", look_for: "l", figures: [], checks: [])"#);
    place.refuses(
        &["field", "show", "e.ron", "-o", "e.png"],
        &["e.ron: is an experiment file", "tigereye run"],
    );
    place.refuses(&["ltg", "e.ron", "-o", "e.vti"], &["e.ron: is an experiment file"]);
}

#[test]
fn folders_without_experiments_are_refused() {
    let place = Place::new();
    std::fs::create_dir(place.path("empty")).unwrap();
    place.refuses(&["reproduce", "--experiments", "empty", "--out", "r"], &["empty", "*.ron"]);
    place.refuses(&["reproduce", "--experiments", "missing", "--out", "r"], &["missing", "No such file"]);
}

#[test]
fn results_cannot_be_a_file() {
    let place = Place::new();
    place.write("r", "a file");
    place.refuses(&["reproduce", "--only", "fig-3-1-emitters", "--out", "r"], &["r: ", "folder"]);
}

#[test]
fn check_runs_nothing_and_says_what_is_there() {
    let place = Place::new();
    place.write("small.ron", experiment("Near(4, 0)"));
    let before = place.files();
    let run = place.succeeds(&["check", "small.ron"]);
    assert_eq!(run.stdout, "small.ron: ok, 2 runs, 1 figure, 1 check\n");
    place.same_files(&before);
}

#[test]
fn faults_name_file_line_and_column() {
    let good = experiment("Near(3, 0)");
    for (from, to, words) in [
        ("format: 1", "format: 2", &["small.ron:3:5: ", "format 1"][..]),
        ("directions: 16", "directions: 12", &["small.ron:6:", "multiple of 8"]),
        ("stop: Steps(3)", "stop: FluxChange(threshold: -1)", &["small.ron:6:", "from 0"]),
        ("stop: Steps(3)", "stop: FluxChange(threshold: NaN)", &["small.ron:6:", "from 0"]),
        ("title: \"Small\"", "titel: \"Small\"", &["small.ron:3:", "titel", "title"]),
        (
            "field: \"f\", directions: 8",
            "field: \"g\", directions: 8",
            &["small.ron:7:37: ", "\"g\"", "expected one of f"],
        ),
        ("lights: [()]", "lights: [(cell: (7, 0))]", &["small.ron:6:9: ", "(7, 0)", "7 x 7"]),
        ("\"size\": 7", "\"sice\": 7", &["small.ron:4:", "`sice`", "size"]),
        (")\n", "", &["small.ron:"]),
    ] {
        let place = Place::new();
        place.write("small.ron", good.replacen(from, to, if from == ")\n" { 9 } else { 1 }));
        place.refuses(&["check", "small.ron"], words);
        place.refuses(&["run", "small.ron", "--out", "r"], words);
        place.refuses(&["reproduce", "--experiments", ".", "--out", "r"], words);
        assert!(!place.path("r").exists());
    }
}

#[test]
fn every_fault_of_every_file_is_a_message_of_its_own() {
    let place = Place::new();
    place.write(
        "a.ron",
        experiment("Near(3, 0)").replace("\"size\"", "\"sice\"").replace("run: \"light\"", "run: \"no\""),
    );
    place.write("b.ron", "nonsense");
    let before = place.files();
    let run = place.tigereye(&["run", "a.ron", "b.ron", "--out", "r"]);
    assert_eq!((run.code, run.stdout.as_str()), (2, ""));
    let lines: Vec<&str> = run.stderr.lines().collect();
    assert_eq!(lines.len(), 3, "{}", run.stderr);
    assert!(lines.iter().all(|l| l.starts_with("tigereye: ")), "{}", run.stderr);
    assert!(
        lines[0].contains("a.ron:4:") && lines[1].contains("a.ron:10:") && lines[2].contains("b.ron:1:1"),
        "{lines:?}"
    );
    place.same_files(&before);
    // A good file beside them is not run either.
    place.write("good.ron", experiment("Near(3, 0)"));
    assert_eq!(place.tigereye(&["run", "good.ron", "a.ron", "--out", "r"]).code, 2);
    assert!(!place.path("r").exists());
}

#[test]
fn unreadable_experiment_files_are_named() {
    let place = Place::new();
    place.write("latin.ron", b"(title: \"\xfc\")");
    place.write("empty.ron", "");
    std::fs::create_dir(place.path("folder.ron")).unwrap();
    for command in [&["check"][..], &["run", "--out", "r"]] {
        for (file, words) in [
            ("latin.ron", &["latin.ron", "byte 9", "UTF-8"][..]),
            ("empty.ron", &["empty.ron:1:1"]),
            ("folder.ron", &["folder.ron", "reading"]),
            ("missing.ron", &["missing.ron", "reading"]),
        ] {
            place.refuses(&[command, &[file]].concat(), words);
        }
    }
}

#[test]
fn nesting_without_end_is_refused() {
    let place = Place::new();
    for (name, open) in [("a.ron", "("), ("b.ron", "["), ("c.ron", "{"), ("d.ron", "Some("), ("e.ron", "/*")]
    {
        place.write(name, format!("(format: 1, title: {}", open.repeat(200_000)));
        place.refuses(&["check", name], &[name]);
    }
    let deviation = "Deviation(label: \"d\", from: \"x\", of: ".repeat(50_000);
    let panel =
        format!("panels: [Chart(x: (label: \"x\"), y: (label: \"y\"), title: \"t\", series: [{deviation}");
    place.write("f.ron", experiment("Near(3, 0)").replace("panels: [Glyphs", &panel));
    place.refuses(&["check", "f.ron"], &["f.ron:"]);
}

#[test]
fn data_files_are_found_beside_the_experiment_and_above() {
    let place = Place::new();
    let text = experiment("Near(3, 0)")
        .replace("Generator(name: \"inverse\", parameters: {\"size\": 7})", "File(path: \"data/f.txt\")");
    place.write("data/f.txt", crate::support::unit_text(5, 5));
    place.write("deep/er/small.ron", &text);
    let run = place.tigereye(&["run", "deep/er/small.ron", "--out", "r"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    place.write("data/f.txt", "1 0\n0 x\n");
    place.refuses(&["run", "deep/er/small.ron", "--out", "r2"], &["small.ron:4:", "line 2, column 3"]);
    std::fs::remove_file(place.path("data/f.txt")).unwrap();
    place.refuses(&["check", "deep/er/small.ron"], &["small.ron:4:", "no file data/f.txt"]);
}

#[test]
fn faults_of_data_files_name_the_file() {
    let place = Place::new();
    let text = experiment("Near(3, 0)")
        .replace("Generator(name: \"inverse\", parameters: {\"size\": 7})", "File(path: \"f.txt\")");
    place.write("small.ron", text);
    place.write("f.txt", "1 0\n0 x\n");
    place.refuses(&["check", "small.ron"], &["small.ron:4:", "f.txt", "line 2, column 3"]);
}

#[test]
fn the_command_to_redo_an_experiment_can_be_pasted_into_a_shell() {
    let place = Place::new();
    place.write("my files/it's small.ron", experiment("Near(3, 0)"));
    assert_eq!(place.tigereye(&["run", "my files/it's small.ron", "--out", "r"]).code, 0);
    let command = place.json("r/summary.json")["experiments"][0]["command"].as_str().unwrap().to_owned();
    assert_eq!(command, r"tigereye run 'my files/it'\''s small.ron' --out r");
    assert_eq!(place.tigereye(&["reproduce", "--experiments", "my files", "--out", "r"]).code, 0);
    let command = place.json("r/summary.json")["experiments"][0]["command"].as_str().unwrap().to_owned();
    assert!(
        command.contains("--experiments 'my files'") && command.contains(r"'it'\''s small'"),
        "{command}"
    );
}

#[test]
fn memory_too_small_for_an_experiment_is_refused() {
    let place = Place::new();
    place.write("small.ron", experiment("Near(3, 0)"));
    let before = place.files();
    let run = place.tigereye(&["run", "small.ron", "--out", "r", "--memory", "1K"]);
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.contains("gradient") && run.stderr.contains("needs at least"), "{}", run.stderr);
    place.same_files(&before);
}

#[test]
fn a_fault_of_a_later_experiment_keeps_the_earlier_report() {
    let place = Place::new();
    place.write("small.ron", experiment("Near(3, 0)"));
    assert_eq!(place.tigereye(&["run", "small.ron", "--out", "r"]).code, 0);
    place.write("small.ron", "nonsense");
    place.refuses(&["run", "small.ron", "--out", "r"], &["small.ron:1:1"]);
}

/// An experiment whose data are not part of the project is left out where they are missing, and nothing else fails.
#[test]
fn experiments_without_their_data_are_left_out() {
    let place = Place::new();
    let experiment = |needs: &str| {
        format!(
            "(format: 1, title: \"t\", source: \"s\", section: \"x\", claim: \"c\", look_for: \"l\", needs: [{needs}],\n\
             fields: {{\"f\": Generator(name: \"inverse\", parameters: {{\"size\": 5}})}},\n\
             figures: [], checks: [(name: \"n\", quantity: ZeroShare(field: \"f\"), expect: AtMost(0), basis: \"b\")])\n"
        )
    };
    place.write("lacking.ron", experiment("\"reference/none.vtp\""));
    place.write("whole.ron", experiment(""));
    let run = place.tigereye(&["run", "lacking.ron", "whole.ron", "--out", "r"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stderr.contains("skipped: lacking needs reference/none.vtp"), "{}", run.stderr);
    let summary: serde_json::Value = serde_json::from_slice(&place.read("r/summary.json")).unwrap();
    assert_eq!(summary["experiments"].as_array().unwrap().len(), 1);
    let page = String::from_utf8(place.read("r/index.html")).unwrap();
    assert!(page.contains("lacking (<code>reference/none.vtp</code>)"));
    place.refuses(&["run", "lacking.ron", "--out", "s"], &["no experiment is left to run"]);
    assert!(place.succeeds(&["check", "lacking.ron"]).stdout.contains("needs reference/none.vtp"));
}
