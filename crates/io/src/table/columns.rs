//! Tables with a name for every column.

use super::error::TableError;
use super::text::{Text, parsed};
use super::times;
use super::validity::{Validity, parsed_validity};
use crate::text::{TextError, shortened};
use crate::volume::{Lattice, lattice_from_points};
use crate::{ArrayChoice, DataArray, IoError, PolyData, Wanted, taken_upwards};

/// Names of the columns of positions along x, y and z, in lower case without marks: `X`, `Points:0`, `coor.X`, `X [m]`.
const POSITIONS: [[&str; 18]; 3] = [
    [
        "x",
        "points0",
        "xpos",
        "posx",
        "coorx",
        "coordx",
        "xcoord",
        "xcoordinate",
        "coord1",
        "coor1",
        "xc",
        "centroidx",
        "xcentroid",
        "xlocation",
        "cellcenters0",
        "cellcentersx",
        "lon",
        "longitude",
    ],
    [
        "y",
        "points1",
        "ypos",
        "posy",
        "coory",
        "coordy",
        "ycoord",
        "ycoordinate",
        "coord2",
        "coor2",
        "yc",
        "centroidy",
        "ycentroid",
        "ylocation",
        "cellcenters1",
        "cellcentersy",
        "lat",
        "latitude",
    ],
    [
        "z",
        "points2",
        "zpos",
        "posz",
        "coorz",
        "coordz",
        "zcoord",
        "zcoordinate",
        "coord3",
        "coor3",
        "zc",
        "centroidz",
        "zcentroid",
        "zlocation",
        "cellcenters2",
        "cellcentersz",
        "height",
        "depth",
    ],
];

/// A column: its name, its unit and its time, as they stand above the numbers.
struct Column {
    name: String,
    unit: Option<String>,
    time: Option<String>,
}

impl Column {
    /// `S11 [MPa]`, `solid.sx (N/m^2) @ t=0`.
    fn of(text: &str) -> Self {
        let (text, time) = times::split(text);
        // An index follows its name at once: `T[0][1]`, but `strain [1]`.
        let is_index = |at: usize| {
            let inside = text[at + 1..].split([']', ')']).next().unwrap_or_default();
            text[..at].ends_with(|c: char| !c.is_whitespace())
                && !inside.is_empty()
                && inside.chars().all(|c| c.is_ascii_digit())
        };
        let brackets = text.match_indices(['[', '(']).map(|(at, _)| at);
        let start = brackets.filter(|at| *at > 0).find(|&at| !is_index(at));
        let unit = start.map(|at| text[at + 1..].trim_end_matches([']', ')', ' ']).to_owned());
        let name = text[..start.unwrap_or(text.len())].trim().to_owned();
        Self { name, unit, time: time.map(str::to_owned) }
    }
}

/// The columns by their names, the line of these, and which of them are positions along x, y and z.
struct Header {
    line: usize,
    columns: Vec<Column>,
    places: [Option<usize>; 3],
    /// What is left aside because other columns are positions, too.
    doubled: Vec<usize>,
}

impl Header {
    /// The nearest line above the numbers that names positions; without names, three columns are x, y and a number
    /// where single numbers are wanted.
    fn of(text: &Text, wanted: Wanted) -> Result<Self, IoError> {
        let candidates: Vec<Self> = text
            .names()
            .map(|(line, names)| Self::named(line, &names).with_units(text.units_below(line)))
            .collect();
        let first = candidates.first().map(|h| (h.line, h.names()));
        if let Some(found) = candidates.into_iter().find(|h| h.places.iter().flatten().count() >= 2) {
            return Ok(found);
        }
        match first {
            Some((line, names)) => {
                Err(TableError::Header { line, found: shortened(names.as_bytes()) }.into())
            }
            None if wanted.is_numbers() && text.columns() == 3 => {
                Ok(Self::named(0, &["x", "y", "value"].map(str::to_owned)))
            }
            None => {
                let found = format!("{} columns without names", text.columns());
                Err(TableError::Header { line: text.first(), found }.into())
            }
        }
    }

