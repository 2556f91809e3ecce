//! Scenes as PDF: paths and text stay what they are, the font is embedded, rasters are images. No time stamps.

use crate::colour::Rgba;
use crate::error::RenderError;
use crate::font;
use crate::scene::{Item, PagePoint, Path, Raster, Scene, Segment, Stroke, Text};
use flate2::{Compression, write::ZlibEncoder};
use pdf_writer::types::{CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use tigereye_core::math;

impl Scene {
    /// The scene as a PDF of one page without margins. The same scene gives the same bytes.
    ///
    /// # Errors
    /// [`RenderError::PictureSize`] for a side outside 1 to [`Self::MAX_SIDE_PX`]; [`RenderError::Encoding`].
    pub fn to_pdf(&self) -> Result<Vec<u8>, RenderError> {
        let (width_px, height_px, limit_px) = (self.width_px, self.height_px, Self::MAX_SIDE_PX);
        if ![width_px, height_px].iter().all(|side| (1.0..=f64::from(limit_px)).contains(side)) {
            return Err(RenderError::PictureSize { width_px, height_px, limit_px });
        }
        let scale = self.pt_per_px;
        let [width, height] = [width_px, height_px].map(|side| (side * scale) as f32);
        let mut page = Contents {
            content: Content::new(),
            rasters: Vec::new(),
            opacities: BTreeSet::new(),
            glyphs: BTreeMap::new(),
        };
        // From pixels, y down, to points, y up.
        page.content.transform([scale as f32, 0.0, 0.0, -scale as f32, 0.0, height]);
        page.content.set_line_cap(LineCapStyle::RoundCap).set_line_join(LineJoinStyle::RoundJoin);
        page.draw(&self.items);
        let title = if self.title.is_empty() { &self.description } else { &self.title };
        Document { pdf: Pdf::new(), last: 0 }.finish(page, [width, height], title)
    }
}

/// The drawing of a page, and what it refers to.
struct Contents<'a> {
    content: Content,
    /// Images in the order of their names.
    rasters: Vec<&'a Raster>,
    /// Opacities of areas and lines, of 255.
    opacities: BTreeSet<u8>,
    /// Glyphs of the font and the characters that they stand for.
    glyphs: BTreeMap<u16, char>,
}

/// Name of the embedded font among the resources.
const FONT: &[u8] = b"F";
/// A subset has six letters before its name.
const FONT_NAME: &[u8] = b"TIGEYE+DejaVuSans";

impl<'a> Contents<'a> {
    fn draw(&mut self, items: &'a [Item]) {
        for item in items {
            match item {
                Item::Raster(raster) => self.draw_raster(raster),
                Item::Path(path) => self.draw_path(path),
                Item::Text(text) => self.draw_text(text),
                Item::Group { dx_px, dy_px, scale, items } => {
                    let [dx, dy, scale] = [dx_px, dy_px, scale].map(|v| finite(*v));
                    self.content.save_state();
                    self.content.transform([scale, 0.0, 0.0, scale, dx, dy]);
                    self.draw(items);
                    self.content.restore_state();
                }
            }
        }
    }

    fn draw_raster(&mut self, raster: &'a Raster) {
        let rows = raster.rows();
        if rows == 0 {
            return;
        }
        let width = finite(raster.cell_px[0] * raster.columns as f64);
        let height = finite(raster.cell_px[1] * rows as f64);
        let [x, y] = [raster.x_px, raster.y_px].map(finite);
        self.content.save_state();
        // Images stand upright in a system with y up.
        self.content.transform([width, 0.0, 0.0, -height, x, y + height]);
        self.content.x_object(Name(&image_name(self.rasters.len())));
        self.content.restore_state();
        self.rasters.push(raster);
    }

    fn draw_path(&mut self, path: &Path) {
        if path.segments.is_empty() {
            return;
        }
        if let Some(colour) = path.fill {
            self.set_fill(colour);
            self.add(&path.segments);
            self.content.fill_nonzero();
        }
        if let Some(stroke) = &path.stroke {
            self.set_stroke(stroke);
            self.add(&path.segments);
            self.content.stroke();
        }
    }

    fn set_opacity(&mut self, opacity: u8) {
        self.opacities.insert(opacity);
        self.content.set_parameters(Name(&opacity_name(opacity)));
    }

    fn set_fill(&mut self, colour: Rgba) {
        self.set_opacity(colour.a);
        let [r, g, b] = channels(colour);
        self.content.set_fill_rgb(r, g, b);
    }

    fn set_stroke(&mut self, stroke: &Stroke) {
        self.set_opacity(stroke.colour.a);
        let [r, g, b] = channels(stroke.colour);
        self.content.set_stroke_rgb(r, g, b);
        self.content.set_line_width(finite(stroke.width_px));
        self.content.set_dash_pattern(stroke.dash_px.iter().map(|d| finite(*d)), 0.0);
    }

