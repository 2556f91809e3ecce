//! A folder in which a sweep keeps what is finished.

use crate::error::CliError;
use crate::part_file::{self, Costs, Identity, Kept, PartFile};
use crate::{files, interrupt};
use std::fs::{File, TryLockError};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tigereye_ltg::Shard;

/// Name of the file in the folder.
const FILE: &str = "checkpoint.part";
/// The file that one run at a time locks.
const LOCK: &str = "lock";
/// How the names of temporary files in the folder begin.
const TEMPORARY: &str = ".tigereye-checkpoint-";
/// A checkpoint is written at most so often,
const PAUSE: Duration = Duration::from_secs(2);
/// and after so many times as long as the last one took: at most 2.5 % of the time.
const PAUSE_OVER_DURATION: u32 = 40;

/// The file, and when it was written last.
pub(crate) struct Checkpoint {
    path: PathBuf,
    command: String,
    identity: Identity,
    shard: Shard,
    state: Mutex<State>,
    /// The lock on the folder, for as long as this lives.
    _lock: Option<File>,
}

#[derive(Default)]
struct State {
    last: Option<Instant>,
    took: Duration,
    /// Cells and sets missing in the file.
    missing: Option<usize>,
    fault: Option<CliError>,
}

impl Checkpoint {
    /// Makes the folder where it is missing, and reads what an earlier run of the same sweep left in it. Nothing of
    /// another sweep is touched.
    pub(crate) fn open(
        folder: &Path,
        command: String,
        identity: Identity,
        shard: Shard,
    ) -> Result<(Self, Option<PartFile>), CliError> {
        let name = format!("--checkpoint {}", folder.display());
        if folder.exists() && !folder.is_dir() {
            return Err(CliError::input(&name, "is not a folder: expected a folder, or a name for one"));
        }
        files::make_folder(folder)?;
        let lock = lock(folder, &name)?;
        if lock.is_some() {
            remove_strays(folder);
        } else {
            eprintln!("tigereye: {name}: cannot be locked here; see that no other run uses it");
        }
        let path = folder.join(FILE);
        files::check_writable(&path)?;
        let found = if path.exists() { Some(part_file::read(&path)?) } else { None };
        if let Some(found) = &found {
            let difference = found.identity.difference(&identity).or_else(|| {
                let differs = found.shard != shard;
                differs.then(|| ("--shard".to_owned(), shard_name(found.shard), shard_name(shard)))
            });
            if let Some((what, before, now)) = difference {
                let problem = format!(
                    "belongs to another sweep: {what} was {before} and is {now} now; expected the same, or another folder"
                );
                return Err(CliError::input(&path.display().to_string(), problem));
            }
        }
        let missing = found.as_ref().map(|f| f.content.kept().missing(Shard::WHOLE));
        let state = Mutex::new(State { missing, ..State::default() });
        Ok((Self { path, command, identity, shard, state, _lock: lock }, found))
    }

    /// Writes what is finished where it is time to. `Break` where that failed.
    pub(crate) fn offer(&self, kept: &dyn Kept, costs: impl FnOnce() -> Costs) -> ControlFlow<()> {
        let mut state = self.state();
        if state.fault.is_some() {
            return ControlFlow::Break(());
        }
        let missing = kept.missing(Shard::WHOLE);
        let pause = PAUSE.max(state.took * PAUSE_OVER_DURATION);
        let is_due = state.last.is_none_or(|last| last.elapsed() >= pause);
        if state.missing == Some(missing) || !(is_due || interrupt::asked() || kept.missing(self.shard) == 0)
        {
            return ControlFlow::Continue(());
        }
        let start = Instant::now();
        let bytes = part_file::encoded(&self.command, &self.identity, self.shard, kept, &costs());
        match files::write_through(&self.path, &bytes, TEMPORARY) {
            Ok(()) => {
                *state = State {
                    last: Some(Instant::now()),
                    took: start.elapsed(),
                    missing: Some(missing),
                    fault: None,
                };
                ControlFlow::Continue(())
            }
            Err(fault) => {
                state.fault = Some(fault);
                ControlFlow::Break(())
            }
        }
    }

    /// What went wrong with writing.
    pub(crate) fn fault(&self) -> Option<CliError> {
        self.state().fault.take()
    }

    /// How an interrupted sweep ends.
    pub(crate) fn interrupted(&self) -> CliError {
        match self.state().missing {
            Some(_) => CliError::Resumable { checkpoint: self.path.display().to_string() },
            None => CliError::Interrupted,
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn shard_name(shard: Shard) -> String {
    if shard == Shard::WHOLE { "none".to_owned() } else { shard.to_string() }
}

/// One run at a time: two would overwrite each other's file. The system gives the lock back, however this run ends;
/// where it cannot lock files there is none. A file of its own, open for writing: network file systems lock nothing
/// else.
fn lock(folder: &Path, name: &str) -> Result<Option<File>, CliError> {
    let Ok(file) = File::options().create(true).truncate(false).write(true).open(folder.join(LOCK)) else {
        return Ok(None);
    };
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => {
            Err(CliError::input(name, "another run is using this folder: expected one run at a time"))
        }
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

/// Removes what runs that were killed while they wrote have left.
fn remove_strays(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(TEMPORARY) {
            // A stray that stays does no harm.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}
