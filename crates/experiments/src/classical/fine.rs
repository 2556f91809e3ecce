//! Scalars sampled finer than the cells: textures and exponents.

use super::{Followed, Following, Placement, axes_name, axes_words, family_name, major_name};
use serde_json::{Value, json};
use tigereye_core::{Anisotropy, Cell, CellShape, Field, Tensor2};
use tigereye_io::{DataArray, ImageData, PROVENANCE, Rows};
use tigereye_lines::{
    ConvolutionOptions, Family, Ftle, FtleOptions, Interpolated, OrderedAxes, SamplingError, convolved, ftle,
    hyper_convolved,
};
use tigereye_render::{
    ColourMap, HeatOptions, Overlay, RenderError, Scene, TextureOptions, Tint, heat_map, texture_map,
};

/// Which texture of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRequest {
    /// The axes to smear along, over which cells.
    pub following: Following,
    /// Which of the two.
    pub family: Family,
    /// Along both, as far as each is long.
    pub hyper: bool,
    /// How noise is smeared.
    pub options: ConvolutionOptions,
}

impl TextureRequest {
    /// Samples a cell along x and y.
    #[must_use]
    pub fn samples_a_cell(&self) -> [usize; 2] {
        self.options.samples_a_cell(self.following.cell)
    }
}

/// The texture, in samples finer than the cells ([`TextureRequest::samples_a_cell`]).
///
/// # Errors
/// See [`SamplingError`].
pub fn texture(field: &Field<Tensor2>, request: &TextureRequest) -> Result<Field<f64>, SamplingError> {
    let followed = Followed::new(field, request.following);
    let between = followed.interpolated();
    if request.hyper {
        hyper_convolved(&between, &request.options)
    } else {
        convolved(&between, request.family, &request.options)
    }
}

/// A texture in grey, or in the colours of the anisotropy; pixels a cell by default as [`texture_map`] has them.
///
/// # Errors
/// [`RenderError`] for a texture of another field.
pub fn texture_picture(
    texture: &Field<f64>,
    field: &Field<Tensor2>,
    request: &TextureRequest,
    tinted: bool,
    title: &str,
    cell_px: Option<usize>,
) -> Result<Scene, RenderError> {
    let samples = request.samples_a_cell();
    let tint = tinted.then(|| {
        let between = Interpolated::new(field);
        let at = |c: Cell| [c.x as f64 / samples[0] as f64, c.y as f64 / samples[1] as f64];
        let anisotropy = |c: Cell| between.at(at(c)).map_or(f64::NAN, |t| Anisotropy::of(&t).linear);
        Tint {
            values: Field::from_fn(texture.grid(), anisotropy),
            quantity: "linear anisotropy (s₁ − s₂) / (s₁ + s₂)".to_owned(),
            map: ColourMap::Batlow,
            range: Some((0.0, 1.0)),
        }
    });
    let title = title.to_owned();
    let missing = Some("no tensor".to_owned());
    texture_map(
        texture,
        &TextureOptions {
            title,
            samples_a_cell: samples,
            note: Some(smeared_words(request)),
            cell: request.following.cell,
            tint,
            cell_px,
            missing,
            ..TextureOptions::default()
        },
    )
}

/// Along which axes noise was smeared, for the legend.
fn smeared_words(request: &TextureRequest) -> String {
    let axes = axes_words(request.following.axes);
    match request.hyper {
        true => format!("smeared along both axes: {axes}"),
        false => format!("smeared along the {} axis: {axes}", family_name(request.family)),
    }
}

/// The parameters of a texture, for provenance.
#[must_use]
pub fn texture_parameters(request: &TextureRequest) -> Value {
    json!({
        "axes": axes_name(request.following.axes.axes()),
        "major": major_name(request.following.axes.major()),
        "family": family_name(request.family),
        "hyper": request.hyper,
        "samples": request.options.samples,
        "half_length": request.options.half_length,
        "seed": request.options.seed,
    })
}

/// FTLE on the lines of a field.
///
/// # Errors
/// See [`SamplingError`].
pub fn exponents(
    field: &Field<Tensor2>,
    following: Following,
    family: Family,
    options: &FtleOptions,
) -> Result<Ftle, SamplingError> {
    ftle(&Followed::new(field, following).interpolated(), family, options)
}

/// The larger exponents in colours.
#[must_use]
pub fn exponents_picture(
    found: &Ftle,
    axes: OrderedAxes,
    title: &str,
    overlays: Vec<Overlay>,
    cell_px: Option<usize>,
) -> Scene {
    let is_square = found.cell == CellShape::SQUARE;
    let unit = if is_square { "1/cell" } else { "1/smaller cell side" };
    let options = HeatOptions {
        title: title.to_owned(),
        quantity: format!("FTLE on tensor lines / ({unit})"),
        note: Some(format!("lines along {}", axes_words(axes))),
        samples_a_cell: found.samples,
        cell: found.cell,
        overlays,
        cell_px,
        missing: Some("no line, or one that leaves the field".to_owned()),
        ..HeatOptions::default()
    };
    heat_map(&found.larger, &options)
}

/// Scalars as image data that lie on the field, with so many samples a cell along x and y: rows upwards, as the parameters of its
/// provenance say ([`tigereye_io::Rows::KEY`]).
#[must_use]
pub fn image(
    arrays: &[(&str, &Field<f64>)],
    samples: [usize; 2],
    placement: &Placement,
    story: &str,
) -> ImageData {
    let Some((name, first)) = arrays.first() else { return ImageData::empty([1, 1, 1]) };
    let (width, height) = (first.grid().width(), first.grid().height());
    let geometry = placement.geometry();
    let mut image = ImageData::empty([width, height, 1]);
    image.origin = geometry.corner();
    let spacing = geometry.spacing();
    let fine = [spacing[0] / samples[0] as f64, spacing[1] / samples[1] as f64];
    image.spacing = [fine[0], fine[1], 1.0];
    image.direction = geometry.direction();
    image.point_active.scalars = Some((*name).to_owned());
    for (name, field) in arrays {
        let values = Rows::Upwards.from_top(field.values(), [width, height], 1);
        image.point_arrays.push(DataArray::new(name, 1, values));
    }
    image.push_text(PROVENANCE, story);
    image
}
