//! Tensor fields as ellipses.

use crate::axis::Axis;
use crate::colour::{ColourMap, Rgba};
use crate::colour_bar::ColourBar;
use crate::legend::{Entry, Mark};
use crate::map_frame::{self, MapFrame};
use crate::overlay::{self, Overlay};
use crate::scene::{PathBuilder, Scene};
use crate::shapes::Marker;
use tigereye_core::{Anisotropy, AxisSign, Eigenvalues, Field, Svd, Tensor2, is_totally_anisotropic};

/// How glyphs are scaled against each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlyphScale {
    /// The largest singular value of the field fills a cell: sizes are comparable.
    #[default]
    Field,
    /// Half-axes by the square root of the singular values, the largest filling a cell: fields with peaks stay legible.
    SquareRoot,
    /// Every glyph fills its cell: only shape and direction are shown.
    Glyph,
}

/// What the colour of glyphs means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlyphColour {
    /// Tension, compression or both, by the real parts of the eigenvalues.
    #[default]
    AxisSign,
    /// Linear anisotropy `(s1 - s2) / (s1 + s2)`.
    Anisotropy,
}

/// Options of [`glyphs`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GlyphOptions {
    /// Title; empty for none.
    pub title: String,
    /// Scaling.
    pub scale: GlyphScale,
    /// Meaning of colours.
    pub colour: GlyphColour,
    /// Draws every n-th cell; by default as many as stay readable.
    pub every: Option<usize>,
    /// Pixels per cell; by default whole, such that the longer side has about 640.
    pub cell_px: Option<usize>,
    /// Points and lines over the glyphs, such as tensor lines.
    pub overlays: Vec<Overlay>,
}

/// Glyphs of 12 pixels are the smallest whose axes can be told apart.
const PITCH_PX: f64 = 12.0;
const ANISOTROPY_STEPS: usize = 16;
const TENSION: Rgba = Rgba::hex(0xd55e00);
const COMPRESSION: Rgba = Rgba::hex(0x0072b2);
const MIXED: Rgba = Rgba::hex(0x8a7a9b);

/// Each tensor as the ellipse it makes of the unit circle, with its major axis as a thin line. Totally anisotropic
/// tensors are segments, zero tensors small hollow dots, tensors that are not finite small crosses.
#[must_use]
pub fn glyphs(field: &Field<Tensor2>, options: &GlyphOptions) -> Scene {
    let grid = field.grid();
    let cell = map_frame::cell_px(grid, options.cell_px, 640, 48);
    let every = options.every.unwrap_or_else(|| map_frame::stride(cell, PITCH_PX)).max(1);
    let bar = (options.colour == GlyphColour::Anisotropy).then(|| ColourBar {
        axis: Axis::linear(0.0, 1.0),
        map: ColourMap::Batlow,
        label: "linear anisotropy (s₁ − s₂) / (s₁ + s₂)",
        below: false,
        above: false,
    });
    let side = bar.as_ref().map_or(0.0, |b| b.width(200.0));
    let mut page = MapFrame::begin(grid, &options.title, cell, side);
    page.grid_lines(every, Rgba::hex(0xececec));
    let largest =
        field.values().iter().map(|t| Svd::of(t).s[0]).filter(|s| s.is_finite()).fold(0.0, f64::max);
    let scaling = Scaling { kind: options.scale, largest, radius: 0.45 * cell * every as f64 };
    let mut layers = Layers::default();
    for cell in map_frame::sampled_cells(grid, every) {
        layers.add(page.centre(cell), field.at(cell), &scaling, options.colour);
    }
    let mut legend = layers.draw(&mut page.scene);
    overlay::draw(&mut page, &options.overlays, &mut legend);
    legend.extend(remarks(options.scale, every, largest));
    if let Some(bar) = bar {
        let (edge, top, height) = (page.left + page.width(), page.top, page.side_height());
        bar.draw(&mut page.scene, edge, top, height);
    }
    let description = format!(
        "Ellipse glyphs of a tensor field of {} x {} cells, row 0 on top, one glyph per {every} x {every} cells.",
        grid.width(),
        grid.height()
    );
    page.finish(&options.title, description, &legend)
}

fn remarks(scale: GlyphScale, every: usize, largest: f64) -> Vec<Entry> {
    let mut remarks = Vec::new();
    match scale {
        _ if largest == 0.0 => remarks.push(Entry::of(Mark::None, "every tensor is zero or not finite")),
        GlyphScale::Field => {}
        GlyphScale::SquareRoot => remarks.push(Entry::of(Mark::None, "half-axes ∝ √s")),
        GlyphScale::Glyph => remarks.push(Entry::of(Mark::None, "each glyph scaled to its cell")),
    }
    if every > 1 {
        remarks.push(Entry::of(Mark::None, format!("one glyph per {every} × {every} cells")));
    }
    remarks
}

struct Scaling {
    kind: GlyphScale,
    largest: f64,
    radius: f64,
}

impl Scaling {
    /// Half-axes in pixels.
    fn axes(&self, svd: &Svd) -> [f64; 2] {
        let unit = if self.kind == GlyphScale::Glyph { svd.s[0] } else { self.largest };
        svd.s.map(|s| {
            let share = if unit > 0.0 { s / unit } else { 0.0 };
            self.radius * if self.kind == GlyphScale::SquareRoot { share.sqrt() } else { share }
        })
    }
}

/// A circle has none.
fn has_major_axis(svd: &Svd) -> bool {
    svd.axis_ratio() < 1.0 - 1e-9
}

