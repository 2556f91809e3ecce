//! Figures from their panels.

use crate::error::ExperimentError;
use crate::panels::{Curve, Drawing, PANEL_PX, PlannedPanel};
use crate::plan::{PlannedAnimation, PlannedFigure};
use crate::results::Results;
use crate::unavailable::Unavailable;
use std::fmt::Write as _;
use tigereye_render::{HeatOptions, PageRect, RenderError, Scene, Style, placed_multiples};
use tigereye_report::{DataFile, Figure, PanelPlace};
use tigereye_views::light;

/// Resolution of the PNG files, pixels per unit.
const PNG_SCALE: f64 = 1.15;

/// A figure with the tables behind its charts, and its animation.
pub(crate) struct Drawn {
    pub(crate) figure: Figure,
    pub(crate) tables: Vec<DataFile>,
}

pub(crate) fn draw(
    figure: &PlannedFigure,
    slug: &str,
    results: &Results<'_>,
) -> Result<Drawn, ExperimentError> {
    let failed =
        |source| ExperimentError::Figure { slug: slug.to_owned(), figure: figure.name.clone(), source };
    let mut panels = Vec::new();
    let mut tables = Vec::new();
    for panel in &figure.panels {
        let undrawn = |source: Unavailable| ExperimentError::Panel {
            slug: slug.to_owned(),
            figure: figure.name.clone(),
            panel: panel.title.clone(),
            source,
        };
        panels.push((panel.title.clone(), scene(panel, figure, results).map_err(undrawn)?));
        if let Some(curves) = &panel.curves {
            let name = match tables.len() {
                0 => figure.name.clone(),
                n => format!("{}-{}", figure.name, n + 1),
            };
            tables.push(table(&name, &curves(results).map_err(undrawn)?));
        }
    }
    let alt: Vec<String> = panels.iter().map(|(t, s)| format!("{t}. {}", s.description)).collect();
    let mut frames = 0;
    if let Some(encoded) = figure.animation.as_ref().and_then(|a| animation(a, &figure.style, results)) {
        let (bytes, count) = encoded.map_err(failed)?;
        tables.push(DataFile { name: format!("{}.apng", figure.name), bytes });
        frames = count;
    }
    let (mut scene, places) = match panels.len() {
        1 => (panels.remove(0).1, Vec::new()),
        _ => placed_multiples(&panels, figure.columns.clamp(1, panels.len().max(1)), ""),
    };
    let panel = |(place, alt): (&PageRect, &String)| {
        let PageRect { x_px, y_px, width_px, height_px } = *place;
        PanelPlace { x_px, y_px, width_px, height_px, alt: alt.clone() }
    };
    let places = places.iter().zip(&alt).map(panel).collect();
    scene.title.clone_from(&figure.caption);
    scene.description = alt.join(" ");
    let figure = Figure {
        timed: figure.panels.iter().any(|panel| panel.is_timed),
        frames,
        panels: places,
        name: figure.name.clone(),
        caption: figure.caption.clone(),
        alt: scene.description.clone(),
        width_px: scene.width_px,
        height_px: scene.height_px,
        png: scene.to_png(PNG_SCALE).map_err(failed)?,
        svg: scene.to_svg().map_err(failed)?,
    };
    Ok(Drawn { figure, tables })
}

/// A panel; among others its heading stands above it.
fn scene(panel: &PlannedPanel, figure: &PlannedFigure, results: &Results<'_>) -> Result<Scene, Unavailable> {
    let alone = figure.panels.len() == 1;
    let title = if alone { panel.title.clone() } else { String::new() };
    let style = panel.style.clone().or(figure.style.clone());
    (panel.picture)(&Drawing::new(results, (alone, title), style, &panel.markings))
}

/// Frames of a run of light and their number; `None` where nothing was kept.
fn animation(
    animation: &PlannedAnimation,
    style: &Style,
    results: &Results<'_>,
) -> Option<Result<(Vec<u8>, usize), RenderError>> {
    let run = &results[animation.light];
    let reel = run.reel.as_ref()?;
    let grid = run.last.grid();
    let options = HeatOptions {
        sources: run.sources.clone(),
        walls: run.surfaces.clone(),
        cell_px: Some((PANEL_PX / grid.width().max(grid.height())).max(2)),
        masked: run.masked.clone(),
        style: style.clone(),
        ..light::options(None)
    };
    let decades = animation.decades.unwrap_or(light::DECADES);
    Some(reel.encoded(&options, decades, animation.every))
}

/// The points of a chart as comma-separated values.
fn table(name: &str, curves: &[Curve]) -> DataFile {
    let mut text = String::from("series,x,y\n");
    for Curve { label, points, .. } in curves {
        for (x, y) in points {
            let quoted = label.replace('"', "\"\"");
            // Writing to a string cannot fail.
            let _ = writeln!(text, "\"{quoted}\",{x:?},{y:?}");
        }
    }
    DataFile { name: format!("{name}.csv"), bytes: text.into_bytes() }
}
