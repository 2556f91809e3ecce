//! The command line.

pub(crate) mod classical;

use clap::{Args, Parser, Subcommand, ValueEnum};
use classical::{FtleArgs, GlyphsArgs, LicArgs, LinesArgs, RidgesArgs, TopologyArgs};
use std::path::PathBuf;
use tigereye_core::{Below, Directions, Normalization};
use tigereye_experiments::input::{Derivation, Derived, Reading};
use tigereye_fields::images::MAX_SIGMA;
use tigereye_io::volume::{Axis, Crop, Frame, Plane, PlaneChoice, parse_slice};
use tigereye_ltg::Shard;

/// Shows 2D tensor fields by letting light run through them.
#[derive(Debug, Parser)]
#[command(name = "tigereye", version, arg_required_else_help = true, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Recompute every evaluation of the thesis and write a report.
    Reproduce(ReproduceArgs),
    /// Run experiment files and write a report of them.
    Run(RunArgs),
    /// Parse and validate experiment files without running them.
    Check(CheckArgs),
    /// The test fields.
    #[command(subcommand)]
    Field(FieldCommand),
    /// One light distribution.
    Propagate(PropagateArgs),
    /// The light transport gradient volume.
    Ltg(LtgArgs),
    /// The light transport gradient volume of shards computed apart.
    Merge(MergeArgs),
    /// What a tensor field holds and how it was read.
    Info(InfoArgs),
    /// Any readable tensor field to another format.
    Convert(ConvertArgs),
    /// Tensor lines and hyperstreamlines.
    Lines(LinesArgs),
    /// Degenerate points and separatrices.
    Topology(TopologyArgs),
    /// Noise smeared along the axes (line integral convolution).
    Lic(LicArgs),
    /// Finite-time Lyapunov exponent of the tensor lines.
    Ftle(FtleArgs),
    /// A glyph for every tensor.
    Glyphs(GlyphsArgs),
    /// Height ridges or contours of a gradient, of exponents, or of any other image of numbers.
    Ridges(RidgesArgs),
    /// Difference of two results.
    Compare(CompareArgs),
    /// What a change moved: numbers and figures of two results, or pending snapshots, on one page.
    Review(ReviewArgs),
    /// The engine's speed beside the limits of this machine.
    Bench(BenchArgs),
}

