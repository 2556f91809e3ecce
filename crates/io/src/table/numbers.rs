//! Rows of numbers as an image.

use super::text::{Text, parsed};
use crate::text::{TextError, shortened};
use crate::volume::{Frame, Known, Lattice, World};
use crate::{IoError, ScalarType};
use tigereye_core::Grid;

/// Reads an image of single numbers: every number is a cell, the first row on top. Lines above the numbers are passed
/// over.
///
/// # Errors
/// Names line and column of a word that is no number, and rows of different length.
pub fn read(bytes: &[u8]) -> Result<Lattice, IoError> {
    let text = Text::of(bytes)?;
    let expected = text.columns();
    let mut values = Vec::with_capacity(expected * text.lines.len());
    for &(line, row) in &text.lines {
        let before = values.len();
        for (column, word) in text.separator.words(row) {
            let fault = || TextError::NotANumber { line, column, found: shortened(word) };
            values.push(parsed(word).ok_or_else(fault)?);
        }
        let found = values.len() - before;
        if found != expected {
            let column = row.trim_ascii_end().len() + 1;
            return Err(TextError::RaggedRow { line, column, found, expected }.into());
        }
    }
    let grid = Grid::new(expected, text.lines.len())?;
    Ok(Lattice {
        size: [grid.width(), grid.height(), 1],
        components: 1,
        values,
        scalar: ScalarType::Float64,
        axes: [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
        origin: [0.0, (grid.height() - 1) as f64, 0.0],
        unit: None,
        world: World::Absent,
        measurement: None,
        mask: None,
        order: None,
        frame: (Frame::World, Known::Stated),
        array: "numbers".to_owned(),
        component_names: Vec::new(),
        notes: vec!["one number a cell, first row on top".to_owned()],
        remarks: Vec::new(),
        order_remarks: Vec::new(),
        warnings: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_a_cell() {
        for text in ["1 2 3\n4 5 6\n7 8 9\n", "# image\n1,2,3\n4,5,6\n7,8,9\n"] {
            let lattice = read(text.as_bytes()).unwrap();
            assert_eq!((lattice.size, lattice.components), ([3, 3, 1], 1));
            let slice = lattice.scalars(crate::volume::PlaneChoice::default()).unwrap();
            assert_eq!(slice.field.values(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        }
        let fault = read(b"1 2\n3 x\n").unwrap_err().to_string();
        assert!(fault.contains("line 2, column 3"), "{fault}");
        assert!(matches!(read(b"1 2\n3\n"), Err(IoError::Text(TextError::RaggedRow { line: 2, .. }))));
    }
}
