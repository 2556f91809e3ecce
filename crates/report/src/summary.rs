//! The summary of a folder of results, `summary.json`: written here, read here, and all that the page is made of
//! besides the pictures.

use std::collections::BTreeSet;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use thiserror::Error;

use crate::json::{not_a_number, nullable};
use crate::links::path;
use crate::outcome::{CheckOutcome, ExperimentOutcome, Figure, PanelPlace, Table};

/// Longest name of an experiment, bytes.
const MAX_NAME: usize = 10_000;

/// All that a folder of results holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Whether every check of every experiment passed; of no experiment they did.
    #[serde(default)]
    pub passed: bool,
    /// Wall-clock seconds of all experiments.
    #[serde(default)]
    pub seconds: f64,
    /// The last run that wrote into the folder.
    #[serde(default)]
    pub about: About,
    /// Experiments in the order in which they came.
    pub experiments: Vec<ExperimentSummary>,
}

/// What the page says about the run as a whole.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct About {
    /// Version of the program.
    pub version: String,
    /// The command line that was run.
    pub command: String,
    /// Whether the thesis's own resolutions were run.
    pub full: bool,
    /// Number of threads; the results do not depend on it.
    pub threads: usize,
    /// How many experiments the run has added or replaced.
    pub added: usize,
    /// Experiments that were left out.
    pub left_out: Vec<LeftOut>,
}

/// An experiment that could not be run, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Its name.
    pub slug: String,
    /// The file that it needs and that was not there.
    pub needs: String,
}

/// Everything about one experiment but the bytes of its files.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ExperimentSummary {
    /// Name of the experiment, and of its folder.
    pub slug: String,
    /// Heading.
    #[serde(default)]
    pub title: String,
    /// What it reproduces, for example `Thesis, Fig. 4.8`.
    #[serde(default)]
    pub source: String,
    /// Wall-clock seconds.
    #[serde(default = "not_a_number", deserialize_with = "nullable")]
    pub seconds: f64,
    /// Whether every check passed.
    #[serde(default)]
    pub passed: bool,
    /// Paths of the figures, PNG before SVG before animation.
    #[serde(default)]
    pub figures: Vec<FilePath>,
    /// Those among them that draw seconds, which are others in every run.
    #[serde(default)]
    pub timed_figures: Vec<FilePath>,
    /// Checks in the order of the file.
    pub checks: Vec<CheckOutcome>,
    /// The command that redoes exactly this experiment.
    #[serde(default)]
    pub command: String,
    /// Counters in the order of the runs.
    #[serde(default)]
    pub work: Work,
    /// Version of the program that ran it.
    #[serde(default)]
    pub version: String,
    /// Whether it ran at the thesis's own resolutions.
    #[serde(default)]
    pub full: bool,
    /// The experiment file, as it was named.
    #[serde(default)]
    pub file: String,
    /// Section of the page.
    #[serde(default)]
    pub section: String,
    /// The sentence of the source that the figures support, or the claim examined.
    #[serde(default)]
    pub claim: String,
    /// What to look for in the figures.
    #[serde(default)]
    pub look_for: String,
    /// The figures without their files, in the order of `figures`.
    #[serde(default)]
    pub pictures: Vec<PictureSummary>,
    /// Tables in the order of the file.
    #[serde(default)]
    pub tables: Vec<Table>,
    /// Data files beside the figures.
    #[serde(default)]
    pub data: Vec<DataSummary>,
}

/// What the page says about a figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureSummary {
    /// File name without extension.
    pub name: String,
    /// What is seen.
    pub caption: String,
    /// Alternative text.
    pub alt: String,
    /// Width at scale 1, pixels.
    pub width_px: f64,
    /// Height at scale 1, pixels.
    pub height_px: f64,
    /// Frames of the animation beside it; 0 for none.
    pub frames: usize,
    /// Where its panels are; empty for a single one.
    #[serde(default)]
    pub panels: Vec<PanelPlace>,
}

/// A file of data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DataSummary {
    /// File name with extension.
    pub name: String,
    /// Its size.
    pub bytes: usize,
}

