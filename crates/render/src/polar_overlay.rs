//! Transmission and light of every cell as small polar diagrams, as in the thesis's figures.

use crate::colour::Rgba;
use crate::legend::{Entry, Mark};
use crate::map_frame::{self, MapFrame};
use crate::mask;
use crate::overlay::{self, Overlay};
use crate::scene::{PagePoint, PathBuilder, Scene};
use crate::shapes;
use crate::style::Style;
use crate::walls;
use tigereye_core::{
    Cell, CellShape, Directions, Field, Grid, LightDistribution, Surface, TransmissionField, math,
};

/// How intensity profiles are scaled against each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum IntensityScale {
    /// Radius proportional to intensity; the brightest sample of the field fills its cell.
    Linear {
        /// Leaves the cells of [`PolarOptions::sources`] out of the comparison; they are drawn at most as large as a
        /// cell.
        exclude_sources: bool,
    },
    /// Every cell is filled by its own maximum: only shapes are comparable.
    PerCell,
    /// The longest radius of a cell falls linearly with the logarithm of its mean intensity, from the brightest cell
    /// down to 0 at `decades` below; the shape is kept. This keeps light visible that decays with distance.
    Logarithmic {
        /// Decades shown, positive.
        decades: f64,
    },
}

/// How transmission profiles are scaled against each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TransmissionScale {
    /// Every cell is filled by its own maximum: only shapes are comparable.
    #[default]
    PerCell,
    /// The longest radius is proportional to the cell's mean transmission, relative to the largest mean of the field:
    /// cells that absorb are small. The shape is kept.
    Rate,
}

/// Options of [`polar_overlay`].
#[derive(Debug, Clone, PartialEq)]
pub struct PolarOptions {
    /// Title; may be empty.
    pub title: String,
    /// Scaling of light.
    pub intensity: IntensityScale,
    /// Scaling of transmission.
    pub transmission: TransmissionScale,
    /// Cells of light sources, marked.
    pub sources: Vec<Cell>,
    /// What a marked cell is, in the singular.
    pub source_name: &'static str,
    /// What the blue diagrams show.
    pub quantity: &'static str,
    /// Walls of a scene over the diagrams.
    pub walls: Option<Field<Option<Surface>>>,
    /// Draws every n-th cell; by default as many as stay readable.
    pub every: Option<usize>,
    /// Pixels per cell; by default whole, such that the longer side has about 720.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
    /// Points and lines over the diagrams.
    pub overlays: Vec<Overlay>,
    /// Cells without a tensor, drawn grey.
    pub masked: Vec<Cell>,
    /// What of all this is chosen otherwise.
    pub style: Style,
}

impl Default for PolarOptions {
    fn default() -> Self {
        Self {
            title: String::new(),
            intensity: IntensityScale::Logarithmic { decades: 4.0 },
            transmission: TransmissionScale::PerCell,
            sources: Vec::new(),
            source_name: "light source",
            quantity: "light intensity",
            walls: None,
            every: None,
            cell_px: None,
            cell: CellShape::SQUARE,
            overlays: Vec::new(),
            masked: Vec::new(),
            style: Style::default(),
        }
    }
}

/// The least distance of two diagrams in pixels.
const PITCH_PX: f64 = 12.0;
/// Curves shorter than this cannot be seen.
const INVISIBLE_PX: f64 = 0.2;
const SOURCE_FILL: Rgba = Rgba::hex(0xffefb8);
const SOURCE_LINE: Rgba = Rgba::hex(0xe69f00);
const ABSORBING: Rgba = Rgba::hex(0xdedede);

