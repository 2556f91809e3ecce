//! Every fault in an experiment file is refused with its line, its column and what was expected.

use proptest::prelude::*;
use std::path::{Path, PathBuf};
use tigereye_experiments::{Host, Scope, SpecError, library, load, plan};

const FILE: &str = "folder/good.ron";

const GOOD: &str = r#"// Claim: this file is in order.
(
    format: 1,
    title: "Title",
    source: "Source",
    section: "1",
    claim: "A claim.",
    look_for: "Something.",
    fields: {
        "swirl": Generator(name: "rings", parameters: {"size": 9}),
        "formula": Axes(width: 5, height: 5, phi: "theta", s1: "2", s2: "1"),
    },
    runs: {
        "glow": Light(
            field: "swirl",
            directions: 16,
            normalization: LocalAbove(0.5),
            lights: [(cell: (4, 4), profile: Expression("1 + cos(theta)"))],
            stop: Steps(8),
            frames: [3, 8],
        ),
        "slope": Gradient(
            field: "formula",
            directions: 16,
            stop: FluxChange(threshold: 0.5),
            omega_step: Samples(2),
            slices_deg: [0, 45],
        ),
        "rest": Pulses(
            field: "formula",
            directions: 16,
            cells: [(2, 3), (1, 1)],
            angles_deg: [0, 67.5],
        ),
    },
    figures: [
        (
            name: "picture",
            caption: "Caption.",
            panels: [
                Overlay(run: "glow", step: 3, title: "a"),
                Slice(run: "slope", deg: 45, title: "b"),
                Glyphs(field: "swirl", title: "c"),
            ],
        ),
        (
            name: "curve",
            caption: "Caption.",
            panels: [
                Chart(
                    x: (label: "x"),
                    y: (label: "y"),
                    title: "d",
                    series: [
                        Formula(label: "e", expression: "x^2", range: (0, 1)),
                        PulsesOverColumn(label: "f", run: "rest", number: PlainSteps, deg: 67.5),
                    ],
                ),
            ],
        ),
    ],
    tables: [
        (title: "stillness", caption: "Caption.", rows: Pulses(runs: ["rest"])),
        (
            title: "times",
            caption: "Caption.",
            rows: Runtimes(rows: [(label: "g", cores: 64, published_s: 757, run: "slope"), (label: "h", cores: 1, published_s: 2)]),
        ),
    ],
    checks: [
        (name: "calm", quantity: OfPulses(runs: ["rest"], number: Settled, over: Least), expect: AtLeast(1), basis: "Basis."),
        (
            name: "steps",
            quantity: Steps(run: "glow"),
            expect: Near(8, 0),
            basis: "Basis.",
        ),
        (
            name: "axis",
            quantity: MajorAxisError(field: "formula", phi_deg: "theta"),
            expect: AtMost(360),
            basis: "Basis.",
        ),
    ],
)
"#;

/// A world without files.
fn nothing(path: &str) -> Result<Vec<u8>, String> {
    Err(format!("no file {path}"))
}

/// All faults of a text.
fn faults(text: &str, full: bool) -> Vec<SpecError> {
    match load(FILE, text) {
        Err(e) => vec![e],
        Ok(experiment) => plan(FILE, text, &experiment, full, &nothing).err().unwrap_or_default(),
    }
}

/// Line and column, from 1, of the first `part` in a text.
#[track_caller]
fn place_of(text: &str, part: &str) -> (usize, usize) {
    let at = text.find(part).unwrap_or_else(|| panic!("no {part} in the text"));
    let before = &text[..at];
    let line = before.matches('\n').count() + 1;
    (line, before.rsplit('\n').next().unwrap().chars().count() + 1)
}