impl Summary {
    /// The text of the file: indented, keys in a fixed order.
    ///
    /// Paths are relative to the results folder. The tolerance of a bound (`kind` is `at most` or `at least`) is 0 and
    /// its `expected` the bound. Numbers that JSON does not have, NaN and the infinities, become `null`.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("strings, numbers and lists always have a JSON form") + "\n"
    }

    /// Reads the text of a `summary.json`; `file` names it in messages.
    ///
    /// A number that is `null` is not a number. What programs did not always write may be missing, except for the slug
    /// and checks of an experiment, and the name, value and verdict of a check.
    ///
    /// # Errors
    /// [`SummaryError`]
    pub fn from_json(file: &str, text: &str) -> Result<Self, SummaryError> {
        let mut json = serde_json::Deserializer::from_str(text);
        let summary: Self = serde_path_to_error::deserialize(&mut json).map_err(|e| {
            let (place, fault) = (e.path().to_string(), e.inner());
            match fault.classify() {
                serde_json::error::Category::Data => SummaryError::Key {
                    file: file.to_owned(),
                    key: if place == "." { String::new() } else { format!("{}: ", crate::shortened(&place)) },
                    problem: crate::shortened(&fault.to_string()),
                },
                _ => SummaryError::Json { file: file.to_owned(), problem: fault.to_string() },
            }
        })?;
        json.end().map_err(|e| SummaryError::Json { file: file.to_owned(), problem: e.to_string() })?;
        let mut slugs = BTreeSet::new();
        let problem = |slug: &str| match slugs.insert(slug.to_owned()) {
            false => Some("expected a name that no other experiment has".to_owned()),
            true => (slug.len() > MAX_NAME).then(|| format!("expected at most {MAX_NAME} bytes of text")),
        };
        let mut problems = summary.experiments.iter().map(|e| e.slug.as_str()).map(problem);
        match problems.by_ref().enumerate().find_map(|(i, problem)| Some((i, problem?))) {
            Some((i, problem)) => Err(SummaryError::Key {
                file: file.to_owned(),
                key: format!("experiments[{i}].slug: "),
                problem,
            }),
            None => Ok(summary),
        }
    }

    /// Puts in an experiment: in the place of an earlier one of its name, or after the others.
    pub fn receive(&mut self, experiment: ExperimentSummary) {
        self.about.left_out.retain(|l| l.slug != experiment.slug);
        match self.experiments.iter_mut().find(|e| e.slug == experiment.slug) {
            Some(earlier) => *earlier = experiment,
            None => self.experiments.push(experiment),
        }
        self.passed = self.experiments.iter().all(|e| e.passed);
        self.seconds = self.experiments.iter().map(|e| e.seconds).filter(|s| s.is_finite()).sum();
    }

    /// Whether a run may write its experiments among these.
    ///
    /// Those of one report are made by one version of the program at the same resolutions, so that they can be read
    /// beside each other; a run of others must replace them all, and never what took `--full` by what did not.
    ///
    /// # Errors
    /// [`Conflict`], with what is there.
    pub fn admits(&self, run: &Incoming<'_>) -> Result<(), Conflict> {
        let replaces = |e: &ExperimentSummary| run.experiments.iter().any(|(slug, _)| *slug == e.slug);
        let there = self.experiments.len();
        let replaced = self.experiments.iter().filter(|e| replaces(e)).count();
        for e in &self.experiments {
            let incoming = run.experiments.iter().find(|(slug, _)| *slug == e.slug);
            let same = |file: &str| e.file.is_empty() || (run.same_file)(&e.file, file);
            if let Some((_, file)) = incoming.filter(|(_, file)| !same(file)) {
                let (slug, there, here) = (e.slug.clone(), e.file.clone(), (*file).to_owned());
                return Err(Conflict::File { slug, there, here });
            }
            if e.full && !run.full {
                return Err(Conflict::Full { slug: e.slug.clone() });
            }
            if e.version != run.version && replaced < there {
                let version = if e.version.is_empty() {
                    "an earlier version".to_owned()
                } else {
                    format!("version {}", e.version)
                };
                return Err(Conflict::Version { version, there, replaced });
            }
            if e.full != run.full && replaced < there {
                return Err(Conflict::Default { there, replaced });
            }
        }
        Ok(())
    }
}

/// What a run is about to write.
pub struct Incoming<'a> {
    /// Version of the program.
    pub version: &'a str,
    /// Whether it runs at the thesis's own resolutions.
    pub full: bool,
    /// Name and file of each experiment.
    pub experiments: &'a [(String, String)],
    /// Whether two names are of one file.
    pub same_file: &'a dyn Fn(&str, &str) -> bool,
}

