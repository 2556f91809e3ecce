//! Fields at the edge of what a field is: one cell, one row, nothing but zeros.

use crate::support::{Place, unit_text};

#[test]
fn fields_without_inner_cells_have_a_dark_gradient() {
    let place = Place::new();
    for size in
        ["width=1,height=1", "width=1,height=9", "width=9,height=1", "width=2,height=2", "width=2,height=7"]
    {
        let input = format!("inverse:{size}");
        let args = ["ltg", &input, "--directions", "8", "--json", "-o", "a.vti"];
        let summary = place.succeeds(&args).json();
        assert_eq!(summary["max"], 0.0, "{size}");
        assert_eq!(summary["mean"], 0.0, "{size}");
        place.succeeds(&["compare", "a.vti", "a.vti", "--tolerance", "0"]);
    }
}

#[test]
fn fields_of_few_cells_transport_light() {
    let place = Place::new();
    for size in ["width=1,height=1", "width=1,height=9", "width=9,height=1", "width=2,height=2"] {
        let input = format!("inverse:{size}");
        place.succeeds(&["propagate", &input, "--light", "0,0", "-o", "a.vti", "a.npy", "a.png", "a.svg"]);
        place.succeeds(&["info", &input, "--json"]);
    }
}

#[test]
fn a_field_of_zeros_lets_no_light_pass() {
    let place = Place::new();
    place.write("zero.txt", "0 0 0 0 0 0 0 0\n".repeat(8));
    for rule in
        ["local", "global", "local-above:0.5", "local-above-global:0.5", "local-above:0", "local-above:1"]
    {
        let args = ["ltg", "zero.txt", "--directions", "8", "--normalization", rule, "--json", "-o", "a.vti"];
        assert_eq!(place.succeeds(&args).json()["max"], 0.0, "{rule}");
        let args = [
            "propagate",
            "zero.txt",
            "--light",
            "1,1",
            "--normalization",
            rule,
            "--json",
            "-o",
            "a.npy",
            "a.png",
        ];
        let energy = place.says(&args, "its tensor is zero").json()["energy"].as_f64().unwrap();
        // The light's own cell keeps shining 1 W/rad.
        assert!((energy - std::f64::consts::TAU).abs() < 1e-12, "{rule}: {energy}");
    }
    let info = place.succeeds(&["info", "zero.txt", "--json"]).json();
    assert_eq!(info["shares"]["zero"], 1.0);
    assert_eq!(info["shares"]["degenerate"], 0.0);
}

#[test]
fn extreme_magnitudes_stay_finite() {
    let place = Place::new();
    for scale in ["1e-300", "1e200", "1e308", "4.9e-324"] {
        place.write("f.txt", unit_text(4, 4).replace('1', scale));
        let summary = place.succeeds(&["ltg", "f.txt", "--directions", "8", "--json", "-o", "a.npy"]).json();
        assert!(summary["max"].as_f64().is_some_and(f64::is_finite), "{scale}: {summary:#}");
        let info = place.succeeds(&["info", "f.txt", "--json"]).json();
        assert!(info["singular_values"]["s1"]["max"].as_f64().is_some(), "{scale}: {info:#}");
        assert!(info["fractional_anisotropy"]["mean"].as_f64().is_some(), "{scale}: {info:#}");
    }
}

#[test]
fn no_step_at_all_leaves_the_lights_alone() {
    let place = Place::new();
    for impulse in [&[][..], &["--impulse"]] {
        let args = [
            "propagate",
            "inverse:size=5",
            "--light",
            "2,2",
            "--steps",
            "0",
            "--json",
            "-o",
            "a.npy",
            "a.png",
        ];
        let summary = place.succeeds(&[&args, impulse].concat()).json();
        assert_eq!(summary["iterations_total"], 0);
        assert!((summary["energy"].as_f64().unwrap() - std::f64::consts::TAU).abs() < 1e-12);
    }
}

#[test]
fn a_sweep_of_one_step_is_possible() {
    let place = Place::new();
    let args =
        ["ltg", "inverse:size=5", "--directions", "8", "--max-iterations", "0", "--json", "-o", "a.npy"];
    let summary = place.succeeds(&args).json();
    assert_eq!(summary["iterations_max"], 1);
}

#[test]
fn extensions_may_be_written_in_capitals() {
    let place = Place::new();
    place.write("F.TXT", unit_text(3, 2));
    let info = place.succeeds(&["info", "F.TXT", "--json"]).json();
    assert_eq!((info["width"].as_u64(), info["height"].as_u64()), (Some(3), Some(2)));
}

#[test]
fn repeated_slices_count_once() {
    let place = Place::new();
    place.succeeds(&["ltg", "x:size=4", "--directions", "8", "--slices", "1,1,0", "-o", "a.vti"]);
    assert_eq!(place.image("a.vti").numbers("slices"), Some(&[0.0, 1.0][..]));
}

#[test]
fn names_with_blanks_and_accents_are_files_like_others() {
    let place = Place::new();
    place.write("ein F\u{fc}ld.txt", unit_text(3, 3));
    place.succeeds(&["ltg", "ein F\u{fc}ld.txt", "--directions", "8", "-o", "gr\u{fc}n und rot.vti"]);
    place.image("gr\u{fc}n und rot.vti");
}

#[test]
fn outputs_get_ordinary_permissions() {
    let place = Place::new();
    place.succeeds(&["ltg", "x:size=4", "--directions", "8", "-o", "a.vti"]);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(place.path("a.vti")).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o644);
    }
}
