//! Photographs and other pictures as images of one number a pixel.

mod error;
use crate::limits::LimitError;
use crate::volume::{Frame, Known, Lattice, World};
use crate::{IoError, Limits, ScalarType};
pub use error::PictureError;
use std::io::Cursor;

/// Weights of red, green and blue (ITU-R BT.709), applied to the stored values.
const LUMA: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Columns and rows of a PNG picture, by its header alone.
///
/// # Errors
/// [`PictureError::Png`].
pub fn size_of_png(bytes: &[u8]) -> Result<[usize; 2], IoError> {
    let reader = reader(bytes)?;
    Ok([reader.info().width as usize, reader.info().height as usize])
}

fn reader(bytes: &[u8]) -> Result<png::Reader<Cursor<&[u8]>>, PictureError> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    // Palettes and bits become bytes, a colour that stands for nothing an alpha channel.
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.read_info().map_err(fault)
}

#[allow(clippy::needless_pass_by_value, reason = "for map_err")]
fn fault(e: png::DecodingError) -> PictureError {
    PictureError::Png { problem: e.to_string() }
}

fn luma(r: f64, g: f64, b: f64) -> f64 {
    LUMA[0] * r + LUMA[1] * g + LUMA[2] * b
}

fn over_white(brightness: f64, alpha: f64) -> f64 {
    alpha * brightness + (1.0 - alpha)
}

/// Reads a PNG picture: brightness from 0 to 1, row 0 on top, pixels at distance 1. Transparent pixels hold no data:
/// the opacity is the confidence of the mask. Partly transparent ones show white behind them.
///
/// # Errors
/// [`PictureError::Png`], [`LimitError::Cells`].
pub fn read_png(bytes: &[u8]) -> Result<Lattice, IoError> {
    let mut reader = reader(bytes)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let (cells, limit) = (width as u128 * height as u128, Limits::default().cells);
    if cells > u128::from(limit) {
        return Err(LimitError::Cells { byte: 16, cells, limit }.into());
    }
    if reader.info().interlaced {
        return Err(PictureError::Png { problem: "it is interlaced, expected plain rows".to_owned() }.into());
    }
    let (mut values, mut opacity, mut format) = (Vec::new(), Vec::new(), ScalarType::UInt8);
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
        for pixel in samples.chunks_exact(channels) {
            let (brightness, alpha) = match pixel {
                [grey, alpha] => (*grey, *alpha),
                [r, g, b] => (luma(*r, *g, *b), 1.0),
                [r, g, b, alpha] => (luma(*r, *g, *b), *alpha),
                _ => (pixel[0], 1.0),
            };
            values.push(over_white(brightness, alpha));
            opacity.push(alpha);
        }
    }
    let remarks = transparent(&opacity);
    let is_opaque = opacity.iter().all(|alpha| *alpha == 1.0);
    let warnings =
        orientation(reader.info()).map(unapplied).into_iter().chain(oblong(reader.info())).collect();
    if values.len() as u128 != cells {
        return Err(PictureError::Png { problem: "the rows do not fill the picture".to_owned() }.into());
    }
    Ok(Lattice {
        size: [width, height, 1],
        components: 1,
        values,
        scalar: format,
        axes: [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
        origin: [0.0, (height - 1) as f64, 0.0],
        unit: None,
        world: World::Absent,
        measurement: None,
        mask: (!is_opaque).then_some(opacity),
        order: None,
        frame: (Frame::World, Known::Stated),
        array: "brightness".to_owned(),
        component_names: Vec::new(),
        notes: vec!["brightness of a picture, 0 to 1, row 0 on top".to_owned()],
        remarks,
        order_remarks: Vec::new(),
        warnings,
    })
}

/// What is said of pixels that are not opaque.
fn transparent(opacity: &[f64]) -> Vec<String> {
    let all = opacity.len();
    let clear = opacity.iter().filter(|alpha| **alpha == 0.0).count();
    let partly = opacity.iter().filter(|alpha| **alpha > 0.0 && **alpha < 1.0).count();
    let clear = (clear > 0)
        .then(|| format!("{clear} of {all} pixels are transparent, taken as samples without data"));
    let partly = (partly > 0)
        .then(|| format!("{partly} of {all} pixels are partly transparent, taken as seen in front of white"));
    clear.into_iter().chain(partly).collect()
}

