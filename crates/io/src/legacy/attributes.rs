//! Attributes of points and cells.

use super::cursor::{Cursor, fault};
use crate::image::{ActiveArrays, DataArray, FieldEntry, FieldValues, ImageData};
use crate::{IoError, ScalarType};

/// Most components of a tuple, and arrays of a FIELD.
const MAX_COMPONENTS: u64 = 1 << 16;

const ATTRIBUTES: &str = "POINT_DATA, CELL_DATA or an attribute such as TENSORS, SCALARS or FIELD";

/// Where attributes go.
struct Target {
    tuples: u64,
    arrays: Vec<DataArray>,
    active: ActiveArrays,
}

/// Reads attributes up to the end of the file.
pub(super) fn read(cursor: &mut Cursor, image: &mut ImageData) -> Result<(), IoError> {
    let mut target: Option<(bool, Target)> = None;
    while let Some((byte, word)) = cursor.next() {
        let on_points = match word {
            b"POINT_DATA" => true,
            b"CELL_DATA" => false,
            _ => {
                let Some((_, target)) = &mut target else { return Err(fault(byte, word, ATTRIBUTES)) };
                attribute(cursor, byte, word, target)?;
                continue;
            }
        };
        keep(image, target.take());
        let expected = "the number of points or cells of the DIMENSIONS";
        let at = cursor.at();
        let tuples: u64 = cursor.parse(expected)?;
        let dimensions = if on_points { image.dimensions } else { image.cell_dimensions() };
        if u128::from(tuples) != dimensions.iter().map(|&n| n as u128).product::<u128>() {
            return Err(fault(at, tuples.to_string().as_bytes(), expected));
        }
        let (arrays, active) = (Vec::new(), ActiveArrays::default());
        target = Some((on_points, Target { tuples, arrays, active }));
    }
    keep(image, target);
    Ok(())
}

fn keep(image: &mut ImageData, target: Option<(bool, Target)>) {
    match target {
        Some((true, t)) => {
            image.point_arrays.extend(t.arrays);
            image.point_active = t.active;
        }
        Some((false, t)) => {
            image.cell_arrays.extend(t.arrays);
            image.cell_active = t.active;
        }
        None => {}
    }
}

fn attribute(cursor: &mut Cursor, byte: usize, word: &[u8], target: &mut Target) -> Result<(), IoError> {
    match word {
        b"SCALARS" => {
            let name = cursor.name()?;
            let scalar = cursor.scalar()?;
            let components = if cursor.more_on_line() { components(cursor)? } else { 1 };
            if cursor.peek() == Some(b"LOOKUP_TABLE") {
                cursor.word("LOOKUP_TABLE")?;
                cursor.word("the name of a table")?;
            }
            target.active.scalars.get_or_insert(name.clone());
            target.push(cursor, name, scalar, components)
        }
        b"COLOR_SCALARS" => {
            let name = cursor.name()?;
            let components = components(cursor)?;
            let scalar = if cursor.binary() { ScalarType::UInt8 } else { ScalarType::Float32 };
            target.push(cursor, name, scalar, components)
        }
        b"LOOKUP_TABLE" => {
            let name = cursor.name()?;
            let colours: u64 = cursor.parse("the size of the table")?;
            let scalar = if cursor.binary() { ScalarType::UInt8 } else { ScalarType::Float32 };
            cursor.numbers(&name, scalar, 4 * u128::from(colours)).map(drop)
        }
        b"TENSORS" | b"TENSORS6" => {
            let name = cursor.name()?;
            let scalar = cursor.scalar()?;
            target.active.tensors.get_or_insert(name.clone());
            target.push(cursor, name, scalar, if word == b"TENSORS" { 9 } else { 6 })
        }
        b"VECTORS" | b"NORMALS" => {
            let name = cursor.name()?;
            let scalar = cursor.scalar()?;
            target.active.vectors.get_or_insert(name.clone());
            target.push(cursor, name, scalar, 3)
        }
        b"TEXTURE_COORDINATES" => {
            let name = cursor.name()?;
            let components = components(cursor)?;
            let scalar = cursor.scalar()?;
            target.push(cursor, name, scalar, components)
        }
        b"GLOBAL_IDS" | b"PEDIGREE_IDS" => {
            let name = cursor.name()?;
            let scalar = cursor.scalar()?;
            target.push(cursor, name, scalar, 1)
        }
        b"FIELD" => fields(cursor, |cursor, name, tuples, components| {
            let (at, scalar) = (cursor.at(), cursor.scalar()?);
            if tuples != target.tuples {
                return Err(fault(at, tuples.to_string().as_bytes(), "a tuple for every point or cell"));
            }
            target.push(cursor, name, scalar, components)
        }),
        b"METADATA" => metadata(cursor),
        _ => Err(fault(byte, word, ATTRIBUTES)),
    }
}

impl Target {
    fn push(
        &mut self,
        cursor: &mut Cursor,
        name: String,
        scalar: ScalarType,
        components: usize,
    ) -> Result<(), IoError> {
        let count = u128::from(self.tuples) * components as u128;
        let values = cursor.numbers(&name, scalar, count)?;
        self.arrays.push(DataArray { name, components, component_names: Vec::new(), values, scalar });
        Ok(())
    }
}

fn components(cursor: &mut Cursor) -> Result<usize, IoError> {
    let expected = "a number of components from 1 to 65536";
    let at = cursor.at();
    let n: u64 = cursor.parse(expected)?;
    if (1..=MAX_COMPONENTS).contains(&n) {
        Ok(n as usize)
    } else {
        Err(fault(at, n.to_string().as_bytes(), expected))
    }
}

/// The arrays behind the word FIELD: name, components, tuples; type and numbers are left to `array`.
fn fields(
    cursor: &mut Cursor,
    mut array: impl FnMut(&mut Cursor, String, u64, usize) -> Result<(), IoError>,
) -> Result<(), IoError> {
    cursor.name()?;
    let at = cursor.at();
    let count: u64 = cursor.parse("the number of arrays")?;
    if count > MAX_COMPONENTS {
        return Err(fault(at, count.to_string().as_bytes(), "at most 65536 arrays"));
    }
    for _ in 0..count {
        while cursor.peek() == Some(b"METADATA") {
            skip_metadata(cursor)?;
        }
        let name = cursor.name()?;
        // VTK's word for an array that is not there.
        if name == "NULL_ARRAY" {
            continue;
        }
        let components = components(cursor)?;
        let tuples = cursor.parse("the number of tuples")?;
        array(cursor, name, tuples, components)?;
    }
    Ok(())
}

/// A FIELD of the whole data set.
pub(super) fn read_field_data(cursor: &mut Cursor, image: &mut ImageData) -> Result<(), IoError> {
    cursor.word("FIELD")?;
    fields(cursor, |cursor, name, tuples, components| {
        let scalar = cursor.scalar()?;
        let values = cursor.numbers(&name, scalar, u128::from(tuples) * components as u128)?;
        image
            .field_data
            .push(FieldEntry { name, values: FieldValues::Numbers { components, values, scalar } });
        Ok(())
    })
}

/// A METADATA block, the word itself included.
pub(super) fn skip_metadata(cursor: &mut Cursor) -> Result<(), IoError> {
    cursor.word("METADATA")?;
    metadata(cursor)
}

/// Lines up to a blank one.
fn metadata(cursor: &mut Cursor) -> Result<(), IoError> {
    cursor.line()?;
    while !cursor.line()?.trim_ascii().is_empty() {}
    Ok(())
}
