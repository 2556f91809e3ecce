//! Walls, filters and crystals of a scene, over a map.

use crate::colour::Rgba;
use crate::legend::{Entry, Mark};
use crate::map_frame::MapFrame;
use crate::scene::{PagePoint, PathBuilder, Scene};
use tigereye_core::{Cell, Field, Surface, math};

const ABSORBING: Rgba = Rgba::hex(0x3b3b3b);
const MIRROR: Rgba = Rgba::hex(0xa9bfd3);
const MIRROR_LINE: Rgba = Rgba::hex(0x1f5f8b);
const DIFFUSE: Rgba = Rgba::hex(0xb9a98c);
const DIFFUSE_DOT: Rgba = Rgba::hex(0x6d5c3f);
/// Smaller cells show no strokes, only their colour, in pixels.
const LEAST_CELL_PX: f64 = 5.0;

/// The kinds, in the order of the legend.
const KINDS: [Kind; 5] = [Kind::Absorbing, Kind::Mirror, Kind::Diffuse, Kind::Filter, Kind::Crystal];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Absorbing,
    Mirror,
    Diffuse,
    Filter,
    Crystal,
}

impl Kind {
    const fn of(surface: &Surface) -> Self {
        match surface {
            Surface::Absorbing => Self::Absorbing,
            Surface::Mirror { .. } => Self::Mirror,
            Surface::Diffuse { .. } => Self::Diffuse,
            Surface::Filter { .. } => Self::Filter,
            Surface::Crystal => Self::Crystal,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Absorbing => "absorbing wall",
            Self::Mirror => "mirror",
            Self::Diffuse => "diffuse wall",
            Self::Filter => "filter",
            Self::Crystal => "crystal",
        }
    }

    /// The colour that covers the cell; filters and crystals leave it visible.
    const fn fill(self) -> Option<Rgba> {
        match self {
            Self::Absorbing => Some(ABSORBING),
            Self::Mirror => Some(MIRROR),
            Self::Diffuse => Some(DIFFUSE),
            Self::Filter | Self::Crystal => None,
        }
    }
}

/// Draws the walls that lie on the map and names their kinds.
pub(crate) fn draw(page: &mut MapFrame, walls: &Field<Option<Surface>>, legend: &mut Vec<Entry>) {
    let grid = page.grid;
    for kind in KINDS {
        let is_kind =
            |cell: Cell| grid.contains(cell) && walls.at(cell).as_ref().is_some_and(|s| Kind::of(s) == kind);
        let cells: Vec<Cell> = walls.grid().iter().filter(|c| is_kind(*c)).collect();
        if cells.is_empty() {
            continue;
        }
        if let Some(colour) = kind.fill() {
            let mut path = PathBuilder::default();
            for run in cells.chunk_by(|a, b| a.y == b.y && a.x + 1 == b.x) {
                let [width, height] = page.cell;
                let (x, y) = (page.left + run[0].x as f64 * width, page.top + run[0].y as f64 * height);
                path.rect(x, y, run.len() as f64 * width, height);
            }
            page.scene.fill(path.finish(), colour);
        }
        if kind == Kind::Crystal {
            outline(page, &cells, &is_kind);
        } else if page.smaller_side() >= LEAST_CELL_PX {
            let mut marks = Marks::default();
            for cell in &cells {
                if let Some(surface) = walls.at(*cell) {
                    marks.add(surface, page.centre(*cell), 0.5 * page.smaller_side());
                }
            }
            marks.draw(&mut page.scene);
        }
        legend.push(Entry::of(swatch(kind), kind.name()));
    }
}

/// Draws the boundary of a region: the sides that its cells do not share with each other.
fn outline(page: &mut MapFrame, cells: &[Cell], belongs: &dyn Fn(Cell) -> bool) {
    let mut boundary = PathBuilder::default();
    let [r, s] = page.cell.map(|side| 0.5 * side);
    for cell in cells {
        let PagePoint { x, y, .. } = page.centre(*cell);
        let beside = |dx: isize, dy: isize| {
            let next = cell.x.checked_add_signed(dx).zip(cell.y.checked_add_signed(dy));
            next.is_some_and(|(x, y)| belongs(Cell::new(x, y)))
        };
        for (dx, dy) in [(1, 0), (0, 1), (-1, 0), (0, -1)] {
            if !beside(dx, dy) {
                let (ux, uy) = (dx as f64, dy as f64);
                boundary.line([x + r * (ux - uy), y + s * (uy + ux)], [x + r * (ux + uy), y + s * (uy - ux)]);
            }
        }
    }
    let boundary = boundary.finish();
    // Dark on white, visible on every colour.
    page.scene.stroke(boundary.clone(), Rgba::WHITE, 2.4);
    page.scene.stroke(boundary, Rgba::INK, 1.0);
}

/// Strokes and dots of many cells.
#[derive(Default)]
struct Marks {
    mirrors: PathBuilder,
    dots: PathBuilder,
    filters: PathBuilder,
}

