//! One direction of a gradient.

use crate::form::{Chosen, Finite, Placed, StyleSource};
use crate::names::Names;
use crate::numerics::gradient::ridge_columns;
use crate::panels::additions::{PlannedAdditions, Shown};
use crate::panels::kind::{PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_core::{Field, Point};
use tigereye_render::{Colours, Overlay};
use tigereye_views::added::Added;
use tigereye_views::gradient::Scalar;

/// Columns between neighbouring rows beyond which a ridge line is broken.
const LARGEST_JUMP: f64 = 2.0;

/// Rows that a ridge line has at the least: fewer are chance.
const FEWEST_ROWS: usize = 5;

/// One direction of a gradient.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Slice {
    /// Name of the gradient run.
    run: Placed<String>,
    /// Direction, degrees.
    deg: Placed<Finite>,
    /// Whether the maximum of every row is marked.
    #[serde(default)]
    ridge: bool,
    /// Heading of the panel.
    title: String,
    /// What is drawn over it, as `--overlay` of commands.
    #[serde(default)]
    overlays: Option<Placed<Vec<Chosen<Added>>>>,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

impl PanelKind for Slice {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn colours(&self) -> Colours {
        Colours::Values
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let slice = names.slice(&self.run, &self.deg)?;
        let marks_ridge = self.ridge;
        let of = names.field_of(slice.gradient.0);
        let added = PlannedAdditions::resolve(&self.overlays, of, Shown::Scalar, names)?;
        let place = names.place(slice.gradient.0);
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let scalar = drawing.results.slice(slice)?;
            let overlays = if marks_ridge { vec![ridge_line(&scalar)] } else { Vec::new() };
            let gradient = &drawing.results[slice.gradient];
            drawing.gradient_map(&scalar, gradient, Scalar::Slice, (overlays, &added))
        });
        Some(panel.placed(place))
    }
}

fn ridge_line(slice: &Field<f64>) -> Overlay {
    let ridge = ridge_columns(slice);
    let rows: Vec<(usize, f64)> = ridge.iter().enumerate().filter_map(|(y, x)| Some((y, (*x)?))).collect();
    // Where the largest value jumps from row to row there is no ridge to follow.
    let follows = |a: &(usize, f64), b: &(usize, f64)| b.0 == a.0 + 1 && (a.1 - b.1).abs() <= LARGEST_JUMP;
    let lines = rows.chunk_by(follows).filter(|line| line.len() >= FEWEST_ROWS);
    let gap = Point::new(f64::NAN, f64::NAN);
    let points = lines.flat_map(|line| line.iter().map(|(y, x)| Point::new(*x, *y as f64)).chain([gap])).collect();
    Overlay { label: "largest value of each row".to_owned(), points, ..Overlay::default() }
}
