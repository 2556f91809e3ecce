//! Scalar fields as coloured cells with a colour bar.

use crate::axis::Axis;
use crate::colour::{ColourMap, Rgba};
use crate::colour_bar::ColourBar;
use crate::error::RenderError;
use crate::glyphs::over;
use crate::legend::{Entry, Mark};
use crate::map_frame::MapFrame;
use crate::mask;
use crate::number;
use crate::overlay::{self, Overlay};
use crate::ribbon::{self, Ribbon};
use crate::sampling::{Sampling, block_mean};
use crate::scale::HeatScale;
use crate::scene::Scene;
use crate::style::{Style, ValueRange};
use crate::walls;
use tigereye_core::{Cell, CellShape, Field, Surface, Tensor2, math};

/// Options of [`heat_map`].
#[derive(Debug, Clone, PartialEq)]
pub struct HeatOptions {
    /// Title above the map; may be empty.
    pub title: String,
    /// Quantity with its unit, beside the colour bar.
    pub quantity: String,
    /// Colour map; by default viridis, and vik for [`HeatScale::Diverging`].
    pub map: Option<ColourMap>,
    /// Linear, logarithmic or diverging.
    pub scale: HeatScale,
    /// Fixed lower and upper end, to compare pictures; by default that of the values. A diverging scale uses the larger
    /// magnitude. A logarithmic scale uses both ends if they are positive, and then ignores its decades.
    pub range: Option<(f64, f64)>,
    /// Samples per side of a cell, usually 1: one value per cell. With n, a map of W x H cells needs a field of n
    /// (W - 1) + 1 by n (H - 1) + 1 values, of which (i, j) lies at (i/n, j/n) cells; axes, sources and overlays stay
    /// in cells. 0 counts as 1, more than there are as all of them.
    pub samples_a_cell: usize,
    /// Walls of a scene over the map. Values they hide affect neither colours nor legend. With several samples per cell
    /// they are not drawn.
    pub walls: Option<Field<Option<Surface>>>,
    /// Light sources, marked with stars.
    pub sources: Vec<Cell>,
    /// What a star marks, in the singular.
    pub source_name: &'static str,
    /// What cells below a logarithmic scale are called; `None` for "no light".
    pub dark_name: Option<&'static str>,
    /// Tensors drawn as ellipses over the map, if there are as many as cells.
    pub glyphs: Option<Field<Tensor2>>,
    /// Bands over the map.
    pub ribbons: Vec<Ribbon>,
    /// Points and lines over the map and its bands.
    pub overlays: Vec<Overlay>,
    /// Pixels of a cell's smaller side; by default a whole number such that the longer side of the map has about 480.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
    /// A remark for the legend.
    pub note: Option<String>,
    /// Label in the legend for cells whose value is NaN; by default `not a finite number`.
    pub missing: Option<String>,
    /// Cells without a tensor, drawn grey. Their values affect neither colours nor legend.
    pub masked: Vec<Cell>,
    /// What of all this is chosen otherwise.
    pub style: Style,
}

impl Default for HeatOptions {
    fn default() -> Self {
        Self {
            title: String::new(),
            quantity: String::new(),
            map: None,
            scale: HeatScale::default(),
            range: None,
            samples_a_cell: 1,
            walls: None,
            sources: Vec::new(),
            source_name: "light source",
            dark_name: None,
            glyphs: None,
            ribbons: Vec::new(),
            overlays: Vec::new(),
            cell_px: None,
            cell: CellShape::SQUARE,
            note: None,
            missing: None,
            masked: Vec::new(),
            style: Style::default(),
        }
    }
}