impl Marks {
    fn add(&mut self, surface: &Surface, centre: PagePoint, r: f64) {
        let PagePoint { x, y, .. } = centre;
        match surface {
            Surface::Absorbing | Surface::Crystal => {}
            // It faces all sides.
            Surface::Mirror { angle_deg: None } => self.mirrors.circle(centre, 0.5 * r),
            Surface::Mirror { angle_deg: Some(angle_deg) } => {
                let angle = math::radians(*angle_deg);
                let (dx, dy) = (0.8 * r * math::cos(angle), -0.8 * r * math::sin(angle));
                self.mirrors.line([x - dx, y - dy], [x + dx, y + dy]);
            }
            Surface::Diffuse { .. } => self.dots.circle(centre, 0.22 * r),
            Surface::Filter { .. } => {
                self.filters.line([x - r, y - r], [x + r, y + r]);
                self.filters.line([x, y - r], [x + r, y]);
                self.filters.line([x - r, y], [x, y + r]);
            }
        }
    }

    fn draw(self, scene: &mut Scene) {
        if !self.mirrors.is_empty() {
            scene.stroke(self.mirrors.finish(), MIRROR_LINE, 1.2);
        }
        if !self.dots.is_empty() {
            scene.fill(self.dots.finish(), DIFFUSE_DOT);
        }
        if !self.filters.is_empty() {
            scene.stroke(self.filters.finish(), Rgba::WHITE.with_opacity(0.75), 0.8);
        }
    }
}

/// Two cells of a kind for the legend, 22 x 11 pixels about (0, 0).
fn swatch(kind: Kind) -> Mark {
    let mut scene = Scene::sized(22.0, 11.0);
    let mut outline = PathBuilder::default();
    outline.rect(-11.0, -5.5, 22.0, 11.0);
    if kind == Kind::Crystal {
        // Only the boundary is drawn, without colour or marks.
        scene.stroke(outline.finish(), Rgba::INK, 1.0);
        return Mark::Drawing(scene.items);
    }
    scene.paint(outline.finish(), kind.fill().unwrap_or(Rgba::MUTED), Rgba::MUTED, 0.5);
    let mut marks = Marks::default();
    for x in [-5.5, 5.5] {
        let surface = match kind {
            Kind::Absorbing => Surface::Absorbing,
            Kind::Mirror => Surface::Mirror { angle_deg: Some(0.0) },
            Kind::Diffuse => Surface::Diffuse { angle_deg: Some(0.0) },
            Kind::Filter => Surface::Filter { transmittance: 0.5 },
            Kind::Crystal => Surface::Crystal,
        };
        marks.add(&surface, PagePoint::new(x, 0.0), 5.5);
    }
    marks.draw(&mut scene);
    Mark::Drawing(scene.items)
}

#[cfg(test)]
mod tests {
    use crate::{HeatOptions, HeatScale, Item, PolarOptions, heat_map, polar_overlay};
    use tigereye_core::{Cell, Directions, Field, Grid, LightDistribution, Surface};

    fn walls() -> Field<Option<Surface>> {
        let grid = Grid::new(12, 9).expect("a grid");
        Field::from_fn(grid, |c| match (c.x, c.y) {
            (0 | 11, _) => Some(Surface::Absorbing),
            (x, 4) => Some(Surface::Mirror { angle_deg: Some(15.0 * x as f64) }),
            (2..=4, 6) => Some(Surface::Diffuse { angle_deg: Some(0.0) }),
            (6..=9, 6..=7) => Some(Surface::Filter { transmittance: 0.5 }),
            (3..=8, 1..=2) => Some(Surface::Crystal),
            _ => None,
        })
    }

    /// All text of a picture, a line each.
    fn texts(items: &[Item]) -> String {
        let of = |item: &Item| match item {
            Item::Text(text) => format!("{}\n", text.text),
            Item::Group { items, .. } => texts(items),
            _ => String::new(),
        };
        items.iter().map(of).collect()
    }

    #[test]
    fn walls_are_drawn_named_and_left_out_of_the_range() {
        let walls = walls();
        let bright = Field::from_fn(walls.grid(), |c| if c.x == 0 { 1e6 } else { c.x as f64 });
        let with = |walls| {
            let quantity = "q".to_owned();
            let options = HeatOptions { walls, scale: HeatScale::Linear, quantity, ..HeatOptions::default() };
            heat_map(&bright, &options)
        };
        let (plain, scene) = (with(None), with(Some(walls)));
        for name in ["absorbing wall", "mirror", "diffuse wall", "filter", "crystal"] {
            assert!(texts(&scene.items).lines().any(|l| l == name), "{name}");
            assert!(!texts(&plain.items).contains(name), "{name}");
        }
        assert!(plain.description.contains("from 1 to 1"), "{}", plain.description);
        assert!(scene.description.contains("from 1 to 10"), "{}", scene.description);
        assert_ne!(plain.description, scene.description);
    }

    #[test]
    fn walls_are_drawn_over_light() {
        let (walls, d) = (walls(), Directions::new(8).expect("directions"));
        let cells = walls.grid().cells();
        let incoming = Field::from_fn(walls.grid(), |_| [1.0; 8]);
        let light = LightDistribution::new(d, vec![1.0; 8 * cells], incoming);
        let sources = vec![Cell::new(2, 2)];
        let options = PolarOptions { walls: Some(walls), sources, ..PolarOptions::default() };
        assert!(texts(&polar_overlay(None, Some(&light), &options).items).contains("diffuse wall"));
    }
}
