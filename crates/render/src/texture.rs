//! Textures, such as line integral convolutions, in grey or tinted by another quantity.

use crate::axis::Axis;
use crate::colour::{ColourMap, Rgba};
use crate::colour_bar::ColourBar;
use crate::error::RenderError;
use crate::glyphs::over;
use crate::heat_map::Summary;
use crate::legend::{Entry, Mark};
use crate::map_frame::MapFrame;
use crate::overlay::{self, Overlay};
use crate::ribbon::{self, Ribbon};
use crate::sampling::{Sampling, block_mean};
use crate::scene::Scene;
use crate::style::{Style, ValueRange};
use tigereye_core::{CellShape, Field, Tensor2};

/// A quantity shown as the colour of a texture.
#[derive(Debug, Clone, PartialEq)]
pub struct Tint {
    /// A value per sample of the texture, in any unit.
    pub values: Field<f64>,
    /// Quantity with its unit, beside the colour bar.
    pub quantity: String,
    /// Colour map.
    pub map: ColourMap,
    /// Fixed lower and upper end; by default that of the values.
    pub range: Option<(f64, f64)>,
}

/// Options of [`texture_map`].
#[derive(Debug, Clone, PartialEq)]
pub struct TextureOptions {
    /// Title; may be empty.
    pub title: String,
    /// Samples per cell along x and y, as for [`crate::HeatOptions`].
    pub samples_a_cell: [usize; 2],
    /// Colour by another quantity.
    pub tint: Option<Tint>,
    /// Pixels of a cell's smaller side; by default such that a sample covers whole pixels and the longer side has about
    /// 480.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
    /// A remark for the legend.
    pub note: Option<String>,
    /// Tensors drawn as ellipses over the map, if there are as many as cells.
    pub glyphs: Option<Field<Tensor2>>,
    /// Bands over the map.
    pub ribbons: Vec<Ribbon>,
    /// Points and lines over the map and its bands.
    pub overlays: Vec<Overlay>,
    /// Label in the legend for samples whose value is NaN; by default `no texture`.
    pub missing: Option<String>,
    /// Settings of the user, which override the options above; its colours apply to the tint.
    pub style: Style,
}

impl Default for TextureOptions {
    fn default() -> Self {
        Self {
            title: String::new(),
            samples_a_cell: [1; 2],
            tint: None,
            cell_px: None,
            cell: CellShape::SQUARE,
            note: None,
            glyphs: None,
            ribbons: Vec::new(),
            overlays: Vec::new(),
            missing: None,
            style: Style::default(),
        }
    }
}

/// Share of black and white in the colour of a tint at the ends of the texture's range.
const TINT_CONTRAST: f64 = 0.75;
/// Samples whose tint is not a number keep their grey; this one stands for them in the legend.
const MIDDLE_GREY: Rgba = Rgba::hex(0x808080);

/// A texture with values from 0 (dark) to 1 (light), clamped to this range, with axes in cells. A tint shows
/// its own colour at 0.5. Samples that are not finite are grey and named in the legend.
///
/// # Errors
/// [`RenderError::GridMismatch`] if a tint has other samples than the texture.
pub fn texture_map(texture: &Field<f64>, options: &TextureOptions) -> Result<Scene, RenderError> {
    let sampling = Sampling::of(texture.grid(), options.samples_a_cell);
    let tint = options.tint.as_ref().map(|tint| Tinting::of(tint, texture, &options.style)).transpose()?;
    let cell = sampling.cell_px(options.cell, options.cell_px);
    let side = |height: f64| tint.as_ref().map_or(0.0, |t| t.bar.width(height));
    let mut page = MapFrame::begin(sampling.cells, (&options.style, &options.title), cell, &side);
    let block = sampling.block(&page);
    let raster = sampling.raster(&page, |first| {
        let value = block_mean(texture, first, block);
        match &tint {
            _ if !value.is_finite() => Rgba::MASKED,
            Some(tint) => tinted(tint.colour(block_mean(tint.values, first, block)), value),
            None => grey(value),
        }
    });
    page.scene.items.push(raster);
    let mut legend = legend(texture, tint.as_ref(), options);
    over::draw(&mut page, options.glyphs.as_ref(), &mut legend);
    ribbon::draw(&mut page, &options.ribbons, &mut legend);
    overlay::draw(&mut page, &options.overlays, &mut legend);
    if let Some(text) = sampling.mean_in_words(block) {
        legend.push(Entry::of(Mark::None, text));
    }
    legend.extend(options.note.as_ref().map(|note| Entry::of(Mark::None, note.clone())));
    if let Some(tint) = &tint {
        let (edge, top, height) = (page.left + page.width(), page.top, page.side_height());
        tint.bar.draw(&mut page.scene, edge, top, height);
    }
    let description = format!("Texture of {}, row 0 on top{}.", sampling.in_words(), tint_in_words(options));
    Ok(page.finish(description, &legend))
}

