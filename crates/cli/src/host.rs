//! Files, progress and interruption for experiments.

use crate::{interrupt, system};
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use tigereye_experiments::{Host, library};
use tigereye_transport::Level;

/// How many parents of an experiment's folder are searched for its data.
const PARENTS: usize = 3;

/// How the names of published reference files begin; they are not part of the project.
pub(crate) const REFERENCE: &str = "reference/";
/// The environment variable with the folder of these files; without it they are looked for beside the working folder.
const REFERENCE_FOLDER: &str = "TIGEREYE_REFERENCE";
const BESIDE: &str = "../shared/reference";

/// Where a reference file is, if it is one and there.
fn reference_file(path: &str) -> Option<PathBuf> {
    let name = path.strip_prefix(REFERENCE)?;
    let folder = std::env::var_os(REFERENCE_FOLDER).map_or_else(|| PathBuf::from(BESIDE), PathBuf::from);
    Some(folder.join(name)).filter(|file| file.is_file())
}

/// The world of one experiment.
pub(crate) struct FileHost {
    folder: Option<PathBuf>,
    bar: ProgressBar,
    prefix: String,
    start: Instant,
    opened: Mutex<Vec<String>>,
}

impl FileHost {
    /// `folder` is the experiment file's; `None` for a built-in one. `prefix` opens the progress line.
    pub(crate) fn new(folder: Option<PathBuf>, prefix: String) -> Self {
        // Hidden by indicatif where standard error is no terminal.
        let bar = ProgressBar::new(0);
        bar.set_style(sweep_style());
        bar.set_message(prefix.clone());
        Self { folder, bar, prefix, start: Instant::now(), opened: Mutex::default() }
    }

    /// Names of the files that were read.
    pub(crate) fn opened(&self) -> Vec<String> {
        self.opened.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn bytes(&self, file: &Path) -> Result<Vec<u8>, String> {
        let bytes = crate::files::read(file).map_err(|e| e.to_string())?;
        let name = file.to_string_lossy().into_owned();
        self.opened.lock().unwrap_or_else(PoisonError::into_inner).push(name);
        Ok(bytes)
    }

    /// Removes the progress line.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// A line with rate and time left.
pub(crate) fn sweep_style() -> ProgressStyle {
    ProgressStyle::with_template("{msg} [{bar:30}] {percent:>3} % {per_sec} {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("=> ")
}

impl Host for FileHost {
    fn level(&self) -> Level {
        // A wrong name was refused at the start.
        system::level().unwrap_or_else(|_| Level::detect())
    }

    fn read(&self, path: &str) -> Result<Vec<u8>, String> {
        if let Some(file) = reference_file(path) {
            return self.bytes(&file);
        }
        let mut tried = Vec::new();
        let mut folder = self.folder.clone();
        for _ in 0..=PARENTS {
            let Some(here) = folder else { break };
            let candidate = here.join(path);
            if candidate.is_file() {
                return self.bytes(&candidate);
            }
            folder = here.canonicalize().ok().and_then(|p| p.parent().map(PathBuf::from));
            tried.push(here.display().to_string());
        }
        tried.push("the built-in data".to_owned());
        library::data(path)
            .map(<[u8]>::to_vec)
            .ok_or_else(|| format!("no file {path} in {}", tried.join(", ")))
    }

    fn remark(&self, words: &str) {
        self.bar.suspend(|| eprintln!("{words}"));
    }

    fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    fn progress(&self, what: &str, done: u64, total: u64) -> ControlFlow<()> {
        // One update in a while is enough for the eye.
        if done.is_multiple_of(64) || done == total {
            self.bar.set_message(format!("{} {what}", self.prefix));
            self.bar.set_length(total.max(done));
            self.bar.set_position(done);
        }
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
