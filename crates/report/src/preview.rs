//! Figures as the page shows them: the same pixels in at most 256 colours, which takes less than half of the bytes.

use crate::pixels::Pixels;
use crate::{PanelPlace, PictureSummary};

/// Colours of a palette.
const COLOURS: usize = 256;

/// The panels of a figure as PNGs of at most 256 colours on white, or the whole figure where it names none: unchanged
/// where they have no more colours, and otherwise with colours that are close to their own. The same bytes give the
/// same bytes. None for what is no PNG of 8 bits a channel.
#[must_use]
pub fn previews(png: &[u8], figure: &PictureSummary) -> Option<Vec<Vec<u8>>> {
    let picture = Pixels::decode(png).ok()?;
    if figure.panels.is_empty() {
        return Some(vec![preview(&picture)?]);
    }
    let scale = f64::from(picture.size[0]) / figure.width_px;
    figure.panels.iter().map(|panel| preview(&cut(&picture, panel, scale))).collect()
}

/// The part of a picture that a panel covers.
fn cut(picture: &Pixels, panel: &PanelPlace, scale: f64) -> Pixels {
    // Conversion saturates, so that a wrong place is an empty part at worst.
    let range = |from: f64, length: f64, side: u32| {
        let [start, end] = [from, from + length].map(|px| ((px * scale).round() as u32).min(side));
        (start as usize, end.max(start) as usize)
    };
    let (left, right) = range(panel.x_px, panel.width_px, picture.size[0]);
    let (top, bottom) = range(panel.y_px, panel.height_px, picture.size[1]);
    let rows = picture.rgba.chunks_exact(picture.size[0].max(1) as usize);
    let rgba = rows.skip(top).take(bottom - top).flat_map(|row| &row[left..right]).copied().collect();
    Pixels { size: [(right - left) as u32, (bottom - top) as u32], rgba }
}

fn preview(picture: &Pixels) -> Option<Vec<u8>> {
    let pixels: Vec<u32> = picture.rgba.iter().map(|p| on_white(*p)).collect();
    let palette = Palette::of(counted(&pixels));
    let indices: Vec<u8> = palette.indices(&pixels);
    encoded(picture.size, palette.bytes, &indices)
}

/// Red, green and blue in one number.
fn on_white([r, g, b, a]: [u8; 4]) -> u32 {
    let [r, g, b] = [r, g, b].map(|c| 255 - (255 - u32::from(c)) * u32::from(a) / 255);
    r << 16 | g << 8 | b
}

fn channel(colour: u32, axis: usize) -> u32 {
    colour >> (16 - 8 * axis) & 255
}

/// Every colour with the number of its pixels, ascending.
fn counted(pixels: &[u32]) -> Vec<(u32, u64)> {
    // Neighbours are mostly of one colour.
    let mut runs: Vec<(u32, u64)> = Vec::new();
    for &colour in pixels {
        match runs.last_mut() {
            Some(last) if last.0 == colour => last.1 += 1,
            _ => runs.push((colour, 1)),
        }
    }
    runs.sort_unstable();
    runs.chunk_by(|a, b| a.0 == b.0).map(|same| (same[0].0, same.iter().map(|c| c.1).sum())).collect()
}

struct Palette {
    /// Red, green and blue of every entry.
    bytes: Vec<u8>,
    /// Every colour of the picture, ascending, with the entry that it becomes.
    entries: Vec<(u32, u8)>,
}

impl Palette {
    /// Median cut (Heckbert 1982): the box of colours that is worst represented is cut at its median along its longest
    /// side until there are enough.
    fn of(colours: Vec<(u32, u64)>) -> Self {
        let mut boxes = vec![Box::of(colours)];
        while boxes.len() < COLOURS {
            let worst = boxes.iter().enumerate().filter(|(_, b)| b.colours.len() > 1);
            // The first of several equal ones.
            let Some((i, _)) = worst.max_by_key(|(i, b)| (b.weight, usize::MAX - i)) else { break };
            let (lower, upper) = boxes.swap_remove(i).cut();
            boxes.extend([lower, upper]);
        }
        let mut entries = Vec::new();
        let mut bytes = Vec::new();
        for (i, b) in boxes.iter().enumerate() {
            bytes.extend(b.mean());
            entries.extend(b.colours.iter().map(|(colour, _)| (*colour, i as u8)));
        }
        entries.sort_unstable();
        Self { bytes, entries }
    }

    fn indices(&self, pixels: &[u32]) -> Vec<u8> {
        let mut last = (u32::MAX, 0);
        let index = |colour: &u32| {
            if last.0 != *colour {
                let found = self.entries.binary_search_by_key(colour, |e| e.0).unwrap_or(0);
                last = (*colour, self.entries[found].1);
            }
            last.1
        };
        pixels.iter().map(index).collect()
    }
}

/// Colours that become one.
struct Box {
    colours: Vec<(u32, u64)>,
    /// Side along which it is longest.
    axis: usize,
    /// How badly one colour stands for all.
    weight: u64,
}

