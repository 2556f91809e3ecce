//! Where the light at a receiver comes from, in colours.

use crate::form::{Placed, Positive, StyleSource};
use crate::names::Names;
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_core::math;
use tigereye_render::{Colours, HeatOptions, heat_map};
use tigereye_views::light;

/// Mean importance over direction of every cell in colours; the receiver is marked.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Importance {
    /// Name of the importance run.
    run: Placed<String>,
    /// Decades shown below the most important cell; a linear scale by default.
    #[serde(default)]
    decades: Option<Positive>,
    /// Heading of the panel.
    title: String,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

impl PanelKind for Importance {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn colours(&self) -> Colours {
        Colours::Values
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let id = names.importance(&self.run)?;
        let decades = self.decades.map(Positive::get);
        let coordinates = names.coordinates(id.0);
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let outcome = &drawing.results[id];
            let options = HeatOptions {
                title: drawing.title.clone(),
                sources: vec![outcome.receiver],
                walls: outcome.surfaces.clone(),
                cell_px: drawing.cell_px(outcome.importance.grid()),
                masked: outcome.masked.clone(),
                style: drawing.style(),
                ..light::importance_options(decades)
            };
            Ok(heat_map(&outcome.importance.energy().map(|e| e / math::TAU), &options))
        });
        Some(panel.placed(coordinates))
    }
}
