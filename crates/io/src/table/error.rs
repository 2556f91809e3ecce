//! What keeps a text from being a table.

use thiserror::Error;

/// What keeps a text from being a table, one point a line.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TableError {
    /// A table whose columns are not known.
    #[error(
        "line {line}: the columns `{found}` are not understood: expected a line above the numbers with names such as x, y, u, v"
    )]
    Header {
        /// The line that should name them, or the first of the numbers.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// Fewer names than columns: nobody knows which column has none.
    #[error(
        "line {line} names {names} columns, but the rows below have {columns}: expected a name for every column, also for row \
         numbers"
    )]
    Names {
        /// The line that names them.
        line: usize,
        /// Names.
        names: usize,
        /// Numbers in a row.
        columns: usize,
    },
    /// A row of a table with other columns than the first, or too few.
    #[error(
        "line {line}, column {column}: found {found} numbers, expected {expected}: x, y, u, v and as many as in the first row"
    )]
    Row {
        /// Line, from 1.
        line: usize,
        /// Where the row ends, from 1.
        column: usize,
        /// Numbers in this row.
        found: usize,
        /// Numbers that are needed.
        expected: usize,
    },
    /// A word that is none of those that say whether a point is valid.
    #[error("line {line}, column {column}: expected a number, true or false, found `{found}`")]
    NotValidity {
        /// Line, from 1.
        line: usize,
        /// Column of the word, from 1.
        column: usize,
        /// The word, shortened.
        found: String,
    },
    /// Columns of several times or parameters.
    #[error(
        "line {line}: the columns are those of several times or parameters ({found}): expected the name of one, such as `{first}`"
    )]
    Times {
        /// The line that names the columns.
        line: usize,
        /// The times, or the first of many.
        found: String,
        /// One of them.
        first: String,
    },
    /// A zone of a Tecplot file that is not one point a line.
    #[error("line {line}: {found}: expected {expected}")]
    Zone {
        /// The line that says so.
        line: usize,
        /// What the zone is.
        found: &'static str,
        /// What it should be, and how to get it.
        expected: &'static str,
    },
    /// A vector between the positions of the others.
    #[error(
        "line {line}: {axis} = {value} is off the lattice: expected positions in equal steps (of {step} on average)"
    )]
    Position {
        /// Line, from 1.
        line: usize,
        /// `x` or `y`.
        axis: char,
        /// The position.
        value: f64,
        /// Mean step of the positions.
        step: f64,
    },
    /// Two vectors at one position of the plane, or vectors of several planes.
    #[error(
        "line {line}: a second row at the x and y of line {before}: expected the vectors of one plane, one at each position"
    )]
    SamePosition {
        /// Line, from 1.
        line: usize,
        /// Line of the first one.
        before: usize,
    },
    /// Two rows at one position.
    #[error(
        "line {line}: a second row at the position of line {before}: expected one row a point, such as those of one time"
    )]
    SamePoint {
        /// Line, from 1.
        line: usize,
        /// Line of the first one.
        before: usize,
    },
    /// Vectors at few of the positions that their coordinates span.
    #[error(
        "{vectors} vectors on a lattice of {width} x {height} positions: expected vectors at half of them or more"
    )]
    SparsePositions {
        /// Vectors in the file.
        vectors: usize,
        /// Different x.
        width: usize,
        /// Different y.
        height: usize,
    },
}