impl Box {
    fn of(colours: Vec<(u32, u64)>) -> Self {
        let side = |axis: usize| {
            let values = || colours.iter().map(|(c, _)| channel(*c, axis));
            values().max().unwrap_or(0) - values().min().unwrap_or(0)
        };
        let axis = (0..3).rev().max_by_key(|axis| side(*axis)).unwrap_or(0);
        let longest = u64::from(side(axis));
        // A few pixels of a far colour count as well as many of a near one: letters are few, fills are many.
        let pixels = colours.iter().map(|(_, n)| n.isqrt()).sum::<u64>();
        Self { axis, weight: longest * longest * pixels, colours }
    }

    /// Both halves, neither empty, of at least two colours.
    fn cut(mut self) -> (Self, Self) {
        let axis = self.axis;
        self.colours.sort_unstable_by_key(|(c, _)| (channel(*c, axis), *c));
        let half = self.colours.iter().map(|(_, n)| n.isqrt()).sum::<u64>() / 2;
        let mut before = 0;
        let below = self.colours.iter().take_while(|(_, n)| {
            before += n.isqrt();
            before <= half
        });
        let at = below.count().clamp(1, self.colours.len() - 1);
        let upper = self.colours.split_off(at);
        (Self::of(self.colours), Self::of(upper))
    }

    fn mean(&self) -> [u8; 3] {
        let pixels: u64 = self.colours.iter().map(|(_, n)| n).sum::<u64>().max(1);
        [0, 1, 2].map(|axis| {
            let sum: u64 = self.colours.iter().map(|(c, n)| u64::from(channel(*c, axis)) * n).sum();
            ((sum + pixels / 2) / pixels) as u8
        })
    }
}

fn encoded([width, height]: [u32; 2], palette: Vec<u8>, indices: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(indices)).ok()?;
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(size: [u32; 2], rgb: &[u8]) -> Vec<u8> {
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, size[0], size[1]);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header().and_then(|mut w| w.write_image_data(rgb)).expect("a PNG");
        png
    }

    fn figure(panels: Vec<PanelPlace>) -> PictureSummary {
        let (name, caption, alt) = ("f".to_owned(), String::new(), String::new());
        PictureSummary { name, caption, alt, width_px: 32.0, height_px: 32.0, frames: 0, panels }
    }

    fn preview(png: &[u8]) -> Option<Vec<u8>> {
        previews(png, &figure(Vec::new()))?.pop()
    }

    #[test]
    fn panels_are_cut_out_of_their_figure() {
        let rgb: Vec<u8> = (0..=255_u8).flat_map(|i| [i, i / 2, 255 - i]).collect();
        let png = picture([16, 16], &rgb);
        let panel = |x_px, y_px| PanelPlace { x_px, y_px, width_px: 8.0, height_px: 4.0, alt: String::new() };
        let found = previews(&png, &figure(vec![panel(2.0, 4.0), panel(24.0, 0.0)])).expect("panels");
        let parts: Vec<Pixels> = found.iter().map(|p| Pixels::decode(p).expect("a picture")).collect();
        assert_eq!((parts.len(), parts[0].size, parts[1].size), (2, [4, 2], [4, 2]));
        assert_eq!(previews(&png, &figure(vec![panel(40.0, 40.0)])), None, "outside of the picture");
        let expected: Vec<[u8; 4]> =
            [33, 34, 35, 36, 49, 50, 51, 52].map(|i| [i, i / 2, 255 - i, 255]).into();
        assert_eq!(parts[0].rgba, expected);
    }

    fn rgba(png: &[u8]) -> Vec<[u8; 4]> {
        Pixels::decode(png).expect("a picture").rgba
    }

    #[test]
    fn pictures_of_few_colours_stay_as_they_are() {
        let rgb: Vec<u8> = (0..=255_u8).flat_map(|i| [i, i / 2, 255 - i]).collect();
        let png = picture([16, 16], &rgb);
        let small = preview(&png).expect("a preview");
        assert_eq!(rgba(&small), rgba(&png));
        assert_eq!(preview(&png), preview(&png));
    }

    /// Largest error of a channel over a gradient of 4096 colours, of 255.
    const NEAR: u8 = 24;

    #[test]
    fn pictures_of_many_colours_stay_close() {
        let rgb: Vec<u8> =
            (0..4096_u32).flat_map(|i| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, 128]).collect();
        let png = picture([64, 64], &rgb);
        let small = preview(&png).expect("a preview");
        let colours = counted(&rgba(&small).iter().map(|p| on_white(*p)).collect::<Vec<_>>()).len();
        assert!(colours <= COLOURS, "{colours}");
        for (a, b) in rgba(&png).iter().zip(rgba(&small)) {
            assert!((0..3).all(|i| a[i].abs_diff(b[i]) <= NEAR), "{a:?} {b:?}");
        }
    }

    #[test]
    fn what_is_no_picture_has_no_preview() {
        assert_eq!(preview(b"text"), None);
    }
}
