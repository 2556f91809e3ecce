//! Scenes as PNG, drawn by tiny-skia.

use crate::colour::Rgba;
use crate::error::RenderError;
use crate::font;
use crate::scene::{Item, PagePoint, Path, Raster, Scene, Segment, Stroke, Text};
use tigereye_core::math;
use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Paint, PathBuilder, Pixmap, PixmapPaint, StrokeDash,
    Transform,
};

impl Scene {
    /// The scene as a PNG of `ceil(width * scale) x ceil(height * scale)` pixels on white. The same scene gives the
    /// same bytes.
    ///
    /// # Errors
    /// [`RenderError::Scale`]; [`RenderError::PictureSize`] for a side outside 1 to [`Self::MAX_SIDE_PX`];
    /// [`RenderError::Encoding`].
    pub fn to_png(&self, scale: f64) -> Result<Vec<u8>, RenderError> {
        encoded(&self.pixmap(scale)?)
    }
}

impl Scene {
    /// The scene as an opaque PNG that states its resolution, `dpi` pixels per inch of the page. The same scene gives
    /// the same bytes.
    ///
    /// # Errors
    /// As [`Self::to_png`].
    pub fn to_png_at(&self, dpi: f64) -> Result<Vec<u8>, RenderError> {
        let scale = dpi / 72.0 * self.pt_per_px;
        let pixmap = self.pixmap(scale)?;
        let rgb: Vec<u8> = pixmap.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
        let failed = |e: png::EncodingError| RenderError::Encoding { reason: e.to_string() };
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, pixmap.width(), pixmap.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let per_metre = (dpi / 0.0254).round() as u32;
        let (xppu, yppu, unit) = (per_metre, per_metre, png::Unit::Meter);
        encoder.set_pixel_dims(Some(png::PixelDimensions { xppu, yppu, unit }));
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&rgb).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(bytes)
    }

    fn pixmap(&self, scale: f64) -> Result<Pixmap, RenderError> {
        if !(scale.is_finite() && scale > 0.0) {
            return Err(RenderError::Scale { scale });
        }
        // The small allowance keeps 100.1 * 10 from becoming 1002 pixels.
        let side = |px: f64| (px * scale - 1e-9).ceil();
        let mut pixmap = checked_pixmap(side(self.width_px), side(self.height_px))?;
        pixmap.fill(Color::WHITE);
        let scale = scale as f32;
        draw_items(&mut pixmap, &self.items, Transform::from_scale(scale, scale))?;
        Ok(pixmap)
    }
}

/// Pixels on white.
#[derive(Debug)]
pub(crate) struct Pixels {
    /// Columns and rows.
    pub(crate) size: [u32; 2],
    /// Red, green and blue, row by row.
    pub(crate) rgb: Vec<u8>,
}

/// A scene at its own size on a page of `width_px` x `height_px`.
pub(crate) fn pixels(scene: &Scene, width_px: f64, height_px: f64) -> Result<Pixels, RenderError> {
    let mut pixmap = checked_pixmap(width_px.ceil(), height_px.ceil())?;
    pixmap.fill(Color::WHITE);
    draw_items(&mut pixmap, &scene.items, Transform::identity())?;
    // The background is white and opaque, so alpha can be dropped.
    let rgb = pixmap.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
    Ok(Pixels { size: [pixmap.width(), pixmap.height()], rgb })
}

/// One pixel per cell.
pub(crate) fn raster_png(raster: &Raster) -> Result<Vec<u8>, RenderError> {
    encoded(&raster_pixmap(raster)?)
}

fn checked_pixmap(width_px: f64, height_px: f64) -> Result<Pixmap, RenderError> {
    let limit_px = Scene::MAX_SIDE_PX;
    let fits = |side: f64| side >= 1.0 && side <= f64::from(limit_px);
    let pixmap = (fits(width_px) && fits(height_px)).then(|| Pixmap::new(width_px as u32, height_px as u32));
    pixmap.flatten().ok_or(RenderError::PictureSize { width_px, height_px, limit_px })
}

fn encoded(pixmap: &Pixmap) -> Result<Vec<u8>, RenderError> {
    pixmap.encode_png().map_err(|e| RenderError::Encoding { reason: e.to_string() })
}

