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
}

impl Wanted {
    pub(super) const fn fits(self, components: usize) -> bool {
        match self {
            Self::Tensors => matches!(components, 9 | 7 | 6 | 4 | 3),
            Self::Vectors => matches!(components, 3 | 2),
            Self::Scalars => components == 1,
        }
    }

    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Tensors => {
                "array of tensors: 9, 7, 6, 4 or 3 components (--array takes a vector or eigenvectors as well)"
            }
            Self::Vectors => "array with 3 or 2 components",
            Self::Scalars => "array with one component",
        }
    }

    pub(super) const fn active(self, names: &ActiveArrays) -> Option<&String> {
        match self {
            Self::Tensors => names.tensors.as_ref(),
            Self::Vectors => names.vectors.as_ref(),
            Self::Scalars => names.scalars.as_ref(),
        }
    }

    /// How well an array suits: 0 not at all, then the better the larger.
    pub(super) fn suits(self, array: &DataArray, active: &ActiveArrays) -> u8 {
        let data = ![VALID_POINTS, GHOSTS].contains(&array.name.as_str());
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
            (Self::Vectors | Self::Scalars, _) => 1,
        }
    }
}
