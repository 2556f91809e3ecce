//! Between [`crate::ImageData`] and core's types: what arrays mean, and which way rows run.

mod arrays;
mod choice;
mod error;
mod light;
mod ltg;
mod rows;
mod wanted;

pub(crate) use arrays::{GHOSTS, VALID_POINTS};
pub use arrays::{LTG_ARRAY, LTG_ERROR_ARRAY, PROVENANCE, TENSOR_ARRAY};
pub use choice::ArrayChoice;
pub(crate) use choice::{choose_array, left_aside};
pub use error::ChoiceError;
pub use light::{image_from_light, image_of_energy};
pub use ltg::{LtgImage, SLICES, add_ltg_error, image_from_ltg, ltg_from_image};
pub use rows::Rows;
pub use wanted::{Association, Wanted};
