//! Figures from results.

use crate::comparison;
use crate::measure::{self, at_step, inner_cells, lobe_ratio, net_flux_ratio, ridge_columns};
use crate::runs::{LightResult, Results, RunError};
use crate::scene::missing_label;
use crate::settings::{PulsesSettings, RunSettings, Settings, axes_of, family_of, sample_of};
use crate::spec::{self, FlatView, Panel, ProfileSource, RidgeSource, SeriesSource};
use crate::ways::Ways;
use std::fmt::Write as _;
use tigereye_core::{
    Cell, CellShape, Field, Grid, LightDistribution, PolarProfile, Tensor2, transmission_ellipse,
};
use tigereye_fields::Expression;
use tigereye_lines::Following;
use tigereye_lines::{ConvolutionOptions, Family, LineOptions};
use tigereye_render::{
    Chart, ChartAxis, GlyphColour, GlyphOptions, GlyphScale, HeatOptions, HeatScale, IntensityScale,
    OrientationOptions, Overlay, PlainOptions, PolarOptions, PolarPlotOptions, PolarSeries, RenderError,
    Rgba, SERIES_PALETTE, Scene, Series, TransmissionScale, glyphs, heat_map, line_chart, orientation_map,
    plain_map, polar_overlay, polar_plot, small_multiples,
};
use tigereye_report::{DataFile, Figure};
use tigereye_transport::{Scheme, SharedWeights, emitter};
use tigereye_views::ftle;
use tigereye_views::lic::{self, TextureRequest};
use tigereye_views::lines::{LinesRequest, Seeds, lines};
use tigereye_views::point_overlays;
use tigereye_views::ridges::line_overlay;
use tigereye_views::topology::topology;

/// Points at which a formula is drawn.
const FORMULA_POINTS: usize = 121;
/// Width of a panel among others, pixels.
const PANEL_PX: usize = 330;
/// Resolution of the PNG files, pixels per unit.
const PNG_SCALE: f64 = 1.5;

/// Distance of lines in parts of the longer side.
const LINES_A_SIDE: f64 = 32.0;

/// Columns between neighbouring rows beyond which a ridge line is broken.
const LARGEST_JUMP: f64 = 2.0;

/// A figure with the tables behind its charts.
pub(crate) struct Drawn {
    pub(crate) figure: Figure,
    pub(crate) tables: Vec<DataFile>,
}

pub(crate) fn draw_figure(
    figure: &spec::Figure,
    settings: &Settings,
    results: &Results,
) -> Result<Drawn, RunError> {
    let draw = Draw { settings, results, alone: figure.panels.len() == 1 };
    let failed = |source| RunError::Figure { figure: figure.name.clone(), source };
    let mut panels = Vec::new();
    let mut tables = Vec::new();
    for panel in &figure.panels {
        let (title, scene) = draw.panel(panel, &figure.name)?;
        panels.push((title, scene));
        if let Panel::Chart { series, .. } = panel {
            let index = tables.len();
            let name =
                if index == 0 { figure.name.clone() } else { format!("{}-{}", figure.name, index + 1) };
            tables.push(draw.table(&name, series)?);
        }
    }
    let alt_of_panels: Vec<String> = panels.iter().map(|(t, s)| format!("{t}. {}", s.description)).collect();
    let mut frames = 0;
    if let Some(encoded) = figure.animation.as_ref().and_then(|a| draw.animation(a)) {
        let (bytes, count) = encoded.map_err(failed)?;
        tables.push(DataFile { name: format!("{}.apng", figure.name), bytes });
        frames = count;
    }
    let mut scene = match panels.len() {
        1 => panels.remove(0).1,
        _ => small_multiples(&panels, figure.columns.clamp(1, panels.len().max(1)), ""),
    };
    scene.title.clone_from(&figure.caption);
    scene.description = alt_of_panels.join(" ");
    let png = scene.to_png(PNG_SCALE).map_err(failed)?;
    let svg = scene.to_svg().map_err(failed)?;
    let draws_seconds = |panel: &Panel| match panel {
        Panel::Chart { series, .. } => series.iter().any(|s| matches!(s, SeriesSource::Seconds { .. })),
        _ => false,
    };
    let figure = Figure {
        timed: figure.panels.iter().any(draws_seconds),
        frames,
        name: figure.name.clone(),
        caption: figure.caption.clone(),
        alt: scene.description.clone(),
        width_px: scene.width_px,
        height_px: scene.height_px,
        png,
        svg,
    };
    Ok(Drawn { figure, tables })
}

