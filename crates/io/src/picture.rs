//! Photographs and other pictures as images of one number a pixel.

use crate::volume::{Frame, Known, Lattice, World};
use crate::{IoError, Limits, ScalarType};
use std::io::Cursor;

/// Weights of red, green and blue (ITU-R BT.709), applied to the stored values.
const LUMA: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Columns and rows of a PNG picture, by its header alone.
///
/// # Errors
/// [`IoError::Png`].
pub fn size_of_png(bytes: &[u8]) -> Result<[usize; 2], IoError> {
    let reader = reader(bytes)?;
    Ok([reader.info().width as usize, reader.info().height as usize])
}

fn reader(bytes: &[u8]) -> Result<png::Reader<Cursor<&[u8]>>, IoError> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    // Palettes and bits become bytes, a colour that stands for nothing an alpha channel.
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.read_info().map_err(fault)
}

#[allow(clippy::needless_pass_by_value, reason = "for map_err")]
fn fault(e: png::DecodingError) -> IoError {
    IoError::Png { problem: e.to_string() }
}

fn luma(r: f64, g: f64, b: f64) -> f64 {
    LUMA[0] * r + LUMA[1] * g + LUMA[2] * b
}

fn over_white(brightness: f64, alpha: f64) -> f64 {
    alpha * brightness + (1.0 - alpha)
}

/// Reads a PNG picture: brightness from 0 to 1, row 0 on top, pixels at distance 1. What is transparent shows white
/// behind it.
///
/// # Errors
/// [`IoError::Png`], [`IoError::TooManyCells`].
pub fn read_png(bytes: &[u8]) -> Result<Lattice, IoError> {
    let mut reader = reader(bytes)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let (cells, limit) = (width as u128 * height as u128, Limits::default().cells);
    if cells > u128::from(limit) {
        return Err(IoError::TooManyCells { byte: 16, cells, limit });
    }
    if reader.info().interlaced {
        return Err(IoError::Png { problem: "it is interlaced, expected plain rows".to_owned() });
    }
    let (mut values, mut format) = (Vec::new(), ScalarType::UInt8);
    let (colour, depth) = reader.output_color_type();
    let channels = colour.samples();
    // Row by row, so that memory grows with what is really there.
    while let Some(row) = reader.next_row().map_err(fault)? {
        let samples: Vec<f64> = if depth == png::BitDepth::Sixteen {
            format = ScalarType::UInt16;
            let pairs = row.data().as_chunks::<2>().0.iter();
            pairs.map(|&b| f64::from(u16::from_be_bytes(b)) / 65535.0).collect()
        } else {
            row.data().iter().map(|&b| f64::from(b) / 255.0).collect()
        };
        values.extend(samples.chunks_exact(channels).map(|p| match p {
            [grey, alpha] => over_white(*grey, *alpha),
            [r, g, b] => luma(*r, *g, *b),
            [r, g, b, alpha] => over_white(luma(*r, *g, *b), *alpha),
            _ => p[0],
        }));
    }
    if values.len() as u128 != cells {
        return Err(IoError::Png { problem: "the rows do not fill the picture".to_owned() });
    }
    Ok(Lattice {
        size: [width, height, 1],
        components: 1,
        values,
        scalar: format,
        axes: [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
        origin: [0.0, (height - 1) as f64, 0.0],
        world: World::Absent,
        measurement: None,
        mask: None,
        order: None,
        frame: (Frame::World, Known::Stated),
        array: "brightness".to_owned(),
        component_names: Vec::new(),
        notes: vec!["brightness of a picture, 0 to 1, row 0 on top".to_owned()],
        remarks: Vec::new(),
        order_remarks: Vec::new(),
        warnings: Vec::new(),
    })
}
