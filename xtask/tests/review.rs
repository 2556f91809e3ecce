//! `cargo xtask review` of revisions, with a stand-in for cargo that makes a program of the revision's contents.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use std::os::unix::fs::PermissionsExt;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tigereye_test_support::{Folder, Run, eventually};

/// The program of a revision copies the summary stored in that revision.
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

fn git(place: &Folder, args: &[&str]) -> String {
    let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
    let mut git = Command::new("git");
    let output = git.args(identity).args(args).current_dir(place.root()).output().unwrap();
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn text(place: &Folder, name: &str) -> String {
    String::from_utf8(place.read(name)).unwrap()
}

fn commit(place: &Folder, tag: &str) {
    git(place, &["add", "--all"]);
    git(place, &["commit", "--quiet", "-m", tag]);
    git(place, &["tag", tag]);
}

fn summary(x: f64) -> String {
    let check = format!(r#"{{"name": "n", "value": {x:?}, "passed": true}}"#);
    format!(r#"{{"experiments": [{{"slug": "a", "checks": [{check}]}}]}}"#)
}

/// A repository with the revisions `one`, `two` and `broken`.
fn repository() -> Folder {
    let place = Folder::new();
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

fn command(place: &Folder, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    command.args(args).current_dir(place.root()).stdin(Stdio::null());
    command.env("CARGO", place.path("cargo.sh")).env("TMPDIR", place.path("tmp"));
    command.env("MARK", place.path("mark"));
    command
}

#[track_caller]
fn leaves_nothing(place: &Folder) {
    assert_eq!(git(place, &["worktree", "list"]).lines().count(), 1);
    assert_eq!(std::fs::read_dir(place.path("tmp")).unwrap().count(), 0);
}

fn run(place: &Folder, args: &[&str]) -> Run {
    Run::of(command(place, args).output().unwrap())
}

#[test]
fn revisions_are_built_and_run() {
    let place = repository();
    let one = run(&place, &["review", "one", "two"]);
    assert_eq!(one.code, 1, "{}", one.stderr);
    assert!(one.stderr.contains("one: building") && one.stderr.contains("two: running"), "{}", one.stderr);
    assert!(one.stdout.contains("check n"), "{}", one.stdout);
    assert!(text(&place, "review/review.html").contains("<code>one</code>"));
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
    assert!(message.starts_with("xtask: broken: `cargo.sh build") && message.contains('7'), "{message}");
    assert!(!place.path("review").exists());
    leaves_nothing(&place);
    // Nothing is built if one of the two is unknown.
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
    let arguments = || text(&place, "mark");
    let both = run(&place, &["review", "later", "later", "--only", "a", "--only", "b"]);
    assert_eq!(both.code, 0, "{}", both.stderr);
    assert_eq!(arguments(), "--only a --only b\n".repeat(2));
    std::fs::remove_file(place.path("mark")).unwrap();
    // The earlier side has none, so it is not built.
    let added = run(&place, &["review", "one", "later", "--only", "a"]);
    assert!(added.code == 1 && added.stdout.contains("0 moved, 1 added"), "{}{}", added.stdout, added.stderr);
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
fn begun(place: &Folder, lasts: &str) -> Child {
    std::fs::remove_file(place.path("build-fails")).unwrap();
    place.write(lasts, "");
    commit(place, "long");
    let mut command = command(place, &["review", "long", "one"]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    assert!(eventually(|| place.path("mark").exists()), "the build never began");
    assert_eq!(git(place, &["worktree", "list"]).lines().count(), 2);
    child
}

fn interrupt(child: &Child) {
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
}

#[track_caller]
fn ends_interrupted(place: &Folder, mut child: Child) {
    assert!(eventually(|| child.try_wait().unwrap().is_some()), "the task goes on after an interrupt");
    let ended = Run::of(child.wait_with_output().unwrap());
    assert_eq!(ended.code, 130, "{}", ended.stderr);
    assert!(!place.path("review").exists());
    leaves_nothing(place);
}

#[test]
fn an_interrupt_ends_the_build_and_removes_the_worktree() {
    let place = repository();
    let child = begun(&place, "build-lasts");
    interrupt(&child);
    ends_interrupted(&place, child);
}

/// The first interrupt waits for a build that does not listen; the second waits for nothing.
#[test]
fn a_second_interrupt_leaves_no_worktree_either() {
    let place = repository();
    let mut child = begun(&place, "build-stubborn");
    interrupt(&child);
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "the build listens");
    interrupt(&child);
    ends_interrupted(&place, child);
}
