//! What a table is.

use crate::names::Names;
use crate::results::Results;
use crate::unavailable::Unavailable;
use tigereye_report::Column;

/// A row's name and entries.
pub(crate) type Row = (String, Vec<String>);
/// A row of the results, every name looked up; or why it is not to be had.
pub(crate) type PlannedRow = Box<dyn Fn(&Results<'_>) -> Result<Row, Unavailable> + Send + Sync>;

/// What stands in the experiment file, and how its rows are made.
pub(crate) trait TableKind {
    /// The columns, that of the rows' names first.
    fn columns(&self) -> Vec<Column>;

    /// The rows without faults whose runs are made.
    fn rows(&self, names: &mut Names<'_, '_>) -> Vec<PlannedRow>;
}

/// Columns: words first, then numbers.
pub(crate) fn columns(headings: &[&str]) -> Vec<Column> {
    let column = |(i, heading): (usize, &&str)| Column { heading: (*heading).to_owned(), words: i == 0 };
    headings.iter().enumerate().map(column).collect()
}

/// Rows of items that are resolved one by one: one that needs a run of another scope is left out.
pub(crate) fn rows_of<T>(
    items: &[T],
    names: &mut Names<'_, '_>,
    row: impl Fn(&T, &mut Names<'_, '_>) -> Option<PlannedRow>,
) -> Vec<PlannedRow> {
    items.iter().filter_map(|item| names.part(|names| row(item, names))).collect()
}
