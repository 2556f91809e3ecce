//! The points of a legacy data set, as a lattice.

use super::cursor::{Cursor, fault};
use crate::limits::LimitError;
use crate::points::{PointLattice, TOLERANCE};
use crate::volume::VolumeError;
use crate::{ImageData, IoError};

const SETS: &str = "DATASET STRUCTURED_POINTS, STRUCTURED_GRID or RECTILINEAR_GRID";

/// Reads everything before the attributes.
pub(super) fn read(cursor: &mut Cursor) -> Result<ImageData, IoError> {
    let (byte, word) = cursor.word(SETS)?;
    if !word.eq_ignore_ascii_case(b"DATASET") {
        return Err(fault(byte, word, SETS).into());
    }
    let (byte, word) = cursor.word(SETS)?;
    let kind = word.to_ascii_uppercase();
    let kind = kind.as_slice();
    let mut image = match kind {
        b"STRUCTURED_POINTS" => ImageData::empty([1; 3]),
        b"STRUCTURED_GRID" | b"RECTILINEAR_GRID" => ImageData::empty([1; 3]),
        _ => return Err(fault(byte, word, SETS).into()),
    };
    let mut sized = false;
    let mut placed = kind == b"STRUCTURED_POINTS";
    while let Some(word) = cursor.peek() {
        match word.to_ascii_uppercase().as_slice() {
            b"FIELD" => super::attributes::read_field_data(cursor, &mut image)?,
            b"DIMENSIONS" => {
                image.dimensions = dimensions(cursor)?;
                sized = true;
            }
            b"SPACING" | b"ASPECT_RATIO" => image.spacing = triple(cursor)?,
            b"ORIGIN" => image.origin = triple(cursor)?,
            b"POINTS" if sized && kind == b"STRUCTURED_GRID" => {
                points(cursor, &mut image)?;
                placed = true;
            }
            b"X_COORDINATES" if sized && kind == b"RECTILINEAR_GRID" => {
                (0..3).try_for_each(|axis| coordinates(cursor, axis, &mut image))?;
                placed = true;
            }
            b"METADATA" => super::attributes::skip_metadata(cursor)?,
            _ => break,
        }
    }
    let expected = if sized { "the points" } else { "DIMENSIONS" };
    if sized && placed {
        return Ok(image);
    }
    let (byte, word) = cursor.word(expected)?;
    Err(fault(byte, word, expected).into())
}

fn dimensions(cursor: &mut Cursor) -> Result<[usize; 3], IoError> {
    let expected = "three positive integers";
    let (byte, _) = cursor.word(expected)?;
    let mut n = [0_u64; 3];
    for axis in &mut n {
        let at = cursor.at();
        *axis = cursor.parse(expected)?;
        if *axis == 0 {
            return Err(fault(at, b"0", expected).into());
        }
    }
    let cells = n.iter().fold(1_u128, |p, &d| p.saturating_mul(u128::from(d)));
    let limit = cursor.limits().cells;
    if cells > u128::from(limit) {
        return Err(LimitError::Cells { byte, cells, limit }.into());
    }
    Ok(n.map(|d| d as usize))
}

fn triple(cursor: &mut Cursor) -> Result<[f64; 3], IoError> {
    let expected = "three finite numbers";
    cursor.word(expected)?;
    Ok([cursor.finite(expected)?, cursor.finite(expected)?, cursor.finite(expected)?])
}

/// Explicit points, which must be those of a lattice, possibly turned.
fn points(cursor: &mut Cursor, image: &mut ImageData) -> Result<(), IoError> {
    cursor.word("POINTS")?;
    let at = cursor.at();
    let count: u64 = cursor.parse("the number of points")?;
    let [nx, ny, nz] = image.dimensions;
    if u128::from(count) != nx as u128 * ny as u128 * nz as u128 {
        return Err(
            fault(at, count.to_string().as_bytes(), "as many points as the DIMENSIONS declare").into()
        );
    }
    let scalar = cursor.scalar()?;
    let values = cursor.numbers("POINTS", scalar, 3 * u128::from(count))?;
    let points = values.as_chunks::<3>().0;
    let lattice = PointLattice::of(points, image.dimensions);
    lattice.map_err(|point| VolumeError::NoLattice { point })?.place(image);
    Ok(())
}

/// Coordinates along one axis of a rectilinear grid, which must be equally spaced.
fn coordinates(cursor: &mut Cursor, axis: usize, image: &mut ImageData) -> Result<(), IoError> {
    const NAMES: [&str; 3] = ["X_COORDINATES", "Y_COORDINATES", "Z_COORDINATES"];
    let (byte, word) = cursor.word(NAMES[axis])?;
    if !word.eq_ignore_ascii_case(NAMES[axis].as_bytes()) {
        return Err(fault(byte, word, NAMES[axis]).into());
    }
    let at = cursor.at();
    let count: usize = cursor.parse("the number of coordinates")?;
    if count != image.dimensions[axis] {
        return Err(
            fault(at, count.to_string().as_bytes(), "as many coordinates as the DIMENSIONS declare").into()
        );
    }
    let scalar = cursor.scalar()?;
    let values = cursor.numbers(NAMES[axis], scalar, count as u128)?;
    let (first, last) = (values[0], values[count - 1]);
    let step = if count > 1 { (last - first) / (count - 1) as f64 } else { 1.0 };
    let off = |(i, v): (usize, &f64)| {
        let near = (v - first - i as f64 * step).abs() <= TOLERANCE * step.abs();
        (!near || step == 0.0).then_some(i)
    };
    if let Some(point) = values.iter().enumerate().find_map(off).filter(|_| count > 1) {
        return Err(VolumeError::NoLattice { point }.into());
    }
    (image.origin[axis], image.spacing[axis]) = (first, step);
    Ok(())
}