fn raster_pixmap(raster: &Raster) -> Result<Pixmap, RenderError> {
    let mut pixmap = checked_pixmap(raster.columns as f64, raster.rows() as f64)?;
    for (pixel, colour) in pixmap.pixels_mut().iter_mut().zip(&raster.cells) {
        *pixel = tiny_skia::ColorU8::from_rgba(colour.r, colour.g, colour.b, colour.a).premultiply();
    }
    Ok(pixmap)
}

fn draw_items(pixmap: &mut Pixmap, items: &[Item], transform: Transform) -> Result<(), RenderError> {
    for item in items {
        match item {
            Item::Raster(raster) => draw_raster(pixmap, raster, transform)?,
            Item::Path(path) => draw_path(pixmap, path, transform),
            Item::Text(text) => draw_text(pixmap, text, transform),
            Item::Group { dx_px, dy_px, scale, items } => {
                let inner = transform
                    .pre_translate(*dx_px as f32, *dy_px as f32)
                    .pre_scale(*scale as f32, *scale as f32);
                draw_items(pixmap, items, inner)?;
            }
        }
    }
    Ok(())
}

fn draw_raster(pixmap: &mut Pixmap, raster: &Raster, transform: Transform) -> Result<(), RenderError> {
    let cells = raster_pixmap(raster)?;
    let [width, height] = raster.cell_px.map(|side| side as f32);
    let placed = transform.pre_translate(raster.x_px as f32, raster.y_px as f32).pre_scale(width, height);
    let paint = PixmapPaint { quality: FilterQuality::Nearest, ..PixmapPaint::default() };
    pixmap.draw_pixmap(0, 0, cells.as_ref(), &paint, placed, None);
    Ok(())
}

fn draw_path(pixmap: &mut Pixmap, path: &Path, transform: Transform) {
    let Some(shape) = skia_path(&path.segments) else { return };
    if let Some(colour) = path.fill {
        pixmap.fill_path(&shape, &paint(colour), FillRule::Winding, transform, None);
    }
    if let Some(stroke) = &path.stroke {
        pixmap.stroke_path(&shape, &paint(stroke.colour), &skia_stroke(stroke), transform, None);
    }
}

fn draw_text(pixmap: &mut Pixmap, text: &Text, transform: Transform) {
    let Some(shape) = skia_path(&font::outline(&text.text)) else { return };
    let scale = (text.size_px / font::UNITS_PER_EM) as f32;
    let placed = transform
        .pre_translate(text.x_px as f32, text.y_px as f32)
        .pre_concat(rotation(text.rotation_deg))
        .pre_translate(font::anchor_shift(text) as f32, 0.0)
        .pre_scale(scale, -scale);
    pixmap.fill_path(&shape, &paint(text.colour), FillRule::Winding, placed, None);
}

/// A counter-clockwise rotation; that of tiny-skia uses the platform's sine.
fn rotation(degrees: f64) -> Transform {
    let angle = math::radians(degrees);
    let (sin, cos) = (math::sin(angle) as f32, math::cos(angle) as f32);
    Transform::from_row(cos, -sin, sin, cos, 0.0, 0.0)
}

fn paint(colour: Rgba) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour.r, colour.g, colour.b, colour.a);
    paint.anti_alias = true;
    paint
}

fn skia_stroke(stroke: &Stroke) -> tiny_skia::Stroke {
    let dash = (!stroke.dash_px.is_empty())
        .then(|| StrokeDash::new(stroke.dash_px.iter().map(|d| *d as f32).collect(), 0.0))
        .flatten();
    tiny_skia::Stroke {
        width: stroke.width_px as f32,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        dash,
        ..tiny_skia::Stroke::default()
    }
}

fn skia_path(segments: &[Segment]) -> Option<tiny_skia::Path> {
    let mut path = PathBuilder::new();
    let point = |p: PagePoint| (p.x as f32, p.y as f32);
    for segment in segments {
        match *segment {
            Segment::Move(p) => {
                let (x, y) = point(p);
                path.move_to(x, y);
            }
            Segment::Line(p) => {
                let (x, y) = point(p);
                path.line_to(x, y);
            }
            Segment::Quad(c, p) => {
                let ((cx, cy), (x, y)) = (point(c), point(p));
                path.quad_to(cx, cy, x, y);
            }
            Segment::Cubic(c, d, p) => {
                let ((cx, cy), (dx, dy), (x, y)) = (point(c), point(d), point(p));
                path.cubic_to(cx, cy, dx, dy, x, y);
            }
            Segment::Close => path.close(),
        }
    }
    path.finish()
}
