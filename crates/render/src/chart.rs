//! Line charts.

use crate::axis::{Axis, Tick};
use crate::chart_backend::{Canvas, SceneBackend, UNITS};
use crate::colour::{Rgba, SERIES_PALETTE};
use crate::error::RenderError;
use crate::font;
use crate::legend::{self, Entry, Mark, SMALL_PX};
use crate::map_frame::{MARGIN_PX, TITLE_PX};
use crate::scene::{Anchor, PagePoint, Scene};
use crate::shapes::Marker;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

/// One axis of a [`Chart`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChartAxis {
    /// Quantity with its unit.
    pub label: String,
    /// Powers of ten instead of equal steps. Points at 0 or below are left out, and the legend says so.
    pub logarithmic: bool,
    /// Fixed range; by default that of the points.
    pub range: Option<(f64, f64)>,
}

/// One data series. Points that are not finite interrupt its line.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name for the legend; a series without one does not appear there.
    pub label: String,
    /// Points (x, y) in the units of the axes, in the order in which they are joined.
    pub points: Vec<(f64, f64)>,
    /// Whether points are joined.
    pub line: bool,
    /// Whether points are marked. Along a line of many points only some are, to tell series apart.
    pub markers: bool,
    /// Colour; by default the next of [`SERIES_PALETTE`].
    pub colour: Option<Rgba>,
    /// Its place among the series of several charts, which decides on colour, marker and dashes; by default that in
    /// this chart.
    pub style: Option<usize>,
    /// Dashes and gaps in pixels, empty for a solid line; by default solid for the first series, dashed for the next
    /// ones that have no markers.
    pub dash_px: Option<Vec<f64>>,
}

impl Default for Series {
    fn default() -> Self {
        Self {
            label: String::new(),
            points: Vec::new(),
            line: true,
            markers: false,
            colour: None,
            style: None,
            dash_px: None,
        }
    }
}

/// A horizontal line to compare with.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reference {
    /// Its position on the y axis.
    pub value: f64,
    /// Meaning, for the legend.
    pub label: String,
}

/// Data and appearance of a line chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title; may be empty.
    pub title: String,
    /// Horizontal axis.
    pub x: ChartAxis,
    /// Vertical axis.
    pub y: ChartAxis,
    /// Series.
    pub series: Vec<Series>,
    /// Horizontal reference lines.
    pub references: Vec<Reference>,
    /// Width of the picture in pixels, 200 to 4000.
    pub width_px: f64,
    /// Height of the picture without its legend in pixels, 160 to 4000.
    pub height_px: f64,
}

impl Default for Chart {
    fn default() -> Self {
        Self {
            title: String::new(),
            x: ChartAxis::default(),
            y: ChartAxis::default(),
            series: Vec::new(),
            references: Vec::new(),
            width_px: 640.0,
            height_px: 400.0,
        }
    }
}

const DASHES: [&[f64]; 4] = [&[], &[6.0, 4.0], &[1.0, 3.5], &[8.0, 3.5, 1.0, 3.5]];
const REFERENCE_DASHES: [&[f64]; 3] = [&[4.0, 4.0], &[1.0, 3.0], &[9.0, 4.0]];
const REFERENCE: Rgba = Rgba::hex(0x777777);

/// The chart with axes, grid lines and a legend below. Without any point that can be drawn it says "no data".
///
/// # Errors
/// [`RenderError::Chart`] if the charting library fails, which no known data cause.
pub fn line_chart(chart: &Chart) -> Result<Scene, RenderError> {
    let width = clamped(chart.width_px, 200.0, 640.0);
    let height = clamped(chart.height_px, 160.0, 400.0);
    let plan = Plan::of(chart, width, height);
    let canvas = Canvas { scene: Scene::sized(width, height), dash_px: Vec::new() };
    let canvas = Rc::new(RefCell::new(canvas));
    plan.draw(chart, &canvas).map_err(|reason| RenderError::Chart { reason })?;
    let mut scene = core::mem::replace(&mut canvas.borrow_mut().scene, Scene::sized(0.0, 0.0));
    let entries = legend_entries(chart, &plan);
    let row = legend::flow(&entries, width - plan.left_px - MARGIN_PX);
    scene.height_px += row.height_px + if entries.is_empty() { 0.0 } else { 0.5 * MARGIN_PX };
    scene.place(row, plan.left_px, height + 2.0, 1.0);
    scene.title.clone_from(&chart.title);
    scene.description = description(chart, &plan);
    Ok(scene)
}

fn clamped(px: f64, least: f64, otherwise: f64) -> f64 {
    if px.is_finite() { px.clamp(least, 4000.0) } else { otherwise }
}

