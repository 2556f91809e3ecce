//! The page every map shares: title, frame, axes in cells, room for a scale on the right and a legend below.

use crate::axis::{self, Axis};
use crate::colour::Rgba;
use crate::font;
use crate::legend::{self, Entry, SMALL_PX};
use crate::scene::{Anchor, PagePoint, PathBuilder, Scene};
use crate::style::{Coordinates, Style};
use std::collections::BTreeMap;
use tigereye_core::{Cell, CellShape, Grid, Point};

/// Margin around pictures in pixels.
pub(crate) const MARGIN_PX: f64 = 16.0;
/// The same where somebody chose the width: pages have margins of their own.
const NARROW_MARGIN_PX: f64 = 3.0;
/// Font size of titles in pixels.
pub(crate) const TITLE_PX: f64 = 15.0;
const TITLE_LINE_PX: f64 = 20.0;
/// Narrower pictures would break titles and legends into single words.
const LEAST_WIDTH_PX: f64 = 300.0;
/// Least height that leaves room for a scale beside flat maps; less where somebody chose the width.
const LEAST_SIDE_HEIGHT_PX: f64 = 150.0;
const NARROW_SIDE_HEIGHT_PX: f64 = 80.0;
/// Least distance of the lines of a hatching.
const HATCH_PX: f64 = 4.0;
/// Least distance of the marks of an axis.
const TICKS_APART_PX: f64 = 40.0;
/// How often a map is laid out to fit a width.
const FITTING_ROUNDS: usize = 8;
/// Narrower maps cannot be read; a page that has no room for one becomes wider.
const LEAST_MAP_PX: f64 = 40.0;

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
    axes: [MapAxis; 2],
    title: String,
    has_side: bool,
    margin: f64,
    least_side_height: f64,
    /// Pixels of the picture per pixel of the page, where somebody chose its size; 1 otherwise.
    pub(crate) fineness: f64,
}

/// Names of the axes of cells; what stands instead beside maps of less than so many pixels.
const COLUMNS: (&str, &str, f64) = ("column x (cells)", "x", 60.0);
const ROWS: (&str, &str, f64) = ("row y (cells)", "y", 110.0);

/// Name and marks of an axis.
struct MapAxis {
    name: String,
    /// What stands instead of the name beside a map of less than so many pixels.
    short: (&'static str, f64),
    /// Cell numbers, with fractions, and labels.
    marks: Vec<(f64, String)>,
}

impl MapAxis {
    fn of(
        (name, letter, least_px): (&'static str, &'static str, f64),
        cells: usize,
        cell_px: f64,
        coordinates: Option<&Coordinates>,
        chosen: Option<String>,
    ) -> Self {
        let marks = match coordinates {
            None => {
                let numbers = axis::cell_ticks(cells, cell_px, TICKS_APART_PX);
                numbers.into_iter().map(|n| (n as f64, n.to_string())).collect()
            }
            Some(Coordinates { first, step, .. }) => {
                let ends = [-0.5, cells as f64 - 0.5].map(|cell| first + step * cell);
                let range = Axis::linear(ends[0].min(ends[1]), ends[0].max(ends[1]));
                let count = (cells as f64 * cell_px / (1.25 * TICKS_APART_PX)) as usize;
                range.ticks(count).into_iter().map(|t| ((t.value - first) / step, t.label)).collect()
            }
        };
        match chosen {
            None => Self { name: name.to_owned(), short: (letter, least_px), marks },
            Some(name) => {
                let width = font::text_width(&name, SMALL_PX);
                Self { name, short: (letter, width), marks }
            }
        }
    }

    /// How far the last label reaches beyond the end of the axis, of so many cells.
    fn overhang(&self, cells: usize, cell_px: f64) -> f64 {
        let beyond = |(at, label): &(f64, String)| {
            (at + 0.5 - cells as f64) * cell_px + 0.5 * font::text_width(label, SMALL_PX)
        };
        self.marks.iter().map(beyond).fold(0.0, f64::max)
    }

