//! The bar that tells which colour means which value.

use crate::axis::Axis;
use crate::colour::{ColourMap, Rgba};
use crate::font;
use crate::legend::SMALL_PX;
use crate::scene::{Anchor, Item, PathBuilder, Raster, Scene};

const BAR_PX: f64 = 14.0;
const TICK_PX: f64 = 4.0;
const ARROW_PX: f64 = 9.0;

/// A vertical colour bar.
pub(crate) struct ColourBar<'a> {
    pub(crate) axis: Axis,
    pub(crate) map: ColourMap,
    /// Quantity with unit.
    pub(crate) label: &'a str,
    /// Values beyond the ends are shown in the colours of the ends: arrowheads say so.
    pub(crate) below: bool,
    pub(crate) above: bool,
}

impl ColourBar<'_> {
    fn ticks(&self, height_px: f64) -> Vec<crate::axis::Tick> {
        self.axis.ticks((height_px / 42.0) as usize)
    }

    fn label_column(&self, height_px: f64) -> f64 {
        self.ticks(height_px).iter().map(|t| font::text_width(&t.label, SMALL_PX)).fold(0.0, f64::max)
    }

    /// Room the bar takes to the right of a map, gap included.
    pub(crate) fn width(&self, height_px: f64) -> f64 {
        let name = if self.label.is_empty() { 0.0 } else { 23.0 };
        18.0 + BAR_PX + TICK_PX + 4.0 + self.label_column(height_px) + name + 4.0
    }

    /// Draws the bar with its upper left corner right of the map's edge at (x, y).
    pub(crate) fn draw(&self, scene: &mut Scene, edge_x: f64, top: f64, height: f64) {
        let x = edge_x + 18.0;
        let (top, height) = self.between_arrows(top, height);
        self.draw_colours(scene, x, top, height);
        let mut marks = PathBuilder::default();
        let at = |value: f64| top + (1.0 - self.axis.position(value)) * height;
        for value in self.axis.minor_ticks() {
            marks.line([x + BAR_PX, at(value)], [x + BAR_PX + 0.5 * TICK_PX, at(value)]);
        }
        for tick in self.ticks(height) {
            let y = at(tick.value);
            marks.line([x + BAR_PX, y], [x + BAR_PX + TICK_PX, y]);
            let baseline = y + 0.5 * font::CAP_HEIGHT_EM * SMALL_PX;
            let left = x + BAR_PX + TICK_PX + 4.0;
            scene.text([left, baseline], &tick.label, SMALL_PX, Rgba::MUTED, Anchor::Start);
        }
        marks.rect(x, top, BAR_PX, height);
        scene.stroke(marks.finish(), Rgba::MUTED, 0.8);
        self.draw_name(scene, x + BAR_PX + TICK_PX + 4.0 + self.label_column(height) + 19.0, top, height);
    }

    /// Upper end and height of the coloured part.
    fn between_arrows(&self, top: f64, height: f64) -> (f64, f64) {
        let (above, below) =
            (if self.above { ARROW_PX } else { 0.0 }, if self.below { ARROW_PX } else { 0.0 });
        (top + above, height - above - below)
    }

    fn draw_name(&self, scene: &mut Scene, x: f64, top: f64, height: f64) {
        let natural = font::text_width(self.label, SMALL_PX);
        let size = SMALL_PX * (height / natural).min(1.0);
        scene.rotated_text([x, top + 0.5 * height], self.label, size, Rgba::INK, Anchor::Middle, 90.0);
    }

    fn draw_colours(&self, scene: &mut Scene, x: f64, top: f64, height: f64) {
        // A stack of squares about one pixel high.
        let rows = height.round().max(1.0) as usize;
        let side = height / rows as f64;
        let columns = (BAR_PX / side).round().max(1.0) as usize;
        let cells = (0..rows)
            .flat_map(|row| {
                let t = 1.0 - (row as f64 + 0.5) / rows as f64;
                core::iter::repeat_n(self.map.sample(t), columns)
            })
            .collect();
        scene.items.push(Item::Raster(Raster { x_px: x, y_px: top, cell_px: [side; 2], columns, cells }));
        let mut arrow = |tip: f64, base: f64, colour: Rgba| {
            let mut path = PathBuilder::default();
            path.polyline(&[[x, base], [x + BAR_PX, base], [x + 0.5 * BAR_PX, tip]], true);
            scene.paint(path.finish(), colour, Rgba::MUTED, 0.8);
        };
        if self.above {
            arrow(top - ARROW_PX, top, self.map.sample(1.0));
        }
        if self.below {
            arrow(top + height + ARROW_PX, top + height, self.map.sample(0.0));
        }
    }
}
