//! The command line of the classical methods.

use super::reading::ReadingArgs;
use super::style::{OverlayArgs, StyleArgs};
use super::values::{choice, families, input_help};
use crate::error::CliError;
use crate::input::Input;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use tigereye_core::{CellShape, Choice, Point};
use tigereye_lines::{Axes, Family, Following, Major, usual_axes};
use tigereye_render::{GlyphColour, GlyphKind, GlyphScale};

/// How lines are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodName {
    /// Runge-Kutta of fourth order with a fixed step.
    Rk4,
    /// The same with steps by --tolerance, halved and doubled.
    Rk43,
    /// Dormand-Prince 5(4) with steps by --tolerance.
    Rk45,
}

/// Tensors, and which of their axes.
#[derive(Debug, Args)]
pub(crate) struct AxesArgs {
    #[arg(help = input_help())]
    pub(crate) input: String,
    /// The axes to follow; by default eigen if the field is symmetric (apart from rounding), otherwise half.
    #[arg(long, value_parser = choice::<Axes>())]
    axes: Option<Axes>,
    /// Which axis is the major one where signs are mixed; by default eigenvectors by value, semi-axes by magnitude.
    #[arg(long, value_parser = choice::<Major>())]
    major: Option<Major>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

impl AxesArgs {
    /// The axes asked for, or those that are usual for such a field, over the cells of the input.
    pub(crate) fn following(&self, input: &Input) -> Result<Following, CliError> {
        let axes = self.axes.unwrap_or_else(|| usual_axes(&input.field));
        if axes == Axes::DualEigenvectors && self.major.is_some() {
            let problem = "changes nothing: dual eigenvectors have one order, the longer first (expected --axes eigen or half)";
            return Err(CliError::input("--major", problem));
        }
        let ordered = self.major.map_or_else(|| axes.into(), |major| axes.by(major));
        Ok(Following { axes: ordered, cell: CellShape::of(input.geometry.spacing()) })
    }
}

#[derive(Debug, Args)]
pub(crate) struct LinesArgs {
    /// Outputs by their extensions: .vtp, .png, .svg, .pdf.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Which lines.
    #[arg(long, default_value = Family::Major.word(), value_parser = families())]
    pub(crate) family: &'static [Family],
    /// Distance between lines, in cells (in units of the smaller side where cells are not square), at least 0.1; by
    /// default a fortieth of the field's longer side.
    #[arg(long, value_name = "CELLS", value_parser = parse_separation, conflicts_with = "seeds")]
    pub(crate) separation: Option<f64>,
    /// A point that a line goes through, in cells from the centre of the upper left one, y downwards; may be repeated.
    #[arg(long = "seed", value_name = "X,Y", value_parser = parse_point, allow_hyphen_values = true)]
    pub(crate) seeds: Vec<Point>,
    /// How lines are integrated.
    #[arg(long, value_enum, default_value_t = MethodName::Rk4)]
    pub(crate) method: MethodName,
    /// Step, cells (smaller sides); the longest one with rk43 and rk45.
    #[arg(long, value_name = "CELLS", default_value = "0.1", value_parser = parse_step)]
    pub(crate) step: f64,
    /// Largest error of a step with rk43 or rk45, cells (smaller sides); 1e-6 by default.
    #[arg(long, value_name = "CELLS", value_parser = parse_tolerance)]
    pub(crate) tolerance: Option<f64>,
    /// Longest line to each side of its seed, cells (smaller sides); by default four times the longer side.
    #[arg(long, value_name = "CELLS", value_parser = parse_length)]
    pub(crate) length: Option<f64>,
    /// Lines end where the axes differ by less than this fraction of the longer one; with --inertia, it only limits
    /// where they may begin.
    #[arg(long, value_name = "F", default_value = "0.001", value_parser = parse_share)]
    pub(crate) least_anisotropy: f64,
    /// Inertia, for tensorlines, which pass through isotropic tensors: the weight of the tensor, from 0 (straight on)
    /// to 1. It acts once per step, so results depend on --step.
    #[arg(long, value_name = "W", value_parser = parse_share)]
    pub(crate) inertia: Option<f64>,
    /// Hyperstreamlines: half of the width, cells (smaller sides), that the largest semi-axis or eigenvalue of the
    /// field gets.
    #[arg(long, value_name = "CELLS", num_args = 0..=1, default_missing_value = "1", value_parser = parse_step)]
    pub(crate) ribbon: Option<f64>,
    #[command(flatten)]
    pub(crate) of: AxesArgs,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

#[derive(Debug, Args)]
pub(crate) struct TopologyArgs {
    /// Outputs by their extensions: .vtp, .png, .svg, .pdf.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Whose separatrices.
    #[arg(long, default_value = Family::Major.word(), value_parser = families())]
    pub(crate) family: &'static [Family],
    /// Step of the separatrices, cells (smaller sides).
    #[arg(long, value_name = "CELLS", default_value = "0.1", value_parser = parse_step)]
    pub(crate) step: f64,
    /// Longest separatrix, cells (smaller sides); by default four times the longer side.
    #[arg(long, value_name = "CELLS", value_parser = parse_length)]
    pub(crate) length: Option<f64>,
    #[command(flatten)]
    pub(crate) of: AxesArgs,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

#[derive(Debug, Args)]
pub(crate) struct LicArgs {
    /// Outputs by their extensions: .png, .svg, .pdf, .vti.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Smear along both axes, in proportion to their lengths (HyperLIC).
    #[arg(long, conflicts_with = "family")]
    pub(crate) hyper: bool,
    /// Along which axis.
    #[arg(long, default_value = Family::Major.word(), value_parser = choice::<Family>())]
    pub(crate) family: Family,
    /// How far noise is smeared to each side, cells (smaller sides); with --hyper along the longer axis.
    #[arg(long, value_name = "CELLS", default_value = "5", value_parser = parse_smear)]
    pub(crate) half_length: f64,
    /// Samples per cell along its smaller side; the spacing along the other side is about the same.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = parse_samples)]
    pub(crate) samples: usize,
    /// Seed of the noise.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Colour by the anisotropy.
    #[arg(long)]
    pub(crate) tint: bool,
    #[command(flatten)]
    pub(crate) of: AxesArgs,
    #[command(flatten)]
    pub(crate) overlay: OverlayArgs,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

#[derive(Debug, Args)]
pub(crate) struct FtleArgs {
    /// Outputs by their extensions: .vti, .png, .svg, .pdf.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Which lines.
    #[arg(long, default_value = Family::Major.word(), value_parser = choice::<Family>())]
    pub(crate) family: Family,
    /// Length of the lines to each side, cells (smaller sides).
    #[arg(long, value_name = "CELLS", default_value = "10", value_parser = parse_reach)]
    pub(crate) length: f64,
    /// Samples a cell along each side.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = parse_samples)]
    pub(crate) samples: usize,
    /// Longest step of the lines, cells (smaller sides).
    #[arg(long, value_name = "CELLS", default_value = "1", value_parser = parse_coarse_step)]
    pub(crate) step: f64,
    /// Largest error of a step, cells (smaller sides).
    #[arg(long, value_name = "CELLS", default_value = "1e-5", value_parser = parse_tolerance)]
    pub(crate) tolerance: f64,
    #[command(flatten)]
    pub(crate) of: AxesArgs,
    #[command(flatten)]
    pub(crate) overlay: OverlayArgs,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

#[derive(Debug, Args)]
pub(crate) struct GlyphsArgs {
    #[arg(help = input_help())]
    pub(crate) input: String,
    /// Outputs by their extensions: .vtp, .png, .svg, .pdf.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// The shape that represents a tensor.
    #[arg(long, default_value = GlyphKind::Ellipse.word(), value_parser = choice::<GlyphKind>())]
    pub(crate) kind: GlyphKind,
    /// Sharpness of superquadrics; 3 by default.
    #[arg(long, value_name = "F", value_parser = parse_gamma)]
    pub(crate) gamma: Option<f64>,
    /// How glyphs are scaled against each other.
    #[arg(long, default_value = GlyphScale::Field.word(), value_parser = choice::<GlyphScale>())]
    pub(crate) scale: GlyphScale,
    /// What colours mean; by default the signs if the field is symmetric (apart from rounding), otherwise the
    /// anisotropy.
    #[arg(long, value_parser = choice::<GlyphColour>())]
    pub(crate) colour: Option<GlyphColour>,
    /// A glyph for every n-th cell; by default as many as stay readable, and all in a .vtp.
    #[arg(long, value_name = "N", value_parser = parse_samples)]
    pub(crate) every: Option<usize>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

#[derive(Debug, Args)]
pub(crate) struct RidgesArgs {
    /// Image data with one number a point: a gradient of `ltg`, exponents of `ftle`, or any other .vti.
    pub(crate) input: String,
    /// Outputs by their extensions: .vtp; .png, .svg and .pdf show one layer.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// The array, where there are several.
    #[arg(long, value_name = "NAME")]
    pub(crate) array: Option<String>,
    /// Lines in one layer (from 0) instead of a surface in all of them.
    #[arg(long, value_name = "N")]
    pub(crate) layer: Option<usize>,
    /// The mean over all layers instead of one: of a gradient, over its directions.
    #[arg(long, conflicts_with = "layer")]
    pub(crate) mean: bool,
    /// The contour of a value instead of ridges.
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true, value_parser = parse_level,
          conflicts_with_all = ["least_value", "least_strength", "least_length", "direction_length", "samples"])]
    pub(crate) contour: Option<f64>,
    /// Only ridges above this fraction of the range of values.
    #[arg(long, value_name = "F", default_value = "0", value_parser = parse_share)]
    pub(crate) least_value: f64,
    /// Only ridges at least as strong as this fraction of the strongest curvature.
    #[arg(long, value_name = "F", default_value = "0.05", value_parser = parse_share)]
    pub(crate) least_strength: f64,
    /// Shortest ridge line, in cells, or smallest ridge surface, in square cells; in units of the smaller side where
    /// cells are not square.
    #[arg(long, value_name = "CELLS", default_value = "2", value_parser = parse_extent)]
    pub(crate) least_length: f64,
    /// Distance between two layers, in cells (smaller sides), when directions across ridges are determined: 1 by
    /// default for the directions of a gradient, and the file's own distance otherwise.
    #[arg(long, value_name = "CELLS", value_parser = parse_step)]
    pub(crate) direction_length: Option<f64>,
    /// Steps per cell in the search for ridges; 2 for a layer and 1 for surfaces by default.
    #[arg(long, value_name = "N", value_parser = parse_samples)]
    pub(crate) samples: Option<usize>,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

/// Shortest and longest step, cells.
const STEPS: [f64; 2] = [1e-3, 1e3];
/// Longest line, cells.
const MAX_LENGTH: f64 = 1e4;

fn number_from(text: &str, low: f64, high: f64, what: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (low..=high).contains(&x) => Ok(x),
        _ => Err(format!("expected {what} from {low} to {high}")),
    }
}

fn parse_separation(text: &str) -> Result<f64, String> {
    number_from(text, 0.1, 1e4, "a number of cells")
}

fn parse_step(text: &str) -> Result<f64, String> {
    number_from(text, STEPS[0], STEPS[1], "a number of cells")
}

fn parse_length(text: &str) -> Result<f64, String> {
    number_from(text, 0.01, MAX_LENGTH, "a number of cells")
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    number_from(text, 1e-14, 1.0, "a number of cells")
}

fn parse_share(text: &str) -> Result<f64, String> {
    number_from(text, 0.0, 1.0, "a number")
}

fn parse_point(text: &str) -> Result<Point, String> {
    let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let point = text.split_once(',').and_then(|(x, y)| Some(Point::new(number(x)?, number(y)?)));
    point.ok_or_else(|| "expected X,Y, for example 25.5,40".to_owned())
}

fn parse_coarse_step(text: &str) -> Result<f64, String> {
    number_from(text, 0.01, 10.0, "a number of cells")
}

fn parse_reach(text: &str) -> Result<f64, String> {
    number_from(text, 0.1, 1000.0, "a number of cells")
}

fn parse_smear(text: &str) -> Result<f64, String> {
    number_from(text, 0.1, 100.0, "a number of cells")
}

fn parse_extent(text: &str) -> Result<f64, String> {
    number_from(text, 0.0, 1e6, "a number of cells")
}

fn parse_level(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| "expected a finite number".to_owned())
}

fn parse_gamma(text: &str) -> Result<f64, String> {
    number_from(text, 0.0, 100.0, "a number")
}

fn parse_samples(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=64) => Ok(n),
        _ => Err("expected 1 to 64".to_owned()),
    }
}