    fn widest(&self) -> f64 {
        self.marks.iter().map(|(_, label)| font::text_width(label, SMALL_PX)).fold(0.0, f64::max)
    }
}

impl MapFrame {
    /// A page for `grid` with cells of `cell` pixels along x and y and, on the right, as many pixels for a scale as
    /// `side_px` makes of the height of the map. Where the style has a width, cells become as large as it allows.
    pub(crate) fn begin(
        grid: Grid,
        (style, own_title): (&Style, &str),
        cell: [f64; 2],
        side_px: &dyn Fn(f64) -> f64,
    ) -> Self {
        let mut frame = Self::laid_out(grid, style, cell, side_px);
        if let Some(width_px) = style.width_px() {
            // The numbers beside the map depend on its size, which depends on the room that they leave. Where that goes
            // back and forth, the smaller map has room.
            let mut smallest = f64::INFINITY;
            for round in 0..FITTING_ROUNDS {
                let around = frame.scene.width_px - frame.width();
                let wanted = (width_px - around).max(LEAST_MAP_PX) / grid.width() as f64;
                if round >= FITTING_ROUNDS / 2 {
                    smallest = smallest.min(wanted);
                }
                let factor = wanted.min(smallest) / frame.cell[0];
                frame = Self::laid_out(grid, style, frame.cell.map(|side| side * factor), side_px);
            }
            frame.scene.width_px = frame.scene.width_px.max(width_px);
        }
        let least = if style.width.is_some() { 0.0 } else { LEAST_WIDTH_PX + frame.margin };
        frame.scene.width_px = frame.scene.width_px.max(least);
        let title = style.title_or(own_title);
        frame.title = title.to_owned();
        let lines = frame.title_lines().len() as f64;
        // A label may reach above the map.
        frame.top =
            (frame.margin + TITLE_LINE_PX * lines + if lines == 0.0 { 0.0 } else { 6.0 }).max(SMALL_PX);
        frame
    }

    /// Without a title.
    fn laid_out(grid: Grid, style: &Style, cell: [f64; 2], side_px: &dyn Fn(f64) -> f64) -> Self {
        let [x_place, y_place] = match style.marked() {
            Some([x, y]) => [Some(x), Some(y)],
            None => [None, None],
        };
        let name = |chosen: &Option<String>, place: Option<&Coordinates>| {
            chosen.clone().or(place.map(|c| style.with_unit(&c.name)))
        };
        let axes = [
            MapAxis::of(COLUMNS, grid.width(), cell[0], x_place, name(&style.x_name, x_place)),
            MapAxis::of(ROWS, grid.height(), cell[1], y_place, name(&style.y_name, y_place)),
        ];
        // Room for the largest number of a row, whether or not it is marked.
        let widest = match y_place {
            Some(_) => axes[1].widest(),
            None => font::text_width(&(grid.height() - 1).to_string(), SMALL_PX),
        };
        let (margin, least_side_height) = match style.width {
            Some(_) => (NARROW_MARGIN_PX, NARROW_SIDE_HEIGHT_PX),
            None => (MARGIN_PX, LEAST_SIDE_HEIGHT_PX),
        };
        let left = margin + 22.0 + widest + 8.0;
        let side_px = side_px((cell[1] * grid.height() as f64).max(least_side_height));
        let overhang = axes[0].overhang(grid.width(), cell[0]);
        let right = margin.max(overhang - side_px + 1.0);
        let mut scene = Scene::sized(left + cell[0] * grid.width() as f64 + side_px + right, 0.0);
        scene.pt_per_px = style.pt_per_px();
        scene.on_paper = style.width.is_some() || style.font_pt.is_some();
        Self {
            scene,
            left,
            top: 0.0,
            cell,
            grid,
            axes,
            title: String::new(),
            has_side: side_px > 0.0,
            margin,
            least_side_height,
            fineness: style.fineness(),
        }
    }

