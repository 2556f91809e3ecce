//! Sizes beyond which no scene is built.

/// Cells of a scene.
pub(crate) const MAX_CELLS: usize = 1 << 20;
/// Cells times corners that may be looked at while shapes are put down.
pub(crate) const MAX_WORK: f64 = 1e8;
