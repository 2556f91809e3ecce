//! Which array of image data is meant.

use super::described;
use crate::image::ActiveArrays;
use crate::{DataArray, ImageData, IoError};

/// Name of the tensor array that is written.
pub const TENSOR_ARRAY: &str = "Tensors";

/// Where the tuples of an array sit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Association {
    /// At the points of the image.
    Points,
    /// In the cells between them.
    Cells,
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
    const fn fits(self, components: usize) -> bool {
        match self {
            Self::Tensors => matches!(components, 9 | 7 | 6 | 4 | 3),
            Self::Vectors => matches!(components, 3 | 2),
            Self::Scalars => components == 1,
        }
    }

    const fn words(self) -> &'static str {
        match self {
            Self::Tensors => "array with 9, 7, 6, 4 or 3 components",
            Self::Vectors => "array with 3 or 2 components",
            Self::Scalars => "array with one component",
        }
    }

    const fn active(self, names: &ActiveArrays) -> Option<&String> {
        match self {
            Self::Tensors => names.tensors.as_ref(),
            Self::Vectors => names.vectors.as_ref(),
            Self::Scalars => names.scalars.as_ref(),
        }
    }
}

/// The named array, or the active one, or the only array whose tuples fit.
pub(crate) fn choose_array<'a>(
    image: &'a ImageData,
    array: Option<&str>,
    wanted: Wanted,
) -> Result<Found<'a>, IoError> {
    match array {
        Some(name) => named(image, name),
        None => only(image, wanted),
    }
}

type Found<'a> = (Association, &'a DataArray);

fn all(image: &ImageData) -> impl Iterator<Item = Found<'_>> {
    let points = image.point_arrays.iter().map(|a| (Association::Points, a));
    points.chain(image.cell_arrays.iter().map(|a| (Association::Cells, a)))
}

fn named<'a>(image: &'a ImageData, name: &str) -> Result<Found<'a>, IoError> {
    all(image).find(|(_, a)| a.name == name).ok_or_else(|| missing(image, &format!("array `{name}`")))
}

fn only(image: &ImageData, wanted: Wanted) -> Result<Found<'_>, IoError> {
    let active = |association| match association {
        Association::Points => &image.point_active,
        Association::Cells => &image.cell_active,
    };
    let is_active =
        |(on, a): &Found| wanted.active(active(*on)) == Some(&a.name) && wanted.fits(a.components);
    if let Some(found) = all(image).find(is_active) {
        return Ok(found);
    }
    for on in [Association::Points, Association::Cells] {
        let fits = |a: &DataArray| {
            let vectors = active(on).vectors.as_ref() == Some(&a.name);
            wanted.fits(a.components) && (wanted != Wanted::Tensors || !vectors)
        };
        let candidates: Vec<Found> = all(image).filter(|&(o, a)| o == on && fits(a)).collect();
        match candidates[..] {
            [] => {}
            [found] => return Ok(found),
            _ => {
                let candidates = described(candidates.iter().map(|f| f.1));
                return Err(IoError::AmbiguousArray { candidates });
            }
        }
    }
    Err(missing(image, wanted.words()))
}

fn missing(image: &ImageData, wanted: &str) -> IoError {
    IoError::NoArray { wanted: wanted.to_owned(), available: described(all(image).map(|f| f.1)) }
}
