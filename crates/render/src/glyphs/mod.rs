//! Tensor fields as glyphs, one a cell.

mod arrows;
mod layers;
mod legend;
mod outlines;
mod quadric;
mod signed;
#[cfg(test)]
mod tests;
mod turned;

use crate::axis::Axis;
use crate::colour::{ColourMap, Rgba};
use crate::colour_bar::ColourBar;
use crate::legend::{Entry, Mark};
use crate::map_frame::{self, MapFrame};
use crate::overlay::{self, Overlay};
use crate::ribbon::{self, Ribbon};
use crate::scene::Scene;
use layers::Layers;
pub use outlines::{GlyphOutline, GlyphPart, glyph_outlines};
use tigereye_core::{CellShape, Field, PrincipalAxes, Svd, Tensor2};

/// What stands for a tensor. Zero tensors are small hollow dots and tensors that are not finite small crosses in every
/// kind; half-axes are the singular values unless something else is said.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GlyphKind {
    /// The ellipse the tensor makes of the unit circle, with its major axis as a thin line. Totally anisotropic tensors are
    /// segments.
    #[default]
    Ellipse,
    /// The rectangle with the half-axes as half-sides; segments as for ellipses.
    Box,
    /// The superellipse `|x / s1|^(2/e) + |y / s2|^(2/e) = 1` along the half-axes with `e = (1 - c_l)^gamma` and
    /// `c_l = (s1 - s2) / (s1 + s2)`: a circle where isotropic, boxier the more anisotropic, a segment in the end.
    ///
    /// Kindlmann ("Superquadric tensor glyphs", VisSym 2004) has two exponents, `(1 - c_p)^gamma` and `(1 - c_l)^gamma`. A
    /// tensor of the plane has no planar part: with `c_p = 0` this is the section of his glyph through its longest axis, with
    /// the `c_l` of two axes instead of three.
    Superquadric {
        /// Sharpness of edges, 0 (always an ellipse) to 100; [`GlyphKind::GAMMA`] is usual, and taken for a value that is
        /// not a number.
        gamma: f64,
    },
    /// The normal component in every direction, `r(n) = |n . T n|`, the section of Reynolds's glyph (Hashash, Yao and
    /// Wotring 2003, "Glyph and hyperstreamline representation of stress and strain tensors and material constitutive
    /// response"): filled lobes where it is positive (tension), hollow ones where it is negative (compression). It shows the
    /// symmetric part alone; along its axes the lobes reach its eigenvalues.
    Signed,
    /// The axes of the symmetric part as a cross of arrows, as long as its eigenvalues: heads outwards for tension, inwards
    /// for compression.
    Arrows,
    /// The ellipse `U S` of `A = U S V^T`, and what the tensor does apart from stretching, `Q = U V^T`.
    ///
    /// For `det A >= 0` that is a rotation ([`tigereye_core::OrthogonalFactor`]): two opposite sectors open from the line
    /// `v1`, which becomes the major axis, to the major axis `u1`; their angle is that of the rotation, true whatever the
    /// ellipse, their radius 0.6 of the larger half-axis. They are filled where it is counter-clockwise, hollow where it
    /// is clockwise; half a turn counts as counter-clockwise. Where both half-axes are equal, +x takes the place of `u1`.
    /// Symmetric tensors that are nowhere negative have no sectors. For `det A < 0`, a reflection, a dashed line shows the
    /// direction that it keeps.
    Asymmetric,
}

impl GlyphKind {
    /// The usual sharpness of superquadrics (Kindlmann 2004).
    pub const GAMMA: f64 = 3.0;

    fn name(self) -> &'static str {
        match self {
            Self::Ellipse => "Ellipse",
            Self::Box => "Box",
            Self::Superquadric { .. } => "Superquadric",
            Self::Signed => "Signed",
            Self::Arrows => "Arrow",
            Self::Asymmetric => "Ellipse and rotation",
        }
    }

    /// Pixels between the smallest glyphs whose parts can be told apart.
    fn pitch_px(self) -> f64 {
        match self {
            Self::Ellipse | Self::Box | Self::Superquadric { .. } => 12.0,
            Self::Signed => 18.0,
            Self::Arrows | Self::Asymmetric => 24.0,
        }
    }

    /// The largest half-axis by the distance between glyphs, such that neighbours never touch.
    fn radius(self) -> f64 {
        match self {
            // The corners of a square that stands on one.
            Self::Box => 0.45 / core::f64::consts::SQRT_2,
            Self::Superquadric { gamma } if gamma > Self::GAMMA => 0.45 / core::f64::consts::SQRT_2,
            // Rounded corners of the usual sharpness lie within 1.05 half-axes.
            _ => 0.45,
        }
    }

    /// Whether it shows the symmetric part of a tensor only.
    const fn is_symmetric(self) -> bool {
        matches!(self, Self::Signed | Self::Arrows)
    }

    /// The largest half-axis in the tensor's unit; not finite where the tensor cannot be drawn.
    fn size(self, t: &Tensor2) -> f64 {
        match self {
            _ if !t.is_finite() => f64::NAN,
            Self::Signed | Self::Arrows => {
                let [l1, l2] = PrincipalAxes::of(t).values;
                l1.abs().max(l2.abs())
            }
            _ => Svd::of(t).s[0],
        }
    }
}

