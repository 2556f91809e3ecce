//! Tensor fields as glyphs, one per cell.

mod arrows;
mod draw;
mod kind;
mod layers;
mod legend;
mod note;
mod outlines;
pub(crate) mod over;
mod quadric;
mod scaling;
mod signed;
#[cfg(test)]
mod tests;
mod turned;

use crate::axis::Axis;
use crate::colour::{ColourMap, Rgba};
use crate::colour_bar::ColourBar;
use crate::legend::{Entry, Mark};
use crate::map_frame::{self, MapFrame};
use crate::mask;
use crate::overlay::{self, Overlay};
use crate::ribbon::{self, Ribbon};
use crate::scene::Scene;
use crate::style::Style;
pub use kind::{GlyphColour, GlyphKind, GlyphScale};
use layers::Layers;
pub use outlines::{GlyphOutline, GlyphPart, glyph_outlines};
use scaling::Scaling;
use tigereye_core::{CellShape, Field, Tensor2};

/// Options of [`glyphs`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GlyphOptions {
    /// Title; may be empty.
    pub title: String,
    /// The kind of glyph.
    pub kind: GlyphKind,
    /// Scaling.
    pub scale: GlyphScale,
    /// Meaning of colours.
    pub colour: GlyphColour,
    /// Draws every n-th cell; by default as many as stay readable.
    pub every: Option<usize>,
    /// Pixels of a cell's smaller side; by default a whole number such that the longer side of the map has about 640.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
    /// Bands, such as hyperstreamlines.
    pub ribbons: Vec<Ribbon>,
    /// Points and lines over the glyphs and bands, such as tensor lines.
    pub overlays: Vec<Overlay>,
    /// Settings of the user, which override the options above; a colour map or a quantity applies to the anisotropy.
    pub style: Style,
}

/// Each tensor as a glyph of the chosen kind, within its cell. The legend explains the marks that occur.
#[must_use]
pub fn glyphs(field: &Field<Tensor2>, options: &GlyphOptions) -> Scene {
    let grid = field.grid();
    let kind = options.kind;
    let cell = map_frame::cell_px(grid, options.cell, options.cell_px, 640, 48);
    let map = options.style.map.unwrap_or(ColourMap::Batlow);
    let bar = (options.colour == GlyphColour::Anisotropy).then(|| ColourBar {
        axis: Axis::linear(0.0, 1.0),
        map,
        label: options.style.quantity.as_deref().unwrap_or("linear anisotropy (s₁ − s₂) / (s₁ + s₂)"),
        below: false,
        above: false,
    });
    // The room is that of a short bar, whatever the height.
    let side = bar.as_ref().map_or(0.0, |b| b.width(200.0));
    let mut page = MapFrame::begin(grid, (&options.style, &options.title), cell, &|_| side);
    let smaller = page.smaller_side();
    let every = options.every.unwrap_or_else(|| map_frame::stride(smaller, kind.pitch_px())).max(1);
    page.grid_lines(every, Rgba::hex(0xececec));
    let largest = largest(field, kind);
    let scaling = Scaling { kind: options.scale, largest, radius: kind.radius() * (smaller * every as f64) };
    let masked = Field::from_fn(grid, |cell| field.at(cell).is_zero());
    mask::draw(&mut page, &masked);
    let mut layers = Layers::of(kind, options.colour, map);
    for cell in map_frame::sampled_cells(grid, every).filter(|cell| !*masked.at(*cell)) {
        layers.add(page.centre(cell), field.at(cell), &scaling);
    }
    let mut legend = layers.draw(&mut page.scene);
    mask::explain(&masked, &options.style, &mut legend);
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
    page.finish(description, &legend)
}

/// The largest semi-axis of a field that can be drawn.
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