/// The good file with `from` replaced by `to` has one fault. It lies in the line of `to`, at `culprit`
/// (a part of `to`) or the character before or after it: the parser stands on either side of what it refuses.
#[track_caller]
fn refused(from: &str, to: &str, culprit: &str, words: &[&str]) {
    assert_eq!(GOOD.matches(from).count(), 1, "{from} must stand once in the good file");
    let text = GOOD.replace(from, to);
    let found = faults(&text, true);
    let [fault] = found.as_slice() else { panic!("{to}: expected one fault, found {found:#?}") };
    assert_eq!(fault.file, FILE);
    for word in words {
        assert!(fault.problem.contains(word), "{to}: `{}` does not say `{word}`", fault.problem);
    }
    let (line, column) = place_of(&text, to);
    let offset = to.find(culprit).unwrap();
    let line = line + to[..offset].matches('\n').count();
    let column = match to[..offset].rsplit_once('\n') {
        Some((_, last)) => last.chars().count() + 1,
        None => column + to[..offset].chars().count(),
    };
    let columns = column - 1..=column + culprit.chars().count() + 1;
    assert!(
        fault.line == line && columns.contains(&fault.column),
        "{to}: placed at {}:{}, expected line {line}, columns {columns:?}: {}",
        fault.line,
        fault.column,
        fault.problem
    );
}

#[test]
fn the_good_file_is_good() {
    assert_eq!(faults(GOOD, true), []);
    assert_eq!(faults(GOOD, false), []);
}

#[test]
fn unknown_keys() {
    refused("title: \"Title\"", "titel: \"Title\"", "titel", &["titel", "title"]);
    refused("omega_step", "omega", "omega", &["`omega`", "omega_step"]);
    refused("deg: 45,", "degrees: 45,", "degrees", &["degrees", "deg"]);
    refused(
        "basis: \"Basis.\",\n        ),\n        (",
        "why: \"Basis.\",\n        ),\n        (",
        "why",
        &["why", "basis"],
    );
}

#[test]
fn missing_keys() {
    // Only at its end does the parser know that something was left out.
    let text = GOOD.replace("    claim: \"A claim.\",\n", "");
    let found = faults(&text, true);
    assert_eq!(found.len(), 1);
    assert!(found[0].problem.contains("claim"), "{}", found[0]);
    let text = GOOD.replace("width: 5, ", "");
    let found = faults(&text, true);
    assert_eq!((found.len(), found[0].line), (1, 11), "{found:#?}");
    assert!(found[0].problem.contains("the key `width` is missing in `Axes`"), "{}", found[0]);
}

#[test]
fn wrong_types() {
    refused("format: 1", "format: \"one\"", "\"one\"", &["expected a whole number"]);
    refused("title: \"Title\"", "title: 5", "5", &["expected text in quotes"]);
    // The parser's own sentences start with a capital.
    refused("cell: (4, 4)", "cell: (4, 4.5)", "4.5", &["xpected"]);
    refused("frames: [3, 8]", "frames: 3", "3", &["expected a list"]);
    refused("{\"size\": 9}", "[\"size\", 9]", "[", &["expected names with values"]);
    refused("{\"size\": 9}", "{\"size\": [9]}", "[9]", &["expected a number, true, false or a string"]);
}

#[test]
fn numbers_out_of_range() {
    refused("threshold: 0.5", "threshold: NaN", "NaN", &["NaN", "finite number from 0"]);
    refused("threshold: 0.5", "threshold: inf", "inf", &["inf", "finite number from 0"]);
    refused("threshold: 0.5", "threshold: -0.5", "-0.5", &["-0.5", "finite number from 0"]);
    refused("LocalAbove(0.5)", "LocalAbove(2)", "2", &["2", "from 0 to 1"]);
    refused("LocalAbove(0.5)", "LocalAbove(-inf)", "-inf", &["-inf", "from 0 to 1"]);
    refused("slices_deg: [0, 45]", "slices_deg: [0, NaN]", "NaN", &["NaN", "finite"]);
    refused("deg: 45,", "deg: inf,", "inf", &["inf", "finite"]);
    refused("Near(8, 0)", "Near(NaN, 0)", "NaN", &["NaN", "finite"]);
    refused("Near(8, 0)", "Near(8, -1)", "-1", &["-1", "from 0"]);
    refused("AtMost(360)", "AtMost(inf)", "inf", &["inf", "finite"]);
}

