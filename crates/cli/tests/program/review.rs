//! `review`: two results, revisions, pending snapshots, and what cannot be compared.

use crate::support::{Place, has_keys};
use serde_json::{Value, json};

/// An experiment whose check and first figure depend on the anisotropy, its second figure on nothing.
fn experiment(anisotropy: &str, expect: &str) -> String {
    format!(
        r#"(
    format: 1, title: "Turning", source: "here", section: "1", claim: "c", look_for: "l",
    fields: {{
        "f": Generator(name: "inverse", parameters: {{"size": 7, "anisotropy": {anisotropy}}}),
        "g": Generator(name: "inverse", parameters: {{"size": 5}}),
    }},
    runs: {{ "light": Light(field: "f", directions: 16, lights: [()], stop: Steps(9)) }},
    figures: [
        (name: "moving", caption: "d", panels: [Glyphs(field: "f", title: "t")]),
        (name: "still", caption: "d", panels: [Glyphs(field: "g", title: "t")]),
    ],
    checks: [
        (name: "anisotropy", quantity: LargestAxis(field: "f"), expect: {expect}, basis: "b"),
        (name: "steps", quantity: Steps(run: "light"), expect: Near(9, 0), basis: "b"),
    ],
)
"#
    )
}

/// Runs both experiments of a folder into results of the same name.
fn results(place: &Place, name: &str, anisotropy: &str, expect: &str) {
    place.write(&format!("{name}-files/turning.ron"), experiment(anisotropy, expect));
    place.write(&format!("{name}-files/constant.ron"), experiment("4", "AtLeast(0)"));
    let folder = format!("{name}-files");
    let run = place.tigereye(&["reproduce", "--experiments", &folder, "--out", name]);
    assert!(run.code < 2, "{}", run.stderr);
}

fn page(place: &Place, name: &str) -> String {
    String::from_utf8(place.read(name)).unwrap()
}

#[test]
fn equal_results_end_with_0() {
    let place = Place::new();
    results(&place, "before", "10", "AtLeast(0)");
    results(&place, "after", "10", "AtLeast(0)");
    let run = place.succeeds(&["review", "before", "after"]);
    assert!(run.stdout.contains("2 experiments: 0 moved, 0 added, 0 gone, 2 unchanged"), "{}", run.stdout);
    assert!(run.stdout.contains("page: review/review.html"), "{}", run.stdout);
    let review = place.json("review/review.json");
    assert_eq!((&review["moved"], &review["base"]), (&json!(false), &json!("before")));
    let run = place.succeeds(&["review", "before", "after", "--only", "turning"]);
    assert!(run.stdout.contains("1 experiment: 0 moved, 0 added, 0 gone, 1 unchanged"), "{}", run.stdout);
    assert!(page(&place, "review/review.html").contains("Nothing moved."));
}