/// How glyphs are scaled against each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlyphScale {
    /// The largest half-axis of the field fills a cell: sizes are comparable.
    #[default]
    Field,
    /// Half-axes by the square root of the values, the largest filling a cell: fields with peaks stay legible.
    SquareRoot,
    /// Every glyph fills its cell: only shape and direction are shown.
    Glyph,
}

/// What the colour of glyphs means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlyphColour {
    /// Tension, compression or both, by the real parts of the eigenvalues; of [`GlyphKind::Asymmetric`], the sense of
    /// rotation.
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
    /// What stands for a tensor.
    pub kind: GlyphKind,
    /// Scaling.
    pub scale: GlyphScale,
    /// Meaning of colours.
    pub colour: GlyphColour,
    /// Draws every n-th cell; by default as many as stay readable.
    pub every: Option<usize>,
    /// Pixels of a cell's smaller side; by default whole, such that the longer side has about 640.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
    /// Bands, such as hyperstreamlines.
    pub ribbons: Vec<Ribbon>,
    /// Points and lines over the glyphs and bands, such as tensor lines.
    pub overlays: Vec<Overlay>,
}

/// Each tensor as a glyph of the kind chosen, within its cell. What marks mean stands in the legend where they occur.
#[must_use]
pub fn glyphs(field: &Field<Tensor2>, options: &GlyphOptions) -> Scene {
    let grid = field.grid();
    let kind = options.kind;
    let cell = map_frame::cell_px(grid, options.cell, options.cell_px, 640, 48);
    let smaller = cell[0].min(cell[1]);
    let every = options.every.unwrap_or_else(|| map_frame::stride(smaller, kind.pitch_px())).max(1);
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
    let largest = largest(field, kind);
    let scaling = Scaling { kind: options.scale, largest, radius: kind.radius() * (smaller * every as f64) };
    let mut layers = Layers::of(kind, options.colour);
    for cell in map_frame::sampled_cells(grid, every) {
        layers.add(page.centre(cell), field.at(cell), &scaling);
    }
    let mut legend = layers.draw(&mut page.scene);
    ribbon::draw(&mut page, &options.ribbons, &mut legend);
    overlay::draw(&mut page, &options.overlays, &mut legend);
    legend.extend(remarks(options, every, largest));
    if let Some(bar) = bar {
        let (edge, top, height) = (page.left + page.width(), page.top, page.side_height());
        bar.draw(&mut page.scene, edge, top, height);
    }
    let description = format!(
        "{} glyphs of a tensor field of {} x {} cells, row 0 on top, one glyph per {every} x {every} cells.",
        kind.name(),
        grid.width(),
        grid.height()
    );
    page.finish(&options.title, description, &legend)
}

/// The largest half-axis of a field that can be drawn.
fn largest(field: &Field<Tensor2>, kind: GlyphKind) -> f64 {
    field.values().iter().map(|t| kind.size(t)).filter(|s| s.is_finite()).fold(0.0, f64::max)
}

fn remarks(options: &GlyphOptions, every: usize, largest: f64) -> Vec<Entry> {
    let symmetric = options.kind.is_symmetric();
    let mut remarks = Vec::new();
    match options.scale {
        _ if largest == 0.0 && symmetric => {
            remarks.push(Entry::of(Mark::None, "every symmetric part is zero or not finite"));
        }
        _ if largest == 0.0 => remarks.push(Entry::of(Mark::None, "every tensor is zero or not finite")),
        GlyphScale::Field => {}
        GlyphScale::SquareRoot if symmetric => {
            remarks.push(Entry::of(Mark::None, "lengths ∝ square root of the values"));
        }
        GlyphScale::SquareRoot => remarks.push(Entry::of(Mark::None, "semi-axes ∝ √s")),
        GlyphScale::Glyph => remarks.push(Entry::of(Mark::None, "each glyph scaled to its cell")),
    }
    if every > 1 {
        remarks.push(Entry::of(Mark::None, format!("one glyph per {every} × {every} cells")));
    }
    remarks
}

/// From the tensor's unit to pixels.
struct Scaling {
    kind: GlyphScale,
    /// Largest half-axis of the field, finite.
    largest: f64,
    /// What it is drawn as, in pixels: less than half of the distance between glyphs.
    radius: f64,
}

impl Scaling {
    /// Pixels for a length `value >= 0` of a glyph whose largest half-axis is `size`.
    fn length(&self, value: f64, size: f64) -> f64 {
        let unit = if self.kind == GlyphScale::Glyph { size } else { self.largest };
        let share = if unit > 0.0 { value / unit } else { 0.0 };
        self.radius * if self.kind == GlyphScale::SquareRoot { share.sqrt() } else { share }
    }

    /// Half-axes in pixels.
    fn axes(&self, svd: &Svd) -> [f64; 2] {
        svd.s.map(|s| self.length(s, svd.s[0]))
    }
}

/// The point at `length` pixels from `centre` in the direction of `[x, y]`, y up.
fn towards(centre: [f64; 2], [x, y]: [f64; 2], length: f64) -> [f64; 2] {
    [centre[0] + length * x, centre[1] - length * y]
}
