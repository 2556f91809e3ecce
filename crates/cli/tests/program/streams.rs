//! Data on standard output, messages on standard error, nothing else on either.

use crate::support::Place;

#[test]
fn json_commands_print_nothing_but_json() {
    let place = Place::new();
    let ltg = ["ltg", "x:size=4", "--directions", "8", "--json", "-o", "a.npy"];
    let propagate = ["propagate", "x:size=4", "--light", "1,1", "--json", "-o", "b.npy"];
    for args in [&["field", "list", "--json"][..], &["info", "x", "--json"], &ltg, &propagate] {
        // `json` refuses anything around the value; `succeeds` anything on standard error.
        place.succeeds(args).json();
    }
}

#[test]
fn no_progress_bar_without_a_terminal() {
    let place = Place::new();
    place.succeeds(&["ltg", "inverse:size=21", "--directions", "16", "-o", "a.npy"]);
    let run = place.tigereye(&["reproduce", "--only", "fig-2-10-inverse", "--out", "r"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(!run.stderr.contains(['\r', '\u{1b}', '%']), "{:?}", run.stderr);
    assert!(!run.stdout.contains(['\r', '\u{1b}']), "{:?}", run.stdout);
}

#[test]
#[cfg(target_os = "linux")]
fn data_that_cannot_be_printed_is_a_fault() {
    use std::fs::File;
    let place = Place::new();
    let full = || File::options().write(true).open("/dev/full").unwrap();
    let output = place.command(&["field", "list", "--json"]).stdout(full()).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "a full disk loses the data");
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard output"));
}

#[test]
#[cfg(unix)]
fn a_reader_that_goes_away_is_no_fault() {
    let place = Place::new();
    let mut child = place.command(&["field", "list"]).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
}
