//! Linear scattering: its light, its exact and estimated gradients, importance, and what is refused.

use crate::support::{Place, has_keys};
use serde_json::Value;
#[cfg(unix)]
use std::process::Command;
use tigereye_core::math;
#[cfg(unix)]
use tigereye_io::ImageData;
use tigereye_io::{ScalarType, npy};
#[cfg(unix)]
use tigereye_test_support::eventually;

/// A gradient that is over at once.
const SHORT: [&str; 6] = ["ltg", "random:width=9,height=8", "--directions", "16", "--scattering", "linear"];
/// The same estimated, in four batches, the last of them not whole.
const SKETCHED: [&str; 10] = [
    "ltg",
    "random:width=9,height=8",
    "--directions",
    "16",
    "--scattering",
    "linear",
    "--estimate",
    "100",
    "--seed",
    "7",
];
/// Light that superposes.
const LIGHT: [&str; 6] =
    ["propagate", "random:width=9,height=8", "--directions", "16", "--scattering", "linear"];

const WALLED: &str = r#"(
    format: 1,
    title: "A wall",
    width: 9,
    height: 8,
    parts: [(shape: Segment(from: (4, 1), to: (4, 5)), material: Mirror())],
    lights: [(cell: (2, 3))],
)"#;

/// Mirrors all around.
const CLOSED: &str = r#"(
    format: 1,
    title: "A closed room",
    width: 8,
    height: 8,
    parts: [(shape: Outline(of: Rectangle(from: (1, 1), to: (6, 6))), material: Mirror())],
    lights: [(cell: (3, 3))],
)"#;

fn with<'a>(args: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [args, more].concat()
}

/// Errors of an estimate make crests of their own.
#[test]
fn ridges_of_estimates_are_warned_of() {
    let place = Place::new();
    let overlaid = ["--overlay", "ridges", "-o", "g.png"];
    place.says(&with(&SKETCHED, &overlaid), "ridges of an estimate follow its errors");
    place.succeeds(&with(&SHORT, &overlaid));
}

fn array(place: &Place, name: &str) -> Vec<f64> {
    npy::read_array(&place.read(name)).unwrap_or_else(|e| panic!("{name}: {e}")).values
}

fn story(place: &Place, name: &str) -> Value {
    serde_json::from_str(place.image(name).text("tigereye").unwrap()).unwrap()
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64], relative: f64) {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let off = found.iter().zip(expected).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    assert!(off <= relative * largest, "off by {off:e} of {largest:e}");
}

