//! From bytes to [`PolyData`].

use crate::limits::LimitError;
use crate::polydata::{Cells, PolyData};
use crate::xml::{
    ArrayReader, Content, Document, Element, XmlError, data_set, only_piece, read_arrays, read_field_data,
};
use crate::{IoError, Limits};

/// Reads a file with the default [`Limits`].
///
/// # Errors
/// See [`read_with_limits`].
pub fn read(bytes: &[u8]) -> Result<PolyData, IoError> {
    read_with_limits(bytes, Limits::default())
}

/// Reads a file.
///
/// # Errors
/// Anything that is not a complete file of one piece, and cells over points that are not there; names byte, element or
/// array.
pub fn read_with_limits(bytes: &[u8], limits: Limits) -> Result<PolyData, IoError> {
    let document = Document::parse(bytes)?;
    let set = data_set(&document.root, "PolyData", "<PolyData>")?;
    let piece = only_piece(set)?;
    let mut arrays = ArrayReader::new(&document, limits);
    let mut data = PolyData::default();
    for child in &set.children {
        match child.name.as_str() {
            "FieldData" => read_field_data(child, &mut arrays, &mut data.field_data)?,
            "Piece" => read_piece(piece, &mut arrays, &mut data, limits)?,
            _ => return Err(child.unexpected("<FieldData> or <Piece>").into()),
        }
    }
    Ok(data)
}

/// Numbers of points and of cells of each kind.
struct Counts {
    points: u64,
    verts: u64,
    lines: u64,
    strips: u64,
    polys: u64,
}

impl Counts {
    fn of(piece: &Element, limits: Limits) -> Result<Self, IoError> {
        let count = |attribute: &'static str| -> Result<u64, IoError> {
            let Some(text) = piece.attribute(attribute) else { return Ok(0) };
            let number = text.trim().parse::<u64>();
            let number = number.map_err(|_| piece.wrong(attribute, "a count from 0"))?;
            if number > limits.cells {
                let (byte, cells, limit) = (piece.byte, u128::from(number), limits.cells);
                return Err(LimitError::Cells { byte, cells, limit }.into());
            }
            Ok(number)
        };
        Ok(Self {
            points: count("NumberOfPoints")?,
            verts: count("NumberOfVerts")?,
            lines: count("NumberOfLines")?,
            strips: count("NumberOfStrips")?,
            polys: count("NumberOfPolys")?,
        })
    }
}

fn read_piece(
    piece: &Element,
    arrays: &mut ArrayReader,
    data: &mut PolyData,
    limits: Limits,
) -> Result<(), IoError> {
    let counts = Counts::of(piece, limits)?;
    for child in &piece.children {
        match child.name.as_str() {
            "PointData" => {
                (data.point_active, data.point_arrays) =
                    read_arrays(child, arrays, counts.points, &mut data.skipped)?;
            }
            "CellData" => {
                let cells = counts.verts + counts.lines + counts.strips + counts.polys;
                (data.cell_active, data.cell_arrays) = read_arrays(child, arrays, cells, &mut data.skipped)?;
            }
            "Points" => data.points = points(child, arrays, counts.points)?,
            "Verts" => data.verts = cells(child, arrays, counts.verts, counts.points)?,
            "Lines" => data.lines = cells(child, arrays, counts.lines, counts.points)?,
            "Strips" => data.strips = cells(child, arrays, counts.strips, counts.points)?,
            "Polys" => data.polys = cells(child, arrays, counts.polys, counts.points)?,
            _ => {
                let expected = "<PointData>, <CellData>, <Points>, <Verts>, <Lines>, <Strips> or <Polys>";
                return Err(child.unexpected(expected).into());
            }
        }
    }
    if data.points.len() as u64 != counts.points {
        let (byte, parent) = (piece.byte, piece.name.clone());
        return Err(XmlError::MissingElement { byte, parent, element: "Points" }.into());
    }
    Ok(())
}

fn points(section: &Element, arrays: &mut ArrayReader, count: u64) -> Result<Vec<[f64; 3]>, IoError> {
    if count == 0 {
        return Ok(Vec::new());
    }
    let [array] = &section.children[..] else {
        return Err(section.unexpected("one <DataArray> in <Points>").into());
    };
    match arrays.read(array, Some(count))? {
        Content::Numbers { components: 3, values, .. } => Ok(values.as_chunks::<3>().0.to_vec()),
        _ => Err(array.wrong("NumberOfComponents", "3, for points").into()),
    }
}

/// One kind of cells: `offsets` says where each ends in `connectivity`.
fn cells(section: &Element, arrays: &mut ArrayReader, count: u64, points: u64) -> Result<Cells, IoError> {
    let mut cells = Cells::default();
    if count == 0 {
        return Ok(cells);
    }
    let array = |name: &'static str| {
        section.children.iter().find(|c| c.attribute("Name") == Some(name)).ok_or_else(|| {
            let (byte, parent) = (section.byte, section.name.clone());
            XmlError::MissingElement { byte, parent, element: name }
        })
    };
    let (ends, connectivity) = (array("offsets")?, array("connectivity")?);
    let ends_read = indices(arrays, ends, count, u64::MAX)?;
    let total = ends_read.last().copied().unwrap_or_default();
    if !ends_read.is_sorted() {
        return Err(ends.wrong("Name", "offsets in ascending order").into());
    }
    let connectivity = indices(arrays, connectivity, total as u64, points)?;
    let mut start = 0;
    for end in ends_read {
        cells.push(connectivity[start..end].iter().copied());
        start = end;
    }
    Ok(cells)
}

/// Whole numbers from 0, below `limit`.
fn indices(arrays: &mut ArrayReader, array: &Element, count: u64, limit: u64) -> Result<Vec<usize>, IoError> {
    let wrong = || array.wrong("Name", "whole numbers from 0, those of points that are there");
    match arrays.read(array, Some(count))? {
        Content::Numbers { components: 1, values, .. } => {
            let index = |v: f64| (v >= 0.0 && v < limit as f64 && v.fract() == 0.0).then_some(v as usize);
            Ok(values.into_iter().map(index).collect::<Option<_>>().ok_or_else(wrong)?)
        }
        _ => Err(wrong().into()),
    }
}
