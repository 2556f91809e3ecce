//! Parses text into values, with the position of the first fault.

use crate::fault::SpecError;
use crate::form::{FORMAT, Placed, key_and_value, nested, options, words_of_fault};
use serde::de::DeserializeOwned;

/// Reads a file; `format_of` is its version, which must be the one that this program reads.
///
/// # Errors
/// The first fault, with line and column.
pub(crate) fn parse<T: DeserializeOwned>(
    file: &str,
    text: &str,
    format_of: impl Fn(&T) -> &Placed<u32>,
) -> Result<T, SpecError> {
    let value = parsed(file, text)?;
    check_format(file, text, format_of(&value))?;
    Ok(value)
}

fn parsed<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, SpecError> {
    options().from_str(text).map_err(|e| {
        if let ron::Error::Message(message) = &e.code
            && let Some((place, words)) = nested(message)
        {
            let (line, column) = place.in_text(text);
            let problem = with_value(words.to_owned(), text, place.offset_in(text));
            return SpecError { file: file.to_owned(), line, column, problem };
        }
        let place = e.span.start;
        let line = text.split_inclusive('\n').nth(place.line.saturating_sub(1)).unwrap_or_default();
        let column = line.char_indices().nth(place.col.saturating_sub(1)).map_or(line.len(), |(at, _)| at);
        let offset = (line.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize) + column;
        let problem = with_value(words_of_fault(&e.code, text), text, offset);
        SpecError { file: file.to_owned(), line: place.line.max(1), column: place.col.max(1), problem }
    })
}

/// Adds the key and the value to the fault of a value of the wrong type.
fn with_value(words: String, text: &str, offset: usize) -> String {
    let of_type = ["expected a ", "expected text", "expected `(`", "expected names"];
    match of_type.iter().any(|start| words.starts_with(start)) {
        true => words + &key_and_value(text, offset),
        false => words,
    }
}

fn check_format(file: &str, text: &str, format: &Placed<u32>) -> Result<(), SpecError> {
    if **format == FORMAT {
        return Ok(());
    }
    let (line, column) = format.key().in_text(text);
    let problem = format!("format {format} is unknown: this version reads format {FORMAT}");
    Err(SpecError { file: file.to_owned(), line, column, problem })
}
