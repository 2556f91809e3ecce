//! Glyphs over the colours of a map.

use super::kind::{GlyphColour, GlyphKind, GlyphScale};
use super::layers::{Layer, Layers};
use super::scaling::Scaling;
use crate::colour::{ColourMap, Rgba};
use crate::legend::{Entry, Mark};
use crate::map_frame::{self, MapFrame};
use crate::scene::{PagePoint, PageVector, PathBuilder, Scene};
use tigereye_core::{Field, Tensor2};

/// Least distance of glyphs in pixels: colours between them must remain visible.
const PITCH_PX: f64 = 20.0;

/// The ellipses of a field as outlines, in dark on a white edge, which stand out from every colour.
pub(crate) fn draw(page: &mut MapFrame, field: Option<&Field<Tensor2>>, legend: &mut Vec<Entry>) {
    let Some(field) = field.filter(|field| field.grid() == page.grid) else { return };
    let kind = GlyphKind::Ellipse;
    let every = map_frame::stride(page.smaller_side(), PITCH_PX);
    let radius = kind.radius() * page.smaller_side() * every as f64;
    let scaling = Scaling { kind: GlyphScale::Field, largest: super::largest(field, kind), radius };
    let mut layers = Layers::of(kind, GlyphColour::AxisSign, ColourMap::default());
    for cell in map_frame::sampled_cells(page.grid, every) {
        let tensor = field.at(cell);
        if tensor.is_finite() && !tensor.is_zero() {
            layers.add(page.centre(cell), tensor, &scaling);
        }
    }
    let mut outlines = Vec::new();
    for Layer { areas, hollow, segments, .. } in layers.tones {
        outlines.extend([areas, hollow, segments].into_iter().flat_map(PathBuilder::finish));
    }
    if outlines.is_empty() {
        return;
    }
    page.scene.stroke(outlines.clone(), Rgba::WHITE.with_opacity(0.8), 2.0);
    page.scene.stroke(outlines, Rgba::INK, 0.8);
    let mut ellipse = PathBuilder::default();
    ellipse.ellipse(PagePoint::zero(), PageVector::new(9.0, 0.0), PageVector::new(0.0, 4.0));
    let mut mark = Scene::sized(0.0, 0.0);
    mark.stroke(ellipse.finish(), Rgba::INK, 0.8);
    let every = if every > 1 { format!(", one per {every} × {every} cells") } else { String::new() };
    legend.push(Entry::of(Mark::Drawing(mark.items), format!("tensors as ellipses{every}")));
}