#[test]
fn options_of_other_methods_are_refused() {
    let place = Place::new();
    let joint = &SHORT[..4];
    for (args, more, words) in [
        (joint, &["--estimate", "64"][..], &["--estimate", "expected --scattering linear"][..]),
        (joint, &["--error", "5%"], &["--error", "expected --scattering linear"]),
        (joint, &["--seed", "1"], &["--seed", "expected --estimate N or --error P%"]),
        (joint, &["--preview", "p.vti"], &["--preview", "expected --estimate N or --error P%"]),
        (&SHORT, &["--seed", "1"], &["--seed", "expected --estimate N or --error P%"]),
        (&SHORT, &["--preview", "p.vti"], &["--preview", "expected --estimate N or --error P%"]),
        (&SHORT, &["--stop", "flux"], &["--stop flux", "expected --stop stationary"]),
        (&SHORT, &["--stop", "distribution"], &["--stop distribution", "expected --stop stationary"]),
        (&SKETCHED, &["--stop", "flux"], &["--stop flux", "expected --stop stationary"]),
        (&SKETCHED, &["--precision", "f64"], &["--precision", "expected f32"]),
        (&SKETCHED, &["--error", "5%"], &["--error", "--estimate"]),
        (&SHORT, &["--error", "5%", "--shard", "0/2"], &["--error", "--shard"]),
        (&SHORT, &["--error", "5%", "--checkpoint", "c"], &["--error", "--checkpoint"]),
        (joint, &["--scattering", "sideways"], &["--scattering", "joint", "linear"]),
    ] {
        place.refuses(&[args, more, &["-o", "a.vti"]].concat(), words);
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    let place = Place::new();
    for (more, words) in [
        (&["--estimate", "15"][..], &["--estimate", "expected 16 to 1048576"][..]),
        (&["--estimate", "0"], &["--estimate", "expected 16 to 1048576"]),
        (&["--estimate", "-64"], &["--estimate", "expected 16 to 1048576"]),
        (&["--estimate", "1048577"], &["--estimate", "expected 16 to 1048576"]),
        (&["--estimate", "many"], &["--estimate", "expected 16 to 1048576"]),
        (&["--estimate", "64", "--seed", "-1"], &["--seed", "expected 0 to 9007199254740991"]),
        (&["--estimate", "64", "--seed", "9007199254740992"], &["--seed", "9007199254740991"]),
        (&["--estimate", "64", "--seed", "x"], &["--seed", "expected 0 to 9007199254740991"]),
        (&["--error", "0"], &["--error", "expected a percentage from 0.2% to 50%"]),
        (&["--error", "51%"], &["--error", "expected a percentage"]),
        (&["--error", "-5%"], &["--error", "expected a percentage"]),
        (&["--error", "few"], &["--error", "expected a percentage"]),
        (&["--error", "nan"], &["--error", "expected a percentage"]),
        (&["--estimate", "64", "--memory", "1K"], &["--memory", "bytes"]),
        (&["--memory", "1K"], &["--memory", "bytes"]),
        (&["--estimate", "64", "--slices", "16"], &["--slices", "16"]),
        (&["--estimate", "64", "--omega-step", "9"], &["--omega-step", "9"]),
    ] {
        place.refuses(&[&SHORT[..], more, &["-o", "a.vti"]].concat(), words);
    }
}

#[test]
fn previews_must_have_a_place_of_their_own() {
    let place = Place::new();
    place.write("own.npy", npy::write_array(&[5, 5, 2, 2], &[1.0; 100]).unwrap());
    for (preview, words) in [
        ("a.vti", &["a.vti", "named twice"][..]),
        ("p.part", &["p.part", "expected .vti"]),
        ("p", &["p", "expected .vti"]),
        ("nowhere/p.vti", &["nowhere/p.vti"]),
    ] {
        place.refuses(&with(&SKETCHED, &["--preview", preview, "-o", "a.vti"]), words);
    }
    let args = ["ltg", "own.npy", "--scattering", "linear", "--estimate", "64"];
    place.refuses(&with(&args, &["--preview", "own.npy", "-o", "a.vti"]), &["own.npy"]);
}

#[test]
fn light_that_cannot_leave_has_no_gradient() {
    let place = Place::new();
    place.write("closed.scene.ron", CLOSED);
    let args = ["ltg", "closed.scene.ron", "--directions", "16", "--scattering", "linear", "-o", "a.vti"];
    let words = ["--scattering linear", "light is trapped around (", "expected"];
    place.refuses(&args, &words);
    place.refuses(&with(&args, &["--estimate", "64"]), &words);
    let args = ["propagate", "closed.scene.ron", "--directions", "16", "--scattering", "linear"];
    place.refuses(&with(&args, &["-o", "a.vti"]), &["did not become stationary", "expected"]);
    place.refuses(
        &with(&args, &["--towards", "3,3", "-o", "a.vti"]),
        &["closed.scene.ron", "did not become stationary", "expected"],
    );
}

#[test]
fn exact_gradients_are_written_and_said_to_be_linear() {
    let place = Place::new();
    let summary = place.succeeds(&with(&SHORT, &["--json", "-o", "a.vti", "a.npy", "a.png", "a.svg"])).json();
    has_keys(&summary, &["width", "height", "sources", "limited", "seconds", "max", "mean", "precision"]);
    assert_eq!((&summary["precision"], &summary["limited"]), (&"f64".into(), &0.into()));
    let said = place.succeeds(&with(&SHORT, &["-o", "b.npy"])).stdout;
    assert!(said.starts_with("544 solutions, "), "eight for each cell that is not a corner: {said}");
    let parameters = &story(&place, "a.vti")["parameters"];
    assert_eq!(
        (&parameters["scattering"], &parameters["stop"]),
        (&"linear".into(), &"stationary".into()),
        "{parameters}"
    );
    // Joint scattering is another scheme, and the default.
    place.succeeds(&with(&SHORT[..4], &["--stop", "stationary", "-o", "joint.vti", "joint.npy"]));
    assert_eq!(story(&place, "joint.vti")["parameters"]["scattering"], "joint");
    assert_ne!(array(&place, "a.npy"), array(&place, "joint.npy"));
    place.succeeds(&with(&SHORT, &["--stop", "stationary", "--precision", "f32", "-o", "single.npy"]));
    assert_near(&array(&place, "single.npy"), &array(&place, "a.npy"), 1e-5);
}

#[test]
fn exact_shards_and_checkpoints_are_those_of_the_whole() {
    let place = Place::new();
    place.succeeds(&with(&SHORT, &["-o", "whole.npy"]));
    for shard in ["0/3", "1/3", "2/3"] {
        let name = format!("{}.part", &shard[..1]);
        place.succeeds(&with(&SHORT, &["--shard", shard, "-o", &name]));
    }
    place.succeeds(&["merge", "2.part", "0.part", "1.part", "-o", "merged.npy"]);
    assert_eq!(place.read("merged.npy"), place.read("whole.npy"));
    for memory in ["1G", "2G"] {
        place.succeeds(&with(&SHORT, &["--checkpoint", "c", "--memory", memory, "-o", "kept.npy"]));
        assert_eq!(place.read("kept.npy"), place.read("whole.npy"));
    }
    place.refuses(
        &with(&SHORT[..4], &["--checkpoint", "c", "-o", "kept.npy"]),
        &["c/checkpoint.part", "--scattering was linear and is joint now"],
    );
}

#[test]
fn estimates_come_with_their_errors() {
    let place = Place::new();
    let summary = place.succeeds(&with(&SKETCHED, &["--json", "-o", "a.vti", "a.npy", "a.png"])).json();
    has_keys(&summary, &["width", "height", "directions", "max", "mean", "threads", "backend", "sweeps"]);
    has_keys(&summary["seconds"], &["total", "propagation", "difference"]);
    assert_eq!((&summary["estimate"], &summary["seed"]), (&100.into(), &7.into()));
    assert_eq!(summary["precision"], "f32");
    let relative_error = summary["relative_error"].as_f64().unwrap();
    assert!((0.05..0.16).contains(&relative_error), "{relative_error} with 100 sketches");
    let image = place.image("a.vti");
    let arrays: Vec<_> = image.point_arrays.iter().map(|a| (a.name.as_str(), a.scalar)).collect();
    assert_eq!(arrays, [("LTG", ScalarType::Float64), ("LTG_error", ScalarType::Float64)]);
    let [values, errors] = ["LTG", "LTG_error"].map(|name| &image.point_array(name).unwrap().values);
    assert_eq!((values.len(), errors.len()), (9 * 8 * 16, 9 * 8 * 16));
    for (value, error) in values.iter().zip(errors) {
        assert_eq!(*value == 0.0, *error == 0.0, "{value} +- {error}");
        assert!(*error >= 0.0 && *error <= 0.6 * value, "{value} +- {error}");
    }
    let parameters = &story(&place, "a.vti")["parameters"];
    assert_eq!((&parameters["estimate"], &parameters["seed"]), (&100.into(), &7.into()));
    // Near the exact gradient, and said in words.
    place.succeeds(&with(&SHORT, &["-o", "exact.npy"]));
    let exact = array(&place, "exact.npy");
    let ratios: Vec<f64> =
        array(&place, "a.npy").iter().zip(&exact).filter(|(_, e)| **e > 0.0).map(|(a, e)| a / e).collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    assert!((mean - 1.0).abs() < 0.3, "{mean} of the exact gradient");
    let said = place.succeeds(&with(&SKETCHED, &["-o", "b.npy"])).stdout;
    assert!(said.starts_with("100 sketches (seed 7), ") && said.contains("standard error of "), "{said}");
    assert_eq!(place.read("b.npy"), place.read("a.npy"));
    place.succeeds(&with(&SKETCHED, &["--threads", "1", "--memory", "40M", "-o", "c.npy"]));
    assert_eq!(place.read("c.npy"), place.read("a.npy"));
    place.succeeds(&with(&SKETCHED[..8], &["-o", "other.npy"]));
    assert_ne!(place.read("other.npy"), place.read("a.npy"), "another seed");
}

#[test]
fn an_error_asked_for_is_met() {
    let place = Place::new();
    for percentage in ["20%", "5"] {
        let args = with(&SHORT, &["--error", percentage, "--seed", "3", "--json", "-o", "a.vti"]);
        let summary = place.succeeds(&args).json();
        let wanted = percentage.trim_end_matches('%').parse::<f64>().unwrap() / 100.0;
        assert!(summary["relative_error"].as_f64().unwrap() <= wanted, "{percentage}: {summary}");
        let sketches = summary["estimate"].to_string();
        let args = with(&SHORT, &["--estimate", &sketches, "--seed", "3", "-o", "b.vti"]);
        place.succeeds(&args);
        assert_eq!(place.image("a.vti").point_arrays, place.image("b.vti").point_arrays, "{percentage}");
    }
    place.refuses(
        &with(&SHORT, &["--error", "0.1%", "-o", "c.vti"]),
        &["--error", "expected a percentage from 0.2% to 50%"],
    );
}

#[test]
fn merged_shards_of_an_estimate_are_the_whole() {
    let place = Place::new();
    let whole = place.succeeds(&with(&SKETCHED, &["--json", "-o", "whole.vti", "whole.npy"])).json();
    // With more shards than batches some have nothing to do.
    for count in [1, 3, 6] {
        let names: Vec<String> = (0..count).map(|k| format!("{k}.part")).collect();
        for (k, name) in names.iter().enumerate() {
            let said = place.succeeds(&with(&SKETCHED, &["--shard", &format!("{k}/{count}"), "-o", name]));
            assert!(!said.stdout.contains("NaN"), "{}", said.stdout);
        }
        let mut args: Vec<&str> = names.iter().rev().map(String::as_str).collect();
        args.insert(0, "merge");
        let merged = place.succeeds(&with(&args, &["--json", "-o", "merged.vti", "merged.npy"])).json();
        assert_eq!(place.read("merged.npy"), place.read("whole.npy"), "{count} shards");
        let images = ["merged.vti", "whole.vti"].map(|name| place.image(name).point_arrays);
        assert_eq!(images[0], images[1], "{count} shards");
        assert_eq!(images[0].len(), 2);
        for key in ["estimate", "seed", "relative_error", "sweeps", "max", "mean"] {
            assert_eq!(merged[key], whole[key], "{key}");
        }
    }
}

#[test]
fn parts_of_other_estimates_are_named() {
    let place = Place::new();
    let part = |args: &[&str], shard: &str, name: &str| {
        place.succeeds(&[args, &["--shard", shard, "-o", name]].concat());
    };
    for shard in ["0/3", "1/3", "2/3"] {
        part(&SKETCHED, shard, &format!("{}.part", &shard[..1]));
    }
    part(&with(&SKETCHED[..8], &["--seed", "8"]), "1/3", "seed.part");
    part(&with(&SHORT, &["--estimate", "128", "--seed", "7"]), "1/3", "more.part");
    part(&SHORT, "1/3", "exact.part");
    part(&with(&SKETCHED, &["--slices", "3"]), "1/3", "slice.part");
    let merge = |parts: &[&'static str], words: &[&str]| {
        place.refuses(&[&["merge"], parts, &["-o", "new.vti"]].concat(), words);
    };
    merge(&["0.part", "2.part"], &["0.part, 2.part", "shard 1/3 is missing"]);
    merge(&["0.part", "1.part", "1.part", "2.part"], &["1.part and 1.part", "in both parts", "1/3"]);
    merge(&["0.part", "seed.part", "2.part"], &["0.part and seed.part", "--seed is 7 and 8"]);
    merge(&["0.part", "more.part", "2.part"], &["0.part and more.part", "--estimate is 100 and 128"]);
    merge(&["0.part", "exact.part", "2.part"], &["0.part and exact.part", "--estimate is 100 and none"]);
    merge(&["exact.part", "0.part"], &["exact.part and 0.part", "--estimate is none and 100"]);
    merge(&["0.part", "slice.part", "2.part"], &["0.part and slice.part", "--slices is 0,1,"]);
}

#[test]
fn damaged_parts_of_an_estimate_are_refused_where_the_damage_is() {
    let place = Place::new();
    place.succeeds(&with(&SKETCHED, &["--shard", "0/1", "-o", "0.part"]));
    let whole = place.read("0.part");
    let refuses = |bytes: Vec<u8>, words: &[&str]| {
        place.write("bad.part", bytes);
        place.refuses(&["merge", "bad.part", "-o", "new.vti"], &[&["bad.part", "byte"], words].concat());
    };
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 4;
    refuses(flipped, &["checksum", "damaged"]);
    refuses(whole[..whole.len() / 2].to_vec(), &["expected"]);
    // Parts whose checksum is right and whose contents are not.
    let part = tigereye_io::part::read(&whole).unwrap();
    for (found, lie, words) in [
        ("\"estimate\":100", "\"estimate\":15", &["15 sketches", "expected 16"][..]),
        ("\"estimate\":100", "\"estimate\":99999999999", &["/parameters/estimate"]),
        ("\"estimate\":100", "\"estimate\":\"x\"", &["/parameters/estimate"]),
        ("\"estimate\":100", "\"estimate\":200", &["byte 32", "4 marks", "expected 7"]),
        ("\"estimate\":100", "\"estimate\":null", &["/summary/sources"]),
        ("\"seed\":7", "\"seed\":-7", &["/parameters/seed"]),
        ("\"width\":9", "\"width\":90", &["byte 24", "values"]),
        ("\"omega_step\":2", "\"omega_step\":0", &["angular step"]),
        ("\"slices\":[0,", "\"slices\":[99,", &["slice"]),
        ("\"slices\":[0,1,", "\"slices\":[1,1,", &["byte 24", "values"]),
    ] {
        let header = part.header.replacen(found, lie, 1);
        assert_ne!(header, part.header, "{found}");
        refuses(tigereye_io::part::write(&header, &part.values, &part.marks), words);
    }
    for wrong in [0.5, 1e300] {
        let mut values = part.values.clone();
        values[3] = wrong;
        refuses(
            tigereye_io::part::write(&part.header, &values, &part.marks),
            &["sum 3", "expected a whole number below 2^53"],
        );
    }
}

/// An estimate that takes seconds.
#[cfg(unix)]
const LONG: [&str; 10] = [
    "ltg",
    "inverse:size=31",
    "--directions",
    "16",
    "--scattering",
    "linear",
    "--estimate",
    "20000",
    "--threads",
    "1",
];

#[cfg(unix)]
fn arrays(image: &ImageData) -> Vec<&str> {
    image.point_arrays.iter().map(|a| a.name.as_str()).collect()
}

#[cfg(unix)]
#[test]
fn an_interrupted_estimate_leaves_a_preview_and_goes_on_from_its_checkpoint() {
    let place = Place::new();
    let args = with(&LONG, &["--checkpoint", "c", "--preview", "p.vti", "-o", "a.vti"]);
    let mut child = place.command(&args).spawn().unwrap();
    let file = place.path("c/checkpoint.part");
    assert!(eventually(|| file.exists() || child.try_wait().unwrap().is_some()));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("tigereye: interrupted; progress saved in c/checkpoint.part"), "{stderr}");
    assert!(!place.path("a.vti").exists());
    let preview = place.image("p.vti");
    assert_eq!(arrays(&preview), ["LTG", "LTG_error"]);
    let part = tigereye_io::part::read(&place.read("c/checkpoint.part")).unwrap();
    assert!(part.marks.contains(&true) && part.marks.contains(&false), "some batches are finished");
    place.succeeds(&args);
    let undisturbed = Place::new();
    undisturbed.succeeds(&with(&LONG, &["-o", "a.vti"]));
    assert_eq!(place.image("a.vti").point_arrays, undisturbed.image("a.vti").point_arrays);
    assert_eq!(place.files().len(), 4, "the output, the preview, the checkpoint and its lock");
}

