//! From [`PolyData`] to bytes.

use crate::polydata::PolyData;
use crate::xml::{Kind, Writer};
use crate::{DataArray, IoError, ScalarType};

/// Writes a file: version 1.0, little-endian, 64-bit headers, zlib blocks, appended raw.
///
/// # Errors
/// [`crate::ArrayError::Size`] for an array that does not fill the points or cells,
/// [`crate::WriteError::Unwritable`] for names or texts with control characters, [`crate::ArrayError::Components`] for
/// an array without components.
pub fn write(data: &PolyData) -> Result<Vec<u8>, IoError> {
    let points = data.points.len();
    let mut writer = Writer::open(Kind::PolyData, "");
    writer.field_data(&data.field_data)?;
    let counts: String =
        data.sections().iter().map(|(name, cells)| format!(" NumberOf{name}=\"{}\"", cells.len())).collect();
    writer.line(format_args!("    <Piece NumberOfPoints=\"{points}\"{counts}>"));
    writer.arrays("PointData", &data.point_active, &data.point_arrays, points as u128)?;
    writer.arrays("CellData", &data.cell_active, &data.cell_arrays, data.cells() as u128)?;
    writer.line(format_args!("      <Points>"));
    let positions = DataArray::new("Points", 3, data.points.iter().flatten().copied().collect());
    writer.array(&positions, points as u128)?;
    writer.line(format_args!("      </Points>"));
    for (name, cells) in data.sections() {
        writer.line(format_args!("      <{name}>"));
        for (array, indices) in [("connectivity", cells.connectivity()), ("offsets", cells.ends())] {
            let values = indices.iter().map(|&i| i as f64).collect();
            let array = DataArray { scalar: ScalarType::Int64, ..DataArray::new(array, 1, values) };
            writer.array(&array, indices.len() as u128)?;
        }
        writer.line(format_args!("      </{name}>"));
    }
    Ok(writer.finish())
}
