//! The command line of reading, converting and comparing.

use super::values::{parse_count, parse_sigma, parse_size, parse_threshold};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use tigereye_experiments::input::{Derivation, Derived, Reading};
use tigereye_io::volume::{Axis, Crop, Frame, Plane, PlaneChoice, parse_slice};

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
    /// Plane of a volume, by its voxel axes; how it lies in the picture follows from the world of the file.
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
