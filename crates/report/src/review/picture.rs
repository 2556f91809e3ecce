//! Where two pictures differ, pixel by pixel.

use super::error::ReviewError;

/// Red of the map's largest difference.
const RED: [u8; 3] = [200, 0, 30];

/// Share of red that the smallest difference has, of 255: it must be seen on a page.
const LEAST_RED: u32 = 72;

/// A PNG with its size.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    pub(super) png: Vec<u8>,
    pub(super) size: [u32; 2],
}

/// How two pictures differ.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    /// Size of both together: the larger width and height.
    pub(super) size: [u32; 2],
    pub(super) pixels: u64,
    pub(super) differing: u64,
    /// Largest difference of a channel, of 255.
    pub(super) largest: u8,
    /// Mean over all pixels of the largest difference of a channel, of 1.
    pub(super) mean: f64,
    /// A PNG: the first picture, faded to grey, red where they differ.
    pub(super) map: Vec<u8>,
}

/// A picture of one side.
pub(super) struct Pixels(crate::pixels::Pixels);

impl Pixels {
    /// Decodes a PNG of 8 bits a channel or fewer.
    pub(super) fn decode(file: &str, png: &[u8]) -> Result<Self, ReviewError> {
        let fault = |problem| ReviewError::Picture { file: file.to_owned(), problem };
        crate::pixels::Pixels::decode(png).map(Self).map_err(fault)
    }

    /// Width and height.
    pub(super) const fn size(&self) -> [u32; 2] {
        self.0.size
    }

    pub(super) fn picture(&self, png: Vec<u8>) -> Picture {
        Picture { png, size: self.0.size }
    }

    /// The picture in the upper left corner of a white one of `size`, which must not be smaller.
    pub(super) fn padded(&self, size: [u32; 2]) -> Self {
        let (width, new_width) = (self.0.size[0] as usize, size[0] as usize);
        let mut rgba = vec![[255; 4]; new_width * size[1] as usize];
        for (row, pixels) in
            rgba.chunks_exact_mut(new_width.max(1)).zip(self.0.rgba.chunks_exact(width.max(1)))
        {
            row[..width].copy_from_slice(pixels);
        }
        Self(crate::pixels::Pixels { size, rgba })
    }

    /// As a PNG, on white.
    pub(super) fn encoded(&self) -> Picture {
        let on_white = |[r, g, b, a]: [u8; 4]| {
            [r, g, b].map(|c| (255 - (255 - u32::from(c)) * u32::from(a) / 255) as u8)
        };
        let rgb = self.0.rgba.iter().flat_map(|p| on_white(*p)).collect();
        Picture { png: encode(self.0.size, rgb), size: self.0.size }
    }
}

/// How `head` differs from `base`; where their sizes differ, both stand in the upper left corner of white.
pub(super) fn difference(base: &Pixels, head: &Pixels) -> Difference {
    let size = [0, 1].map(|i| base.0.size[i].max(head.0.size[i]));
    if base.0.size != head.0.size {
        return difference(&base.padded(size), &head.padded(size));
    }
    let of_pixel = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0);
    let differences: Vec<u8> = base.0.rgba.iter().zip(&head.0.rgba).map(of_pixel).collect();
    let largest = differences.iter().copied().max().unwrap_or(0);
    let sum: u64 = differences.iter().map(|d| u64::from(*d)).sum();
    let pixels = differences.len() as u64;
    let map =
        base.0.rgba.iter().zip(&differences).flat_map(|(p, d)| colour(faded(*p), *d, largest)).collect();
    Difference {
        size,
        pixels,
        differing: differences.iter().filter(|d| **d > 0).count() as u64,
        largest,
        mean: sum as f64 / (pixels.max(1) as f64 * 255.0),
        map: encode(base.0.size, map),
    }
}

/// Brightness on white, in the upper quarter of the range.
fn faded([r, g, b, a]: [u8; 4]) -> u8 {
    let brightness = (54 * u32::from(r) + 183 * u32::from(g) + 19 * u32::from(b)) / 256;
    let on_white = 255 - (255 - brightness) * u32::from(a) / 255;
    (191 + on_white / 4) as u8
}