/// Why a run may not write among the experiments of a report.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum Conflict {
    /// Another version of the program made them.
    #[error(
        "holds a report of {version} with {there} experiments, of which this run would replace {replaced}: \
         expected another folder (--out), or a run of all of them"
    )]
    Version {
        /// That version.
        version: String,
        /// Number of experiments there.
        there: usize,
        /// Those among them that the run has, too.
        replaced: usize,
    },
    /// They were made without `--full`.
    #[error(
        "holds a report made without --full with {there} experiments, of which this run would replace {replaced}: \
         expected another folder (--out), or a run of all of them"
    )]
    Default {
        /// Number of experiments there.
        there: usize,
        /// Those among them that the run has, too.
        replaced: usize,
    },
    /// One of them was made with `--full`, and the run is without.
    #[error("holds {slug}, made with --full: expected --full, or another folder (--out)")]
    Full {
        /// That experiment.
        slug: String,
    },
    /// An experiment of the same name comes from elsewhere.
    #[error(
        "holds an experiment {slug} made from {there}, and this run has one of the same name from {here}: expected \
         another name, or another folder (--out)"
    )]
    File {
        /// The name.
        slug: String,
        /// The file of the one that is there.
        there: String,
        /// The file of the run.
        here: String,
    },
}

/// Why a `summary.json` cannot be read.
#[derive(Debug, Error)]
pub enum SummaryError {
    /// A file that is no JSON.
    #[error("{file}: expected the JSON that `reproduce --out` writes: {problem}")]
    Json {
        /// The file.
        file: String,
        /// What the reader says.
        problem: String,
    },
    /// A value that is missing or wrong.
    #[error("{file}: {key}{problem}")]
    Key {
        /// The file.
        file: String,
        /// Where in the file, for example `experiments[2].checks[0].value: `; nothing for the file as a whole.
        key: String,
        /// What the reader says.
        problem: String,
    },
}

/// How an experiment was made.
#[derive(Clone, Debug)]
pub struct Made<'a> {
    /// Version of the program.
    pub version: &'a str,
    /// Whether at the thesis's own resolutions.
    pub full: bool,
    /// The experiment file, as it was named.
    pub file: &'a str,
}

impl ExperimentOutcome {
    /// What the summary says of it.
    #[must_use]
    pub fn summary(&self, made: &Made<'_>) -> ExperimentSummary {
        let files = |f: &Figure| {
            let extensions = ["png", "svg"].into_iter().chain((f.frames > 0).then_some("apng"));
            extensions.map(|e| FilePath(path(&self.slug, &format!("{}.{e}", f.name)))).collect::<Vec<_>>()
        };
        ExperimentSummary {
            slug: self.slug.clone(),
            title: self.title.clone(),
            source: self.source.clone(),
            seconds: self.seconds,
            passed: self.passed(),
            figures: self.figures.iter().flat_map(files).collect(),
            timed_figures: self.figures.iter().filter(|f| f.timed).flat_map(files).collect(),
            checks: self.checks.clone(),
            command: self.command.clone(),
            work: Work::unique(&self.work),
            version: made.version.to_owned(),
            full: made.full,
            file: made.file.to_owned(),
            section: self.section.clone(),
            claim: self.claim.clone(),
            look_for: self.look_for.clone(),
            pictures: self.figures.iter().map(PictureSummary::of).collect(),
            tables: self.tables.clone(),
            data: self
                .data
                .iter()
                .map(|d| DataSummary { name: d.name.clone(), bytes: d.bytes.len() })
                .collect(),
        }
    }
}

impl PictureSummary {
    fn of(figure: &Figure) -> Self {
        let Figure { name, caption, alt, width_px, height_px, frames, panels, .. } = figure;
        Self {
            name: name.clone(),
            caption: caption.clone(),
            alt: alt.clone(),
            width_px: *width_px,
            height_px: *height_px,
            frames: *frames,
            panels: panels.clone(),
        }
    }
}

/// The path of a file that stays in the results folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String")]
pub struct FilePath(String);

impl FilePath {
    /// The path, relative to the results folder.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl TryFrom<String> for FilePath {
    type Error = &'static str;

    fn try_from(path: String) -> Result<Self, Self::Error> {
        let inside = path.split('/').all(|part| !["", ".", ".."].contains(&part))
            && !path.chars().any(|c| c == '\\' || c == ':' || c.is_control());
        if inside { Ok(Self(path)) } else { Err("expected the path of a file below the results folder") }
    }
}

