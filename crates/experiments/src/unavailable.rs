//! Why a number or a picture is not to be had.

use thiserror::Error;
use tigereye_lines::{ExtractionError, SamplingError};
use tigereye_render::RenderError;
use tigereye_views::added::AddedError;
use tigereye_views::lines::TooManyPoints;

/// Why something that the plan asks for could not be computed from the results of this run.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Unavailable {
    /// A run that ended early.
    #[error("the run ended after {steps} steps, before step {wanted}")]
    BeforeStep {
        /// The step that was asked for.
        wanted: usize,
        /// Steps of the run.
        steps: usize,
    },
    /// A number that is not defined for these results.
    #[error("{0}")]
    Undefined(&'static str),
    /// Lines that cannot be drawn.
    #[error(transparent)]
    Lines(#[from] TooManyPoints),
    /// A texture that cannot be sampled.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// Ridges that cannot be extracted.
    #[error(transparent)]
    Extraction(#[from] ExtractionError),
    /// What cannot be drawn over a picture.
    #[error(transparent)]
    Added(Box<AddedError>),
    /// A picture that cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl From<AddedError> for Unavailable {
    fn from(error: AddedError) -> Self {
        Self::Added(Box::new(error))
    }
}

/// For numbers that are not defined everywhere: with the reason.
pub(crate) trait OrUndefined<T> {
    fn or_undefined(self, reason: &'static str) -> Result<T, Unavailable>;
}

impl<T> OrUndefined<T> for Option<T> {
    fn or_undefined(self, reason: &'static str) -> Result<T, Unavailable> {
        self.ok_or(Unavailable::Undefined(reason))
    }
}