#[test]
fn previews_are_estimates_of_fewer_sketches() {
    let place = Place::new();
    let args = with(&SHORT, &["--estimate", "2000", "--threads", "1", "--preview", "p.vti", "-o", "a.vti"]);
    place.succeeds(&args);
    let [preview, whole] = ["p.vti", "a.vti"].map(|name| place.image(name));
    let error = |image: &tigereye_io::ImageData| -> f64 {
        image.point_array("LTG_error").unwrap().values.iter().sum()
    };
    // The last preview has at least a quarter of the sketches.
    let ratio = error(&preview) / error(&whole);
    assert!((0.9..2.3).contains(&ratio), "{ratio} times the error of the whole");
    // A picture, and with shards, too.
    place.succeeds(&with(&SKETCHED, &["--preview", "p.png", "--shard", "0/2", "-o", "0.part"]));
    assert!(place.read("p.png").starts_with(b"\x89PNG"));
}

#[test]
fn checkpoints_of_other_estimates_are_refused() {
    let place = Place::new();
    place.succeeds(&with(&SKETCHED, &["--checkpoint", "c", "-o", "a.npy"]));
    let before = place.read("a.npy");
    place.succeeds(&with(&SKETCHED, &["--checkpoint", "c", "-o", "a.npy"]));
    assert_eq!(place.read("a.npy"), before);
    for (args, words) in [
        (with(&SKETCHED[..8], &["--seed", "8"]), "--seed was 7 and is 8 now"),
        (with(&SHORT, &["--estimate", "101", "--seed", "7"]), "--estimate was 100 and is 101 now"),
        (with(&SHORT, &[]), "--estimate was 100 and is none now"),
    ] {
        place.refuses(
            &with(&args, &["--checkpoint", "c", "-o", "b.npy"]),
            &["c/checkpoint.part: belongs to another sweep", words],
        );
    }
}

