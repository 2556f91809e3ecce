//! A scalar over the cells.

use crate::form::{Chosen, Placed, StyleSource};
use crate::names::Names;
use crate::panels::additions::{PlannedAdditions, Shown};
use crate::panels::kind::{PanelKind, PlannedPanel};
use crate::scalars::{Map as Scalar, MapSource, Ridges};
use serde::Deserialize;
use tigereye_render::{Colours, HeatOptions, Rgba};
use tigereye_views::added::{Added, Additions, Scalars};
use tigereye_views::{ftle, gradient};
use tigereye_views::ridges::line_overlay;

/// A scalar over the cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// The scalar.
    map: MapSource,
    /// Whether its height ridges are drawn.
    #[serde(default)]
    ridges: bool,
    /// Heading of the panel.
    title: String,
    /// What is drawn over it, as `--overlay` of commands.
    #[serde(default)]
    overlays: Option<Placed<Vec<Chosen<Added>>>>,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

impl PanelKind for Map {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn colours(&self) -> Colours {
        Colours::Values
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let (scalar, ridges) = (self.map.resolve(names)?, self.ridges);
        let of = names.field_of(scalar.run());
        let added = PlannedAdditions::resolve(&self.overlays, of, Shown::Scalar, names)?;
        let place = names.place(scalar.run());
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let results = drawing.results;
            let overlays = if ridges {
                let found = Ridges::Of(scalar).lines(results)?;
                vec![line_overlay(&found, "height ridges", Rgba::hex(0xd62728))]
            } else {
                Vec::new()
            };
            let (id, which) = match scalar {
                Scalar::Ftle(id) => {
                    let outcome = &results[id];
                    let following = outcome.following;
                    let cell_px = drawing.cell_px_of(outcome.at_cells().grid(), following.cell);
                    let title = drawing.title.clone();
                    let style = drawing.style();
                    let scalars = Scalars { values: &outcome.found.larger, samples: outcome.found.samples };
                    let Additions { overlays: more, glyphs } = added.over(results, Some(scalars))?;
                    let overlays = [overlays, more].concat();
                    let options =
                        HeatOptions { title, overlays, glyphs, cell_px, style, ..HeatOptions::default() };
                    let field = &results.field(outcome.field).field;
                    return Ok(ftle::picture(&outcome.found, field, following.axes, options));
                }
                Scalar::Slice(slice) => (slice.gradient, gradient::Scalar::Slice),
                Scalar::Mean(id) => (id, gradient::Scalar::Mean),
                Scalar::Maximum(id) => (id, gradient::Scalar::Largest),
            };
            drawing.gradient_map(&scalar.scalar(results)?, &results[id], which, (overlays, &added))
        });
        Some(panel.placed(place))
    }
}
