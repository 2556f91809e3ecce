//! Sweeps in pieces: shards and their merging, checkpoints, and everything that can go wrong with them.

use crate::support::{Place, beside_thin_cells};
use std::path::Path;
use std::process::{Child, Command};
use std::time::Duration;
use tigereye_test_support::eventually;

/// A sweep that is over at once.
const SHORT: [&str; 4] = ["ltg", "random:width=9,height=8", "--directions", "16"];
/// A sweep that takes a second or two.
const LONG: [&str; 6] = ["ltg", "inverse:size=31", "--directions", "16", "--threads", "1"];

fn with<'a>(args: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [args, more].concat()
}

/// Writes the shards of a sweep as `0.part`, `1.part` ...
fn shards(place: &Place, args: &[&str], count: usize) -> Vec<String> {
    let name = |k: usize| format!("{k}.part");
    for k in 0..count {
        place.succeeds(&with(args, &["--shard", &format!("{k}/{count}"), "-o", &name(k)]));
    }
    (0..count).map(name).collect()
}

#[test]
fn merged_shards_hold_the_values_of_the_whole() {
    let place = Place::new();
    place.succeeds(&with(&SHORT, &["-o", "whole.vti", "whole.npy"]));
    for count in [1, 3, 5] {
        let parts = shards(&place, &SHORT, count);
        let mut args: Vec<&str> = vec!["merge"];
        args.extend(parts.iter().map(String::as_str));
        let forward = with(&args, &["-o", "merged.vti", "merged.npy", "merged.png", "merged.svg"]);
        place.succeeds(&forward);
        assert_eq!(place.read("merged.npy"), place.read("whole.npy"), "{count} shards");
        let (whole, merged) = (place.image("whole.vti"), place.image("merged.vti"));
        assert_eq!(whole.point_arrays, merged.point_arrays);
        let story = |image: &tigereye_io::ImageData| -> serde_json::Value {
            serde_json::from_str(image.text("tigereye").unwrap()).unwrap()
        };
        for key in ["version", "parameters", "input_blake3"] {
            assert_eq!(story(&merged)[key], story(&whole)[key], "{key}");
        }
        assert!(story(&merged)["command"].as_str().unwrap().starts_with("tigereye merge 0.part"));
        // In any order.
        args[1..].reverse();
        place.succeeds(&with(&args, &["-o", "backward.npy"]));
        assert_eq!(place.read("backward.npy"), place.read("whole.npy"));
    }
}

#[test]
fn a_merged_summary_counts_every_source_once() {
    let place = Place::new();
    let whole = place.succeeds(&with(&SHORT, &["--json", "-o", "a.npy"])).json();
    shards(&place, &SHORT, 3);
    let merged = place.succeeds(&["merge", "2.part", "0.part", "1.part", "--json", "-o", "b.npy"]).json();
    for key in [
        "width",
        "height",
        "directions",
        "sources",
        "iterations_total",
        "iterations_max",
        "cell_updates",
        "precision",
        "max",
        "mean",
    ] {
        assert_eq!(merged[key], whole[key], "{key}");
    }
    let seconds = |key: &str| merged["seconds"][key].as_f64().unwrap();
    assert!(seconds("propagation") + seconds("difference") <= seconds("total"));
}

#[test]
fn parts_that_do_not_belong_together_are_named() {
    let place = Place::new();
    shards(&place, &SHORT, 3);
    let (k, n) = (["--shard", "1/3", "-o"], ["-o", "new.vti"]);
    place.succeeds(&[&SHORT[..], &["--threshold", "0.25"], &k[..], &["threshold.part"]].concat());
    place.succeeds(&[&SHORT[..], &["--precision", "f32"], &k[..], &["single.part"]].concat());
    place.succeeds(
        &[&["ltg", "gyre:width=9,height=8", "--directions", "16"], &k[..], &["gyre.part"]].concat(),
    );
    let merge = |parts: &[&'static str], words: &[&str]| {
        place.refuses(&[&["merge"], parts, &n[..]].concat(), words);
    };
    merge(&["0.part", "2.part"], &["0.part, 2.part", "shard 1/3 is missing"]);
    merge(&["1.part"], &["1.part", "shard 0/3, 2/3 is missing"]);
    merge(&["0.part", "1.part", "1.part", "2.part"], &["1.part and 1.part", "finished twice", "1/3"]);
    merge(
        &["0.part", "threshold.part", "2.part"],
        &["0.part and threshold.part", "--threshold is 0.5 and 0.25"],
    );
    merge(&["0.part", "single.part", "2.part"], &["0.part and single.part", "--precision is f64 and f32"]);
    merge(&["0.part", "gyre.part", "2.part"], &["0.part and gyre.part", "the input is random", "gyre"]);
    merge(&["0.part", "nothing.part"], &["nothing.part", "reading"]);
    place.refuses(&["merge", "0.part", "-o", "new.xyz"], &["new.xyz", "expected .vti"]);
    place.refuses(&["merge", "-o", "new.vti"], &["<DIR|PART>"]);
    place.refuses(&["merge", "0.part"], &["--output"]);
}

