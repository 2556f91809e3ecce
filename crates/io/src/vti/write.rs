//! From [`ImageData`] to bytes.

use crate::IoError;
use crate::image::ImageData;
use crate::write_error::WriteError;
use crate::xml::{Kind, Writer, spaced};

/// Writes a file: version 1.0, little-endian, 64-bit headers, zlib blocks, appended raw.
///
/// # Errors
/// [`crate::ArrayError::Size`] for an array that does not fill the image, [`WriteError::Unwritable`] for names or texts
/// with control characters, [`crate::ArrayError::Components`] for an array without components,
/// [`WriteError::EmptyImage`].
pub fn write(image: &ImageData) -> Result<Vec<u8>, IoError> {
    let [Some(x), Some(y), Some(z)] = image.dimensions.map(|n| n.checked_sub(1)) else {
        return Err(WriteError::EmptyImage { dimensions: image.dimensions }.into());
    };
    let extent = format!("0 {x} 0 {y} 0 {z}");
    let direction = image.direction.unwrap_or([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let attributes = format!(
        " WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\" Direction=\"{}\"",
        spaced(&image.origin),
        spaced(&image.spacing),
        spaced(&direction)
    );
    let mut writer = Writer::open(Kind::ImageData, &attributes);
    writer.field_data(&image.field_data)?;
    writer.line(format_args!("    <Piece Extent=\"{extent}\">"));
    let points = tuples(image.dimensions);
    writer.arrays("PointData", &image.point_active, &image.point_arrays, points)?;
    writer.arrays("CellData", &image.cell_active, &image.cell_arrays, tuples(image.cell_dimensions()))?;
    Ok(writer.finish())
}

fn tuples(dimensions: [usize; 3]) -> u128 {
    dimensions.iter().fold(1, |n, &d| n.saturating_mul(d as u128))
}
