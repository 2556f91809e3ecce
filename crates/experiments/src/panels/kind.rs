//! What a panel is.

use crate::form::{Placed, StyleSource};
use crate::names::Names;
use crate::panels::additions::PlannedAdditions;
use crate::results::Results;
use crate::runs::gradient::Outcome;
use crate::unavailable::Unavailable;
use tigereye_core::{CellShape, Field, Grid};
use tigereye_render::{AxisNumbers, Colours, HeatOptions, Overlay, Scene, Style};
use tigereye_views::added::Scalars;
use tigereye_views::gradient;
use tigereye_views::total_anisotropy::ThinCells;

/// A picture of the results, every name looked up; or why it is not to be had.
pub(crate) type Picture = Box<dyn Fn(&Drawing<'_>) -> Result<Scene, Unavailable> + Send + Sync>;
/// The curves behind a picture.
pub(crate) type Curves = Box<dyn Fn(&Results<'_>) -> Result<Vec<Curve>, Unavailable> + Send + Sync>;

/// The form in the experiment file, and how it is drawn.
pub(crate) trait PanelKind {
    /// Looks up names, checks cells and steps, and parses expressions; `None` where something is wrong, which is
    /// reported.
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel>;

    /// How it is to look.
    fn style(&self) -> Option<&Placed<StyleSource>> {
        None
    }

    /// What its colours show.
    fn colours(&self) -> Colours {
        Colours::Kinds
    }

    /// [`Self::resolve`] with the style.
    fn planned(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let style = checked_style(self.style(), Some(self.colours()), names);
        let panel = self.resolve(names)?;
        let place = panel.style.clone();
        Some(PlannedPanel { style: style?.or(place), ..panel })
    }
}

/// The style of a panel, or of a figure, whose panels show different things; `None` where something is wrong, which is
/// reported.
pub(crate) fn checked_style(
    source: Option<&Placed<StyleSource>>,
    colours: Option<Colours>,
    names: &mut Names<'_, '_>,
) -> Option<Style> {
    let Some(source) = source else { return Some(Style::default()) };
    let useless = |style: &Style| {
        let (key, expected) = colours.and_then(|colours| style.useless(colours))?;
        Some(format!("`{key}` has no effect here: expected {expected}"))
    };
    let single = source
        .of_single_pictures()
        .map(|key| format!("`{key}` has no effect in experiments: expected it in a style file"));
    match source.style() {
        Err(problem) => names.fault(source.place(), &problem),
        Ok(style) => match single.or_else(|| useless(&style)) {
            None => return Some(style),
            Some(problem) => names.fault(source.place(), &problem),
        },
    }
    None
}

/// A panel, ready to be drawn.
pub(crate) struct PlannedPanel {
    /// Heading.
    pub(crate) title: String,
    pub(crate) picture: Picture,
    /// Curves that are written as a table, too.
    pub(crate) curves: Option<Curves>,
    /// Whether it shows seconds, which are others in every run.
    pub(crate) is_timed: bool,
    /// Names of the curves in the legend, if it is a chart.
    pub(crate) series: Vec<String>,
    /// For each curve, which colour and marker it has: the same for one name in all charts of an experiment.
    pub(crate) markings: Vec<usize>,
    /// How it is to look, and where what it shows lies.
    pub(crate) style: Style,
}

impl PlannedPanel {
    /// A panel that a closure draws.
    pub(crate) fn new(
        title: &str,
        picture: impl Fn(&Drawing<'_>) -> Result<Scene, Unavailable> + Send + Sync + 'static,
    ) -> Self {
        Self {
            title: title.to_owned(),
            picture: Box::new(picture),
            curves: None,
            is_timed: false,
            series: Vec::new(),
            markings: Vec::new(),
            style: Style::default(),
        }
    }

    /// The panel where what it shows lies.
    pub(crate) fn placed(self, place: Style) -> Self {
        Self { style: place, ..self }
    }
}

/// A curve of a chart.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve {
    /// Name in the legend.
    pub(crate) label: String,
    pub(crate) points: Vec<(f64, f64)>,
    /// How its points are shown.
    pub(crate) look: Look,
}

/// How the points of a curve are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// A formula: a line without markers.
    Line,
    /// Values at places that follow each other: a line, and markers where there are few.
    Joined,
    /// Single values: markers alone, since nothing is known between them.
    Marks,
}

/// Width of a panel among others, pixels.
pub(crate) const PANEL_PX: usize = 330;

/// What a panel is drawn of and where.
pub(crate) struct Drawing<'a> {
    pub(crate) results: &'a Results<'a>,
    /// Whether the panel is the whole figure.
    pub(crate) alone: bool,
    /// Heading within the picture: empty among others, where it stands above.
    pub(crate) title: String,
    /// For each curve of a chart, which colour and marker it has.
    pub(crate) markings: &'a [usize],
    style: Style,
}

