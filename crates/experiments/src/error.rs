//! Experiments that could not be evaluated.

use crate::runs::RunError;
use crate::unavailable::Unavailable;
use thiserror::Error;
use tigereye_io::IoError;
use tigereye_render::RenderError;

/// An experiment that could not be evaluated.
#[derive(Debug, Error)]
pub enum ExperimentError {
    /// A run that could not be made.
    #[error("experiment {slug}: {source}")]
    Run {
        /// Name of the experiment.
        slug: String,
        /// What went wrong.
        source: RunError,
    },
    /// A panel that could not be drawn.
    #[error("experiment {slug}: figure \"{figure}\", panel \"{panel}\": {source}")]
    Panel {
        /// Name of the experiment.
        slug: String,
        /// Name of the figure.
        figure: String,
        /// Heading of the panel.
        panel: String,
        /// Why it could not.
        source: Unavailable,
    },
    /// A figure that could not be made of its panels.
    #[error("experiment {slug}: figure \"{figure}\": {source}")]
    Figure {
        /// Name of the experiment.
        slug: String,
        /// Name of the figure.
        figure: String,
        /// What went wrong.
        source: RenderError,
    },
    /// A result could not be encoded.
    #[error("experiment {slug}, run \"{run}\": {source}")]
    Encoding {
        /// Name of the experiment.
        slug: String,
        /// Name of the run.
        run: String,
        /// What went wrong.
        source: Box<IoError>,
    },
}
