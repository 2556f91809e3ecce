//! The page every map shares: title, frame, axes in cells, room for a scale on the right and a legend below.

use crate::axis;
use crate::colour::Rgba;
use crate::font;
use crate::legend::{self, Entry, SMALL_PX};
use crate::scene::{Anchor, PagePoint, PathBuilder, Scene};
use tigereye_core::{Cell, CellShape, Grid, Point};

/// Margin around pictures in pixels.
pub(crate) const MARGIN_PX: f64 = 16.0;
/// Font size of titles in pixels.
pub(crate) const TITLE_PX: f64 = 15.0;
const TITLE_LINE_PX: f64 = 20.0;
/// Narrower pictures would break titles and legends into single words.
const LEAST_WIDTH_PX: f64 = 300.0;
/// Least height that leaves room for a scale beside flat maps.
const LEAST_SIDE_HEIGHT_PX: f64 = 150.0;

/// A map under construction: draw into `scene`, then [`MapFrame::finish`].
pub(crate) struct MapFrame {
    pub(crate) scene: Scene,
    /// Left edge of the map in pixels.
    pub(crate) left: f64,
    /// Upper edge of the map in pixels.
    pub(crate) top: f64,
    /// Width and height of a cell in pixels.
    pub(crate) cell: [f64; 2],
    pub(crate) grid: Grid,
    title: Vec<String>,
    has_side: bool,
}

impl MapFrame {
    /// A page for `grid` with cells of `cell` pixels along x and y and, on the right, `side_px` pixels for a scale.
    pub(crate) fn begin(grid: Grid, title: &str, cell: [f64; 2], side_px: f64) -> Self {
        let widest_row = font::text_width(&(grid.height() - 1).to_string(), SMALL_PX);
        let left = MARGIN_PX + 22.0 + widest_row + 8.0;
        let map_width = cell[0] * grid.width() as f64;
        let width_px = (left + map_width + side_px).max(LEAST_WIDTH_PX) + MARGIN_PX;
        let title = font::wrapped(title, TITLE_PX, width_px - left - MARGIN_PX);
        let top = MARGIN_PX + TITLE_LINE_PX * title.len() as f64 + if title.is_empty() { 0.0 } else { 6.0 };
        let scene = Scene::sized(width_px, 0.0);
        Self { scene, left, top, cell, grid, title, has_side: side_px > 0.0 }
    }

    pub(crate) fn width(&self) -> f64 {
        self.cell[0] * self.grid.width() as f64
    }

    pub(crate) fn height(&self) -> f64 {
        self.cell[1] * self.grid.height() as f64
    }

    /// The smaller side of a cell in pixels.
    pub(crate) fn smaller_side(&self) -> f64 {
        self.cell[0].min(self.cell[1])
    }

    /// Height available to a scale on the right.
    pub(crate) fn side_height(&self) -> f64 {
        self.height().max(LEAST_SIDE_HEIGHT_PX)
    }

    /// Centre of a cell in pixels.
    pub(crate) fn centre(&self, cell: Cell) -> PagePoint {
        self.point(cell.centre())
    }

    /// The position of a point of the grid on the page.
    pub(crate) fn point(&self, p: Point) -> PagePoint {
        let [width, height] = self.cell;
        PagePoint::new(self.left + (p.x + 0.5) * width, self.top + (p.y + 0.5) * height)
    }

    /// The outlines of `cells`.
    pub(crate) fn squares(&self, cells: impl IntoIterator<Item = Cell>) -> PathBuilder {
        let mut path = PathBuilder::default();
        for c in cells.into_iter().filter(|c| self.grid.contains(*c)) {
            let [width, height] = self.cell;
            path.rect(self.left + c.x as f64 * width, self.top + c.y as f64 * height, width, height);
        }
        path
    }

    /// Hatches `cells` if they are large enough to show it.
    pub(crate) fn hatch(&mut self, cells: &[Cell]) {
        if self.smaller_side() < 4.0 || cells.is_empty() {
            return;
        }
        let mut path = PathBuilder::default();
        for c in cells {
            let PagePoint { x, y, .. } = self.centre(*c);
            let [r, s] = self.cell.map(|side| 0.5 * side);
            path.line([x - r, y + s], [x + r, y - s]);
        }
        self.scene.stroke(path.finish(), Rgba::WHITE, 1.0);
    }

    /// Lines between cells, unless only every n-th cell is drawn.
    pub(crate) fn grid_lines(&mut self, every: usize, colour: Rgba) {
        let (left, top, right, bottom) =
            (self.left, self.top, self.left + self.width(), self.top + self.height());
        let mut path = PathBuilder::default();
        for x in 1..self.grid.width() {
            let x = left + x as f64 * self.cell[0];
            path.line([x, top], [x, bottom]);
        }
        for y in 1..self.grid.height() {
            let y = top + y as f64 * self.cell[1];
            path.line([left, y], [right, y]);
        }
        if every == 1 && !path.is_empty() {
            self.scene.stroke(path.finish(), colour, 0.5);
        }
    }