/// The field as a heat map. Values that are not finite are grey and hatched and named in the legend; a field without
/// any finite value is drawn and described as such.
#[must_use]
pub fn heat_map(field: &Field<f64>, options: &HeatOptions) -> Scene {
    let sampling = Sampling::of(field.grid(), [options.samples_a_cell; 2]);
    let grid = sampling.cells;
    let walls = options.walls.as_ref().filter(|walls| walls.grid() == field.grid());
    let masked = mask::within(&options.masked, grid);
    let seen = seen_values(field, walls, &masked, sampling.per_cell);
    let summary = Summary::of(&seen);
    let scale = options.style.scale.unwrap_or(options.scale);
    let chosen = options.style.range.or(options.range.map(|(low, high)| ValueRange::Values(low, high)));
    let positive = matches!(scale, HeatScale::Logarithmic { .. });
    let axis = chosen_axis(&summary, scale, chosen.and_then(|range| range.ends(&seen, positive)));
    let quantity = options.style.quantity.as_ref().unwrap_or(&options.quantity);
    let map = options.style.map.or(options.map).unwrap_or(match scale {
        HeatScale::Diverging => ColourMap::Vik,
        _ => ColourMap::Viridis,
    });
    // With a fixed range the bottom of a logarithmic scale is not tied to the values.
    let bar = ColourBar {
        axis,
        map,
        label: quantity,
        below: summary.finite > 0 && !axis.logarithmic && axis.position(summary.low) < -1e-9,
        above: summary.finite > 0 && axis.position(summary.high) > 1.0 + 1e-9,
    };
    let cell = sampling.cell_px(options.cell, options.cell_px);
    let titled = (&options.style, options.title.as_str());
    let mut page = MapFrame::begin(grid, titled, cell, &|height| bar.width(height));
    let block = sampling.block(&page);
    let colour = |first| cell_colour(block_mean(field, first, block), &axis, map);
    page.scene.items.push(sampling.raster(&page, colour));
    let is_hatched = page.hatch(&sampling.cells_where(|sample| !field.at(sample).is_finite()));
    mask::draw(&mut page, &masked);
    let names = [options.missing.as_deref(), options.dark_name];
    let mut legend = value_legend(&seen, &summary, &axis, (names, is_hatched), &sampling);
    mask::explain(&masked, &options.style, &mut legend);
    if let Some(text) = sampling.mean_in_words(block) {
        legend.push(Entry::of(Mark::None, text));
    }
    legend.extend(options.note.as_ref().map(|note| Entry::of(Mark::None, note.clone())));
    if let Some(walls) = walls {
        walls::draw(&mut page, walls, &mut legend);
    }
    over::draw(&mut page, options.glyphs.as_ref(), &mut legend);
    ribbon::draw(&mut page, &options.ribbons, &mut legend);
    overlay::draw(&mut page, &options.overlays, &mut legend);
    overlay::draw_sources(&mut page, &options.sources, options.source_name, &mut legend);
    let (edge, top, height) = (page.left + page.width(), page.top, page.side_height());
    bar.draw(&mut page.scene, edge, top, height);
    page.finish(description(&sampling, &summary, scale, quantity), &legend)
}

/// The values that neither a wall nor the mask hides.
fn seen_values(
    field: &Field<f64>,
    walls: Option<&Field<Option<Surface>>>,
    masked: &Field<bool>,
    [m, n]: [usize; 2],
) -> Vec<f64> {
    let hidden = |c: Cell| {
        let nearest = Cell::new((c.x + m / 2) / m, (c.y + n / 2) / n);
        walls.is_some_and(|w| w.at(c).as_ref().is_some_and(Surface::is_wall))
            || (masked.grid().contains(nearest) && *masked.at(nearest))
    };
    field.iter().filter(|(cell, _)| !hidden(*cell)).map(|(_, v)| *v).collect()
}

/// The comparison of [`difference_map`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Difference {
    /// `a - b`.
    #[default]
    Absolute,
    /// `a / b - 1`; NaN where both are 0.
    Relative,
}

/// A diverging heat map of the difference of two fields. `options.scale` is set to [`HeatScale::Diverging`].
///
/// # Errors
/// [`RenderError::GridMismatch`].
pub fn difference_map(
    a: &Field<f64>,
    b: &Field<f64>,
    kind: Difference,
    options: &HeatOptions,
) -> Result<Scene, RenderError> {
    if a.grid() != b.grid() {
        let (g, h) = (a.grid(), b.grid());
        return Err(RenderError::GridMismatch {
            a_width: g.width(),
            a_height: g.height(),
            b_width: h.width(),
            b_height: h.height(),
        });
    }
    let field = Field::from_fn(a.grid(), |c| match kind {
        Difference::Absolute => a.at(c) - b.at(c),
        Difference::Relative => a.at(c) / b.at(c) - 1.0,
    });
    Ok(heat_map(&field, &HeatOptions { scale: HeatScale::Diverging, ..options.clone() }))
}

