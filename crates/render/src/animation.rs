//! Scenes one after the other, as an animated PNG.

use crate::error::RenderError;
use crate::png_export::pixels;
use crate::scene::Scene;

/// How frames follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pace {
    /// How long a frame is seen, milliseconds.
    pub frame_ms: u16,
    /// How long the last one is, before the first comes again.
    pub last_ms: u16,
}

impl Default for Pace {
    fn default() -> Self {
        Self { frame_ms: 120, last_ms: 1600 }
    }
}

/// Most pixels of all frames together: some seconds of work.
pub const MAX_ANIMATED_PIXELS: u64 = 1 << 30;

/// `count` frames as an animated PNG that never ends, on white and as large as the larger of the first and the last.
/// Programs that know no animations show the first. The same frames give the same bytes.
///
/// Behind the first, a frame holds the rectangle that changes only. They are drawn one after the other, so that no more
/// than two are there at a time; the last one once more for its size.
///
/// # Errors
/// As [`Scene::to_png`]; [`RenderError::Frames`] for no frames, or more pixels than [`MAX_ANIMATED_PIXELS`].
pub fn animation(count: usize, frame: impl Fn(usize) -> Scene, pace: Pace) -> Result<Vec<u8>, RenderError> {
    let too_many = |pixels| RenderError::Frames { frames: count, pixels, most: MAX_ANIMATED_PIXELS };
    let Some(end) = count.checked_sub(1) else { return Err(too_many(0.0)) };
    let (first, last) = (frame(0), frame(end));
    let (width_px, height_px) = (first.width_px.max(last.width_px), first.height_px.max(last.height_px));
    let all = width_px * height_px * count as f64;
    if all > MAX_ANIMATED_PIXELS as f64 {
        return Err(too_many(all));
    }
    let frames = u32::try_from(count).unwrap_or(u32::MAX);
    let mut bytes = Vec::new();
    let mut shown = pixels(&first, width_px, height_px)?;
    let [width, height] = shown.size;
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_animated(frames, 0).map_err(fault)?;
    let delay = |i: usize| if i == end { pace.last_ms } else { pace.frame_ms };
    encoder.set_frame_delay(delay(0), 1000).map_err(fault)?;
    let mut writer = encoder.write_header().map_err(fault)?;
    writer.write_image_data(&shown.rgb).map_err(fault)?;
    for i in 1..count {
        let next = pixels(&frame(i), width_px, height_px)?;
        let part = changed(&shown.rgb, &next.rgb, width as usize);
        writer.reset_frame_position().map_err(fault)?;
        writer.set_frame_dimension(part.width as u32, part.height as u32).map_err(fault)?;
        writer.set_frame_position(part.x as u32, part.y as u32).map_err(fault)?;
        writer.set_frame_delay(delay(i), 1000).map_err(fault)?;
        writer.write_image_data(&part.of(&next.rgb, width as usize)).map_err(fault)?;
        shown = next;
    }
    writer.finish().map_err(fault)?;
    Ok(bytes)
}

fn fault(e: png::EncodingError) -> RenderError {
    RenderError::Encoding { reason: e.to_string() }
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
}

impl Part {
    /// Its bytes, out of a picture with `stride` pixels per row.
    fn of(self, rgb: &[u8], stride: usize) -> Vec<u8> {
        let row = |y: usize| &rgb[3 * (y * stride + self.x)..][..3 * self.width];
        (self.y..self.y + self.height).flat_map(row).copied().collect()
    }
}

/// The bounding rectangle of all changes; one pixel if nothing changes.
fn changed(before: &[u8], now: &[u8], stride: usize) -> Part {
    let (mut left, mut right, mut top, mut bottom) = (usize::MAX, 0, usize::MAX, 0);
    let differ = before.chunks(3).zip(now.chunks(3)).enumerate().filter(|(_, (a, b))| a != b);
    for (i, _) in differ {
        let (x, y) = (i % stride, i / stride);
        (left, right) = (left.min(x), right.max(x));
        (top, bottom) = (top.min(y), bottom.max(y));
    }
    if left > right {
        return Part { x: 0, y: 0, width: 1, height: 1 };
    }
    Part { x: left, y: top, width: right + 1 - left, height: bottom + 1 - top }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HeatOptions, heat_map};
    use tigereye_core::{Field, Grid};

    fn frame(step: usize) -> Scene {
        let grid = Grid::new(20, 12).expect("a grid");
        let field = Field::from_fn(grid, |c| f64::from(u8::from(c.x == step && c.y > 3)));
        heat_map(&field, &HeatOptions { range: Some((0.0, 1.0)), ..HeatOptions::default() })
    }

    #[test]
    fn every_frame_comes_back_as_it_was_drawn() {
        let frames: Vec<Scene> = [3, 4, 4, 9].map(frame).to_vec();
        let animated = || animation(frames.len(), |i| frames[i].clone(), Pace { frame_ms: 50, last_ms: 700 });
        let bytes = animated().expect("an animation");
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().expect("a header");
        let control = *reader.info().animation_control().expect("an animation");
        assert_eq!((control.num_frames, control.num_plays), (4, 0));
        let (width, height) = (reader.info().width as usize, reader.info().height as usize);
        let mut canvas = vec![0; 3 * width * height];
        let mut delays = Vec::new();
        for frame in &frames {
            let mut part = vec![0; reader.output_buffer_size().expect("a size")];
            reader.next_frame(&mut part).expect("a frame");
            let control = *reader.info().frame_control().expect("a frame");
            delays.push(control.delay_num);
            let (w, h) = (control.width as usize, control.height as usize);
            for y in 0..h {
                let at = 3 * ((control.y_offset as usize + y) * width + control.x_offset as usize);
                canvas[at..at + 3 * w].copy_from_slice(&part[3 * y * w..3 * (y + 1) * w]);
            }
            let drawn = pixels(frame, width as f64, height as f64).expect("a picture");
            assert!(drawn.rgb == canvas);
        }
        assert_eq!(delays, [50, 50, 50, 700]);
        assert_eq!(bytes, animated().expect("an animation"));
    }

    #[test]
    fn animations_without_end_are_refused() {
        let large = |_| Scene::sized(8000.0, 8000.0);
        let made = |count| animation(count, large, Pace::default());
        assert!(matches!(made(0), Err(RenderError::Frames { frames: 0, .. })));
        assert!(matches!(made(100), Err(RenderError::Frames { frames: 100, .. })));
    }
}
