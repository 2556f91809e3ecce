//! Between [`crate::ImageData`] and core's types: what arrays mean, and which way rows run.

mod choice;
mod light;
mod ltg;
mod rows;

pub use choice::{ArrayChoice, Association, TENSOR_ARRAY, Wanted};
pub(crate) use choice::{GHOSTS, VALID_POINTS, choose_array};
pub use light::{image_from_light, image_of_energy};
pub use ltg::{LTG_ARRAY, LtgImage, SLICES, image_from_ltg, ltg_from_image};
pub use rows::Rows;

/// Field data entry with the JSON text that says what made a file.
pub const PROVENANCE: &str = "tigereye";

/// Name and components of arrays, for messages.
fn described<'a>(arrays: impl IntoIterator<Item = &'a crate::DataArray>) -> Vec<String> {
    let words = |n: usize| if n == 1 { "1 component".to_owned() } else { format!("{n} components") };
    arrays.into_iter().map(|a| format!("`{}` ({})", a.name, words(a.components))).collect()
}
