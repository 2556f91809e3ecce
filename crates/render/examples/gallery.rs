//! Draws one picture of every kind from made-up data into the folder given on the command line.

use std::error::Error;
use std::path::{Path, PathBuf};
use tigereye_core::{
    Cell, Directions, Field, Grid, LightDistribution, Normalization, Point, PolarProfile, Tensor2,
    TransmissionField, math,
};
use tigereye_render::{
    Chart, ChartAxis, ColourMap, Difference, GlyphColour, GlyphKind, GlyphOptions, GlyphScale, HeatOptions,
    HeatScale, IntensityScale, Marker, OrientationOptions, Overlay, PolarOptions, PolarPlotOptions,
    PolarSeries, Reference, Rgba, Ribbon, Scene, Series, TextureOptions, Tint, TransmissionScale,
    difference_map, glyphs, heat_map, line_chart, orientation_map, polar_overlay, polar_plot,
    small_multiples, texture_map,
};

type Outcome = Result<(), Box<dyn Error>>;

fn main() -> Outcome {
    let folder = std::env::args().nth(1).map(PathBuf::from).ok_or("usage: gallery FOLDER")?;
    std::fs::create_dir_all(&folder)?;
    maps(&folder)?;
    tensors(&folder)?;
    kinds(&folder)?;
    fine(&folder)?;
    overlays(&folder)?;
    curves(&folder)?;
    charts(&folder)?;
    multiples(&folder)?;
    awkward(&folder)
}

fn save(folder: &Path, name: &str, scene: &Scene) -> Outcome {
    std::fs::write(folder.join(format!("{name}.png")), scene.to_png(1.5)?)?;
    std::fs::write(folder.join(format!("{name}.svg")), scene.to_svg()?)?;
    Ok(())
}

/// Offsets from the centre in cells, y up.
fn from_centre(grid: Grid, c: Cell) -> (f64, f64) {
    let m = grid.centre();
    (c.x as f64 - m.x as f64, m.y as f64 - c.y as f64)
}

fn radial(grid: Grid, value: impl Fn(f64) -> f64) -> Field<f64> {
    Field::from_fn(grid, |c| {
        let (x, y) = from_centre(grid, c);
        value(math::hypot(x, y))
    })
}

/// Major axes along circles about the centre.
fn rings(grid: Grid) -> Field<Tensor2> {
    Field::from_fn(grid, |c| {
        let (x, y) = from_centre(grid, c);
        Tensor2::from_eigen(
            math::atan2(y, x) + math::FRAC_PI_2,
            1.0,
            if x == 0.0 && y == 0.0 { 1.0 } else { 0.2 },
        )
    })
}

/// Three circles, interrupted lines of one overlay.
fn circles(centre: Point) -> Vec<Point> {
    let mut points = Vec::new();
    for radius in [12.0, 25.0, 40.0] {
        points.extend((0..=90).map(|i| {
            let angle = math::TAU * f64::from(i) / 90.0;
            Point::new(centre.x + radius * math::cos(angle), centre.y + radius * math::sin(angle))
        }));
        points.push(Point::splat(f64::NAN));
    }
    points
}

fn maps(folder: &Path) -> Outcome {
    let grid = Grid::new(51, 51)?;
    let light = radial(grid, |r| if r > 22.0 { 0.0 } else { math::exp(-0.5 * r) });
    let along = |x: f64| Point::new(x + 12.0, 25.0 + 8.0 * math::sin(x / 4.0));
    let ridge = (0..=24).map(|i| along(f64::from(i))).collect();
    let options = HeatOptions {
        title: "Energy of the light around one source, continuous emission".to_owned(),
        quantity: "energy (W)".to_owned(),
        scale: HeatScale::Logarithmic { decades: 4.0 },
        sources: vec![grid.centre()],
        overlays: vec![
            Overlay {
                label: "ridge".to_owned(),
                points: ridge,
                colour: Rgba::hex(0xcc3377),
                ..Overlay::default()
            },
            Overlay {
                label: "extrema".to_owned(),
                points: vec![Point::new(8.0, 8.0), Point::new(40.0, 12.0)],
                marker: Some(Marker::Ring),
                ..Overlay::default()
            },
        ],
        ..HeatOptions::default()
    };
    save(folder, "heat_log", &heat_map(&light, &options))?;
    let linear = HeatOptions {
        title: "Light transport gradient at 90°".to_owned(),
        quantity: "LTG (W/rad per cell)".to_owned(),
        ..HeatOptions::default()
    };
    let wide = Field::from_fn(Grid::new(40, 12)?, |c| {
        if c.x == 20 && c.y < 4 { f64::NAN } else { 1e-5 * (c.x as f64 + 2.0 * c.y as f64) }
    });
    save(folder, "heat_linear_nan", &heat_map(&wide, &linear))?;
    let clamped = HeatOptions { range: Some((0.2, 0.6)), ..linear };
    save(folder, "heat_clamped", &heat_map(&radial(grid, |r| math::cos(r / 8.0)), &clamped))?;
    let a = radial(grid, |r| math::cos(r / 6.0));
    let b = radial(grid, |r| 0.5 * math::cos(r / 8.0));
    let options = HeatOptions {
        title: "Oracle minus reduced engine".to_owned(),
        quantity: "difference of energy (W)".to_owned(),
        ..HeatOptions::default()
    };
    save(folder, "difference", &difference_map(&a, &b, Difference::Absolute, &options)?)
}