/// Both ends of the major axis in pixels.
fn major_axis(centre: [f64; 2], svd: &Svd, scaling: &Scaling) -> ([f64; 2], [f64; 2]) {
    let a = scaling.axes(svd)[0];
    let [ux, uy] = svd.major();
    let end = |sign: f64| [centre[0] + sign * a * ux, centre[1] - sign * a * uy];
    (end(-1.0), end(1.0))
}

/// Glyphs of one colour.
#[derive(Default)]
struct Layer {
    areas: PathBuilder,
    lines: PathBuilder,
    segments: PathBuilder,
}

/// All glyphs, gathered by colour so that a picture has few paths.
#[derive(Default)]
struct Layers {
    tension: Layer,
    compression: Layer,
    mixed: Layer,
    anisotropy: [Layer; ANISOTROPY_STEPS],
    /// Major axes of indefinite tensors: tension, compression.
    signed_lines: [PathBuilder; 2],
    zeros: PathBuilder,
    broken: PathBuilder,
}

impl Layers {
    fn add(&mut self, centre: [f64; 2], t: &Tensor2, scaling: &Scaling, colour: GlyphColour) {
        if !t.is_finite() {
            let r = (0.25 * scaling.radius).clamp(1.5, 4.0);
            self.broken.line([centre[0] - r, centre[1] - r], [centre[0] + r, centre[1] + r]);
            self.broken.line([centre[0] - r, centre[1] + r], [centre[0] + r, centre[1] - r]);
            return;
        }
        if t.is_zero() {
            self.zeros.circle(centre, (0.16 * scaling.radius).clamp(1.2, 2.5));
            return;
        }
        let layer = match colour {
            GlyphColour::AxisSign => self.signed(t),
            GlyphColour::Anisotropy => {
                let step = Anisotropy::of(t).linear * (ANISOTROPY_STEPS - 1) as f64;
                &mut self.anisotropy[(step.round().max(0.0) as usize).min(ANISOTROPY_STEPS - 1)]
            }
        };
        layer.add(centre, t, scaling);
        if colour == GlyphColour::AxisSign {
            self.add_signed_line(centre, t, scaling);
        }
    }

    fn signed(&mut self, t: &Tensor2) -> &mut Layer {
        let signs = Eigenvalues::of(t).axis_signs();
        let has = |sign: AxisSign| signs.contains(&sign);
        match (has(AxisSign::Tension), has(AxisSign::Compression)) {
            (true, false) => &mut self.tension,
            (false, true) => &mut self.compression,
            _ => &mut self.mixed,
        }
    }

    /// For axes of opposite signs, a major axis in the colour of its own sign.
    fn add_signed_line(&mut self, centre: [f64; 2], t: &Tensor2, scaling: &Scaling) {
        let eigenvalues = Eigenvalues::of(t);
        if eigenvalues.is_indefinite() && has_major_axis(&Svd::of(t)) {
            let major = eigenvalues.axis_signs()[0];
            let (from, to) = major_axis(centre, &Svd::of(t), scaling);
            self.signed_lines[usize::from(major == AxisSign::Compression)].line(from, to);
        }
    }

    /// Paints everything and returns the legend of what there was.
    fn draw(self, scene: &mut Scene) -> Vec<Entry> {
        let mut legend = Vec::new();
        for (layer, colour, name) in [
            (self.tension, TENSION, "tension (both axes ≥ 0)"),
            (self.compression, COMPRESSION, "compression (both axes ≤ 0)"),
            (self.mixed, MIXED, "axes of opposite or no sign (line: sign of the major one)"),
        ] {
            if layer.draw(scene, colour) {
                let mark = Mark::Outlined(colour.with_opacity(0.35), colour);
                legend.push(Entry::of(mark, name));
            }
        }
        for (lines, colour) in self.signed_lines.into_iter().zip([TENSION, COMPRESSION]) {
            if !lines.is_empty() {
                scene.stroke(lines.finish(), colour, 1.2);
            }
        }
        for (i, layer) in self.anisotropy.into_iter().enumerate() {
            layer.draw(scene, ColourMap::Batlow.sample(i as f64 / (ANISOTROPY_STEPS - 1) as f64));
        }
        if !self.zeros.is_empty() {
            scene.stroke(self.zeros.finish(), Rgba::MUTED, 0.8);
            legend.push(Entry::of(Mark::Ring(Rgba::MUTED), "zero tensor"));
        }
        if !self.broken.is_empty() {
            scene.stroke(self.broken.finish(), Rgba::NOT_FINITE, 1.2);
            legend.push(Entry::of(Mark::Point(Marker::Cross, Rgba::NOT_FINITE), "tensor not finite"));
        }
        legend
    }
}

impl Layer {
    fn add(&mut self, centre: [f64; 2], t: &Tensor2, scaling: &Scaling) {
        let svd = Svd::of(t);
        let [a, b] = scaling.axes(&svd);
        let [ux, uy] = svd.major();
        let (from, to) = major_axis(centre, &svd, scaling);
        if is_totally_anisotropic(t) {
            self.segments.line(from, to);
            return;
        }
        self.areas.ellipse(centre, [a * ux, -a * uy], [b * uy, b * ux]);
        if has_major_axis(&svd) {
            self.lines.line(from, to);
        }
    }

    fn draw(self, scene: &mut Scene, colour: Rgba) -> bool {
        let any = !(self.areas.is_empty() && self.segments.is_empty());
        if !self.areas.is_empty() {
            scene.paint(self.areas.finish(), colour.with_opacity(0.35), colour, 0.8);
        }
        if !self.lines.is_empty() {
            scene.stroke(self.lines.finish(), colour.mixed(Rgba::INK, 0.35), 0.7);
        }
        if !self.segments.is_empty() {
            scene.stroke(self.segments.finish(), colour, 1.6);
        }
        any
    }
}
