//! The command line of the classical methods.

use super::ReadingArgs;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use tigereye_lines::{Axes, Family};

/// The axes that lines follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum AxesName {
    /// Half-axes of the ellipse: what light sees.
    Half,
    /// Eigenvectors by the size of their eigenvalues with sign; pseudo-eigenvectors where these are complex.
    Eigen,
    /// Dual eigenvectors, halfway between the eigenvectors; only for tensors that are not symmetric.
    Dual,
}

impl From<AxesName> for Axes {
    fn from(name: AxesName) -> Self {
        match name {
            AxesName::Half => Self::HalfAxes,
            AxesName::Eigen => Self::Eigenvectors,
            AxesName::Dual => Self::DualEigenvectors,
        }
    }
}

/// Which of the two axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FamilyName {
    /// The longer half-axis, or the larger eigenvalue.
    Major,
    /// The other one.
    Minor,
    /// Both.
    Both,
}

impl FamilyName {
    pub(crate) const fn families(self) -> &'static [Family] {
        match self {
            Self::Major => &[Family::Major],
            Self::Minor => &[Family::Minor],
            Self::Both => &[Family::Major, Family::Minor],
        }
    }
}

/// How lines are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodName {
    /// Runge-Kutta of fourth order with a fixed step.
    Rk4,
    /// Dormand-Prince 5(4) with steps by --tolerance.
    Rk45,
}

#[derive(Debug, Args)]
pub(crate) struct LinesArgs {
    /// A data file, a field file or a generator.
    pub(crate) input: String,
    /// Outputs by their endings: .vtp, .png, .svg.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Which lines.
    #[arg(long, value_enum, default_value_t = FamilyName::Major)]
    pub(crate) family: FamilyName,
    /// The axes to follow; by default eigen where all tensors are symmetric, half otherwise.
    #[arg(long, value_enum)]
    pub(crate) axes: Option<AxesName>,
    /// Distance of the lines, cells, from 0.1; by default a fortieth of the longer side.
    #[arg(long, value_name = "CELLS", value_parser = parse_separation, conflicts_with = "seeds")]
    pub(crate) separation: Option<f64>,
    /// A point that a line goes through, in cells from the centre of the upper left one, y downwards; may be repeated.
    #[arg(long = "seed", value_name = "X,Y", value_parser = parse_point, allow_hyphen_values = true)]
    pub(crate) seeds: Vec<[f64; 2]>,
    /// How lines are integrated.
    #[arg(long, value_enum, default_value_t = MethodName::Rk4)]
    pub(crate) method: MethodName,
    /// Step, cells; the longest one with rk45.
    #[arg(long, value_name = "CELLS", default_value = "0.1", value_parser = parse_step)]
    pub(crate) step: f64,
    /// Largest error of a step with rk45, cells.
    #[arg(long, value_name = "CELLS", default_value = "1e-6", value_parser = parse_tolerance)]
    pub(crate) tolerance: f64,
    /// Longest line to each side of its seed, cells; by default four times the longer side.
    #[arg(long, value_name = "CELLS", value_parser = parse_length)]
    pub(crate) length: Option<f64>,
    /// Lines end where the axes differ by less than this part of the longer one.
    #[arg(long, value_name = "F", default_value = "0.001", value_parser = parse_share)]
    pub(crate) least_anisotropy: f64,
    /// Inertia of tensorlines, which cross round tensors: the weight of the tensor there, from 0 (straight on) to 1.
    #[arg(long, value_name = "W", value_parser = parse_share)]
    pub(crate) inertia: Option<f64>,
    /// Hyperstreamlines: half of the width, cells, that the largest half-axis or eigenvalue of the field gets.
    #[arg(long, value_name = "CELLS", num_args = 0..=1, default_missing_value = "1", value_parser = parse_step)]
    pub(crate) ribbon: Option<f64>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct TopologyArgs {
    /// A data file, a field file or a generator.
    pub(crate) input: String,
    /// Outputs by their endings: .vtp, .png, .svg.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Whose separatrices.
    #[arg(long, value_enum, default_value_t = FamilyName::Major)]
    pub(crate) family: FamilyName,
    /// The axes; by default eigen where all tensors are symmetric, half otherwise.
    #[arg(long, value_enum)]
    pub(crate) axes: Option<AxesName>,
    /// Step of the separatrices, cells.
    #[arg(long, value_name = "CELLS", default_value = "0.1", value_parser = parse_step)]
    pub(crate) step: f64,
    /// Longest separatrix, cells; by default four times the longer side.
    #[arg(long, value_name = "CELLS", value_parser = parse_length)]
    pub(crate) length: Option<f64>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// Points and separatrices as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
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

fn parse_point(text: &str) -> Result<[f64; 2], String> {
    let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let point = text.split_once(',').and_then(|(x, y)| Some([number(x)?, number(y)?]));
    point.ok_or_else(|| "expected X,Y, for example 25.5,40".to_owned())
}