#[test]
fn lights_superpose() {
    let place = Place::new();
    let (one, other) = ("2,3", "6,5,1+cos(theta)");
    place.succeeds(&with(&LIGHT, &["--light", one, "--light", other, "-o", "both.npy"]));
    place.succeeds(&with(&LIGHT, &["--light", one, "-o", "one.npy"]));
    place.succeeds(&with(&LIGHT, &["--light", other, "-o", "other.npy"]));
    let sum: Vec<f64> =
        array(&place, "one.npy").iter().zip(array(&place, "other.npy")).map(|(a, b)| a + b).collect();
    assert_near(&array(&place, "both.npy"), &sum, 1e-8);
    // Step by step, too; with joint scattering they do not.
    for (scattering, superposes) in [("linear", true), ("joint", false)] {
        let args = [&LIGHT[..4], &["--scattering", scattering, "--steps", "12"]].concat();
        place.succeeds(&with(&args, &["--light", one, "--light", other, "-o", "both.npy"]));
        place.succeeds(&with(&args, &["--light", one, "-o", "one.npy"]));
        place.succeeds(&with(&args, &["--light", other, "-o", "other.npy"]));
        let (both, one, other) =
            (array(&place, "both.npy"), array(&place, "one.npy"), array(&place, "other.npy"));
        let largest = both.iter().fold(0.0, |m: f64, v| m.max(*v));
        let off = both.iter().zip(&one).zip(&other).map(|((b, x), y)| (b - x - y).abs()).fold(0.0, f64::max);
        assert_eq!(off <= 1e-12 * largest, superposes, "{scattering}: off by {off:e} of {largest:e}");
    }
}

