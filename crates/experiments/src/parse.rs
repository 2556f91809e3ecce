//! Text to what it says, with the place of the first fault.

use crate::fault::SpecError;
use crate::form::{FORMAT, Placed, nested, options, words_of_fault};
use serde::de::DeserializeOwned;
use tigereye_report::shortened;

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
            return SpecError { file: file.to_owned(), line, column, problem: shortened(words) };
        }
        let place = e.span.start;
        let problem = words_of_fault(&e.code, text);
        SpecError { file: file.to_owned(), line: place.line.max(1), column: place.col.max(1), problem }
    })
}

fn check_format(file: &str, text: &str, format: &Placed<u32>) -> Result<(), SpecError> {
    if **format == FORMAT {
        return Ok(());
    }
    let (line, column) = format.key().in_text(text);
    let problem = format!("format {format} is unknown: this version reads format {FORMAT}");
    Err(SpecError { file: file.to_owned(), line, column, problem })
}
