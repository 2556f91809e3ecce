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
    // Where the largest value jumps from row to row there is no ridge to follow.
    let near = |y: usize, other: Option<&Option<f64>>| match (ridge[y], other) {
        (Some(a), Some(Some(b))) => (a - b).abs() <= LARGEST_JUMP,
        _ => false,
    };
    let follows = |y: usize| near(y, ridge.get(y + 1)) || (y > 0 && near(y, ridge.get(y - 1)));
    let point = |(y, x): (usize, &Option<f64>)| {
        Point::new(x.filter(|_| follows(y)).unwrap_or(f64::NAN), y as f64)
    };
    let points = ridge.iter().enumerate().map(point).collect();
    Overlay { label: "largest value of each row".to_owned(), points, ..Overlay::default() }
}
