//! Data files of every readable format as tensor fields in the plane, with what was read and what was assumed.
//!
//! ```text
//! bytes --io--> Lattice --tensors--> TensorVolume --slice--> Field<Tensor2>
//!                  |                                             ^
//!                  '--slice--> scalars, vectors --derivatives----'     then crop and resample
//! ```
//!
//! The program's commands and the fields of experiment files go the same way. Whoever calls reads the bytes.

mod file;
pub mod lint;
mod plane;
pub mod provenance;
mod reading;
mod threshold;

pub use file::{Content, TEXT_MATRICES, TensorFile, finite_volume, format_of, is_readable, open};
pub use plane::{PlaneField, not_finite_words};
pub use reading::{Derivation, Derived, Reading};
pub use threshold::suggested_local_above;

use thiserror::Error;
use tigereye_fields::FieldError;
use tigereye_io::IoError;

/// What keeps a file from being a tensor field.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum InputError {
    /// The bytes of a file are not to be had; in the words of whoever reads them.
    #[error("{words}")]
    Unread {
        /// What went wrong, with the file's name.
        words: String,
    },
    /// An ending that tells no format.
    #[error(
        "unknown file extension: expected .txt, .npy, .npz, .vti, .vtp, .vtk, .nrrd, .nhdr, .nii, .nii.gz, .png, or .csv, .dat, .vec or .jvc for tables"
    )]
    Ending,
    /// A format that another program converts.
    #[error("{format} is not read: expected one of the readable formats; {help}")]
    Foreign {
        /// The format's name.
        format: &'static str,
        /// How to get there.
        help: &'static str,
    },
    /// What the file's reader says.
    #[error("{}{source}{}", detached.as_ref().map_or(String::new(), |d| format!("with its data in {d}: ")), hint(source))]
    File {
        /// The reader's words.
        source: IoError,
        /// The data file of a header.
        detached: Option<String>,
    },
    /// Numbers or vectors where tensors are needed.
    #[error(
        "holds {components} a voxel: expected tensors, or --derive gradient, strain-rate, hessian, structure or orientation"
    )]
    NoTensors {
        /// Words for what is there.
        components: &'static str,
    },
    /// Text with vectors at positions, where tensors or numbers are needed.
    #[error(
        "is a table of vectors at positions (x, y, u, v), no 2x2 blocks: expected --derive gradient or strain-rate"
    )]
    VectorTable,
    /// Text with points, one a line, whose columns have no names.
    #[error(
        "is a table without names of its columns, one point a line, no 2x2 blocks: expected a line above the numbers with names \
         such as x,y,S11,S22,S12 (or --derive gradient for x, y, u, v)"
    )]
    UnnamedTable,
    /// A picture, which holds brightness.
    #[error("is a picture: expected --derive structure, orientation or hessian")]
    Picture,
    /// Tuples that cannot be differentiated as asked.
    #[error("holds {components} numbers a voxel: expected {expected} for --derive {name}")]
    Tuples {
        /// Numbers a voxel.
        components: usize,
        /// How many there should be.
        expected: &'static str,
        /// What was to be derived.
        name: &'static str,
    },
    /// A mask of another size.
    #[error("mask {mask}: {} x {} x {} voxels: expected {} x {} x {}", found[0], found[1], found[2], expected[0], expected[1], expected[2])]
    MaskSize {
        /// Name of the mask's file.
        mask: String,
        /// Its voxels along each axis.
        found: [usize; 3],
        /// Those of the input.
        expected: [usize; 3],
    },
    /// A mask that cannot be read, or is no image of single numbers.
    #[error("mask {mask}: {words}")]
    Mask {
        /// Name of the mask's file.
        mask: String,
        /// What is wrong with it.
        words: String,
    },
    /// A tensor with a component that is infinite or not a number.
    #[error(
        "the tensor of cell ({x}, {y}) is not finite ({count} such tensors): expected numbers, a --mask that leaves them out, or --not-finite zero"
    )]
    NotFinite {
        /// Column of the first one.
        x: usize,
        /// Its row.
        y: usize,
        /// How many there are.
        count: usize,
    },
    /// The same in a volume that is taken whole.
    #[error(
        "the tensor of voxel ({}, {}, {}) is not finite ({count} such tensors): expected numbers, a --mask that leaves them out, or --not-finite zero", voxel[0], voxel[1], voxel[2]
    )]
    NotFiniteVoxel {
        /// Indices of the first one.
        voxel: [usize; 3],
        /// How many there are.
        count: usize,
    },
    /// An option that would change nothing.
    #[error("{option} has nothing to do: {why}")]
    Needless {
        /// The option.
        option: &'static str,
        /// Why.
        why: &'static str,
    },
    /// A size that no field has.
    #[error(transparent)]
    Field(#[from] FieldError),
}

