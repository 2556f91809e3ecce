//! Light distributions as image data.

use super::PROVENANCE;
use crate::{DataArray, ImageData};
use tigereye_core::LightDistribution;

/// An image of W x H x 1 points with three arrays:
///
/// | array | components | |
/// | --- | --- | --- |
/// | `energy` | 1 | W, the active scalars |
/// | `intensity` | S | W/rad, one per direction |
/// | `flux` | 3 | net radiant flux, W, in the frame x right, y **up**; z is 0; the active vectors |
///
/// Row 0 is the field's first row and is not flipped, as in light transport gradient volumes: a viewer whose y axis
/// points up shows the picture upside down, and the flux mirrored against it.
#[must_use]
pub fn image_from_light(light: &LightDistribution, field_data_json: &str) -> ImageData {
    let mut image = image_of_energy(light);
    image
        .point_arrays
        .insert(1, DataArray::new("intensity", light.directions().count(), light.samples().to_vec()));
    image.push_text(PROVENANCE, field_data_json);
    image
}

/// The arrays `energy` and `flux` of [`image_from_light`] alone: one frame of many.
#[must_use]
pub fn image_of_energy(light: &LightDistribution) -> ImageData {
    let grid = light.grid();
    let flux = light.net_flux().values().iter().flat_map(|&[x, y]| [x, y, 0.0]).collect();
    let mut image = ImageData::empty([grid.width(), grid.height(), 1]);
    image.point_arrays = vec![
        DataArray::new("energy", 1, light.energy().values().to_vec()),
        DataArray::new("flux", 3, flux).with_component_names(&["X", "Y", "Z"]),
    ];
    image.point_active.scalars = Some("energy".to_owned());
    image.point_active.vectors = Some("flux".to_owned());
    image
}