fn tensors(folder: &Path) -> Outcome {
    let small = Grid::new(13, 13)?;
    let mut mixed = Field::from_fn(small, |c| {
        let (x, y) = from_centre(small, c);
        Tensor2::symmetric(0.1 * x, 0.06 * y, 0.1 * x + 0.05 * y)
    });
    mixed.values_mut()[0] = Tensor2::ZERO;
    mixed.values_mut()[1] = Tensor2::new(f64::NAN, 0.0, 0.0, 1.0);
    mixed.values_mut()[2] = Tensor2::from_eigen(0.7, 1.0, 0.0);
    let options = GlyphOptions { title: "Stress glyphs".to_owned(), ..GlyphOptions::default() };
    save(folder, "glyphs_sign", &glyphs(&mixed, &options))?;
    let large = rings(Grid::new(101, 101)?);
    let options = GlyphOptions {
        title: "“rings” test field with tensor lines".to_owned(),
        overlays: vec![Overlay {
            label: "tensor lines".to_owned(),
            points: circles(Point::new(50.0, 50.0)),
            ..Overlay::default()
        }],
        scale: GlyphScale::Glyph,
        colour: GlyphColour::Anisotropy,
        ..GlyphOptions::default()
    };
    save(folder, "glyphs_large", &glyphs(&large, &options))?;
    let mut field = Field::from_fn(Grid::new(61, 41)?, |c| {
        let (x, y) = from_centre(Grid::new(61, 41).unwrap_or(small), c);
        let r = math::hypot(x, y);
        Tensor2::from_eigen(math::atan2(y, x) + math::FRAC_PI_2, 1.0, math::exp(-r / 15.0))
    });
    field.values_mut()[70] = Tensor2::ZERO;
    field.values_mut()[75] = Tensor2::new(f64::INFINITY, 0.0, 0.0, 1.0);
    let options = OrientationOptions {
        title: "Orientation of “rings”".to_owned(),
        ..OrientationOptions::default()
    };
    save(folder, "orientation", &orientation_map(&field, &options))
}

/// Every kind of glyph on a field with both signs and rotations.
fn kinds(folder: &Path) -> Outcome {
    let grid = Grid::new(13, 13)?;
    let mut field = Field::from_fn(grid, |c| {
        let (x, y) = from_centre(grid, c);
        Tensor2::new(0.1 * x, 0.05 * y - 0.03 * x, 0.05 * y + 0.06 * x, 0.1 * x + 0.05 * y)
    });
    field.values_mut()[0] = Tensor2::ZERO;
    field.values_mut()[1] = Tensor2::new(f64::NAN, 0.0, 0.0, 1.0);
    field.values_mut()[2] = Tensor2::from_eigen(0.7, 1.0, 0.0);
    for (name, kind) in [
        ("box", GlyphKind::Box),
        ("superquadric", GlyphKind::Superquadric { gamma: GlyphKind::GAMMA }),
        ("signed", GlyphKind::Signed),
        ("arrows", GlyphKind::Arrows),
        ("asymmetric", GlyphKind::Asymmetric),
    ] {
        let options = GlyphOptions { title: format!("Glyphs: {name}"), kind, ..GlyphOptions::default() };
        save(folder, &format!("glyphs_{name}"), &glyphs(&field, &options))?;
    }
    Ok(())
}