type Plot<'a> = ChartContext<'a, SceneBackend, Cartesian2d<UnitAxis, UnitAxis>>;

/// Everything decided before drawing. Positions run from 0 to 1 along both axes.
struct Plan {
    left_px: f64,
    title: Vec<String>,
    x: UnitAxis,
    y: UnitAxis,
    /// Per series: connected runs of positions.
    runs: Vec<Vec<Vec<(f64, f64)>>>,
    /// Per series: points that a logarithmic axis cannot show.
    not_positive: Vec<usize>,
}

impl Plan {
    fn of(chart: &Chart, width: f64, height: f64) -> Self {
        let drawable: Vec<(f64, f64)> =
            chart.series.iter().flat_map(|s| s.points.iter().copied()).filter(|p| fits(*p, chart)).collect();
        let x = fitted(&chart.x, drawable.iter().map(|p| p.0), false);
        let references = chart.references.iter().map(|r| r.value).filter(|_| !drawable.is_empty());
        let y = fitted(&chart.y, drawable.iter().map(|p| p.1).chain(references), true);
        let y = UnitAxis::of(y, ((height - 90.0) / 45.0) as usize);
        let x = UnitAxis::of(x, ((width - 80.0) / 75.0) as usize);
        let labels = y.ticks.iter().map(|t| font::text_width(&t.1, SMALL_PX)).fold(0.0, f64::max);
        let name = if chart.y.label.is_empty() { 0.0 } else { 20.0 };
        let left_px = MARGIN_PX + name + labels + 12.0;
        let title = font::wrapped(&chart.title, TITLE_PX, width - left_px - MARGIN_PX);
        let runs = chart.series.iter().map(|s| visible_runs(s, chart, &x.axis, &y.axis)).collect();
        let hidden = |p: &&(f64, f64)| p.0.is_finite() && p.1.is_finite() && !fits(**p, chart);
        let not_positive = chart.series.iter().map(|s| s.points.iter().filter(hidden).count()).collect();
        Self { left_px, title, x, y, runs, not_positive }
    }

    fn draw(&self, chart: &Chart, canvas: &Rc<RefCell<Canvas>>) -> Result<(), String> {
        let said = |e: DrawingAreaErrorKind<core::convert::Infallible>| e.to_string();
        let root = SceneBackend(Rc::clone(canvas)).into_drawing_area();
        let units = |px: f64| (px * f64::from(UNITS)).round() as i32;
        let title_px = 20.0 * self.title.len() as f64 + if self.title.is_empty() { 0.0 } else { 4.0 };
        let below_px = if chart.x.label.is_empty() { 22.0 } else { 36.0 };
        let mut plot = ChartBuilder::on(&root)
            .margin_left(units(MARGIN_PX))
            .margin_right(units(MARGIN_PX + 4.0))
            .margin_top(units(MARGIN_PX + title_px))
            .margin_bottom(units(8.0))
            .x_label_area_size(units(below_px))
            .y_label_area_size(units(self.left_px - MARGIN_PX))
            .build_cartesian_2d(self.x.clone(), self.y.clone())
            .map_err(said)?;
        let text = |c: Rgba| ("sans-serif", units(SMALL_PX)).into_font().color(&ink(c));
        plot.configure_mesh()
            .bold_line_style(ink(Rgba::HAIRLINE).stroke_width(6))
            .light_line_style(ink(Rgba::hex(0xf0f0f0)).stroke_width(4))
            .axis_style(ink(Rgba::MUTED).stroke_width(6))
            .label_style(text(Rgba::MUTED))
            .axis_desc_style(text(Rgba::INK))
            .set_all_tick_mark_size(units(4.0))
            .x_label_formatter(&|u| self.x.label(*u))
            .y_label_formatter(&|u| self.y.label(*u))
            .x_desc(chart.x.label.as_str())
            .y_desc(chart.y.label.as_str())
            .draw()
            .map_err(said)?;
        self.draw_lines(chart, canvas, &mut plot).map_err(said)?;
        let area = plot.plotting_area();
        let place = |u: f64, v: f64| {
            let (x, y) = area.map_coordinate(&(u, v));
            PagePoint::new(f64::from(x) / f64::from(UNITS), f64::from(y) / f64::from(UNITS))
        };
        self.draw_markers(chart, &mut canvas.borrow_mut().scene, place);
        Ok(())
    }