/// Words for an orientation that is not applied: masks and other pictures of the same pixels would no longer fit.
fn unapplied(orientation: u16) -> String {
    format!(
        "the picture's EXIF data turn or mirror it (orientation {orientation}), which is not applied: rows and columns as stored"
    )
}

/// Words for pixels that the picture states to be oblong (its chunk `pHYs`): they are read as squares.
fn oblong(info: &png::Info) -> Option<String> {
    let png::PixelDimensions { xppu, yppu, .. } = info.pixel_dims?;
    (xppu != yppu && xppu > 0 && yppu > 0).then(|| {
        let ratio = f64::from(xppu) / f64::from(yppu);
        format!(
            "the picture states that its pixels are {ratio:.3} times as high as wide (pHYs), which is not applied: \
             directions are right only in a picture resampled to square pixels"
        )
    })
}

/// The orientation in the EXIF data of a picture, where it is another than that of the rows and columns as stored.
fn orientation(info: &png::Info) -> Option<u16> {
    exif_orientation(info.exif_metadata.as_ref()?).filter(|orientation| (2..=8).contains(orientation))
}

/// The tag `Orientation` of the first directory of EXIF data (TIFF 6.0, section 2; EXIF 2.3, section 4.6.4).
fn exif_orientation(exif: &[u8]) -> Option<u16> {
    const TAG: u16 = 0x0112;
    const ENTRY: usize = 12;
    let is_big = match exif.get(..4)? {
        [b'M', b'M', 0, 42] => true,
        [b'I', b'I', 42, 0] => false,
        _ => return None,
    };
    let short = |at: usize| {
        let b = [*exif.get(at)?, *exif.get(at + 1)?];
        Some(if is_big { u16::from_be_bytes(b) } else { u16::from_le_bytes(b) })
    };
    let halves = [short(4)?, short(6)?].map(usize::from);
    let directory = if is_big { halves[0] << 16 | halves[1] } else { halves[1] << 16 | halves[0] };
    let entries = (0..usize::from(short(directory)?)).map(|i| directory + 2 + ENTRY * i);
    // A short stands at the beginning of the entry's value.
    entries
        .map_while(|at| Some((at, short(at)?)))
        .find(|(_, tag)| *tag == TAG)
        .and_then(|(at, _)| short(at + 8))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey pixel with so many pixels a metre along x and y.
    fn pixel(xppu: u32, yppu: u32) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
        encoder.set_pixel_dims(Some(png::PixelDimensions { xppu, yppu, unit: png::Unit::Meter }));
        encoder.write_header().unwrap().write_image_data(&[0; 4]).unwrap();
        bytes
    }

    #[test]
    fn oblong_pixels_are_warned_of() {
        assert_eq!(read_png(&pixel(3937, 3937)).unwrap().warnings, Vec::<String>::new());
        let warnings = read_png(&pixel(3937, 1969)).unwrap().warnings;
        assert!(warnings.len() == 1 && warnings[0].contains("1.999 times as high as wide"), "{warnings:?}");
    }

    #[test]
    fn orientations_are_found_in_both_byte_orders() {
        let little = [
            &b"II\x2a\x00\x08\x00\x00\x00\x02\x00"[..],
            &[0x00, 0x01, 3, 0, 1, 0, 0, 0, 9, 0, 0, 0],
            &[0x12, 0x01, 3, 0, 1, 0, 0, 0, 6, 0, 0, 0],
        ];
        let big = [&b"MM\x00\x2a\x00\x00\x00\x08\x00\x01"[..], &[0x01, 0x12, 0, 3, 0, 0, 0, 1, 0, 8, 0, 0]];
        assert_eq!(exif_orientation(&little.concat()), Some(6));
        assert_eq!(exif_orientation(&big.concat()), Some(8));
        for end in 0..34 {
            let _ = exif_orientation(&little.concat()[..end]);
        }
        assert_eq!(exif_orientation(b"II\x2a\x00\xff\xff\xff\xff"), None);
    }
}
