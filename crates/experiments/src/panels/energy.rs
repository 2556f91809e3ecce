//! The energy of every cell in colours.

use crate::form::{Placed, Positive};
use crate::names::Names;
use crate::numerics::paths::Paths;
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_core::Cell;
use tigereye_render::{Overlay, Rgba};
use tigereye_views::light::{self, Request};
use tigereye_views::total_anisotropy::ThinCells;

/// The energy of every cell in colours.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Energy {
    /// Name of the light run.
    run: Placed<String>,
    /// Step to show; the last by default.
    #[serde(default)]
    step: Option<Placed<usize>>,
    /// Decades shown below the brightest cell; a linear scale by default.
    #[serde(default)]
    decades: Option<Positive>,
    /// In a scene, draws the shortest and the brightest path from the first light to this column and row.
    #[serde(default)]
    way_to: Option<Placed<(usize, usize)>>,
    /// Heading of the panel.
    title: String,
}

impl PanelKind for Energy {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let frame = names.frame(&self.run, self.step.as_ref())?;
        let to = match &self.way_to {
            Some(to) => Some(names.path_to(&self.run, to)?.1),
            None => None,
        };
        let decades = self.decades.map(Positive::get);
        Some(PlannedPanel::new(&self.title, move |drawing| {
            let run = &drawing.results[frame.light];
            let mut overlays: Vec<Overlay> = run.thin.iter().map(ThinCells::overlay).collect();
            if let Some(to) = to {
                overlays.extend(paths(&Paths::of(run, to)?));
            }
            let request = Request {
                title: drawing.title.clone(),
                decades,
                sources: run.sources.clone(),
                walls: run.surfaces.clone(),
                overlays,
                cell_px: drawing.cell_px(run.last.grid()),
                ..Request::default()
            };
            Ok(light::picture(&drawing.results.frame(frame)?.energy(), request))
        }))
    }
}

/// The shortest path, and the brightest one over it.
fn paths(paths: &Paths) -> Vec<Overlay> {
    let line = |path: &[Cell], label: &str, colour, width_px| Overlay {
        label: label.to_owned(),
        points: path.iter().map(|c| c.centre()).collect(),
        colour,
        width_px,
        ..Overlay::default()
    };
    let blue = Rgba::hex(0x56b4e9);
    vec![
        line(&paths.shortest, "shortest way (breadth-first search)", Rgba::hex(0xd55e00), 4.0),
        match &paths.brightest {
            Some(path) => line(path, "brightest way", blue, 1.2),
            None => line(&[], "brightest way: none, a summit lies before the light", blue, 1.2),
        },
    ]
}
