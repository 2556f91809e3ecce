//! Numbers of named rows as markers on a common axis.

use crate::axis::Tick;
use crate::chart::{ChartAxis, Series, colour, fitted, marker};
use crate::colour::Rgba;
use crate::font;
use crate::legend::{self, Entry, Mark, SMALL_PX};
use crate::map_frame::{MARGIN_PX, TITLE_PX};
use crate::scene::{Anchor, PathBuilder, Scene};

const ROW_PX: f64 = 24.0;
const MARKER_PX: f64 = 4.2;

/// Data and appearance of a chart of named rows.
#[derive(Debug, Clone, PartialEq)]
pub struct RowChart {
    /// Title; may be empty.
    pub title: String,
    /// Names of the rows, from the top.
    pub rows: Vec<String>,
    /// The horizontal axis.
    pub value: ChartAxis,
    /// Series; the first number of a point is its row, from 1, the second its value.
    pub series: Vec<Series>,
    /// Width of the picture in pixels, 200 to 4000.
    pub width_px: f64,
}

impl Default for RowChart {
    fn default() -> Self {
        let (title, rows, value, series) = (String::new(), Vec::new(), ChartAxis::default(), Vec::new());
        Self { title, rows, value, series, width_px: 640.0 }
    }
}

/// The chart with its rows below each other and a legend under the axis. Points that no row has, or that the axis
/// cannot show, are left out.
#[must_use]
pub fn row_chart(chart: &RowChart) -> Scene {
    let width = if chart.width_px.is_finite() { chart.width_px.clamp(200.0, 4000.0) } else { 640.0 };
    let fits = |v: f64| v.is_finite() && (!chart.value.logarithmic || v > 0.0);
    let values = chart.series.iter().flat_map(|s| &s.points).map(|p| p.1).filter(|v| fits(*v));
    let axis = fitted(&chart.value, values, true);
    let names = chart.rows.iter().map(|r| font::text_width(r, SMALL_PX)).fold(0.0, f64::max);
    let left = MARGIN_PX + names.min(0.45 * width) + 10.0;
    let inner = width - left - MARGIN_PX - 10.0;
    let mut scene = Scene::sized(width, MARGIN_PX);
    for line in font::wrapped(&chart.title, TITLE_PX, width - 2.0 * MARGIN_PX) {
        scene.text([MARGIN_PX, scene.height_px + 13.0], &line, TITLE_PX, Rgba::INK, Anchor::Start);
        scene.height_px += 24.0;
    }
    let top = scene.height_px;
    let bottom = top + ROW_PX * chart.rows.len() as f64;
    let x = |value: f64| left + inner * axis.position(value);
    let y = |row: usize| top + ROW_PX * (row as f64 + 0.5);
    for Tick { value, label } in axis.ticks((inner / 75.0) as usize) {
        let mut line = PathBuilder::default();
        line.line([x(value), top], [x(value), bottom]);
        scene.stroke(line.finish(), Rgba::HAIRLINE, 0.75);
        scene.text([x(value), bottom + 15.0], &label, SMALL_PX, Rgba::MUTED, Anchor::Middle);
    }
    for (row, name) in chart.rows.iter().enumerate() {
        let mut line = PathBuilder::default();
        line.line([left, y(row)], [left + inner, y(row)]);
        scene.stroke(line.finish(), Rgba::hex(0xf0f0f0), 0.75);
        let baseline = y(row) + 0.5 * font::CAP_HEIGHT_EM * SMALL_PX;
        scene.text([left - 8.0, baseline], name, SMALL_PX, Rgba::INK, Anchor::End);
    }
    let mut entries = Vec::new();
    for (i, series) in chart.series.iter().enumerate() {
        for &(row, value) in series.points.iter().filter(|p| fits(p.1)) {
            let row = (1..=chart.rows.len()).find(|n| *n as f64 == row);
            if let Some(row) = row.filter(|_| (-1e-9..=1.0 + 1e-9).contains(&axis.position(value))) {
                marker(series, i).draw(&mut scene, [x(value), y(row - 1)], MARKER_PX, colour(series, i));
            }
        }
        if !series.label.is_empty() {
            entries.push(Entry::of(Mark::Point(marker(series, i), colour(series, i)), series.label.clone()));
        }
    }
    scene.height_px = bottom + 22.0;
    if !chart.value.label.is_empty() {
        let at = [left + 0.5 * inner, scene.height_px + 10.0];
        scene.text(at, &chart.value.label, SMALL_PX, Rgba::INK, Anchor::Middle);
        scene.height_px += 18.0;
    }
    let row = legend::flow(&entries, width - left - MARGIN_PX);
    let (height, place) = (row.height_px, scene.height_px + 2.0);
    scene.place(row, left, place, 1.0);
    scene.height_px = place + height + 0.5 * MARGIN_PX;
    scene.title.clone_from(&chart.title);
    scene.description = description(chart);
    scene
}

fn description(chart: &RowChart) -> String {
    let names: Vec<&str> = chart.series.iter().map(|s| s.label.as_str()).filter(|l| !l.is_empty()).collect();
    let scale = if chart.value.logarithmic { "logarithmic" } else { "linear" };
    let what = if chart.value.label.is_empty() { "values" } else { &chart.value.label };
    format!("Chart of {what} ({scale}) of {}; series: {}.", chart.rows.join(", "), names.join(", "))
}
