//! Lines and points alone on the axes of a grid.

use crate::legend::Entry;
use crate::map_frame::{self, MapFrame};
use crate::mask;
use crate::overlay::{self, Overlay};
use crate::ribbon::{self, Ribbon};
use crate::scene::{PagePoint, PathBuilder, Scene};
use crate::style::Style;
use crate::{Rgba, legend::Mark};
use tigereye_core::{Cell, CellShape, Grid};

/// Options of [`plain_map`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlainOptions {
    /// Title; may be empty.
    pub title: String,
    /// What the map shows: the beginning of a sentence for readers who cannot see it.
    pub description: String,
    /// Pixels of a cell's smaller side; by default a whole number such that the longer side of the map has about 480.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
    /// Bands, such as hyperstreamlines.
    pub ribbons: Vec<Ribbon>,
    /// The lines and points, over the bands.
    pub overlays: Vec<Overlay>,
    /// Cells without a tensor, drawn grey.
    pub masked: Vec<Cell>,
    /// Cells with a light ground.
    pub shaded: Vec<Cell>,
    /// Their name in the legend.
    pub shaded_label: String,
    /// What of all this is chosen otherwise.
    pub style: Style,
}

/// Light enough for lines of every colour.
const SHADE: Rgba = Rgba::hex(0xe4ebf5);

/// Overlays on white.
#[must_use]
pub fn plain_map(grid: Grid, options: &PlainOptions) -> Scene {
    let cell = map_frame::cell_px(grid, options.cell, options.cell_px, 480, 40);
    let mut page = MapFrame::begin(grid, (&options.style, &options.title), cell, &|_| 0.0);
    let mut legend = Vec::new();
    let mut squares = PathBuilder::default();
    for c in &options.shaded {
        let (PagePoint { x, y, .. }, [width, height]) = (page.centre(*c), page.cell);
        squares.rect(x - 0.5 * width, y - 0.5 * height, width, height);
    }
    if !squares.is_empty() {
        page.scene.fill(squares.finish(), SHADE);
    }
    let masked = mask::within(&options.masked, grid);
    mask::draw(&mut page, &masked);
    mask::explain(&masked, &options.style, &mut legend);
    if !options.shaded.is_empty() {
        legend.push(Entry::of(Mark::Swatch(SHADE), options.shaded_label.clone()));
    }
    ribbon::draw(&mut page, &options.ribbons, &mut legend);
    overlay::draw(&mut page, &options.overlays, &mut legend);
    let description =
        format!("{} on {} x {} cells, row 0 on top.", options.description, grid.width(), grid.height());
    page.finish(description, &legend)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Item;
    use tigereye_core::Point;

    #[test]
    fn lines_and_points_are_there_with_their_names() {
        let overlay = |label: &str, points: &[Point]| Overlay {
            label: label.to_owned(),
            points: points.to_vec(),
            ..Overlay::default()
        };
        let options = PlainOptions {
            title: "a field".to_owned(),
            description: "Lines".to_owned(),
            overlays: vec![overlay("a line", &[Point::new(0.0, 0.0), Point::new(3.0, 2.0)])],
            masked: vec![Cell::new(1, 1)],
            shaded: vec![Cell::new(2, 1)],
            shaded_label: "a part".to_owned(),
            ..PlainOptions::default()
        };
        let scene = plain_map(Grid::new(30, 20).expect("a size"), &options);
        assert!(scene.description.contains("Lines on 30 x 20 cells"));
        let mut words = Vec::new();
        collect(&scene.items, &mut words);
        for text in ["a field", "a line", "no tensor", "a part"] {
            assert!(words.iter().any(|w| w == text), "{text}: {words:?}");
        }
    }

    fn collect(items: &[Item], words: &mut Vec<String>) {
        for item in items {
            match item {
                Item::Text(text) => words.push(text.text.clone()),
                Item::Group { items, .. } => collect(items, words),
                Item::Path(_) | Item::Raster(_) => {}
            }
        }
    }
}