/// A texture along circles and fields sampled finer than cells, with bands over them.
fn fine(folder: &Path) -> Outcome {
    const N: usize = 6;
    let cells = Grid::new(21, 15)?;
    let grid = Grid::new(N * (cells.width() - 1) + 1, N * (cells.height() - 1) + 1)?;
    let radius = Field::from_fn(grid, |c| {
        let (x, y) = from_centre(grid, c);
        math::hypot(x, y) / N as f64
    });
    let missing = |c: Cell, value: f64| if c.x < 20 && c.y < 14 { f64::NAN } else { value };
    let texture = Field::from_fn(grid, |c| missing(c, 0.5 + 0.5 * math::sin(9.0 * radius.at(c))));
    let band = |label: &str, radius: f64, width: f64, colour| Ribbon {
        label: label.to_owned(),
        points: (0..=60)
            .map(|i| f64::from(i) / 60.0 * math::TAU)
            .map(|w| Point::new(10.0 + radius * math::cos(w), 7.0 - radius * math::sin(w)))
            .collect(),
        half_widths: (0..=60).map(|i| width * (1.2 + math::sin(f64::from(i) * 0.3))).collect(),
        colour,
    };
    let ribbons = vec![
        band("compressive hyperstreamline", 4.0, 0.5, Rgba::hex(0x0072b2)),
        band("tensile hyperstreamline", 7.3, 0.4, Rgba::hex(0xd55e00)),
    ];
    let plain = TextureOptions {
        title: "Texture along circles".to_owned(),
        samples_a_cell: [N; 2],
        ribbons: ribbons.clone(),
        ..TextureOptions::default()
    };
    save(folder, "texture", &texture_map(&texture, &plain)?)?;
    let quantity = "distance (cells)".to_owned();
    let tint = Tint { values: radius.clone(), quantity, map: ColourMap::Batlow, range: Some((0.0, 9.0)) };
    let options = TextureOptions { tint: Some(tint), ribbons: Vec::new(), ..plain };
    save(folder, "texture_tinted", &texture_map(&texture, &options)?)?;
    let options = HeatOptions {
        title: "Six samples per cell".to_owned(),
        quantity: "distance (cells)".to_owned(),
        samples_a_cell: N,
        sources: vec![Cell::new(10, 7)],
        ribbons: ribbons.clone(),
        ..HeatOptions::default()
    };
    let holed = Field::from_fn(grid, |c| missing(c, *radius.at(c)));
    save(folder, "heat_fine", &heat_map(&holed, &options))?;
    let field = rings(cells);
    let options = GlyphOptions { ribbons: ribbons.clone(), ..GlyphOptions::default() };
    save(folder, "glyphs_bands", &glyphs(&field, &options))?;
    let options = OrientationOptions { ribbons, ..OrientationOptions::default() };
    save(folder, "orientation_bands", &orientation_map(&field, &options))
}

/// Light that falls as 1/r from `source`, thrown outwards.
fn made_up_light(grid: Grid, directions: Directions, source: Cell) -> LightDistribution {
    let mut samples = Vec::new();
    for c in grid.iter() {
        let (x, y) = (c.x as f64 - source.x as f64, source.y as f64 - c.y as f64);
        let (r, phi) = (math::hypot(x, y), math::atan2(y, x));
        for t in 0..directions.count() {
            let lobe = math::cos(directions.angle_rad(t) - phi).max(0.0);
            samples.push(if r == 0.0 { 1.0 } else { lobe * math::exp(-0.2 * r) / r });
        }
    }
    LightDistribution::new(directions, samples, Field::from_fn(grid, |_| [0.0; 8]))
}

fn overlays(folder: &Path) -> Outcome {
    let directions = Directions::new(64)?;
    for side in [7, 21, 51] {
        let grid = Grid::new(side, side)?;
        let mut tensors = rings(grid);
        tensors.values_mut()[2] = Tensor2::ZERO;
        tensors.values_mut()[3] = Tensor2::from_eigen(0.5, 1.0, 0.0);
        let transmission = TransmissionField::from_tensors(&tensors, directions, Normalization::Local)?;
        let source = Cell::new(side / 2, side / 4);
        let light = made_up_light(grid, directions, source);
        let options = PolarOptions {
            title: format!("Light in “rings”, {side} × {side} cells"),
            sources: vec![source],
            ..PolarOptions::default()
        };
        save(
            folder,
            &format!("overlay_{side}"),
            &polar_overlay(Some(&transmission), Some(&light), &options),
        )?;
        if side == 7 {
            let linear = PolarOptions {
                intensity: IntensityScale::Linear { exclude_sources: true },
                transmission: TransmissionScale::Rate,
                title: String::new(),
                ..options
            };
            save(folder, "overlay_linear", &polar_overlay(Some(&transmission), Some(&light), &linear))?;
        }
    }
    Ok(())
}

fn emitter(directions: Directions, power: i32) -> PolarProfile {
    PolarProfile::from_fn(directions, |t| {
        let c = math::cos(directions.angle_rad(t) - math::FRAC_PI_4).max(0.0);
        if power == 0 { 1.0 } else { math::pow(c, f64::from(power)) }
    })
}