/// Counters as an object in the order given.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Work(pub Vec<(String, u64)>);

impl Work {
    /// JSON readers keep only one of two equal keys, so a repeated label gets a number.
    fn unique(counters: &[(String, u64)]) -> Self {
        let label = |(i, (label, n)): (usize, &(String, u64))| {
            let earlier = counters[..i].iter().filter(|(l, _)| l == label).count();
            (if earlier == 0 { label.clone() } else { format!("{label} ({})", earlier + 1) }, *n)
        };
        Self(counters.iter().enumerate().map(label).collect())
    }
}

impl Serialize for Work {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(label, n)| (label, n)))
    }
}

impl<'de> Deserialize<'de> for Work {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Members;
        impl<'de> serde::de::Visitor<'de> for Members {
            type Value = Work;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object of counters")
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<Work, A::Error> {
                let mut counters = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    counters.push(entry);
                }
                Ok(Work(counters))
            }
        }
        deserializer.deserialize_map(Members)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn experiment(slug: &str, version: &str, full: bool) -> ExperimentSummary {
        let (slug, file) = (slug.to_owned(), format!("{slug}.ron"));
        ExperimentSummary {
            slug,
            file,
            version: version.to_owned(),
            full,
            passed: true,
            ..Default::default()
        }
    }

    fn report(experiments: &[(&str, &str, bool)]) -> Summary {
        let mut summary = Summary::default();
        experiments.iter().for_each(|(slug, version, full)| {
            summary.receive(experiment(slug, version, *full));
        });
        summary
    }

    #[track_caller]
    fn check(there: &[(&str, &str, bool)], slugs: &[&str], full: bool, conflict: &str) {
        let experiments: Vec<_> = slugs.iter().map(|s| ((*s).to_owned(), format!("{s}.ron"))).collect();
        let same_file = |a: &str, b: &str| a == b;
        let run = Incoming { version: "2", full, experiments: &experiments, same_file: &same_file };
        let found = report(there).admits(&run).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(found.contains(conflict) && found.is_empty() == conflict.is_empty(), "{found}");
    }

    #[test]
    fn experiments_of_one_version_and_setting_share_a_report() {
        check(&[], &["a"], false, "");
        check(&[("a", "2", false), ("b", "2", false)], &["a", "c"], false, "");
        check(&[("a", "2", true), ("b", "2", true)], &["c"], true, "");
    }

    #[test]
    fn a_larger_report_of_another_version_is_not_replaced() {
        check(&[("a", "1", false), ("b", "1", false)], &["a"], false, "of version 1 with 2 experiments");
        check(&[("a", "", false), ("b", "", false)], &["c"], false, "would replace 0");
        check(&[("a", "1", false), ("b", "1", false)], &["c", "b", "a"], false, "");
    }

    #[test]
    fn results_of_full_runs_are_not_replaced_by_others() {
        check(&[("a", "2", true)], &["a"], false, "holds a, made with --full");
        check(&[("a", "2", false), ("b", "2", false)], &["a"], true, "made without --full");
        check(&[("a", "2", false)], &["a", "b"], true, "");
    }

    #[test]
    fn experiments_of_one_name_must_be_of_one_file() {
        let mut summary = report(&[("a", "2", false)]);
        summary.experiments[0].file = "elsewhere/a.ron".into();
        let experiments = [("a".to_owned(), "a.ron".to_owned())];
        let same_file = |a: &str, b: &str| a == b;
        let run = Incoming { version: "2", full: false, experiments: &experiments, same_file: &same_file };
        let conflict = summary.admits(&run).expect_err("another file").to_string();
        assert!(conflict.contains("made from elsewhere/a.ron") && conflict.contains("from a.ron"));
    }

    #[test]
    fn an_experiment_takes_the_place_of_the_earlier_one() {
        let mut summary = report(&[("a", "2", false), ("b", "2", false)]);
        summary.about.left_out = vec![LeftOut { slug: "a".into(), needs: "f".into() }];
        let failed = ExperimentSummary { seconds: 2.0, passed: false, ..experiment("a", "2", false) };
        summary.receive(failed);
        let slugs: Vec<_> = summary.experiments.iter().map(|e| e.slug.as_str()).collect();
        assert_eq!((slugs, summary.passed, summary.seconds), (vec!["a", "b"], false, 2.0));
        assert!(summary.about.left_out.is_empty());
    }
}