#[test]
fn damaged_parts_are_refused_where_the_damage_is() {
    let place = Place::new();
    shards(&place, &SHORT, 1);
    let whole = place.read("0.part");
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 4;
    let middle = format!("byte {}", whole.len() / 2);
    for (bytes, words) in [
        (&whole[..whole.len() / 2], &["bad.part", middle.as_str(), "expected"][..]),
        (&whole[..5], &["bad.part", "byte 0", "tigerprt"]),
        (&[], &["bad.part", "byte 0"]),
        (b"not a part, but as long as the first bytes of one", &["bad.part", "byte 0"]),
        (&flipped, &["bad.part", "byte", "checksum", "damaged"]),
    ] {
        place.write("bad.part", bytes);
        place.refuses(&["merge", "bad.part", "-o", "new.vti"], words);
    }
}

/// Parts whose checksum is right and whose header is not.
#[test]
fn parts_whose_header_has_no_meaning_are_refused() {
    let place = Place::new();
    shards(&place, &SHORT, 1);
    let part = tigereye_io::part::read(&place.read("0.part")).unwrap();
    for (found, lie, words) in [
        ("\"width\":9", "\"width\":10", &["byte 24", "1152 values", "expected"][..]),
        ("\"width\":9", "\"width\":99999999999", &["byte 40", "grid"]),
        ("\"height\":8", "\"height\":-8", &["byte 40", "/summary/height"]),
        ("\"omega_step\":2", "\"omega_step\":0", &["byte 40", "angular step"]),
        ("\"directions\":16,\"input\"", "\"directions\":17,\"input\"", &["byte 40", "17 directions"]),
        ("\"slices\":[0,", "\"slices\":[99,", &["byte 40", "slice 99"]),
        ("\"slices\":[0,", "\"slices\":[1,", &["byte 24", "1152 values"]),
        ("\"shard\":\"0/1\"", "\"shard\":\"1/1\"", &["byte 40", "/shard"]),
        ("{", "[", &["byte", "JSON"]),
    ] {
        let header = part.header.replacen(found, lie, 1);
        assert_ne!(header, part.header, "{found}");
        place.write("bad.part", tigereye_io::part::write(&header, &part.values, &part.marks));
        place.refuses(&["merge", "bad.part", "-o", "new.vti"], &[&["bad.part"], words].concat());
    }
}

#[test]
fn shards_and_their_outputs_are_checked_before_anything_is_computed() {
    let place = Place::new();
    let long = ["ltg", "inverse:size=301"];
    for (more, words) in [
        (&["--shard", "0/2", "-o", "a.vti"][..], &["a.vti", "--shard", "NAME.part"][..]),
        (&["--shard", "0/2", "-o", "a.part", "b.part"], &["b.part", "one NAME.part"]),
        (&["--shard", "0/2", "-o", "a.part", "b.npy"], &["b.npy", "one NAME.part"]),
        (&["--shard", "0/2", "-o", "nowhere/a.part"], &["nowhere/a.part"]),
        (&["-o", "a.part"], &["a.part", "--shard K/N"]),
        (&["--shard", "2/2", "-o", "a.part"], &["--shard", "K from 0 to N-1"]),
        (&["--shard", "1", "-o", "a.part"], &["--shard", "K/N"]),
        (&["--shard", "0/2", "--memory", "1K", "--checkpoint", "c", "-o", "a.part"], &["--memory"]),
    ] {
        place.refuses(&with(&long, more), words);
    }
    assert!(!place.path("c").exists());
}

#[test]
fn single_precision_says_so_and_is_close() {
    let place = Place::new();
    place.succeeds(&with(&SHORT, &["-o", "double.vti"]));
    let args = with(&SHORT, &["--precision", "f32", "--json", "-o", "single.vti"]);
    assert_eq!(place.succeeds(&args).json()["precision"], "f32");
    assert!(place.image("single.vti").text("tigereye").unwrap().contains("\"precision\":\"f32\""));
    place.succeeds(&["compare", "double.vti", "single.vti", "--tolerance", "1e-4"]);
}

