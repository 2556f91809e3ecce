//! Cells without a tensor, grey in every picture.

use crate::colour::Rgba;
use crate::legend::{Entry, Mark};
use crate::map_frame::MapFrame;
use crate::scene::{Item, Raster};
use crate::style::Style;
use tigereye_core::{Cell, Field, Grid};

/// The cells of `masked` that are on a grid, as a field.
pub(crate) fn within(masked: &[Cell], grid: Grid) -> Field<bool> {
    let mut field = Field::from_fn(grid, |_| false);
    for cell in masked.iter().filter(|cell| grid.contains(**cell)) {
        field.values_mut()[grid.index(*cell)] = true;
    }
    field
}

/// Covers them.
pub(crate) fn draw(page: &mut MapFrame, masked: &Field<bool>) {
    if !masked.values().contains(&true) {
        return;
    }
    let clear = Rgba::MASKED.with_opacity(0.0);
    let cells = masked.values().iter().map(|masked| if *masked { Rgba::MASKED } else { clear }).collect();
    page.scene.items.push(Item::Raster(Raster {
        x_px: page.left,
        y_px: page.top,
        cell_px: page.cell,
        columns: masked.grid().width(),
        cells,
    }));
}

/// Names them in the legend.
pub(crate) fn explain(masked: &Field<bool>, style: &Style, legend: &mut Vec<Entry>) {
    if masked.values().contains(&true) {
        legend.push(Entry::of(Mark::Swatch(Rgba::MASKED), name(style)));
    }
}

/// What they are called in legends.
pub(crate) fn name(style: &Style) -> &str {
    style.masked.as_deref().unwrap_or("no tensor")
}
