//! Errors of drawing and encoding pictures.

use thiserror::Error;

/// Why a scene could not become a picture.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RenderError {
    /// A side of the picture would have more than [`crate::Scene::MAX_SIDE_PX`] pixels, or none.
    #[error(
        "a picture of {width_px} x {height_px} pixels (each side must be 1 to {limit_px}); choose a smaller scale"
    )]
    PictureSize {
        /// Requested width in pixels.
        width_px: f64,
        /// Requested height in pixels.
        height_px: f64,
        /// Largest side in pixels.
        limit_px: u32,
    },
    /// The scale is not a positive finite number.
    #[error("a picture scale must be positive and finite, not {scale}")]
    Scale {
        /// Requested scale.
        scale: f64,
    },
    /// The PNG encoder failed.
    #[error("encoding the PNG failed: {reason}")]
    Encoding {
        /// The message of the encoder.
        reason: String,
    },
    /// An animation without frames, or with too many.
    #[error(
        "an animation of {frames} frames with {pixels:.1e} pixels: expected one or more, and at most {most} pixels"
    )]
    Frames {
        /// Frames asked for.
        frames: usize,
        /// Pixels of all of them.
        pixels: f64,
        /// Most pixels.
        most: u64,
    },
    /// A width that leaves no room for the map.
    #[error(
        "a width of {asked_mm:.1} mm leaves no room for the map: expected {least_mm:.1} mm or more, or smaller text"
    )]
    Narrow {
        /// Width asked for, millimetres.
        asked_mm: f64,
        /// Least width of such a picture, millimetres.
        least_mm: f64,
    },
    /// Two fields that should be compared have different grids.
    #[error("cannot compare a field of {a_width} x {a_height} cells with one of {b_width} x {b_height}")]
    GridMismatch {
        /// Width of the first field in cells.
        a_width: usize,
        /// Height of the first field in cells.
        a_height: usize,
        /// Width of the second field in cells.
        b_width: usize,
        /// Height of the second field in cells.
        b_height: usize,
    },
    /// The charting library reported an error.
    #[error("drawing the chart failed: {reason}")]
    Chart {
        /// Its message.
        reason: String,
    },
}