#[test]
fn directions_are_multiples_of_8() {
    let at = "\"swirl\",\n            directions: ";
    for (bad, says) in [("12", "12"), ("0", "0"), ("7208", "7208")] {
        refused(&format!("{at}16"), &format!("{at}{bad}"), bad, &[says, "a multiple of 8 from 8"]);
    }
}

#[test]
fn integers_out_of_bounds_say_what_was_expected() {
    refused("cell: (4, 4)", "cell: (4, -4)", "-4", &["xpected"]);
    refused("stop: Steps(8)", "stop: Steps(-8)", "-8", &["xpected"]);
}

#[test]
fn unknown_variants() {
    refused("Steps(8)", "Step(8)", "Step", &["Step", "Steps"]);
    refused("Near(8, 0)", "About(8, 0)", "About", &["About", "Near"]);
    refused("Glyphs(", "Arrows(", "Arrows", &["Arrows", "Glyphs"]);
    refused("Steps(run: \"glow\")", "Strides(run: \"glow\")", "Strides", &["Strides", "Steps"]);
    refused("\"slope\": Gradient(", "\"slope\": Slope(", "Slope", &["Slope", "Gradient"]);
}

#[test]
fn unknown_formats() {
    refused("format: 1", "format: 2", "format", &["format 2", "reads format 1"]);
}

#[test]
fn unknown_names() {
    refused(
        "field: \"swirl\",\n",
        "field: \"whirl\",\n",
        "\"whirl\"",
        &["run \"glow\"", "\"whirl\"", "swirl, formula"],
    );
    refused(
        "Overlay(run: \"glow\"",
        "Overlay(run: \"glov\"",
        "\"glov\"",
        &["figure \"picture\"", "glow, slope"],
    );
    refused("Steps(run: \"glow\")", "Steps(run: \"glov\")", "\"glov\"", &["check \"steps\"", "glow, slope"]);
    refused(
        "Glyphs(field: \"swirl\"",
        "Glyphs(field: \"sw\"",
        "\"sw\"",
        &["figure \"picture\"", "swirl, formula"],
    );
    refused(
        "(field: \"formula\", phi",
        "(field: \"for\", phi",
        "\"for\"",
        &["check \"axis\"", "swirl, formula"],
    );
}

#[test]
fn gradients_are_no_lights() {
    for (from, to, words) in [
        (
            "Overlay(run: \"glow\", step: 3",
            "Overlay(run: \"slope\"",
            ["figure \"picture\"", "\"slope\"", "Light"],
        ),
        ("Slice(run: \"slope\"", "Slice(run: \"glow\"", ["figure \"picture\"", "\"glow\"", "Gradient"]),
        ("Steps(run: \"glow\")", "Steps(run: \"slope\")", ["check \"steps\"", "\"slope\"", "Light"]),
    ] {
        let found = faults(&GOOD.replace(from, to), true);
        assert_eq!(found.len(), 1, "{found:#?}");
        assert!(words.iter().all(|w| found[0].problem.contains(w)), "{to}: {}", found[0]);
    }
}

#[test]
fn a_run_of_the_wrong_kind_is_a_fault_of_its_user() {
    let words = ["figure \"picture\"", "\"slope\"", "Light"];
    refused("Overlay(run: \"glow\", step: 3", "Overlay(run: \"slope\"", "\"slope\"", &words);
}

#[test]
fn lights_stand_in_the_field() {
    let run = "\"glow\": Light(\n            field: \"swirl\",\n            directions: 16,\n            normalization: LocalAbove(0.5),\n            lights: [(cell: (4, 4)";
    let outside = run.replace("(4, 4)", "(9, 4)");
    refused(run, &outside, "\"glow\"", &["run \"glow\"", "(9, 4)", "9 x 9"]);
}

