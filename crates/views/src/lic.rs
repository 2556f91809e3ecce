//! Line integral convolution: textures smeared along axes.

use serde_json::{Value, json};
use tigereye_core::{Anisotropy, Cell, Field, Point, Tensor2};
use tigereye_lines::{
    ConvolutionOptions, Family, Followed, Following, Interpolated, SamplingError, convolved, hyper_convolved,
};
use tigereye_render::{ColourMap, RenderError, Scene, TextureOptions, Tint, texture_map};

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
    /// Samples per cell along x and y.
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

/// A texture in grey, or in the colours of the anisotropy.
///
/// # Errors
/// [`RenderError`] for a texture of another field.
pub fn picture(
    texture: &Field<f64>,
    field: &Field<Tensor2>,
    request: &TextureRequest,
    tinted: bool,
    options: TextureOptions,
) -> Result<Scene, RenderError> {
    let samples = request.samples_a_cell();
    let tint = tinted.then(|| {
        let between = Interpolated::new(field);
        let at = |c: Cell| Point::new(c.x as f64 / samples[0] as f64, c.y as f64 / samples[1] as f64);
        let anisotropy = |c: Cell| between.at(at(c)).map_or(f64::NAN, |t| Anisotropy::of(&t).linear);
        Tint {
            values: Field::from_fn(texture.grid(), anisotropy),
            quantity: "linear anisotropy (s₁ − s₂) / (s₁ + s₂)".to_owned(),
            map: ColourMap::Batlow,
            range: Some((0.0, 1.0)),
        }
    });
    let missing = Some("no tensor".to_owned());
    texture_map(
        texture,
        &TextureOptions {
            samples_a_cell: samples,
            note: Some(smeared_words(request)),
            cell: request.following.cell,
            tint,
            missing,
            ..options
        },
    )
}

/// Along which axes noise was smeared, for the legend.
fn smeared_words(request: &TextureRequest) -> String {
    let axes = request.following.axes.words();
    match request.hyper {
        true => format!("smeared along both axes: {axes}"),
        false => format!("smeared along the {} axis: {axes}", request.family.name()),
    }
}

/// The parameters of a texture, for provenance.
#[must_use]
pub fn parameters(request: &TextureRequest) -> Value {
    json!({
        "axes": request.following.axes.axes().name(),
        "major": request.following.axes.major().name(),
        "family": request.family.name(),
        "hyper": request.hyper,
        "samples": request.options.samples,
        "half_length": request.options.half_length,
        "seed": request.options.seed,
    })
}