    fn title_lines(&self) -> Vec<String> {
        font::wrapped(&self.title, TITLE_PX, self.scene.width_px - self.left - self.margin)
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
        self.height().max(self.least_side_height)
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

    /// Hatches `cells` with a line in each, or in each square of so many that a line can be seen. Whether there was
    /// room for one.
    pub(crate) fn hatch(&mut self, cells: &[Cell]) -> bool {
        let block = (HATCH_PX / self.smaller_side()).ceil().max(1.0) as usize;
        // Blocks, row by row, with the number of their cells.
        let mut blocks = BTreeMap::new();
        for c in cells {
            *blocks.entry((c.y / block, c.x / block)).or_insert(0) += 1;
        }
        let mut path = PathBuilder::default();
        for ((y, x), _) in blocks.into_iter().filter(|(_, count)| *count == block * block) {
            let [left, top] =
                [self.left + self.cell[0] * (x * block) as f64, self.top + self.cell[1] * (y * block) as f64];
            let [width, height] = self.cell.map(|side| side * block as f64);
            path.line([left, top + height], [left + width, top]);
        }
        let is_hatched = !path.is_empty();
        if is_hatched {
            self.scene.stroke(path.finish(), Rgba::WHITE, 1.0);
        }
        is_hatched
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
    pub(crate) fn finish(mut self, description: String, legend: &[Entry]) -> Scene {
        self.frame_and_axes();
        for (i, line) in self.title_lines().iter().enumerate() {
            let baseline = self.margin + TITLE_LINE_PX * i as f64 + 13.0;
            self.scene.text([self.left, baseline], line, TITLE_PX, Rgba::INK, Anchor::Start);
        }
        let mut bottom = self.top + self.height() + 40.0;
        if self.has_side {
            bottom = bottom.max(self.top + self.side_height() + 12.0);
        }
        let row = legend::flow(legend, self.scene.width_px - self.left - self.margin);
        let legend_height = row.height_px;
        self.scene.place(row, self.left, bottom, 1.0);
        self.scene.height_px =
            bottom + legend_height + if legend.is_empty() { 0.5 * self.margin } else { self.margin };
        self.scene.title = self.title;
        self.scene.description = description;
        self.scene
    }

    fn frame_and_axes(&mut self) {
        let (left, top, width, height) = (self.left, self.top, self.width(), self.height());
        let mut frame = PathBuilder::default();
        frame.rect(left, top, width, height);
        let mut numbers = Vec::new();
        let [x_axis, y_axis] = &self.axes;
        for (x, label) in &x_axis.marks {
            let at = self.point(Point::new(*x, 0.0)).x;
            frame.line([at, top + height], [at, top + height + 4.0]);
            numbers.push(([at, top + height + 16.0], label.clone(), Anchor::Middle));
        }
        for (y, label) in &y_axis.marks {
            let at = self.point(Point::new(0.0, *y)).y;
            frame.line([left - 4.0, at], [left, at]);
            let baseline = at + 0.5 * font::CAP_HEIGHT_EM * SMALL_PX;
            numbers.push(([left - 7.0, baseline], label.clone(), Anchor::End));
        }
        self.scene.stroke(frame.finish(), Rgba::MUTED, 0.8);
        for (at, text, anchor) in numbers {
            self.scene.text(at, &text, SMALL_PX, Rgba::MUTED, anchor);
        }
        // On small maps the names of the axes would be longer than the axes.
        let fitting =
            |a: &MapAxis, side: f64| if side < a.short.1 { a.short.0.to_owned() } else { a.name.clone() };
        let [x_name, y_name] = [fitting(x_axis, width), fitting(y_axis, height)];
        let below = [left + 0.5 * width, top + height + 32.0];
        self.scene.text(below, &x_name, SMALL_PX, Rgba::MUTED, Anchor::Middle);
        let beside = [self.margin + 9.0, top + 0.5 * height];
        self.scene.rotated_text(beside, &y_name, SMALL_PX, Rgba::MUTED, Anchor::Middle, 90.0);
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
