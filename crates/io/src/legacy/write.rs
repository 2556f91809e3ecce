//! From [`ImageData`] to bytes.

use crate::array_error::ArrayError;
use crate::text::shortened;
use crate::volume::points_of_image;
use crate::write_error::WriteError;
use crate::{DataArray, ImageData, IoError, ScalarType};

/// Longest second line of a file, the line feed among it.
const TITLE: usize = 256;

/// Writes a file with the point arrays of an image: the active tensors as TENSORS, everything else as arrays of a
/// FIELD. Field data are left out; `title` has room for 255 bytes.
///
/// # Errors
/// [`WriteError::Unwritable`] for a title or names that the format cannot hold, [`ArrayError::Size`],
/// [`WriteError::EmptyImage`].
pub fn write(image: &ImageData, title: &str) -> Result<Vec<u8>, IoError> {
    if image.dimensions.contains(&0) {
        return Err(WriteError::EmptyImage { dimensions: image.dimensions }.into());
    }
    if title.len() >= TITLE || title.chars().any(char::is_control) {
        return Err(WriteError::Unwritable { name: shortened(title.as_bytes()) }.into());
    }
    let [nx, ny, nz] = image.dimensions;
    let count = nx * ny * nz;
    let mut bytes = Vec::new();
    let line = |bytes: &mut Vec<u8>, text: &str| bytes.extend([text.as_bytes(), b"\n"].concat());
    line(&mut bytes, &format!("# vtk DataFile Version 3.0\n{title}\nBINARY"));
    if image.direction.is_none() {
        line(&mut bytes, &format!("DATASET STRUCTURED_POINTS\nDIMENSIONS {nx} {ny} {nz}"));
        let ([x, y, z], [u, v, w]) = (image.origin, image.spacing);
        line(&mut bytes, &format!("ORIGIN {x:?} {y:?} {z:?}\nSPACING {u:?} {v:?} {w:?}"));
    } else {
        line(
            &mut bytes,
            &format!("DATASET STRUCTURED_GRID\nDIMENSIONS {nx} {ny} {nz}\nPOINTS {count} double"),
        );
        let points: Vec<f64> = points_of_image(image).flatten().collect();
        numbers(&mut bytes, ScalarType::Float64, &points);
    }
    line(&mut bytes, &format!("POINT_DATA {count}"));
    let is_tensor =
        |a: &&DataArray| image.point_active.tensors.as_ref() == Some(&a.name) && a.components == 9;
    let (tensors, others): (Vec<&DataArray>, Vec<_>) = image.point_arrays.iter().partition(is_tensor);
    for array in tensors {
        line(&mut bytes, &format!("TENSORS {} {}", name(array)?, type_name(array.scalar)));
        checked(&mut bytes, array, count)?;
    }
    if !others.is_empty() {
        line(&mut bytes, &format!("FIELD FieldData {}", others.len()));
        for array in others {
            let (name, components) = (name(array)?, array.components);
            line(&mut bytes, &format!("{name} {components} {count} {}", type_name(array.scalar)));
            checked(&mut bytes, array, count)?;
        }
    }
    Ok(bytes)
}

fn checked(bytes: &mut Vec<u8>, array: &DataArray, tuples: usize) -> Result<(), IoError> {
    let (found, expected) = (array.values.len() as u128, tuples as u128 * array.components as u128);
    if found != expected {
        let (array, byte) = (array.name.clone(), bytes.len());
        return Err(ArrayError::Size { array, byte, found, expected, unit: "numbers" }.into());
    }
    numbers(bytes, array.scalar, &array.values);
    Ok(())
}

/// Big-endian numbers and a line feed.
fn numbers(bytes: &mut Vec<u8>, scalar: ScalarType, values: &[f64]) {
    let mut encoded = scalar.encode(values);
    encoded.chunks_exact_mut(scalar.bytes()).for_each(<[u8]>::reverse);
    bytes.extend(encoded);
    bytes.push(b'\n');
}

/// A name without blanks, which would end it.
fn name(array: &DataArray) -> Result<&str, IoError> {
    let unfit = |c: char| c.is_control() || c.is_whitespace();
    if array.name.is_empty() || array.name.contains(unfit) {
        return Err(WriteError::Unwritable { name: shortened(array.name.as_bytes()) }.into());
    }
    Ok(&array.name)
}

const fn type_name(scalar: ScalarType) -> &'static str {
    match scalar {
        ScalarType::Int8 => "char",
        ScalarType::UInt8 => "unsigned_char",
        ScalarType::Int16 => "short",
        ScalarType::UInt16 => "unsigned_short",
        ScalarType::Int32 => "int",
        ScalarType::UInt32 => "unsigned_int",
        ScalarType::Int64 => "vtktypeint64",
        ScalarType::UInt64 => "vtktypeuint64",
        ScalarType::Float32 => "float",
        ScalarType::Float64 => "double",
    }
}
