//! Light distributions as image data.

use super::arrays::{ENERGY, FLUX, INTENSITY, PROVENANCE};
use super::rows::{self, Rows};
use crate::volume::PlaneGeometry;
use crate::{DataArray, ImageData};
use tigereye_core::{LightDistribution, Vector};

/// An image of W x H x 1 points with three arrays:
///
/// | array | components | |
/// | --- | --- | --- |
/// | `energy` | 1 | W, the active scalars |
/// | `intensity` | S | W/rad, one per direction |
/// | `flux` | 3 | net radiant flux, W; the active vectors |
///
/// On a field that lies somewhere the image lies on it: rows upwards, with its origin, spacing and direction, the flux
/// along the axes of the world. Otherwise row 0 is the field's first row, as in light transport gradient volumes, and
/// the flux is in the frame x right, y **up**: a viewer whose y axis points up shows the picture upside down, and the
/// flux mirrored against it. The provenance says which, under [`Rows::KEY`].
#[must_use]
pub fn image_from_light(
    light: &LightDistribution,
    geometry: &PlaneGeometry,
    field_data_json: &str,
) -> ImageData {
    let mut image = image_of_energy(light, geometry);
    let directions = light.directions().count();
    let samples = Rows::of_results(geometry).from_top(light.samples(), sides(light), directions);
    image.point_arrays.insert(1, DataArray::new(INTENSITY, directions, samples));
    image.push_text(PROVENANCE, field_data_json);
    image
}

/// The arrays `energy` and `flux` of [`image_from_light`] alone: one frame of many.
#[must_use]
pub fn image_of_energy(light: &LightDistribution, geometry: &PlaneGeometry) -> ImageData {
    let (rows, [width, height]) = (Rows::of_results(geometry), sides(light));
    let along = |flux: &Vector| {
        let [x, y] = flux.to_array();
        if geometry.is_placed() { geometry.along([x, y]) } else { [x, y, 0.0] }
    };
    let flux: Vec<f64> = light.net_flux().values().iter().flat_map(along).collect();
    let energy = light.energy();
    let mut image = ImageData::empty([width, height, 1]);
    rows::place(&mut image, geometry);
    image.point_arrays = vec![
        DataArray::new(ENERGY, 1, rows.from_top(energy.values(), [width, height], 1)),
        DataArray::new(FLUX, 3, rows.from_top(&flux, [width, height], 3))
            .with_component_names(&["X", "Y", "Z"]),
    ];
    image.point_active.scalars = Some(ENERGY.to_owned());
    image.point_active.vectors = Some(FLUX.to_owned());
    image
}

fn sides(light: &LightDistribution) -> [usize; 2] {
    [light.grid().width(), light.grid().height()]
}
