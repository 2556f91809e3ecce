//! The machine: its limits beside the engine, and the instruction set that may be forced.

use crate::support::Place;

#[test]
fn bench_measures_engine_and_limits_in_both_precisions() {
    let place = Place::new();
    let run = place.succeeds(&["bench", "--cells", "5,9", "--threads", "2", "--seconds", "0.01", "--json"]);
    let value = run.json();
    let rows = value["rows"].as_array().unwrap();
    // Two precisions, one and two threads, two sides.
    assert_eq!(rows.len(), 8, "{value}");
    for row in rows {
        for rate in ["updates_per_second", "arithmetic_limit", "streaming_limit"] {
            assert!(row[rate].as_f64().unwrap() > 0.0, "{row}");
        }
        let percent =
            100.0 * row["updates_per_second"].as_f64().unwrap() / row["arithmetic_limit"].as_f64().unwrap();
        assert!((row["percent_of_arithmetic"].as_f64().unwrap() - percent).abs() < 1e-9, "{row}");
    }
    let table = place.succeeds(&["bench", "--cells", "5", "--threads", "1", "--seconds", "0.01"]).stdout;
    assert!(table.contains("5x5") && table.contains("arithmetic") && table.contains("f32"), "{table}");
}

#[test]
fn bench_refuses_what_it_cannot_measure() {
    let place = Place::new();
    for (option, value) in [("--cells", "2"), ("--cells", "100000"), ("--seconds", "0"), ("--seconds", "x")] {
        place.refuses(&["bench", option, value], &[option, "expected"]);
    }
}

#[test]
fn every_instruction_set_writes_the_same_volume_and_says_which_it_was() {
    let place = Place::new();
    for precision in ["f64", "f32"] {
        let mut volumes = Vec::new();
        for level in ["baseline", "avx2", "avx512"] {
            let args = [
                "ltg",
                "drain:size=7",
                "--directions",
                "16",
                "--precision",
                precision,
                "--json",
                "-o",
                "a.npy",
            ];
            let output = place.command(&args).env("TIGEREYE_SIMD", level).output().unwrap();
            let message = String::from_utf8_lossy(&output.stderr);
            if !output.status.success() {
                // A set this processor lacks is refused by its name, with those it has.
                assert!(
                    level != "baseline" && message.contains("baseline") && message.contains(level),
                    "{message}"
                );
                continue;
            }
            let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(summary["backend"], level);
            volumes.push(place.read("a.npy"));
        }
        assert!(volumes.iter().all(|v| *v == volumes[0]), "{precision}");
    }
    let output = place.command(&["field", "list"]).env("TIGEREYE_SIMD", "mmx").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(
        message.contains("TIGEREYE_SIMD") && message.contains("mmx") && message.contains("expected"),
        "{message}"
    );
}
