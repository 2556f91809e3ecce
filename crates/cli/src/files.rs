//! Files: whole reads, atomic writes.

use crate::error::CliError;
use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{NamedTempFile, TempPath};

/// Largest input file, bytes. Text needs about twenty bytes a number; this holds every field a grid may have.
const MAX_INPUT: u64 = 16 << 30;

/// The bytes of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, CliError> {
    read_at_most(path, MAX_INPUT)
}

/// The bytes of a file that must not be larger than `limit`.
pub(crate) fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>, CliError> {
    let fault = |source| CliError::File { path: path.display().to_string(), action: "reading", source };
    let file = std::fs::File::open(path).map_err(fault)?;
    let mut bytes = Vec::new();
    let read = file.take(limit + 1).read_to_end(&mut bytes).map_err(fault)?;
    if read as u64 > limit {
        return Err(CliError::input(&path.display().to_string(), format!("is larger than {limit} bytes")));
    }
    Ok(bytes)
}

/// The text of a file.
pub(crate) fn read_text(path: &Path) -> Result<String, CliError> {
    text_of(path, read(path)?)
}

/// The text that a file's bytes are.
pub(crate) fn text_of(path: &Path, bytes: Vec<u8>) -> Result<String, CliError> {
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        CliError::input(&path.display().to_string(), format!("byte {at}: expected UTF-8 text"))
    })
}

/// How the names of temporary files begin.
const TEMPORARY: &str = ".tigereye-";

/// Temporary files of this process, and folders made for them. Dropped, they are gone; where the process ends at once,
/// [`abandon`] removes them.
static PENDING: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn pending() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    PENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file that becomes another one, or goes away.
struct Temporary {
    file: Option<NamedTempFile>,
    path: PathBuf,
}

impl Temporary {
    fn new(folder: &Path, prefix: &str) -> std::io::Result<Self> {
        // Known before anybody can ask for its removal.
        let mut pending = pending();
        let file = tempfile::Builder::new().prefix(prefix).tempfile_in(folder)?;
        let path = file.path().to_path_buf();
        pending.insert(path.clone());
        Ok(Self { file: Some(file), path })
    }

    fn fill(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        file.write_all(bytes)?;
        set_ordinary_permissions(file.as_file())?;
        file.as_file().sync_all()
    }

    fn become_file(mut self, path: &Path) -> std::io::Result<()> {
        let Some(file) = self.file.take() else { return Ok(()) };
        file.persist(path).map(drop).map_err(|e| e.error)
    }

    /// The same file, closed.
    fn waiting(mut self) -> Waiting {
        let file = self.file.take().map(NamedTempFile::into_temp_path);
        // It stays among the pending ones.
        self.path = PathBuf::new();
        Waiting(file)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        drop(self.file.take());
        pending().remove(&self.path);
    }
}

/// Removes what is being written; no further temporary file can be made. For a process that ends right now.
pub(crate) fn abandon() {
    let pending = pending();
    // Folders come before what is in them, and only empty ones go. There is nobody left to tell.
    for path in pending.iter().rev() {
        let _ = std::fs::remove_file(path).or_else(|_| std::fs::remove_dir(path));
    }
    std::mem::forget(pending);
}

/// A folder for files that belong together, which become visible all at once.
///
/// Each file has a temporary name until [`Self::finish`]. If that is never called, the files are removed, and so is the
/// folder if it was created for them. Earlier contents of the folder stay until `finish`.
pub(crate) struct Staging {
    folder: PathBuf,
    /// Whether the folder was made for the files.
    made: bool,
    files: Vec<(PathBuf, Waiting)>,
}

/// A temporary file that is closed, so that thousands may wait.
struct Waiting(Option<TempPath>);

impl Waiting {
    fn become_file(mut self, path: &Path) -> std::io::Result<()> {
        let Some(file) = self.0.take() else { return Ok(()) };
        let temporary = file.to_path_buf();
        let result = file.persist(path).map_err(|e| e.error);
        pending().remove(&temporary);
        result
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(file) = self.0.take() {
            let temporary = file.to_path_buf();
            drop(file);
            pending().remove(&temporary);
        }
    }
}

impl Staging {
    pub(crate) fn new(folder: &Path) -> Result<Self, CliError> {
        let made = !folder.exists();
        make_folder(folder)?;
        if made {
            pending().insert(folder.to_path_buf());
        }
        Ok(Self { folder: folder.to_path_buf(), made, files: Vec::new() })
    }

    /// How many files wait.
    pub(crate) const fn len(&self) -> usize {
        self.files.len()
    }

