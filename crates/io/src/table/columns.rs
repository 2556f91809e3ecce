//! Tables with a name for every column.

use super::text::{Text, parsed};
use crate::error::shortened;
use crate::volume::{Lattice, lattice_from_points};
use crate::{ArrayChoice, DataArray, IoError, PolyData, Wanted};

/// Names of the columns of positions along x, y and z, in lower case without marks: `X`, `Points:0`, `coor.X`, `X [m]`.
const POSITIONS: [[&str; 8]; 3] = [
    ["x", "points0", "xpos", "coorx", "coordx", "xcoord", "xcoordinate", "coord1"],
    ["y", "points1", "ypos", "coory", "coordy", "ycoord", "ycoordinate", "coord2"],
    ["z", "points2", "zpos", "coorz", "coordz", "zcoord", "zcoordinate", "coord3"],
];

/// The array of tensors (or what is wanted) that named columns hold, at the positions of the columns x, y and z (or x and y).
///
/// # Errors
/// [`IoError::TableHeader`] without names of all columns or without positions; names line and column of a word that does not
/// fit; and as [`lattice_from_points`].
pub fn read(bytes: &[u8], choice: ArrayChoice, wanted: Wanted) -> Result<Lattice, IoError> {
    let text = Text::of(bytes)?;
    let Some((line, names)) = text.names() else {
        let found = format!("{} columns without names", text.columns());
        return Err(IoError::TableHeader { line: text.first, found });
    };
    let names: Vec<String> = names.iter().map(|name| without_unit(name)).collect();
    let places = POSITIONS.each_ref().map(|known| position_of(&names, known));
    let [Some(x), Some(y), z] = places else {
        return Err(IoError::TableHeader { line, found: shortened(names.join(", ").as_bytes()) });
    };
    let rows = text.lines.iter().enumerate().map(|(i, line)| {
        let needed = [Some(x), Some(y), z];
        row(&text, text.first + i, line, &needed)
    });
    let rows = rows.collect::<Result<Vec<Vec<f64>>, IoError>>()?;
    let at = |row: &[f64], column: Option<usize>| column.map_or(0.0, |c| row[c]);
    let points = rows.iter().map(|row| [at(row, Some(x)), at(row, Some(y)), at(row, z)]).collect();
    let mut data = PolyData { points, ..PolyData::default() };
    let others: Vec<usize> = (0..names.len()).filter(|c| !places.contains(&Some(*c))).collect();
    for (name, columns) in arrays(&names, &others) {
        let values: Vec<f64> = rows.iter().flat_map(|row| columns.iter().map(|&c| row[c])).collect();
        if values.iter().all(|v| v.is_nan()) {
            data.skipped.push(format!("`{name}` (no numbers)"));
        } else {
            data.point_arrays.push(DataArray::new(&name, columns.len(), values));
        }
    }
    let mut lattice = lattice_from_points(data, choice, wanted)?;
    lattice.notes[0] = format!("one point a line, columns by their names in line {line}");
    if text.has_decimal_commas() {
        lattice.notes.push("commas taken as decimal points".to_owned());
    }
    Ok(lattice)
}

/// A name without its unit: `S11 [MPa]`, `solid.sx (N/m^2)`.
fn without_unit(name: &str) -> String {
    let end = name.find(['[', '(']).filter(|at| *at > 0).unwrap_or(name.len());
    name[..end].trim().to_owned()
}

fn position_of(names: &[String], known: &[&str]) -> Option<usize> {
    let plain = |name: &str| name.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
    names.iter().position(|name| known.contains(&plain(name).as_str()))
}

/// The numbers of a line. Words are no number but at the needed columns.
fn row(text: &Text, line: usize, bytes: &[u8], needed: &[Option<usize>]) -> Result<Vec<f64>, IoError> {
    if bytes.trim_ascii().is_empty() {
        return Err(IoError::BlankLine { line });
    }
    let expected = text.columns();
    let mut numbers = Vec::with_capacity(expected);
    for (column, word) in text.separator.words(bytes) {
        let value = parsed(word);
        if needed.contains(&Some(numbers.len())) {
            let found = || shortened(word);
            match value {
                None => return Err(IoError::NotANumber { line, column, found: found() }),
                Some(v) if !v.is_finite() => return Err(IoError::NotFinite { line, column, found: found() }),
                Some(_) => {}
            }
        }
        if numbers.len() == expected {
            break;
        }
        numbers.push(value.unwrap_or(f64::NAN));
    }
    let found = text.separator.words(bytes).count();
    if found != expected {
        let column = bytes.trim_ascii_end().len() + 1;
        return Err(IoError::TableRow { line, column, found, expected });
    }
    Ok(numbers)
}

