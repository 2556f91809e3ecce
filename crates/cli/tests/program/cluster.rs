//! Shards of a sweep while they are on their way: how far they are, and what there is already.

use crate::support::Place;
use serde_json::Value;

const SWEEP: [&str; 4] = ["ltg", "random:width=9,height=8", "--directions", "16"];

fn shard(place: &Place, index: usize, output: &str) {
    place.succeeds(&[&SWEEP[..], &["--shard", &format!("{index}/3"), "-o", output]].concat());
}

#[test]
fn status_tells_what_is_done_missing_and_broken() {
    let place = Place::new();
    place.write("parts/1.failed", b"");
    place.succeeds(
        &[&SWEEP[..], &["--shard", "0/3", "--checkpoint", "parts/0", "-o", "parts/0.part"]].concat(),
    );
    shard(&place, 2, "parts/2.part");
    let whole = place.read("parts/2.part");
    place.write("parts/broken.part", &whole[..100]);
    place.write("parts/1.failed", b"shard 1/3 ended with 2:\nno-such-field: expected a field");
    let found = place.tigereye(&["status", "parts", "--json"]);
    assert_eq!(found.code, 1);
    let found = found.json();
    assert_eq!(found["shards"], 3);
    assert_eq!(found["complete"], false);
    assert_eq!(found["missing"], serde_json::json!([1]));
    // The finished part counts, not its checkpoint beside it.
    let states: Vec<&Value> = found["parts"].as_array().unwrap().iter().map(|p| &p["state"]).collect();
    assert_eq!(states, ["done", "done"]);
    assert_eq!(found["parts"][0]["file"], "parts/0.part");
    assert!(found["broken"][0]["file"].as_str().unwrap().ends_with("broken.part"));
    assert!(found["failed"][0]["problem"].as_str().unwrap().contains("no-such-field"));
    let said = place.tigereye(&["status", "parts"]).stdout;
    for words in ["3 shards: 2 done", "missing: 1/3", "broken: parts/broken.part", "failed: parts/1.failed"] {
        assert!(said.contains(words), "{words}: {said}");
    }
}

#[test]
fn status_of_a_complete_sweep_is_a_success() {
    let place = Place::new();
    (0..3).for_each(|k| shard(&place, k, &format!("{k}.part")));
    let found = place.succeeds(&["status", "0.part", "1.part", "2.part", "--json"]).json();
    assert_eq!((&found["complete"], &found["share"]), (&true.into(), &1.0.into()));
}

#[test]
fn parts_of_two_sweeps_are_told_apart() {
    let place = Place::new();
    shard(&place, 0, "0.part");
    place.succeeds(&[&SWEEP[..], &["--threshold", "0.25", "--shard", "1/3", "-o", "1.part"]].concat());
    let found = place.tigereye(&["status", "0.part", "1.part", "--json"]).json();
    let problem = found["broken"][0]["problem"].as_str().unwrap().to_owned();
    assert!(problem.contains("another sweep") && problem.contains("--threshold"), "{problem}");
}

#[test]
fn folders_without_shards_are_refused() {
    let place = Place::new();
    place.write("empty/notes.txt", b"nothing");
    place.refuses(&["status", "empty"], &["empty", "expected files .part"]);
    place.refuses(&["merge", "empty", "-o", "new.npy"], &["empty", "expected files .part"]);
}

#[test]
fn a_partial_merge_marks_what_is_missing() {
    let place = Place::new();
    place.succeeds(&[&SWEEP[..], &["-o", "whole.npy"]].concat());
    place.write("parts/notes.txt", b"The folder must be there.");
    shard(&place, 0, "parts/0.part");
    shard(&place, 2, "parts/2.part");
    place.refuses(&["merge", "parts", "-o", "new.npy"], &["shard 1/3 is missing"]);
    let summary = place.succeeds(&["merge", "parts", "--partial", "--json", "-o", "some.npy"]).json();
    let numbers = |name: &str| -> Vec<f64> {
        let bytes = place.read(name);
        // 72 cells and 16 slices of f64 stand at the end.
        let values = &bytes[bytes.len() - 72 * 16 * 8..];
        values.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect()
    };
    let (whole, some) = (numbers("whole.npy"), numbers("some.npy"));
    let missing = some.iter().filter(|v| v.is_nan()).count();
    // One mark per inner cell, and every slice of it.
    assert_eq!(summary["missing"].as_u64().unwrap() * 16, missing as u64);
    assert_eq!(summary["of"], 7 * 6);
    assert_eq!(missing, 14 * 16);
    assert!(whole.iter().zip(&some).all(|(w, s)| s.is_nan() || w.to_bits() == s.to_bits()));
    // With all shards it is the whole.
    shard(&place, 1, "parts/1.part");
    place.succeeds(&["merge", "parts", "--partial", "-o", "all.npy"]);
    assert_eq!(place.read("all.npy"), place.read("whole.npy"));
}