/// Statistics of the values of a field.
pub(crate) struct Summary {
    pub(crate) finite: usize,
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Smallest positive value, infinite if there is none.
    low_positive: f64,
}

impl Summary {
    pub(crate) fn of(values: &[f64]) -> Self {
        let mut s =
            Self { finite: 0, low: f64::INFINITY, high: f64::NEG_INFINITY, low_positive: f64::INFINITY };
        for &v in values.iter().filter(|v| v.is_finite()) {
            s.finite += 1;
            s.low = s.low.min(v);
            s.high = s.high.max(v);
            if v > 0.0 {
                s.low_positive = s.low_positive.min(v);
            }
        }
        s
    }
}

fn chosen_axis(summary: &Summary, scale: HeatScale, fixed: Option<(f64, f64)>) -> Axis {
    let (low, high) = if summary.finite == 0 { (0.0, 1.0) } else { (summary.low, summary.high) };
    match (scale, fixed) {
        (HeatScale::Linear, _) => {
            let (low, high) = fixed.unwrap_or((low, high));
            Axis::linear(low, high)
        }
        (HeatScale::Diverging, _) => {
            let (low, high) = fixed.unwrap_or((low, high));
            let reach = low.abs().max(high.abs());
            if reach > Axis::TINY { Axis::linear(-reach, reach) } else { Axis::linear(-1.0, 1.0) }
        }
        (HeatScale::Logarithmic { .. }, Some((low, high))) if low > 0.0 => Axis::logarithmic(low, high),
        (HeatScale::Logarithmic { decades }, _) => {
            let top = fixed.map_or(high, |(_, high)| high);
            let top = if top > 0.0 { top } else { 1.0 };
            let decades = if decades > 0.0 { decades.min(300.0) } else { 6.0 };
            Axis::logarithmic(top * math::pow(10.0, -decades), top)
        }
    }
}

fn cell_colour(value: f64, axis: &Axis, map: ColourMap) -> Rgba {
    if !value.is_finite() {
        return Rgba::NOT_FINITE;
    }
    if axis.logarithmic && value < axis.low {
        return Rgba::NO_LIGHT;
    }
    map.sample(axis.position(value))
}

fn value_legend(
    values: &[f64],
    summary: &Summary,
    axis: &Axis,
    ([missing, dark_name], is_hatched): ([Option<&str>; 2], bool),
    sampling: &Sampling,
) -> Vec<Entry> {
    let dark_name = dark_name.unwrap_or("no light");
    let mut legend = Vec::new();
    if axis.logarithmic && values.iter().any(|v| v.is_finite() && *v < axis.low) {
        let negative = values.iter().any(|v| v.is_finite() && *v < 0.0);
        let text = format!(
            "{dark_name}: {} or below {}",
            if negative { "0, negative" } else { "0" },
            number::significant(axis.low, 2)
        );
        legend.push(Entry::of(Mark::Swatch(Rgba::NO_LIGHT), text));
    }
    let broken = values.len() - summary.finite;
    if broken > 0 {
        let text = missing.map_or_else(
            || format!("not a finite number ({broken} of {} {})", values.len(), sampling.places()),
            ToOwned::to_owned,
        );
        legend.push(Entry::of(Mark::broken(is_hatched), text));
    }
    if summary.finite == 0 {
        legend.push(Entry::of(Mark::None, "The field has no finite value."));
    } else if summary.low == summary.high {
        legend.push(Entry::of(Mark::None, format!("constant value {}", number::significant(summary.low, 4))));
    }
    legend
}

fn description(sampling: &Sampling, summary: &Summary, scale: HeatScale, quantity: &str) -> String {
    let scale = match scale {
        HeatScale::Linear => "linear",
        HeatScale::Logarithmic { .. } => "logarithmic",
        HeatScale::Diverging => "diverging",
    };
    let quantity = if quantity.is_empty() { "values" } else { quantity };
    let range = if summary.finite == 0 {
        "no finite value".to_owned()
    } else {
        format!("from {} to {}", number::significant(summary.low, 4), number::significant(summary.high, 4))
    };
    format!("Heat map of {quantity} on {}, row 0 on top, {scale} colour scale; {range}.", sampling.in_words())
}
