//! Text to [`Experiment`], with the place of every fault.

use super::{Experiment, FORMAT};
use ron::extensions::Extensions;
use thiserror::Error;

/// A fault in an experiment file.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{file}:{line}:{column}: {problem}")]
pub struct SpecError {
    /// Name of the file as it was given.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// What is wrong and what was expected.
    pub problem: String,
}

/// Reads an experiment. Numbers are in range afterwards; names are looked up later, by [`crate::settings::resolve`].
///
/// # Errors
/// The first fault, with line and column.
pub fn load(file: &str, text: &str) -> Result<Experiment, SpecError> {
    let at = |line, column, problem| SpecError { file: file.to_owned(), line, column, problem };
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    let experiment: Experiment = options.from_str(text).map_err(|e| {
        let place = e.span.start;
        at(place.line.max(1), place.col.max(1), e.code.to_string())
    })?;
    if experiment.format != FORMAT {
        let (line, column) = place_of(text, "format");
        let problem = format!("format {} is unknown: this version reads format {FORMAT}", experiment.format);
        return Err(at(line, column, problem));
    }
    Ok(experiment)
}

/// Line and column of the first occurrence of `word` outside of comment lines, or the start of the file.
pub(crate) fn place_of(text: &str, word: &str) -> (usize, usize) {
    text.lines()
        .enumerate()
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        .find_map(|(i, line)| Some((i + 1, line[..line.find(word)?].chars().count() + 1)))
        .unwrap_or((1, 1))
}