/// Faults of the good file with other lights.
#[track_caller]
fn lit(lights: &str) -> Vec<SpecError> {
    let text = GOOD.replace("(cell: (4, 4), profile: Expression(\"1 + cos(theta)\"))", lights);
    let found = faults(&text, true);
    assert!(!found.is_empty(), "{lights}");
    // A formula has a place of its own.
    let place = if lights.contains('$') { "$" } else { "\"glow\"" };
    assert_eq!((found[0].line, found[0].column), place_of(&text, place), "{}", found[0]);
    found
}

#[test]
fn lights_shine() {
    for (lights, words) in [
        ("", &["no light"][..]),
        ("(), ()", &["two lights at (4, 4)"]),
        ("(profile: Expression(\"0\"))", &["(4, 4)", "0 in every direction"]),
        ("(profile: Expression(\"sin(theta) $\"))", &["(4, 4)", "unknown character"]),
        ("(profile: Expression(\"1/0\"))", &["(4, 4)", "finite"]),
        ("(profile: Pulse(theta_deg: 10))", &["10 degrees", "multiple of 22.5"]),
    ] {
        let found = lit(lights);
        let says = |w: &&str| found[0].problem.contains(*w);
        assert!(words.iter().chain(&["run \"glow\""]).all(says), "{lights}: {}", found[0]);
    }
}

#[test]
fn one_bad_light_is_one_fault() {
    let found = lit("(profile: Expression(\"sin($\"))");
    assert_eq!(found.len(), 1, "{found:#?}");
}

#[test]
fn slices_are_samples() {
    let text = GOOD.replace("slices_deg: [0, 45]", "slices_deg: [0, 45, 50]");
    let found = faults(&text, true);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!((found[0].line, found[0].column), place_of(&text, "\"slope\""));
    assert!(found[0].problem.contains("50 degrees is no sample of 16"), "{}", found[0]);
}

#[test]
fn angular_steps_are_from_1_to_half_the_samples() {
    for k in ["0", "9", "18446744073709551615"] {
        let text = GOOD.replace("Samples(2)", &format!("Samples({k})"));
        let found = faults(&text, true);
        assert_eq!(found.len(), 1, "{found:#?}");
        assert_eq!((found[0].line, found[0].column), place_of(&text, "\"slope\""));
        assert!(found[0].problem.contains(&format!("step {k}: expected 1 to 8")), "{}", found[0]);
    }
}

#[test]
fn pulses_start_from_cells_and_samples_that_exist() {
    for (from, to, words) in [
        ("(2, 3), (1, 1)", "(2, 5)", &["(2, 5) lies outside of the 5 x 5 cells"][..]),
        ("(2, 3), (1, 1)", "(2, 3), (1, 1), (2, 3)", &["(2, 3) stands twice"]),
        ("(2, 3), (1, 1)", "", &["no pulse", "cells and angles"]),
        ("[0, 67.5]", "[]", &["no pulse", "cells and angles"]),
        ("[0, 67.5]", "[67.5, 60]", &["60 degrees is no sample of 16"]),
        ("[0, 67.5]", "[0, 67.5, 360]", &["360 degrees is listed twice"]),
    ] {
        let text = GOOD.replace(from, to);
        let found = faults(&text, true);
        assert_eq!(found.len(), 1, "{to}: {found:#?}");
        assert_eq!((found[0].line, found[0].column), place_of(&text, "\"rest\""), "{}", found[0]);
        let says = |w: &&str| found[0].problem.contains(*w);
        assert!(words.iter().chain(&["run \"rest\""]).all(says), "{to}: {}", found[0]);
    }
}

#[test]
fn users_of_pulses_name_pulses() {
    let words = ["check \"calm\"", "\"glow\"", "Pulses"];
    refused("OfPulses(runs: [\"rest\"]", "OfPulses(runs: [\"glow\"]", "\"glow\"", &words);
    refused(
        "rows: Pulses(runs: [\"rest\"])",
        "rows: Pulses(runs: [\"slope\"])",
        "\"slope\"",
        &["table \"stillness\"", "Pulses"],
    );
    refused("number: Settled", "number: Settle", "Settle", &["Settle", "Settled"]);
    refused("deg: 67.5", "deg: 45.0", "deg: 45", &["figure \"curve\"", "no pulse of \"rest\""]);
}

