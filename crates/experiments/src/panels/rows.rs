//! Numbers of named rows.

use crate::names::Names;
use crate::panels::chart::{Axis, curves};
use crate::panels::kind::{Curve, Curves, PanelKind, PlannedPanel};
use crate::panels::series::SeriesSource;
use serde::Deserialize;
use std::sync::Arc;
use tigereye_render::{RowChart, Series, row_chart};

/// Numbers of named rows on a common axis, a marker for each series.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Rows {
    /// Names of the rows, from the top.
    rows: Vec<String>,
    /// The horizontal axis.
    value: Axis,
    /// The numbers: x of a point is the number of its row, from 1, and y its value.
    series: Vec<SeriesSource>,
    /// Heading of the panel.
    title: String,
}

impl PanelKind for Rows {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let series = self.series.iter().map(|s| s.resolve(names)).collect::<Option<Vec<_>>>()?;
        let is_timed = series.iter().any(|s| s.is_timed);
        let labels = series.iter().map(|s| s.label.clone()).collect();
        let series = Arc::new(series);
        let (rows, value) = (self.rows.clone(), self.value.drawn());
        let of_picture = Arc::clone(&series);
        let picture = PlannedPanel::new(&self.title, move |drawing| {
            let drawn = curves(&of_picture, drawing.results)?.into_iter().enumerate();
            let series = drawn.map(|(i, Curve { label, points, .. })| {
                let style = drawing.markings.get(i).copied();
                Series { label, points, line: false, markers: true, style, ..Series::default() }
            });
            let (title, rows, value) = (drawing.title.clone(), rows.clone(), value.clone());
            Ok(row_chart(&RowChart { title, rows, value, series: series.collect(), ..RowChart::default() }))
        });
        let table: Curves = Box::new(move |results| curves(&series, results));
        Some(PlannedPanel { curves: Some(table), is_timed, series: labels, ..picture })
    }
}
