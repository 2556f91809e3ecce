//! What may stand in an experiment file.
//!
//! Strict: unknown keys, missing keys, wrong types and numbers out of range are errors with line and column. Keys carry
//! their units. Everything is documented here because this is the reference for people who write such files.

mod checks;
mod classical;
mod figures;
mod load;
mod named;
mod numbers;
mod scene;
mod source_text;
mod tables;

pub use checks::{Check, Expectation, Mirror, PulseNumber, Quantity, SchemeConstant, Summary};
pub use classical::{AxesChoice, DistanceNumber, FamilyChoice, MajorChoice, MapSource, RidgeSource};
pub use figures::{
    Animation, Axis, Curve, Figure, FlatView, GlyphColour, Panel, ProfileSource, Scale, SeriesSource,
};
pub use load::{SpecError, load, load_field, load_scene};
pub use named::Named;
pub use numbers::{DirectionCount, Finite, Fraction, NonNegative, Positive, Sigma};
pub use scene::{MaterialSource, Point, SceneFile, ScenePart, ShapeSource};
pub(crate) use source_text::SourceText;
pub use tables::{ComparisonRow, GradientRow, NoiseRow, RuntimeRow, Table, TableRows};

use serde::Deserialize;

/// The format this version reads.
pub const FORMAT: u32 = 1;

/// One experiment file.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// Version of the format, 1.
    pub format: u32,
    /// Heading.
    pub title: String,
    /// What it reproduces, for example `Thesis, Fig. 4.8`.
    pub source: String,
    /// Section of the gallery; sections are sorted.
    pub section: String,
    /// The sentence that the figures support or examine.
    pub claim: String,
    /// What to look for, for someone who has not read the source.
    pub look_for: String,
    /// When the whole experiment runs.
    #[serde(default)]
    pub scope: Scope,
    /// Data files that are not part of the project; where one is missing, the experiment is left out and says so.
    #[serde(default)]
    pub needs: Vec<String>,
    /// Tensor fields by name.
    #[serde(default)]
    pub fields: Named<FieldSource>,
    /// Scenes by name, each in a file `NAME.scene.ron` beside this one. Runs of light take them where they take fields.
    #[serde(default)]
    pub scenes: Named<String>,
    /// Propagations, gradients and studies of pulses by name, in order.
    #[serde(default)]
    pub runs: Named<Run>,
    /// Pictures.
    pub figures: Vec<Figure>,
    /// Tables of results.
    #[serde(default)]
    pub tables: Vec<Table>,
    /// What must hold.
    pub checks: Vec<Check>,
}

/// A tensor field in a file of its own, `NAME.field.ron`: commands and experiments take it where they take a generator.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct FieldFile {
    /// Version of the format, 1.
    pub format: u32,
    /// Heading of its sheet.
    pub title: String,
    /// Where it comes from: a paper, a formula, a measurement.
    #[serde(default)]
    pub source: String,
    /// The field.
    pub field: FieldSource,
}

/// When something runs.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum Scope {
    /// In every run.
    #[default]
    Always,
    /// Only with `--full`; figures and checks that need it are left out otherwise.
    Full,
}

/// Where a tensor field comes from.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
#[expect(clippy::large_enum_variant, reason = "an experiment has a handful")]
pub enum FieldSource {
    /// A generator with its parameters, as `tigereye field list` shows them.
    Generator {
        /// Name of the generator.
        name: String,
        /// Parameters that differ from their defaults, for example `{"size": "51"}`.
        #[serde(default)]
        parameters: Named<Parameter>,
    },
    /// Semi-axes by expressions in x, y (-1 to 1, y up), i, j, n, r, theta.
    Axes {
        /// Cells per row.
        width: usize,
        /// Cells per column.
        height: usize,
        /// Direction of the major half-axis, radians.
        phi: String,
        /// Major half-axis.
        s1: String,
        /// Minor half-axis.
        s2: String,
    },
    /// The four components by expressions in the same variables.
    Components {
        /// Cells per row.
        width: usize,
        /// Cells per column.
        height: usize,
        /// Component xx.
        xx: String,
        /// Component xy.
        xy: String,
        /// Component yx.
        yx: String,
        /// Component yy.
        yy: String,
    },
    /// A data file of any format that the program reads, or another field's file (`.field.ron`), looked up beside the experiment file, in its parent folders, and
    /// among the data that the program carries. The options are those of the command line.
    File {
        /// Path of the file.
        path: String,
        /// Array of a VTK file or archive; `None`: its active tensors or its only tensor array.
        #[serde(default)]
        array: Option<String>,
        /// Arrays that hold one component each, `XX=S_XX,YY=S_YY,XY=S_XY`, or one row, `X=T_x,Y=T_y`.
        #[serde(default)]
        components: Option<String>,
        /// Component order: a tool's name or component names.
        #[serde(default)]
        order: Option<String>,
        /// What shears are: `tensor` (the default) or `engineering`.
        #[serde(default)]
        shear: Option<String>,
        /// Axes that the components are along: `voxel`, `world`, `measurement` or `fsl`.
        #[serde(default)]
        frame: Option<String>,
        /// Slice of a volume, `z=10`.
        #[serde(default)]
        slice: Option<String>,
        /// Plane of a volume: `xy`, `xz` or `yz`.
        #[serde(default)]
        plane: Option<String>,
        /// Part of the plane, `X0:X1,Y0:Y1`.
        #[serde(default)]
        crop: Option<String>,
        /// Columns and rows to resample to, after cropping.
        #[serde(default)]
        resample: Option<(usize, usize)>,
        /// Tensors of an image.
        #[serde(default)]
        derive: Option<DeriveRule>,
        /// File of one number a voxel; tensors become zero where it is not above [`mask_above`](Self::File::mask_above).
        #[serde(default)]
        mask: Option<String>,
        /// What a mask, or the confidence in an NRRD file, must exceed.
        #[serde(default)]
        mask_above: f64,
        /// What becomes of tensors that are infinite or not a number: `refuse` (the default) or `zero`.
        #[serde(default)]
        not_finite: Option<String>,
        /// Every how many cells one is kept, from the upper left.
        #[serde(default = "one")]
        stride: usize,
    },
    /// Another field with noise added to its tensors.
    Noisy {
        /// The field.
        of: Box<FieldSource>,
        /// Size of the noise over that of each tensor (Frobenius norm, root of the mean square).
        share: Fraction,
        /// Seed of the random numbers.
        seed: u64,
    },
}

