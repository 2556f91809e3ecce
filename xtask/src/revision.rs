//! Results of a git revision: a worktree of its own, built and run, and removed again.

use crate::error::Fault;
use crate::interrupt;
use std::ffi::{OsStr, OsString};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tempfile::TempDir;

/// How often a running program is looked at.
const PAUSE: Duration = Duration::from_millis(50);

/// How often a folder is tried to be removed by a process that ends at once.
const ATTEMPTS: usize = 40;

/// The process group that is running, 0 for none.
static RUNNING: AtomicU32 = AtomicU32::new(0);

/// The commit of a revision; none where git knows no such revision.
pub(crate) fn commit(name: &str) -> Result<Option<String>, Fault> {
    if name.is_empty() || name.starts_with('-') {
        return Ok(None);
    }
    let mut git = Command::new("git");
    git.args(["rev-parse", "--verify", "--quiet", "--end-of-options", &format!("{name}^{{commit}}")]);
    let output = git.stdin(Stdio::null()).output().map_err(not_run("git"))?;
    let commit = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    let is_commit = commit.len() >= 40 && commit.bytes().all(|b| b.is_ascii_hexdigit());
    Ok((output.status.success() && is_commit).then_some(commit))
}

/// The names of a commit's experiments.
pub(crate) fn slugs(commit: &str) -> Result<Vec<String>, Fault> {
    let mut git = Command::new("git");
    git.args(["ls-tree", "-r", "-z", "--full-tree", "--name-only", commit, "experiments/"]);
    let output = git.stdin(Stdio::null()).output().map_err(not_run("git"))?;
    let paths = String::from_utf8_lossy(&output.stdout).into_owned();
    Ok(paths.split('\0').filter_map(slug_of).collect())
}

/// The experiment of a file name. Files `NAME.KIND.ron` are fields or scenes.
fn slug_of(path: &str) -> Option<String> {
    let slug = path.rsplit('/').next()?.strip_suffix(".ron")?;
    (!slug.contains('.')).then(|| slug.to_owned())
}

/// The folder of a [`Workshop`], for a process that ends at once; see [`abandon`].
static FOLDER: Mutex<Option<PathBuf>> = Mutex::new(None);

fn folder_made() -> MutexGuard<'static, Option<PathBuf>> {
    FOLDER.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary folder for everything that revisions need, made for the first of them. Their common parts are built
/// once.
#[derive(Default)]
pub(crate) struct Workshop {
    folder: Option<TempDir>,
    /// Revisions made so far.
    made: usize,
}

impl Workshop {
    /// The results of a commit, of the experiments `only` or of all, in a folder that lasts as long as this.
    pub(crate) fn results(&mut self, name: &str, commit: &str, only: &[String]) -> Result<PathBuf, Fault> {
        let folder = self.folder()?;
        self.made += 1;
        let worktree = Worktree { path: folder.join(format!("worktree-{}", self.made)) };
        let (results, target) = (folder.join(format!("results-{}", self.made)), folder.join("target"));
        eprintln!("{name}: taking out {} into {}", &commit[..12], worktree.path.display());
        let mut git = Command::new("git");
        git.args(["worktree", "add", "--quiet", "--detach", "--force"]).arg(&worktree.path).arg(commit);
        succeeds(name, git, &[0])?;

        eprintln!("{name}: building");
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo")));
        cargo.args(["build", "--release", "--quiet", "-p", "tigereye-cli"]).current_dir(&worktree.path);
        cargo.env("CARGO_TARGET_DIR", &target);
        succeeds(name, cargo, &[0])?;

        eprintln!("{name}: running reproduce");
        let program = target.join("release").join(format!("tigereye{}", std::env::consts::EXE_SUFFIX));
        let mut reproduce = Command::new(program);
        // Its exit code is 1 where a check failed: that is a result, too.
        reproduce.args([OsStr::new("reproduce"), OsStr::new("--out"), results.as_os_str()]);
        reproduce.args(only.iter().flat_map(|slug| ["--only", slug]));
        succeeds(name, reproduce, &[0, 1])?;
        Ok(results)
    }

