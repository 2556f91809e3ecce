//! Parts and checkpoints of a sweep, as they lie in folders.

use crate::error::CliError;
use std::path::{Path, PathBuf};

/// Name of the checkpoint in its folder.
const CHECKPOINT: &str = "checkpoint.part";
/// Longest message of a failed shard that is read, bytes.
const LONGEST_MESSAGE: u64 = 1 << 16;

/// What lies in folders and was named on the command line, each list ascending by name.
#[derive(Debug, Default)]
pub(crate) struct Pieces {
    /// Files of finished shards, or named as such.
    pub(crate) parts: Vec<PathBuf>,
    /// Checkpoints in folders below a folder.
    pub(crate) checkpoints: Vec<PathBuf>,
    /// Files `K.failed`, in which `docs/slurm/sweep.sbatch` keeps what a failed shard said.
    pub(crate) failed: Vec<PathBuf>,
}

impl Pieces {
    /// Looks into folders, and takes files as they are.
    pub(crate) fn find(paths: &[PathBuf]) -> Result<Self, CliError> {
        let mut found = Self::default();
        for path in paths {
            if path.is_dir() { found.look_into(path)? } else { found.parts.push(path.clone()) }
        }
        Ok(found)
    }

    fn look_into(&mut self, folder: &Path) -> Result<(), CliError> {
        let before = (self.parts.len(), self.checkpoints.len(), self.failed.len());
        let fault = |source| CliError::File { path: folder.display().to_string(), action: "reading", source };
        let entries = std::fs::read_dir(folder).map_err(fault)?;
        let mut entries: Vec<PathBuf> =
            entries.map(|entry| entry.map(|e| e.path())).collect::<Result<_, _>>().map_err(fault)?;
        entries.sort_by_key(|path| (number_of(path), path.clone()));
        for entry in entries {
            let extension = entry.extension().unwrap_or_default();
            if entry.file_name().is_some_and(|name| name == CHECKPOINT) {
                self.checkpoints.push(entry);
            } else if entry.is_dir() {
                let checkpoint = entry.join(CHECKPOINT);
                if checkpoint.is_file() {
                    self.checkpoints.push(checkpoint);
                }
            } else if extension == "part" {
                self.parts.push(entry);
            } else if extension == "failed" {
                self.failed.push(entry);
            }
        }
        if before == (self.parts.len(), self.checkpoints.len(), self.failed.len()) {
            let problem = "has no shard of a sweep: expected files .part, or folders with a checkpoint.part";
            return Err(CliError::input(&folder.display().to_string(), problem));
        }
        Ok(())
    }
}

/// The number that a name begins with, so that 10 comes after 9.
fn number_of(path: &Path) -> Option<u64> {
    let name = path.file_stem()?.to_string_lossy();
    name.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

/// What a failed shard said.
pub(crate) fn message(path: &Path) -> Result<String, CliError> {
    let bytes = crate::files::read_at_most(path, LONGEST_MESSAGE)?;
    Ok(String::from_utf8_lossy(&bytes).trim().to_owned())
}