    /// Adds frame, axes, title and legend.
    pub(crate) fn finish(mut self, title: &str, description: String, legend: &[Entry]) -> Scene {
        self.frame_and_axes();
        for (i, line) in self.title.iter().enumerate() {
            let baseline = MARGIN_PX + TITLE_LINE_PX * i as f64 + 13.0;
            self.scene.text([self.left, baseline], line, TITLE_PX, Rgba::INK, Anchor::Start);
        }
        let mut bottom = self.top + self.height() + 40.0;
        if self.has_side {
            bottom = bottom.max(self.top + self.side_height() + 12.0);
        }
        let row = legend::flow(legend, self.scene.width_px - self.left - MARGIN_PX);
        let legend_height = row.height_px;
        self.scene.place(row, self.left, bottom, 1.0);
        self.scene.height_px = bottom + legend_height + if legend.is_empty() { 8.0 } else { MARGIN_PX };
        self.scene.title = title.to_owned();
        self.scene.description = description;
        self.scene
    }

    fn frame_and_axes(&mut self) {
        let (left, top, width, height) = (self.left, self.top, self.width(), self.height());
        let mut frame = PathBuilder::default();
        frame.rect(left, top, width, height);
        let mut numbers = Vec::new();
        for x in axis::cell_ticks(self.grid.width(), self.cell[0], 40.0) {
            let at = self.point(Point::new(x as f64, 0.0)).x;
            frame.line([at, top + height], [at, top + height + 4.0]);
            numbers.push(([at, top + height + 16.0], x.to_string(), Anchor::Middle));
        }
        for y in axis::cell_ticks(self.grid.height(), self.cell[1], 40.0) {
            let at = self.point(Point::new(0.0, y as f64)).y;
            frame.line([left - 4.0, at], [left, at]);
            let baseline = at + 0.5 * font::CAP_HEIGHT_EM * SMALL_PX;
            numbers.push(([left - 7.0, baseline], y.to_string(), Anchor::End));
        }
        self.scene.stroke(frame.finish(), Rgba::MUTED, 0.8);
        for (at, text, anchor) in numbers {
            self.scene.text(at, &text, SMALL_PX, Rgba::MUTED, anchor);
        }
        // On small maps the names of the axes would be longer than the axes.
        let (x_name, y_name) = (
            if width < 60.0 { "x" } else { "column x (cells)" },
            if height < 110.0 { "y" } else { "row y (cells)" },
        );
        let below = [left + 0.5 * width, top + height + 32.0];
        self.scene.text(below, x_name, SMALL_PX, Rgba::MUTED, Anchor::Middle);
        let beside = [MARGIN_PX + 9.0, top + 0.5 * height];
        self.scene.rotated_text(beside, y_name, SMALL_PX, Rgba::MUTED, Anchor::Middle, 90.0);
    }
}

/// Width and height of a cell in pixels. Its smaller side has `fixed` pixels, or by default as many as keep the longer
/// side of the map within `target_px`: an integer up to `most`, or one over an integer if cells are smaller than
/// pixels.
pub(crate) fn cell_px(
    grid: Grid,
    shape: CellShape,
    fixed: Option<usize>,
    target_px: usize,
    most: usize,
) -> [f64; 2] {
    let longer = shape.longer_side([grid.width(), grid.height()]).ceil() as usize;
    let smaller = match fixed {
        Some(px) => px.max(1) as f64,
        None if longer <= target_px => (target_px / longer.max(1)).min(most) as f64,
        None => 1.0 / longer.div_ceil(target_px) as f64,
    };
    shape.sides().map(|side| smaller * side)
}

/// The step with which cells are skipped so that neighbouring glyphs are at least `pitch_px` apart.
pub(crate) fn stride(cell_px: f64, pitch_px: f64) -> usize {
    ((pitch_px / cell_px).ceil() as usize).max(1)
}

/// Every `every`-th column and row, the middle ones among them: structures about the centre must not fall between the
/// glyphs. The outermost are half a step from the edge, so that glyphs stay within the frame.
pub(crate) fn sampled_cells(grid: Grid, every: usize) -> impl Iterator<Item = Cell> {
    let samples = move |side: usize| {
        let middle = (side - 1) / 2;
        let first = if side <= every { middle } else { every / 2 + (middle + every - every / 2) % every };
        let beyond = side.saturating_sub(every / 2).max(first + 1);
        (first..beyond).step_by(every)
    };
    samples(grid.height()).flat_map(move |y| samples(grid.width()).map(move |x| Cell::new(x, y)))
}