/// The adjoint identity: what a receiver gets of a light is the light weighed with the importance.
#[test]
fn importance_says_what_a_receiver_gets() {
    let place = Place::new();
    place.write("walled.scene.ron", WALLED);
    let (samples, width) = (16, 9);
    let step = std::f64::consts::TAU / f64::from(samples);
    let samples = samples as usize;
    let angle = |t: usize| step * t as f64;
    for input in ["random:width=9,height=8", "walled.scene.ron"] {
        let args = ["propagate", input, "--directions", "16", "--scattering", "linear"];
        for (profile, sensitivity) in
            [("", &(|_| 1.0) as &dyn Fn(f64) -> f64), (",2+sin(theta)", &|a: f64| 2.0 + math::sin(a))]
        {
            let towards = format!("6,5{profile}");
            let summary = place.succeeds(&with(&args, &["--towards", &towards, "--json", "-o", "i.npy"]));
            has_keys(&summary.json(), &["width", "height", "receiver", "sweeps", "seconds", "max", "mean"]);
            place.succeeds(&with(&args, &["--light", "2,3,1+cos(theta)", "-o", "light.npy"]));
            let (importance, light) = (array(&place, "i.npy"), array(&place, "light.npy"));
            let at = |x: usize, y: usize| (y * width + x) * samples;
            let received: f64 =
                (0..samples).map(|t| step * sensitivity(angle(t)) * light[at(6, 5) + t]).sum();
            let emitted = |t: usize| 1.0 + math::cos(angle(t));
            let told: f64 = (0..samples).map(|t| step * emitted(t) * importance[at(2, 3) + t]).sum();
            assert!((told - received).abs() < 1e-7 * received, "{input}: {told} and {received}");
            assert!(received > 1e-3, "{input}: something arrives");
        }
    }
}