#[derive(Debug, Subcommand)]
pub(crate) enum FieldCommand {
    /// All generators with their parameters and defaults.
    List(FieldListArgs),
    /// A field file to begin with, and an experiment made from it.
    New(FieldNewArgs),
    /// A sheet about a field: ellipses, lines, anisotropy, determinant, one light, a gradient.
    Show(FieldShowArgs),
    /// What is odd about a field.
    Lint(FieldLintArgs),
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
    /// A field file, a data file or a generator.
    pub(crate) input: String,
    /// The sheet, .png or .svg.
    #[arg(short, long = "output", value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Cell that shines, column and row; by default the one nearest to the middle whose tensor is not zero.
    #[arg(long, value_name = "X,Y", value_parser = parse_cell)]
    pub(crate) light: Option<[usize; 2]>,
    /// Direction of the gradient, degrees, a multiple of 22.5.
    #[arg(long, value_name = "DEG", default_value_t = 90.0)]
    pub(crate) slice_deg: f64,
    /// Scaling of transmission profiles; as `ltg` by default.
    #[arg(long, value_name = "RULE", value_parser = parse_normalization)]
    pub(crate) normalization: Option<Normalization>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

#[derive(Debug, Args)]
pub(crate) struct FieldLintArgs {
    /// A field file, a data file or a generator.
    pub(crate) input: String,
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    /// Folder for the report, figures and data.
    #[arg(long, value_name = "DIR", default_value = "results")]
    pub(crate) out: PathBuf,
    /// Only this experiment; may be repeated.
    #[arg(long, value_name = "SLUG")]
    pub(crate) only: Vec<String>,
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
    /// Folder for the report, figures and data.
    #[arg(long, value_name = "DIR", default_value = "results")]
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
pub(crate) struct FieldListArgs {
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

/// What a computation may use.
#[derive(Clone, Debug, Args)]
pub(crate) struct Resources {
    /// Threads; all processors by default. Results do not depend on it.
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Upper bound on memory, bytes (suffixes K, M, G); half of the machine's by default.
    #[arg(long, value_name = "BYTES", value_parser = parse_bytes)]
    pub(crate) memory: Option<u64>,
}

/// What determines a propagation.
#[derive(Clone, Debug, Args)]
pub(crate) struct SchemeArgs {
    /// Angular samples S, a multiple of 8.
    #[arg(long, value_name = "N", default_value = "32", value_parser = parse_directions)]
    pub(crate) directions: Directions,
    /// Stop when the stopping rule's measure falls below F; 0 never stops early.
    #[arg(long, value_name = "F", default_value = "0.5", value_parser = parse_threshold, allow_hyphen_values = true)]
    pub(crate) threshold: f64,
    /// At most N+1 steps.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = parse_count, allow_hyphen_values = true)]
    pub(crate) max_iterations: usize,
    /// What the threshold is compared with.
    #[arg(long, value_enum, default_value_t = StopRule::Flux)]
    pub(crate) stop: StopRule,
    /// global, local, local-above:F or local-above-global:F; `local` for generators and .txt, `global` otherwise.
    #[arg(long, value_name = "RULE", value_parser = parse_normalization)]
    pub(crate) normalization: Option<Normalization>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

/// What files do not state, the plane of a volume, and what becomes of its values.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ReadingArgs {
    /// Array of a .vti, .vtp, .vtk or .npz to take the tensors from.
    #[arg(long, value_name = "NAME")]
    array: Option<String>,
    /// Order of the components: vtk, nrrd, dipy, fsl, mrtrix, or names such as xx,xy,xz,yy,yz,zz.
    #[arg(long, value_name = "ORDER")]
    order: Option<String>,
    /// The axes that the components are along. `convert` of a whole volume whose file states them writes tensors along
    /// these axes instead.
    #[arg(long, value_enum)]
    frame: Option<FrameName>,
    /// Slice of a volume: axis and index, from 0 as the file counts, for example z=10.
    #[arg(long, value_name = "AXIS=INDEX", value_parser = parse_slice)]
    slice: Option<(Axis, usize)>,
    /// Plane of a volume; the first letter to the right, the second up.
    #[arg(long, value_enum)]
    plane: Option<PlaneName>,
    /// Part of the plane: columns X0 to X1-1, rows Y0 to Y1-1, row 0 on top.
    #[arg(long, value_name = "X0:X1,Y0:Y1", value_parser = Crop::parse)]
    crop: Option<Crop>,
    /// Number of cells wanted, after cropping; tensors are interpolated, or averaged where cells become fewer.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    resample: Option<[usize; 2]>,
    /// Tensors of an image: the gradient of vectors, the Hessian or structure tensor of numbers.
    #[arg(long, value_enum)]
    derive: Option<DerivedName>,
    /// Gaussian that derivatives are taken at, cells; 0 for gradients and 1 for images by default.
    #[arg(long, value_name = "CELLS", value_parser = parse_sigma, requires = "derive")]
    sigma: Option<f64>,
    /// Gaussian window that structure tensors are averaged over, cells; 4 by default.
    #[arg(long, value_name = "CELLS", value_parser = parse_sigma, requires = "derive")]
    window: Option<f64>,
    /// File of one number a voxel; tensors become zero where it is not above --mask-above.
    #[arg(long, value_name = "FILE")]
    mask: Option<String>,
    /// What a mask, or the confidence in an NRRD file, must exceed.
    #[arg(long, value_name = "F", default_value_t = 0.0, value_parser = parse_threshold)]
    mask_above: f64,
    /// What becomes of tensors that are infinite or not a number.
    #[arg(long, value_enum, default_value_t = NotFinite::Refuse)]
    not_finite: NotFinite,
    /// Numbers that a file may hold at most, 2^28 by default; each takes eight bytes and more while it is read.
    #[arg(long, value_name = "N")]
    limit: Option<u64>,
}

impl ReadingArgs {
    /// The options as the readers want them.
    pub(crate) fn reading(&self) -> Reading {
        let derive = self.derive.map(|name| {
            let kind = Derived::from(name);
            Derivation { kind, sigma: self.sigma.unwrap_or_else(|| kind.usual_sigma()), window: self.window }
        });
        Reading {
            array: self.array.clone(),
            order: self.order.clone(),
            frame: self.frame.map(Into::into),
            choice: PlaneChoice { plane: self.plane.map(Into::into), slice: self.slice },
            crop: self.crop,
            resample: self.resample,
            derive,
            mask: self.mask.clone(),
            mask_above: self.mask_above,
            zero_not_finite: self.not_finite == NotFinite::Zero,
            limit: self.limit,
        }
    }
}

/// Tensors of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DerivedName {
    /// Gradient of a vector field.
    Gradient,
    /// Second derivatives of a scalar field.
    Hessian,
    /// Averaged products of a scalar field's derivatives.
    Structure,
}

impl From<DerivedName> for Derived {
    fn from(name: DerivedName) -> Self {
        match name {
            DerivedName::Gradient => Self::Gradient,
            DerivedName::Hessian => Self::Hessian,
            DerivedName::Structure => Self::Structure,
        }
    }
}

/// What becomes of tensors that are not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum NotFinite {
    /// The file is refused.
    #[default]
    Refuse,
    /// They become zero tensors, which transmit nothing; how many is said.
    Zero,
}

/// Frames of components.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FrameName {
    /// The voxel axes.
    Voxel,
    /// The world of the file: the scanner's axes, or VTK's x, y, z.
    World,
    /// NRRD's measurement frame.
    Measurement,
}

