//! Laws of exported pictures: sizes, bytes, colours and accessibility.

// Helpers outside #[test] functions unwrap, too.
#![allow(clippy::unwrap_used)]

use quick_xml::Reader;
use quick_xml::events::Event;
use tigereye_core::{
    Cell, Directions, Field, Grid, LightDistribution, Normalization, PolarProfile, Tensor2, TransmissionField,
};
use tigereye_render::*;

fn decoded(bytes: &[u8]) -> (usize, usize, Vec<[u8; 4]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut buffer).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    let pixels = buffer.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect();
    (info.width as usize, info.height as usize, pixels)
}

/// Panics unless the scene exports to well-formed SVG without text elements, fonts or references to the outside.
fn check_svg(scene: &Scene) {
    let svg = scene.to_svg().unwrap();
    let mut reader = Reader::from_str(&svg);
    let (mut depth, mut titles) = (0, 0);
    loop {
        match reader.read_event().unwrap() {
            Event::Start(tag) => {
                depth += 1;
                titles += usize::from(matches!(tag.name().as_ref(), "title" | "desc"));
                assert_ne!(tag.name().as_ref(), "text");
            }
            Event::End(_) => depth -= 1,
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!((depth, titles), (0, 2));
    assert!(svg.contains(r#"role="img""#));
    // Encoded pictures may contain any letters.
    let parts: Vec<&str> = svg.split("base64,").collect();
    let rest = |part: &&str| part.find('"').map_or(String::new(), |end| part[end..].to_owned());
    let drawn = parts[0].to_owned() + &parts[1..].iter().map(rest).collect::<String>();
    for absent in ["<text", "font-family", "NaN", "inf"] {
        assert!(!drawn.contains(absent), "{absent} in {drawn}");
    }
    assert!(svg.split("href=\"").skip(1).all(|rest| rest.starts_with("data:image/png;base64,")));
    assert_eq!(svg.matches("http").count(), 1, "only the SVG namespace");
}

fn check(scene: &Scene) {
    check_svg(scene);
    let (width, height, _) = decoded(&scene.to_png(1.0).unwrap());
    assert_eq!((width, height), (scene.width_px.ceil() as usize, scene.height_px.ceil() as usize));
}

fn grid(width: usize, height: usize) -> Grid {
    Grid::new(width, height).unwrap()
}

fn ramp(g: Grid) -> Field<f64> {
    Field::from_fn(g, |c| c.x as f64 + 10.0 * c.y as f64)
}

/// The first raster of a scene: that of the map.
fn raster(scene: &Scene) -> &Raster {
    scene.items.iter().find_map(|i| if let Item::Raster(r) = i { Some(r) } else { None }).unwrap()
}

fn pixel_of(scene: &Scene, cell: Cell) -> [u8; 4] {
    let r = raster(scene);
    let (width, _, pixels) = decoded(&scene.to_png(1.0).unwrap());
    let at = |start: f64, i: usize| (start + (i as f64 + 0.5) * r.cell_px) as usize;
    pixels[at(r.y_px, cell.y) * width + at(r.x_px, cell.x)]
}

#[test]
fn png_has_the_scaled_size() {
    let scene = heat_map(&ramp(grid(5, 3)), &HeatOptions::default());
    for scale in [0.5, 1.0, 2.0] {
        let (width, height, _) = decoded(&scene.to_png(scale).unwrap());
        assert_eq!(width, (scene.width_px * scale).ceil() as usize);
        assert_eq!(height, (scene.height_px * scale).ceil() as usize);
    }
}

#[test]
fn impossible_sizes_are_errors() {
    let scene = heat_map(&ramp(grid(5, 3)), &HeatOptions::default());
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(scene.to_png(scale), Err(RenderError::Scale { .. })));
    }
    assert!(matches!(scene.to_png(1e6), Err(RenderError::PictureSize { .. })));
    for side in [0.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Scene::sized(side, 10.0).to_png(1.0), Err(RenderError::PictureSize { .. })));
    }
}

