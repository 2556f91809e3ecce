//! One large polar diagram with rings and spokes.

use crate::axis::Axis;
use crate::colour::Rgba;
use crate::font;
use crate::legend::{self, Entry, Mark, SMALL_PX};
use crate::map_frame::{MARGIN_PX, TITLE_PX};
use crate::number;
use crate::scene::{Anchor, PagePoint, PathBuilder, Scene};
use crate::shapes;
use tigereye_core::{PolarProfile, math};

/// One curve of a polar plot.
#[derive(Debug, Clone, PartialEq)]
pub struct PolarSeries {
    /// Name for the legend.
    pub label: String,
    /// The curve; negative values are drawn as 0.
    pub profile: PolarProfile,
    /// Colour.
    pub colour: Rgba,
    /// Whether its inside is tinted.
    pub fill: bool,
    /// Lengths of dashes and gaps in pixels; empty for a solid line.
    pub dash_px: Vec<f64>,
}

/// Options of [`polar_plot`].
#[derive(Debug, Clone, PartialEq)]
pub struct PolarPlotOptions {
    /// Title; may be empty.
    pub title: String,
    /// Quantity of the radius with its unit.
    pub quantity: String,
    /// Value of the outer ring; by default the largest value, rounded up.
    pub maximum: Option<f64>,
    /// Diameter of the outer ring in pixels.
    pub diameter_px: f64,
    /// Angle between spokes in degrees.
    pub spoke_deg: f64,
}

impl Default for PolarPlotOptions {
    fn default() -> Self {
        Self {
            title: String::new(),
            quantity: String::new(),
            maximum: None,
            diameter_px: 360.0,
            spoke_deg: 30.0,
        }
    }
}

/// The curves about a common centre: 0 degrees to the right, 90 degrees up.
#[must_use]
pub fn polar_plot(series: &[PolarSeries], options: &PolarPlotOptions) -> Scene {
    let diameter =
        if options.diameter_px.is_finite() { options.diameter_px.clamp(80.0, 4000.0) } else { 360.0 };
    let radius = 0.5 * diameter;
    let width = diameter + 2.0 * (MARGIN_PX + 36.0);
    let mut scene = Scene::sized(width, 0.0);
    let mut top = MARGIN_PX;
    for line in font::wrapped(&options.title, TITLE_PX, width - 2.0 * MARGIN_PX) {
        scene.text([0.5 * width, top + 13.0], &line, TITLE_PX, Rgba::INK, Anchor::Middle);
        top += 20.0;
    }
    let centre = PagePoint::new(0.5 * width, top + radius + 26.0);
    let disc = Disc { centre, radius, axis: radial_axis(series, options) };
    disc.draw_grid(&mut scene, options.spoke_deg);
    for s in series {
        disc.draw_series(&mut scene, s);
    }
    disc.draw_ring_labels(&mut scene);
    let entries = legend_entries(series, options);
    let row = legend::flow(&entries, width - 2.0 * MARGIN_PX);
    let below = disc.centre.y + radius + 34.0;
    let (row_width, row_height) = (row.width_px, row.height_px);
    scene.place(row, 0.5 * (width - row_width), below, 1.0);
    scene.height_px = below + row_height + 0.5 * MARGIN_PX;
    scene.title.clone_from(&options.title);
    scene.description = format!(
        "Polar diagram of {}: {}; outer ring {}.",
        if options.quantity.is_empty() { "profiles" } else { &options.quantity },
        if series.is_empty() { "no data" } else { "curves about a common centre, 90 degrees up" },
        number::significant(disc.axis.high, 4)
    );
    scene
}

fn radial_axis(series: &[PolarSeries], options: &PolarPlotOptions) -> Axis {
    let samples = series.iter().flat_map(|s| s.profile.samples().iter().copied());
    let largest = samples.filter(|v| v.is_finite()).fold(0.0, f64::max);
    match options.maximum.filter(|m| m.is_finite() && *m > 0.0) {
        Some(maximum) => Axis::linear(0.0, maximum),
        None => Axis::linear(0.0, largest).rounded_outwards(4),
    }
}

fn legend_entries(series: &[PolarSeries], options: &PolarPlotOptions) -> Vec<Entry> {
    let mut entries: Vec<Entry> = series
        .iter()
        .map(|s| {
            let mark =
                Mark::Line { colour: s.colour, width_px: 2.0, dash_px: s.dash_px.clone(), marker: None };
            Entry::of(mark, s.label.clone())
        })
        .collect();
    if series.is_empty() {
        entries.push(Entry::of(Mark::None, "no data"));
    }
    if !options.quantity.is_empty() {
        entries.push(Entry::of(Mark::None, format!("radius: {}", options.quantity)));
    }
    entries
}