struct Draw<'a> {
    settings: &'a Settings,
    results: &'a Results,
    alone: bool,
}

impl Draw<'_> {
    /// Heading and scene of a panel; among others the heading stands above it.
    fn panel(&self, panel: &Panel, figure: &str) -> Result<(String, Scene), RunError> {
        let failed = |source| RunError::Figure { figure: figure.to_owned(), source };
        let own_title = |title: &String| if self.alone { title.clone() } else { String::new() };
        match panel {
            Panel::Glyphs { field, colour, title } => {
                let cell = self.settings.cell(field);
                let fields = &self.settings.fields;
                let scene = fields.get(field).map(|f| self.glyphs((f, cell), *colour, own_title(title)));
                shown(scene, title, figure)
            }
            Panel::Orientation { field, title } => {
                let cell = self.settings.cell(field);
                let fields = &self.settings.fields;
                let scene = fields.get(field).map(|f| self.orientation((f, cell), own_title(title)));
                shown(scene, title, figure)
            }
            Panel::Lines { field, axes, major, family, title } => {
                let following = self.following(field, *axes, *major);
                let scene = following.and_then(|f| self.lines(f, *family, own_title(title)));
                shown(scene, title, figure)
            }
            Panel::Texture { field, axes, major, family, hyper, title } => {
                let following = self.following(field, *axes, *major);
                let scene = following.and_then(|f| self.texture(f, *family, *hyper, &own_title(title)));
                shown(scene, title, figure)
            }
            Panel::Map { map, ridges, title } => {
                shown(self.map(map, *ridges, own_title(title)), title, figure)
            }
            Panel::Ridges { field, sources, title } => {
                let cell = self.settings.cell(field);
                let fields = &self.settings.fields;
                let scene = fields.get(field).and_then(|f| self.ridges((f, cell), sources, own_title(title)));
                shown(scene, title, figure)
            }
            Panel::Overlay { run, step, scale, transmission, title } => {
                let scene = self.light(run).and_then(|r| {
                    self.overlay(run, r, at_step(r, *step)?, *scale, *transmission, own_title(title))
                });
                shown(scene, title, figure)
            }
            Panel::Energy { run, step, decades, way_to, title } => {
                let decades = decades.map(spec::Positive::get);
                let overlays = way_to.and_then(|to| self.ways(run, to)).unwrap_or_default();
                let scene = self
                    .light(run)
                    .and_then(|r| self.energy(run, r, *step, decades, (overlays, own_title(title))));
                shown(scene, title, figure)
            }
            Panel::Slice { run, deg, ridge, title } => {
                let scene = self.slice(run, deg.get(), *ridge, own_title(title));
                shown(scene, title, figure)
            }
            Panel::Flat { run, view, title } => {
                let scene = self.flat(run, *view, own_title(title));
                shown(scene, title, figure)
            }
            Panel::Polar { curves, quantity, title } => {
                let series: Vec<PolarSeries> =
                    curves.iter().enumerate().filter_map(|(i, c)| self.curve(i, c)).collect();
                let options = PolarPlotOptions {
                    title: own_title(title),
                    quantity: quantity.clone(),
                    ..PolarPlotOptions::default()
                };
                Ok((title.clone(), polar_plot(&series, &options)))
            }
            Panel::Chart { x, y, series, title } => {
                let scene = line_chart(&self.chart(x, y, series, own_title(title))?).map_err(failed)?;
                Ok((title.clone(), scene))
            }
        }
    }

    fn light(&self, run: &str) -> Option<&LightResult> {
        self.results.lights.get(run)
    }

    /// Pixels per cell: chosen by the picture where it stands alone, fitting a panel otherwise.
    fn cell_px(&self, grid: Grid) -> Option<usize> {
        self.cell_px_of(grid, CellShape::SQUARE)
    }

    /// The same for the smaller side of cells that need not be square.
    fn cell_px_of(&self, grid: Grid, cell: CellShape) -> Option<usize> {
        let longest = cell.longer_side([grid.width(), grid.height()]);
        (!self.alone).then(|| (PANEL_PX / longest.ceil() as usize).max(2))
    }

    fn glyphs(
        &self,
        (field, cell): (&Field<Tensor2>, CellShape),
        colour: spec::GlyphColour,
        title: String,
    ) -> Scene {
        let scale = if same_size(field) { GlyphScale::Field } else { GlyphScale::SquareRoot };
        let colour = match colour {
            spec::GlyphColour::Anisotropy => GlyphColour::Anisotropy,
            spec::GlyphColour::Sign => GlyphColour::AxisSign,
        };
        let cell_px = self.cell_px_of(field.grid(), cell);
        glyphs(field, &GlyphOptions { title, scale, colour, cell_px, cell, ..GlyphOptions::default() })
    }

    fn orientation(&self, (field, cell): (&Field<Tensor2>, CellShape), title: String) -> Scene {
        let cell_px = self.cell_px_of(field.grid(), cell);
        orientation_map(field, &OrientationOptions { title, cell_px, cell, ..OrientationOptions::default() })
    }

    /// A field with what is followed in it.
    fn following(
        &self,
        name: &str,
        axes: spec::AxesChoice,
        major: Option<spec::MajorChoice>,
    ) -> Option<(&Field<Tensor2>, Following)> {
        let field = self.settings.fields.get(name)?;
        Some((field, Following { axes: axes_of(axes, major, field), cell: self.settings.cell(name) }))
    }

    fn lines(
        &self,
        (field, following): (&Field<Tensor2>, Following),
        family: Option<spec::FamilyChoice>,
        title: String,
    ) -> Option<Scene> {
        let families = family.map_or(vec![Family::Major, Family::Minor], |f| vec![family_of(f)]);
        let longest = following.longer_side(field.grid());
        let request = LinesRequest {
            following,
            families,
            seeds: Seeds::Even((longest / LINES_A_SIDE).max(0.5)),
            options: LineOptions { step: 0.2, length: 2.0 * longest, ..LineOptions::default() },
            ribbon: None,
        };
        let points = topology(field, following, &[], &LineOptions::default()).points;
        let found = lines(field, &request).ok()?;
        let cell_px = self.cell_px_of(field.grid(), following.cell);
        Some(found.picture(field, &title, point_overlays(&points), cell_px))
    }

    fn texture(
        &self,
        (field, following): (&Field<Tensor2>, Following),
        family: spec::FamilyChoice,
        hyper: bool,
        title: &str,
    ) -> Option<Scene> {
        let longest = following.longer_side(field.grid()).ceil() as usize;
        // Whole pixels a sample, and at most eight samples a cell.
        let wanted = if self.alone { 2 * PANEL_PX } else { PANEL_PX } / longest;
        let pixels = wanted.div_ceil(8).max(1);
        let samples = (wanted / pixels).max(1);
        let options = ConvolutionOptions { samples, ..ConvolutionOptions::default() };
        let request = TextureRequest { following, family: family_of(family), hyper, options };
        let found = lic::texture(field, &request).ok()?;
        lic::picture(&found, field, &request, hyper, title, Some(samples * pixels)).ok()
    }

    fn map(&self, source: &spec::MapSource, ridges: bool, title: String) -> Option<Scene> {
        let overlays = if ridges {
            let found = comparison::ridges(&RidgeSource::Of(source.clone()), self.results)?;
            vec![line_overlay(&found, "height ridges", Rgba::hex(0xd62728))]
        } else {
            Vec::new()
        };
        if let spec::MapSource::Ftle { run } = source {
            let (_, settings) = self.settings.runs.iter().find(|(name, _)| name == run)?;
            let RunSettings::Ftle(settings) = settings else { return None };
            let (axes, cell) = (settings.following.axes, settings.following.cell);
            let cell_px = self.cell_px_of(self.settings.fields.get(&settings.field)?.grid(), cell);
            let found = self.results.ftle.get(run)?;
            return Some(ftle::picture(found, axes, &title, overlays, cell_px));
        }
        let field = comparison::map(source, self.results)?;
        let quantity = match source {
            spec::MapSource::Mean { .. } => "mean LTG / (W/rad)",
            spec::MapSource::Maximum { .. } => "largest LTG / (W/rad)",
            _ => "LTG / (W/rad)",
        };
        Some(self.gradient_map(source.run(), &field, quantity, overlays, title))
    }

    fn ridges(
        &self,
        (field, cell): (&Field<Tensor2>, CellShape),
        sources: &[(String, RidgeSource)],
        title: String,
    ) -> Option<Scene> {
        let overlays = sources.iter().zip(SERIES_PALETTE).map(|((label, source), colour)| {
            Some(line_overlay(&comparison::ridges(source, self.results)?, label, colour))
        });
        let options = PlainOptions {
            title,
            description: "Height ridges".to_owned(),
            cell_px: self.cell_px_of(field.grid(), cell),
            cell,
            overlays: overlays.collect::<Option<_>>()?,
            ..PlainOptions::default()
        };
        Some(plain_map(field.grid(), &options))
    }

    fn overlay(
        &self,
        run: &str,
        r: &LightResult,
        light: &LightDistribution,
        scale: spec::Scale,
        transmission: bool,
        title: String,
    ) -> Option<Scene> {
        let intensity = match scale {
            spec::Scale::Linear => IntensityScale::Linear { exclude_sources: false },
            spec::Scale::LinearWithoutSources => IntensityScale::Linear { exclude_sources: true },
            spec::Scale::PerCell => IntensityScale::PerCell,
            spec::Scale::Logarithmic => IntensityScale::Logarithmic { decades: 4.0 },
            spec::Scale::Decades(d) => IntensityScale::Logarithmic { decades: d.get() },
        };
        let options = PolarOptions {
            title,
            intensity,
            transmission: TransmissionScale::Rate,
            sources: r.sources.clone(),
            walls: self.results.surfaces.get(run).cloned(),
            cell_px: self.cell_px(r.last.grid()),
            ..PolarOptions::default()
        };
        Some(polar_overlay(transmission.then_some(&r.transmission), Some(light), &options))
    }

    fn energy(
        &self,
        run: &str,
        r: &LightResult,
        step: Option<usize>,
        decades: Option<f64>,
        (overlays, title): (Vec<Overlay>, String),
    ) -> Option<Scene> {
        let scale = decades.map_or(HeatScale::Linear, |decades| HeatScale::Logarithmic { decades });
        let options = HeatOptions {
            title,
            quantity: "energy of a cell / W".to_owned(),
            scale,
            sources: r.sources.clone(),
            walls: self.results.surfaces.get(run).cloned(),
            overlays,
            cell_px: self.cell_px(r.last.grid()),
            ..HeatOptions::default()
        };
        Some(heat_map(&at_step(r, step)?.energy(), &options))
    }

    /// The shortest way to a cell, and the brightest one over it.
    fn ways(&self, run: &str, to: (usize, usize)) -> Option<Vec<Overlay>> {
        let ways = Ways::of(self.settings, self.results, run, to)?;
        let line = |way: &[Cell], label: &str, colour, width_px| Overlay {
            label: label.to_owned(),
            points: way.iter().map(|c| [c.x as f64, c.y as f64]).collect(),
            colour,
            width_px,
            ..Overlay::default()
        };
        let blue = Rgba::hex(0x56b4e9);
        Some(vec![
            line(&ways.shortest, "shortest way (breadth-first search)", Rgba::hex(0xd55e00), 4.0),
            match &ways.brightest {
                Some(way) => line(way, "brightest way", blue, 1.2),
                None => line(&[], "brightest way: none, a summit lies before the light", blue, 1.2),
            },
        ])
    }

    /// Frames of a light run and their number.
    fn animation(&self, animation: &spec::Animation) -> Option<Result<(Vec<u8>, usize), RenderError>> {
        let r = self.light(&animation.run)?;
        let reel = r.reel.as_ref()?;
        let options = HeatOptions {
            quantity: "energy of a cell / W".to_owned(),
            sources: r.sources.clone(),
            walls: self.results.surfaces.get(&animation.run).cloned(),
            cell_px: Some((PANEL_PX / r.last.grid().width().max(r.last.grid().height())).max(2)),
            ..HeatOptions::default()
        };
        let decades = animation.decades.map_or(4.0, spec::Positive::get);
        Some(reel.encoded(&options, decades, animation.every.get()))
    }

    fn slice(&self, run: &str, deg: f64, ridge: bool, title: String) -> Option<Scene> {
        let volume = &self.results.gradients.get(run)?.volume;
        let slice = volume.slice(sample_of(deg, volume.directions()).ok()?)?;
        let overlays = if ridge { vec![ridge_line(&slice)] } else { Vec::new() };
        Some(self.gradient_map(run, &slice, "LTG / (W/rad)", overlays, title))
    }

    fn flat(&self, run: &str, view: FlatView, title: String) -> Option<Scene> {
        let volume = &self.results.gradients.get(run)?.volume;
        let (field, quantity) = match view {
            FlatView::Mean => (volume.mean_over_directions(), "mean LTG / (W/rad)"),
            FlatView::Maximum => (volume.max_over_directions(), "largest LTG / (W/rad)"),
            FlatView::Deviation => (volume.deviation_over_directions(), "deviation of LTG / (W/rad)"),
        };
        Some(self.gradient_map(run, &field, quantity, Vec::new(), title))
    }

    /// What is no result is drawn as missing, so that it does not stretch the scale.
    fn gradient_map(
        &self,
        run: &str,
        field: &Field<f64>,
        quantity: &str,
        overlays: Vec<Overlay>,
        title: String,
    ) -> Scene {
        let grid = field.grid();
        let inner = self.results.inner(run, field);
        let walls = self.results.surfaces.get(run).cloned();
        let missing = missing_label(walls.as_ref());
        let options = HeatOptions {
            title,
            quantity: quantity.to_owned(),
            walls,
            overlays,
            cell_px: self.cell_px(grid),
            missing: Some(missing.to_owned()),
            ..HeatOptions::default()
        };
        heat_map(&inner, &options)
    }

    fn curve(&self, index: usize, curve: &spec::Curve) -> Option<PolarSeries> {
        let (profile, colour, fill) = match &curve.source {
            ProfileSource::Emitter { theta_deg, power } => {
                let theta = tigereye_core::math::radians(theta_deg.get());
                let profile = emitter(measure::fine_directions()?, theta, power.get());
                (profile, SERIES_PALETTE[index % SERIES_PALETTE.len()], false)
            }
            ProfileSource::ConeWeight { neighbour, directions } => {
                let scheme = Scheme::new(directions.0, SharedWeights::Thesis);
                let weight = |t| scheme.weights(t)[neighbour % 8];
                let profile = PolarProfile::from_fn(directions.0, weight);
                (profile, SERIES_PALETTE[index % SERIES_PALETTE.len()], true)
            }
            ProfileSource::Ellipse { field, cell } => {
                let field = self.settings.fields.get(field)?;
                let cell = Cell::new(cell.0, cell.1);
                let inside = field.grid().contains(cell);
                let tensor = inside.then(|| field.at(cell))?;
                (transmission_ellipse(tensor, measure::fine_directions()?), Rgba::TRANSMISSION, true)
            }
            ProfileSource::Light { run, cell, step } => {
                let light = at_step(self.light(run)?, *step)?;
                let samples = profile_at(light.grid(), *cell, |c| light.profile(c).to_vec())?;
                (PolarProfile::from_samples(light.directions(), samples).ok()?, Rgba::LIGHT, true)
            }
            ProfileSource::Windowed { run, cell } => {
                let r = self.light(run)?;
                let samples = profile_at(r.last.grid(), *cell, |c| {
                    r.last.profile(c).iter().zip(r.transmission.shape(c)).map(|(i, t)| i * t).collect()
                })?;
                let purple = SERIES_PALETTE[index % SERIES_PALETTE.len()];
                (PolarProfile::from_samples(r.last.directions(), samples).ok()?, purple, false)
            }
        };
        Some(PolarSeries { label: curve.label.clone(), profile, colour, fill, dash_px: Vec::new() })
    }

    fn chart(
        &self,
        x: &spec::Axis,
        y: &spec::Axis,
        series: &[SeriesSource],
        title: String,
    ) -> Result<Chart, RunError> {
        let axis =
            |a: &spec::Axis| ChartAxis { label: a.label.clone(), logarithmic: a.logarithmic, range: None };
        let series = series
            .iter()
            .map(|s| {
                let (label, points) = self.series(s)?;
                // A formula is a line; what was computed or published at separate places also has markers.
                let formula = matches!(s, SeriesSource::Formula { .. });
                let markers = !formula && points.len() <= 60;
                Ok(Series { label, points, line: true, markers, ..Series::default() })
            })
            .collect::<Result<_, RunError>>()?;
        Ok(Chart { title, x: axis(x), y: axis(y), series, ..Chart::default() })
    }

    /// Legend and points of a series; empty where its run has nothing to show.
    fn series(&self, source: &SeriesSource) -> Result<(String, Vec<(f64, f64)>), RunError> {
        use SeriesSource as S;
        let counted = |values: Vec<f64>| values.into_iter().enumerate().map(|(i, v)| (i as f64, v)).collect();
        Ok(match source {
            S::Points { label, points } => {
                (label.clone(), points.iter().map(|p| (p.0.get(), p.1.get())).collect())
            }
            S::Formula { label, expression, range } => {
                let f = parse_in_x(expression)?;
                let (a, b) = (range.0.get(), range.1.get());
                let at = |i: usize| a + (b - a) * i as f64 / (FORMULA_POINTS - 1) as f64;
                (label.clone(), (0..FORMULA_POINTS).map(|i| (at(i), f.eval(&[at(i)]))).collect())
            }
            S::Deviation { label, of, from } => {
                let f = parse_in_x(from)?;
                let (_, points) = self.series(of)?;
                (label.clone(), points.into_iter().map(|(x, y)| (x, y - f.eval(&[x]))).collect())
            }
            S::NetFlux { label, run, to } => (label.clone(), self.along(run, *to, net_flux_ratio)),
            S::OutwardLobe { label, run, to } => (label.clone(), self.along(run, *to, lobe_ratio)),
            S::EnergyError { label, run } => {
                let energies = self.light(run).map(|r| r.energies.clone()).unwrap_or_default();
                let start = energies.first().copied().unwrap_or(0.0);
                (label.clone(), counted(energies.iter().map(|e| (e - start).abs()).collect()))
            }
            S::RadiusMean { label, run } => (
                label.clone(),
                counted(self.light(run).map_or(Vec::new(), |r| r.radii.iter().map(|r| r.0).collect())),
            ),
            S::RadiusSpread { label, run } => (
                label.clone(),
                counted(self.light(run).map_or(Vec::new(), |r| r.radii.iter().map(|r| r.1).collect())),
            ),
            S::Seconds { label, runs } => {
                let taken =
                    |(i, run): (usize, &String)| Some(((i + 1) as f64, *self.results.seconds.get(run)?));
                (label.clone(), runs.iter().enumerate().filter_map(taken).collect())
            }
            S::SliceRow { label, run, deg, row } => {
                (label.clone(), self.slice_row(run, deg.get(), *row).unwrap_or_default())
            }
            S::PulsesOverColumn { label, run, number, deg } => {
                (label.clone(), self.pulses_over_column(run, *number, deg.get()).unwrap_or_default())
            }
            S::MeanOverCells { label, run } => (label.clone(), self.mean_over_cells(run).unwrap_or_default()),
        })
    }

    fn along(&self, run: &str, to: usize, f: impl Fn(&LightResult, usize) -> Option<f64>) -> Vec<(f64, f64)> {
        let Some(r) = self.light(run) else { return Vec::new() };
        (1..=to).filter_map(|d| Some((d as f64, f(r, d)?))).collect()
    }

    fn slice_row(&self, run: &str, deg: f64, row: usize) -> Option<Vec<(f64, f64)>> {
        let volume = &self.results.gradients.get(run)?.volume;
        let slice = volume.slice(sample_of(deg, volume.directions()).ok()?)?;
        let w = slice.grid().width();
        (row < slice.grid().height())
            .then(|| (1..w - 1).map(|x| (x as f64, *slice.at(Cell::new(x, row)))).collect())
    }

    fn pulses_over_column(&self, run: &str, number: spec::PulseNumber, deg: f64) -> Option<Vec<(f64, f64)>> {
        let (_, settings) = self.settings.runs.iter().find(|(name, _)| name == run)?;
        let RunSettings::Pulses(PulsesSettings { setup, .. }) = settings else { return None };
        let sample = sample_of(deg, setup.directions).ok()?;
        let pulses = self.results.pulses.get(run)?.iter().filter(|p| p.sample == sample);
        Some(pulses.map(|p| (p.cell.x as f64, p.number(number))).collect())
    }

    fn mean_over_cells(&self, run: &str) -> Option<Vec<(f64, f64)>> {
        let volume = &self.results.gradients.get(run)?.volume;
        let cells: Vec<Cell> = inner_cells(volume.grid()).collect();
        let mean = |t| {
            Some(cells.iter().map(|&c| volume.value(c, t)).sum::<Option<f64>>()? / cells.len().max(1) as f64)
        };
        volume.slices().iter().map(|&t| Some((volume.directions().angle_deg(t), mean(t)?))).collect()
    }

    /// The points of a chart as comma-separated values.
    fn table(&self, name: &str, series: &[SeriesSource]) -> Result<DataFile, RunError> {
        let mut text = String::from("series,x,y\n");
        for s in series {
            let (label, points) = self.series(s)?;
            for (x, y) in points {
                let quoted = label.replace('"', "\"\"");
                // Writing to a string cannot fail.
                let _ = writeln!(text, "\"{quoted}\",{x:?},{y:?}");
            }
        }
        Ok(DataFile { name: format!("{name}.csv"), bytes: text.into_bytes() })
    }
}