#[test]
fn cells_have_the_colour_of_their_value() {
    let g = grid(7, 4);
    let scene = heat_map(&ramp(g), &HeatOptions::default());
    for cell in [Cell::new(0, 0), Cell::new(6, 0), Cell::new(0, 3), Cell::new(6, 3), Cell::new(3, 2)] {
        let t = (cell.x as f64 + 10.0 * cell.y as f64) / 36.0;
        assert_eq!(pixel_of(&scene, cell), ColourMap::Viridis.sample(t).to_array(), "{cell:?}");
    }
}

#[test]
fn logarithmic_scale_shows_dark_cells_apart() {
    let field = Field::from_values(grid(4, 1), vec![1.0, 1e-2, 1e-5, 0.0]).unwrap();
    let options = HeatOptions { scale: HeatScale::Logarithmic { decades: 4.0 }, ..HeatOptions::default() };
    let scene = heat_map(&field, &options);
    let expected =
        [ColourMap::Viridis.sample(1.0), ColourMap::Viridis.sample(0.5), Rgba::NO_LIGHT, Rgba::NO_LIGHT];
    assert_eq!(raster(&scene).cells, expected);
}

#[test]
fn diverging_scale_puts_zero_in_the_middle() {
    let a = Field::from_values(grid(3, 1), vec![1.0, 5.0, 0.0]).unwrap();
    let b = Field::from_values(grid(3, 1), vec![1.0, 1.0, 1.0]).unwrap();
    let scene = difference_map(&a, &b, Difference::Absolute, &HeatOptions::default()).unwrap();
    let cells = &raster(&scene).cells;
    assert_eq!(cells[0], ColourMap::Vik.sample(0.5));
    assert_eq!(cells[1], ColourMap::Vik.sample(1.0));
    assert_eq!(cells[2], ColourMap::Vik.sample(0.375));
    let other = ramp(grid(2, 1));
    let mismatch = difference_map(&a, &other, Difference::Relative, &HeatOptions::default());
    assert!(matches!(mismatch, Err(RenderError::GridMismatch { .. })));
}

#[test]
fn huge_grids_are_averaged_not_refused() {
    let scene = heat_map(&ramp(grid(2500, 3)), &HeatOptions::default());
    assert!(scene.width_px < 1000.0);
    check(&scene);
}

#[test]
fn awkward_fields_are_drawn() {
    let fields = [
        vec![f64::NAN; 6],
        vec![0.0; 6],
        vec![-1.0, -2.0, -3.0, -4.0, 0.0, f64::NAN],
        vec![f64::INFINITY, f64::NEG_INFINITY, 1.0, 2.0, 3.0, 4.0],
        vec![1e308, -1e308, 0.0, 1.0, 1e-308, 5e-324],
        vec![5e-324; 6],
        vec![1.0, 1.0 + f64::EPSILON, 1.0, 1.0, 1.0, 1.0],
    ];
    for values in fields {
        for (width, height) in [(1, 6), (6, 1), (2, 3)] {
            let field = Field::from_values(grid(width, height), values.clone()).unwrap();
            for scale in [HeatScale::Linear, HeatScale::Logarithmic { decades: 6.0 }, HeatScale::Diverging] {
                for range in [None, Some((-1.0, 1.0)), Some((f64::NAN, 1.0)), Some((2.0, 1.0))] {
                    let title = "A title that is far too long for so small a map & has <signs>".to_owned();
                    let options = HeatOptions { title, scale, range, ..HeatOptions::default() };
                    check(&heat_map(&field, &options));
                }
            }
        }
    }
    let one = Field::from_values(grid(1, 1), vec![f64::NAN]).unwrap();
    check(&heat_map(&one, &HeatOptions::default()));
}

