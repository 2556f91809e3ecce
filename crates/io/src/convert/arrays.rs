//! Names of arrays and entries that this program and others write.

use crate::DataArray;

/// Name of the tensor array that is written.
pub const TENSOR_ARRAY: &str = "Tensors";

/// Arrays by which VTK says what points and cells are: no data.
pub(crate) const VALID_POINTS: &str = "vtkValidPointMask";
pub(crate) const GHOSTS: &str = "vtkGhostType";
/// Name of the array that [`crate::image_from_ltg`] writes.
pub const LTG_ARRAY: &str = "LTG";
/// Name of the array of the standard errors of an estimate.
pub const LTG_ERROR_ARRAY: &str = "LTG_error";
/// Name of the array in the published volumes.
pub(super) const PUBLISHED_ARRAY: &str = "Energy";
/// Name of the array of energies.
pub(super) const ENERGY: &str = "energy";
/// Name of the array of intensities.
pub(super) const INTENSITY: &str = "intensity";
/// Name of the array of fluxes.
pub(super) const FLUX: &str = "flux";

/// Field data entry with the JSON text that says what made a file.
pub const PROVENANCE: &str = "tigereye";

/// Name and components of arrays, for messages.
pub(super) fn described<'a>(arrays: impl IntoIterator<Item = &'a DataArray>) -> Vec<String> {
    let words = |n: usize| if n == 1 { "1 component".to_owned() } else { format!("{n} components") };
    arrays.into_iter().map(|a| format!("`{}` ({})", a.name, words(a.components))).collect()
}
