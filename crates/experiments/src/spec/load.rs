//! Text to [`Experiment`], with the place of every fault.

use super::{Experiment, FORMAT, FieldFile};
use crate::shortened;
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;
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
    let experiment: Experiment = parsed(file, text)?;
    check_format(file, text, experiment.format)?;
    Ok(experiment)
}

/// Reads a field that has a file of its own.
///
/// # Errors
/// The first fault, with line and column.
pub fn load_field(file: &str, text: &str) -> Result<FieldFile, SpecError> {
    let field: FieldFile = parsed(file, text)?;
    check_format(file, text, field.format)?;
    Ok(field)
}

fn parsed<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, SpecError> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|e| {
        let place = e.span.start;
        let problem = match e.code {
            ron::Error::IntegerOutOfBounds => {
                "the number is out of range: expected a whole number from 0 that fits the machine".to_owned()
            }
            code => shortened(&code.to_string()),
        };
        SpecError { file: file.to_owned(), line: place.line.max(1), column: place.col.max(1), problem }
    })
}

fn check_format(file: &str, text: &str, format: u32) -> Result<(), SpecError> {
    if format == FORMAT {
        return Ok(());
    }
    let (line, column) = place_after(text, &[], "format");
    let problem = format!("format {format} is unknown: this version reads format {FORMAT}");
    Err(SpecError { file: file.to_owned(), line, column, problem })
}

/// Line and column of the first `word` outside of comments behind all `anchors`, each looked for behind the one before.
/// An anchor or word that is missing is passed over.
pub(crate) fn place_after(text: &str, anchors: &[&str], word: &str) -> (usize, usize) {
    let code = without_comments(text);
    let mut from = 0;
    let mut place = 0;
    for part in anchors.iter().chain(std::iter::once(&word)) {
        if let Some(found) = code[from..].find(part) {
            place = from + found;
            from = place + part.len();
        }
    }
    let line = code[..place].matches('\n').count() + 1;
    let start = code[..place].rfind('\n').map_or(0, |n| n + 1);
    (line, code[start..place].chars().count() + 1)
}

/// The text with comment tails blanked out, every other byte at its place.
fn without_comments(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let end = comment_start(line).unwrap_or(line.len());
        code.push_str(&line[..end]);
        code.extend(line[end..].chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
    }
    code
}

/// Where a `//` stands outside of a string.
fn comment_start(line: &str) -> Option<usize> {
    let mut in_string = false;
    let mut previous = ' ';
    for (i, c) in line.char_indices() {
        match c {
            '"' if previous != '\\' => in_string = !in_string,
            '/' if previous == '/' && !in_string => return Some(i - 1),
            _ => {}
        }
        previous = if c == '\\' && previous == '\\' { ' ' } else { c };
    }
    None
}
