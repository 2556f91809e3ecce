//! What a user says about a file.

use crate::InputError;
use tigereye_io::volume::{ComponentArrays, Crop, Frame, PlaneChoice, Shear};
use tigereye_io::{ArrayChoice, Limits, Wanted};

/// What files do not state, the plane of a volume, and what becomes of its values. The default says nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Array of a VTK file or `.npz` archive.
    pub array: Option<String>,
    /// Arrays that hold one component each (or one row), where there is no array of tuples.
    pub components: Option<ComponentArrays>,
    /// Component order: a tool's name or component names.
    pub order: Option<String>,
    /// What the numbers of shears are; components of the tensor where nobody says otherwise.
    pub shear: Option<Shear>,
    /// Axes that the components are along.
    pub frame: Option<Frame>,
    /// Plane and slice of a volume.
    pub choice: PlaneChoice,
    /// Part of the plane.
    pub crop: Option<Crop>,
    /// Columns and rows that the field is resampled to.
    pub resample: Option<[usize; 2]>,
    /// Tensors made of numbers or vectors.
    pub derive: Option<Derivation>,
    /// File with one number a voxel; where it is not above [`Self::mask_above`], tensors become zero.
    pub mask: Option<String>,
    /// Array of the mask's file, where this has several.
    pub mask_array: Option<String>,
    /// Confidence that a mask (of its own file, or in NRRD) must exceed.
    pub mask_above: f64,
    /// Whether tensors that are not finite become zero instead of being refused.
    pub zero_not_finite: bool,
    /// Numbers that a file may hold at most; [`Limits::default`] where nobody says another.
    pub limit: Option<u64>,
}

/// Which tensors, at which scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivation {
    /// Which tensors.
    pub kind: Derived,
    /// Standard deviation of the Gaussian that derivatives are taken of, cells.
    pub sigma: f64,
    /// Standard deviation of the window that structure tensors are averaged over, cells; [`Derived::USUAL_WINDOW`]
    /// where nobody says another.
    pub window: Option<f64>,
}

/// Tensors of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derived {
    /// Gradient of a vector field.
    Gradient,
    /// Second derivatives of a scalar field.
    Hessian,
    /// Rate of strain of a velocity: the symmetric part of its gradient.
    StrainRate,
    /// Averaged products of a scalar field's derivatives: the major axis runs across stripes.
    Structure,
    /// The structure tensor with its eigenvalues exchanged: the major axis runs along stripes.
    Orientation,
}

impl Derived {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Gradient, Self::StrainRate, Self::Hessian, Self::Structure, Self::Orientation];

    /// `gradient`, `strain-rate`, `hessian`, `structure` or `orientation`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gradient => "gradient",
            Self::Hessian => "hessian",
            Self::StrainRate => "strain-rate",
            Self::Structure => "structure",
            Self::Orientation => "orientation",
        }
    }

    /// The kind of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|d| d.name() == name)
    }

    /// The scale where nobody says another: differences of neighbours for vectors, one cell for images.
    #[must_use]
    pub const fn usual_sigma(self) -> f64 {
        match self {
            Self::Gradient | Self::StrainRate => 0.0,
            Self::Hessian | Self::Structure | Self::Orientation => 1.0,
        }
    }

    /// Whether it is made of vectors, not of single numbers.
    #[must_use]
    pub const fn takes_vectors(self) -> bool {
        match self {
            Self::Gradient | Self::StrainRate => true,
            Self::Hessian | Self::Structure | Self::Orientation => false,
        }
    }

    /// Whether it is averaged over a window.
    #[must_use]
    pub const fn has_window(self) -> bool {
        match self {
            Self::Structure | Self::Orientation => true,
            Self::Gradient | Self::StrainRate | Self::Hessian => false,
        }
    }

    /// The window where nobody says another, cells.
    pub const USUAL_WINDOW: f64 = 4.0;
}

impl Reading {
    /// Refuses options that would change nothing.
    ///
    /// # Errors
    /// [`InputError::Needless`].
    pub fn check(&self) -> Result<(), InputError> {
        if self.components.is_some() && (self.array.is_some() || self.order.is_some()) {
            let option = if self.array.is_some() { "--array" } else { "--order" };
            return Err(InputError::Needless {
                option,
                why: "--components names the arrays and their order",
            });
        }
        if self.mask_array.is_some() && self.mask.is_none() {
            return Err(InputError::Needless { option: "--mask-array", why: "no --mask is given" });
        }
        let Some(Derivation { kind, window, .. }) = self.derive else { return Ok(()) };
        let numbers = !kind.takes_vectors();
        let needless = [
            (
                self.order.is_some(),
                "--order",
                "--derive takes numbers or vectors, which have no component order",
            ),
            (self.shear.is_some(), "--shear", "--derive takes numbers or vectors, which have no shears"),
            (
                numbers && self.frame.is_some(),
                "--frame",
                "--derive hessian, structure and orientation take single numbers, which are along no axes",
            ),
            (
                !kind.has_window() && window.is_some(),
                "--window",
                "only --derive structure and orientation average over a window",
            ),
        ];
        match needless.into_iter().find(|(is_given, _, _)| *is_given) {
            Some((_, option, why)) => Err(InputError::Needless { option, why }),
            None => Ok(()),
        }
    }

    /// Which array is meant.
    #[must_use]
    pub fn array_choice(&self) -> ArrayChoice<'_> {
        match &self.components {
            Some(components) => ArrayChoice::Components(components),
            None => ArrayChoice::from(self.array.as_deref()),
        }
    }

    /// What a file may ask for.
    #[must_use]
    pub fn limits(&self) -> Limits {
        self.limit.map_or_else(Limits::default, |values| Limits { cells: values, values })
    }

    /// What the tuples of the file must be.
    #[must_use]
    pub const fn wanted(&self) -> Wanted {
        match self.derive {
            None => Wanted::Tensors,
            Some(Derivation { kind, .. }) if kind.takes_vectors() => Wanted::Vectors,
            Some(_) => Wanted::Scalars,
        }
    }
}