/// A tint that fits its texture.
struct Tinting<'a> {
    values: &'a Field<f64>,
    bar: ColourBar<'a>,
}

impl<'a> Tinting<'a> {
    fn of(tint: &'a Tint, texture: &Field<f64>, style: &'a Style) -> Result<Self, RenderError> {
        let (a, b) = (texture.grid(), tint.values.grid());
        if a != b {
            return Err(RenderError::GridMismatch {
                a_width: a.width(),
                a_height: a.height(),
                b_width: b.width(),
                b_height: b.height(),
            });
        }
        let summary = Summary::of(tint.values.values());
        let chosen = style.range.or(tint.range.map(|(low, high)| ValueRange::Values(low, high)));
        let fixed = chosen.and_then(|range| range.ends(tint.values.values(), false));
        let own = if summary.finite == 0 { (0.0, 1.0) } else { (summary.low, summary.high) };
        let (low, high) = fixed.unwrap_or(own);
        let axis = Axis::linear(low, high);
        let bar = ColourBar {
            axis,
            map: style.map.unwrap_or(tint.map),
            label: style.quantity.as_ref().unwrap_or(&tint.quantity),
            below: summary.finite > 0 && axis.position(summary.low) < -1e-9,
            above: summary.finite > 0 && axis.position(summary.high) > 1.0 + 1e-9,
        };
        Ok(Self { values: &tint.values, bar })
    }

    fn colour(&self, value: f64) -> Rgba {
        if value.is_finite() { self.bar.map.sample(self.bar.axis.position(value)) } else { MIDDLE_GREY }
    }
}

fn grey(value: f64) -> Rgba {
    Rgba::hex(0).mixed(Rgba::WHITE, value)
}

fn tinted(colour: Rgba, value: f64) -> Rgba {
    let light = 2.0 * value.clamp(0.0, 1.0) - 1.0;
    let end = if light < 0.0 { Rgba::hex(0) } else { Rgba::WHITE };
    colour.mixed(end, TINT_CONTRAST * light.abs())
}

fn legend(texture: &Field<f64>, tint: Option<&Tinting>, options: &TextureOptions) -> Vec<Entry> {
    let mut legend = Vec::new();
    if texture.values().iter().any(|v| !v.is_finite()) {
        let text = options.style.masked.as_deref().or(options.missing.as_deref()).unwrap_or("no texture");
        legend.push(Entry::of(Mark::Swatch(Rgba::MASKED), text));
    }
    let both = |tint: &Tinting| {
        texture.values().iter().zip(tint.values.values()).any(|(v, t)| v.is_finite() && !t.is_finite())
    };
    if tint.is_some_and(both) {
        legend.push(Entry::of(Mark::Swatch(MIDDLE_GREY), "colour not a finite number"));
    }
    legend
}

