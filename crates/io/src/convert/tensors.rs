//! Tensor fields in image data.

use super::{ComponentOrder, described};
use crate::image::ActiveArrays;
use crate::{DataArray, ImageData, IoError};
use std::fmt;
use tigereye_core::{Cell, Field, Grid, Tensor2};

/// Name of the tensor array that [`image_from_tensors`] writes.
pub const TENSOR_ARRAY: &str = "Tensors";

/// Where the tuples of an array sit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Association {
    /// At the points of the image.
    Points,
    /// In the cells between them.
    Cells,
}

/// A tensor field and what was assumed to get it.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorImage {
    /// The tensors, row 0 on top, in the frame x right, y up.
    pub field: Field<Tensor2>,
    /// Name of the array.
    pub array: String,
    /// Where its tuples sit.
    pub association: Association,
    /// Numbers per tuple.
    pub components: usize,
    /// Which of them were taken.
    pub order: ComponentOrder,
    /// Whether the first row of the file is the bottom row of the field: true unless the y axis is reversed.
    pub rows_flipped: bool,
    /// Whether the first column of the file is the right one of the field: false unless the x axis is reversed.
    pub columns_flipped: bool,
    /// Position of the first point of the file.
    pub origin: [f64; 3],
    /// Distance of the points along each axis.
    pub spacing: [f64; 3],
}

impl fmt::Display for TensorImage {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let kind = if self.association == Association::Points { "point" } else { "cell" };
        write!(f, "{kind} array `{}`: {}; xy plane", self.array, self.order)?;
        write!(
            f,
            "; rows {}",
            if self.rows_flipped { "flipped, file runs upwards" } else { "as in the file" }
        )?;
        if self.columns_flipped { write!(f, "; columns flipped") } else { Ok(()) }
    }
}

/// Takes the tensor field out of an image of one layer.
///
/// `array` names the array; without it the active `Tensors` array is taken, or else the only one with 9, 6, 4 or 3
/// components (that is not the active `Vectors`). Point arrays come before cell arrays. Components are ordered as
/// [`ComponentOrder`] says. VTK's rows run upwards: the row of the largest y becomes row 0, and the tensors, which are
/// in the frame x right, y up, stay as they are.
///
/// # Errors
/// [`IoError::NeedsPlane`], [`IoError::NoArray`], [`IoError::AmbiguousArray`], [`IoError::Components`],
/// [`IoError::RotatedAxes`].
pub fn tensors_from_image(image: &ImageData, array: Option<&str>) -> Result<TensorImage, IoError> {
    let (association, array) = choose_array(image, array, Wanted::Tensors)?;
    let components = array.components;
    let order = ComponentOrder::of(array)
        .ok_or_else(|| IoError::Components { array: array.name.clone(), components })?;
    let dimensions = match association {
        Association::Points => image.dimensions,
        Association::Cells => image.cell_dimensions(),
    };
    let [width, height, depth] = dimensions;
    if image.dimensions[2] != 1 || depth != 1 {
        return Err(IoError::NeedsPlane { dimensions: image.dimensions });
    }
    let (rows_flipped, columns_flipped) = flips(image)?;
    let grid = Grid::new(width, height)?;
    check_size(array, grid)?;
    let field = Field::from_fn(grid, |c| {
        let x = if columns_flipped { width - 1 - c.x } else { c.x };
        let y = if rows_flipped { height - 1 - c.y } else { c.y };
        let i = grid.index(Cell::new(x, y)) * components;
        order.tensor(&array.values[i..i + components])
    });
    Ok(TensorImage {
        field,
        array: array.name.clone(),
        association,
        components,
        order,
        rows_flipped,
        columns_flipped,
        origin: image.origin,
        spacing: image.spacing,
    })
}

/// An image of one layer with the field in the point array [`TENSOR_ARRAY`]: nine named components with zero z row and
/// column, the active tensors. Row 0 of the field becomes the row of the largest y. `origin` is the position of the
/// lower left point.
#[must_use]
pub fn image_from_tensors(field: &Field<Tensor2>, origin: [f64; 2], spacing: [f64; 2]) -> ImageData {
    let grid = field.grid();
    let rows = field.values().chunks(grid.width()).rev();
    let values = rows.flatten().flat_map(|t| {
        let [xx, xy, yx, yy] = t.components();
        [xx, xy, 0.0, yx, yy, 0.0, 0.0, 0.0, 0.0]
    });
    let array = DataArray::new(TENSOR_ARRAY, 9, values.collect())
        .with_component_names(&["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"]);
    let mut image = ImageData::empty([grid.width(), grid.height(), 1]);
    image.origin = [origin[0], origin[1], 0.0];
    image.spacing = [spacing[0], spacing[1], 1.0];
    image.point_active.tensors = Some(TENSOR_ARRAY.to_owned());
    image.point_arrays.push(array);
    image
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

/// Images built by hand may not keep the promise that files are held to.
fn check_size(array: &DataArray, grid: Grid) -> Result<(), IoError> {
    let (found, expected) = (array.values.len() as u128, (grid.cells() * array.components) as u128);
    if found == expected {
        return Ok(());
    }
    Err(IoError::ArraySize { array: array.name.clone(), byte: 0, found, expected, unit: "numbers" })
}

/// Whether rows and columns must be reversed to lead down and right.
fn flips(image: &ImageData) -> Result<(bool, bool), IoError> {
    let d = image.direction.unwrap_or([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let aligned = [1, 2, 3, 5, 6, 7].iter().all(|&i| d[i] == 0.0) && d[0] != 0.0 && d[4] != 0.0;
    if !aligned {
        return Err(IoError::RotatedAxes { direction: d });
    }
    Ok((d[4] * image.spacing[1] >= 0.0, d[0] * image.spacing[0] < 0.0))
}