    fn named(line: usize, names: &[String]) -> Self {
        let columns: Vec<Column> = names.iter().map(|name| Column::of(name)).collect();
        let plain =
            |c: &Column| c.name.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
        let called = |known: &[&str]| -> Vec<usize> {
            (0..columns.len()).filter(|&c| known.contains(&plain(&columns[c]).as_str())).collect()
        };
        let all = POSITIONS.each_ref().map(|known| called(known));
        let places = all.each_ref().map(|found| found.first().copied());
        let doubled = all.iter().flat_map(|found| found.iter().skip(1).copied()).collect();
        Self { line, columns, places, doubled }
    }

    /// With the units of a line of their own, for columns that have none in their names.
    fn with_units(mut self, units: Vec<Option<String>>) -> Self {
        for (column, unit) in self.columns.iter_mut().zip(units) {
            column.unit = column.unit.take().or(unit);
        }
        self
    }

    fn names(&self) -> String {
        self.columns.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ")
    }

    /// Leaves the columns of the time that the user chooses, or of the only one, under names without it; without such a
    /// choice every column has its time in its name. Returns the columns that are left aside.
    ///
    /// # Errors
    /// [`TableError::Times`].
    fn choose_time(&mut self, choice: ArrayChoice) -> Result<(Option<String>, Vec<usize>), IoError> {
        let full = |c: &Column| {
            c.time.as_ref().map_or_else(|| c.name.clone(), |time| format!("{}{}{time}", c.name, times::MARK))
        };
        let names: Vec<String> = self.columns.iter().map(full).collect();
        let chosen = times::chosen(self.line, &names, choice)?.map(str::to_owned);
        match &chosen {
            Some(time) => {
                let is_other = |c: &Column| c.time.as_ref().is_some_and(|t| t != time);
                let aside = (0..names.len()).filter(|&c| is_other(&self.columns[c])).collect();
                Ok((chosen, aside))
            }
            None => {
                self.columns.iter_mut().zip(names).for_each(|(column, name)| column.name = name);
                Ok((None, Vec::new()))
            }
        }
    }

    /// The columns that say which points are valid; one that the user names as data is none.
    fn validity(&self, choice: ArrayChoice, wanted: Wanted) -> Vec<(usize, Validity)> {
        // Those of a mask are what it is read for.
        if wanted == Wanted::Mask {
            return Vec::new();
        }
        let is_data = |name: &str| match choice {
            ArrayChoice::Usual => false,
            ArrayChoice::Named(named) => named == name,
            ArrayChoice::Components(components) => components.arrays().any(|array| array == name),
        };
        let validity = |(at, column): (usize, &Column)| {
            let is_free = !self.places.contains(&Some(at)) && !is_data(&column.name);
            Some((at, Validity::of(&column.name).filter(|_| is_free)?))
        };
        self.columns.iter().enumerate().filter_map(validity).collect()
    }

    /// A warning where columns that belong together have different units.
    fn unequal_units(&self, of: &[usize]) -> Option<String> {
        let units: Vec<&String> = of.iter().filter_map(|&c| self.columns[c].unit.as_ref()).collect();
        let differ = units.windows(2).any(|u| u[0] != u[1]);
        let names: Vec<&str> = of.iter().map(|&c| self.columns[c].name.as_str()).collect();
        let units = units.iter().map(|u| u.as_str()).collect::<Vec<_>>().join(", ");
        differ.then(|| {
            format!("the columns {} have different units ({units}), taken as they stand", names.join(", "))
        })
    }
}

