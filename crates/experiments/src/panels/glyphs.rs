//! The tensors as ellipses.

use crate::form::{Chosen, Placed, StyleSource};
use crate::names::Names;
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_core::{Field, Tensor2};
use tigereye_render::{Colours, GlyphColour, GlyphOptions, GlyphScale, glyphs};

/// The tensors as ellipses.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Glyphs {
    /// Name of the field.
    field: Placed<String>,
    /// Meaning of the colours.
    #[serde(default = "anisotropy")]
    colour: Chosen<GlyphColour>,
    /// Heading of the panel.
    title: String,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

/// Signs mean something in stresses, but nothing in the rotated diagonal tensors of generators.
const fn anisotropy() -> Chosen<GlyphColour> {
    Chosen(GlyphColour::Anisotropy)
}

impl PanelKind for Glyphs {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn colours(&self) -> Colours {
        if self.colour.0 == GlyphColour::Anisotropy { Colours::Quantity } else { Colours::Kinds }
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let field = names.field(&self.field)?;
        let Chosen(colour) = self.colour;
        let place = names.named_field(field).place();
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let named = drawing.results.field(field);
            let (field, cell) = (&named.field, named.cell);
            let scale = if same_size(field) { GlyphScale::Field } else { GlyphScale::SquareRoot };
            let cell_px = drawing.cell_px_of(field.grid(), cell);
            let title = drawing.title.clone();
            let style = drawing.style();
            let options =
                GlyphOptions { title, scale, colour, cell_px, cell, style, ..GlyphOptions::default() };
            Ok(glyphs(field, &options))
        });
        Some(panel.placed(place))
    }
}

/// Whether the largest and smallest ellipses of a field differ by less than a factor of four.
fn same_size(field: &Field<Tensor2>) -> bool {
    let sizes = || field.values().iter().map(Tensor2::max_abs).filter(|s| *s > 0.0);
    let (low, high) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    high < 4.0 * low
}
