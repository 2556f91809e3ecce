//! 2x2 matrices in plain text.
//!
//! 2H rows of 2W numbers separated by blanks. Cell (x, y) is the 2x2 block at rows 2y, 2y+1 and columns 2x, 2x+1, in
//! the frame x right, y up; row 0 is the top row of cells:
//!
//! ```text
//! xx(0,0) xy(0,0)  xx(1,0) xy(1,0)  ...
//! yx(0,0) yy(0,0)  yx(1,0) yy(1,0)  ...
//! xx(0,1) xy(0,1)  ...
//! ```
//!
//! Blanks at both ends of a row, blank lines at the end, CR LF and a UTF-8 byte order mark are accepted; `nan` and
//! `inf` are not.

mod error;
use crate::IoError;
use crate::text::{TextError, shortened};
use crate::volume::Lattice;
pub use error::MatricesError;
use std::fmt::Write as _;
use tigereye_core::{Cell, CoreError, Field, Grid, Symmetry, Tensor2};

/// Reads a tensor field.
///
/// # Errors
/// Names line and column of the first number, row or blank line that does not fit.
pub fn read(bytes: &[u8]) -> Result<Field<Tensor2>, IoError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut rows = Rows::default();
    for (i, line) in bytes.split(|&b| b == b'\n').enumerate() {
        rows.add(i + 1, line.strip_suffix(b"\r").unwrap_or(line))?;
    }
    rows.field()
}

/// Cells across at most, and rows of cells for each of them at least, of what may be a table instead.
const NARROW: usize = 4;
const LONG: usize = 5;
/// Lines of four numbers at least whose second and third agree in every one, as xy and yx of a table do.
const ALIKE: usize = 4;

/// Whether lines of four numbers are symmetric tensors each, while as blocks they are not.
fn has_a_tensor_a_line(field: &Field<Tensor2>) -> bool {
    let grid = field.grid();
    let is_table = |c: [&Tensor2; 2]| {
        let [left, right] = c.map(Tensor2::components);
        left[1] == right[0] && left[3] == right[2]
    };
    grid.width() == 2
        && 2 * grid.height() >= ALIKE
        && field.values().as_chunks::<2>().0.iter().all(|[left, right]| is_table([left, right]))
        && field.values().iter().any(|t| !t.is_symmetric_within(0.0))
}

/// Reads a tensor field as a lattice, with a warning where a table would look the same.
///
/// # Errors
/// As [`read`].
pub fn read_lattice(bytes: &[u8]) -> Result<Lattice, IoError> {
    let field = read(bytes)?;
    let mut lattice = Lattice::from_field(&field);
    let [width, height, _] = lattice.size;
    let symmetry = Symmetry::of(&field);
    if field.values().iter().any(|t| !symmetry.has_symmetric(t)) {
        lattice.remarks.push(format!(
            "took blocks of 2 x 2 numbers as the tensors of {width} x {height} cells; numbers of one quantity need --derive"
        ));
    }
    if width <= NARROW && height >= LONG * width || has_a_tensor_a_line(&field) {
        lattice.warnings.push(format!(
            "{width} x {height} cells of 2x2 blocks: a table with one tensor a line would look the same (it needs positions \
             and names of its columns, or an array in NumPy's format)"
        ));
    }
    Ok(lattice)
}

/// Writes a tensor field; every number with the digits that bring it back exactly.
///
/// # Errors
/// [`CoreError::NonFiniteTensor`] for a component that the format cannot hold.
pub fn write(field: &Field<Tensor2>) -> Result<Vec<u8>, IoError> {
    if let Some(Cell { x, y }) = field.first_non_finite() {
        return Err(CoreError::NonFiniteTensor { x, y }.into());
    }
    let mut text = String::new();
    for row in field.values().chunks(field.grid().width()) {
        for half in 0..2 {
            let numbers = row.iter().flat_map(|t| {
                let c = t.components();
                [c[2 * half], c[2 * half + 1]]
            });
            for (i, number) in numbers.enumerate() {
                let blank = if i == 0 { "" } else { " " };
                // Writing to a String does not fail.
                let _ = write!(text, "{blank}{number:?}");
            }
            text.push('\n');
        }
    }
    Ok(text.into_bytes())
}

/// What has been read so far.
#[derive(Default)]
struct Rows {
    numbers: Vec<f64>,
    columns: usize,
    rows: usize,
    last_line: usize,
    first_blank: Option<usize>,
}

impl Rows {
    fn add(&mut self, line: usize, text: &[u8]) -> Result<(), IoError> {
        let before = self.numbers.len();
        let mut last_column = 0;
        for (column, word) in words(text) {
            if let Some(blank) = self.first_blank {
                return Err(MatricesError::BlankLine { line: blank }.into());
            }
            self.numbers.push(number(line, column, word)?);
            let found = self.numbers.len() - before;
            if self.rows > 0 && found == self.columns + 1 {
                // Counting on would parse a hostile line for nothing.
                let found = words(text).count();
                return Err(TextError::RaggedRow { line, column, found, expected: self.columns }.into());
            }
            last_column = column;
        }
        let found = self.numbers.len() - before;
        if found == 0 {
            self.first_blank.get_or_insert(line);
            return Ok(());
        }
        if self.rows == 0 && !found.is_multiple_of(2) {
            return Err(MatricesError::OddColumns { column: last_column, columns: found }.into());
        }
        if self.rows > 0 && found < self.columns {
            let column = text.trim_ascii_end().len() + 1;
            return Err(TextError::RaggedRow { line, column, found, expected: self.columns }.into());
        }
        (self.columns, self.last_line) = (found, line);
        self.rows += 1;
        Ok(())
    }