    fn draw_lines(
        &self,
        chart: &Chart,
        canvas: &Rc<RefCell<Canvas>>,
        plot: &mut Plot<'_>,
    ) -> Result<(), DrawingAreaErrorKind<core::convert::Infallible>> {
        for (i, r) in chart.references.iter().enumerate() {
            let v = self.y.axis.position(r.value);
            if (0.0..=1.0).contains(&v) {
                canvas.borrow_mut().dash_px = REFERENCE_DASHES[i % REFERENCE_DASHES.len()].to_vec();
                let style = ink(REFERENCE).stroke_width(9);
                plot.draw_series(LineSeries::new([(0.0, v), (1.0, v)], style))?;
            }
        }
        for (i, series) in chart.series.iter().enumerate() {
            canvas.borrow_mut().dash_px = dash(series, i);
            for run in self.runs[i].iter().filter(|_| series.line) {
                let style = ink(colour(series, i)).stroke_width(13);
                plot.draw_series(LineSeries::new(run.iter().copied(), style))?;
            }
        }
        canvas.borrow_mut().dash_px.clear();
        Ok(())
    }

    fn draw_markers(&self, chart: &Chart, scene: &mut Scene, place: impl Fn(f64, f64) -> PagePoint) {
        for (i, series) in chart.series.iter().enumerate() {
            let points: Vec<(f64, f64)> =
                series.points.iter().copied().filter(|p| fits(*p, chart)).map(|p| self.position(p)).collect();
            let every = if series.line { points.len().div_ceil(40).max(1) } else { 1 };
            // A single point has no line that would show it.
            let marked = series.markers || points.len() == 1;
            for &(u, v) in points.iter().step_by(every).filter(|_| marked) {
                if inside(u) && inside(v) {
                    marker(series, i).draw(scene, place(u, v), 3.6, colour(series, i));
                }
            }
        }
        if self.runs.iter().all(Vec::is_empty) {
            scene.text(place(0.5, 0.5), "no data", 16.0, Rgba::MUTED, Anchor::Middle);
        }
        for (i, line) in self.title.iter().enumerate() {
            let baseline = MARGIN_PX + 20.0 * i as f64 + 13.0;
            scene.text([self.left_px, baseline], line, TITLE_PX, Rgba::INK, Anchor::Start);
        }
    }

    fn position(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.x.axis.position(x), self.y.axis.position(y))
    }
}

fn ink(c: Rgba) -> RGBAColor {
    RGBAColor(c.r, c.g, c.b, f64::from(c.a) / 255.0)
}

fn inside(u: f64) -> bool {
    (-1e-9..=1.0 + 1e-9).contains(&u)
}

fn fits((x, y): (f64, f64), chart: &Chart) -> bool {
    let fits = |v: f64, axis: &ChartAxis| v.is_finite() && (!axis.logarithmic || v > 0.0);
    fits(x, &chart.x) && fits(y, &chart.y)
}

pub(crate) fn fitted(options: &ChartAxis, values: impl Iterator<Item = f64>, outwards: bool) -> Axis {
    let fixed = options.range.filter(|(a, b)| a.is_finite() && b.is_finite() && a < b);
    if let Some((low, high)) = fixed.filter(|(low, _)| !options.logarithmic || *low > 0.0) {
        return if options.logarithmic { Axis::logarithmic(low, high) } else { Axis::linear(low, high) };
    }
    let usable = values.filter(|v| v.is_finite() && (!options.logarithmic || *v > 0.0));
    let (low, high) = usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if low > high {
        return if options.logarithmic { Axis::logarithmic(0.1, 1.0) } else { Axis::linear(0.0, 1.0) };
    }
    if options.logarithmic {
        let pad = if outwards { 1.3 } else { 1.08 };
        return Axis::logarithmic(low / pad, high * pad);
    }
    let axis = Axis::linear(low, high);
    if outwards {
        return axis.rounded_outwards(6);
    }
    let pad = 0.02 * (axis.high - axis.low);
    Axis::linear(axis.low - pad, axis.high + pad)
}

/// The parts of a series' line within the plot, as positions.
fn visible_runs(series: &Series, chart: &Chart, x: &Axis, y: &Axis) -> Vec<Vec<(f64, f64)>> {
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut previous: Option<(f64, f64)> = None;
    for &p in &series.points {
        let Some(here) = fits(p, chart).then(|| (x.position(p.0), y.position(p.1))) else {
            previous = None;
            continue;
        };
        match previous.map(|before| clipped(before, here)) {
            Some(Some((from, to))) => match runs.last_mut() {
                Some(run) if run.last() == Some(&from) => run.push(to),
                _ => runs.push(vec![from, to]),
            },
            Some(None) => {}
            None if inside(here.0) && inside(here.1) => runs.push(vec![here]),
            None => {}
        }
        previous = Some(here);
    }
    runs
}