/// Tensors made of an image; scales are standard deviations of Gaussians, in cells.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum DeriveRule {
    /// Gradient of a vector field.
    Gradient {
        /// Of the field smoothed by this much.
        #[serde(default)]
        sigma: Option<Sigma>,
    },
    /// Second derivatives of a scalar field.
    Hessian {
        /// Of the field smoothed by this much.
        #[serde(default)]
        sigma: Option<Sigma>,
    },
    /// Rate of strain: the symmetric part of the gradient of a vector field.
    StrainRate {
        /// Of the field smoothed by this much.
        #[serde(default)]
        sigma: Option<Sigma>,
    },
    /// Averaged products of a scalar field's derivatives: light and lines run across stripes.
    Structure {
        /// Derivatives of the field smoothed by this much.
        #[serde(default)]
        sigma: Option<Sigma>,
        /// Averaged over this much.
        #[serde(default)]
        window: Option<Sigma>,
    },
    /// The structure tensor with its eigenvalues exchanged: light and lines run along stripes.
    Orientation {
        /// Derivatives of the field smoothed by this much.
        #[serde(default)]
        sigma: Option<Sigma>,
        /// Averaged over this much.
        #[serde(default)]
        window: Option<Sigma>,
    },
}

fn one() -> usize {
    1
}

/// A generator's parameter: a number, a flag or a word.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(try_from = "ron::Value")]
pub struct Parameter(pub String);

impl TryFrom<ron::Value> for Parameter {
    type Error = String;

    fn try_from(value: ron::Value) -> Result<Self, String> {
        match value {
            ron::Value::Bool(b) => Ok(Self(b.to_string())),
            ron::Value::String(s) => Ok(Self(s)),
            ron::Value::Number(n) => Ok(Self(number_text(n.into_f64()))),
            other => Err(format!("expected a number, true, false or a string, found {other:?}")),
        }
    }
}

fn number_text(x: f64) -> String {
    format!("{x}")
}