fn awkward_tensors() -> Field<Tensor2> {
    let values = vec![
        Tensor2::ZERO,
        Tensor2::IDENTITY,
        Tensor2::new(f64::NAN, 0.0, 0.0, 1.0),
        Tensor2::from_eigen(0.3, 1.0, 0.0),
        Tensor2::from_eigen(0.3, 1.0, -0.5),
        Tensor2::new(0.0, -1.0, 1.0, 0.0),
        Tensor2::symmetric(-1e300, 0.0, -1e300),
        Tensor2::symmetric(1e-300, 0.0, 2e-300),
    ];
    Field::from_values(grid(4, 2), values).unwrap()
}

#[test]
fn awkward_tensors_are_drawn() {
    for scale in [GlyphScale::Field, GlyphScale::SquareRoot, GlyphScale::Glyph] {
        for colour in [GlyphColour::AxisSign, GlyphColour::Anisotropy] {
            for every in [None, Some(0), Some(3), Some(100)] {
                check(&glyphs(
                    &awkward_tensors(),
                    &GlyphOptions { scale, colour, every, ..GlyphOptions::default() },
                ));
            }
        }
    }
    check(&orientation_map(&awkward_tensors(), &OrientationOptions::default()));
    let zero = Field::from_values(grid(1, 1), vec![Tensor2::ZERO]).unwrap();
    check(&glyphs(&zero, &GlyphOptions::default()));
    check(&orientation_map(&zero, &OrientationOptions::default()));
}

#[test]
fn orientation_does_not_depend_on_the_sign_of_the_axis() {
    let field = Field::from_fn(grid(2, 1), |c| {
        let half_turn = if c.x == 0 { 0.0 } else { core::f64::consts::PI };
        Tensor2::from_axes(0.8 + half_turn, 1.0, 0.1)
    });
    let scene = orientation_map(&field, &OrientationOptions::default());
    let cells = &raster(&scene).cells;
    assert_eq!(cells[0], cells[1]);
}

fn upward_light(g: Grid) -> LightDistribution {
    let directions = Directions::new(32).unwrap();
    let samples = g.iter().flat_map(|_| (0..32).map(|t| if t == 8 { 1.0 } else { 0.0 })).collect();
    LightDistribution::new(directions, samples, Field::from_fn(g, |_| [0.0; 8]))
}

#[test]
fn light_at_90_degrees_points_up() {
    let scales = [
        IntensityScale::PerCell,
        IntensityScale::Linear { exclude_sources: false },
        IntensityScale::Logarithmic { decades: 3.0 },
    ];
    for intensity in scales {
        let options = PolarOptions { intensity, ..PolarOptions::default() };
        let scene = polar_overlay(None, Some(&upward_light(grid(1, 1))), &options);
        let blue = |item: &&Path| item.stroke.as_ref().is_some_and(|s| s.colour == Rgba::LIGHT);
        let paths = scene.items.iter().filter_map(|i| if let Item::Path(p) = i { Some(p) } else { None });
        let path = paths.clone().find(blue).unwrap();
        let points: Vec<[f64; 2]> = path
            .segments
            .iter()
            .filter_map(|s| match s {
                Segment::Move(p) | Segment::Line(p) => Some(*p),
                _ => None,
            })
            .collect();
        let tip = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
        let foot = points.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max);
        assert!(foot - tip > 10.0, "the spike is long");
        assert!(points.iter().all(|p| (p[0] - points[0][0]).abs() < 1e-9), "and upright");
        let centre = points.iter().filter(|p| p[1] == foot).count();
        assert!(centre >= points.len() - centre, "its foot is the centre, so the tip lies above");
    }
}