/// In every cell the transmission profile in red and the intensity profile in blue, 90 degrees pointing up. Without
/// either, only the other is drawn; if their grids differ, only the light.
#[must_use]
pub fn polar_overlay(
    transmission: Option<&TransmissionField>,
    light: Option<&LightDistribution>,
    options: &PolarOptions,
) -> Scene {
    let Some(grid) = light.map(LightDistribution::grid).or(transmission.map(TransmissionField::grid)) else {
        return nothing(options.style.title_or(&options.title));
    };
    let transmission = transmission.filter(|t| t.grid() == grid);
    let cell = map_frame::cell_px(grid, options.cell, options.cell_px, 720, 72);
    let mut page = MapFrame::begin(grid, (&options.style, &options.title), cell, &|_| 0.0);
    let smaller = page.smaller_side();
    let every = options.every.unwrap_or_else(|| map_frame::stride(smaller, PITCH_PX)).max(1);
    let mut legend = Vec::new();
    draw_grounds(&mut page, transmission, options, &mut legend);
    page.grid_lines(every, Rgba::HAIRLINE);
    let cells: Vec<Cell> = map_frame::sampled_cells(grid, every).collect();
    let radius = 0.46 * smaller * every as f64;
    // The stroke of a few hundred diagrams must not become a carpet.
    let line_px = (radius / 14.0).clamp(0.5, 1.3);
    if let Some(t) = transmission {
        draw_transmission(&mut page, t, &cells, radius, line_px, options, &mut legend);
    }
    if let Some(l) = light {
        draw_light(&mut page, l, &cells, radius, line_px, options, &mut legend);
    }
    if let Some(walls) = options.walls.as_ref().filter(|walls| walls.grid() == grid) {
        walls::draw(&mut page, walls, &mut legend);
    }
    overlay::draw(&mut page, &options.overlays, &mut legend);
    if every > 1 {
        legend.push(Entry::of(Mark::None, format!("one diagram per {every} × {every} cells")));
    }
    page.finish(description(grid, transmission.is_some(), light.is_some()), &legend)
}

fn nothing(title: &str) -> Scene {
    let mut scene = Scene::sized(300.0, 60.0);
    let middle = crate::scene::Anchor::Middle;
    scene.text([150.0, 34.0], "neither transmission nor light given", 12.0, Rgba::MUTED, middle);
    scene.title = title.to_owned();
    scene.description = "Neither transmission nor light was given.".to_owned();
    scene
}

fn description(grid: Grid, transmission: bool, light: bool) -> String {
    let what = match (transmission, light) {
        (true, true) => "transmission (red) and light intensity (blue)",
        (true, false) => "transmission (red)",
        _ => "light intensity (blue)",
    };
    format!(
        "Polar diagrams of {what} in {} x {} cells, row 0 on top, 90 degrees pointing up.",
        grid.width(),
        grid.height()
    )
}

fn draw_grounds(
    page: &mut MapFrame,
    transmission: Option<&TransmissionField>,
    options: &PolarOptions,
    legend: &mut Vec<Entry>,
) {
    if let Some(t) = transmission {
        // The walls of a scene are drawn separately.
        let hidden = |cell| {
            let walls = options.walls.as_ref().filter(|walls| walls.grid() == t.grid());
            walls.is_some_and(|w| w.at(cell).as_ref().is_some_and(Surface::is_wall))
        };
        let masked = mask::within(&options.masked, t.grid());
        mask::draw(page, &masked);
        mask::explain(&masked, &options.style, legend);
        let is_dark = |c: &Cell| t.rate(*c) == 0.0 && !*masked.at(*c) && !hidden(*c);
        let dark = page.squares(t.grid().iter().filter(is_dark));
        if !dark.is_empty() {
            page.scene.fill(dark.finish(), ABSORBING);
            legend.push(Entry::of(Mark::Swatch(ABSORBING), "absorbs all light"));
        }
    }
    if !options.sources.is_empty() {
        let lit = page.squares(options.sources.iter().copied());
        page.scene.paint(lit.finish(), SOURCE_FILL, SOURCE_LINE, 1.0);
        let name = options.source_name;
        let text = if options.sources.len() == 1 { name.to_owned() } else { format!("{name}s") };
        legend.push(Entry::of(Mark::Outlined(SOURCE_FILL, SOURCE_LINE), text));
    }
}

fn draw_transmission(
    page: &mut MapFrame,
    field: &TransmissionField,
    cells: &[Cell],
    radius: f64,
    line_px: f64,
    options: &PolarOptions,
    legend: &mut Vec<Entry>,
) {
    let largest = field.rates().iter().copied().fold(0.0, f64::max);
    let mut path = PathBuilder::default();
    for &cell in cells {
        let longest = match options.transmission {
            TransmissionScale::PerCell => radius,
            TransmissionScale::Rate if largest > 0.0 => radius * field.rate(cell) / largest,
            TransmissionScale::Rate => 0.0,
        };
        add_curve(&mut path, page.centre(cell), field.shape(cell), field.directions(), longest);
    }
    // In dense pictures red must not drown the blue.
    let red = Rgba::TRANSMISSION.with_opacity(if radius < 12.0 { 0.65 } else { 1.0 });
    paint(page, path, red, 0.10, line_px);
    let text = match options.transmission {
        TransmissionScale::PerCell => "transmission (each cell scaled to itself)",
        TransmissionScale::Rate => "transmission (size: mean of the cell)",
    };
    legend.push(outlined(Rgba::TRANSMISSION, 0.10, text.to_owned()));
}

