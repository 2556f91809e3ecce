//! A few small pictures, compared pixel by pixel with those recorded beside this file.
//!
//! Texts are left out, so that the pictures stay small and a change of the font does not touch them. After an
//! intended change, run the test with `TIGEREYE_UPDATE_PICTURES=1`, look at the pictures, and commit them.

use std::path::PathBuf;
use tigereye_core::{
    Cell, Directions, Field, Grid, LightDistribution, Normalization, Tensor2, TransmissionField, math,
};
use tigereye_render::{
    GlyphColour, GlyphOptions, GlyphScale, HeatOptions, Item, PolarOptions, Scene, glyphs, heat_map,
    orientation_map, polar_overlay,
};

/// Largest difference of a colour channel (of 255) that counts as the same: edges are blended in floating point.
const CHANNEL_TOLERANCE: u8 = 2;
/// Largest recorded picture, bytes.
const MAX_BYTES: usize = 20 * 1024;

fn only_paths(items: Vec<Item>) -> Vec<Item> {
    without_text(items).into_iter().filter(|item| !matches!(item, Item::Raster(_))).collect()
}

fn without_text(items: Vec<Item>) -> Vec<Item> {
    items
        .into_iter()
        .filter_map(|item| match item {
            Item::Text(_) => None,
            Item::Group { dx_px, dy_px, scale, items } => {
                Some(Item::Group { dx_px, dy_px, scale, items: without_text(items) })
            }
            other => Some(other),
        })
        .collect()
}

fn pixels(png: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut bytes).expect("a picture");
    bytes.truncate(info.buffer_size());
    (info.width, info.height, bytes)
}

#[track_caller]
fn looks_as_recorded(name: &str, mut scene: Scene) {
    scene.items = without_text(scene.items);
    let png = scene.to_png(1.0).expect("a picture");
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/pictures").join(format!("{name}.png"));
    if std::env::var_os("TIGEREYE_UPDATE_PICTURES").is_some() {
        std::fs::write(&path, &png).expect("a writable folder");
    }
    let recorded = std::fs::read(&path).expect("a recorded picture");
    assert!(recorded.len() <= MAX_BYTES, "{name}.png has {} bytes", recorded.len());
    let ((w, h, now), (rw, rh, then)) = (pixels(&png), pixels(&recorded));
    assert_eq!((w, h), (rw, rh), "size of {name}");
    let worst = now.iter().zip(&then).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    assert!(worst <= CHANNEL_TOLERANCE, "{name}: a channel differs by {worst} of 255");
}

/// Directions that rotate with the position, one zero and one totally anisotropic tensor.
fn field() -> Field<Tensor2> {
    Field::from_fn(Grid::new(5, 4).expect("a grid"), |c| match (c.x, c.y) {
        (0, 0) => Tensor2::ZERO,
        (4, 3) => Tensor2::symmetric(1.0, 0.0, 0.0),
        (x, y) => Tensor2::from_eigen(0.4 * x as f64 + 0.3 * y as f64, 1.0, if y == 2 { -0.3 } else { 0.3 }),
    })
}

#[test]
fn glyphs_look_as_recorded() {
    let options = GlyphOptions { cell_px: Some(24), ..GlyphOptions::default() };
    looks_as_recorded("glyphs", glyphs(&field(), &options));
}

/// The pictures of existing experiments are compared by their bytes: new kinds of glyphs must not move old ones.
#[test]
fn ellipses_keep_their_bytes() {
    let mut field = field();
    field.values_mut()[1] = Tensor2::new(f64::NAN, 0.0, 0.0, 1.0);
    field.values_mut()[2] = Tensor2::new(0.5, -0.7, 0.2, -0.1);
    let mut page = String::new();
    for (scale, colour) in
        [(GlyphScale::Field, GlyphColour::AxisSign), (GlyphScale::SquareRoot, GlyphColour::Anisotropy)]
    {
        let options = GlyphOptions { cell_px: Some(24), scale, colour, ..GlyphOptions::default() };
        let mut scene = glyphs(&field, &options);
        scene.items = only_paths(scene.items);
        page += &scene.to_svg().expect("a drawing");
    }
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/pictures/ellipses.svg");
    if std::env::var_os("TIGEREYE_UPDATE_PICTURES").is_some() {
        std::fs::write(&path, &page).expect("a writable folder");
    }
    assert!(
        page == std::fs::read_to_string(&path).expect("a recorded drawing"),
        "the bytes of ellipses moved"
    );
}

#[test]
fn orientation_looks_as_recorded() {
    looks_as_recorded("orientation", orientation_map(&field(), &Default::default()));
}

#[test]
fn heat_map_looks_as_recorded() {
    let values = Field::from_fn(Grid::new(6, 5).expect("a grid"), |c| match (c.x, c.y) {
        (5, 4) => f64::NAN,
        (x, y) => (x * y) as f64,
    });
    let options = HeatOptions { cell_px: Some(16), sources: vec![Cell::new(1, 1)], ..HeatOptions::default() };
    looks_as_recorded("heat_map", heat_map(&values, &options));
}

/// Frame, ticks and overlays of a map do not depend on how finely its field is sampled.
#[test]
fn fine_maps_have_the_frame_of_their_cells() {
    let map = |n: usize| {
        let grid = Grid::new(5 * n + 1, 4 * n + 1).expect("a grid");
        let values = Field::from_fn(grid, |c| (c.x + c.y) as f64 / n as f64);
        let options = HeatOptions {
            cell_px: Some(16),
            samples_a_cell: n,
            sources: vec![Cell::new(1, 1)],
            ..HeatOptions::default()
        };
        heat_map(&values, &options)
    };
    let (coarse, fine) = (map(1), map(4));
    let others = |scene: &Scene| {
        let all = scene.items.iter().skip(1);
        all.filter(|item| !matches!(item, Item::Text(_))).cloned().collect::<Vec<_>>()
    };
    assert_eq!((coarse.width_px, coarse.height_px), (fine.width_px, fine.height_px));
    assert_eq!(others(&coarse), others(&fine));
    let rasters = [&coarse, &fine].map(|scene| match &scene.items[0] {
        Item::Raster(raster) => raster.clone(),
        other => panic!("a raster, not {other:?}"),
    });
    assert_eq!(rasters[1].cell_px, [4.0; 2]);
    // The outer edge of the first sample lies half a cell less half a sample further in.
    assert_eq!(rasters[1].x_px - rasters[0].x_px, 6.0);
    assert_eq!(rasters[0].cells[0], rasters[1].cells[0]);
    assert_eq!(rasters[0].cells.last(), rasters[1].cells.last());
}

#[test]
fn overlay_looks_as_recorded() {
    let directions = Directions::new(16).expect("directions");
    let transmission =
        TransmissionField::from_tensors(&field(), directions, Normalization::Local).expect("a field");
    let grid = transmission.grid();
    // Light that goes up, fading to the right.
    let samples = grid
        .iter()
        .flat_map(|c| {
            (0..16).map(move |t| {
                let up = math::cos(directions.angle_rad(t) - math::FRAC_PI_2).max(0.0);
                up / (1.0 + c.x as f64)
            })
        })
        .collect();
    let light = LightDistribution::new(directions, samples, Field::from_fn(grid, |_| [0.0; 8]));
    let options =
        PolarOptions { cell_px: Some(28), sources: vec![Cell::new(0, 2)], ..PolarOptions::default() };
    looks_as_recorded("overlay", polar_overlay(Some(&transmission), Some(&light), &options));
}