/// Formats of tensors that are not read: their extensions, names, and what converts them.
const FOREIGN: &[(&[&str], &str, &str)] = &[
    (
        &["mif", "mih"],
        "MRtrix's image format",
        "`mrconvert IN.mif OUT.nii.gz` writes NIfTI (then --order mrtrix)",
    ),
    (&["mgz", "mgh"], "FreeSurfer's image format", "`mri_convert IN.mgz OUT.nii.gz` writes NIfTI"),
    (&["hdr", "img"], "ANALYZE or a NIfTI pair", "nibabel, or `fslchfiletype NIFTI_GZ`, writes one .nii.gz"),
    (&["dcm"], "DICOM", "dcm2niix writes the measurement as NIfTI, to which tensors are then fitted"),
    (&["mnc"], "MINC", "`mnc2nii` writes NIfTI"),
    (&["mha", "mhd"], "MetaImage", "ITK (SimpleITK.WriteImage) or 3D Slicer writes .nrrd or .nii.gz"),
    (
        &["xdmf", "xmf", "h5", "hdf5"],
        "XDMF or HDF5",
        "ParaView's Resample To Image, saved as .vti, reads it; h5py and numpy.save write an array as .npy",
    ),
    (&["exo", "e", "ex2", "exoii"], "Exodus II", "ParaView's Resample To Image, saved as .vti, reads it"),
    (
        &["odb"],
        "Abaqus's result format",
        "a script in Abaqus Python writes the stresses; save them as .npy or .vti",
    ),
    (
        &[
            "vtu", "vtr", "vts", "pvtu", "pvti", "vtm", "vtmb", "vthb", "vtkhdf", "frd", "msh", "inp",
            "cgns", "med", "case", "rst", "bdf",
        ],
        "a mesh or a collection",
        "ParaView's Resample To Image, saved as .vti, puts it on a lattice (for .frd, ccx2paraview first)",
    ),
    (&["mat"], "MATLAB's format", "scipy.io.loadmat and numpy.save write an array as .npy"),
    (&["tif", "tiff", "jpg", "jpeg", "bmp"], "a picture", "any picture program saves it as .png"),
    (&["pkl", "nc", "zarr", "parquet"], "an array store", "numpy.save writes an array as .npy"),
];

impl InputError {
    /// What is wrong with a name whose extension is not read.
    fn of_name(name: &str) -> Self {
        let unpacked = name.strip_suffix(".gz").unwrap_or(name);
        let extension = format_of(unpacked);
        let known = FOREIGN.iter().find(|(extensions, _, _)| extensions.contains(&extension.as_str()));
        known.map_or(Self::Ending, |&(_, format, help)| Self::Foreign { format, help })
    }
}

/// Which option helps.
fn hint(source: &IoError) -> &'static str {
    match source {
        IoError::PlaneNeeded { .. } => " (option --slice AXIS=INDEX)",
        IoError::SliceNeeded { .. } => " (option --slice)",
        IoError::AmbiguousArray { candidates } if candidates.iter().any(|c| c.contains(", ")) => {
            " (option --array, or --components for those of several arrays)"
        }
        IoError::AmbiguousArray { .. } => " (option --array)",
        IoError::NoTensor { .. } => " (option --order)",
        IoError::TooManyCells { .. } | IoError::TooManyValues { .. } => " (option --limit)",
        IoError::NpyShape { .. } => " (option --derive for vectors and numbers)",
        _ => "",
    }
}

impl From<IoError> for InputError {
    fn from(source: IoError) -> Self {
        Self::File { source, detached: None }
    }
}