#[test]
fn a_number_that_moves_is_shown_with_its_figure() {
    let place = Place::new();
    results(&place, "before", "10", "AtLeast(0)");
    results(&place, "after", "12", "AtLeast(0)");
    let run = place.tigereye(&["review", "before", "after", "--out", "deep/er"]);
    assert_eq!((run.code, run.stderr.as_str()), (1, ""));
    assert!(run.stdout.contains("1 moved") && run.stdout.contains("check anisotropy"), "{}", run.stdout);
    assert!(run.stdout.lines().count() <= 25);
    let review = place.json("deep/er/review.json");
    has_keys(&review, &["base", "head", "tolerance", "moved", "experiments"]);
    let turning = &review["experiments"][0];
    has_keys(
        turning,
        &["slug", "state", "largest_change", "numbers", "figures", "base_seconds", "head_seconds"],
    );
    assert_eq!((&turning["slug"], &turning["state"]), (&json!("turning"), &json!("moved")));
    let names: Vec<&Value> = turning["numbers"].as_array().unwrap().iter().map(|n| &n["name"]).collect();
    assert_eq!(names, ["anisotropy"]);
    let number = &turning["numbers"][0];
    let summary = place.json("after/summary.json");
    let experiments = summary["experiments"].as_array().unwrap();
    let of_summary = experiments.iter().find(|e| e["slug"] == "turning").unwrap();
    assert_eq!(number["head"], of_summary["checks"][0]["value"]);
    assert_eq!(turning["head_seconds"], of_summary["seconds"]);
    let (a, b) = (number["base"].as_f64().unwrap(), number["head"].as_f64().unwrap());
    let change = number["relative_change"].as_f64().unwrap();
    assert!((change - (b - a).abs() / a.abs().max(b.abs())).abs() < 1e-12, "{change}");
    for figure in turning["figures"].as_array().unwrap() {
        has_keys(figure, &["name", "state", "pixels_differing", "largest_difference"]);
        let moved = figure["name"] == "moving";
        assert_eq!(figure["state"], if moved { "moved" } else { "unchanged" });
        assert_eq!(figure["pixels_differing"].as_u64().unwrap() > 0, moved);
    }
    assert_eq!(review["experiments"][1]["state"], "unchanged");
    let page = page(&place, "deep/er/review.html");
    assert_eq!(page.matches("<img ").count(), 3);
    for outside in ["http:", "https:", "url(", "<link", "<script src"] {
        assert!(!page.contains(outside), "{outside}");
    }
    // Figures count whatever the tolerance, numbers do not.
    let run = place.tigereye(&["review", "before", "after", "--tolerance", "10"]);
    assert_eq!(run.code, 1);
    assert!(run.stdout.contains("0 checks moved") && run.stdout.contains("1 figure moved"), "{}", run.stdout);
}

