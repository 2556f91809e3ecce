//! Rows of marks with their meaning.

use crate::colour::Rgba;
use crate::font;
use crate::scene::{Anchor, Item, PagePoint, PathBuilder, Scene};
use crate::shapes::{self, Marker};

/// Font size of legends and axis numbers in pixels.
pub(crate) const SMALL_PX: f64 = 11.0;
const ROW_PX: f64 = 19.0;
const MARK_PX: f64 = 22.0;
const GAP_PX: f64 = 6.0;
const BETWEEN_PX: f64 = 20.0;

/// The mark before a text of the legend.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mark {
    /// A filled rectangle.
    Swatch(Rgba),
    /// A filled rectangle with diagonal hatching.
    Hatched(Rgba),
    /// A filled rectangle with a coloured outline.
    Outlined(Rgba, Rgba),
    /// A line with an optional marker.
    Line { colour: Rgba, width_px: f64, dash_px: Vec<f64>, marker: Option<Marker> },
    /// A marker alone.
    Point(Marker, Rgba),
    /// A small hollow circle.
    Ring(Rgba),
    /// Items about (0, 0), within a rectangle of 22 x 11 pixels.
    Drawing(Vec<Item>),
    /// Nothing: the text is a remark.
    None,
}

/// One mark and its meaning.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub(crate) mark: Mark,
    pub(crate) label: String,
}

impl Mark {
    /// That of values that are not finite: hatched where the map is.
    pub(crate) const fn broken(is_hatched: bool) -> Self {
        if is_hatched { Self::Hatched(Rgba::NOT_FINITE) } else { Self::Swatch(Rgba::NOT_FINITE) }
    }
}

impl Entry {
    pub(crate) fn of(mark: Mark, label: impl Into<String>) -> Self {
        Self { mark, label: label.into() }
    }

    fn mark_width(&self) -> f64 {
        if self.mark == Mark::None { 0.0 } else { MARK_PX + GAP_PX }
    }
}

/// Entries side by side, in as many rows as `max_width_px` makes necessary.
pub(crate) fn flow(entries: &[Entry], max_width_px: f64) -> Scene {
    let mut scene = Scene::sized(0.0, if entries.is_empty() { 0.0 } else { ROW_PX });
    let mut x = 0.0;
    for entry in entries {
        let room = max_width_px - entry.mark_width();
        for (i, line) in font::wrapped(&entry.label, SMALL_PX, room).iter().enumerate() {
            let width = entry.mark_width() + font::text_width(line, SMALL_PX);
            if x > 0.0 && (i > 0 || x + width > max_width_px) {
                x = 0.0;
                scene.height_px += ROW_PX;
            }
            let middle = scene.height_px - 0.5 * ROW_PX;
            if i == 0 {
                draw_mark(&mut scene, &entry.mark, PagePoint::new(x, middle));
            }
            let baseline = middle + 0.5 * font::CAP_HEIGHT_EM * SMALL_PX;
            scene.text([x + entry.mark_width(), baseline], line, SMALL_PX, Rgba::MUTED, Anchor::Start);
            scene.width_px = scene.width_px.max(x + width);
            x += width + BETWEEN_PX;
        }
    }
    scene
}

fn draw_mark(scene: &mut Scene, mark: &Mark, PagePoint { x, y, .. }: PagePoint) {
    const HEIGHT: f64 = 11.0;
    let mut outline = PathBuilder::default();
    outline.rect(x, y - 0.5 * HEIGHT, MARK_PX, HEIGHT);
    let centre = PagePoint::new(x + 0.5 * MARK_PX, y);
    match mark {
        Mark::Swatch(colour) => scene.paint(outline.finish(), *colour, Rgba::MUTED, 0.5),
        Mark::Outlined(fill, line) => scene.paint(outline.finish(), *fill, *line, 1.2),
        Mark::Hatched(colour) => {
            scene.paint(outline.finish(), *colour, Rgba::MUTED, 0.5);
            let mut lines = PathBuilder::default();
            for left in [0.0, 0.5] {
                let left = x + left * MARK_PX;
                lines.line([left, y + 0.5 * HEIGHT], [left + HEIGHT, y - 0.5 * HEIGHT]);
            }
            scene.stroke(lines.finish(), Rgba::WHITE, 1.0);
        }
        Mark::Line { colour, width_px, dash_px, marker } => {
            let mut line = PathBuilder::default();
            line.line([x, y], [x + MARK_PX, y]);
            shapes::dashed(scene, line.finish(), *colour, *width_px, dash_px);
            if let Some(marker) = marker {
                marker.draw(scene, centre, 3.5, *colour);
            }
        }
        Mark::Point(marker, colour) => marker.draw(scene, centre, 4.0, *colour),
        Mark::Ring(colour) => {
            outline = PathBuilder::default();
            outline.circle(centre, 3.0);
            scene.stroke(outline.finish(), *colour, 1.0);
        }
        Mark::Drawing(items) => {
            scene.items.push(Item::Group {
                dx_px: centre.x,
                dy_px: centre.y,
                scale: 1.0,
                items: items.clone(),
            });
        }
        Mark::None => {}
    }
}
