//! Text to [`Experiment`], with the place of every fault.

use super::source_text::SourceText;
use super::{Experiment, FORMAT, FieldFile, SceneFile};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;
use thiserror::Error;
use tigereye_report::shortened;

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

/// Reads a scene. Files that it names are read later, by [`crate::scene::prepare`].
///
/// # Errors
/// The first fault, with line and column.
pub fn load_scene(file: &str, text: &str) -> Result<SceneFile, SpecError> {
    let scene: SceneFile = parsed(file, text)?;
    check_format(file, text, scene.format)?;
    Ok(scene)
}

fn parsed<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, SpecError> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|e| {
        let place = e.span.start;
        let problem = in_words(&e.code, text);
        SpecError { file: file.to_owned(), line: place.line.max(1), column: place.col.max(1), problem }
    })
}

/// What the parser says of `text`, without the names of types that do not stand there.
fn in_words(error: &ron::Error, text: &str) -> String {
    use ron::Error as E;
    let one_of = |names: &[&str]| match names {
        [] => "none".to_owned(),
        [name] => format!("`{name}`"),
        names => format!("one of `{}`", names.join("`, `")),
    };
    let within = |outer: &Option<String>| match outer {
        Some(name) if text.contains(name.as_str()) => format!(" in `{name}`"),
        _ => String::new(),
    };
    let words = match error {
        E::IntegerOutOfBounds => {
            "the number is out of range: expected a whole number from 0 that fits the machine".to_owned()
        }
        E::ExpectedArray => "expected a list, `[...]`".to_owned(),
        E::ExpectedMap => "expected names with values, `{...}`".to_owned(),
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) => "expected `(`".to_owned(),
        E::ExpectedFloat => "expected a number".to_owned(),
        E::ExpectedInteger => "expected a whole number".to_owned(),
        E::ExpectedString => "expected text in quotes".to_owned(),
        E::ExpectedDifferentStructName { found, .. } => {
            format!("there is `{found}` where `(` was expected: is a bracket missing before it?")
        }
        E::Eof => "the file ends within a value".to_owned(),
        E::ExceededRecursionLimit => "values are nested too deeply".to_owned(),
        E::TrailingCharacters => "expected the end of the file".to_owned(),
        E::NoSuchEnumVariant { expected, found, .. } => {
            format!("there is no `{found}` here: expected {}", one_of(expected))
        }
        E::NoSuchStructField { expected, found, outer } => {
            format!("there is no key `{found}`{}: expected {}", within(outer), one_of(expected))
        }
        E::MissingStructField { field, outer } => format!("the key `{field}` is missing{}", within(outer)),
        E::DuplicateStructField { field, outer } => {
            format!("the key `{field}` stands here twice{}", within(outer))
        }
        other => other.to_string(),
    };
    shortened(&words)
}

fn check_format(file: &str, text: &str, format: u32) -> Result<(), SpecError> {
    if format == FORMAT {
        return Ok(());
    }
    let (line, column) = SourceText::new(text).place_after(&[], "format:");
    let problem = format!("format {format} is unknown: this version reads format {FORMAT}");
    Err(SpecError { file: file.to_owned(), line, column, problem })
}