impl<'a> Drawing<'a> {
    /// Of a panel of a figure, in its style; axes are marked with cells unless it says otherwise.
    pub(crate) fn new(
        results: &'a Results<'a>,
        (alone, title): (bool, String),
        style: Style,
        markings: &'a [usize],
    ) -> Self {
        let cells = Style { numbers: Some(AxisNumbers::Cells), ..Style::default() };
        Self { results, alone, title, markings, style: style.or(cells) }
    }

    /// How the panel looks.
    pub(crate) fn style(&self) -> Style {
        self.style.clone()
    }

    /// Pixels per cell: chosen by the picture where it stands alone, fitting a panel otherwise.
    pub(crate) fn cell_px(&self, grid: Grid) -> Option<usize> {
        self.cell_px_of(grid, CellShape::SQUARE)
    }

    /// The same for the smaller side of cells that need not be square.
    pub(crate) fn cell_px_of(&self, grid: Grid, cell: CellShape) -> Option<usize> {
        let longest = cell.longer_side([grid.width(), grid.height()]);
        (!self.alone).then(|| (PANEL_PX / longest.ceil() as usize).max(2))
    }

    /// A scalar of a gradient in colours.
    pub(crate) fn gradient_map(
        &self,
        scalar: &Field<f64>,
        of: &Outcome,
        which: gradient::Scalar,
        (above, added): (Vec<Overlay>, &PlannedAdditions),
    ) -> Result<Scene, Unavailable> {
        let mut shown = gradient::where_result(scalar, of.surfaces.as_ref());
        of.masked.iter().for_each(|cell| shown.values_mut()[scalar.grid().index(*cell)] = f64::NAN);
        let scalars = Scalars { values: &shown, samples: 1 };
        let additions = added.over(self.results, Some(scalars))?;
        let thin = of.thin.iter().map(ThinCells::overlay);
        let overlays = thin.chain(above).chain(additions.overlays).collect();
        let options = HeatOptions {
            title: self.title.clone(),
            walls: of.surfaces.clone(),
            overlays,
            glyphs: additions.glyphs,
            cell_px: self.cell_px(scalar.grid()),
            masked: of.masked.clone(),
            style: self.style(),
            ..HeatOptions::default()
        };
        Ok(gradient::picture(scalar, which, options))
    }
}

/// Chooses colours and markers of curves: those of one name look alike in all charts of an experiment, the others take
/// what is left in theirs.
pub(crate) fn series_styles<'a>(panels: impl Iterator<Item = &'a mut PlannedPanel>) {
    let mut charts: Vec<&mut PlannedPanel> = panels.filter(|p| !p.series.is_empty()).collect();
    let series: Vec<Vec<String>> = charts.iter().map(|c| c.series.clone()).collect();
    let is_shared = |name: &str| series.iter().filter(|names| names.iter().any(|n| n == name)).count() > 1;
    let mut known: Vec<(String, usize)> = Vec::new();
    for chart in &mut charts {
        let style_of =
            |known: &[(String, usize)], name: &str| known.iter().find(|k| k.0 == name).map(|k| k.1);
        let mut taken: Vec<usize> = chart.series.iter().filter_map(|name| style_of(&known, name)).collect();
        for name in &chart.series {
            let style = style_of(&known, name).unwrap_or_else(|| {
                let free = (0..).find(|style| !taken.contains(style)).unwrap_or(0);
                taken.push(free);
                free
            });
            if is_shared(name) && style_of(&known, name).is_none() {
                known.push((name.clone(), style));
            }
            chart.markings.push(style);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn styles(charts: &[&[&str]]) -> Vec<Vec<usize>> {
        let panel = |names: &&[&str]| {
            let drawn = PlannedPanel::new("", |_| Ok(Scene::sized(1.0, 1.0)));
            PlannedPanel { series: names.iter().map(|n| (*n).to_owned()).collect(), ..drawn }
        };
        let mut panels: Vec<PlannedPanel> = charts.iter().map(panel).collect();
        series_styles(panels.iter_mut());
        panels.into_iter().map(|p| p.markings).collect()
    }

    #[test]
    fn curves_of_one_name_look_alike_in_all_charts() {
        let found = styles(&[&["1/r", "flux", "lobe"], &["flux", "lobe", "other"], &["a", "b"]]);
        assert_eq!(found, [vec![0, 1, 2], vec![1, 2, 0], vec![0, 1]]);
        // One that comes later keeps away from those that are there.
        assert_eq!(styles(&[&["a", "b"], &["new", "b"]]), [vec![0, 1], vec![0, 1]]);
    }
}