fn tint_in_words(options: &TextureOptions) -> String {
    match &options.tint {
        Some(tint) if tint.quantity.is_empty() => ", coloured".to_owned(),
        Some(tint) => format!(", coloured by {}", tint.quantity),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Item, Raster};
    use tigereye_core::Grid;

    fn raster(scene: &Scene) -> &Raster {
        let first = scene.items.iter().find_map(|item| match item {
            Item::Raster(raster) => Some(raster),
            _ => None,
        });
        first.expect("a raster")
    }

    fn ramp() -> Field<f64> {
        Field::from_fn(Grid::new(9, 5).expect("a grid"), |c| c.x as f64 / 8.0)
    }

    fn legend_of(scene: &Scene) -> String {
        fn texts(items: &[Item], all: &mut String) {
            for item in items {
                match item {
                    Item::Text(text) => *all += &text.text,
                    Item::Group { items, .. } => texts(items, all),
                    _ => {}
                }
            }
        }
        let mut all = String::new();
        texts(&scene.items, &mut all);
        all
    }

    #[test]
    fn textures_run_from_black_to_white() {
        let mut texture = ramp();
        texture.values_mut()[9] = -3.0;
        texture.values_mut()[10] = f64::NAN;
        let options = TextureOptions { samples_a_cell: [4; 2], ..TextureOptions::default() };
        let scene = texture_map(&texture, &options).expect("a map");
        let cells = &raster(&scene).cells;
        assert_eq!([cells[0], cells[8]], [Rgba::hex(0), Rgba::WHITE]);
        assert_eq!([cells[9], cells[10]], [Rgba::hex(0), Rgba::MASKED]);
        assert!(scene.description.contains("3 x 2 cells with 4 samples"), "{}", scene.description);
        assert!(legend_of(&scene).contains("no texture"));
        let whole = texture_map(&ramp(), &options).expect("a map");
        assert!(!legend_of(&whole).contains("no texture"));
    }

    #[test]
    fn a_tint_shows_its_own_colour_in_the_middle_of_the_texture() {
        let even = ramp().map(|_| 0.5);
        let mut values = ramp();
        values.values_mut()[3] = f64::NAN;
        let tint = Tint { values, quantity: "anisotropy".to_owned(), map: ColourMap::Batlow, range: None };
        let options = TextureOptions { tint: Some(tint.clone()), ..TextureOptions::default() };
        let scene = texture_map(&even, &options).expect("a map");
        let cells = &raster(&scene).cells;
        assert_eq!([cells[0], cells[8]], [ColourMap::Batlow.sample(0.0), ColourMap::Batlow.sample(1.0)]);
        assert_eq!(cells[3], MIDDLE_GREY);
        let legend = legend_of(&scene);
        assert!(legend.contains("anisotropy") && legend.contains("colour not a finite number"));
        let other = Tint { values: Field::from_fn(Grid::new(3, 3).expect("a grid"), |_| 0.0), ..tint };
        let options = TextureOptions { tint: Some(other), ..TextureOptions::default() };
        assert!(matches!(texture_map(&even, &options), Err(RenderError::GridMismatch { .. })));
    }

    #[test]
    fn awkward_textures_are_drawn() {
        for (width, height, value) in [(1, 1, f64::NAN), (1, 7, f64::INFINITY), (300, 1, f64::MAX)] {
            let texture = Field::from_fn(Grid::new(width, height).expect("a grid"), |_| value);
            for samples_a_cell in [0, 1, 6, usize::MAX] {
                let tint = Tint {
                    values: texture.clone(),
                    quantity: String::new(),
                    map: ColourMap::Viridis,
                    range: Some((f64::NAN, 1.0)),
                };
                for tint in [None, Some(tint)] {
                    let options = TextureOptions {
                        samples_a_cell: [samples_a_cell; 2],
                        tint,
                        ..TextureOptions::default()
                    };
                    let scene = texture_map(&texture, &options).expect("a map");
                    assert!(scene.to_png(1.0).is_ok(), "{width} x {height}, {samples_a_cell} a cell");
                }
            }
        }
    }
}