fn draw_light(
    page: &mut MapFrame,
    light: &LightDistribution,
    cells: &[Cell],
    radius: f64,
    line_px: f64,
    options: &PolarOptions,
    legend: &mut Vec<Entry>,
) {
    let excluded = matches!(options.intensity, IntensityScale::Linear { exclude_sources: true });
    let compared = light.grid().iter().filter(|c| !(excluded && options.sources.contains(c)));
    let (mut brightest, mut brightest_mean) = (0.0_f64, 0.0_f64);
    for cell in compared {
        brightest = brightest.max(maximum(light.profile(cell)));
        brightest_mean = brightest_mean.max(finite_mean(light.profile(cell)));
    }
    let mut path = PathBuilder::default();
    for &cell in cells {
        let profile = light.profile(cell);
        let share = match options.intensity {
            IntensityScale::Linear { .. } => maximum(profile) / brightest,
            IntensityScale::PerCell => 1.0,
            IntensityScale::Logarithmic { decades } => {
                1.0 + math::log10(finite_mean(profile) / brightest_mean) / decades.max(1e-3)
            }
        };
        let longest = if share.is_nan() { 0.0 } else { radius * share.clamp(0.0, 1.0) };
        add_curve(&mut path, page.centre(cell), profile, light.directions(), longest);
    }
    let dark = path.is_empty();
    paint(page, path, Rgba::LIGHT, if radius < 12.0 { 0.45 } else { 0.28 }, line_px);
    let quantity = options.quantity;
    let text = match options.intensity {
        _ if dark => format!("{quantity}: no cell is lit"),
        IntensityScale::Linear { exclude_sources: true } => {
            format!("{quantity}, linear (sources not to scale)")
        }
        IntensityScale::Linear { exclude_sources: false } => format!("{quantity}, linear"),
        IntensityScale::PerCell => format!("{quantity} (each cell scaled to itself)"),
        IntensityScale::Logarithmic { decades } => {
            format!("{quantity}, size logarithmic over {decades} decades")
        }
    };
    legend.push(outlined(Rgba::LIGHT, 0.28, text));
}

fn paint(page: &mut MapFrame, path: PathBuilder, colour: Rgba, opacity: f64, line_px: f64) {
    if !path.is_empty() {
        page.scene.paint(path.finish(), colour.with_opacity(opacity), colour, line_px);
    }
}

fn outlined(colour: Rgba, opacity: f64, text: String) -> Entry {
    Entry::of(Mark::Outlined(colour.with_opacity(opacity), colour), text)
}

/// Adds a closed polar curve whose largest sample is `longest` pixels long.
fn add_curve(
    path: &mut PathBuilder,
    PagePoint { x, y, .. }: PagePoint,
    samples: &[f64],
    directions: Directions,
    longest: f64,
) {
    let largest = maximum(samples);
    if largest <= 0.0 || longest < INVISIBLE_PX {
        return;
    }
    let mut points: Vec<PagePoint> = (0..samples.len())
        .map(|t| {
            let share = if samples[t].is_finite() { (samples[t] / largest).clamp(0.0, 1.0) } else { 0.0 };
            let [ux, uy] = directions.unit(t);
            PagePoint::new(x + longest * share * ux, y - longest * share * uy)
        })
        .collect();
    points.push(points[0]);
    let mut points = shapes::simplified(&points, 0.06);
    points.pop();
    path.polyline(&points, true);
}

fn maximum(samples: &[f64]) -> f64 {
    samples.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max)
}

fn finite_mean(samples: &[f64]) -> f64 {
    samples.iter().copied().filter(|v| v.is_finite() && *v > 0.0).sum::<f64>() / samples.len() as f64
}
