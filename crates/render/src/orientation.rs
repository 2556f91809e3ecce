//! The direction of the major axis as colour.

use crate::colour::{ColourMap, Rgba};
use crate::font;
use crate::legend::{Entry, Mark, SMALL_PX};
use crate::map_frame::{self, MapFrame};
use crate::mask;
use crate::overlay::{self, Overlay};
use crate::ribbon::{self, Ribbon};
use crate::scene::{Anchor, Item, PagePoint, PathBuilder, Raster, Scene};
use crate::style::Style;
use tigereye_core::{Anisotropy, Cell, CellShape, Field, Svd, Tensor2, math};

/// Options of [`orientation_map`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OrientationOptions {
    /// Title; may be empty.
    pub title: String,
    /// Pixels of a cell's smaller side; by default a whole number such that the longer side of the map has about 480.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
    /// Bands, such as hyperstreamlines.
    pub ribbons: Vec<Ribbon>,
    /// Points and lines over the map and bands.
    pub overlays: Vec<Overlay>,
    /// What of all this is chosen otherwise; the colour map should be cyclic.
    pub style: Style,
}

/// The colour of isotropic tensors, which have no direction.
const ISOTROPIC: Rgba = Rgba::hex(0xe2e2e2);
const RING_PX: f64 = 56.0;
const GAP_PX: f64 = 48.0;
const SIDE_PX: f64 = GAP_PX + 2.0 * RING_PX + 22.0;

/// The direction of the longer semi-axis modulo 180 degrees in a cyclic colour map, faded to grey where the tensor is
/// isotropic, with a half ring of directions as legend.
#[must_use]
pub fn orientation_map(field: &Field<Tensor2>, options: &OrientationOptions) -> Scene {
    let grid = field.grid();
    // Directions have no mean that pixels could show: large grids are sampled.
    let cell = map_frame::cell_px(grid, options.cell, options.cell_px, 480, 40);
    let mut page = MapFrame::begin(grid, (&options.style, &options.title), cell, &|_| SIDE_PX);
    let block = (1.0 / page.smaller_side()).round().max(1.0) as usize;
    let map = options.style.map.unwrap_or(ColourMap::RomaO);
    page.scene.items.push(raster(field, &page, block, map));
    let broken: Vec<Cell> = field.iter().filter(|(_, t)| !t.is_finite()).map(|(c, _)| c).collect();
    let is_hatched = page.hatch(&broken);
    draw_half_ring(&mut page, map);
    let mut legend = Vec::new();
    if field.values().iter().any(Tensor2::is_zero) {
        legend.push(Entry::of(Mark::Swatch(Rgba::MASKED), mask::name(&options.style)));
    }
    if !broken.is_empty() {
        legend.push(Entry::of(Mark::broken(is_hatched), "tensor not finite"));
    }
    ribbon::draw(&mut page, &options.ribbons, &mut legend);
    overlay::draw(&mut page, &options.overlays, &mut legend);
    if block > 1 {
        legend.push(Entry::of(Mark::None, format!("one pixel = one of {block} × {block} cells")));
    }
    let description = format!(
        "Direction of the major axis of a tensor field of {} x {} cells, row 0 on top, as cyclic colour.",
        grid.width(),
        grid.height()
    );
    page.finish(description, &legend)
}

/// One cell of each block of `block` x `block`, its upper left one.
fn raster(field: &Field<Tensor2>, page: &MapFrame, block: usize, map: ColourMap) -> Item {
    let grid = field.grid();
    let columns = grid.width().div_ceil(block);
    let cells = (0..grid.height())
        .step_by(block)
        .flat_map(|y| {
            (0..grid.width()).step_by(block).map(move |x| tensor_colour(field.at(Cell::new(x, y)), map))
        })
        .collect();
    Item::Raster(Raster {
        x_px: page.left,
        y_px: page.top,
        cell_px: page.cell.map(|side| side * block as f64),
        columns,
        cells,
    })
}

fn tensor_colour(t: &Tensor2, map: ColourMap) -> Rgba {
    if !t.is_finite() {
        return Rgba::NOT_FINITE;
    }
    if t.is_zero() {
        return Rgba::MASKED;
    }
    direction_colour(Svd::of(t).phi_rad(), Anisotropy::of(t).linear, map)
}

fn direction_colour(phi_rad: f64, anisotropy: f64, map: ColourMap) -> Rgba {
    let turns = phi_rad / math::PI;
    ISOTROPIC.mixed(map.sample(turns - turns.floor()), anisotropy)
}

/// Directions from 0 to 180 degrees, strong colours outside, isotropic grey in the middle.
fn draw_half_ring(page: &mut MapFrame, map: ColourMap) {
    const SECTORS: usize = 60;
    const RINGS: usize = 10;
    let centre = PagePoint::new(page.left + page.width() + GAP_PX + RING_PX, page.top + RING_PX + 44.0);
    let point = |radius: f64, angle: f64| {
        PagePoint::new(centre.x + radius * math::cos(angle), centre.y - radius * math::sin(angle))
    };
    let scene = &mut page.scene;
    scene.text([centre.x, page.top + 10.0], "major axis", SMALL_PX, Rgba::INK, Anchor::Middle);
    for ring in (0..RINGS).rev() {
        let radius = RING_PX * (ring + 1) as f64 / RINGS as f64;
        for sector in 0..SECTORS {
            let middle = math::PI * (sector as f64 + 0.5) / SECTORS as f64;
            // Sectors reach under the next one, or the ground would shine through the seams.
            let (from, to) = (middle - math::PI / 120.0, (middle + math::PI / 60.0).min(math::PI));
            let mut path = PathBuilder::default();
            path.polyline(&[centre, point(radius, from), point(radius, to)], true);
            scene.fill(path.finish(), direction_colour(middle, (ring as f64 + 0.5) / RINGS as f64, map));
        }
    }
    for (degrees, anchor) in [
        (0.0, Anchor::Start),
        (45.0, Anchor::Start),
        (90.0, Anchor::Middle),
        (135.0, Anchor::End),
        (180.0, Anchor::End),
    ] {
        let angle = math::radians(degrees);
        let at = point(RING_PX + 6.0, angle);
        let drop = if degrees == 90.0 { 0.0 } else { 0.5 * font::CAP_HEIGHT_EM * SMALL_PX };
        scene.text([at.x, at.y + drop], &format!("{degrees}°"), SMALL_PX, Rgba::MUTED, anchor);
    }
    let below = [centre.x, centre.y + 20.0];
    scene.text(below, "grey: isotropic", SMALL_PX, Rgba::MUTED, Anchor::Middle);
}
