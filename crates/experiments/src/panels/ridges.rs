//! Height ridges of several scalars over each other.

use crate::form::{Placed, StyleSource};
use crate::names::Names;
use crate::panels::kind::{PanelKind, PlannedPanel};
use crate::scalars::RidgeSource;
use serde::Deserialize;
use tigereye_render::{PlainOptions, SERIES_PALETTE, plain_map};
use tigereye_views::ridges::line_overlay;

/// Height ridges of several scalars in one picture.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Ridges {
    /// The field, for its size.
    field: Placed<String>,
    /// Names in the legend, and ridges; at most four.
    sources: Vec<(String, RidgeSource)>,
    /// Heading of the panel.
    title: String,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

impl PanelKind for Ridges {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let field = names.field(&self.field)?;
        let resolved = self.sources.iter().map(|(label, source)| Some((label.clone(), source.resolve(names)?)));
        let sources = resolved.collect::<Option<Vec<_>>>()?;
        let place = names.named_field(field).place();
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let named = drawing.results.field(field);
            let overlays = sources.iter().zip(SERIES_PALETTE).map(|((label, source), colour)| {
                let lines = source.lines(drawing.results)?;
                // Whoever looks for them must not take them for hidden.
                let label = if lines.lines.is_empty() { format!("{label}: no ridge") } else { label.clone() };
                Ok(line_overlay(&lines, &label, colour))
            });
            let options = PlainOptions {
                title: drawing.title.clone(),
                description: "Height ridges".to_owned(),
                cell_px: drawing.cell_px_of(named.field.grid(), named.cell),
                cell: named.cell,
                style: drawing.style(),
                overlays: overlays.collect::<Result<_, crate::unavailable::Unavailable>>()?,
                ..PlainOptions::default()
            };
            Ok(plain_map(named.field.grid(), &options))
        });
        Some(panel.placed(place))
    }
}