#[test]
fn importance_is_written_in_every_format() {
    let place = Place::new();
    let args = with(&LIGHT, &["--towards", "6,5", "-o", "i.vti", "i.npy", "i.png", "i.svg"]);
    let said = place.succeeds(&args).stdout;
    assert!(said.contains("arrives at (6, 5)"), "{said}");
    assert_eq!(story(&place, "i.vti")["parameters"]["towards"], "6,5");
    place.succeeds(&with(&LIGHT, &["--towards", "6,5", "--picture", "energy", "-o", "e.svg"]));
    let svg = String::from_utf8(place.read("e.svg")).unwrap();
    assert!(svg.contains("importance for (6, 5)"), "a title");
}

#[test]
fn receivers_that_cannot_be_are_refused() {
    let place = Place::new();
    place.write("walled.scene.ron", WALLED);
    let joint = &LIGHT[..4];
    let scene = ["propagate", "walled.scene.ron", "--scattering", "linear"];
    for (args, more, words) in [
        (joint, &["--towards", "3,3", "-o", "a.vti"][..], &["--towards", "--scattering linear"][..]),
        (
            &LIGHT,
            &["--towards", "9,3", "-o", "a.vti"],
            &["--towards", "(9, 3) lies outside the field of 9 x 8"],
        ),
        (&LIGHT, &["--towards", "3", "-o", "a.vti"], &["--towards 3", "expected X,Y"]),
        (&LIGHT, &["--towards", "-1,3", "-o", "a.vti"], &["--towards -1,3", "expected X,Y"]),
        (&LIGHT, &["--towards", "3,3,sin(", "-o", "a.vti"], &["--towards 3,3,sin("]),
        (&LIGHT, &["--towards", "3,3,0", "-o", "a.vti"], &["--towards", "0 in every direction"]),
        (&LIGHT, &["--towards", "3,3,-1", "-o", "a.vti"], &["--towards", "0 in every direction"]),
        (&LIGHT, &["--towards", "3,3,1e101", "-o", "a.vti"], &["--towards", "no more than 1e100"]),
        (&LIGHT, &["--towards", "3,3", "--stop", "flux", "-o", "a.vti"], &["--stop", "expected stationary"]),
        (&LIGHT, &["--towards", "3,3", "--light", "2,2", "-o", "a.vti"], &["--towards", "--light"]),
        (&LIGHT, &["--towards", "3,3", "--impulse", "-o", "a.vti"], &["--towards", "--impulse"]),
        (&LIGHT, &["--towards", "3,3", "--steps", "4", "-o", "a.vti"], &["--towards", "--steps"]),
        (&LIGHT, &["--towards", "3,3", "-o", "a.pvd"], &["a.pvd", "importance has no steps"]),
        (&LIGHT, &["--towards", "3,3", "-o", "a.vti", "a.apng"], &["a.apng", "importance has no steps"]),
        (&scene, &["--towards", "4,3", "-o", "a.vti"], &["--towards", "(4, 3) is inside a wall"]),
    ] {
        place.refuses(&with(args, more), words);
    }
}

#[test]
fn sheets_of_fields_show_linear_scattering() {
    let place = Place::new();
    let args = ["field", "show", "inverse:size=13"];
    place.succeeds(&with(&args, &["-o", "joint.svg"]));
    place.succeeds(&with(&args, &["--scattering", "linear", "-o", "linear.svg"]));
    assert_ne!(place.read("joint.svg"), place.read("linear.svg"));
    place.refuses(&with(&args, &["--scattering", "x", "-o", "a.svg"]), &["--scattering", "joint", "linear"]);
}