/// The part of the line from `a` to `b` within the unit square (Liang and Barsky 1984).
fn clipped(a: (f64, f64), b: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (p, q) in [(-dx, a.0), (dx, 1.0 - a.0), (-dy, a.1), (dy, 1.0 - a.1)] {
        // Rounding may put the ends of the range just outside.
        let q = if q.abs() < 1e-9 { 0.0 } else { q };
        if p == 0.0 && q < 0.0 {
            return None;
        }
        if p < 0.0 {
            enter = enter.max(q / p);
        } else if p > 0.0 {
            leave = leave.min(q / p);
        }
    }
    let at = |t: f64| {
        if t <= 0.0 {
            a
        } else if t >= 1.0 {
            b
        } else {
            (a.0 + t * dx, a.1 + t * dy)
        }
    };
    (enter <= leave).then(|| (at(enter), at(leave)))
}

pub(crate) fn colour(series: &Series, index: usize) -> Rgba {
    series.colour.unwrap_or(SERIES_PALETTE[series.style.unwrap_or(index) % SERIES_PALETTE.len()])
}

fn dash(series: &Series, index: usize) -> Vec<f64> {
    match &series.dash_px {
        Some(dash) if dash.iter().all(|d| d.is_finite() && *d > 0.0) && dash.len() % 2 == 0 => dash.clone(),
        Some(_) => Vec::new(),
        None if series.markers => Vec::new(),
        None => DASHES[series.style.unwrap_or(index) % DASHES.len()].to_vec(),
    }
}

pub(crate) fn marker(series: &Series, index: usize) -> Marker {
    Marker::SERIES[series.style.unwrap_or(index) % Marker::SERIES.len()]
}

fn legend_entries(chart: &Chart, plan: &Plan) -> Vec<Entry> {
    let mut entries = Vec::new();
    for (i, series) in chart.series.iter().enumerate().filter(|(_, s)| !s.label.is_empty()) {
        let colour = colour(series, i);
        let mark = if series.line {
            let marker = series.markers.then(|| marker(series, i));
            Mark::Line { colour, width_px: 1.6, dash_px: dash(series, i), marker }
        } else {
            Mark::Point(marker(series, i), colour)
        };
        let hidden = match plan.not_positive[i] {
            0 => String::new(),
            1 => " (1 point ≤ 0 not shown)".to_owned(),
            n => format!(" ({n} points ≤ 0 not shown)"),
        };
        entries.push(Entry::of(mark, format!("{}{hidden}", series.label)));
    }
    for (i, r) in chart.references.iter().enumerate().filter(|(_, r)| !r.label.is_empty()) {
        let dash_px = REFERENCE_DASHES[i % REFERENCE_DASHES.len()].to_vec();
        let mark = Mark::Line { colour: REFERENCE, width_px: 1.1, dash_px, marker: None };
        entries.push(Entry::of(mark, r.label.clone()));
    }
    entries
}

fn description(chart: &Chart, plan: &Plan) -> String {
    let names: Vec<&str> = chart.series.iter().map(|s| s.label.as_str()).filter(|l| !l.is_empty()).collect();
    let hidden: usize = plan.not_positive.iter().sum();
    let scale = |axis: &ChartAxis| if axis.logarithmic { "logarithmic" } else { "linear" };
    format!(
        "Line chart of {} ({}) over {} ({}); series: {}.{}",
        if chart.y.label.is_empty() { "y" } else { &chart.y.label },
        scale(&chart.y),
        if chart.x.label.is_empty() { "x" } else { &chart.x.label },
        scale(&chart.x),
        if plan.runs.iter().all(Vec::is_empty) { "no data".to_owned() } else { names.join(", ") },
        if hidden > 0 { format!(" {hidden} points at 0 or below are not shown.") } else { String::new() }
    )
}

/// An axis of plotters that runs from 0 to 1 and has its tick marks given.
#[derive(Clone)]
struct UnitAxis {
    axis: Axis,
    /// Position and label.
    ticks: Vec<(f64, String)>,
    minor: Vec<f64>,
}

impl UnitAxis {
    fn of(axis: Axis, count: usize) -> Self {
        let ticks = axis.ticks(count).into_iter().map(|Tick { value, label }| (axis.position(value), label));
        let minor = axis.minor_ticks().into_iter().map(|v| axis.position(v)).collect();
        Self { axis, ticks: ticks.collect(), minor }
    }

    fn label(&self, position: f64) -> String {
        self.ticks.iter().find(|t| t.0 == position).map_or(String::new(), |t| t.1.clone())
    }
}

impl Ranged for UnitAxis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        RangedCoordf64::from(0.0..1.0).map(value, limit)
    }

    fn key_points<H: KeyPointHint>(&self, hint: H) -> Vec<f64> {
        let labelled = self.ticks.iter().map(|t| t.0);
        if hint.weight().allow_light_points() { self.minor.clone() } else { labelled.collect() }
    }

    fn range(&self) -> Range<f64> {
        0.0..1.0
    }
}