impl From<FrameName> for Frame {
    fn from(name: FrameName) -> Self {
        match name {
            FrameName::Voxel => Self::Voxel,
            FrameName::World => Self::World,
            FrameName::Measurement => Self::Measurement,
        }
    }
}

/// Planes of voxel axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlaneName {
    /// x right, y up.
    Xy,
    /// x right, z up.
    Xz,
    /// y right, z up.
    Yz,
}

impl From<PlaneName> for Plane {
    fn from(name: PlaneName) -> Self {
        match name {
            PlaneName::Xy => Self::Xy,
            PlaneName::Xz => Self::Xz,
            PlaneName::Yz => Self::Yz,
        }
    }
}

/// Stopping rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StopRule {
    /// Change of the total transported flux between two steps, W.
    Flux,
    /// Sum of the changes of all profiles, W.
    Distribution,
    /// That sum over the energy at most 1e-10; ignores --threshold and --max-iterations.
    Stationary,
}

#[derive(Debug, Args)]
pub(crate) struct PropagateArgs {
    /// A file (.txt .npy .npz .vti .vtp .vtk .nrrd .nhdr .nii .nii.gz) or a generator, NAME or NAME:key=value,key=value;
    /// or a scene (NAME.scene.ron).
    pub(crate) input: String,
    /// A light: column, row and, after a further comma, its profile as an expression in `theta` (default 1). A scene has
    /// lights of its own where none is given.
    #[arg(long = "light", value_name = "X,Y[,PROFILE]", allow_hyphen_values = true)]
    pub(crate) lights: Vec<String>,
    /// The lights flash once instead of shining all the time.
    #[arg(long)]
    pub(crate) impulse: bool,
    /// Exactly N steps instead of a stopping rule.
    #[arg(long, value_name = "N", value_parser = parse_count, allow_hyphen_values = true)]
    pub(crate) steps: Option<usize>,
    /// Outputs by their endings: .vti, .npy, .png, .svg; .pvd has a frame for every step, in the folder NAME beside NAME.pvd;
    /// .apng is an animation of the energy, a frame for every step or every n-th.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// What pictures show.
    #[arg(long, value_enum, default_value_t = Picture::Overlay)]
    pub(crate) picture: Picture,
    #[command(flatten)]
    pub(crate) scheme: SchemeArgs,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

/// What a picture of a light distribution shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Picture {
    /// Transmission (red) and light (blue) of every cell.
    Overlay,
    /// Energy of every cell, logarithmic.
    Energy,
}

