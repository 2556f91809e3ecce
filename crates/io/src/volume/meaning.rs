//! What components of tensors are along, and how that is known.

/// The axes that the components of a tensor are along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The voxel axes.
    Voxel,
    /// The axes of the file's world: VTK's x, y, z; the patient's or scanner's axes.
    World,
    /// NRRD's measurement frame.
    Measurement,
    /// The axes of FSL's gradient tables, and of tensors fitted with them: the voxel axes, the first reversed where the
    /// determinant of the affine is positive (FSL, "What conventions do the bvecs use?", FDT user guide).
    Fsl,
    /// Left, posterior and superior, whatever the file's own world: ITK's axes, in which it writes images of vectors as
    /// they are.
    Lps,
}

impl Frame {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Voxel, Self::World, Self::Measurement, Self::Fsl, Self::Lps];

    /// The frame of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }

    /// The name the command line uses.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Voxel => "voxel",
            Self::World => "world",
            Self::Measurement => "measurement",
            Self::Fsl => "fsl",
            Self::Lps => "lps",
        }
    }

    /// The axes in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Voxel => "the voxel axes",
            Self::World => "the world axes",
            Self::Measurement => "the measurement axes",
            Self::Fsl => "the axes of FSL's gradient tables",
            Self::Lps => "the axes left, posterior, superior",
        }
    }
}

/// What the numbers of shear components are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shear {
    /// Components of the tensor.
    #[default]
    Tensor,
    /// Engineering shears, twice the components: gamma_xy = 2 epsilon_xy.
    Engineering,
}

/// How something about a file is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// The file says so.
    Stated,
    /// The user says so.
    Given,
    /// The format leaves it open and this program has a convention for it.
    Convention,
    /// Assumed by convention; the file does not state it.
    Assumed,
}

impl Known {
    /// `stated by the file`, `as given`, `by convention` or `assumed`.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Stated => "stated by the file",
            Self::Given => "as given",
            Self::Convention => "this program's convention for the format",
            Self::Assumed => "ASSUMED: the file does not say",
        }
    }

    /// The same in a word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Stated => "stated",
            Self::Given => "given",
            Self::Convention => "by convention",
            Self::Assumed => "assumed",
        }
    }
}

/// What the axes of the world are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum World {
    /// A viewer's own: x right, y up.
    Viewer,
    /// The patient's or scanner's, by its name in the file.
    Scanner(String),
    /// None: rows and columns of an array or a picture, which lie nowhere.
    Absent,
}

/// Worlds of scanners with the signs that turn their axes to the right, anterior and superior, by NRRD's names.
const SCANNERS: [(&str, &str, [f64; 3]); 3] = [
    ("right-anterior-superior", "RAS", [1.0, 1.0, 1.0]),
    ("left-anterior-superior", "LAS", [-1.0, 1.0, 1.0]),
    ("left-posterior-superior", "LPS", [-1.0, -1.0, 1.0]),
];

impl World {
    /// Whether the axes are named after the patient: left or right, posterior or anterior.
    #[must_use]
    pub fn is_of_patient(&self) -> bool {
        self.signs().is_some()
    }

    /// Signs that turn the axes to the right, anterior and superior; `None` for worlds that are not the patient's.
    pub(crate) fn signs(&self) -> Option<[f64; 3]> {
        let Self::Scanner(name) = self else { return None };
        let is_named = |(long, short, _): &&(&str, &str, _)| {
            name.eq_ignore_ascii_case(long) || name.eq_ignore_ascii_case(short)
        };
        SCANNERS.iter().find(is_named).map(|(_, _, signs)| *signs)
    }
}
