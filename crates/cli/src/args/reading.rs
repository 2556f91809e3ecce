//! The command line of reading, converting and comparing.

use super::values::{input_help, parse_count, parse_sigma, parse_size, parse_threshold};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use tigereye_input::{Derivation, Derived, Reading};
use tigereye_io::nifti::WrittenAs;
use tigereye_io::volume::{Axis, ComponentArrays, Crop, Frame, Plane, PlaneChoice, Shear, parse_slice};

/// What files do not state, the plane of a volume, and what becomes of its values.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ReadingArgs {
    /// Array of a .vti, .vtp, .vtk or .npz to take the tensors from; points:NAME or cells:NAME where both have one of
    /// that name.
    #[arg(long, value_name = "NAME")]
    array: Option<String>,
    /// A tensor from arrays of their own: XX=S_XX,YY=S_YY,XY=S_XY for single numbers, X=T_x,Y=T_y,Z=T_z for rows; with
    /// --derive gradient the components of a vector.
    #[arg(long, value_name = "XX=NAME,YY=NAME,XY=NAME[,...]", value_parser = ComponentArrays::parse)]
    components: Option<ComponentArrays>,
    /// Order of the components: vtk, nrrd, dipy, fsl, mrtrix, itk, voigt, abaqus, or names such as xx,yy,zz,xy.
    #[arg(long, value_name = "ORDER")]
    order: Option<String>,
    /// What the numbers of shears are: components of the tensor, or engineering shears, twice as large.
    #[arg(long, value_enum)]
    shear: Option<ShearName>,
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
    /// Number of cells after cropping; tensors are interpolated, or averaged if there are fewer cells than before.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    resample: Option<[usize; 2]>,
    /// Tensors of an image: gradient or rate of strain of vectors; Hessian, structure tensor (light runs across
    /// stripes) or orientation tensor (along them) of numbers.
    #[arg(long, value_enum)]
    derive: Option<DerivedName>,
    /// Standard deviation of the Gaussian with which derivatives are taken, cells; by default 0 for gradients and 1 for
    /// images.
    #[arg(long, value_name = "CELLS", value_parser = parse_sigma, requires = "derive")]
    sigma: Option<f64>,
    /// Standard deviation of the Gaussian window over which structure and orientation tensors are averaged, cells; 4 by
    /// default.
    #[arg(long, value_name = "CELLS", value_parser = parse_sigma, requires = "derive")]
    window: Option<f64>,
    /// File of one number per voxel; tensors become zero where the number does not exceed --mask-above.
    #[arg(long, value_name = "FILE")]
    mask: Option<String>,
    /// Array of the mask file, if it has several; by default the one called mask, valid, validity or confidence, or
    /// else the active one.
    #[arg(long, value_name = "NAME", requires = "mask")]
    mask_array: Option<String>,
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
            components: self.components.clone(),
            order: self.order.clone(),
            shear: self.shear.map(Into::into),
            frame: self.frame.map(Into::into),
            choice: PlaneChoice { plane: self.plane.map(Into::into), slice: self.slice },
            crop: self.crop,
            resample: self.resample,
            derive,
            mask: self.mask.clone(),
            mask_array: self.mask_array.clone(),
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
    /// Rate of strain of a velocity: the symmetric part of the gradient.
    StrainRate,
    /// Averaged products of a scalar field's derivatives: light and lines run across stripes.
    Structure,
    /// The structure tensor with its eigenvalues exchanged: light and lines run along stripes.
    Orientation,
}

impl From<DerivedName> for Derived {
    fn from(name: DerivedName) -> Self {
        match name {
            DerivedName::Gradient => Self::Gradient,
            DerivedName::Hessian => Self::Hessian,
            DerivedName::StrainRate => Self::StrainRate,
            DerivedName::Structure => Self::Structure,
            DerivedName::Orientation => Self::Orientation,
        }
    }
}

/// What becomes of tensors that are not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum NotFinite {
    /// The file is refused.
    #[default]
    Refuse,
    /// They become zero tensors, which transmit nothing; their number is reported.
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
    /// FSL's: the voxel axes with x reversed where the determinant of the affine is positive.
    Fsl,
    /// Left, posterior and superior: ITK's, whose images of vectors in NIfTI keep them.
    Lps,
}

impl From<FrameName> for Frame {
    fn from(name: FrameName) -> Self {
        match name {
            FrameName::Voxel => Self::Voxel,
            FrameName::World => Self::World,
            FrameName::Measurement => Self::Measurement,
            FrameName::Fsl => Self::Fsl,
            FrameName::Lps => Self::Lps,
        }
    }
}

/// What the numbers of shears are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShearName {
    /// Components of the tensor.
    Tensor,
    /// Engineering shears: gamma_xy = 2 epsilon_xy.
    Engineering,
}

impl From<ShearName> for Shear {
    fn from(name: ShearName) -> Self {
        match name {
            ShearName::Tensor => Self::Tensor,
            ShearName::Engineering => Self::Engineering,
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
    #[arg(help = input_help())]
    pub(crate) input: String,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Layouts of NIfTI files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum WriteOrder {
    /// Symmetric or general matrices along the voxel axes, intents 1005 and 1004.
    Nifti,
    /// xx,xy,xz,yy,yz,zz along the axes of FSL's gradient tables.
    Fsl,
    /// xx,yy,zz,xy,xz,yz along the scanner's axes.
    Mrtrix,
}

impl From<WriteOrder> for WrittenAs {
    fn from(order: WriteOrder) -> Self {
        match order {
            WriteOrder::Nifti => Self::Matrices,
            WriteOrder::Fsl => Self::Fsl,
            WriteOrder::Mrtrix => Self::Mrtrix,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct ConvertArgs {
    #[arg(help = input_help())]
    pub(crate) input: String,
    /// The output by its extension: .vti, .vtp, .vtk, .nrrd, .nii, .nii.gz, .npy or .txt. A volume without a plane is
    /// written whole, which .npy and .txt cannot hold.
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// Add the fractional anisotropy, mean diffusivity and mode of every voxel as arrays `FA`, `MD` and `mode`; for
    /// whole volumes written as .vti, .vtp or .vtk.
    #[arg(long)]
    pub(crate) invariants: bool,
    /// Layout of the components of a .nii or .nii.gz: the standard's matrices (5-D), or six components (4-D) as FSL or
    /// MRtrix3 read them.
    #[arg(long, value_enum)]
    pub(crate) write_order: Option<WriteOrder>,
    /// Replace an output that exists.
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The first result: a gradient volume or light (.vti, .npy), a tensor field in any readable format, or a
    /// generator.
    pub(crate) a: String,
    /// The second result.
    pub(crate) b: String,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// Largest relative difference accepted: the L2 difference over the L2 norm of A, and the largest difference over
    /// the largest value of A.
    #[arg(long, value_name = "REL", default_value = "1e-10", value_parser = parse_threshold, allow_hyphen_values = true)]
    pub(crate) tolerance: f64,
    /// Angular slices of volumes to leave out (sample indices).
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', value_parser = parse_count)]
    pub(crate) except_slices: Vec<usize>,
}