    /// A file of the folder.
    pub(crate) fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), CliError> {
        let path = self.folder.join(name);
        self.add_at(path, bytes)
    }

    /// A file that belongs to them, beside the folder for example.
    pub(crate) fn add_at(&mut self, path: PathBuf, bytes: &[u8]) -> Result<(), CliError> {
        let written = Temporary::new(folder_of(&path), TEMPORARY).and_then(|mut temporary| {
            temporary.fill(bytes)?;
            Ok(temporary.waiting())
        });
        match written {
            Ok(waiting) => {
                self.files.push((path, waiting));
                Ok(())
            }
            Err(source) => {
                Err(CliError::File { path: path.display().to_string(), action: "writing", source })
            }
        }
    }

    /// Gives the files their names, in the order in which they came.
    pub(crate) fn finish(mut self) -> Result<(), CliError> {
        for (path, waiting) in std::mem::take(&mut self.files) {
            let fault =
                |source| CliError::File { path: path.display().to_string(), action: "writing", source };
            waiting.become_file(&path).map_err(fault)?;
        }
        Ok(())
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        self.files.clear();
        if self.made {
            pending().remove(&self.folder);
            // Not where there are files in it.
            let _ = std::fs::remove_dir(&self.folder);
        }
    }
}

/// Replaces a file as a whole: readers see the old bytes or the new ones, never a part.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    write_through(path, bytes, TEMPORARY)
}

/// As [`write()`], through a temporary file whose name begins with `prefix`.
pub(crate) fn write_through(path: &Path, bytes: &[u8], prefix: &str) -> Result<(), CliError> {
    let fault = |source| CliError::File { path: path.display().to_string(), action: "writing", source };
    let folder = folder_of(path);
    let mut temporary = Temporary::new(folder, prefix).map_err(fault)?;
    temporary.fill(bytes).map_err(fault)?;
    temporary.become_file(path).map_err(fault)?;
    // The rename itself must survive a crash too. Not every system lets a folder be opened.
    if let Ok(folder) = std::fs::File::open(folder) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// The folder a file is in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    }
}

/// Temporary files are private to their owner; results are not.
#[cfg(unix)]
fn set_ordinary_permissions(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn set_ordinary_permissions(_file: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}

/// Makes a folder and its parents.
pub(crate) fn make_folder(path: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(path).map_err(|source| CliError::File {
        path: path.display().to_string(),
        action: "making the folder",
        source,
    })
}

/// Removes a file, if it is there.
pub(crate) fn remove(path: &Path) -> Result<(), CliError> {
    match std::fs::remove_file(path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(CliError::File { path: path.display().to_string(), action: "removing", source })
        }
        _ => Ok(()),
    }
}

/// Whether a file can be written at `path`, before hours are spent on what should go there.
pub(crate) fn check_writable(path: &Path) -> Result<(), CliError> {
    if path.is_dir() {
        return Err(CliError::input(&path.display().to_string(), "is a folder: expected a file name"));
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        let problem = format!("there is no folder {}: expected one that exists", folder.display());
        return Err(CliError::input(&path.display().to_string(), problem));
    }
    // Without a name where the system can: nothing stays of it, even if the program is killed at this moment.
    tempfile::tempfile_in(folder).map(drop).map_err(|source| CliError::File {
        path: path.display().to_string(),
        action: "writing",
        source,
    })
}

/// Refuses an output that is one of the inputs: the data would be gone.
pub(crate) fn check_apart(inputs: &[String], outputs: &[PathBuf]) -> Result<(), CliError> {
    let places: Vec<PathBuf> = inputs.iter().map(|input| place_of(Path::new(input))).collect();
    match outputs.iter().find(|output| places.contains(&place_of(output))) {
        Some(output) => {
            let problem = "is also an input and would be overwritten: expected another name";
            Err(CliError::input(&output.display().to_string(), problem))
        }
        None => Ok(()),
    }
}

/// The same for every way of writing one path: without links and dots, as far as it exists.
pub(crate) fn place_of(path: &Path) -> PathBuf {
    if let Ok(place) = path.canonicalize() {
        return place;
    }
    let folder = folder_of(path);
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    path.file_name().map_or_else(|| folder.clone(), |name| folder.join(name))
}

/// The extension of a path in lower case, without dot.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn staged_files_appear_together_or_not_at_all() {
        let place = tempfile::tempdir().expect("a folder");
        let (folder, list) = (place.path().join("new"), place.path().join("list"));
        let stage = || {
            let mut staging = Staging::new(&folder).expect("a folder");
            staging.add("a", b"1").expect("a file");
            staging.add_at(list.clone(), b"2").expect("a file");
            staging
        };
        let everything = || {
            let entries = [place.path(), &folder].map(|f| std::fs::read_dir(f).into_iter().flatten().count());
            (entries, std::fs::read(&list).ok())
        };
        let staging = stage();
        assert_eq!((staging.len(), everything()), (2, ([2, 1], None)), "waiting under other names");
        assert_eq!(pending().iter().filter(|p| p.starts_with(place.path())).count(), 3);
        drop(staging);
        assert_eq!(everything(), ([0, 0], None), "nothing is left");
        stage().finish().expect("a rename");
        assert_eq!(everything(), ([2, 1], Some(b"2".to_vec())));
        // Without an end the older files stay.
        std::fs::write(&list, "old").expect("a file");
        drop(stage());
        assert_eq!(everything(), ([2, 1], Some(b"old".to_vec())));
        assert_eq!(pending().iter().filter(|p| p.starts_with(place.path())).count(), 0);
    }
}
