//! Faults in files, with their places.

use crate::form::Place;
use thiserror::Error;
use tigereye_report::shortened;

/// A fault in an experiment, a field or a scene.
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

/// What is wrong with the source of a field.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{problem}")]
pub struct SourceFault {
    /// What is wrong and what was expected.
    pub problem: String,
    /// Where, if it is one of the values in the file.
    pub place: Option<Place>,
}

impl SourceFault {
    /// As a fault of the file whose text the source was read from.
    #[must_use]
    pub fn in_file(&self, file: &str, text: &str) -> String {
        match self.place {
            Some(place) => Faults::new(file, text).fault(place, &self.problem).to_string(),
            None => format!("{file}: {}", self.problem),
        }
    }
}

impl From<String> for SourceFault {
    fn from(problem: String) -> Self {
        Self { problem, place: None }
    }
}

/// The faults of one file, as they are found.
#[derive(Debug)]
pub(crate) struct Faults<'a> {
    file: &'a str,
    text: &'a str,
    found: Vec<SpecError>,
}

impl<'a> Faults<'a> {
    /// No fault yet, of a file whose values were read from `text`.
    pub(crate) const fn new(file: &'a str, text: &'a str) -> Self {
        Self { file, text, found: Vec::new() }
    }

    /// Reports what is wrong with a value.
    pub(crate) fn at(&mut self, place: Place, problem: &str) {
        let fault = self.fault(place, problem);
        self.found.push(fault);
    }

    /// Takes faults of another file.
    pub(crate) fn extend(&mut self, others: Vec<SpecError>) {
        self.found.extend(others);
    }

    /// What [`Self::at`] reports.
    pub(crate) fn fault(&self, place: Place, problem: &str) -> SpecError {
        let (line, column) = place.in_text(self.text);
        SpecError { file: self.file.to_owned(), line, column, problem: shortened(problem) }
    }

    pub(crate) fn len(&self) -> usize {
        self.found.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// All of them in the order in which they were found.
    pub(crate) fn into_errors(self) -> Vec<SpecError> {
        self.found
    }
}
