//! Curves over a number.

use crate::names::Names;
use crate::panels::kind::{Curve, Curves, Look, PanelKind, PlannedPanel};
use crate::panels::series::{PlannedSeries, SeriesSource};
use crate::results::Results;
use crate::unavailable::Unavailable;
use serde::Deserialize;
use std::sync::Arc;
use tigereye_render::{ChartAxis, Series, line_chart};

/// Points of a curve that are marked at most.
const MARKED: usize = 60;

/// Curves plotted against a number.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Chart {
    /// Horizontal axis.
    x: Axis,
    /// Vertical axis.
    y: Axis,
    /// The curves.
    series: Vec<SeriesSource>,
    /// Heading of the panel.
    title: String,
}

/// An axis of a chart.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Name and unit.
    label: String,
    /// Whether it is logarithmic.
    #[serde(default)]
    logarithmic: bool,
}

impl Axis {
    pub(super) fn drawn(&self) -> ChartAxis {
        ChartAxis { label: self.label.clone(), logarithmic: self.logarithmic, range: None }
    }
}

impl PanelKind for Chart {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let series = self.series.iter().map(|s| s.resolve(names)).collect::<Option<Vec<_>>>()?;
        let is_timed = series.iter().any(|s| s.is_timed);
        let labels = series.iter().map(|s| s.label.clone()).collect();
        let series = Arc::new(series);
        let (x, y) = (self.x.drawn(), self.y.drawn());
        let of_picture = Arc::clone(&series);
        let picture = PlannedPanel::new(&self.title, move |drawing| {
            let drawn = curves(&of_picture, drawing.results)?.into_iter().enumerate().map(|(i, curve)| {
                let Curve { label, points, look } = curve;
                let line = look != Look::Marks;
                let markers = !line || (look == Look::Joined && points.len() <= MARKED);
                let style = drawing.markings.get(i).copied();
                Series { label, points, line, markers, style, ..Series::default() }
            });
            let series = drawn.collect();
            let (title, x, y) = (drawing.title.clone(), x.clone(), y.clone());
            let chart = tigereye_render::Chart { title, x, y, series, ..tigereye_render::Chart::default() };
            Ok(line_chart(&chart)?)
        });
        let table: Curves = Box::new(move |results| curves(&series, results));
        Some(PlannedPanel { curves: Some(table), is_timed, series: labels, ..picture })
    }
}

pub(super) fn curves(series: &[PlannedSeries], results: &Results<'_>) -> Result<Vec<Curve>, Unavailable> {
    series.iter().map(|s| s.curve(results)).collect()
}
