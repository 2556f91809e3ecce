//! Runs that could not be made.

use thiserror::Error;
use tigereye_lines::SamplingError;
use tigereye_ltg::LtgError;
use tigereye_scenes::SceneError;
use tigereye_transport::TransportError;

/// A run that could not be made, although its plan was in order.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RunError {
    /// A field that cannot transmit light.
    #[error("run \"{run}\": {source}")]
    Field {
        /// Name of the run.
        run: String,
        /// What is wrong with the field or scene.
        source: SceneError,
    },
    /// A propagation that cannot start.
    #[error("run \"{run}\": {source}")]
    Propagation {
        /// Name of the run.
        run: String,
        /// What is wrong with it.
        source: TransportError,
    },
    /// A sweep that cannot start.
    #[error("run \"{run}\": {source}")]
    Sweep {
        /// Name of the run.
        run: String,
        /// What is wrong with it.
        source: LtgError,
    },
    /// Exponents that cannot be computed.
    #[error("run \"{run}\": {source}")]
    Ftle {
        /// Name of the run.
        run: String,
        /// What is wrong with it.
        source: SamplingError,
    },
    /// The host asked to end.
    #[error("interrupted")]
    Interrupted,
}