/// The map's pixel: red in proportion to the difference, grey where there is none.
fn colour(grey: u8, difference: u8, largest: u8) -> [u8; 3] {
    if difference == 0 {
        return [grey; 3];
    }
    let red = LEAST_RED + (255 - LEAST_RED) * u32::from(difference) / u32::from(largest.max(1));
    RED.map(|c| ((u32::from(c) * red + u32::from(grey) * (255 - red)) / 255) as u8)
}

/// A PNG of three bytes a pixel.
fn encode([width, height]: [u32; 2], rgb: Vec<u8>) -> Vec<u8> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, width, height);
    encoder.set_color(png::ColorType::Rgb);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&rgb));
    written.expect("memory takes every picture of the size that was just decoded");
    png
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(size: [u32; 2], colour: png::ColorType, data: &[u8]) -> Vec<u8> {
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, size[0], size[1]);
        encoder.set_color(colour);
        encoder.write_header().and_then(|mut w| w.write_image_data(data)).expect("a PNG");
        png
    }

    fn pixels(size: [u32; 2], colour: png::ColorType, data: &[u8]) -> Pixels {
        Pixels::decode("p.png", &picture(size, colour, data)).expect("pixels")
    }

    #[test]
    fn differences_are_counted_and_measured() {
        let base = pixels([2, 2], png::ColorType::Grayscale, &[0, 10, 20, 255]);
        let head = pixels([2, 2], png::ColorType::Grayscale, &[0, 13, 20, 204]);
        let d = difference(&base, &head);
        assert_eq!((d.pixels, d.differing, d.largest), (4, 2, 51));
        assert!((d.mean - 54.0 / 1020.0).abs() < 1e-15);
        let map = Pixels::decode("map", &d.map).expect("a map");
        let reddish = |i: usize| map.0.rgba[i][0] > map.0.rgba[i][1];
        assert_eq!([reddish(0), reddish(1), reddish(2), reddish(3)], [false, true, false, true]);
        assert_eq!(map.0.rgba[3][..3], RED);
    }

    #[test]
    fn colours_in_other_words_are_equal() {
        let grey = pixels([1, 1], png::ColorType::Grayscale, &[7]);
        let rgba = pixels([1, 1], png::ColorType::Rgba, &[7, 7, 7, 255]);
        assert_eq!([difference(&grey, &rgba)].map(|d| (d.differing, d.largest)), [(0, 0)]);
        let clear = pixels([1, 1], png::ColorType::GrayscaleAlpha, &[7, 250]);
        assert_eq!([difference(&grey, &clear)].map(|d| (d.differing, d.largest)), [(1, 5)]);
    }

    #[test]
    fn pictures_of_different_sizes_are_compared_on_white() {
        let [a, b] = [[2, 1], [1, 2]].map(|size| pixels(size, png::ColorType::Grayscale, &[0, 200]));
        let d = difference(&a, &b);
        // The corner is equal, one pixel of each lies on white, and one is white in both.
        assert_eq!((d.size, d.pixels, d.differing, d.largest), ([2, 2], 4, 2, 55));
        let padded = a.padded([2, 2]).encoded();
        let shown = Pixels::decode("p.png", &padded.png).expect("a picture");
        assert_eq!(
            (shown.0.size, shown.0.rgba[1], shown.0.rgba[3]),
            ([2, 2], [200, 200, 200, 255], [255; 4])
        );
        let wider = pixels([3, 1], png::ColorType::Grayscale, &[0, 200, 255]);
        assert_eq!(difference(&a, &wider).differing, 0, "white at the edge is no difference");
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let good = picture([2, 2], png::ColorType::Grayscale, &[1, 2, 3, 4]);
        for end in 0..good.len() - 12 {
            assert!(Pixels::decode("a/b.png", &good[..end]).is_err(), "{end}");
        }
        let error = Pixels::decode("a/b.png", b"text").err().expect("refused").to_string();
        assert!(error.starts_with("a/b.png: "), "{error}");
        // A header of a picture that no memory holds.
        let mut huge = good;
        huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
        assert!(Pixels::decode("a/b.png", &huge).is_err());
    }
}