#[test]
fn tables_name_runs_and_times_that_can_be() {
    refused("run: \"slope\"), (", "run: \"slop\"), (", "\"slop\"", &["table \"times\"", "glow, slope"]);
    refused(
        "rows: Pulses(runs: [\"rest\"])",
        "rows: Pulses(runs: [\"nest\"])",
        "\"nest\"",
        &["table \"stillness\"", "glow, slope"],
    );
    refused("published_s: 757", "published_s: 0", "0", &["above 0"]);
    refused("cores: 64", "core: 64", "core", &["core", "cores"]);
}

#[test]
fn gradients_are_compared_over_the_same_slices() {
    let other =
        "\"other\": Gradient(field: \"formula\", directions: 16, slices_deg: [SLICES]), \"rest\": Pulses(";
    let compared = |slices: &str| {
        GOOD.replace("\"rest\": Pulses(", &other.replace("SLICES", slices))
            .replace("Steps(run: \"glow\")", "GradientDifference(run: \"slope\", from: \"other\")")
    };
    assert_eq!(faults(&compared("45, 0"), true), []);
    let text = compared("45");
    let found = faults(&text, true);
    assert_eq!(found.len(), 1, "{found:#?}");
    let (line, column) = place_of(&text, "from: \"other\"");
    assert_eq!((found[0].line, found[0].column), (line, column + "from: ".len()));
    assert!(found[0].problem.contains("differ in cells, directions or slices"), "{}", found[0]);
}