fn curves(folder: &Path) -> Outcome {
    let directions = Directions::new(360)?;
    let names = ["m = 0: spherical emitter", "m = 1: Lambert emitter", "m = 2: cone emitter"];
    let series: Vec<PolarSeries> = names
        .iter()
        .zip(tigereye_render::SERIES_PALETTE)
        .zip(0..)
        .map(|((label, colour), power)| PolarSeries {
            label: (*label).to_owned(),
            profile: emitter(directions, power),
            colour,
            fill: power > 0,
            dash_px: Vec::new(),
        })
        .collect();
    let options = PolarPlotOptions {
        title: "Emitters I(ω) = max(0, cos(ω − 45°))ᵐ".replace('ᵐ', "^m"),
        quantity: "radiant intensity (W/rad)".to_owned(),
        ..PolarPlotOptions::default()
    };
    save(folder, "polar_plot", &polar_plot(&series, &options))
}

fn charts(folder: &Path) -> Outcome {
    let r: Vec<f64> = (1..=24).map(f64::from).collect();
    let chart = Chart {
        title: "Attenuation of light with distance".to_owned(),
        x: ChartAxis { label: "distance r (cells)".to_owned(), logarithmic: true, range: None },
        y: ChartAxis { label: "relative flux Φ(r) / Φ(1)".to_owned(), logarithmic: true, range: None },
        series: vec![
            Series {
                label: "measured".to_owned(),
                points: r.iter().map(|r| (*r, 1.0366 / r - 0.024)).collect(),
                markers: true,
                line: false,
                ..Series::default()
            },
            Series {
                label: "1/r".to_owned(),
                points: r.iter().map(|r| (*r, 1.0 / r)).collect(),
                ..Series::default()
            },
            Series {
                label: "shifted".to_owned(),
                points: r.iter().map(|r| (*r, 0.8 / r - 0.05)).collect(),
                markers: true,
                ..Series::default()
            },
        ],
        references: vec![Reference { value: 0.1, label: "10 %".to_owned() }],
        ..Chart::default()
    };
    save(folder, "chart_log", &line_chart(&chart)?)?;
    let steps: Vec<f64> = (0..=80).map(f64::from).collect();
    let drift =
        |scale: f64| steps.iter().map(|s| (*s, scale * 1e-13 * (s + 3.0 * math::sin(0.8 * s)))).collect();
    let linear = Chart {
        title: "Energy conservation: change of the total energy over 80 steps".to_owned(),
        x: ChartAxis { label: "propagation step".to_owned(), ..ChartAxis::default() },
        y: ChartAxis { label: "E − E₀ (W)".to_owned(), ..ChartAxis::default() },
        series: [1.0, 2.0, 5.0]
            .iter()
            .map(|s| Series { label: format!("strength {s}"), points: drift(*s), ..Series::default() })
            .collect(),
        references: vec![Reference::default()],
        ..Chart::default()
    };
    save(folder, "chart_linear", &line_chart(&linear)?)?;
    let empty = Chart { title: "Nothing measured".to_owned(), series: Vec::new(), ..chart };
    save(folder, "chart_empty", &line_chart(&empty)?)
}

fn multiples(folder: &Path) -> Outcome {
    let grid = Grid::new(31, 31)?;
    let panel = |steps: f64| {
        let options = HeatOptions {
            quantity: "energy (W)".to_owned(),
            range: Some((0.0, 1.0)),
            cell_px: Some(6),
            ..HeatOptions::default()
        };
        let wave = radial(grid, |r| math::exp(-0.5 * (r - steps) * (r - steps)));
        (format!("after {steps} steps"), heat_map(&wave, &options))
    };
    let panels: Vec<(String, Scene)> = [0.0, 2.0, 4.0, 7.0, 11.0].map(panel).into();
    save(folder, "multiples", &small_multiples(&panels, 3, "Impulse response of an isotropic field"))
}

fn awkward(folder: &Path) -> Outcome {
    let log = HeatOptions {
        scale: HeatScale::Logarithmic { decades: 6.0 },
        quantity: "energy (W)".to_owned(),
        title: "A field of a single row".to_owned(),
        ..HeatOptions::default()
    };
    let row =
        Field::from_fn(Grid::new(60, 1)?, |c| if c.x % 9 == 0 { -1.0 } else { math::exp(-(c.x as f64)) });
    save(folder, "awkward_row", &heat_map(&row, &log))?;
    let one = Field::from_fn(Grid::new(1, 1)?, |_| f64::NAN);
    let options = HeatOptions { title: "One cell that is not a number".to_owned(), ..HeatOptions::default() };
    save(folder, "awkward_cell", &heat_map(&one, &options))?;
    let column = Field::from_fn(Grid::new(2, 60)?, |c| c.y as f64 * 250.0);
    let options = HeatOptions { title: "A field of two columns".to_owned(), ..log };
    save(folder, "awkward_column", &heat_map(&column, &HeatOptions { scale: HeatScale::Linear, ..options }))
}
