//! A gradient without its direction.

use crate::form::{Chosen, Placed, StyleSource};
use crate::names::Names;
use crate::panels::additions::{PlannedAdditions, Shown};
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_render::Colours;
use tigereye_views::added::Added;
use tigereye_views::gradient::Scalar;

/// A gradient summarised over its directions.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Flat {
    /// Name of the gradient run.
    run: Placed<String>,
    /// How directions are summarised.
    view: FlatView,
    /// Heading of the panel.
    title: String,
    /// What is drawn over it, as `--overlay` of commands.
    #[serde(default)]
    overlays: Option<Placed<Vec<Chosen<Added>>>>,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

/// How the directions of a gradient are summarised.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum FlatView {
    /// Mean.
    Mean,
    /// Maximum.
    Maximum,
    /// Standard deviation.
    Deviation,
}

impl PanelKind for Flat {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn colours(&self) -> Colours {
        Colours::Values
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let (gradient, view) = (names.gradient(&self.run)?, self.view);
        let of = names.field_of(gradient.0);
        let added = PlannedAdditions::resolve(&self.overlays, of, Shown::Scalar, names)?;
        let place = names.place(gradient.0);
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let gradient = &drawing.results[gradient];
            let volume = gradient.volume();
            let (scalar, which) = match view {
                FlatView::Mean => (volume.mean_over_directions(), Scalar::Mean),
                FlatView::Maximum => (volume.max_over_directions(), Scalar::Largest),
                FlatView::Deviation => (volume.deviation_over_directions(), Scalar::Deviation),
            };
            drawing.gradient_map(&scalar, gradient, which, (Vec::new(), &added))
        });
        Some(panel.placed(place))
    }
}
