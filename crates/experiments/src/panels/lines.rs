//! Lines along an axis, evenly spaced, with the degenerate points.

use crate::form::{AxesChoice, Chosen, Placed, StyleSource};
use crate::names::Names;
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_lines::{Family, Following, LineOptions, Major};
use tigereye_render::PlainOptions;
use tigereye_views::lines::{LinesRequest, Seeds, lines};
use tigereye_views::point_overlays;
use tigereye_views::topology::topology;

/// Distance of lines in parts of the longer side.
const LINES_A_SIDE: f64 = 32.0;

/// Lines along an axis, evenly spaced, with the degenerate points.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Lines {
    /// Name of the field.
    field: Placed<String>,
    /// The axes that lines follow.
    #[serde(default)]
    axes: AxesChoice,
    /// Whether the major axis has the larger value or the larger magnitude.
    #[serde(default)]
    major: Option<Chosen<Major>>,
    /// Which of the two axes; both by default.
    #[serde(default)]
    family: Option<Chosen<Family>>,
    /// Heading of the panel.
    title: String,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

impl PanelKind for Lines {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let field = names.field(&self.field)?;
        let named = names.named_field(field);
        let following = Following { axes: self.axes.ordered(self.major, &named.field), cell: named.cell };
        let families = self.family.map_or(vec![Family::Major, Family::Minor], |f| vec![f.0]);
        let place = named.place();
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let field = &drawing.results.field(field).field;
            let longest = following.longer_side(field.grid());
            let request = LinesRequest {
                following,
                families: families.clone(),
                seeds: Seeds::Even((longest / LINES_A_SIDE).max(0.5)),
                options: LineOptions { step: 0.2, length: 2.0 * longest, ..LineOptions::default() },
                ribbon: None,
            };
            let points = topology(field, following, &[], &LineOptions::default()).points;
            let found = lines(field, &request)?;
            let cell_px = drawing.cell_px_of(field.grid(), following.cell);
            let (title, overlays) = (drawing.title.clone(), point_overlays(&points));
            let style = drawing.style();
            let options = PlainOptions { title, overlays, cell_px, style, ..PlainOptions::default() };
            Ok(found.picture(field, options))
        });
        Some(panel.placed(place))
    }
}
