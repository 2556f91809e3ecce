//! From bytes to [`ImageData`].

use crate::image::ImageData;
use crate::limits::LimitError;
use crate::xml::{ArrayReader, Document, Element, data_set, only_piece, read_arrays, read_field_data};
use crate::{IoError, Limits};

/// Reads a file with the default [`Limits`].
///
/// # Errors
/// See [`read_with_limits`].
pub fn read(bytes: &[u8]) -> Result<ImageData, IoError> {
    read_with_limits(bytes, Limits::default())
}

/// Reads a file. The origin returned is the position of the first point, also where the extent does not start at 0.
///
/// # Errors
/// Anything that is not a complete file of one piece; names byte, element or array.
pub fn read_with_limits(bytes: &[u8], limits: Limits) -> Result<ImageData, IoError> {
    let document = Document::parse(bytes)?;
    let image = data_set(&document.root, "ImageData", "<ImageData>")?;
    let piece = only_piece(image)?;
    let mut data = geometry(image, piece, limits)?;
    let mut arrays = ArrayReader::new(&document, limits);
    for child in &image.children {
        match child.name.as_str() {
            "FieldData" => read_field_data(child, &mut arrays, &mut data.field_data)?,
            "Piece" => read_piece(child, &mut arrays, &mut data)?,
            _ => return Err(child.unexpected("<FieldData> or <Piece>").into()),
        }
    }
    Ok(data)
}

/// An image without arrays yet.
fn geometry(image: &Element, piece: &Element, limits: Limits) -> Result<ImageData, IoError> {
    let extent = extent(image, "WholeExtent")?;
    if self::extent(piece, "Extent")? != extent {
        return Err(piece.wrong("Extent", "the WholeExtent").into());
    }
    let axis = |i: usize| u64::try_from(i128::from(extent[2 * i + 1]) - i128::from(extent[2 * i]) + 1).ok();
    let (Some(nx @ 1..), Some(ny @ 1..), Some(nz @ 1..)) = (axis(0), axis(1), axis(2)) else {
        return Err(image.wrong("WholeExtent", "at least one point along each axis").into());
    };
    let points = (u128::from(nx) * u128::from(ny)).saturating_mul(u128::from(nz));
    if points > u128::from(limits.cells) {
        return Err(LimitError::Cells { byte: image.byte, cells: points, limit: limits.cells }.into());
    }
    let origin = numbers(image, "Origin", "three finite numbers")?.unwrap_or([0.0; 3]);
    let spacing = numbers(image, "Spacing", "three finite numbers")?.unwrap_or([1.0; 3]);
    let direction = numbers(image, "Direction", "nine finite numbers")?;
    let start = [extent[0], extent[2], extent[4]];
    Ok(ImageData {
        origin: first_point(origin, spacing, direction, start),
        spacing,
        direction,
        ..ImageData::empty([nx as usize, ny as usize, nz as usize])
    })
}

fn first_point(
    origin: [f64; 3],
    spacing: [f64; 3],
    direction: Option<[f64; 9]>,
    start: [i64; 3],
) -> [f64; 3] {
    let step = [0, 1, 2].map(|i| if start[i] == 0 { 0.0 } else { spacing[i] * start[i] as f64 });
    let d = direction.unwrap_or([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    [0, 1, 2].map(|i| origin[i] + d[3 * i] * step[0] + d[3 * i + 1] * step[1] + d[3 * i + 2] * step[2])
}

fn extent(element: &Element, attribute: &'static str) -> Result<[i64; 6], IoError> {
    const EXPECTED: &str = "six integers x0 x1 y0 y1 z0 z1";
    let words = element.required(attribute, EXPECTED)?.split_ascii_whitespace().take(7);
    let numbers: Option<Vec<i64>> = words.map(|w| w.parse().ok()).collect();
    let exact = numbers.and_then(|n| <[i64; 6]>::try_from(n).ok());
    Ok(exact.ok_or_else(|| element.wrong(attribute, EXPECTED))?)
}

fn numbers<const N: usize>(
    element: &Element,
    attribute: &'static str,
    expected: &'static str,
) -> Result<Option<[f64; N]>, IoError> {
    let Some(text) = element.attribute(attribute) else { return Ok(None) };
    let words = text.split_ascii_whitespace().take(N + 1);
    let numbers: Option<Vec<f64>> = words.map(|w| w.parse().ok().filter(|v: &f64| v.is_finite())).collect();
    let exact = numbers.and_then(|n| <[f64; N]>::try_from(n).ok());
    Ok(exact.map(Some).ok_or_else(|| element.wrong(attribute, expected))?)
}

fn read_piece(piece: &Element, arrays: &mut ArrayReader, data: &mut ImageData) -> Result<(), IoError> {
    for child in &piece.children {
        match child.name.as_str() {
            "PointData" => {
                let points = tuples(data.dimensions);
                (data.point_active, data.point_arrays) =
                    read_arrays(child, arrays, points, &mut data.skipped)?;
            }
            "CellData" => {
                let cells = tuples(data.cell_dimensions());
                (data.cell_active, data.cell_arrays) = read_arrays(child, arrays, cells, &mut data.skipped)?;
            }
            _ => return Err(child.unexpected("<PointData> or <CellData>").into()),
        }
    }
    Ok(())
}

/// Points or cells; the limit on cells was checked, so nothing overflows.
fn tuples(dimensions: [usize; 3]) -> u64 {
    dimensions.iter().map(|&n| n as u64).product()
}