#[test]
fn verdicts_and_experiments_that_come_and_go_are_movement() {
    let place = Place::new();
    results(&place, "before", "10", "AtLeast(0)");
    results(&place, "after", "10", "AtLeast(5)");
    std::fs::remove_file(place.path("after-files/constant.ron")).unwrap();
    place.write("after-files/fresh.ron", experiment("4", "AtLeast(0)"));
    assert_eq!(place.tigereye(&["reproduce", "--experiments", "after-files", "--out", "after"]).code, 1);
    let run = place.tigereye(&["review", "before", "after"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(run.stdout.contains("1 moved, 1 added, 1 gone, 0 unchanged"), "{}", run.stdout);
    assert!(run.stdout.contains("1 verdict changed"), "{}", run.stdout);
    let review = place.json("review/review.json");
    let states: Vec<_> =
        review["experiments"].as_array().unwrap().iter().map(|e| [&e["slug"], &e["state"]]).collect();
    assert_eq!(json!(states), json!([["turning", "moved"], ["constant", "gone"], ["fresh", "added"]]));
    let number = &review["experiments"][0]["numbers"][0];
    assert_eq!((&number["base_passed"], &number["head_passed"]), (&json!(true), &json!(false)));
}

#[test]
fn what_is_no_result_is_refused() {
    let place = Place::new();
    results(&place, "good", "10", "AtLeast(0)");
    place.write("garbage/summary.json", "not json");
    place.write(
        "odd/summary.json",
        r#"{"experiments": [{"slug": "a", "checks": [{"name": "n", "value": "x"}]}]}"#,
    );
    place.write("bytes/summary.json", [0xff, 0xfe]);
    place.write(
        "escape/summary.json",
        r#"{"experiments": [{"slug": "a", "checks": [], "figures": ["../a.png"]}]}"#,
    );
    place.write(
        "lacking/summary.json",
        r#"{"experiments": [{"slug": "a", "checks": [], "figures": ["a/b.png"]}]}"#,
    );
    place.write("empty/readme", "no results");
    place.refuses(&["review", "good", "missing"], &["missing", "no git revision", "missing/summary.json"]);
    place.refuses(&["review", "empty", "good"], &["empty", "no git revision"]);
    place.refuses(&["review", "good", "garbage"], &["garbage/summary.json", "expected the JSON"]);
    place.refuses(&["review", "odd", "good"], &["odd/summary.json", "experiments[0].checks[0]"]);
    place.refuses(&["review", "good", "bytes"], &["bytes/summary.json", "UTF-8"]);
    place.refuses(&["review", "escape", "good"], &["escape/summary.json", "experiments[0].figures[0]"]);
    place.refuses(&["review", "lacking", "good"], &["lacking/a/b.png", "No such file"]);
    place.refuses(&["review", "good"], &["<HEAD>"]);
    place.refuses(&["review"], &["<BASE>"]);
    place.refuses(&["review", "good", "good", "--tolerance", "-1"], &["--tolerance", "from 0"]);
    place.refuses(&["review", "good", "good", "--snapshots"], &["--snapshots", "cannot be used"]);
    place.write("file", "a file");
    place.refuses(&["review", "good", "good", "--out", "file"], &["file: "]);
    place
        .refuses(&["review", "good", "good", "--only", "nothing"], &["--only nothing", "no such experiment"]);
    place.refuses(&["review", "--snapshots", "--only", "turning"], &["--only", "cannot be used"]);
    // A figure that is no picture.
    let mut files = place.files().into_keys();
    let figure = files.find(|p| p.ends_with("good/turning/moving.png")).unwrap();
    for (name, bytes) in place.files() {
        if let Ok(inside) = name.strip_prefix(place.path("good")) {
            let bytes = if name == figure { b"junk".to_vec() } else { bytes };
            place.write(&format!("broken/{}", inside.display()), bytes);
        }
    }
    place.refuses(&["review", "good", "broken"], &["broken/turning/moving.png"]);
}

const SNAPSHOT: &str = "---\nsource: a.rs\n---\nDigest(\n  slug: \"a\",\n  mean: \"1.00000000e0\",\n  figures: [\n    \"f 10x10\",\n  ],\n)\n";

#[test]
fn pending_snapshots_are_compared() {
    let place = Place::new();
    place.write("snaps/digest@a.snap", SNAPSHOT);
    place.write("snaps/digest@b.snap", SNAPSHOT);
    let run = place.succeeds(&["review", "--snapshots", "snaps"]);
    assert!(
        run.stdout.contains("0 snapshots pending") && run.stdout.contains("2 snapshots without"),
        "{}",
        run.stdout
    );
    place.write(
        "snaps/digest@a.snap.new",
        SNAPSHOT.replace("1.00000000", "1.50000000").replace("10x10", "10x20"),
    );
    place.write("snaps/digest@c.snap.new", SNAPSHOT);
    let run = place.tigereye(&["review", "--snapshots", "snaps", "--out", "out"]);
    assert_eq!((run.code, run.stderr.as_str()), (1, ""), "{}", run.stdout);
    assert!(run.stdout.contains("2 snapshots pending: 1 moved, 1 added"), "{}", run.stdout);
    let review = place.json("out/review.json");
    let states: Vec<_> =
        review["experiments"].as_array().unwrap().iter().map(|e| [&e["slug"], &e["state"]]).collect();
    assert_eq!(json!(states), json!([["digest@a", "moved"], ["digest@c", "added"]]));
    let numbers = &review["experiments"][0]["numbers"];
    assert_eq!((&numbers[0]["name"], &numbers[0]["head"]), (&json!("mean"), &json!(1.5)));
    assert_eq!((&numbers[1]["name"], &numbers[1]["head"]), (&json!("figures[0]"), &json!("f 10x20")));
    assert!(page(&place, "out/review.html").contains("figures[0]"));
    // The folder of the project is looked for where no other is named.
    place.refuses(&["review", "--snapshots"], &["crates/experiments/tests/snapshots", "No such file"]);
    place.refuses(&["review", "--snapshots", "nowhere"], &["nowhere", "No such file"]);
}

/// Revisions, with a stand-in for cargo that makes a program out of what the revision holds.
#[cfg(unix)]
mod revisions {
    use super::page;
    use crate::support::{Place, Run};
    use std::os::unix::fs::PermissionsExt;
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    /// The program of a revision copies the summary that the revision holds.
    const CARGO: &str = r#"#!/bin/sh
test "$*" = "build --release --quiet -p tigereye-cli" || exit 9
test -f build-fails && exit 7
if test -f build-lasts; then echo $$ > "$MARK"; sleep 60; fi
if test -f build-stubborn; then trap '' TERM; echo $$ > "$MARK"; for i in 1 2 3 4 5 6 7 8 9; do sleep 7; done; fi
mkdir -p "$CARGO_TARGET_DIR/release"
cat > "$CARGO_TARGET_DIR/release/tigereye" <<END
#!/bin/sh
mkdir -p "\$3"
cp "$PWD/summary" "\$3/summary.json"
shift 3
echo "\$@" >> "$MARK"
exit 1
END
chmod +x "$CARGO_TARGET_DIR/release/tigereye"
"#;

    fn git(place: &Place, args: &[&str]) -> String {
        let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
        let mut git = Command::new("git");
        let output = git.args(identity).args(args).current_dir(place.root()).output().unwrap();
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }

    fn commit(place: &Place, tag: &str) {
        git(place, &["add", "--all"]);
        git(place, &["commit", "--quiet", "-m", tag]);
        git(place, &["tag", tag]);
    }

    fn summary(x: f64) -> String {
        let check = format!(r#"{{"name": "n", "value": {x:?}, "passed": true}}"#);
        format!(r#"{{"experiments": [{{"slug": "a", "checks": [{check}]}}]}}"#)
    }

    /// A repository with the revisions `one`, `two` and `broken`.
    fn repository() -> Place {
        let place = Place::new();
        git(&place, &["init", "--quiet"]);
        place.write("cargo.sh", CARGO);
        std::fs::set_permissions(place.path("cargo.sh"), std::fs::Permissions::from_mode(0o755)).unwrap();
        place.write(".gitignore", "/tmp\n/review\n/mark\n");
        for (tag, x) in [("one", 1.0), ("two", 2.0)] {
            place.write("summary", summary(x));
            commit(&place, tag);
        }
        place.write("build-fails", "");
        commit(&place, "broken");
        std::fs::create_dir(place.path("tmp")).unwrap();
        place
    }

    fn command(place: &Place, args: &[&str]) -> Command {
        let mut command = place.command(args);
        command.env("CARGO", place.path("cargo.sh")).env("TMPDIR", place.path("tmp"));
        command.env("MARK", place.path("mark"));
        command
    }

    #[track_caller]
    fn leaves_nothing(place: &Place) {
        assert_eq!(git(place, &["worktree", "list"]).lines().count(), 1);
        assert_eq!(std::fs::read_dir(place.path("tmp")).unwrap().count(), 0);
    }

    fn run(place: &Place, args: &[&str]) -> Run {
        Run::of(command(place, args).output().unwrap())
    }

    #[test]
    fn revisions_are_built_and_run() {
        let place = repository();
        let one = run(&place, &["review", "one", "two"]);
        assert_eq!(one.code, 1, "{}", one.stderr);
        assert!(
            one.stderr.contains("one: building") && one.stderr.contains("two: running"),
            "{}",
            one.stderr
        );
        assert!(one.stdout.contains("check n"), "{}", one.stdout);
        assert!(page(&place, "review/review.html").contains("<code>one</code>"));
        leaves_nothing(&place);
        assert_eq!(run(&place, &["review", "one", "two~1"]).code, 0);
        // A folder beside a revision.
        place.write("folder/summary.json", summary(2.0));
        assert_eq!(run(&place, &["review", "folder", "two"]).code, 0);
        leaves_nothing(&place);
    }

    #[test]
    fn a_revision_that_cannot_be_built_is_said_and_cleared_away() {
        let place = repository();
        let broken = run(&place, &["review", "one", "broken"]);
        assert_eq!(broken.code, 2, "{}", broken.stderr);
        let message = broken.stderr.lines().last().unwrap();
        assert!(
            message.starts_with("tigereye: broken: `cargo.sh build") && message.contains('7'),
            "{message}"
        );
        assert!(!place.path("review").exists());
        leaves_nothing(&place);
        // Nothing is built for a pair of which one is unknown.
        let unknown = run(&place, &["review", "one", "three"]);
        assert_eq!((unknown.code, unknown.stderr.lines().count()), (2, 1), "{}", unknown.stderr);
    }

    #[test]
    fn of_revisions_only_the_named_experiments_run() {
        let place = repository();
        std::fs::remove_file(place.path("build-fails")).unwrap();
        for file in ["a.ron", "b.ron", "b.field.ron"] {
            place.write(&format!("experiments/x/{file}"), "");
        }
        commit(&place, "later");
        let arguments = || String::from_utf8(place.read("mark")).unwrap();
        let both = run(&place, &["review", "later", "later", "--only", "a", "--only", "b"]);
        assert_eq!(both.code, 0, "{}", both.stderr);
        assert_eq!(arguments(), "--only a --only b\n".repeat(2));
        std::fs::remove_file(place.path("mark")).unwrap();
        // Before, there was none: that side is not built.
        let added = run(&place, &["review", "one", "later", "--only", "a"]);
        assert!(
            added.code == 1 && added.stdout.contains("0 moved, 1 added"),
            "{}{}",
            added.stdout,
            added.stderr
        );
        assert!(!added.stderr.contains("one: building"), "{}", added.stderr);
        assert_eq!(arguments(), "--only a\n");
        for unknown in ["c", "b.field"] {
            let refused = run(&place, &["review", "one", "later", "--only", unknown]);
            assert_eq!((refused.code, refused.stderr.lines().count()), (2, 1), "{}", refused.stderr);
            assert!(refused.stderr.contains("no such experiment in one or later"), "{}", refused.stderr);
        }
        leaves_nothing(&place);
    }

    /// Starts a review of a revision whose build lasts; ends once it is building.
    fn begun(place: &Place, lasts: &str) -> (Child, Instant) {
        std::fs::remove_file(place.path("build-fails")).unwrap();
        place.write(lasts, "");
        commit(place, "long");
        let mut command = command(place, &["review", "long", "one"]);
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let start = Instant::now();
        while !place.path("mark").exists() {
            assert!(start.elapsed() < Duration::from_secs(20), "the build never began");
            std::thread::sleep(Duration::from_millis(10));
        }
        assert_eq!(git(place, &["worktree", "list"]).lines().count(), 2);
        (child, start)
    }

    fn interrupt(child: &Child) {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    }

    #[track_caller]
    fn ends_interrupted(place: &Place, mut child: Child, start: Instant) {
        while child.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < Duration::from_secs(40), "the program goes on after an interrupt");
            std::thread::sleep(Duration::from_millis(10));
        }
        let ended = Run::of(child.wait_with_output().unwrap());
        assert_eq!(ended.code, 130, "{}", ended.stderr);
        assert!(!place.path("review").exists());
        leaves_nothing(place);
    }

    #[test]
    fn an_interrupt_ends_the_build_and_removes_the_worktree() {
        let place = repository();
        let (child, start) = begun(&place, "build-lasts");
        interrupt(&child);
        ends_interrupted(&place, child, start);
    }

    /// The first interrupt waits for a build that does not listen; the second waits for nothing.
    #[test]
    fn a_second_interrupt_leaves_no_worktree_either() {
        let place = repository();
        let (mut child, start) = begun(&place, "build-stubborn");
        interrupt(&child);
        std::thread::sleep(Duration::from_millis(300));
        assert!(child.try_wait().unwrap().is_none(), "the build listens");
        interrupt(&child);
        ends_interrupted(&place, child, start);
    }
}