    fn add(&mut self, segments: &[Segment]) {
        let content = &mut self.content;
        let xy = |p: PagePoint| (finite(p.x), finite(p.y));
        let (mut pen, mut start) = (PagePoint::zero(), PagePoint::zero());
        for segment in segments {
            match *segment {
                Segment::Move(p) => {
                    let (x, y) = xy(p);
                    content.move_to(x, y);
                    (pen, start) = (p, p);
                }
                Segment::Line(p) => {
                    let (x, y) = xy(p);
                    content.line_to(x, y);
                    pen = p;
                }
                Segment::Quad(c, p) => {
                    // The same curve with two control points.
                    let ((ax, ay), (bx, by)) = (xy(pen.lerp(c, 2.0 / 3.0)), xy(p.lerp(c, 2.0 / 3.0)));
                    let (x, y) = xy(p);
                    content.cubic_to(ax, ay, bx, by, x, y);
                    pen = p;
                }
                Segment::Cubic(c, d, p) => {
                    let ((ax, ay), (bx, by), (x, y)) = (xy(c), xy(d), xy(p));
                    content.cubic_to(ax, ay, bx, by, x, y);
                    pen = p;
                }
                Segment::Close => {
                    content.close_path();
                    pen = start;
                }
            }
        }
    }

    fn draw_text(&mut self, text: &Text) {
        let glyphs = font::glyphs(&text.text);
        if glyphs.is_empty() {
            return;
        }
        let mut codes = Vec::with_capacity(2 * glyphs.len());
        for (glyph, c) in glyphs {
            self.glyphs.entry(glyph).or_insert(c);
            codes.extend(glyph.to_be_bytes());
        }
        self.set_fill(text.colour);
        let angle = math::radians(text.rotation_deg);
        let (sin, cos, shift) = (math::sin(angle), math::cos(angle), font::anchor_shift(text));
        // Counter-clockwise on a page with y down, and upright letters there.
        let (x, y) = (text.x_px + shift * cos, text.y_px - shift * sin);
        let matrix = [cos, -sin, -sin, -cos, x, y].map(finite);
        self.content.begin_text();
        self.content.set_font(Name(FONT), finite(text.size_px));
        self.content.set_text_matrix(matrix);
        self.content.show(Str(&codes));
        self.content.end_text();
    }
}

fn finite(value: f64) -> f32 {
    if value.is_finite() { value as f32 } else { 0.0 }
}

fn channels(colour: Rgba) -> [f32; 3] {
    [colour.r, colour.g, colour.b].map(|v| f32::from(v) / 255.0)
}

fn image_name(i: usize) -> Vec<u8> {
    format!("I{i}").into_bytes()
}

fn opacity_name(opacity: u8) -> Vec<u8> {
    format!("A{opacity}").into_bytes()
}

/// Gives the objects of a file their numbers, from 1.
struct Document {
    pdf: Pdf,
    last: i32,
}

impl Document {
    fn next(&mut self) -> Ref {
        self.last += 1;
        Ref::new(self.last)
    }

    fn finish(
        mut self,
        page: Contents<'_>,
        [width, height]: [f32; 2],
        title: &str,
    ) -> Result<Vec<u8>, RenderError> {
        let [catalog, pages, page_id, contents, info] = std::array::from_fn(|_| self.next());
        self.pdf.set_version(1, 4);
        self.pdf.catalog(catalog).pages(pages);
        self.pdf.pages(pages).kids([page_id]).count(1);
        self.pdf.document_info(info).title(TextStr(title)).creator(TextStr("tigereye"));
        let images = page.rasters.iter().map(|raster| self.image(raster)).collect::<Result<Vec<_>, _>>()?;
        let font = if page.glyphs.is_empty() { None } else { Some(self.font(&page.glyphs)?) };
        let mut written = self.pdf.page(page_id);
        written.media_box(Rect::new(0.0, 0.0, width, height)).parent(pages).contents(contents);
        let mut resources = written.resources();
        if let Some(font) = font {
            resources.fonts().pair(Name(FONT), font);
        }
        let mut objects = resources.x_objects();
        for (i, image) in images.iter().enumerate() {
            objects.pair(Name(&image_name(i)), *image);
        }
        objects.finish();
        let mut states = resources.ext_g_states();
        for opacity in &page.opacities {
            let share = f32::from(*opacity) / 255.0;
            let mut state = states
                .insert(Name(&opacity_name(*opacity)))
                .start::<pdf_writer::writers::ExtGraphicsState<'_>>();
            state.non_stroking_alpha(share).stroking_alpha(share);
        }
        states.finish();
        resources.finish();
        written.finish();
        let drawing = compressed(&page.content.finish().into_vec())?;
        self.pdf.stream(contents, &drawing).filter(Filter::FlateDecode);
        Ok(self.pdf.finish())
    }

