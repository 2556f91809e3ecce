//! Attributes of points and cells.

use super::cursor::{Cursor, Stored, decoded, fault};
use crate::image::{ActiveArrays, DataArray, FieldEntry, FieldValues, ImageData};
use crate::xml::skipped_words;
use crate::{IoError, ScalarType};

/// Most components of a tuple, and arrays of a FIELD.
const MAX_COMPONENTS: u64 = 1 << 16;

const ATTRIBUTES: &str = "POINT_DATA, CELL_DATA or an attribute such as TENSORS, SCALARS or FIELD";

/// Where attributes go.
struct Target {
    tuples: u64,
    arrays: Vec<DataArray>,
    active: ActiveArrays,
    skipped: Vec<String>,
}

/// Reads attributes up to the end of the file.
pub(super) fn read(cursor: &mut Cursor, image: &mut ImageData) -> Result<(), IoError> {
    let mut target: Option<(bool, Target)> = None;
    while let Some((byte, word)) = cursor.next() {
        let on_points = match word.to_ascii_uppercase().as_slice() {
            b"POINT_DATA" => true,
            b"CELL_DATA" => false,
            _ => {
                let Some((_, target)) = &mut target else { return Err(fault(byte, word, ATTRIBUTES).into()) };
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
            return Err(fault(at, tuples.to_string().as_bytes(), expected).into());
        }
        let target_of =
            Target { tuples, arrays: Vec::new(), active: ActiveArrays::default(), skipped: Vec::new() };
        target = Some((on_points, target_of));
    }
    keep(image, target);
    Ok(())
}

fn keep(image: &mut ImageData, target: Option<(bool, Target)>) {
    match target {
        Some((true, t)) => {
            image.point_arrays.extend(t.arrays);
            image.skipped.extend(t.skipped);
            image.point_active = t.active;
        }
        Some((false, t)) => {
            image.cell_arrays.extend(t.arrays);
            image.skipped.extend(t.skipped);
            image.cell_active = t.active;
        }
        None => {}
    }
}

fn attribute(cursor: &mut Cursor, byte: usize, word: &[u8], target: &mut Target) -> Result<(), IoError> {
    match word.to_ascii_uppercase().as_slice() {
        b"SCALARS" => {
            let name = cursor.name()?;
            let scalar = cursor.element()?;
            let components = if cursor.more_on_line() { components(cursor)? } else { 1 };
            if cursor.peek_is("LOOKUP_TABLE") {
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
            target.push(cursor, name, Stored::Numbers(scalar), components)
        }
        b"LOOKUP_TABLE" => {
            let name = cursor.name()?;
            let colours: u64 = cursor.parse("the size of the table")?;
            let scalar = if cursor.binary() { ScalarType::UInt8 } else { ScalarType::Float32 };
            cursor.numbers(&name, scalar, 4 * u128::from(colours)).map(drop)
        }
        b"TENSORS" | b"TENSORS6" => {
            let name = cursor.name()?;
            let scalar = cursor.element()?;
            target.active.tensors.get_or_insert(name.clone());
            target.push(cursor, name, scalar, if word.len() == b"TENSORS".len() { 9 } else { 6 })
        }
        b"VECTORS" | b"NORMALS" => {
            let name = cursor.name()?;
            let scalar = cursor.element()?;
            target.active.vectors.get_or_insert(name.clone());
            target.push(cursor, name.clone(), scalar, 3)?;
            // Every one of them is a vector, not only the first.
            if let Some(array) = target.arrays.last_mut().filter(|a| a.name == name) {
                array.component_names = ["X", "Y", "Z"].map(str::to_owned).to_vec();
            }
            Ok(())
        }
        b"TEXTURE_COORDINATES" => {
            let name = cursor.name()?;
            let components = components(cursor)?;
            let scalar = cursor.element()?;
            target.push(cursor, name, scalar, components)
        }
        b"GLOBAL_IDS" | b"PEDIGREE_IDS" => {
            let name = cursor.name()?;
            let scalar = cursor.element()?;
            target.push(cursor, name, scalar, 1)
        }
        b"FIELD" => fields(cursor, |cursor, name, tuples, components| {
            let (at, scalar) = (cursor.at(), cursor.element()?);
            if tuples != target.tuples {
                return Err(
                    fault(at, tuples.to_string().as_bytes(), "a tuple for every point or cell").into()
                );
            }
            target.push(cursor, name, scalar, components)?;
            while cursor.peek_is("METADATA") {
                cursor.word("METADATA")?;
                target.metadata(cursor)?;
            }
            Ok(())
        }),
        b"METADATA" => target.metadata(cursor),
        _ => Err(fault(byte, word, ATTRIBUTES).into()),
    }
}

impl Target {
    fn push(
        &mut self,
        cursor: &mut Cursor,
        name: String,
        stored: Stored,
        components: usize,
    ) -> Result<(), IoError> {
        let count = u128::from(self.tuples) * components as u128;
        let scalar = match stored {
            Stored::Numbers(scalar) => scalar,
            Stored::Other(kind) => {
                cursor.skip(&name, kind, count)?;
                self.skipped.push(skipped_words(&name, kind.name()));
                return Ok(());
            }
        };
        let values = cursor.numbers(&name, scalar, count)?;
        self.arrays.push(DataArray { name, components, component_names: Vec::new(), values, scalar });
        Ok(())
    }

    /// What is said about the array before.
    fn metadata(&mut self, cursor: &mut Cursor) -> Result<(), IoError> {
        let components = self.arrays.last().map_or(0, |a| a.components);
        let names = metadata(cursor, components)?;
        if let Some(array) = self.arrays.last_mut().filter(|a| a.components == names.len()) {
            array.component_names = names;
        }
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
        Err(fault(at, n.to_string().as_bytes(), expected).into())
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
        return Err(fault(at, count.to_string().as_bytes(), "at most 65536 arrays").into());
    }
    for _ in 0..count {
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

/// A FIELD of the whole data set. Strings and the like are passed over.
pub(super) fn read_field_data(cursor: &mut Cursor, image: &mut ImageData) -> Result<(), IoError> {
    cursor.word("FIELD")?;
    fields(cursor, |cursor, name, tuples, components| {
        let count = u128::from(tuples) * components as u128;
        match cursor.element()? {
            Stored::Other(kind) => cursor.skip(&name, kind, count)?,
            Stored::Numbers(scalar) => {
                let values = cursor.numbers(&name, scalar, count)?;
                let values = FieldValues::Numbers { components, values, scalar };
                image.field_data.push(FieldEntry { name, values });
            }
        }
        while cursor.peek_is("METADATA") {
            skip_metadata(cursor)?;
        }
        Ok(())
    })
}

/// A METADATA block, the word itself included.
pub(super) fn skip_metadata(cursor: &mut Cursor) -> Result<(), IoError> {
    cursor.word("METADATA")?;
    metadata(cursor, 0).map(drop)
}

/// Lines up to a blank one; the names of as many components, where they are there.
fn metadata(cursor: &mut Cursor, components: usize) -> Result<Vec<String>, IoError> {
    cursor.line()?;
    let mut names = Vec::new();
    loop {
        let line = cursor.line()?.trim_ascii();
        if line.is_empty() {
            return Ok(names);
        }
        if line.eq_ignore_ascii_case(b"COMPONENT_NAMES") {
            // A component without a name is a blank line.
            for _ in 0..components {
                names.push(decoded(cursor.line()?.trim_ascii()));
            }
        }
    }
}