#[test]
fn overlays_of_dark_or_missing_data_are_drawn() {
    let directions = Directions::new(16).unwrap();
    let g = grid(3, 2);
    let dark = LightDistribution::new(directions, vec![0.0; 16 * 6], Field::from_fn(g, |_| [0.0; 8]));
    let broken = LightDistribution::new(directions, vec![f64::NAN; 16 * 6], Field::from_fn(g, |_| [0.0; 8]));
    let zero = Field::from_fn(g, |_| Tensor2::ZERO);
    let wall = TransmissionField::from_tensors(&zero, directions, Normalization::Local).unwrap();
    for transmission in [TransmissionScale::PerCell, TransmissionScale::Rate] {
        let options =
            PolarOptions { transmission, sources: vec![Cell::new(0, 0)], ..PolarOptions::default() };
        check(&polar_overlay(Some(&wall), Some(&dark), &options));
        check(&polar_overlay(Some(&wall), None, &options));
        check(&polar_overlay(None, Some(&broken), &options));
        check(&polar_overlay(None, None, &options));
    }
    let linear = IntensityScale::Linear { exclude_sources: true };
    let options = PolarOptions { intensity: linear, sources: g.iter().collect(), ..PolarOptions::default() };
    check(&polar_overlay(None, Some(&upward_light(g)), &options));
}

#[test]
fn polar_plots_of_nothing_and_of_negative_values_are_drawn() {
    let directions = Directions::new(16).unwrap();
    check(&polar_plot(&[], &PolarPlotOptions::default()));
    for value in [-1.0, 0.0, 1e-300, 1e300] {
        let series = PolarSeries {
            label: "one".to_owned(),
            profile: PolarProfile::constant(directions, value),
            colour: Rgba::LIGHT,
            fill: true,
            dash_px: vec![2.0, 2.0],
        };
        check(&polar_plot(&[series], &PolarPlotOptions::default()));
    }
}

fn chart(points: Vec<(f64, f64)>, logarithmic: bool) -> Chart {
    let axis = ChartAxis { label: "quantity (W)".to_owned(), logarithmic, range: None };
    let lines = Series { label: "a".to_owned(), points: points.clone(), ..Series::default() };
    let marks = Series { label: "b".to_owned(), points, line: false, markers: true, ..Series::default() };
    Chart { x: axis.clone(), y: axis, series: vec![lines, marks], ..Chart::default() }
}

#[test]
fn charts_of_any_points_are_drawn() {
    let cases = [
        vec![],
        vec![(1.0, 1.0)],
        vec![(0.0, 0.0)],
        vec![(-1.0, -1.0), (1.0, 1.0)],
        vec![(f64::NAN, 1.0), (1.0, f64::INFINITY)],
        vec![(1.0, 1e300), (2.0, -1e300), (3.0, 1e-300)],
        vec![(1e-300, 1.0), (1e300, 1.0)],
        vec![(1.0, 2.0), (1.0, 2.0)],
        vec![(1.0, 2.0), (f64::NAN, 0.0), (3.0, 4.0), (4.0, 5.0)],
    ];
    for points in cases {
        for logarithmic in [false, true] {
            let mut chart = chart(points.clone(), logarithmic);
            check(&line_chart(&chart).unwrap());
            chart.x.range = Some((0.5, 2.5));
            chart.y.range = Some((1.5, 2.0));
            chart.references =
                vec![Reference { value: f64::NAN, label: "x".to_owned() }, Reference::default()];
            check(&line_chart(&chart).unwrap());
        }
    }
    check(&line_chart(&Chart { width_px: f64::NAN, height_px: 1.0, ..Chart::default() }).unwrap());
}

#[test]
fn charts_say_what_a_logarithmic_axis_hides() {
    let scene = line_chart(&chart(vec![(1.0, 1.0), (2.0, 0.0), (3.0, -1.0)], true)).unwrap();
    assert!(scene.description.contains("4 points at 0 or below are not shown"), "{}", scene.description);
    let empty = line_chart(&chart(Vec::new(), false)).unwrap();
    assert!(empty.description.contains("no data"));
}

