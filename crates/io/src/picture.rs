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

/// Reads a PNG picture: brightness from 0 to 1, row 0 on top. Pixels are at distance 1 or, where the picture states
/// that they are oblong, as it states: in millimetres, or in widths of a pixel where it has no unit. Transparent pixels
/// hold no data: the opacity is the confidence of the mask. Partly transparent ones show white behind them.
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
    let is_opaque = opacity.iter().all(|alpha| *alpha == 1.0);
    let warnings = orientation(reader.info()).map(unapplied).into_iter().collect();
    let (mut remarks, mut pixel, mut unit) = (transparent(&opacity), [1.0; 2], None);
    if let Some((sides, of)) = oblong(reader.info()) {
        (pixel, unit) = (sides, of);
        let [x, y] = sides;
        remarks.push(match unit {
            Some(unit) => format!("pixels are {x:.4} x {y:.4} {unit}, as the picture states (pHYs)"),
            None => format!("pixels are {y:.4} times as high as wide, as the picture states (pHYs)"),
        });
    }
    if values.len() as u128 != cells {
        return Err(PictureError::Png { problem: "the rows do not fill the picture".to_owned() }.into());
    }
    Ok(Lattice {
        size: [width, height, 1],
        components: 1,
        values,
        scalar: format,
        axes: [[pixel[0], 0.0, 0.0], [0.0, -pixel[1], 0.0], [0.0, 0.0, 1.0]],
        origin: [0.0, (height - 1) as f64 * pixel[1], 0.0],
        unit,
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

/// The message about pixels that are not opaque.
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

/// Width and height of pixels that the picture states to be oblong (its chunk `pHYs`), and their unit.
fn oblong(info: &png::Info) -> Option<([f64; 2], Option<&'static str>)> {
    const MILLIMETRES: f64 = 1000.0;
    let png::PixelDimensions { xppu, yppu, unit } = info.pixel_dims?;
    // Pixels a metre are rounded to whole numbers; ratios of small numbers, such as 1 to 2, are exact.
    let rounding = if unit == png::Unit::Meter { 1 } else { 0 };
    let is_oblong = xppu > 0 && yppu > 0 && xppu.abs_diff(yppu) > rounding;
    let (x, y) = (f64::from(xppu), f64::from(yppu));
    is_oblong.then(|| match unit {
        png::Unit::Meter => ([MILLIMETRES / x, MILLIMETRES / y], Some("mm")),
        png::Unit::Unspecified => ([1.0, x / y], None),
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

    /// A grey picture of 2 x 2 pixels, so many a unit along x and y.
    fn picture(xppu: u32, yppu: u32, unit: png::Unit) -> Lattice {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
        encoder.set_pixel_dims(Some(png::PixelDimensions { xppu, yppu, unit }));
        encoder.write_header().unwrap().write_image_data(&[0; 4]).unwrap();
        read_png(&bytes).unwrap()
    }

    #[test]
    fn pixels_are_as_oblong_as_the_picture_states() {
        let spacing = |lattice: &Lattice| (lattice.spacing()[0], lattice.spacing()[1], lattice.unit);
        for (x, y) in [(3937, 3937), (3937, 3936), (0, 5), (5, 0)] {
            let square = picture(x, y, png::Unit::Meter);
            assert_eq!((spacing(&square), square.remarks.len()), ((1.0, 1.0, None), 0), "{x} {y}");
        }
        let oblong = picture(4000, 2000, png::Unit::Meter);
        assert_eq!((spacing(&oblong), oblong.origin), ((0.25, 0.5, Some("mm")), [0.0, 0.5, 0.0]));
        assert!(oblong.remarks[0].contains("0.2500 x 0.5000 mm"), "{:?}", oblong.remarks);
        let ratio = picture(2, 1, png::Unit::Unspecified);
        assert_eq!(spacing(&ratio), (1.0, 2.0, None));
        assert!(ratio.remarks[0].contains("2.0000 times as high as wide"), "{:?}", ratio.remarks);
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