/// A panel that has nothing to show is a mistake in the file, not an empty picture.
fn shown(scene: Option<Scene>, title: &str, figure: &str) -> Result<(String, Scene), RunError> {
    let missing = || RunError::Panel { figure: figure.to_owned(), panel: title.to_owned() };
    scene.map(|s| (title.to_owned(), s)).ok_or_else(missing)
}

fn parse_in_x(text: &str) -> Result<Expression, RunError> {
    Expression::parse(text, &["x"])
        .map_err(|e| RunError::Expression { expression: text.to_owned(), problem: e.to_string() })
}

fn profile_at(grid: Grid, cell: (usize, usize), f: impl Fn(Cell) -> Vec<f64>) -> Option<Vec<f64>> {
    let cell = Cell::new(cell.0, cell.1);
    grid.contains(cell).then(|| f(cell))
}

fn ridge_line(slice: &Field<f64>) -> Overlay {
    let ridge = ridge_columns(slice);
    // Where the largest value jumps from row to row there is no ridge to follow.
    let near = |y: usize, other: Option<&Option<f64>>| match (ridge[y], other) {
        (Some(a), Some(Some(b))) => (a - b).abs() <= LARGEST_JUMP,
        _ => false,
    };
    let follows = |y: usize| near(y, ridge.get(y + 1)) || (y > 0 && near(y, ridge.get(y - 1)));
    let point = |(y, x): (usize, &Option<f64>)| [x.filter(|_| follows(y)).unwrap_or(f64::NAN), y as f64];
    let points = ridge.iter().enumerate().map(point).collect();
    Overlay { label: "largest value of each row".to_owned(), points, ..Overlay::default() }
}

/// Whether the largest and smallest ellipses of a field differ by less than a factor of four.
fn same_size(field: &Field<tigereye_core::Tensor2>) -> bool {
    let sizes = || field.values().iter().map(tigereye_core::Tensor2::max_abs).filter(|s| *s > 0.0);
    let (low, high) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    high <= 4.0 * low
}
