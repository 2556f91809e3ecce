//! The command line of the test fields.

use super::light::ProfileArgs;
use super::reading::ReadingArgs;
use super::style::StyleArgs;
use super::values::{choice, input_help, parse_cell};
use clap::{Args, Subcommand};
use std::path::PathBuf;
use tigereye_core::Choice;
use tigereye_transport::ScatteringRule;

#[derive(Debug, Subcommand)]
#[expect(clippy::large_enum_variant, reason = "there is one at a time")]
pub(crate) enum FieldCommand {
    /// All generators with their parameters and defaults.
    List(FieldListArgs),
    /// A field file to begin with, and an experiment made from it.
    New(FieldNewArgs),
    /// A sheet about a field: ellipses, lines, anisotropy, determinant, one light, a gradient.
    Show(FieldShowArgs),
    /// Likely mistakes in a field.
    Lint(FieldLintArgs),
}

#[derive(Debug, Args)]
pub(crate) struct FieldListArgs {
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct FieldNewArgs {
    /// Name of the field: lower-case letters, digits, - and _; with --experiment also a generator, to show it in one.
    pub(crate) name: String,
    /// Folder for the files.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub(crate) folder: PathBuf,
    /// Write an experiment with the field beside it.
    #[arg(long)]
    pub(crate) experiment: bool,
}

#[derive(Debug, Args)]
pub(crate) struct FieldShowArgs {
    #[arg(help = input_help())]
    pub(crate) input: String,
    /// The sheet, .png, .svg or .pdf.
    #[arg(short, long = "output", value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Cell that shines, column and row; by default the one nearest to the middle whose tensor is not zero.
    #[arg(long, value_name = "X,Y", value_parser = parse_cell)]
    pub(crate) light: Option<[usize; 2]>,
    /// Direction of the gradient, degrees, a multiple of 22.5.
    #[arg(long, value_name = "DEG", default_value_t = 90.0)]
    pub(crate) slice_deg: f64,
    /// How a cell scatters light that arrives from several sides.
    #[arg(long, default_value = ScatteringRule::Joint.word(), value_parser = choice::<ScatteringRule>())]
    pub(crate) scattering: ScatteringRule,
    #[command(flatten)]
    pub(crate) profiles: ProfileArgs,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

#[derive(Debug, Args)]
pub(crate) struct FieldLintArgs {
    #[arg(help = input_help())]
    pub(crate) input: String,
    /// Also list notes that need not be mistakes: shares of zero, indefinite and asymmetric tensors, and similar.
    #[arg(long)]
    pub(crate) all: bool,
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}
