//! What the tuples of an array are to be, and how well arrays suit.

use super::arrays::{GHOSTS, VALID_POINTS};
use crate::image::ActiveArrays;
use crate::volume::{Naming, names_eigenvectors, names_principal_values, naming};
use crate::{DataArray, ScalarType};

/// Where the tuples of an array sit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Association {
    /// At the points of the image.
    Points,
    /// In the cells between them.
    Cells,
}

impl Association {
    /// What stands before the name of an array where both associations have one of that name.
    pub(super) const fn prefix(self) -> &'static str {
        match self {
            Self::Points => "points:",
            Self::Cells => "cells:",
        }
    }
}

/// How well an array suits as a mask that is called one.
pub(super) const NAMED_MASK: u8 = 3;

/// Whether an array called so says which points count: `mask`, `brain_mask`, `valid`, `isValid`, `validity`.
fn names_mask(name: &str) -> bool {
    const NAMES: [&str; 5] = ["mask", "valid", "isvalid", "validity", "confidence"];
    let name = name.to_ascii_lowercase();
    name.split(|c: char| !c.is_alphanumeric()).any(|word| NAMES.contains(&word))
}

/// What the tuples of an array are to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wanted {
    /// Tensors.
    #[default]
    Tensors,
    /// Vectors of two or three components.
    Vectors,
    /// Single numbers.
    Scalars,
    /// Single numbers that say which points count: an array called after a mask goes before others.
    Mask,
}

impl Wanted {
    pub(super) const fn fits(self, components: usize) -> bool {
        match self {
            Self::Tensors => matches!(components, 9 | 7 | 6 | 4 | 3),
            Self::Vectors => matches!(components, 3 | 2),
            Self::Scalars | Self::Mask => components == 1,
        }
    }

    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Tensors => {
                "array of tensors: 9, 7, 6, 4 or 3 components (--array takes a vector or eigenvectors as well)"
            }
            Self::Vectors => "array with 3 or 2 components",
            Self::Scalars | Self::Mask => "array with one component",
        }
    }

    pub(super) const fn active(self, names: &ActiveArrays) -> Option<&String> {
        match self {
            Self::Tensors => names.tensors.as_ref(),
            Self::Vectors => names.vectors.as_ref(),
            Self::Scalars | Self::Mask => names.scalars.as_ref(),
        }
    }

    /// What is taken, in a word, as data sets have an active one of each.
    pub(super) const fn word(self) -> &'static str {
        match self {
            Self::Tensors => "tensors",
            Self::Vectors => "vectors",
            Self::Scalars | Self::Mask => "scalars",
        }
    }

    /// The option that names the array.
    pub(super) const fn option(self) -> &'static str {
        match self {
            Self::Tensors | Self::Vectors | Self::Scalars => "--array",
            Self::Mask => "--mask-array",
        }
    }

    /// Whether single numbers are wanted.
    #[must_use]
    pub const fn is_numbers(self) -> bool {
        matches!(self, Self::Scalars | Self::Mask)
    }

    /// How well an array suits that is not a second choice: others of that kind are ignored where it is taken.
    pub(super) const fn certain(self) -> u8 {
        match self {
            Self::Tensors | Self::Mask => 2,
            Self::Vectors | Self::Scalars => 1,
        }
    }

    /// How well an array suits: 0 not at all, then the better the larger.
    pub(super) fn suits(self, array: &DataArray, active: &ActiveArrays) -> u8 {
        let data = ![VALID_POINTS, GHOSTS].contains(&array.name.as_str());
        if self == Self::Mask && array.components == 1 {
            return match (array.name.as_str(), names_mask(&array.name)) {
                (GHOSTS, _) => 0,
                (VALID_POINTS, _) => 1,
                (_, false) => 2,
                (_, true) => NAMED_MASK,
            };
        }
        if !data || !self.fits(array.components) {
            return 0;
        }
        // Three or four bytes are a colour.
        let is_colour = array.scalar == ScalarType::UInt8 && matches!(array.components, 3 | 4);
        if active.marks.contains(&array.name) || self == Self::Tensors && is_colour {
            return 0;
        }
        let is_vector = active.vectors.as_ref() == Some(&array.name);
        match (self, naming(&array.component_names, array.components)) {
            (Self::Tensors, Naming::Tensor(_)) => 2,
            (Self::Tensors, Naming::Principal) => 0,
            (Self::Tensors, _) if names_eigenvectors(&array.name) => 0,
            // Three numbers without names of a tensor's components are a vector rather than a tensor.
            (Self::Tensors, Naming::Other) if array.components == 3 => 0,
            (Self::Tensors, _)
                if array.components == 3 && (is_vector || names_principal_values(&array.name)) =>
            {
                0
            }
            (Self::Tensors, _) => 1 + u8::from(array.components > 3),
            (Self::Vectors, Naming::Tensor(_) | Naming::Principal) => 0,
            (Self::Vectors | Self::Scalars | Self::Mask, _) => 1,
        }
    }
}
