//! What keeps a text from being rows of 2x2 blocks.

use thiserror::Error;

/// What keeps a text from being rows of 2x2 blocks.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MatricesError {
    /// 2x2 blocks need an even number of columns.
    #[error("line 1, column {column}: expected an even number of columns (2x2 blocks), found {columns}")]
    OddColumns {
        /// Column of the last number, from 1.
        column: usize,
        /// Numbers in the row.
        columns: usize,
    },
    /// 2x2 blocks need an even number of rows.
    #[error("line {line}: expected an even number of rows (2x2 blocks), the file ends after {rows}")]
    OddRows {
        /// The last line with numbers.
        line: usize,
        /// Rows with numbers.
        rows: usize,
    },
    /// An empty line above further rows.
    #[error("line {line}: expected numbers, found a blank line (they are allowed at the end only)")]
    BlankLine {
        /// Line, from 1.
        line: usize,
    },
}
