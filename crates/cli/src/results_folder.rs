//! A folder of results: experiments join those that are there, and nothing else is touched.

use crate::error::CliError;
use crate::files;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use tigereye_report::review::MAX_FILE;
use tigereye_report::{
    About, ExperimentOutcome, ExperimentSummary, FilePath, Incoming, LeftOut, Made, PictureSummary, Summary,
};

/// What programs read.
const SUMMARY: &str = "summary.json";

/// What people read.
const PAGE: &str = "index.html";

/// A folder that takes the experiments of one run.
pub(crate) struct ResultsFolder {
    path: PathBuf,
    about: About,
}

impl ResultsFolder {
    /// The folder, if these experiments (name and file) may join what is there. Nothing is written yet.
    pub(crate) fn open(
        path: &Path,
        about: About,
        experiments: &[(String, String)],
    ) -> Result<Self, CliError> {
        let folder = Self { path: path.to_path_buf(), about };
        let Some(there) = folder.summary()? else {
            if folder.page().exists() {
                let problem = "is not a tigereye report: expected a folder without such a file (--out)";
                return Err(CliError::input(&folder.page().display().to_string(), problem));
            }
            return Ok(folder);
        };
        let same_file =
            |a: &str, b: &str| a == b || files::place_of(Path::new(a)) == files::place_of(Path::new(b));
        let run = Incoming {
            version: &folder.about.version,
            full: folder.about.full,
            experiments,
            same_file: &same_file,
        };
        there.admits(&run).map_err(|conflict| CliError::input(&path.display().to_string(), conflict))?;
        Ok(folder)
    }

    /// What is there; none where nothing is.
    fn summary(&self) -> Result<Option<Summary>, CliError> {
        let path = self.path.join(SUMMARY);
        if !path.exists() {
            return Ok(None);
        }
        let text = files::text_of(&path, files::read_at_most(&path, MAX_FILE)?)?;
        let summary = Summary::from_json(&path.display().to_string(), &text);
        summary
            .map(Some)
            .map_err(|e| CliError::Input(format!("{e}; expected a report, or another folder (--out)")))
    }

    /// The page.
    pub(crate) fn page(&self) -> PathBuf {
        self.path.join(PAGE)
    }

    /// Writes an experiment's files, and then the summary that tells of them: whatever happens after, the folder holds
    /// this experiment and all others as a whole.
    pub(crate) fn add(&mut self, outcome: &ExperimentOutcome, file: &str) -> Result<(), CliError> {
        let mut staging = files::Staging::new(&self.path.join(&outcome.slug))?;
        for figure in &outcome.figures {
            staging.add(&format!("{}.png", figure.name), &figure.png)?;
            staging.add(&format!("{}.svg", figure.name), figure.svg.as_bytes())?;
        }
        for data in &outcome.data {
            staging.add(&data.name, &data.bytes)?;
        }
        staging.finish()?;
        self.about.added += 1;
        // Read anew: another run may have added some meanwhile.
        let earlier = self.summary()?.unwrap_or_default();
        let left_out = left_out(&earlier, &self.about.left_out);
        let mut summary = Summary { about: About { left_out, ..self.about.clone() }, ..earlier };
        let made = Made { version: &self.about.version, full: self.about.full, file };
        summary.receive(outcome.summary(&made));
        files::write(&self.path.join(SUMMARY), summary.to_json().as_bytes())
    }

    /// Makes the page of all that the folder holds; how many experiments that are.
    pub(crate) fn finish(&self) -> Result<usize, CliError> {
        let summary = self.summary()?.unwrap_or_default();
        let figures: Vec<(FilePath, &PictureSummary)> =
            summary.experiments.iter().flat_map(files_of).collect();
        let previews: BTreeMap<&str, Vec<Vec<u8>>> = figures
            .par_iter()
            .filter_map(|(path, figure)| {
                let png = files::read_at_most(&self.path.join(path.as_str()), MAX_FILE).ok()?;
                Some((path.as_str(), tigereye_report::previews(&png, figure)?))
            })
            .collect();
        let picture = |path: &str| previews.get(path).cloned();
        files::write(&self.page(), tigereye_report::html(&summary, &picture).as_bytes())?;
        Ok(summary.experiments.len())
    }

    /// As [`Self::finish`] after an interruption: the page that is there stays where experiments of another version
    /// are left, which it shows better.
    pub(crate) fn finish_early(&self) -> Result<(), CliError> {
        let summary = self.summary()?.unwrap_or_default();
        let ours = |version: &str| version == self.about.version;
        if summary.experiments.iter().all(|e| ours(&e.version)) { self.finish().map(drop) } else { Ok(()) }
    }
}

/// The figures of an experiment with the paths of their PNGs.
fn files_of(experiment: &ExperimentSummary) -> impl Iterator<Item = (FilePath, &PictureSummary)> {
    let path = |name: &str| FilePath::try_from(format!("{}/{name}.png", experiment.slug)).ok();
    experiment.pictures.iter().filter_map(move |figure| Some((path(&figure.name)?, figure)))
}

/// Experiments still missing: skipped in an earlier run or in this one, and not in the folder.
fn left_out(earlier: &Summary, now: &[LeftOut]) -> Vec<LeftOut> {
    let of_earlier = earlier.about.left_out.iter().filter(|l| !now.iter().any(|n| n.slug == l.slug));
    let missing = of_earlier.chain(now).filter(|l| !earlier.experiments.iter().any(|e| e.slug == l.slug));
    missing.cloned().collect()
}
