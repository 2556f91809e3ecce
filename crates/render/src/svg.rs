//! Scenes as SVG: text as text, rasters as embedded PNG, fixed number formatting, no reference to anything outside.

use crate::colour::Rgba;
use crate::error::RenderError;
use crate::png_export::raster_png;
use crate::scene::{Anchor, Item, PagePoint, Path, Raster, Scene, Segment, Text};
use base64::Engine;
use std::fmt::Write;

impl Scene {
    /// The scene as a self-contained SVG document.
    ///
    /// # Errors
    /// [`RenderError::PictureSize`] or [`RenderError::Encoding`] for an invalid raster layer.
    pub fn to_svg(&self) -> Result<String, RenderError> {
        let mut out = String::new();
        let (w, h) = (number(self.width_px), number(self.height_px));
        // On paper a size has a unit.
        let side = |px: f64| match self.on_paper {
            true => format!("{:.3}mm", px * self.pt_per_px * 25.4 / 72.0),
            false => number(px),
        };
        let _ = writeln!(
            out,
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{}" height="{}" viewBox="0 0 {w} {h}" role="img" font-family="{FONTS}">"#,
            side(self.width_px),
            side(self.height_px)
        );
        let _ = writeln!(out, "<title>{}</title>", escaped(&self.title));
        let _ = writeln!(out, "<desc>{}</desc>", escaped(&self.description));
        let _ = writeln!(out, r##"<rect width="{w}" height="{h}" fill="#ffffff"/>"##);
        write_items(&mut out, &self.items)?;
        out.push_str("</svg>\n");
        Ok(out)
    }
}

/// The font of the layout; Verdana, which systems without it have, is about as wide.
const FONTS: &str = "'DejaVu Sans', Verdana, sans-serif";

fn write_items(out: &mut String, items: &[Item]) -> Result<(), RenderError> {
    for item in items {
        match item {
            Item::Raster(raster) => write_raster(out, raster)?,
            Item::Path(path) => write_path(out, path),
            Item::Text(text) => write_text(out, text),
            Item::Group { dx_px, dy_px, scale, items } => {
                let (x, y) = (number(*dx_px), number(*dy_px));
                let scaling = if *scale == 1.0 { String::new() } else { format!(" scale({scale:.5})") };
                let _ = writeln!(out, r#"<g transform="translate({x} {y}){scaling}">"#);
                write_items(out, items)?;
                out.push_str("</g>\n");
            }
        }
    }
    Ok(())
}

fn write_raster(out: &mut String, raster: &Raster) -> Result<(), RenderError> {
    let data = base64::engine::general_purpose::STANDARD.encode(raster_png(raster)?);
    let (x, y) = (number(raster.x_px), number(raster.y_px));
    let width = number(raster.cell_px[0] * raster.columns as f64);
    let height = number(raster.cell_px[1] * raster.rows() as f64);
    let _ = writeln!(
        out,
        r#"<image x="{x}" y="{y}" width="{width}" height="{height}" preserveAspectRatio="none" image-rendering="optimizeSpeed" style="image-rendering:pixelated" href="data:image/png;base64,{data}"/>"#
    );
    Ok(())
}

fn write_path(out: &mut String, path: &Path) {
    if path.segments.is_empty() {
        return;
    }
    let _ = write!(out, r#"<path d="{}""#, path_data(&path.segments));
    match path.fill {
        Some(colour) => write_paint(out, "fill", colour),
        None => out.push_str(r#" fill="none""#),
    }
    if let Some(stroke) = &path.stroke {
        write_paint(out, "stroke", stroke.colour);
        let _ = write!(
            out,
            r#" stroke-width="{}" stroke-linecap="round" stroke-linejoin="round""#,
            number(stroke.width_px)
        );
        if !stroke.dash_px.is_empty() {
            let dashes: Vec<String> = stroke.dash_px.iter().map(|d| number(*d)).collect();
            let _ = write!(out, r#" stroke-dasharray="{}""#, dashes.join(" "));
        }
    }
    out.push_str("/>\n");
}

fn write_paint(out: &mut String, property: &str, colour: Rgba) {
    let Rgba { r, g, b, a } = colour;
    let _ = write!(out, r##" {property}="#{r:02x}{g:02x}{b:02x}""##);
    if a != 255 {
        let _ = write!(out, r#" {property}-opacity="{}""#, number(f64::from(a) / 255.0));
    }
}

fn write_text(out: &mut String, text: &Text) {
    if text.text.trim().is_empty() {
        return;
    }
    let (x, y) = (number(text.x_px), number(text.y_px));
    let _ = write!(out, r#"<text x="{x}" y="{y}" font-size="{}""#, number(text.size_px));
    match text.anchor {
        Anchor::Start => {}
        Anchor::Middle => out.push_str(r#" text-anchor="middle""#),
        Anchor::End => out.push_str(r#" text-anchor="end""#),
    }
    if text.rotation_deg != 0.0 {
        let _ = write!(out, r#" transform="rotate({} {x} {y})""#, number(-text.rotation_deg));
    }
    write_paint(out, "fill", text.colour);
    let _ = writeln!(out, ">{}</text>", escaped(&text.text));
}

/// Coordinates are kept in parts of a pixel.
const UNIT: f64 = 100.0;

/// Steps with coordinates rounded to hundredths of a pixel. Positions are rounded before differences are taken, so
/// errors do not add up along relative steps.
fn path_data(segments: &[Segment]) -> String {
    let mut out = String::new();
    let mut pen = [0_i64; 2];
    let mut start = pen;
    let rounded =
        |p: PagePoint| p.to_array().map(|v| if v.is_finite() { (v * UNIT).round() as i64 } else { 0 });
    for segment in segments {
        match *segment {
            Segment::Move(p) => {
                pen = rounded(p);
                start = pen;
                write_points(&mut out, 'M', &[pen], [0, 0]);
            }
            Segment::Line(p) => {
                let to = rounded(p);
                write_points(&mut out, 'l', &[to], pen);
                pen = to;
            }
            Segment::Quad(c, p) => {
                let to = rounded(p);
                write_points(&mut out, 'q', &[rounded(c), to], pen);
                pen = to;
            }
            Segment::Cubic(c, d, p) => {
                let to = rounded(p);
                write_points(&mut out, 'c', &[rounded(c), rounded(d), to], pen);
                pen = to;
            }
            Segment::Close => {
                out.push('z');
                pen = start;
            }
        }
    }
    out
}

fn write_points(out: &mut String, letter: char, points: &[[i64; 2]], origin: [i64; 2]) {
    out.push(letter);
    for (i, p) in points.iter().enumerate() {
        for axis in 0..2 {
            let text = number((p[axis] - origin[axis]) as f64 / UNIT);
            if (i > 0 || axis > 0) && !text.starts_with('-') {
                out.push(' ');
            }
            out.push_str(&text);
        }
    }
}

/// At most two decimals, without trailing zeros or a negative zero; 0 for non-finite values.
fn number(value: f64) -> String {
    let value = if value.is_finite() { value } else { 0.0 };
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML 1.0 does not allow control characters, not even escaped.
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
