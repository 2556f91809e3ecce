//! The first light in a field of one's own: what it shows without options, and what is said where it shows little.

use crate::support::{Place, unit_text};
use serde_json::Value;

const NPY: &str = "{'descr': '<f8', 'fortran_order': False, 'shape': (30, 40, 2, 2), }";

/// 40 x 30 tensors as an array.
fn array(tensor: impl Fn(usize, usize) -> [f64; 4]) -> Vec<u8> {
    let values = (0..30).flat_map(|y| (0..40).map(move |x| (x, y))).flat_map(|(x, y)| tensor(x, y));
    let mut bytes = crate::support::npy_file(NPY, 0);
    bytes.extend(values.flat_map(f64::to_le_bytes));
    bytes
}

/// A stress concentration: the strength falls off from the upper left.
fn concentration(x: usize, y: usize) -> [f64; 4] {
    let strength = {
        let distance = 1.0 + x as f64 + y as f64;
        100.0 / (distance * distance)
    };
    [strength, 0.0, 0.0, 0.5 * strength]
}

fn summary(place: &Place, args: &[&str], said: &str) -> Value {
    place.says(&[&["propagate"], args, &["--json", "-o", "l.npy"]].concat(), said).json()
}

/// Cells above a ten-thousandth of the brightest, of 40 x 30 cells and 32 directions.
fn lit(place: &Place) -> usize {
    let bytes = place.read("l.npy");
    let start = bytes.len() - 40 * 30 * 32 * 8;
    let sample = |b: &[u8]| f64::from_le_bytes(b.try_into().unwrap());
    let energy: Vec<f64> =
        bytes[start..].chunks(32 * 8).map(|cell| cell.chunks(8).map(sample).sum()).collect();
    let largest = energy.iter().copied().fold(0.0, f64::max);
    energy.iter().filter(|e| **e > 1e-4 * largest).count()
}

#[test]
fn the_first_light_in_a_stress_concentration_is_not_blank() {
    let place = Place::new();
    place.write("stress.npy", array(concentration));
    summary(&place, &["stress.npy", "--light", "20,15"], "took row 0 on top");
    assert!(lit(&place) > 800, "{} cells", lit(&place));
    let run = place.tigereye(&["propagate", "stress.npy", "--light", "20,15", "-o", "l.npy"]);
    assert!(!run.stderr.contains("reached") && !run.stderr.contains("anisotropic"), "{}", run.stderr);
}

#[test]
fn a_nearly_blank_light_says_why_and_what_to_try() {
    let place = Place::new();
    place.write("stress.npy", array(concentration));
    let global = ["stress.npy", "--light", "20,15", "--normalization", "global"];
    summary(&place, &global, "try --normalization local");
    assert!(lit(&place) < 60, "{} cells", lit(&place));
    summary(&place, &global, "within 1 step; with --normalization global half of the cells");
    let faint = ["stress.npy", "--light", "20,15,0.01"];
    summary(&place, &faint, "the lights emit 0.0628 W");
    summary(&place, &faint, "try --threshold 6e-5 or --stop stationary");
    // Whoever asks for steps gets them.
    let run = place.tigereye(&["propagate", "stress.npy", "--light", "20,15", "--steps", "2", "-o", "l.npy"]);
    assert!(!run.stderr.contains("reached"), "{}", run.stderr);
}

#[test]
fn lights_in_cells_that_transmit_nothing_are_named() {
    let place = Place::new();
    place.write("stress.npy", array(concentration));
    let above = ["stress.npy", "--light", "20,15", "--normalization", "local-above:0.3"];
    let words = "the light at (20, 15) lights no other cell: it transmits 0.001 of the strongest cell, below the threshold";
    summary(&place, &above, words);
    let sink = ["propagate", "sink:size=9", "--light", "4,4", "-o", "l.npy"];
    place.says(&sink, "the light at (4, 4) lights no other cell: its tensor is zero");
}

/// A threshold between two groups, and none for the tail of a concentration.
#[test]
fn info_suggests_a_threshold_for_two_groups_only() {
    let place = Place::new();
    let threshold =
        |name: &str| place.says(&["info", name, "--json"], "").json()["suggested_local_above"].clone();
    place.write("stress.npy", array(concentration));
    assert_eq!(threshold("stress.npy"), Value::Null);
    for generator in ["kirsch", "inverse", "rings", "random", "point_load", "double_gyre"] {
        assert_eq!(threshold(generator), Value::Null, "{generator}");
    }
    let noise = |x: usize, y: usize| 0.01 * (1 + (7 * x + 13 * y) % 5) as f64;
    place.write(
        "tissue.npy",
        array(|x, y| {
            let strength = if x < 15 { 1.0 - noise(y, x) } else { 0.1 + noise(x, y) };
            [strength, 0.0, 0.0, strength]
        }),
    );
    let found = threshold("tissue.npy").as_f64().unwrap();
    assert!(found > 0.15 && found < 0.95, "{found}");
    let told = place.succeeds(&["info", "tissue.npy"]).stdout;
    assert!(told.contains("--normalization local-above:0."), "{told}");
}

