//! Transmission and light of every cell as polar diagrams.

use crate::form::{Chosen, Placed, Positive, StyleSource};
use crate::names::Names;
use crate::panels::additions::{PlannedAdditions, Shown};
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_render::{IntensityScale, PolarOptions, TransmissionScale, polar_overlay};
use tigereye_views::added::{Added, Additions, Scalars};
use tigereye_views::total_anisotropy::ThinCells;

/// Transmission (red) and light (blue) of every cell.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Overlay {
    /// Name of the light run.
    run: Placed<String>,
    /// Step to show; the last by default.
    #[serde(default)]
    step: Option<Placed<usize>>,
    /// The brightness scale.
    #[serde(default)]
    scale: Scale,
    /// Whether the transmission is drawn.
    #[serde(default = "yes")]
    transmission: bool,
    /// Heading of the panel.
    title: String,
    /// What is drawn over it, as `--overlay` of commands.
    #[serde(default)]
    overlays: Option<Placed<Vec<Chosen<Added>>>>,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

fn yes() -> bool {
    true
}

/// The brightness scale of an overlay.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
pub enum Scale {
    /// Relative to the brightest cell, including the lights.
    Linear,
    /// Relative to the brightest cell that is not a light.
    LinearWithoutSources,
    /// Each cell relative to itself: shape only.
    PerCell,
    /// By the logarithm of the cell's mean over four decades.
    #[default]
    Logarithmic,
    /// The same over this many decades.
    Decades(Positive),
}

impl PanelKind for Overlay {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let frame = names.frame(&self.run, self.step.as_ref())?;
        let intensity = match self.scale {
            Scale::Linear => IntensityScale::Linear { exclude_sources: false },
            Scale::LinearWithoutSources => IntensityScale::Linear { exclude_sources: true },
            Scale::PerCell => IntensityScale::PerCell,
            Scale::Logarithmic => IntensityScale::Logarithmic { decades: 4.0 },
            Scale::Decades(d) => IntensityScale::Logarithmic { decades: d.get() },
        };
        let shows_transmission = self.transmission;
        let of = names.field_of(frame.light.0);
        let added = PlannedAdditions::resolve(&self.overlays, of, Shown::Diagrams, names)?;
        let place = names.place(frame.light.0);
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let run = &drawing.results[frame.light];
            let light = drawing.results.frame(frame)?;
            let energy = light.energy();
            let scalars = Scalars { values: &energy, samples: 1 };
            let Additions { mut overlays, .. } = added.over(drawing.results, Some(scalars))?;
            // Beneath the others.
            overlays.splice(0..0, run.thin.iter().map(ThinCells::overlay));
            let options = PolarOptions {
                overlays,
                title: drawing.title.clone(),
                intensity,
                transmission: TransmissionScale::Rate,
                sources: run.sources.clone(),
                walls: run.surfaces.clone(),
                cell_px: drawing.cell_px(run.last.grid()),
                masked: run.masked.clone(),
                style: drawing.style(),
                ..PolarOptions::default()
            };
            Ok(polar_overlay(shows_transmission.then_some(&run.transmission), Some(light), &options))
        });
        Some(panel.placed(place))
    }
}