#[test]
fn rows_of_another_scope_are_left_out_but_missing_times_are_told() {
    let text = GOOD
        .replace("angles_deg: [0, 67.5],", "angles_deg: [0, 67.5], scope: Full,")
        .replace("slices_deg: [0, 45],", "slices_deg: [0, 45], scope: Full,");
    let tables = |full| {
        let experiment = load(FILE, &text).unwrap();
        let plan = plan(FILE, &text, &experiment, full, &nothing).ok().unwrap();
        plan.tables().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(
        (tables(true), tables(false)),
        (vec!["stillness".into(), "times".into()], vec!["times".into()])
    );
}

#[test]
fn names_stand_once() {
    refused("\"formula\": Axes", "\"swirl\": Axes", "\"swirl\"", &["\"swirl\"", "twice"]);
    refused("\"slope\": Gradient(", "\"glow\": Gradient(", "\"glow\"", &["\"glow\"", "twice"]);
    refused("{\"size\": 9}", "{\"size\": 9, \"size\": 8}", "\"size\": 8", &["\"size\"", "twice"]);
    refused("title: \"Title\"", "title: \"Title\", title: \"Title\"", "title: \"Title\", title", &["title"]);
}

#[test]
fn figures_have_names_of_their_own() {
    let text = GOOD.replace("name: \"curve\"", "name: \"picture\"");
    let found = faults(&text, true);
    let [fault] = &found[..] else { panic!("expected one fault, found {found:#?}") };
    assert!(fault.problem.contains("two figures are called \"picture\""), "{fault}");
    // It is the second that is one too many.
    let (first, second) = (text.find("\"picture\"").unwrap(), text.rfind("\"picture\"").unwrap());
    assert!(first < second && fault.line == text[..second].matches('\n').count() + 1, "{fault}");
}

#[test]
fn figure_names_are_file_names() {
    for bad in ["../evil", "a b", "", "a/b", "\u{fc}"] {
        refused(
            "name: \"curve\"",
            &format!("name: \"{bad}\""),
            &format!("\"{bad}\""),
            &["expected letters, digits"],
        );
    }
}

#[test]
fn kept_steps_come_before_the_end() {
    let text = GOOD.replace("frames: [3, 8]", "frames: [3, 9]");
    let found = faults(&text, true);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!((found[0].line, found[0].column), place_of(&text, "\"glow\""));
    assert!(found[0].problem.contains("step 9 but ends after 8 steps"), "{}", found[0]);
}

#[test]
fn panels_show_steps_that_there_are() {
    // Steps that are shown are kept, whatever the run says.
    assert_eq!(faults(&GOOD.replace("step: 3,", "step: 5,"), true), []);
    refused("step: 3,", "step: 9,", "step: 9", &["figure \"picture\"", "step 9", "ends after 8 steps"]);
}

#[test]
fn panels_show_slices_that_are_computed() {
    refused(
        "Slice(run: \"slope\", deg: 45",
        "Slice(run: \"slope\", deg: 90",
        "deg: 90",
        &["figure \"picture\"", "90"],
    );
    refused(
        "Slice(run: \"slope\", deg: 45",
        "Slice(run: \"slope\", deg: 50",
        "deg: 50",
        &["figure \"picture\"", "50"],
    );
}

#[test]
fn generators_and_their_parameters() {
    for (from, to, words) in [
        ("name: \"rings\"", "name: \"ringz\"", &["`ringz`", "`rings`"][..]),
        ("\"size\": 9", "\"sice\": 9", &["`sice`", "expected size"]),
        ("\"size\": 9", "\"size\": 0", &["`0`", "integer from 1"]),
        ("\"size\": 9", "\"size\": NaN", &["NaN", "integer from 1"]),
        ("\"size\": 9", "\"size\": 1e300", &["integer from 1"]),
        ("\"size\": 9", "\"size\": \"nine\"", &["`nine`", "integer from 1"]),
        ("\"size\": 9", "\"total\": 2", &["`total`", "true or false"]),
    ] {
        let text = GOOD.replace(from, to);
        let found = faults(&text, true);
        assert_eq!((found[0].line, found[0].column), place_of(&text, "\"swirl\""), "{}", found[0]);
        let says = |w: &&str| found[0].problem.contains(*w);
        assert!(words.iter().chain(&["field \"swirl\""]).all(says), "{to}: {}", found[0]);
    }
}

#[test]
fn expressions() {
    for (from, to, at, words) in [
        ("phi: \"theta\"", "phi: \"thet\"", "thet\"", &["`phi`", "`theta`"][..]),
        ("s1: \"2\"", "s1: \"2 +\"", "\", s2", &["`s1`", "expected"]),
        ("s2: \"1\"", "s2: \"-1\"", "\"-1\"", &["`s2`", "cell (0, 0)", "at least 0"]),
        ("s2: \"1\"", "s2: \"1/x^2\"", "\"1/x^2\"", &["`s2`", "cell (2, 0)", "finite"]),
        ("s2: \"1\"", "s2: \"\"", "\"),\n    },\n    runs", &["`s2`"]),
        ("width: 5", "width: 0", "\"formula\"", &["0 x 5"]),
        ("width: 5", "width: 18446744073709551615", "\"formula\"", &["18446744073709551615 x 5"]),
    ] {
        let text = GOOD.replace(from, to);
        let found = faults(&text, true);
        let [fault] = found.as_slice() else { panic!("{to}: expected one fault, found {found:#?}") };
        assert_eq!((fault.line, fault.column), place_of(&text, at), "{fault}");
        assert!(!fault.problem.contains("line 1"), "two places: {fault}");
        assert!(
            words.iter().chain(&["field \"formula\""]).all(|w| fault.problem.contains(w)),
            "{to}: {fault}"
        );
    }
}

#[test]
fn expressions_of_figures_and_checks() {
    refused(
        "expression: \"x^2\"",
        "expression: \"y^2\"",
        "y^2\"",
        &["figure \"curve\"", "`y^2`: unknown name"],
    );
    refused("phi_deg: \"theta\"", "phi_deg: \"thet\"", "thet\"", &["check \"axis\"", "`thet`: unknown name"]);
}

#[test]
fn missing_files() {
    let text =
        GOOD.replace("Generator(name: \"rings\", parameters: {\"size\": 9})", "File(path: \"no.txt\")");
    let found = faults(&text, true);
    assert_eq!((found[0].line, found[0].column), place_of(&text, "\"swirl\""));
    assert!(found[0].problem.contains("no file no.txt"), "{}", found[0]);
}

#[test]
fn several_faults_are_reported_at_once() {
    let text = GOOD
        .replace("\"size\": 9", "\"sice\": 9")
        .replace("s1: \"2\"", "s1: \"2 +\"")
        .replace("Samples(2)", "Samples(99)")
        .replace("Overlay(run: \"glow\"", "Overlay(run: \"none\"")
        .replace("name: \"curve\"", "name: \"picture\"");
    let found = faults(&text, true);
    let said: Vec<String> = found.iter().map(|f| f.problem.clone()).collect();
    for part in ["`sice`", "`s1`", "\"none\"", "two figures"] {
        assert_eq!(said.iter().filter(|s| s.contains(part)).count(), 1, "{part}: {said:#?}");
    }
}

#[test]
fn a_fault_is_placed_by_its_section_not_by_an_equal_name_above() {
    // The run bears its field's name.
    let text = GOOD.replace("\"glow\"", "\"swirl\"").replace("(4, 4)", "(9, 4)");
    let found = faults(&text, true);
    assert_eq!((found[0].line, found[0].column), place_of(&text, "\"swirl\": Light"), "{}", found[0]);
    // A comment behind a line mentions the name first.
    let text =
        GOOD.replace("title: \"Title\",", "title: \"Title\", // see \"glow\"").replace("(4, 4)", "(9, 4)");
    let found = faults(&text, true);
    assert_eq!((found[0].line, found[0].column), place_of(&text, "\"glow\": Light"), "{}", found[0]);
}

#[test]
fn columns_count_characters() {
    let text = GOOD.replace("title: \"Title\",", "title: \"\u{1f98a}\u{fc}\", titel: 1,");
    let found = faults(&text, true);
    let (line, column) = place_of(&text, "titel");
    assert_eq!(found[0].line, line);
    assert!((column..=column + 6).contains(&found[0].column), "{} instead of {column}", found[0]);
}

#[test]
fn faults_of_runs_are_found_in_every_scope() {
    let text = GOOD
        .replace("frames: [3, 8],", "frames: [3, 8], scope: Full,")
        .replace("slices_deg: [0, 45],", "slices_deg: [0, 45], scope: Full,");
    assert_eq!(faults(&text, false), []);
    let text = text.replace("Samples(2)", "Samples(0)");
    assert_eq!(faults(&text, false).len(), 1);
}

#[test]
fn a_text_that_is_no_experiment_is_refused() {
    for text in
        ["", " ", "(", ")", "nonsense", "()", "[]", "{}", "1", "\u{0}", "\u{feff}", "(format: 1)", "// only"]
    {
        let found = faults(text, true);
        assert_eq!(found.len(), 1, "{text:?}");
        assert!(found[0].line >= 1 && found[0].column >= 1 && !found[0].problem.is_empty(), "{text:?}");
    }
}

#[test]
fn nesting_without_end_is_refused() {
    let deviation = "Deviation(label: \"d\", from: \"x\", of: ".repeat(20_000);
    for text in [
        "(".repeat(100_000),
        "[".repeat(100_000),
        format!("(format: 1, title: {}", "Some(".repeat(100_000)),
        GOOD.replace("\"size\": 9", &format!("\"size\": {}", "[".repeat(100_000))),
        GOOD.replace("Formula(", &format!("{deviation}Formula(")),
        GOOD.replace("\"theta\", s1", &format!("\"{}\", s1", "(".repeat(100_000))),
    ] {
        assert_eq!(faults(&text, true).len(), 1);
    }
}

#[test]
fn messages_are_short_whatever_the_file_holds() {
    let long = "1+".repeat(100_000);
    for text in [
        GOOD.replace("phi: \"theta\"", &format!("phi: \"{long}\"")),
        GOOD.replace("1 + cos(theta)", &long),
        GOOD.replace("name: \"rings\"", &format!("name: \"{long}\"")),
    ] {
        for fault in faults(&text, true) {
            assert!(fault.problem.len() < 2000, "a message of {} bytes", fault.problem.len());
        }
    }
}

/// Every file below `experiments/`.
fn experiment_files() -> Vec<PathBuf> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../../experiments")];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if library::is_experiment(&path.to_string_lossy()) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The project's own data: beside the file, above it, and among what the program carries.
fn around(folder: &Path) -> impl Host {
    move |path: &str| {
        let found = folder.ancestors().take(4).find_map(|above| std::fs::read(above.join(path)).ok());
        found.or_else(|| library::data(path).map(<[u8]>::to_vec)).ok_or_else(|| format!("no file {path}"))
    }
}

#[test]
fn every_experiment_has_a_header_a_check_and_a_figure() {
    let files = experiment_files();
    assert!(files.len() >= 20, "{} experiments", files.len());
    let mut problems = Vec::new();
    for path in files {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(&path).unwrap();
        if !text.starts_with("//") {
            problems.push(format!("{name}: no header comment"));
        }
        for full in [true, false] {
            let host = around(path.parent().unwrap());
            let experiment = load(&name, &text).map_err(|e| vec![e]);
            // The snapshots resolve those whose data are not part of the project, where these are there.
            if experiment.as_ref().is_ok_and(|e| e.needs.iter().any(|file| !host.has(file))) {
                continue;
            }
            match experiment.and_then(|e| plan(&name, &text, &e, full, &host)) {
                Err(faults) => problems.extend(faults.iter().map(ToString::to_string)),
                Ok(s) => {
                    let always = full || s.scope == Scope::Always;
                    if always && s.figures().next().is_none() {
                        problems.push(format!("{name}: no figure with full: {full}"));
                    }
                    if always && s.checks().next().is_none() {
                        problems.push(format!("{name}: no check with full: {full}"));
                    }
                }
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// Pieces that a random byte would hardly hit.
const PIECES: [&str; 16] = [
    "NaN",
    "inf",
    "-1",
    "0",
    "18446744073709551615",
    "1e999",
    "()",
    "[]",
    "{}",
    "\"\"",
    "None",
    "Some(",
    "/*",
    "\u{1f98a}",
    "Full",
    "\\",
];

fn edited(edits: &[(usize, usize, u8, usize)]) -> String {
    let mut bytes = GOOD.as_bytes().to_vec();
    for &(kind, at, byte, piece) in edits {
        let at = at % bytes.len().max(1);
        match kind {
            0 => bytes.insert(at, byte),
            1 if !bytes.is_empty() => _ = bytes.remove(at),
            2 if !bytes.is_empty() => bytes[at] = byte,
            3 => bytes.truncate(at),
            _ => _ = bytes.splice(at..at, PIECES[piece % PIECES.len()].bytes()),
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_edits_never_panic_and_faults_lie_in_the_file(
        // Cutting the file off is rare: it leaves little to look at.
        edits in prop::collection::vec((prop_oneof![8 => 0_usize..3, 1 => 3_usize..4, 8 => 4_usize..5], 0..GOOD.len(), any::<u8>(), any::<usize>()), 1..6)
    ) {
        let text = edited(&edits);
        let lines = text.lines().count().max(1) + 1;
        for full in [true, false] {
            for fault in faults(&text, full) {
                prop_assert!((1..=lines).contains(&fault.line), "{}", fault);
                prop_assert!(fault.column >= 1 && !fault.problem.is_empty(), "{}", fault);
            }
        }
    }

    #[test]
    fn one_edited_digit_or_word_never_panics(
        at in 0..GOOD.len(), piece in 0..PIECES.len()
    ) {
        // The word or number around a position, exchanged as a whole.
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
        let start = GOOD[..at].rfind(|c| !plain(c)).map_or(0, |i| i + 1);
        let end = GOOD[at..].find(|c| !plain(c)).map_or(GOOD.len(), |i| at + i);
        let text = format!("{}{}{}", &GOOD[..start], PIECES[piece], &GOOD[end.max(start)..]);
        for full in [true, false] {
            for fault in faults(&text, full) {
                prop_assert!(fault.line >= 1 && fault.column >= 1, "{}", fault);
            }
        }
    }
}
