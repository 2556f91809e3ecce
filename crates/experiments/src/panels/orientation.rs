//! The direction of the longer semi-axis in colours.

use crate::form::{Placed, StyleSource};
use crate::names::Names;
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_render::{Colours, OrientationOptions, orientation_map};

/// The direction of the longer semi-axis in colours.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Orientation {
    /// Name of the field.
    field: Placed<String>,
    /// Heading of the panel.
    title: String,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

impl PanelKind for Orientation {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn colours(&self) -> Colours {
        Colours::Directions
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let field = names.field(&self.field)?;
        let place = names.named_field(field).place();
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let named = drawing.results.field(field);
            let cell_px = drawing.cell_px_of(named.field.grid(), named.cell);
            let (title, cell) = (drawing.title.clone(), named.cell);
            let style = drawing.style();
            let options =
                OrientationOptions { title, cell_px, cell, style, ..OrientationOptions::default() };
            Ok(orientation_map(&named.field, &options))
        });
        Some(panel.placed(place))
    }
}