/// The array of tensors (or what is wanted) that named columns hold, at the positions of the columns x, y and z (or x
/// and y).
///
/// # Errors
/// [`TableError::Header`] without names of all columns or without positions; names line and column of a word that
/// does not fit; and as [`lattice_from_points`].
pub fn read(bytes: &[u8], choice: ArrayChoice, wanted: Wanted) -> Result<Lattice, IoError> {
    let text = Text::of(bytes)?;
    text.check_zones()?;
    let mut header = Header::of(&text, wanted)?;
    let (time, of_other_times) = header.choose_time(choice)?;
    let validity = header.validity(choice, wanted);
    // A time is no array.
    let is_time = time.as_ref().is_some_and(|time| times::is_named(time, choice));
    let choice = if is_time { ArrayChoice::Usual } else { choice };
    let places = header.places;
    let rows = text.lines.iter().map(|(number, line)| row(&text, *number, line, &places, &validity));
    let rows = rows.collect::<Result<Vec<Vec<f64>>, IoError>>()?;
    let points: Vec<[f64; 3]> =
        rows.iter().map(|row| places.map(|place| place.map_or(0.0, |c| row[c]))).collect();
    let mut data = PolyData { points, ..PolyData::default() };
    let is_validity = |c: &usize| validity.iter().any(|(at, _)| at == c);
    let is_left = |c: &usize| header.doubled.contains(c) || of_other_times.contains(c) || is_validity(c);
    let others: Vec<usize> =
        (0..header.columns.len()).filter(|c| !places.contains(&Some(*c)) && !is_left(c)).collect();
    let names: Vec<&str> = header.columns.iter().map(|c| c.name.as_str()).collect();
    let arrays = arrays(&names, &others);
    for (name, columns) in &arrays {
        let values: Vec<f64> = rows.iter().flat_map(|row| columns.iter().map(|&c| row[c])).collect();
        if values.iter().all(|v| v.is_nan()) {
            data.skipped.push(format!("`{name}` (no numbers)"));
        } else {
            data.point_arrays.push(DataArray::new(name, columns.len(), values));
        }
    }
    let mask = mask(&data.points, &rows, &validity)?;
    let lines: Vec<usize> = text.lines.iter().map(|(line, _)| *line).collect();
    check_positions(&data.points, &lines)?;
    let mut lattice = lattice_from_points(data, choice, wanted)?;
    if let Some(mask) = mask {
        let _ = lattice.mask_by(&mask);
    }
    lattice.notes[0] = match header.line {
        0 => "one point per line, columns x, y and a number by position".to_owned(),
        line => format!("one point per line, columns named in line {line}"),
    };
    if let Some(time) = &time {
        let others = of_other_times.len();
        let aside =
            if others > 0 { format!("; {others} columns of other times ignored") } else { String::new() };
        lattice.notes.push(format!("columns at {time}{aside}"));
    }
    // Such a column leaves points out where it is not 0, if it stands beside the data.
    if wanted == Wanted::Mask && Validity::of(&lattice.array) == Some(Validity::Mask) {
        let words = format!("of the column `{}`, points are kept where it is above 0", lattice.array);
        lattice.remarks.push(words);
    }
    lattice.remarks.extend(validity.iter().filter_map(|&(at, validity)| {
        let values: Vec<f64> = rows.iter().map(|row| row[at]).collect();
        validity.said(names[at], &values, "points")
    }));
    let said = text.decimal_commas();
    lattice.remarks.extend(said.map(|(words, _)| words.to_owned()));
    if said.is_some_and(|(_, thousands)| thousands) {
        lattice
            .warnings
            .push("every comma is followed by three digits, as a thousands separator would be".to_owned());
    }
    if !header.doubled.is_empty() {
        let name = |&c: &usize| names[c];
        let taken: Vec<&str> = places.iter().flatten().map(name).collect();
        let aside: Vec<&str> = header.doubled.iter().map(name).collect();
        let (taken, aside) = (taken.join(", "), aside.join(", "));
        lattice.warnings.push(format!("positions taken from the columns {taken}; {aside} ignored"));
    }
    let is_pixel = |c: &usize| {
        header.columns[*c].unit.as_ref().is_some_and(|u| u.starts_with("px") || u.starts_with("pix"))
    };
    if places[1].as_ref().or(places[2].as_ref()).is_some_and(is_pixel) {
        lattice.warnings.push(
            "positions are in pixels: y taken to run upwards; where it runs downwards, as rows of an image do, the picture is \
             upside down and xy has the other sign"
                .to_owned(),
        );
    } else if let Some(axis) = lattice.vertical_axis() {
        lattice.remarks.push(taken_upwards(axis));
    }
    let read =
        |name: &str| arrays.iter().find(|(n, _)| n == name).map(|(_, c)| c.clone()).unwrap_or_default();
    let of_array: Vec<usize> = lattice.array.split(", ").flat_map(read).collect();
    let of_places: Vec<usize> = places.into_iter().flatten().collect();
    let is_read = |c: &usize| of_array.contains(c) || of_places.contains(c) || is_left(c);
    let unread: Vec<&str> = (0..names.len()).filter(|c| !is_read(c)).map(|c| names[c]).collect();
    if !unread.is_empty() {
        lattice.remarks.push(unread_words(&unread));
    }
    lattice.warnings.extend([of_places, of_array].iter().filter_map(|of| header.unequal_units(of)));
    Ok(lattice)
}