#[test]
fn a_finished_checkpoint_just_writes_the_output() {
    let place = Place::new();
    let plain = place.succeeds(&with(&SHORT, &["--json", "-o", "a.vti"])).json();
    let args = with(&SHORT, &["--checkpoint", "state/deep", "--json", "-o", "a.vti"]);
    place.succeeds(&args);
    let first = place.files();
    assert_eq!(first.len(), 3, "the output, the checkpoint and its lock");
    let again = place.succeeds(&args).json();
    place.same_files(&first);
    for key in ["sources", "iterations_total", "cell_updates", "max", "mean"] {
        assert_eq!(again[key], plain[key], "{key}");
    }
    // Other threads, memory and outputs are no other sweep.
    let other = ["--checkpoint", "state/deep", "--threads", "1", "--memory", "1G", "-o", "b.npy"];
    place.succeeds(&with(&SHORT, &other));
    assert_eq!(place.read("state/deep/checkpoint.part"), first[&place.path("state/deep/checkpoint.part")]);
}

#[test]
fn checkpoints_of_other_sweeps_are_refused_and_kept() {
    let place = Place::new();
    place.succeeds(&with(&SHORT, &["--checkpoint", "c", "-o", "a.vti"]));
    let ltg = |args: &[&str], words: &[&str]| {
        place.refuses(&[args, &["--checkpoint", "c"]].concat(), &[&["c/checkpoint.part"], words].concat());
    };
    let output = ["-o", "a.vti"];
    for (option, value, words) in [
        ("--threshold", "0.25", &["--threshold was 0.5 and is 0.25 now"][..]),
        ("--max-iterations", "7", &["--max-iterations was 1000 and is 7 now"]),
        ("--omega-step", "1", &["--omega-step was 2 and is 1 now"]),
        ("--slices", "3,1", &["--slices was 0,1,", "and is 1,3 now"]),
        ("--precision", "f32", &["--precision was f64 and is f32 now"]),
        ("--normalization", "global", &["--normalization was local and is global now"]),
        ("--total-anisotropy", "smooth", &["--total-anisotropy was 20 and is 20:2 now"]),
        ("--total-anisotropy", "none", &["--total-anisotropy was 20 and is none now"]),
        ("--stop", "distribution", &["--stop was flux and is distribution now"]),
    ] {
        ltg(&[&SHORT[..], &[option, value], &output].concat(), words);
    }
    ltg(
        &["ltg", "random:width=9,height=8", "--directions", "8", "-o", "a.vti"],
        &["--directions was 16 and is 8 now"],
    );
    ltg(
        &["ltg", "gyre:width=9,height=8", "--directions", "16", "-o", "a.vti"],
        &["the input was random", "is gyre"],
    );
    ltg(&with(&SHORT, &["--shard", "0/2", "-o", "a.part"]), &["--shard was none and is 0/2 now"]);
}

#[test]
fn damaged_checkpoints_are_refused_and_kept() {
    let place = Place::new();
    let args = with(&SHORT, &["--checkpoint", "c", "-o", "a.vti"]);
    place.succeeds(&args);
    let whole = place.read("c/checkpoint.part");
    let mut flipped = whole.clone();
    flipped[100] ^= 1;
    for (bytes, words) in [
        (&whole[..whole.len() - 1], &["byte", "expected"][..]),
        (&flipped[..], &["checksum"]),
        (&[], &["byte 0"]),
    ] {
        place.write("c/checkpoint.part", bytes);
        place.refuses(&args, &[&["c/checkpoint.part"], words].concat());
    }
    place.write("file", "");
    place.refuses(&with(&SHORT, &["--checkpoint", "file", "-o", "a.vti"]), &["--checkpoint file", "folder"]);
}

#[test]
fn what_killed_runs_left_is_removed() {
    let place = Place::new();
    place.write("c/.tigereye-checkpoint-x1y2", "half of a checkpoint");
    place.write("c/mine", "something else");
    place.succeeds(&with(&SHORT, &["--checkpoint", "c", "-o", "a.vti"]));
    let names: Vec<_> = place.files().keys().map(|p| p.file_name().unwrap().to_owned()).collect();
    assert_eq!(names, ["a.vti", "checkpoint.part", "lock", "mine"]);
}

fn wait_for(path: &Path, child: &mut Child) {
    let there_or_over = eventually(|| path.exists() || child.try_wait().unwrap().is_some());
    assert!(there_or_over && path.exists(), "no {}", path.display());
}

fn interrupt(child: &Child) {
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
}

/// The bytes of a sweep that nothing disturbed, with the same words on the command line.
fn undisturbed(args: &[&str]) -> Vec<u8> {
    let place = Place::new();
    place.succeeds(args);
    place.read("a.vti")
}

