//! Ctrl-C ends with 130 and leaves what was there before, no more and no less.

use crate::support::Place;
use std::process::{Child, Command};
use std::time::Duration;
use tigereye_test_support::eventually;

fn interrupt(child: &Child, signal: &str) {
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
}

/// Waits until the program watches for interrupts: before, a signal would kill it.
fn wait_until_watching(child: &Child) {
    let status = format!("/proc/{}/status", child.id());
    if std::fs::read_to_string(&status).is_err() {
        // No such file system here: half a second is plenty.
        std::thread::sleep(Duration::from_millis(500));
        return;
    }
    let is_watching = || {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let caught = text.lines().find_map(|l| l.strip_prefix("SigCgt:")).map(str::trim);
        // SIGINT is signal 2, bit 1.
        caught.and_then(|h| u64::from_str_radix(h, 16).ok()).is_some_and(|bits| bits & 2 != 0)
    };
    assert!(eventually(is_watching), "the program never watched for interrupts");
    std::thread::sleep(Duration::from_millis(200));
}

/// The exit code and standard error, or a failure where the program goes on.
#[track_caller]
fn ending(mut child: Child) -> (Option<i32>, String) {
    if !eventually(|| child.try_wait().unwrap().is_some()) {
        child.kill().unwrap();
        child.wait().unwrap();
        panic!("the program goes on after an interrupt");
    }
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), "", "standard output");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Starts a command that would run for long, interrupts it, and looks at what remains.
#[track_caller]
fn leaves_everything(args: &[&str], signal: &str) {
    let place = Place::new();
    place.write("kept.vti", "an earlier result");
    place.write("r/summary.json", r#"{"experiments": []}"#);
    place.write("long.ron", LONG);
    let before = place.files();
    let mut child = place.command(args).spawn().unwrap();
    wait_until_watching(&child);
    assert!(child.try_wait().unwrap().is_none(), "{args:?} ended before it could be interrupted");
    interrupt(&child, signal);
    let (code, stderr) = ending(child);
    assert_eq!(code, Some(130), "{args:?}: {stderr}");
    assert_eq!(stderr.lines().filter(|l| l.starts_with("tigereye: interrupted")).count(), 1, "{stderr}");
    place.same_files(&before);
}

const LONG: &str = r#"(
    format: 1, title: "t", source: "s", section: "1", claim: "c", look_for: "l",
    fields: { "f": Generator(name: "inverse", parameters: {"size": 151}) },
    runs: { "g": Gradient(field: "f") },
    figures: [(name: "a", caption: "b", panels: [Flat(run: "g", view: Mean, title: "m")])],
    checks: [(name: "n", quantity: GradientMax(run: "g"), expect: AtLeast(0), basis: "b")],
)"#;

#[test]
fn an_interrupted_sweep_leaves_no_output() {
    leaves_everything(&["ltg", "inverse:size=201", "-o", "new.vti"], "-INT");
}

#[test]
fn an_interrupted_sweep_keeps_the_output_that_was_there() {
    leaves_everything(&["ltg", "inverse:size=201", "--json", "--threads", "1", "-o", "kept.vti"], "-INT");
}

#[test]
fn a_terminated_sweep_ends_in_the_same_way() {
    leaves_everything(&["ltg", "inverse:size=201", "-o", "kept.vti"], "-TERM");
}

#[test]
fn an_interrupted_propagation_leaves_no_output() {
    let args = ["propagate", "inverse:size=301", "--light", "9,9", "--steps", "100000000", "--json"];
    leaves_everything(&[&args[..], &["-o", "new.npy", "kept.vti", "new.png"]].concat(), "-INT");
}

#[test]
fn an_interrupted_experiment_leaves_no_report() {
    leaves_everything(&["run", "long.ron", "--out", "r"], "-INT");
}

/// What was finished stays, what was there before does too, and the page shows both.
#[test]
fn an_interrupted_run_keeps_finished_experiments_and_earlier_ones() {
    let place = Place::new();
    let quick = |title: &str| {
        let quick = LONG.replace("\"size\": 151", "\"size\": 5");
        quick.replace("title: \"t\", source", &format!("title: \"{title}\", source"))
    };
    place.write("earlier.ron", quick("Earlier"));
    place.write("first.ron", quick("Finished"));
    place.write("long.ron", LONG);
    assert_eq!(place.tigereye(&["run", "earlier.ron", "--out", "r"]).code, 0);
    let child = place.command(&["run", "first.ron", "long.ron", "--out", "r"]).spawn().unwrap();
    let summary = || String::from_utf8(place.read("r/summary.json")).unwrap();
    assert!(eventually(|| summary().contains("\"first\"")), "the first one never ended");
    interrupt(&child, "-INT");
    let (code, stderr) = ending(child);
    assert_eq!(code, Some(130), "{stderr}");
    let page = String::from_utf8(place.read("r/index.html")).unwrap();
    assert!(page.contains("Earlier") && page.contains("Finished"));
    assert!(summary().contains("\"earlier\"") && !summary().contains("\"long\""));
    let leftovers = place.files().into_keys().filter(|p| p.to_string_lossy().contains(".tigereye-")).count();
    assert_eq!(leftovers, 0);
}

#[test]
fn an_interrupted_reading_command_ends_with_130_too() {
    // Making this field takes seconds; `info` then has no further work that could notice.
    leaves_everything(&["info", "random:size=3000"], "-INT");
}

/// A command that waits for ever: nobody writes into its input.
fn waiting(place: &Place) -> Child {
    assert!(Command::new("mkfifo").arg(place.path("pipe.txt")).status().unwrap().success());
    let child = place.command(&["ltg", "pipe.txt", "-o", "kept.vti"]).spawn().unwrap();
    wait_until_watching(&child);
    child
}

#[test]
fn the_second_interrupt_ends_a_program_that_waits() {
    let place = Place::new();
    place.write("kept.vti", "an earlier result");
    let mut child = waiting(&place);
    let before = place.files();
    interrupt(&child, "-INT");
    std::thread::sleep(Duration::from_millis(300));
    // Either the first one was enough, or the second one is.
    if child.try_wait().unwrap().is_none() {
        interrupt(&child, "-INT");
        let (code, _) = ending(child);
        assert_eq!(code, Some(130));
    }
    place.same_files(&before);
}