/// Refuses two rows at one position, of several times or layers.
///
/// # Errors
/// [`TableError::SamePoint`].
fn check_positions(points: &[[f64; 3]], lines: &[usize]) -> Result<(), TableError> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    // A zero is one whatever its sign.
    let key = |i: usize| points[i].map(|v| v + 0.0);
    let compare = |a: &usize, b: &usize| {
        let (p, q) = (key(*a), key(*b));
        (0..3).map(|i| p[i].total_cmp(&q[i])).find(|o| o.is_ne()).unwrap_or(a.cmp(b))
    };
    order.sort_unstable_by(compare);
    let twice = order.windows(2).filter(|w| key(w[0]) == key(w[1])).min_by_key(|w| w[1]);
    match twice {
        Some(w) if points.len() > 1 => Err(TableError::SamePoint { line: lines[w[1]], before: lines[w[0]] }),
        _ => Ok(()),
    }
}

/// Most columns that a message names.
const MOST_NAMED: usize = 12;

/// The message about columns that are not read. Some of them may mark invalid points.
fn unread_words(unread: &[&str]) -> String {
    let named = unread[..unread.len().min(MOST_NAMED)].join(", ");
    let more = unread.len().saturating_sub(MOST_NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!(
        "columns not read, even if they mark invalid points: {named}{more} (write points to leave out as nan)"
    )
}

/// Which points the columns of validity leave, on the lattice of all; `None` where that is every one.
///
/// # Errors
/// As [`lattice_from_points`].
fn mask(
    points: &[[f64; 3]],
    rows: &[Vec<f64>],
    validity: &[(usize, Validity)],
) -> Result<Option<Lattice>, IoError> {
    let is_out = |row: &Vec<f64>| validity.iter().any(|(at, validity)| validity.leaves_out(row[*at]));
    let confidence: Vec<f64> = rows.iter().map(|row| if is_out(row) { 0.0 } else { 1.0 }).collect();
    if !confidence.contains(&0.0) {
        return Ok(None);
    }
    let data = PolyData {
        points: points.to_vec(),
        point_arrays: vec![DataArray::new("mask", 1, confidence)],
        ..PolyData::default()
    };
    lattice_from_points(data, ArrayChoice::Usual, Wanted::Scalars).map(Some)
}

/// The numbers of a line. Words are no number but at the needed columns; those of validity may be words.
fn row(
    text: &Text,
    line: usize,
    bytes: &[u8],
    needed: &[Option<usize>],
    validity: &[(usize, Validity)],
) -> Result<Vec<f64>, IoError> {
    let expected = text.columns();
    let mut numbers = Vec::with_capacity(expected);
    for (column, word) in text.separator.words(bytes) {
        let is_validity = validity.iter().any(|(at, _)| *at == numbers.len());
        let value = if is_validity { parsed_validity(word) } else { parsed(word) };
        if is_validity && value.is_none() {
            return Err(TableError::NotValidity { line, column, found: shortened(word) }.into());
        }
        if needed.contains(&Some(numbers.len())) {
            let found = || shortened(word);
            match value {
                None => return Err(TextError::NotANumber { line, column, found: found() }.into()),
                Some(v) if !v.is_finite() => {
                    return Err(TextError::NotFinite { line, column, found: found() }.into());
                }
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
        return Err(TableError::Row { line, column, found, expected }.into());
    }
    Ok(numbers)
}

/// Columns that are one array: `Stress:0`, `Stress:1` and so on follow each other; the others are alone.
fn arrays(names: &[&str], columns: &[usize]) -> Vec<(String, Vec<usize>)> {
    let mut all: Vec<(String, Vec<usize>)> = Vec::new();
    for &column in columns {
        let indexed =
            names[column].rsplit_once([':', '_']).and_then(|(stem, i)| Some((stem, i.parse().ok()?)));
        match (indexed, all.last_mut()) {
            (Some((stem, index)), Some((name, members))) if name == stem && members.len() == index => {
                members.push(column);
            }
            (Some((stem, 0)), _) if names[column].contains(':') => all.push((stem.to_owned(), vec![column])),
            _ => all.push((names[column].to_owned(), vec![column])),
        }
    }
    all
}

#[cfg(test)]
mod tests;
