//! Light transport gradients in image data: x fastest, then row, then direction.
//!
//! On a field that lies somewhere the rows run upwards. Otherwise row 0 is the field's first row and is **not**
//! flipped, as in the published volumes.

use super::arrays::{LTG_ARRAY, LTG_ERROR_ARRAY, PROVENANCE, PUBLISHED_ARRAY, described};
use super::error::ChoiceError;
use super::rows::{self, Rows};
use crate::array_error::ArrayError;
use crate::volume::PlaneGeometry;
use crate::{DataArray, FieldEntry, FieldValues, ImageData, IoError, ScalarType};
use tigereye_core::{Directions, Grid, LtgVolume};

/// Field data entry with the sample indices of the slices, where not all are held.
pub const SLICES: &str = "slices";

/// A light transport gradient as read.
#[derive(Clone, Debug, PartialEq)]
pub struct LtgImage {
    /// Name of the array it was in.
    pub array: String,
    /// The grid of one slice.
    pub grid: Grid,
    /// Sample index of each slice, ascending.
    pub slices: Vec<usize>,
    /// All values, slice by slice, each row-major with the field's first row first, whichever way the file has it.
    pub values: Vec<f64>,
    /// What made the file: JSON text, if it is there.
    pub provenance: Option<String>,
}

impl LtgImage {
    /// The volume; the caller knows how many directions there were in all.
    ///
    /// # Errors
    /// [`ChoiceError::Slices`] for slices beyond `directions`.
    pub fn into_volume(self, directions: Directions) -> Result<LtgVolume, IoError> {
        let limit = directions.count();
        if self.slices.last().is_some_and(|&t| t >= limit) {
            let found = self.slices.iter().rev().take(8).rev().map(|&t| t as f64).collect();
            return Err(ChoiceError::Slices { found, expected: self.slices.len(), limit }.into());
        }
        Ok(LtgVolume::new(self.grid, directions, self.slices, self.values))
    }
}

/// An image of W x H x n points with the one array [`LTG_ARRAY`], and the JSON text in the field data. On a field that
/// lies somewhere the image has its origin, spacing and direction, and rows upwards; the third axis is that of the
/// slices, from the plane in steps of 1 along right x up. The provenance says which way rows run, under [`Rows::KEY`].
#[must_use]
pub fn image_from_ltg(volume: &LtgVolume, geometry: &PlaneGeometry, field_data_json: &str) -> ImageData {
    let (grid, slices) = (volume.grid(), volume.slices());
    let mut image = ImageData::empty([grid.width(), grid.height(), slices.len()]);
    rows::place(&mut image, geometry);
    let values = Rows::of_results(geometry).from_top(volume.values(), [grid.width(), grid.height()], 1);
    image.point_arrays.push(DataArray::new(LTG_ARRAY, 1, values));
    image.point_active.scalars = Some(LTG_ARRAY.to_owned());
    image.push_text(PROVENANCE, field_data_json);
    if slices.len() != volume.directions().count() {
        let values = slices.iter().map(|&t| t as f64).collect();
        let values = FieldValues::Numbers { components: 1, values, scalar: ScalarType::Int64 };
        image.field_data.push(FieldEntry { name: SLICES.to_owned(), values });
    }
    image
}

/// Adds the standard error of each value of a gradient to its image, as the array [`LTG_ERROR_ARRAY`].
pub fn add_ltg_error(image: &mut ImageData, error: &LtgVolume, geometry: &PlaneGeometry) {
    let sides = [error.grid().width(), error.grid().height()];
    let values = Rows::of_results(geometry).from_top(error.values(), sides, 1);
    image.point_arrays.push(DataArray::new(LTG_ERROR_ARRAY, 1, values));
}

/// Takes a volume out of an image: the array `LTG`, or `Energy` as in the published volumes, or the only array of one
/// component. Slices are those of the field data, or 0, 1, 2, ...
///
/// # Errors
/// [`ChoiceError::NoArray`], [`ChoiceError::Ambiguous`], [`ChoiceError::Slices`].
pub fn ltg_from_image(image: &ImageData) -> Result<LtgImage, IoError> {
    let array = scalar_array(image)?;
    let [width, height, layers] = image.dimensions;
    let grid = Grid::new(width, height)?;
    let expected = (grid.cells() as u128) * layers as u128;
    if array.values.len() as u128 != expected {
        let (found, array) = (array.values.len() as u128, array.name.clone());
        return Err(ArrayError::Size { array, byte: 0, found, expected, unit: "numbers" }.into());
    }
    Ok(LtgImage {
        array: array.name.clone(),
        grid,
        slices: slices(image, layers)?,
        values: Rows::of(image, &array.name).from_top(&array.values, [width, height], 1),
        provenance: image.text(PROVENANCE).map(str::to_owned),
    })
}

fn scalar_array(image: &ImageData) -> Result<&DataArray, IoError> {
    let scalars: Vec<&DataArray> = image.point_arrays.iter().filter(|a| a.components == 1).collect();
    for name in [LTG_ARRAY, PUBLISHED_ARRAY] {
        if let Some(&array) = scalars.iter().find(|a| a.name == name) {
            return Ok(array);
        }
    }
    match scalars[..] {
        [array] => Ok(array),
        [] => {
            let wanted = "point array with one component".to_owned();
            Err(ChoiceError::NoArray { wanted, available: described(&image.point_arrays) }.into())
        }
        _ => Err(ChoiceError::Ambiguous { candidates: described(scalars) }.into()),
    }
}

fn slices(image: &ImageData, layers: usize) -> Result<Vec<usize>, ChoiceError> {
    let Some(numbers) = image.numbers(SLICES) else { return Ok((0..layers).collect()) };
    let index = |&n: &f64| (n >= 0.0 && n < Directions::MAX as f64 && n.fract() == 0.0).then_some(n as usize);
    let slices: Option<Vec<usize>> = numbers.iter().map(index).collect();
    slices.filter(|s| s.len() == layers && s.windows(2).all(|w| w[0] < w[1])).ok_or_else(|| {
        ChoiceError::Slices {
            found: numbers.iter().copied().take(8).collect(),
            expected: layers,
            limit: Directions::MAX,
        }
    })
}