#[derive(Debug, Args)]
pub(crate) struct LtgArgs {
    /// A file (.txt .npy .npz .vti .vtp .vtk .nrrd .nhdr .nii .nii.gz) or a generator, NAME or NAME:key=value,key=value;
    /// or a scene (NAME.scene.ron).
    pub(crate) input: String,
    /// Outputs by their endings: .vti, .npy; .png, .svg show the only slice, or the mean over the slices. With --shard
    /// one .part.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) scheme: SchemeArgs,
    /// Half-width of the angular difference, samples; ceil(S/12) by default.
    #[arg(long, value_name = "K", value_parser = parse_count, allow_hyphen_values = true)]
    pub(crate) omega_step: Option<usize>,
    /// Only these angular slices (sample indices: 90 degrees are S/4); the output then holds just them, ascending.
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', value_parser = parse_count, allow_hyphen_values = true)]
    pub(crate) slices: Option<Vec<usize>>,
    /// Precision of the computation.
    #[arg(long, value_enum, default_value_t = Precision::F64)]
    pub(crate) precision: Precision,
    #[command(flatten)]
    pub(crate) resources: Resources,
    /// Write NAME.view.py beside NAME.vti: it opens the volume in ParaView with contours and a slice.
    #[arg(long)]
    pub(crate) view: bool,
    /// Keep what is finished in DIR/checkpoint.part; the same command again continues.
    #[arg(long, value_name = "DIR")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Only piece K, from 0, of N nearly equal ones, for `merge`.
    #[arg(long, value_name = "K/N", value_parser = parse_shard)]
    pub(crate) shard: Option<Shard>,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// What `ltg --shard` wrote, every shard once, in any order.
    #[arg(required = true, value_name = "PART")]
    pub(crate) parts: Vec<PathBuf>,
    /// Outputs by their endings, as those of `ltg`: .vti, .npy, .png, .svg.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Precision of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Precision {
    /// Double precision.
    F64,
    /// Single precision: faster, and less than 1e-4 off in the fields that the tests compare.
    F32,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// A file (.txt .npy .npz .vti .vtp .vtk .nrrd .nhdr .nii .nii.gz) or a generator, NAME or NAME:key=value,key=value.
    pub(crate) input: String,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ConvertArgs {
    /// A file (.txt .npy .npz .vti .vtp .vtk .nrrd .nhdr .nii .nii.gz .png) or a generator, NAME or NAME:key=value,key=value.
    pub(crate) input: String,
    /// The output by its ending: .vti, .vtp, .vtk, .nrrd, .nii, .nii.gz, .npy or .txt. A volume without a plane is written
    /// whole, which .npy and .txt cannot hold.
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// Add the fractional anisotropy, mean diffusivity and mode of every voxel as arrays `FA`, `MD` and `mode`; for whole
    /// volumes written as .vti, .vtp or .vtk.
    #[arg(long)]
    pub(crate) invariants: bool,
    /// Replace an output that exists.
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The first result: a gradient volume or light (.vti, .npy), a tensor field in any readable format, or a generator.
    pub(crate) a: String,
    /// The second result.
    pub(crate) b: String,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// Largest relative difference accepted: the L2 difference over the L2 norm of A, and the largest difference over the
    /// largest value of A.
    #[arg(long, value_name = "REL", default_value = "1e-10", value_parser = parse_threshold, allow_hyphen_values = true)]
    pub(crate) tolerance: f64,
    /// Angular slices of volumes to leave out (sample indices).
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', value_parser = parse_count)]
    pub(crate) except_slices: Vec<usize>,
}

#[derive(Debug, Args)]
pub(crate) struct ReviewArgs {
    /// What was before: a results folder, as `reproduce --out` writes it, or a git revision, which is built and run.
    #[arg(required_unless_present = "snapshots", conflicts_with = "snapshots")]
    pub(crate) base: Option<String>,
    /// What is now, in the same way.
    #[arg(required_unless_present = "snapshots", conflicts_with = "snapshots")]
    pub(crate) head: Option<String>,
    /// Folder for the page and the summary, review.html and review.json.
    #[arg(long, value_name = "DIR", default_value = "review")]
    pub(crate) out: PathBuf,
    /// Only the experiment of this name, its file without folder and ending; repeatable. Of revisions only these are run.
    #[arg(long, value_name = "SLUG", conflicts_with = "snapshots")]
    pub(crate) only: Vec<String>,
    /// Largest relative change of a number that is no movement.
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

#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    /// The larger number of threads to measure; all processors by default. One thread is measured too.
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Sides of the square fields.
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', default_value = "14,51,101,201", value_parser = parse_side)]
    pub(crate) cells: Vec<usize>,
    /// Seconds for each number; each of the three numbers of a row takes so long, at the least.
    #[arg(long, value_name = "F", default_value = "1", value_parser = parse_seconds)]
    pub(crate) seconds: f64,
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

fn parse_side(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 3..=1000) => Ok(n),
        _ => Err("expected 3 to 1000".to_owned()),
    }
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x <= 60.0 => Ok(x),
        _ => Err("expected a number of seconds above 0, at most 60".to_owned()),
    }
}