    fn folder(&mut self) -> Result<PathBuf, Fault> {
        if let Some(folder) = &self.folder {
            return Ok(folder.path().to_path_buf());
        }
        let above = std::env::temp_dir();
        let fault = || Fault::file(&above, "making a folder");
        let folder = tempfile::Builder::new().prefix("tigereye-review-").tempdir().map_err(fault())?;
        // As git writes it: without links.
        let path = folder.path().canonicalize().map_err(fault())?;
        *folder_made() = Some(path.clone());
        self.folder = Some(folder);
        Ok(path)
    }
}

impl Drop for Workshop {
    fn drop(&mut self) {
        // Who abandons it waits until it is gone.
        let mut made = folder_made();
        drop(self.folder.take());
        *made = None;
    }
}

/// A worktree, removed at the end, however that comes.
struct Worktree {
    path: PathBuf,
}

impl Drop for Worktree {
    fn drop(&mut self) {
        let remove = ["worktree", "remove", "--force"].map(OsStr::new);
        if !git_succeeds(&[&remove[..], &[self.path.as_os_str()]].concat()) {
            // Never added, or half: the folder goes with its parent, git forgets it here.
            let _ = std::fs::remove_dir_all(&self.path);
            forget_worktrees();
        }
    }
}

/// Lets git forget the worktrees whose folders are gone.
fn forget_worktrees() {
    git_succeeds(&["worktree", "prune", "--expire=now"].map(OsStr::new));
}

/// Runs git silently; a second interrupt must not reach it halfway.
fn git_succeeds(args: &[&OsStr]) -> bool {
    let mut git = Command::new("git");
    git.args(args).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    in_own_group(&mut git);
    git.status().is_ok_and(|s| s.success())
}

/// Runs a program to its end; an interrupt ends it, too.
fn succeeds(name: &str, mut command: Command, codes: &[i32]) -> Result<(), Fault> {
    interrupt::check()?;
    let program =
        Path::new(command.get_program()).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let words: Vec<String> = std::iter::once(program.clone())
        .chain(command.get_args().map(|w| w.to_string_lossy().into_owned()))
        .collect();
    command.stdin(Stdio::null()).stdout(Stdio::null());
    in_own_group(&mut command);
    let mut child = command.spawn().map_err(not_run(&program))?;
    RUNNING.store(child.id(), Ordering::SeqCst);
    let status = wait(&mut child, &program);
    RUNNING.store(0, Ordering::SeqCst);
    let status = status?;
    if status.code().is_some_and(|c| codes.contains(&c)) {
        Ok(())
    } else {
        Err(Fault::Ended { name: name.to_owned(), command: words.join(" "), status })
    }
}

fn wait(child: &mut Child, program: &str) -> Result<ExitStatus, Fault> {
    let mut asked = false;
    loop {
        if let Some(status) = child.try_wait().map_err(not_run(program))? {
            return if asked { Err(Fault::Interrupted) } else { Ok(status) };
        }
        if interrupt::asked() && !asked {
            asked = true;
            end_group(child.id(), "-TERM");
        }
        std::thread::sleep(PAUSE);
    }
}

/// Ends what is running and clears away, for a process that ends right now.
pub(crate) fn abandon() {
    // Held to the end: who clears away after the first interrupt waits, and the process ends here.
    let made = folder_made();
    let Some(folder) = made.as_deref() else { return };
    end_group(RUNNING.load(Ordering::SeqCst), "-KILL");
    for _ in 0..ATTEMPTS {
        // What was killed may still be ending, and the first interrupt may be clearing away, too.
        match std::fs::remove_dir_all(folder) {
            Err(e) if e.kind() != ErrorKind::NotFound || folder.exists() => std::thread::sleep(PAUSE),
            _ => break,
        }
    }
    forget_worktrees();
    std::mem::forget(made);
}

/// Compilers are children of children: all of them end together, and not by a Ctrl-C that only we should answer.
#[cfg(unix)]
fn in_own_group(command: &mut Command) {
    use std::os::unix::process::CommandExt;
    command.process_group(0);
}

#[cfg(not(unix))]
fn in_own_group(_command: &mut Command) {}

fn end_group(id: u32, signal: &str) {
    if id != 0 && cfg!(unix) {
        // Where there is no `kill`, the programs end by themselves.
        let _ = Command::new("kill").args([signal, "--", &format!("-{id}")]).stderr(Stdio::null()).status();
    }
}

fn not_run(program: &str) -> impl FnOnce(std::io::Error) -> Fault {
    let program = program.to_owned();
    move |source| Fault::NotRun { program, source }
}
