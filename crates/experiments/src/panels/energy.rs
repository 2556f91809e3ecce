//! The energy of every cell in colours.

use crate::form::{Chosen, Placed, Positive, StyleSource};
use crate::names::Names;
use crate::numerics::paths::Paths;
use crate::panels::additions::{PlannedAdditions, Shown};
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_core::Cell;
use tigereye_render::{Colours, HeatOptions, Overlay, Rgba, heat_map};
use tigereye_views::added::{Added, Additions, Scalars};
use tigereye_views::light;
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
    /// What is drawn over it, as `--overlay` of commands.
    #[serde(default)]
    overlays: Option<Placed<Vec<Chosen<Added>>>>,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

impl PanelKind for Energy {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn colours(&self) -> Colours {
        Colours::Values
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let frame = names.frame(&self.run, self.step.as_ref())?;
        let to = match &self.way_to {
            Some(to) => Some(names.path_to(&self.run, to)?.1),
            None => None,
        };
        let decades = self.decades.map(Positive::get);
        let of = names.field_of(frame.light.0);
        let added = PlannedAdditions::resolve(&self.overlays, of, Shown::Scalar, names)?;
        let place = names.place(frame.light.0);
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let run = &drawing.results[frame.light];
            let energy = drawing.results.frame(frame)?.energy();
            let scalars = Scalars { values: &energy, samples: 1 };
            let Additions { mut overlays, glyphs } = added.over(drawing.results, Some(scalars))?;
            // Beneath the others.
            overlays.splice(0..0, run.thin.iter().map(ThinCells::overlay));
            if let Some(to) = to {
                overlays.extend(ways(&Paths::of(run, to)?));
            }
            let options = HeatOptions {
                title: drawing.title.clone(),
                sources: run.sources.clone(),
                walls: run.surfaces.clone(),
                overlays,
                glyphs,
                cell_px: drawing.cell_px(run.last.grid()),
                masked: run.masked.clone(),
                style: drawing.style(),
                ..light::options(decades)
            };
            Ok(heat_map(&energy, &options))
        });
        Some(panel.placed(place))
    }
}

/// The shortest path, and the brightest one over it.
fn ways(paths: &Paths) -> Vec<Overlay> {
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