#[test]
fn killed_at_any_moment_a_sweep_goes_on_to_the_same_bytes() {
    let args = with(&LONG, &["--checkpoint", "c", "-o", "a.vti"]);
    let place = Place::new();
    let file = place.path("c/checkpoint.part");
    // Before there is a checkpoint, just when there is one, and later.
    for (wait, delay) in [(false, 20), (true, 0), (true, 1), (true, 60), (true, 300)] {
        let mut child = place.command(&args).spawn().unwrap();
        if wait {
            wait_for(&file, &mut child);
        }
        std::thread::sleep(Duration::from_millis(delay));
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(!place.path("a.vti").exists(), "killed before its end");
    }
    place.succeeds(&args);
    assert_eq!(place.read("a.vti"), undisturbed(&args));
    assert_eq!(place.files().len(), 3, "the output, the checkpoint and its lock");
}

#[test]
fn an_interrupted_sweep_completes_its_checkpoint_and_goes_on_from_there() {
    let args = with(&LONG, &["--checkpoint", "c", "-o", "a.vti"]);
    let place = Place::new();
    let mut child = place.command(&args).spawn().unwrap();
    wait_for(&place.path("c/checkpoint.part"), &mut child);
    let first = place.read("c/checkpoint.part");
    std::thread::sleep(Duration::from_millis(200));
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("tigereye: interrupted; progress saved in c/checkpoint.part"), "{stderr}");
    assert_eq!(place.files().len(), 2, "the checkpoint and its lock, no output");
    assert_ne!(place.read("c/checkpoint.part"), first, "what was finished meanwhile is in it");
    // The interrupted run's work is not done again.
    let done = tigereye_io::part::read(&place.read("c/checkpoint.part")).unwrap();
    assert!(done.marks.contains(&true) && done.marks.contains(&false));
    place.succeeds(&args);
    assert_eq!(place.read("a.vti"), undisturbed(&args));
}

#[test]
fn two_runs_do_not_share_a_folder() {
    let place = Place::new();
    let args = ["ltg", "inverse:size=101", "--checkpoint", "c", "-o", "a.vti"];
    let mut child = place.command(&args).spawn().unwrap();
    wait_for(&place.path("c"), &mut child);
    std::thread::sleep(Duration::from_millis(200));
    let run = place.tigereye(&with(&SHORT, &["--checkpoint", "c", "-o", "b.vti"]));
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("--checkpoint c: another run is using this folder"), "{}", run.stderr);
}

#[test]
fn a_full_disk_is_named_and_the_checkpoint_before_stays() {
    let place = Place::new();
    let args = with(&LONG, &["--checkpoint", "c", "-o", "a.vti"]);
    let mut child = place.command(&args).spawn().unwrap();
    wait_for(&place.path("c/checkpoint.part"), &mut child);
    interrupt(&child);
    child.wait().unwrap();
    let before = place.files();
    // Files may have 8 blocks of at most 1 KiB; the signal that tells so is ignored.
    let script =
        format!("trap '' XFSZ; ulimit -f 8; exec {} {}", env!("CARGO_BIN_EXE_tigereye"), args.join(" "));
    let output = Command::new("sh").args(["-c", &script]).current_dir(place.root()).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("c/checkpoint.part: writing failed"), "{stderr}");
    place.same_files(&before);
    place.succeeds(&args);
    assert_eq!(place.read("a.vti"), undisturbed(&args));
}

#[test]
fn the_cluster_scripts_compute_shards_and_merge_them() {
    let place = Place::new();
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/slurm");
    let program = Path::new(env!("CARGO_BIN_EXE_tigereye")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let run = |script: &str, args: &[&str], task: usize| {
        let output = Command::new("bash")
            .arg(scripts.join(script))
            .args(args)
            .current_dir(place.root())
            .env("PATH", &path)
            .env("TIGEREYE_PARTS", "parts")
            .env("TIGEREYE_MEMORY", "1G")
            .env("SLURM_ARRAY_TASK_ID", task.to_string())
            .env("TIGEREYE_SHARDS", "3")
            .env("SLURM_CPUS_PER_TASK", "1")
            .output()
            .unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), beside_thin_cells(&stderr).as_str()), (Some(0), ""), "{script}");
    };
    for task in [0, 1, 2, 1] {
        run("sweep.sbatch", &SHORT[1..], task);
    }
    run("merge.sbatch", &["merged.npy"], 0);
    place.succeeds(&with(&SHORT, &["-o", "whole.npy"]));
    assert_eq!(place.read("merged.npy"), place.read("whole.npy"));
}