/// A computation.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Run {
    /// Light from some cells.
    Light {
        /// Name of the field.
        field: String,
        /// Angular samples S, a multiple of 8.
        #[serde(default)]
        directions: DirectionCount,
        /// How profiles are scaled.
        #[serde(default)]
        normalization: NormalizationRule,
        /// Cone weights of the overlap.
        #[serde(default)]
        weights: Weights,
        /// The lights; a scene's own where there are none.
        #[serde(default)]
        lights: Vec<LightSource>,
        /// When to end.
        #[serde(default)]
        stop: Stop,
        /// What computes it.
        #[serde(default)]
        engine: EngineChoice,
        /// Steps whose distribution is kept for figures and checks besides the last one; 0 is the state before the first.
        #[serde(default)]
        frames: Vec<usize>,
        /// When it runs.
        #[serde(default)]
        scope: Scope,
    },
    /// The light transport gradient of a field.
    Gradient {
        /// Name of the field.
        field: String,
        /// Angular samples S, a multiple of 8.
        #[serde(default)]
        directions: DirectionCount,
        /// How profiles are scaled.
        #[serde(default)]
        normalization: NormalizationRule,
        /// Cone weights of the overlap.
        #[serde(default)]
        weights: Weights,
        /// When each propagation ends.
        #[serde(default)]
        stop: Stop,
        /// Half-width of the angular difference.
        #[serde(default)]
        omega_step: OmegaStep,
        /// Angles to compute, degrees; all when left out. Each must be a sample.
        #[serde(default)]
        slices_deg: Option<Vec<Finite>>,
        /// When it runs.
        #[serde(default)]
        scope: Scope,
    },
    /// How pulses come to rest: what a stopping rule leaves out of their stationary states, how many plain steps lead there,
    /// and how few evaluations the solver of gradients needs instead.
    Pulses {
        /// Name of the field.
        field: String,
        /// Angular samples S, a multiple of 8.
        #[serde(default)]
        directions: DirectionCount,
        /// How profiles are scaled.
        #[serde(default)]
        normalization: NormalizationRule,
        /// Cone weights of the overlap.
        #[serde(default)]
        weights: Weights,
        /// The rule that is compared with the stationary state.
        #[serde(default)]
        stop: Stop,
        /// Columns and rows from which pulses start.
        cells: Vec<(usize, usize)>,
        /// Directions in which a pulse starts from each of the cells, degrees. Each must be a sample.
        angles_deg: Vec<Finite>,
        /// When it runs.
        #[serde(default)]
        scope: Scope,
    },
    /// The finite-time Lyapunov exponent of the field's lines.
    Ftle {
        /// Name of the field.
        field: String,
        /// The axes that lines follow.
        #[serde(default)]
        axes: AxesChoice,
        /// By what the major one is larger.
        #[serde(default)]
        major: Option<MajorChoice>,
        /// Which of the two.
        #[serde(default)]
        family: FamilyChoice,
        /// Length of the lines to each side, in the unit of the smaller side of a cell.
        length: Positive,
        /// Samples a cell along each side.
        #[serde(default = "two")]
        samples: usize,
        /// When it runs.
        #[serde(default)]
        scope: Scope,
    },
}

fn two() -> usize {
    2
}

/// How profiles are scaled against each other.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum NormalizationRule {
    /// By their own means: nothing absorbs.
    #[default]
    Local,
    /// By the largest mean (eq. 3.11).
    Global,
    /// Locally from this fraction of the largest mean, absorbing below.
    LocalAbove(Fraction),
    /// Locally from this fraction of the largest mean, globally below.
    LocalAboveGlobal(Fraction),
}

/// Cone weights of the overlap of face and diagonal cones.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum Weights {
    /// The printed constants.
    #[default]
    Thesis,
    /// The values their formula gives for beta = atan(1/2).
    Geometric,
}

/// What computes a distribution.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum EngineChoice {
    /// Eight fluxes a cell.
    #[default]
    EightLobe,
    /// Whole profiles: slow, the oracle.
    SampleSpace,
}

/// A light.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct LightSource {
    /// Column and row, 0 on the upper left; left out: the centre.
    #[serde(default)]
    pub cell: Option<(usize, usize)>,
    /// When it shines.
    #[serde(default)]
    pub emission: EmissionKind,
    /// What it shines.
    #[serde(default)]
    pub profile: ProfileShape,
}

/// When a light shines.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum EmissionKind {
    /// Always; its cell's profile is replaced after every step.
    #[default]
    Continuous,
    /// Once, before the first step.
    Impulse,
}

/// What a light shines, W/rad.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum ProfileShape {
    /// The same in every direction.
    Isotropic(Positive),
    /// `max(0, cos(theta - theta0))^power`.
    Emitter {
        /// Brightest direction, degrees.
        theta_deg: Finite,
        /// 0 spherical, 1 Lambert, 2 cone, more: narrower.
        power: NonNegative,
        /// Intensity in the brightest direction, W/rad.
        #[serde(default = "Positive::one")]
        intensity: Positive,
    },
    /// One sample.
    Pulse {
        /// Direction, degrees; must be a sample.
        theta_deg: Finite,
    },
    /// An expression in `theta` (radians), negative values clipped.
    Expression(String),
}

impl Default for ProfileShape {
    fn default() -> Self {
        Self::Isotropic(Positive::one())
    }
}

/// When a propagation ends.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Stop {
    /// Change of the total flux below a threshold (the published programme).
    FluxChange {
        /// W.
        threshold: NonNegative,
        /// At most this many steps and one.
        #[serde(default = "thousand")]
        max_iterations: usize,
    },
    /// Change of the distribution below a threshold (the text of the thesis).
    DistributionChange {
        /// W.
        threshold: NonNegative,
        /// At most this many steps and one.
        #[serde(default = "thousand")]
        max_iterations: usize,
    },
    /// Relative change of the distribution at most 1e-10: the stationary state.
    Stationary,
    /// Exactly so many steps.
    Steps(usize),
}

fn thousand() -> usize {
    1000
}

impl Default for Stop {
    fn default() -> Self {
        Self::FluxChange { threshold: NonNegative::half(), max_iterations: thousand() }
    }
}

/// Half-width K of the angular difference, in samples.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum OmegaStep {
    /// ceil(S/12), as in most published volumes.
    #[default]
    Volumes,
    /// S/16, as in the published slices.
    Slices,
    /// This many samples.
    Samples(usize),
}