struct Disc {
    centre: PagePoint,
    radius: f64,
    axis: Axis,
}

impl Disc {
    fn point(&self, share: f64, angle_rad: f64) -> PagePoint {
        let r = share * self.radius;
        PagePoint::new(self.centre.x + r * math::cos(angle_rad), self.centre.y - r * math::sin(angle_rad))
    }

    fn draw_grid(&self, scene: &mut Scene, spoke_deg: f64) {
        let mut rings = PathBuilder::default();
        for tick in self.axis.ticks(4).iter().filter(|t| t.value > 0.0 && t.value < self.axis.high) {
            rings.circle(self.centre, self.axis.position(tick.value) * self.radius);
        }
        let step = if spoke_deg.is_finite() { spoke_deg.clamp(5.0, 180.0) } else { 30.0 };
        for i in 0..(360.0 / step).ceil() as usize {
            let degrees = i as f64 * step;
            let angle = math::radians(degrees);
            rings.line(self.centre, self.point(1.0, angle));
            self.draw_spoke_label(scene, degrees, angle);
        }
        scene.stroke(rings.finish(), Rgba::HAIRLINE, 0.8);
        let mut rim = PathBuilder::default();
        rim.circle(self.centre, self.radius);
        scene.stroke(rim.finish(), Rgba::MUTED, 0.8);
    }

    fn draw_spoke_label(&self, scene: &mut Scene, degrees: f64, angle: f64) {
        let (cos, sin) = (math::cos(angle), math::sin(angle));
        let anchor = if cos > 0.1 {
            Anchor::Start
        } else if cos < -0.1 {
            Anchor::End
        } else {
            Anchor::Middle
        };
        let PagePoint { x, y, .. } = self.point(1.0 + 7.0 / self.radius, angle);
        // The text's middle moves from its foot (label above) to its head (label below).
        let baseline = y + 0.5 * font::CAP_HEIGHT_EM * SMALL_PX * (1.0 - sin);
        scene.text(
            [x, baseline],
            &format!("{}°", number::label(degrees, 0.1)),
            SMALL_PX,
            Rgba::MUTED,
            anchor,
        );
    }

    fn draw_ring_labels(&self, scene: &mut Scene) {
        // Between two spokes, on a white patch so that curves do not cross the numbers.
        let angle = math::radians(75.0);
        for tick in self.axis.ticks(4).iter().filter(|t| t.value > 0.0 && t.value < self.axis.high * 0.999) {
            self.draw_ring_label(scene, &tick.label, self.point(self.axis.position(tick.value), angle));
        }
        let outer = number::significant(self.axis.high, 3);
        let PagePoint { x, y, .. } = self.point(1.0 + 9.0 / self.radius, angle);
        scene.text([x, y + 3.6], &outer, 10.0, Rgba::MUTED, Anchor::Middle);
    }

    fn draw_ring_label(&self, scene: &mut Scene, label: &str, PagePoint { x, y, .. }: PagePoint) {
        let size = 10.0;
        let (width, height) = (font::text_width(label, size), font::CAP_HEIGHT_EM * size);
        let mut patch = PathBuilder::default();
        patch.rect(x - 0.5 * width - 2.0, y - 0.5 * height - 2.0, width + 4.0, height + 4.0);
        scene.fill(patch.finish(), Rgba::WHITE.with_opacity(0.85));
        scene.text([x, y + 0.5 * height], label, size, Rgba::MUTED, Anchor::Middle);
    }

    fn draw_series(&self, scene: &mut Scene, series: &PolarSeries) {
        let directions = series.profile.directions();
        let points: Vec<PagePoint> = series
            .profile
            .samples()
            .iter()
            .enumerate()
            // A fixed outer ring cuts longer curves.
            .map(|(t, v)| self.point(self.axis.position(*v).clamp(0.0, 1.0), directions.angle_rad(t)))
            .collect();
        let mut path = PathBuilder::default();
        path.polyline(&points, true);
        let segments = path.finish();
        if series.fill {
            scene.fill(segments.clone(), series.colour.with_opacity(0.15));
        }
        shapes::dashed(scene, segments, series.colour, 2.0, &series.dash_px);
    }
}