/// Columns that are one array: `Stress:0`, `Stress:1` and so on follow each other; the others are alone.
fn arrays(names: &[String], columns: &[usize]) -> Vec<(String, Vec<usize>)> {
    let mut all: Vec<(String, Vec<usize>)> = Vec::new();
    for &column in columns {
        let indexed =
            names[column].rsplit_once([':', '_']).and_then(|(stem, i)| Some((stem, i.parse().ok()?)));
        match (indexed, all.last_mut()) {
            (Some((stem, index)), Some((name, members))) if name == stem && members.len() == index => {
                members.push(column);
            }
            (Some((stem, 0)), _) if names[column].contains(':') => all.push((stem.to_owned(), vec![column])),
            _ => all.push((names[column].clone(), vec![column])),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{PlaneChoice, Reading};
    use tigereye_core::Tensor2;

    /// 4 x 3 points, xx = x, yy = 10 y, xy = 0.25, one a line.
    fn table(header: &str, line: impl Fn(f64, f64) -> String) -> Vec<u8> {
        let at = (0..12).map(|i| (f64::from(i % 4) * 2.0 + 1.0, 3.0 - f64::from(i / 4) * 0.5));
        at.fold(header.to_owned(), |text, (x, y)| text + &line(x, y) + "\n").into_bytes()
    }

    #[track_caller]
    fn is_read(bytes: &[u8]) {
        assert_eq!(super::super::kind(bytes), super::super::Kind::Named);
        let lattice = read(bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap();
        let slice = lattice.tensors(Reading::default()).unwrap().slice(PlaneChoice::default()).unwrap();
        let top = |x: f64| Tensor2::new(x, 0.25, 0.25, 30.0);
        assert_eq!(
            slice.field.values()[..4],
            [top(1.0), top(3.0), top(5.0), top(7.0)],
            "row 0 has the largest y"
        );
        assert_eq!(slice.cut.geometry.corner(), [1.0, 2.0, 0.0]);
        assert_eq!(slice.cut.geometry.spacing(), [2.0, 0.5]);
    }

    #[test]
    fn programs_are_understood() {
        let ten = |y: f64| 10.0 * y;
        is_read(&table("x,y,S11,S22,S12\n", |x, y| format!("{x},{y},{x},{},0.25", ten(y))));
        is_read(&table("Node,X,Y,Z,SX,SY,SZ,SXY,SYZ,SXZ\n", |x, y| {
            format!("7,{x},{y},0,{x},{},5,0.25,0.5,0.75", ten(y))
        }));
        let comsol = "% Model: plate.mph\n% x  y  solid.sx (N/m^2)  solid.sy (N/m^2)  solid.sxy (N/m^2)\n";
        is_read(&table(comsol, |x, y| format!("{x}   {y}   {x:.3e}   {:.3e}   2.5e-1", ten(y))));
        let paraview = "\"Stress:0\",\"Stress:1\",\"Stress:2\",\"Stress:3\",\"Stress:4\",\"Stress:5\",\
                        \"Points:0\",\"Points:1\",\"Points:2\"\n";
        is_read(&table(paraview, |x, y| format!("{x},{},5,0.25,0.5,0.75,{x},{y},0", ten(y))));
        is_read(&table("x [m];y [m];sigma_xx [Pa];sigma_yy [Pa];tau_xy [Pa];part\n", |x, y| {
            format!("{x};{y};{x};{};0,25;plate", ten(y))
        }));
        let tecplot =
            "TITLE=\"a\"\nVARIABLES=\"X\" \"Y\" \"du/dx\" \"du/dy\" \"dv/dx\" \"dv/dy\"\nZONE I=4, J=3\n";
        is_read(&table(tecplot, |x, y| format!("{x} {y} {x} 0.25 0.25 {}", ten(y))));
    }

    #[test]
    fn what_is_missing_is_said() {
        #[track_caller]
        fn refused(text: &str, words: &str) {
            let fault = read(text.as_bytes(), ArrayChoice::Usual, Wanted::Tensors).unwrap_err().to_string();
            assert!(fault.contains(words), "{text:?}: {fault}");
        }
        refused("1 2 3 4 5\n", "line 1: the columns `5 columns without names`");
        refused("a,y,S11,S22,S12\n1,2,3,4,5\n", "line 1: the columns `a, y, S11, S22, S12`");
        refused("x,y,S11,S22\n1,2,3,4\n", "`S11` (1 component)");
        refused("x,y,S11,S22,S12\n1,2,3,4,5\n1,b,3,4,5\n", "line 3, column 3: expected a number");
        refused("x,y,S11,S22,S12\n1,2,3,4,5\n2,2,3,4\n", "line 3, column 8: found 4 numbers, expected 5");
        refused("x,y,S11,S22,S12\n1,2,3,4,5\n\n2,2,3,4,5\n", "line 3");
    }
}
