//! Where the light at a receiver comes from, in colours.

use crate::form::{Chosen, Placed, Positive, StyleSource};
use crate::names::Names;
use crate::panels::additions::{PlannedAdditions, Shown};
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_core::math;
use tigereye_render::{Colours, HeatOptions, heat_map};
use tigereye_views::added::{Added, Additions, Scalars};
use tigereye_views::light;
use tigereye_views::total_anisotropy::ThinCells;

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
    /// What is drawn over it, as `--overlay` of commands.
    #[serde(default)]
    overlays: Option<Placed<Vec<Chosen<Added>>>>,
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
        let of = names.field_of(id.0);
        let added = PlannedAdditions::resolve(&self.overlays, of, Shown::Scalar, names)?;
        let place = names.place(id.0);
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let outcome = &drawing.results[id];
            let mean = outcome.importance.energy().map(|e| e / math::TAU);
            let scalars = Scalars { values: &mean, samples: 1 };
            let Additions { mut overlays, glyphs } = added.over(drawing.results, Some(scalars))?;
            // Beneath the others.
            overlays.splice(0..0, outcome.thin.iter().map(ThinCells::overlay));
            let options = HeatOptions {
                overlays,
                glyphs,
                title: drawing.title.clone(),
                sources: vec![outcome.receiver],
                walls: outcome.surfaces.clone(),
                cell_px: drawing.cell_px(outcome.importance.grid()),
                masked: outcome.masked.clone(),
                style: drawing.style(),
                ..light::importance_options(decades)
            };
            Ok(heat_map(&mean, &options))
        });
        Some(panel.placed(place))
    }
}
