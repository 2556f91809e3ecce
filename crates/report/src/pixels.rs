//! The pixels of a PNG.

use crate::limits::MAX_FILE;
use std::io::Cursor;

/// Largest picture, pixels.
const MAX_PIXELS: u64 = 1 << 26;

/// Red, green, blue and opacity of every pixel, row by row.
pub(crate) struct Pixels {
    pub(crate) size: [u32; 2],
    pub(crate) rgba: Vec<[u8; 4]>,
}

impl Pixels {
    /// Decodes a PNG of 8 bits a channel or fewer; or what is wrong with it.
    pub(crate) fn decode(png: &[u8]) -> Result<Self, String> {
        let limits = png::Limits { bytes: MAX_FILE as usize };
        let mut decoder = png::Decoder::new_with_limits(Cursor::new(png), limits);
        // Palettes and bits become bytes.
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
        let size = [reader.info().width, reader.info().height];
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        if pixels > MAX_PIXELS {
            return Err(format!("{pixels} pixels: expected at most {MAX_PIXELS}"));
        }
        if reader.info().interlaced {
            return Err("it is interlaced: expected plain rows".to_owned());
        }
        let (colour, depth) = reader.output_color_type();
        if depth != png::BitDepth::Eight {
            return Err("more than 8 bits a channel: expected 8".to_owned());
        }
        let mut rgba = Vec::new();
        // Row by row, so that memory grows with what is really there.
        while let Some(row) = reader.next_row().map_err(|e| e.to_string())? {
            rgba.extend(row.data().chunks_exact(colour.samples()).map(|p| match *p {
                [grey] => [grey, grey, grey, 255],
                [grey, a] => [grey, grey, grey, a],
                [r, g, b] => [r, g, b, 255],
                [r, g, b, a, ..] => [r, g, b, a],
                [] => [0; 4],
            }));
        }
        if rgba.len() as u64 != pixels {
            return Err("the rows do not fill the picture".to_owned());
        }
        Ok(Self { size, rgba })
    }
}
