//! Text to [`Experiment`], with the place of every fault.

use super::{Experiment, FORMAT, FieldFile, SceneFile};
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
        E::Eof => "the file ends within a value".to_owned(),
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
    line_and_column(&code, place)
}

/// Line and column of `word` in an item of the list behind `list`, or of the item where it has no such word.
pub(crate) fn place_in_list(text: &str, list: &str, index: usize, word: &str) -> (usize, usize) {
    let code = without_strings(&without_comments(text));
    let Some(list) = code.find(list).map(|at| at + list.len()) else { return (1, 1) };
    let Some(items) = code[list..].find('[').map(|at| list + at + 1) else { return (1, 1) };
    let (mut depth, mut seen, mut start, mut end) = (0_usize, 0, items, code.len());
    for (i, c) in code[items..].char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' if depth == 0 => {
                end = items + i;
                break;
            }
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 && seen == index => {
                end = items + i;
                break;
            }
            ',' if depth == 0 => {
                seen += 1;
                start = items + i + 1;
            }
            _ => {}
        }
    }
    let item = &code[start..end];
    let place = start + item.find(word).unwrap_or(item.len() - item.trim_start().len());
    line_and_column(&code, place)
}

fn line_and_column(code: &str, place: usize) -> (usize, usize) {
    let line = code[..place].matches('\n').count() + 1;
    let start = code[..place].rfind('\n').map_or(0, |n| n + 1);
    (line, code[start..place].chars().count() + 1)
}

/// The text with what stands in strings replaced by dots, every character at its place.
fn without_strings(code: &str) -> String {
    let (mut in_string, mut escaped) = (false, false);
    let blanked = code.chars().map(|c| {
        let inside = in_string && (c != '"' || escaped);
        if c == '"' && !escaped {
            in_string = !in_string;
        }
        escaped = in_string && c == '\\' && !escaped;
        if inside && c != '\n' { '.' } else { c }
    });
    blanked.collect()
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
