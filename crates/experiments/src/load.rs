//! Text to an experiment.

use crate::experiment::Experiment;
use crate::fault::SpecError;
use crate::parse::parse;

/// Reads an experiment. Numbers are in range afterwards; names are looked up later, by [`crate::plan::plan`].
///
/// # Errors
/// The first fault, with line and column.
pub fn load(file: &str, text: &str) -> Result<Experiment, SpecError> {
    parse(file, text, |experiment: &Experiment| &experiment.format)
}