fn parse_directions(text: &str) -> Result<Directions, String> {
    let samples =
        text.parse().map_err(|_| format!("expected a multiple of 8 from 8 to {}", Directions::MAX))?;
    Directions::new(samples).map_err(|e| e.to_string())
}

fn parse_threshold(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("expected a finite number from 0".to_owned()),
    }
}

fn parse_count(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "expected a whole number from 0".to_owned())
}

fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=1024) => Ok(n),
        _ => Err("expected 1 to 1024".to_owned()),
    }
}

fn parse_size(text: &str) -> Result<[usize; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.filter(|s| !s.contains(&0)).ok_or_else(|| "expected WIDTHxHEIGHT, for example 64x48".to_owned())
}

fn parse_cell(text: &str) -> Result<[usize; 2], String> {
    let cell = text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    cell.ok_or_else(|| "expected X,Y, for example 25,40".to_owned())
}

fn parse_sigma(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (0.0..=MAX_SIGMA).contains(&x) => Ok(x),
        _ => Err(format!("expected a number of cells from 0 to {MAX_SIGMA}")),
    }
}

pub(crate) fn parse_shard(text: &str) -> Result<Shard, String> {
    let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    let (index, count) = numbers.ok_or("expected K/N, for example 0/4")?;
    Shard::new(index, count).map_err(|e| e.to_string())
}

fn parse_bytes(text: &str) -> Result<u64, String> {
    let expected = || "expected a number of bytes, for example 2000000000, 800M or 2G".to_owned();
    let (digits, factor) = match text.char_indices().last() {
        Some((i, 'k' | 'K')) => (&text[..i], 1 << 10),
        Some((i, 'm' | 'M')) => (&text[..i], 1 << 20),
        Some((i, 'g' | 'G')) => (&text[..i], 1 << 30),
        _ => (text, 1),
    };
    let count: u64 = digits.parse().map_err(|_| expected())?;
    count.checked_mul(factor).filter(|b| *b > 0).ok_or_else(expected)
}

fn parse_normalization(text: &str) -> Result<Normalization, String> {
    let fraction = |f: &str, below| match f.parse::<f64>() {
        Ok(fraction) if (0.0..=1.0).contains(&fraction) => Ok(Normalization::LocalAbove { fraction, below }),
        _ => Err(format!("`{f}` is no fraction: expected a number from 0 to 1")),
    };
    match text.split_once(':') {
        None if text == "global" => Ok(Normalization::Global),
        None if text == "local" => Ok(Normalization::Local),
        Some(("local-above", f)) => fraction(f, Below::Absorb),
        Some(("local-above-global", f)) => fraction(f, Below::Global),
        _ => Err("expected global, local, local-above:F or local-above-global:F".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn bytes_have_suffixes() {
        assert_eq!(parse_bytes("2G"), Ok(2 << 30));
        assert_eq!(parse_bytes("12"), Ok(12));
        assert!(
            parse_bytes("0").is_err() && parse_bytes("x").is_err() && parse_bytes("99999999999G").is_err()
        );
        assert!(parse_bytes("").is_err() && parse_bytes("ü").is_err());
    }

    #[test]
    fn slices_and_crops_are_spelled_as_documented() {
        assert_eq!(parse_slice("z=10"), Ok((Axis::Z, 10)));
        assert_eq!(Crop::parse("1:5,0:4"), Ok(Crop { x: [1, 5], y: [0, 4] }));
        for wrong in ["", "z", "w=1", "z=-1", "xy=1", "z=1.5"] {
            assert!(parse_slice(wrong).is_err(), "{wrong}");
        }
        for wrong in ["", "1:5", "5:5,0:1", "a:b,c:d", "1:5,4:0", "1,2,3,4"] {
            assert!(Crop::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn shards_count_from_zero() {
        assert_eq!(parse_shard("2/3").map(|s| (s.index(), s.count())), Ok((2, 3)));
        for wrong in ["3/3", "0/0", "1", "-1/3", "a/b", "0/3/4", "", "0/99999999999999999999"] {
            assert!(parse_shard(wrong).is_err_and(|e| e.contains("K/N")), "{wrong}");
        }
    }

    #[test]
    fn normalisations_are_spelled_as_documented() {
        assert_eq!(parse_normalization("global"), Ok(Normalization::Global));
        assert!(matches!(parse_normalization("local-above:0.25"), Ok(Normalization::LocalAbove { .. })));
        assert!(parse_normalization("local-above:2").is_err() && parse_normalization("nothing").is_err());
    }
}
