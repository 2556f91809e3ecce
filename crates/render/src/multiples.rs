//! Several pictures on one page, aligned and lettered.

use crate::colour::Rgba;
use crate::font;
use crate::map_frame::{MARGIN_PX, TITLE_PX};
use crate::scene::{Anchor, Scene};

const LABEL_PX: f64 = 13.0;
const LABEL_LINE_PX: f64 = 18.0;
const GAP_PX: f64 = 10.0;

/// Panels row by row in `columns` columns (at least 1), each under its letter (a), (b), (c) and title; `title` above
/// all.
///
/// Give the panels no title of their own: their maps then share one upper edge.
#[must_use]
pub fn small_multiples(panels: &[(String, Scene)], columns: usize, title: &str) -> Scene {
    placed_multiples(panels, columns, title).0
}

/// A rectangle on a page, pixels from its upper left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PageRect {
    /// Left edge.
    pub x_px: f64,
    /// Upper edge.
    pub y_px: f64,
    /// Width.
    pub width_px: f64,
    /// Height.
    pub height_px: f64,
}

/// [`small_multiples`] with the place of each panel, its heading included.
#[must_use]
pub fn placed_multiples(panels: &[(String, Scene)], columns: usize, title: &str) -> (Scene, Vec<PageRect>) {
    let columns = columns.clamp(1, panels.len().max(1));
    let widths = column_widths(panels, columns);
    let width = (widths.iter().sum::<f64>() + GAP_PX * (columns - 1) as f64).max(240.0) + 2.0 * MARGIN_PX;
    let mut page = Scene::sized(width, MARGIN_PX);
    for line in font::wrapped(title, TITLE_PX, width - 2.0 * MARGIN_PX) {
        page.text([MARGIN_PX, page.height_px + 13.0], &line, TITLE_PX, Rgba::INK, Anchor::Start);
        page.height_px += 22.0;
    }
    if !title.is_empty() {
        page.height_px += 8.0;
    }
    if panels.is_empty() {
        page.text([MARGIN_PX, page.height_px + 12.0], "no panels", LABEL_PX, Rgba::MUTED, Anchor::Start);
        page.height_px += LABEL_LINE_PX;
    }
    let mut places = Vec::new();
    for (row, shown) in panels.chunks(columns).enumerate() {
        places.extend(place_row(&mut page, shown, row * columns, &widths));
    }
    page.height_px += 0.5 * MARGIN_PX;
    page.title = title.to_owned();
    page.description = described(panels);
    (page, places)
}

fn column_widths(panels: &[(String, Scene)], columns: usize) -> Vec<f64> {
    let width = |(_, scene): &(String, Scene)| if scene.width_px.is_finite() { scene.width_px } else { 0.0 };
    (0..columns).map(|c| panels.iter().skip(c).step_by(columns).map(width).fold(0.0, f64::max)).collect()
}

fn place_row(page: &mut Scene, panels: &[(String, Scene)], first: usize, widths: &[f64]) -> Vec<PageRect> {
    let top = page.height_px;
    let headings: Vec<Vec<String>> = panels
        .iter()
        .zip(widths)
        .enumerate()
        .map(|(i, ((title, _), width))| {
            let text = format!("({}) {title}", letter(first + i));
            font::wrapped(&text, LABEL_PX, width - MARGIN_PX)
        })
        .collect();
    let heading_height = LABEL_LINE_PX * headings.iter().map(Vec::len).max().unwrap_or(0) as f64;
    let mut left = MARGIN_PX;
    let mut tallest = 0.0_f64;
    let mut places = Vec::new();
    for (((_, scene), heading), width) in panels.iter().zip(&headings).zip(widths) {
        for (i, line) in heading.iter().enumerate() {
            let baseline = top + 13.0 + LABEL_LINE_PX * i as f64;
            page.text([left, baseline], line, LABEL_PX, Rgba::INK, Anchor::Start);
        }
        // Panels bring a margin of their own above.
        page.place(scene.clone(), left, top + heading_height - 6.0, 1.0);
        tallest = tallest.max(scene.height_px);
        let height_px = heading_height + scene.height_px;
        // Without most of the margin on the right, which is empty.
        let width_px = (width - 0.6 * MARGIN_PX).max(1.0);
        places.push(PageRect { x_px: left, y_px: top, width_px, height_px });
        left += width + GAP_PX;
    }
    page.height_px = top + heading_height + tallest;
    places
}

/// a to z, then aa, ab and so on.
fn letter(index: usize) -> String {
    let last = char::from(b'a' + (index % 26) as u8);
    if index < 26 { last.to_string() } else { format!("{}{last}", letter(index / 26 - 1)) }
}

fn described(panels: &[(String, Scene)]) -> String {
    let parts: Vec<String> = panels
        .iter()
        .enumerate()
        .map(|(i, (title, scene))| format!("({}) {title}: {}", letter(i), scene.description))
        .collect();
    parts.join(" ")
}
