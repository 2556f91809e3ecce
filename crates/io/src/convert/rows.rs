//! Which way the rows of a result run, and where its points lie.

use super::arrays::{ENERGY, FLUX, INTENSITY, LTG_ARRAY, PROVENANCE, PUBLISHED_ARRAY};
use crate::ImageData;
use crate::volume::{IDENTITY, PlaneGeometry};
use serde_json::Value;

/// Which way the rows of an image run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// The first row of the file is the lowest of the picture, as VTK has it.
    Upwards,
    /// The first row of the file is that on top.
    Downwards,
}

impl Rows {
    /// The key under which the parameters of a result say it.
    pub const KEY: &str = "rows";

    /// `upwards` or `downwards`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Upwards => "upwards",
            Self::Downwards => "downwards",
        }
    }

    /// How light and its gradient are written: on the data where these lie somewhere, else with the field's first row
    /// first.
    #[must_use]
    pub const fn of_results(geometry: &PlaneGeometry) -> Self {
        if geometry.is_placed() { Self::Upwards } else { Self::Downwards }
    }

    /// How the rows of an array run: as the provenance says; downwards in the thesis's published volumes, which have no
    /// provenance, and in results of this program that do not say it; upwards in every other file.
    #[must_use]
    pub fn of(image: &ImageData, array: &str) -> Self {
        let is_down = match image.text(PROVENANCE) {
            Some(story) => match told(story) {
                Some(rows) => return rows,
                None => [LTG_ARRAY, ENERGY, INTENSITY, FLUX].contains(&array),
            },
            None => array == PUBLISHED_ARRAY && is_plain(image),
        };
        if is_down { Self::Downwards } else { Self::Upwards }
    }

    /// The values of an image of `width` x `height` points a layer, tuples of `components`, with row 0 on top in every
    /// layer: from such an image, and into one.
    #[must_use]
    pub fn from_top(self, values: &[f64], [width, height]: [usize; 2], components: usize) -> Vec<f64> {
        let row = width * components;
        if self == Self::Downwards || row == 0 || height == 0 {
            return values.to_vec();
        }
        let layers = values.chunks(row * height);
        layers.flat_map(|layer| layer.chunks(row).rev()).flatten().copied().collect()
    }
}

fn told(story: &str) -> Option<Rows> {
    let story: Value = serde_json::from_str(story).ok()?;
    let name = story.get("parameters")?.get(Rows::KEY)?.as_str()?;
    [Rows::Upwards, Rows::Downwards].into_iter().find(|rows| rows.name() == name)
}

/// Whether an image lies where the published volumes do: they count cells.
fn is_plain(image: &ImageData) -> bool {
    image.origin == [0.0; 3] && image.spacing == [1.0; 3] && image.direction.is_none_or(|d| d == IDENTITY)
}

/// Puts an image of a plane where its cells lie. A third axis, of directions, begins at the plane and keeps its own
/// distance of 1.
pub(super) fn place(image: &mut ImageData, geometry: &PlaneGeometry) {
    if !geometry.is_placed() {
        return;
    }
    let [dx, dy] = geometry.spacing();
    image.origin = geometry.corner();
    image.spacing = [dx, dy, 1.0];
    image.direction = geometry.direction();
}