    fn field(self) -> Result<Field<Tensor2>, IoError> {
        if self.rows == 0 {
            return Err(TextError::Empty.into());
        }
        if !self.rows.is_multiple_of(2) {
            return Err(MatricesError::OddRows { line: self.last_line, rows: self.rows }.into());
        }
        let grid = Grid::new(self.columns / 2, self.rows / 2)?;
        let (n, w) = (&self.numbers, self.columns);
        Ok(Field::from_fn(grid, |c| {
            let i = 2 * c.y * w + 2 * c.x;
            Tensor2::new(n[i], n[i + 1], n[i + w], n[i + w + 1])
        }))
    }
}

/// The words of a line with their columns, from 1.
fn words(line: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    line.split(u8::is_ascii_whitespace)
        .scan(1, |column, word| {
            let at = *column;
            *column += word.len() + 1;
            Some((at, word))
        })
        .filter(|(_, word)| !word.is_empty())
}

fn number(line: usize, column: usize, word: &[u8]) -> Result<f64, IoError> {
    match std::str::from_utf8(word).ok().and_then(|w| w.parse::<f64>().ok()) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(TextError::NotFinite { line, column, found: shortened(word) }.into()),
        None => Err(TextError::NotANumber { line, column, found: shortened(word) }.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn refused(text: &str, message: &str) {
        assert_eq!(read(text.as_bytes()).map_err(|e| e.to_string()), Err(message.to_owned()), "{text:?}");
    }

    #[test]
    fn blocks_are_cells_from_the_top() {
        let field = read(b"\xef\xbb\xbf 1 2 5 6 \r\n3 4\t7 8\r\n-1 0 0 0\r\n0 1e-3 0 .5\r\n\r\n \n").unwrap();
        assert_eq!((field.grid().width(), field.grid().height()), (2, 2));
        assert_eq!(*field.at(Cell::new(0, 0)), Tensor2::new(1.0, 2.0, 3.0, 4.0));
        assert_eq!(*field.at(Cell::new(1, 0)), Tensor2::new(5.0, 6.0, 7.0, 8.0));
        assert_eq!(*field.at(Cell::new(0, 1)), Tensor2::new(-1.0, 0.0, 0.0, 1e-3));
    }

    #[test]
    fn messages_name_line_and_column() {
        refused("", "line 1: expected rows of numbers, found none (an empty file, or words alone)");
        refused(" \n\n", "line 1: expected rows of numbers, found none (an empty file, or words alone)");
        refused("1 2\n3  x4\n", "line 2, column 4: expected a number, found `x4`");
        refused("1 nan\n3 4\n", "line 1, column 3: expected a finite number, found `nan`");
        refused("1 2\n-inf 4\n", "line 2, column 1: expected a finite number, found `-inf`");
        refused("1 1e999\n3 4\n", "line 1, column 3: expected a finite number, found `1e999`");
        refused("1 2\n3 4 5 6\n", "line 2, column 5: expected 2 numbers as in line 1, found 4");
        refused("1 2 3 4\n3 4\n", "line 2, column 4: expected 4 numbers as in line 1, found 2");
        refused("1 2 3\n", "line 1, column 5: expected an even number of columns (2x2 blocks), found 3");
        refused(
            "1 2\n3 4\n5 6\n\n",
            "line 3: expected an even number of rows (2x2 blocks), the file ends after 3",
        );
        refused(
            "1 2\n\n3 4\n",
            "line 2: expected numbers, found a blank line (they are allowed at the end only)",
        );
    }

    #[test]
    fn narrow_fields_are_said_to_look_like_tables() {
        let rows = |n: usize| "1 0.5 0.5 2\n".repeat(2 * n);
        let warnings = |n| read_lattice(rows(n).as_bytes()).unwrap().warnings.len();
        assert_eq!((warnings(1), warnings(21)), (0, 1));
        // Four numbers a line with equal shears, which as blocks are not symmetric.
        let lines = |n: usize| (0..2 * n).fold(String::new(), |text, i| text + &format!("{i} 0.5 0.5 2\n"));
        let warned = |text: &str| !read_lattice(text.as_bytes()).unwrap().warnings.is_empty();
        assert!(warned(&lines(2)) && !warned("1 0 2 0\n0 1 0 2\n3 0 4 0\n0 3 0 4\n"));
    }

    #[test]
    fn what_is_written_comes_back_exactly() {
        let values = [0.1, -0.0, 5e-324, f64::MAX, 1.0 / 3.0, -1e-300, 123456789.125, 2.0];
        let grid = Grid::new(2, 1).unwrap();
        let tensors = values.chunks(4).map(|c| Tensor2::new(c[0], c[1], c[2], c[3])).collect();
        let field = Field::from_values(grid, tensors).unwrap();
        assert_eq!(read(&write(&field).unwrap()).unwrap(), field);
        let nan = field.map(|_| Tensor2::isotropic(f64::NAN));
        assert_eq!(write(&nan), Err(CoreError::NonFiniteTensor { x: 0, y: 0 }.into()));
    }
}