/// Cells of a ratio of 30 on the left, of 2 on the right.
fn half_thin(x: usize, _: usize) -> [f64; 4] {
    [1.0, 0.0, 0.0, if x < 10 { 1.0 / 30.0 } else { 0.5 }]
}

#[test]
fn totally_anisotropic_cells_are_told_of_and_outlined() {
    let place = Place::new();
    place.write("thin.npy", array(half_thin));
    let propagate = |option: &[&str], said: &str, out: &str| {
        place.says(&[&["propagate", "thin.npy", "--light", "20,15", "-o", out], option].concat(), said);
    };
    propagate(&[], "thin.npy: 25.0 % of the cells are totally anisotropic (semi-axes beyond 20:1)", "a.svg");
    propagate(&["--total-anisotropy", "smooth"], "blended from 10:1 to 40:1", "b.npy");
    propagate(&["--total-anisotropy", "cap"], "taken as 20:1", "c.npy");
    propagate(&[], "", "d.npy");
    for other in ["b.npy", "c.npy"] {
        assert_ne!(place.read(other), place.read("d.npy"), "{other}");
    }
    for rule in ["none", "40"] {
        let args = ["propagate", "thin.npy", "--light", "20,15", "-o", "e.npy", "--total-anisotropy", rule];
        let run = place.tigereye(&args);
        assert!(run.code == 0 && !run.stderr.contains("anisotropic"), "{rule}: {}", run.stderr);
    }
    // The outline is the line between columns 9 and 10 in either picture, and nothing else is so thin.
    let drawn = |args: &[&str]| {
        place.says(&[args, &["-o", "p.svg"]].concat(), "");
        String::from_utf8(place.read("p.svg")).unwrap().contains(r#"stroke-width="0.9""#)
    };
    for picture in ["overlay", "energy"] {
        let of = |rule| {
            drawn(&[
                "propagate",
                "thin.npy",
                "--light",
                "20,15",
                "--picture",
                picture,
                "--total-anisotropy",
                rule,
            ])
        };
        assert!(of("20") && !of("40"), "{picture}");
    }
    let ltg = ["ltg", "thin.npy", "--resample", "8x6", "--directions", "8"];
    let told = place.says(&[&ltg[..], &["--json", "-o", "g.vti"]].concat(), "totally anisotropic").json();
    assert!(told["total_anisotropy_share"].as_f64().is_some_and(|share| share > 0.1), "{told:#}");
    place.write("round.txt", unit_text(8, 6));
    let told = place.succeeds(&["ltg", "round.txt", "--directions", "8", "--json", "-o", "r.vti"]).json();
    assert_eq!(told.get("total_anisotropy_share"), None);
}

/// Pictures of merged parts have the outline, which the parts carry.
#[test]
fn parts_carry_the_rule_and_the_cells() {
    let place = Place::new();
    place.write("thin.npy", array(half_thin));
    let ltg = |more: &[&str]| {
        let all = ["ltg", "thin.npy", "--resample", "8x6", "--directions", "8", "--total-anisotropy", "12:2"];
        place.says(&[&all[..], more].concat(), "blended from 6:1 to 24:1")
    };
    ltg(&["--shard", "0/2", "-o", "0.part"]);
    ltg(&["--shard", "1/2", "-o", "1.part"]);
    ltg(&["-o", "whole.svg", "whole.vti"]);
    let merged =
        place.succeeds(&["merge", "0.part", "1.part", "--json", "-o", "merged.svg", "merged.vti"]).json();
    let whole = ltg(&["--json", "-o", "again.npy"]).json();
    assert_eq!(merged["total_anisotropy_share"], whole["total_anisotropy_share"]);
    assert!(whole["total_anisotropy_share"].is_f64());
    assert_eq!(place.read("merged.svg"), place.read("whole.svg"));
    place.succeeds(&["compare", "merged.vti", "whole.vti", "--tolerance", "0"]);
    let story: Value = serde_json::from_str(place.image("merged.vti").text("tigereye").unwrap()).unwrap();
    assert_eq!(story["parameters"]["total_anisotropy"], "12:2");
    let other =
        ["ltg", "thin.npy", "--resample", "8x6", "--directions", "8", "--shard", "1/2", "-o", "2.part"];
    place.says(&other, "");
    place.refuses(&["merge", "0.part", "2.part", "-o", "m.vti"], &["--total-anisotropy is 12:2 and 20"]);
}

#[test]
fn rules_that_cannot_be_are_refused() {
    let place = Place::new();
    let refused = ["propagate", "x", "--light", "1,1", "--total-anisotropy", "0.5", "-o", "a.npy"];
    place.refuses(&refused, &["--total-anisotropy", "out of range"]);
    place.refuses(&["ltg", "x", "--total-anisotropy", "thin", "-o", "a.vti"], &["R:WIDTH", "`none`"]);
}