    /// Cells of a raster as pixels, which viewers must not smooth.
    fn image(&mut self, raster: &Raster) -> Result<Ref, RenderError> {
        let (columns, rows) = (raster.columns, raster.rows());
        let side = |cells: usize| i32::try_from(cells).unwrap_or(i32::MAX);
        let cells = &raster.cells[..columns * rows];
        let id = self.next();
        let is_clear = cells.iter().any(|colour| colour.a != 255);
        let mask = is_clear.then(|| self.next());
        let colours: Vec<u8> = cells.iter().flat_map(|colour| [colour.r, colour.g, colour.b]).collect();
        let data = compressed(&colours)?;
        let mut image = self.pdf.image_xobject(id, &data);
        image.filter(Filter::FlateDecode);
        image.width(side(columns)).height(side(rows)).bits_per_component(8).interpolate(false);
        image.color_space().device_rgb();
        if let Some(mask) = mask {
            image.s_mask(mask);
        }
        image.finish();
        if let Some(mask) = mask {
            let opacities: Vec<u8> = cells.iter().map(|colour| colour.a).collect();
            let data = compressed(&opacities)?;
            let mut image = self.pdf.image_xobject(mask, &data);
            image.filter(Filter::FlateDecode);
            image.width(side(columns)).height(side(rows)).bits_per_component(8).interpolate(false);
            image.color_space().device_gray();
        }
        Ok(id)
    }

    /// The embedded font, and how its glyphs become text again.
    fn font(&mut self, glyphs: &BTreeMap<u16, char>) -> Result<Ref, RenderError> {
        let [font, cid_font, descriptor, file, to_unicode] = std::array::from_fn(|_| self.next());
        let system = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
        self.pdf
            .type0_font(font)
            .base_font(Name(FONT_NAME))
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(cid_font)
            .to_unicode(to_unicode);
        // Font units are thousandths of an em here.
        let unit = |v: f64| (1000.0 * v / font::UNITS_PER_EM) as f32;
        let mut cid = self.pdf.cid_font(cid_font);
        cid.subtype(CidFontType::Type2).base_font(Name(FONT_NAME)).system_info(system);
        cid.font_descriptor(descriptor).default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
        let mut widths = cid.widths();
        for glyph in glyphs.keys() {
            widths.same(*glyph, *glyph, unit(font::glyph_width(*glyph)));
        }
        widths.finish();
        cid.finish();
        let [left, bottom, right, top] = font::BOUNDS.map(unit);
        self.pdf
            .font_descriptor(descriptor)
            .name(Name(FONT_NAME))
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(left, bottom, right, top))
            .italic_angle(0.0)
            .ascent(unit(font::ASCENT))
            .descent(unit(font::DESCENT))
            .cap_height((1000.0 * font::CAP_HEIGHT_EM) as f32)
            .stem_v(80.0)
            .font_file2(file);
        let bytes = compressed(font::BYTES)?;
        let length = i32::try_from(font::BYTES.len()).unwrap_or(i32::MAX);
        self.pdf.stream(file, &bytes).filter(Filter::FlateDecode).pair(Name(b"Length1"), length);
        let mut map = UnicodeCmap::new(Name(b"Custom"), system);
        for (glyph, c) in glyphs {
            map.pair(*glyph, *c);
        }
        let map = compressed(&map.finish().into_vec())?;
        self.pdf.stream(to_unicode, &map).filter(Filter::FlateDecode);
        Ok(font)
    }
}

fn compressed(bytes: &[u8]) -> Result<Vec<u8>, RenderError> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.map_err(|e| RenderError::Encoding { reason: e.to_string() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Anchor, PathBuilder};

    fn scene() -> Scene {
        let mut scene = Scene::sized(120.0, 80.0);
        scene.title = "a (title) with ü".to_owned();
        let cells = vec![Rgba::INK, Rgba::MASKED.with_opacity(0.0)];
        scene.items.push(Item::Raster(Raster {
            x_px: 10.0,
            y_px: 5.0,
            cell_px: [4.0; 2],
            columns: 1,
            cells,
        }));
        let mut path = PathBuilder::default();
        path.circle([60.0, 40.0], 10.0);
        path.quad_to(PagePoint::new(1.0, 2.0), PagePoint::new(f64::NAN, 3.0));
        scene.paint(path.finish(), Rgba::LIGHT.with_opacity(0.5), Rgba::INK, 1.0);
        scene.rotated_text([20.0, 70.0], "10⁻³ W", 11.0, Rgba::INK, Anchor::Middle, 90.0);
        scene
    }

    #[test]
    fn files_are_whole_and_always_the_same() {
        let bytes = scene().to_pdf().expect("a PDF");
        assert!(bytes.starts_with(b"%PDF-1.4") && bytes.ends_with(b"%%EOF"));
        assert_eq!(bytes, scene().to_pdf().expect("a PDF"));
        let text = String::from_utf8_lossy(&bytes);
        for part in ["/MediaBox [0 0 90 60]", "/SMask", "/FontFile2", "/ToUnicode", "/Interpolate false"] {
            assert!(text.contains(part), "{part}");
        }
        assert!(!text.contains("Date") && !text.contains("NaN"));
    }

    #[test]
    fn pages_without_an_area_are_refused() {
        assert!(matches!(Scene::sized(0.0, 10.0).to_pdf(), Err(RenderError::PictureSize { .. })));
        assert!(matches!(Scene::sized(10.0, f64::NAN).to_pdf(), Err(RenderError::PictureSize { .. })));
    }
}
