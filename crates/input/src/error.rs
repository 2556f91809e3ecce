//! What keeps a file from being a tensor field.

use thiserror::Error;
use tigereye_fields::FieldError;
use tigereye_io::matrices::MatricesError;
use tigereye_io::npy::NpyError;
use tigereye_io::table::TableError;
use tigereye_io::volume::{PlaneError, VolumeError};
use tigereye_io::{ChoiceError, IoError};

/// What keeps a file from being a tensor field.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum InputError {
    /// The bytes of a file are not to be had; in the words of whoever reads them.
    #[error("{words}")]
    Unread {
        /// What went wrong, with the file's name.
        words: String,
    },
    /// An extension that tells no format.
    #[error("unknown file extension: expected {expected}")]
    Extension {
        /// The extensions that are read, in words.
        expected: String,
    },
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
        source: Box<IoError>,
        /// The data file of a header.
        detached: Option<Box<str>>,
    },
    /// Numbers or vectors where tensors are needed.
    #[error(
        "holds {components} per voxel: expected tensors, or --derive gradient, strain-rate, hessian, structure or orientation"
    )]
    NoTensors {
        /// Words for what is there.
        components: &'static str,
    },
    /// Text with vectors at positions, where tensors or numbers are needed.
    #[error(
        "is a table of vectors at positions (x, y, u, v), not 2x2 blocks: expected --derive gradient or strain-rate"
    )]
    VectorTable,
    /// Text with points, one a line, whose columns have no names.
    #[error(
        "is a table without column names (one point per line), not 2x2 blocks: expected a line above the numbers with names \
         such as x,y,S11,S22,S12 (or --derive gradient for x, y, u, v)"
    )]
    UnnamedTable,
    /// A picture, which holds brightness.
    #[error("is a picture: expected --derive structure, orientation or hessian")]
    Picture,
    /// Tuples that cannot be differentiated as asked.
    #[error("holds {components} numbers per voxel: expected {expected} for --derive {name}")]
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
    /// A mask that leaves nothing.
    #[error(
        "mask {mask} leaves nothing: expected a number above {above} at one point at least (--mask-above, --mask-array)"
    )]
    NothingLeft {
        /// Name of the mask's file.
        mask: String,
        /// What its numbers should exceed.
        above: f64,
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
    #[error("{option} has no effect here: {why}")]
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

/// Which option helps.
fn hint(source: &IoError) -> &'static str {
    match source {
        IoError::Plane(PlaneError::Needed { .. }) => " (option --slice AXIS=INDEX)",
        IoError::Plane(PlaneError::SliceNeeded { .. }) => " (option --slice)",
        IoError::Choice(ChoiceError::Ambiguous { candidates })
            if candidates.iter().any(|c| c.contains(", ")) =>
        {
            " (option --array, or --components for those of several arrays)"
        }
        IoError::Choice(ChoiceError::Ambiguous { .. }) | IoError::Table(TableError::Times { .. }) => {
            " (option --array)"
        }
        IoError::Volume(VolumeError::NoTensor { .. }) => " (option --order)",
        IoError::Choice(ChoiceError::NoArray { wanted, available })
            if wanted.starts_with("array of tensors")
                && available.iter().any(|a| a.ends_with("a vector)")) =>
        {
            " (option --derive gradient or strain-rate for tensors of a vector)"
        }
        // Components whose names are not understood.
        IoError::Choice(ChoiceError::NoArray { wanted, available })
            if wanted.starts_with("array of tensors")
                && available.iter().filter(|a| a.ends_with("(1 component)")).count() >= 3 =>
        {
            " (option --components XX=NAME,YY=NAME,XY=NAME for arrays of one component each)"
        }
        IoError::Matrices(MatricesError::OddColumns { .. }) => {
            " (a table, one point a line, needs a line of names such as x,y,S11,S22,S12 above the numbers)"
        }
        IoError::Limit(_) => " (option --limit)",
        IoError::Npy(NpyError::Shape { .. }) => " (option --derive for vectors and numbers)",
        _ => "",
    }
}

impl From<IoError> for InputError {
    fn from(source: IoError) -> Self {
        Self::File { source: Box::new(source), detached: None }
    }
}

impl From<VolumeError> for InputError {
    fn from(source: VolumeError) -> Self {
        IoError::from(source).into()
    }
}

impl From<PlaneError> for InputError {
    fn from(source: PlaneError) -> Self {
        IoError::from(source).into()
    }
}

impl InputError {
    /// The same about the file of a mask, whose array has an option of its own.
    pub(crate) fn words_of_mask(&self) -> String {
        match self {
            Self::File { source, .. }
                if matches!(**source, IoError::Choice(ChoiceError::Ambiguous { .. })) =>
            {
                format!("{source} (option --mask-array)")
            }
            other => other.to_string(),
        }
    }

    /// An option that chooses an array in a file that has no names for them.
    pub(crate) const fn nameless(option: &'static str) -> Self {
        Self::Needless { option, why: "the format has no names for arrays" }
    }
}
