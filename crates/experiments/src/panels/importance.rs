//! Where the light at a receiver comes from, in colours.

use crate::form::{Placed, Positive};
use crate::names::Names;
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_core::math;
use tigereye_views::light::{self, Request};
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
}

impl PanelKind for Importance {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let id = names.importance(&self.run)?;
        let decades = self.decades.map(Positive::get);
        Some(PlannedPanel::new(&self.title, move |drawing| {
            let outcome = &drawing.results[id];
            let request = Request {
                title: drawing.title.clone(),
                quantity: Some("mean importance over direction".to_owned()),
                decades,
                sources: vec![outcome.receiver],
                source_name: Some("receiver"),
                dark_name: Some("unimportant"),
                walls: outcome.surfaces.clone(),
                overlays: outcome.thin.iter().map(ThinCells::overlay).collect(),
                cell_px: drawing.cell_px(outcome.importance.grid()),
                ..Request::default()
            };
            Ok(light::picture(&outcome.importance.energy().map(|e| e / math::TAU), request))
        }))
    }
}