#[test]
fn small_multiples_hold_their_panels() {
    let panel = heat_map(&ramp(grid(4, 4)), &HeatOptions::default());
    for count in [0_usize, 1, 5, 30] {
        let panels: Vec<(String, Scene)> = (0..count).map(|i| (format!("step {i}"), panel.clone())).collect();
        for columns in [0_usize, 1, 3] {
            let scene = small_multiples(&panels, columns, "Panels");
            check_svg(&scene);
            let rows = count.div_ceil(columns.clamp(1, count.max(1)));
            assert!(scene.height_px >= panel.height_px * rows as f64);
            assert!(count == 0 || scene.width_px >= panel.width_px);
        }
    }
}

#[test]
fn the_same_data_gives_the_same_bytes() {
    let scenes = || {
        [
            heat_map(&ramp(grid(9, 9)), &HeatOptions { title: "Twice".to_owned(), ..HeatOptions::default() }),
            glyphs(&awkward_tensors(), &GlyphOptions::default()),
            polar_overlay(None, Some(&upward_light(grid(3, 3))), &PolarOptions::default()),
            line_chart(&chart(vec![(1.0, 2.0), (3.0, 5.0)], true)).unwrap(),
        ]
    };
    for (a, b) in scenes().iter().zip(&scenes()) {
        assert_eq!(a.to_svg().unwrap(), b.to_svg().unwrap());
        assert_eq!(a.to_png(1.3).unwrap(), b.to_png(1.3).unwrap());
    }
}

#[test]
fn overlays_lie_on_the_cells_they_name() {
    let ring = Overlay {
        points: vec![[2.0, 1.0], [f64::NAN, 0.0]],
        marker: Some(Marker::Circle),
        ..Overlay::default()
    };
    let line = Overlay {
        points: vec![[0.0, 0.0], [1.0, 1.0], [f64::NAN; 2], [3.0, 0.0], [900.0, 0.0]],
        ..Overlay::default()
    };
    let options = HeatOptions {
        overlays: vec![ring, line],
        sources: vec![Cell::new(3, 2), Cell::new(99, 99)],
        ..HeatOptions::default()
    };
    let scene = heat_map(&ramp(grid(4, 3)), &options);
    assert_eq!(pixel_of(&scene, Cell::new(2, 1)), Rgba::INK.to_array());
    check(&scene);
}

#[test]
fn logarithmic_light_keeps_far_cells_visible() {
    let directions = Directions::new(8).unwrap();
    let g = grid(3, 1);
    let samples = [1.0, 1e-2, 1e-6].iter().flat_map(|v| [*v; 8]).collect();
    let light = LightDistribution::new(directions, samples, Field::from_fn(g, |_| [0.0; 8]));
    let widths = |intensity: IntensityScale| -> Vec<f64> {
        let options = PolarOptions { intensity, ..PolarOptions::default() };
        let scene = polar_overlay(None, Some(&light), &options);
        let curves = scene.items.iter().find_map(|item| match item {
            Item::Path(p) if p.stroke.as_ref().is_some_and(|s| s.colour == Rgba::LIGHT) => Some(&p.segments),
            _ => None,
        });
        let points = |part: &[Segment]| {
            part.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| match s {
                Segment::Move(p) | Segment::Line(p) => (low.min(p[0]), high.max(p[0])),
                _ => (low, high),
            })
        };
        let curves = curves.unwrap().split(|s| *s == Segment::Close).filter(|part| !part.is_empty());
        curves.map(points).map(|(low, high)| high - low).collect()
    };
    let log = widths(IntensityScale::Logarithmic { decades: 4.0 });
    assert_eq!(log.len(), 2, "six decades below is nothing");
    assert!((log[1] / log[0] - 0.5).abs() < 1e-9, "two of four decades is half the size");
    let linear = widths(IntensityScale::Linear { exclude_sources: false });
    assert!((linear[1] / linear[0] - 0.01).abs() < 1e-9);
    let shapes = widths(IntensityScale::PerCell);
    assert!(shapes.iter().all(|w| (w - shapes[0]).abs() < 1e-9) && shapes.len() == 3);
}
