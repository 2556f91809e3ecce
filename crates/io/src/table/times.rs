//! Columns of several times or parameters, as COMSOL exports them: `solid.sx (N/m^2) @ t=0`.

use super::error::TableError;
use crate::ArrayChoice;

/// What separates a name from its time.
pub(super) const MARK: &str = " @ ";
/// Most times that a message lists.
const MOST_LISTED: usize = 8;

/// A name without its time, and the time: `solid.sx (N/m^2)` and `t=0`.
pub(super) fn split(name: &str) -> (&str, Option<&str>) {
    name.split_once(MARK).map_or((name, None), |(name, time)| (name.trim_end(), Some(time.trim())))
}

/// The times of all columns, each once, in the order of the columns.
fn times(names: &[String]) -> Vec<&str> {
    let mut all: Vec<&str> = Vec::new();
    for time in names.iter().filter_map(|name| split(name).1) {
        if !all.contains(&time) {
            all.push(time);
        }
    }
    all
}

/// Whether the user names a time in place of an array: `t=0.5`, `@ t=0.5`.
pub(super) fn is_named(time: &str, choice: ArrayChoice) -> bool {
    matches!(choice, ArrayChoice::Named(name) if name.trim().trim_start_matches('@').trim() == time)
}

/// The only time, or the one that the user names in place of an array; `None` without times, or where the user names
/// columns with theirs.
///
/// # Errors
/// [`TableError::Times`] where there are several and the user names nothing.
pub(super) fn chosen<'a>(
    line: usize,
    names: &'a [String],
    choice: ArrayChoice,
) -> Result<Option<&'a str>, TableError> {
    let all = times(names);
    match (choice, &all[..]) {
        (_, []) => Ok(None),
        (_, [only]) => Ok(Some(*only)),
        (ArrayChoice::Named(_), several) => Ok(several.iter().copied().find(|time| is_named(time, choice))),
        (ArrayChoice::Components(_), _) => Ok(None),
        (ArrayChoice::Usual, [first, ..]) => {
            let listed = all[..all.len().min(MOST_LISTED)].join("; ");
            let more = if all.len() > MOST_LISTED { "; and more" } else { "" };
            Err(TableError::Times { line, found: format!("{listed}{more}"), first: (*first).to_owned() })
        }
    }
}
