//! The command line of experiments and their review.

use super::light::Resources;
use super::values::parse_threshold;
use clap::Args;
use std::path::PathBuf;

/// Where results go unless `--out` says otherwise.
pub(crate) const DEFAULT_OUT: &str = "results";

#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    /// Folder for the report, figures and data; experiments already in it are kept.
    #[arg(long, value_name = "DIR", default_value = DEFAULT_OUT)]
    pub(crate) out: PathBuf,
    /// Only the experiment of this name, or all whose names begin so (`fig-4-5`); may be repeated.
    #[arg(long, value_name = "SLUG")]
    pub(crate) only: Vec<String>,
    /// List the experiments with their titles instead of running them.
    #[arg(long)]
    pub(crate) list: bool,
    /// The thesis's own resolutions: takes much longer.
    #[arg(long)]
    pub(crate) full: bool,
    /// Take the experiment files of this folder instead of the built-in ones.
    #[arg(long, value_name = "DIR")]
    pub(crate) experiments: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) resources: Resources,
}

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// Experiment files.
    #[arg(required = true, value_name = "FILE.ron")]
    pub(crate) files: Vec<PathBuf>,
    /// Folder for the report, figures and data; experiments already in it are kept.
    #[arg(long, value_name = "DIR", default_value = DEFAULT_OUT)]
    pub(crate) out: PathBuf,
    /// Also the runs that are marked `scope: Full`.
    #[arg(long)]
    pub(crate) full: bool,
    #[command(flatten)]
    pub(crate) resources: Resources,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Experiment files, or scenes.
    #[arg(required = true, value_name = "FILE.ron")]
    pub(crate) files: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ReviewArgs {
    /// The earlier results: a folder written by `reproduce --out`.
    #[arg(required_unless_present = "snapshots", conflicts_with = "snapshots")]
    pub(crate) base: Option<PathBuf>,
    /// The later results: another such folder.
    #[arg(required_unless_present = "snapshots", conflicts_with = "snapshots")]
    pub(crate) head: Option<PathBuf>,
    /// Folder for the page and the summary, review.html and review.json.
    #[arg(long, value_name = "DIR", default_value = "review")]
    pub(crate) out: PathBuf,
    /// Only the experiment of this name, its file without folder and extension; repeatable.
    #[arg(long, value_name = "SLUG", conflicts_with = "snapshots")]
    pub(crate) only: Vec<String>,
    /// Largest relative change at which a number still counts as unmoved.
    #[arg(long, value_name = "REL", default_value = "1e-9", value_parser = parse_threshold, allow_hyphen_values = true)]
    pub(crate) tolerance: f64,
    /// Compare the pending snapshots (*.snap.new) of a folder with the accepted ones beside them.
    #[arg(
        long,
        value_name = "FOLDER",
        num_args = 0..=1,
        default_missing_value = "crates/experiments/tests/snapshots"
    )]
    pub(crate) snapshots: Option<PathBuf>,
}
