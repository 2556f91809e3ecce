//! Tables of vectors.

use super::error::TableError;
use super::steps::Steps;
use super::text::{Text, parsed};
use super::times;
use super::validity::{Validity, parsed_validity};
use crate::text::{TextError, shortened};
use crate::volume::{Frame, Known, Lattice, World};
use crate::{ArrayChoice, IoError, ScalarType};

/// Nodes of the lattice for each vector at most: others lie on no lattice, or on too thin a part of one.
const SPARSE: usize = 2;
/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    X,
    Y,
    U,
    V,
    Validity(Validity),
}

impl Role {
    const NEEDED: [Self; 4] = [Self::X, Self::Y, Self::U, Self::V];

    /// The word of a name that says what its column is: in small letters, without units and marks.
    fn word(name: &str) -> Option<String> {
        let name = name.to_ascii_lowercase();
        let mut words = name.split([' ', '[', '(', '"']).filter(|w| !w.is_empty());
        let first = words.next()?;
        let word = if ["velocity", "displacement"].contains(&first) { words.next()? } else { first };
        Some(word.replace(['_', ':', '-', '.'], ""))
    }

    /// The role of a name such as `x`, `x [px]`, `"U m/s"` or `Velocity u [m/s]`.
    fn of(name: &str) -> Option<Self> {
        if let Some(validity) = Validity::of(name) {
            return Some(Self::Validity(validity));
        }
        let word = Self::word(name)?;
        if let Some(role) = PAIRS
            .iter()
            .find_map(|[u, v]| if word == *u { Some(Self::U) } else { (word == *v).then_some(Self::V) })
        {
            return Some(role);
        }
        match word.as_str() {
            "x" | "xpos" | "points0" => Some(Self::X),
            "y" | "ypos" | "points1" => Some(Self::Y),
            _ => None,
        }
    }
}

/// What both components of a vector are called.
const PAIRS: [[&str; 2]; 8] = [
    ["u", "v"],
    ["vx", "vy"],
    ["ux", "uy"],
    ["u0", "u1"],
    ["velx", "vely"],
    ["velocityx", "velocityy"],
    ["velocity0", "velocity1"],
    ["uvel", "vvel"],
];

/// Which column holds what.
struct Columns {
    /// As in the file; empty without names.
    names: Vec<String>,
    roles: Vec<Option<Role>>,
    /// What stands in brackets behind the names.
    units: Vec<Option<String>>,
    /// Line that names them, from 1.
    named: Option<usize>,
    /// Columns that are not read, in words.
    unread: Vec<String>,
}

impl Columns {
    fn by_place(columns: usize) -> Self {
        let [flags, mask] = [Validity::Flags, Validity::Mask].map(Role::Validity);
        let all = [Role::X, Role::Y, Role::U, Role::V, flags, mask];
        // One column beside the vectors may be anything.
        let known = if columns < all.len() { 4 } else { all.len() };
        Self {
            names: Vec::new(),
            roles: all[..known].iter().copied().map(Some).collect(),
            units: vec![None; known],
            named: None,
            unread: (known..columns).map(|column| format!("number {}", column + 1)).collect(),
        }
    }

    /// The columns that the lines above the numbers name; the last line that does so.
    fn named_above(text: &Text) -> Option<Self> {
        let named = |(line, names): (usize, Vec<String>)| {
            let roles: Vec<Option<Role>> = names.iter().map(|name| Role::of(name)).collect();
            let unit = |name: &String| {
                let (_, unit) = name.split_once(['[', '('])?;
                Some(unit.trim_end_matches([']', ')', ' ']).to_owned())
            };
            let mut below = text.units_below(line).into_iter();
            let units = names.iter().map(|name| unit(name).or(below.next().flatten())).collect();
            let once = |role: &Role| roles.iter().filter(|r| **r == Some(*role)).count() == 1;
            let is_unread = |(name, role): (&String, &Option<Role>)| role.is_none().then(|| name.clone());
            let unread = names.iter().zip(&roles).filter_map(is_unread).collect();
            let words: Vec<String> = names.iter().filter_map(|name| Role::word(name)).collect();
            let has = |word: &str| words.iter().any(|w| w == word);
            // `u_x` and `v_y` are derivatives; `u0`, `v0`, `u1`, `v1` the vectors of two frames.
            let is_pair = PAIRS.iter().any(|[u, v]| has(u) && has(v)) && !(has("u0") && has("v0"));
            let is_complete = Role::NEEDED.iter().all(once) && is_pair;
            is_complete.then_some(Self { names, roles, units, named: Some(line), unread })
        };
        text.headers().into_iter().find_map(named)
    }

    /// Warnings where x and y, or u and v, have different units.
    fn unequal_units(&self) -> Vec<String> {
        let unit = |role| self.of(role).and_then(|at| self.units[at].as_ref());
        let differ = |(a, b, names): (Role, Role, &str)| {
            let (a, b) = (unit(a)?, unit(b)?);
            (a != b).then(|| format!("{names} have different units ({a}, {b}), taken as they stand"))
        };
        [(Role::X, Role::Y, "x and y"), (Role::U, Role::V, "u and v")]
            .into_iter()
            .filter_map(differ)
            .collect()
    }

    fn of(&self, role: Role) -> Option<usize> {
        self.roles.iter().position(|r| *r == Some(role))
    }

    /// The columns that say which vectors are valid.
    fn validity(&self) -> impl Iterator<Item = (usize, Validity)> {
        self.roles.iter().enumerate().filter_map(|(at, role)| match role {
            Some(Role::Validity(validity)) => Some((at, *validity)),
            _ => None,
        })
    }

    /// What a column is called in messages.
    fn name(&self, at: usize) -> String {
        self.names.get(at).map_or_else(|| format!("number {}", at + 1), |name| name.trim().to_owned())
    }
}

/// A vector with its place.
struct Row {
    /// Its line, from 1.
    line: usize,
    position: [f64; 2],
    vector: [f64; 2],
    masked: bool,
}

/// Reads vectors on a lattice: two components, masked nodes with confidence 0.
///
/// # Errors
/// Names line and column of the first word that does not fit; positions off the lattice, and two vectors at one.
pub fn read(bytes: &[u8]) -> Result<Lattice, IoError> {
    let text = Text::of(bytes)?;
    text.check_zones()?;
    let mut columns = match (Columns::named_above(&text), text.names().next()) {
        (Some(columns), _) => columns,
        (None, Some((line, names))) => {
            times::chosen(line, &names, ArrayChoice::Usual)?;
            return Err(TableError::Header { line, found: shortened(names.join(", ").as_bytes()) }.into());
        }
        (None, None) => Columns::by_place(text.columns()),
    };
    if let Some(line) = columns.named.filter(|_| columns.names.len() < text.columns()) {
        let (names, columns) = (columns.names.len(), text.columns());
        return Err(TableError::Names { line, names, columns }.into());
    }
    let read = text.lines.iter().map(|&(number, line)| numbers(&text, &columns, line, number));
    let read = read.collect::<Result<Vec<Vec<f64>>, IoError>>()?;
    let values = |at: usize| read.iter().map(|row| row[at]).collect::<Vec<f64>>();
    let mut said = Vec::new();
    // More columns may be named than there are.
    let mut validity: Vec<(usize, Validity)> =
        columns.validity().filter(|(at, _)| *at < text.columns()).collect();
    // A sixth column without name that holds anything but 0 and 1 is no mask.
    let is_binary = |at: usize| values(at).iter().all(|v| [0.0, 1.0].contains(v));
    let are_masks = validity.iter().all(|&(at, v)| v != Validity::Mask || is_binary(at));
    if columns.named.is_some() || are_masks {
        said.extend(validity.iter().filter_map(|&(at, v)| v.said(&columns.name(at), &values(at), "vectors")));
    } else {
        // Then neither it nor the one before it is what OpenPIV writes there.
        let aside: Vec<usize> = validity.drain(..).map(|(at, _)| at).collect();
        aside.iter().for_each(|&at| columns.roles[at] = None);
        columns.unread.splice(..0, aside.iter().map(|at| format!("number {}", at + 1)));
    }
    let notes = vec![words_of(&columns)];
    let place = Role::NEEDED.map(|role| columns.of(role).unwrap_or_default());
    let row = |(&(line, _), row): (&(usize, &[u8]), &Vec<f64>)| {
        let [x, y, u, v] = place.map(|at| row[at]);
        let masked = validity.iter().any(|&(at, validity)| validity.leaves_out(row[at]));
        Row { line, position: [x, y], vector: [u, v], masked }
    };
    let rows: Vec<Row> = text.lines.iter().zip(&read).map(row).collect();
    if columns.named.is_none() && columns.roles.len() >= 5 && is_flat(&rows) {
        return Err(TableError::Header {
            line: text.first(),
            found: format!("{} columns, the third of one value", text.columns()),
        }
        .into());
    }
    if !columns.unread.is_empty() {
        said.push(format!(
            "columns not read, even if they mark invalid vectors: {}",
            columns.unread.join(", ")
        ));
    }
    let zeros = rows.iter().filter(|row| !row.masked && row.vector == [0.0; 2]).count();
    if zeros > 0 && zeros < rows.len() {
        said.push(format!("{zeros} vectors are exactly zero, as some programs write those that are missing; taken as they stand"));
    }
    let y_up = "y taken to run upwards and v with it (right-handed, as OpenPIV's transform_coordinates makes them); where a \
                file has y downwards the picture is upside down";
    let commas = text.decimal_commas();
    let mut lattice = lattice(&rows, notes)?;
    lattice.remarks.extend(said);
    lattice.remarks.extend(commas.map(|(words, _)| words.to_owned()));
    if commas.is_some_and(|(_, thousands)| thousands) {
        lattice
            .warnings
            .push("every comma is followed by three digits, as a thousands separator would be".to_owned());
    }
    lattice.warnings.extend(columns.unequal_units());
    lattice.remarks.push(y_up.to_owned());
    if columns.named.is_none() {
        lattice.warnings.push(words_of(&columns));
    }
    Ok(lattice)
}

/// Whether a line above the numbers names x, y, u and v.
pub(super) fn names_vectors(text: &Text) -> bool {
    Columns::named_above(text).is_some()
}

/// Whether what is taken for u has one value, as z of a plane would.
fn is_flat(rows: &[Row]) -> bool {
    rows.iter().all(|row| row.vector[0] == rows[0].vector[0])
}

/// The numbers of a line as far as they are needed.
fn numbers(text: &Text, columns: &Columns, line: &[u8], number: usize) -> Result<Vec<f64>, IoError> {
    let (expected, mut found) = (text.columns(), Vec::with_capacity(columns.roles.len()));
    let mut count = 0;
    for (column, word) in text.separator.words(line) {
        count += 1;
        let role = columns.roles.get(count - 1).copied().flatten();
        let is_validity = matches!(role, Some(Role::Validity(_)));
        let value = if is_validity { parsed_validity(word) } else { parsed(word) };
        let value = match (value, role) {
            (None, Some(_)) => {
                let (line, found) = (number, shortened(word));
                return Err(if is_validity {
                    TableError::NotValidity { line, column, found }.into()
                } else {
                    TextError::NotANumber { line, column, found }.into()
                });
            }
            (Some(v), Some(Role::X | Role::Y)) if !v.is_finite() => {
                return Err(TextError::NotFinite { line: number, column, found: shortened(word) }.into());
            }
            (value, _) => value.unwrap_or(f64::NAN),
        };
        if count <= columns.roles.len() {
            found.push(value);
        }
    }
    let needed = Role::NEEDED.iter().filter_map(|r| columns.of(*r)).max().map_or(4, |last| last + 1);
    if count != expected || count < needed {
        let expected = expected.max(needed);
        let column = line.trim_ascii_end().len() + 1;
        return Err(TableError::Row { line: number, column, found: count, expected }.into());
    }
    Ok(found)
}

fn words_of(columns: &Columns) -> String {
    let name = |role: &Option<Role>| match role {
        Some(Role::X) => "x",
        Some(Role::Y) => "y",
        Some(Role::U) => "u",
        Some(Role::V) => "v",
        Some(Role::Validity(validity)) => validity.words(),
        None => "(not read)",
    };
    let names: Vec<&str> = columns.roles.iter().map(name).collect();
    let how = columns.named.map_or_else(
        || "assumed by their places".to_owned(),
        |line| format!("by their names in line {line}"),
    );
    format!("one vector a line, columns {} {how}", names.join(", "))
}

/// The vectors on the lattice of their positions.
fn lattice(rows: &[Row], mut notes: Vec<String>) -> Result<Lattice, IoError> {
    let axes = [0, 1].map(|a| Steps::of(rows.iter().map(|row| row.position[a]).collect()));
    let [width, height] = axes.map(|a| a.count);
    let nodes = width.saturating_mul(height);
    let index = |axis: usize, i: usize| {
        let value = rows[i].position[axis];
        let (line, axis_name, step) = (rows[i].line, ['x', 'y'][axis], axes[axis].step);
        axes[axis].index(value).ok_or(TableError::Position { line, axis: axis_name, value, step })
    };
    let sparse = nodes > rows.len().saturating_mul(SPARSE);
    let mut line_of = vec![0; if sparse { 0 } else { nodes }];
    let mut values = vec![0.0; 2 * line_of.len()];
    let mut mask = vec![0.0; line_of.len()];
    for (i, row) in rows.iter().enumerate() {
        let (x, y) = (index(0, i)?, index(1, i)?);
        if sparse {
            continue;
        }
        let node = y * width + x;
        if line_of[node] > 0 {
            return Err(TableError::SamePosition { line: row.line, before: line_of[node] }.into());
        }
        line_of[node] = row.line;
        values[2 * node..2 * node + 2].copy_from_slice(&row.vector);
        mask[node] = if row.masked { 0.0 } else { 1.0 };
    }
    if sparse {
        return Err(TableError::SparsePositions { vectors: rows.len(), width, height }.into());
    }
    let missing = nodes - rows.len();
    if missing > 0 {
        notes.push(format!("{missing} of {nodes} nodes of the lattice have no line and are left out"));
    }
    let any = mask.contains(&0.0);
    Ok(Lattice {
        size: [width, height, 1],
        components: 2,
        values,
        scalar: ScalarType::Float64,
        axes: [[axes[0].step, 0.0, 0.0], [0.0, axes[1].step, 0.0], [0.0, 0.0, 1.0]],
        origin: [axes[0].first, axes[1].first, 0.0],
        unit: None,
        world: World::Viewer,
        measurement: None,
        mask: any.then_some(mask),
        order: None,
        frame: (Frame::World, Known::Convention),
        array: "table of vectors".to_owned(),
        component_names: Vec::new(),
        notes,
        remarks: Vec::new(),
        order_remarks: Vec::new(),
        warnings: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Kind, kind};
    use super::*;

    /// 4 x 3 positions at steps 2 and 0.5, u = x, v = 10 y.
    fn table(header: &str, line: impl Fn(f64, f64) -> String) -> Vec<u8> {
        let at = (0..12).map(|i| (f64::from(i % 4) * 2.0 + 1.0, 3.0 - f64::from(i / 4) * 0.5));
        at.fold(header.to_owned(), |text, (x, y)| text + &line(x, y) + "\n").into_bytes()
    }

    #[track_caller]
    fn is_read(bytes: &[u8], masked: usize) -> Lattice {
        assert_ne!(kind(bytes), Kind::Other, "{}", String::from_utf8_lossy(bytes));
        let lattice = read(bytes).unwrap();
        assert_eq!((lattice.size, lattice.origin), ([4, 3, 1], [1.0, 2.0, 0.0]));
        assert_eq!((lattice.axes[0][0], lattice.axes[1][1]), (2.0, 0.5));
        for (i, v) in lattice.values.as_chunks::<2>().0.iter().enumerate() {
            assert_eq!(*v, [1.0 + (i % 4) as f64 * 2.0, 20.0 + (i / 4) as f64 * 5.0], "{i}");
        }
        let zeros = lattice.mask.iter().flatten().filter(|m| **m == 0.0).count();
        assert_eq!(zeros, masked, "{:?}", lattice.notes);
        lattice
    }

    #[test]
    fn programs_are_understood() {
        let ten = |y: f64| 10.0 * y;
        let low = |y: f64| u8::from(y < 2.5);
        is_read(&table("", |x, y| format!("{x} {y} {x} {}", ten(y))), 0);
        is_read(&table("", |x, y| format!("{x:.4e}\t{y:.4e}\t{x:.4e}\t{:.4e}\t1\t{}", ten(y), low(y))), 4);
        is_read(&table("# x\ty\tu\tv\tflags\tmask\n", |x, y| format!("{x}\t{y}\t{x}\t{}\t0\t0", ten(y))), 0);
        let pivlab = "PIVlab, ASCII chart output - 20-Oct-2023\nFRAME: 1, filenames: A: a.png, B: b.png\n\
                      x [px],y [px],u [px/frame],v [px/frame],Vector type [-]\n";
        is_read(&table(pivlab, |x, y| format!("{x},{y},{x},{},{}", ten(y), 1 - low(y))), 4);
        let more = "x [px],y [px],u [px/frame],v [px/frame],vector direction [degrees],Vector length [px],Vector type [-]\n";
        let line = |x: f64, y: f64| format!("{x},{y},{x},{},0.5,0,{}", ten(y), 1 - low(y));
        is_read(&table(more, line), 4);
        for [yes, no] in [["True", "False"], ["\"true\"", "\"false\""], ["YES", "no"]] {
            let word = |y: f64| if low(y) == 1 { no } else { yes };
            is_read(&table("x,y,u,v,valid\n", |x, y| format!("{x},{y},{x},{},{}", ten(y), word(y))), 4);
        }
        is_read(&table("x,y,u,v,valid\n", |x, y| format!("{x},{y},{x},{},{}", ten(y), 1 - low(y))), 4);
        let insight =
            "TITLE=\"run\" VARIABLES=\"X mm\", \"Y mm\", \"U m/s\", \"V m/s\", \"CHC\", ZONE I=4, J=3\n";
        is_read(
            &table(insight, |x, y| {
                format!("{x}, {y}, {x}, {}, {}", ten(y), if low(y) == 1 { -2 } else { 4 })
            }),
            4,
        );
        let davis =
            "#DaVis 8.1.2 2D-vector 16 3 4 \"position\" \"mm\" \"position\" \"mm\" \"velocity\" \"m/s\"\n";
        is_read(&table(davis, |x, y| format!("{x}\t{y}\t{x}\t{}", ten(y))), 0);
        let jpiv = "TITLE=\"a\"\nVARIABLES= \"y\" \"x\" \"u\" \"v\" \"SN\"\nZONE I=4, J=3\n";
        is_read(&table(jpiv, |x, y| format!("{y} {x} {x} {} 7.5", ten(y))), 0);
        // Programs of countries with decimal commas.
        let comma = |text: String| text.replace('.', ",");
        for mark in [';', '\t'] {
            let line = |x: f64, y: f64| comma(format!("{x:.2}{mark}{y:.2}{mark}{x:.3}{mark}{:.1}", ten(y)));
            let lattice = is_read(&table("", line), 0);
            assert!(lattice.remarks.iter().any(|n| n.contains("decimal points")), "{:?}", lattice.remarks);
        }
        is_read(
            &table("x;y;Velocity u [m/s];Velocity v [m/s]\n", |x, y| format!("{x};{y};{x};{};", ten(y))),
            0,
        );
    }

    #[test]
    fn order_does_not_matter_and_missing_nodes_are_masked() {
        let bytes = table("x y u v\n", |x, y| format!("{x} {y} {x} {}", 10.0 * y));
        let text = String::from_utf8(bytes).unwrap();
        let mut lines: Vec<&str> = text.lines().collect();
        lines[1..].reverse();
        assert_eq!(read(lines.join("\n").as_bytes()), read(text.as_bytes()));
        lines.remove(6);
        let lattice = read(lines.join("\r\n").as_bytes()).unwrap();
        assert_eq!(lattice.mask.iter().flatten().filter(|m| **m == 0.0).count(), 1);
        assert!(lattice.notes.iter().any(|n| n.contains("1 of 12 nodes")), "{:?}", lattice.notes);
    }

    /// Rows of 2x2 blocks repeat positions or leave most nodes out.
    #[test]
    fn blocks_are_no_tables() {
        for text in [
            "1 0 1 0\n0 1 0 1\n1 0 1 0\n0 1 0 1\n",
            "0 1 2 0\n1 2 0 0\n2 0 1 1\n0 2 1 1\n1 1 0 0\n0 0 0 0\n",
            "0 0 1 1\n0 1 1 1\n1 0 1 1\n1 1 1 1\n",
            "1 2\n3 4\n",
            "1 2 3 x\n1 2 3 4\n",
            "",
        ] {
            assert_eq!(kind(text.as_bytes()), Kind::Other, "{text}");
        }
    }

    #[test]
    fn what_is_not_known_of_vectors_is_said() {
        let is_said = |header: &str, line: &dyn Fn(f64, f64) -> String, words: &str| {
            let remarks = read(&table(header, line)).unwrap().remarks;
            assert!(remarks.iter().any(|r| r.contains(words)), "{header}: {remarks:?}");
        };
        is_said(
            "x,y,u,v,status\n",
            &|x, y| format!("{x},{y},{x},1,0"),
            "columns not read, even if they mark invalid vectors: status",
        );
        is_said(
            "",
            &|x, y| format!("{x} {y} {x} 1 0"),
            "columns not read, even if they mark invalid vectors: number 5",
        );
        is_said(
            "x,y,u,v,mask\n",
            &|x, y| format!("{x},{y},{x},1,{}", u8::from(x > 4.0)),
            "6 of 12 vectors left out by the column `mask`, where it is not 0",
        );
        is_said("x,y,u,v,flags,mask\n", &|x, y| format!("{x},{y},{x},1,1,0"), "12 vectors with a flag");
        is_said("x,y,u,v\n", &|x, y| format!("{x},{y},{},0", x - 1.0), "3 vectors are exactly zero");
    }

    #[test]
    fn messages_name_line_and_column() {
        #[track_caller]
        fn refused(text: &str, message: &str) {
            assert_eq!(read(text.as_bytes()).map_err(|e| e.to_string()), Err(message.to_owned()), "{text:?}");
        }
        refused("", "line 1: expected rows of numbers, found none (an empty file, or words alone)");
        refused("x y u v\n", "line 1: expected rows of numbers, found none (an empty file, or words alone)");
        // Row numbers without a name, more numbers than names, derivatives, two frames.
        refused(
            "x\ty\tu\tv\n0\t1\t2\t3\t4\n",
            "line 1 names 4 columns, but the rows below have 5: expected a name for every column, also for row numbers",
        );
        refused(
            "# x y u v\n1 2 3 4 5 6\n",
            "line 1 names 4 columns, but the rows below have 6: expected a name for every column, also for row numbers",
        );
        for names in ["x,y,u_x,v_y", "x,y,u0,v0,u1,v1", "x,y,u_0,v_0,u_1,v_1"] {
            let row = vec!["1"; names.split(',').count()].join(",");
            let found = read(format!("{names}\n{row}\n").as_bytes());
            assert!(found.is_err(), "{names}");
        }
        refused("x,y,u,v\n1,2,3,4\n1, a,3,4\n", "line 3, column 4: expected a number, found `a`");
        refused("1 2 3 4\nnan 2 3 4\n", "line 2, column 1: expected a finite number, found `nan`");
        // Blank lines separate blocks of rows, as gnuplot has them.
        assert!(read(b"1 2 3 4\n2 2 3 4\n\n1 3 3 4\n2 3 3 4\n").is_ok());
        refused(
            "1 2 3 4\n2 2 3\n",
            "line 2, column 6: found 3 numbers, expected 4: x, y, u, v and as many as in the first row",
        );
        refused(
            "1 2 3\n",
            "line 1, column 6: found 3 numbers, expected 4: x, y, u, v and as many as in the first row",
        );
        refused(
            "1 2 3 4\n1 2 5 6\n",
            "line 2: a second row at the x and y of line 1: expected the vectors of one plane, one at each position",
        );
        refused(
            "0 0 3 4\n1 0 5 6\n2.5 0 1 1\n",
            "line 2: x = 1 is off the lattice: expected positions in equal steps (of 1.25 on average)",
        );
        refused(
            "0 0 0 0\n1 1 0 0\n2 2 0 0\n3 3 0 0\n",
            "4 vectors on a lattice of 4 x 4 positions: expected vectors at half of them or more",
        );
        // Decimal commas between tabs are not taken for two numbers.
        refused("1,5,0\t2\t3\t4\n", "line 1, column 1: expected a number, found `1,5,0`");
    }

    /// What is said of the columns is what was done with them.
    #[test]
    fn columns_that_are_no_mask_are_not_called_one() {
        let lattice = read(&table("", |x, y| format!("{x} {y} {x} {y} 0 {}", 3.0 + x))).unwrap();
        let said = [lattice.notes, lattice.remarks, lattice.warnings].concat().join("\n");
        assert!(!said.contains("left out") && said.contains("not read"), "{said}");
        assert!(said.contains("even if they mark invalid vectors: number 5, number 6"), "{said}");
    }

    /// A lattice column or row without any vector becomes missing nodes; all other nodes keep their positions.
    #[test]
    fn whole_rows_and_columns_may_be_missing() {
        let at = (0..30).map(|i| (i % 6, i / 6)).filter(|(x, y)| *x != 2 && *y != 3);
        let text = at.fold(String::new(), |text, (x, y)| text + &format!("{}.5 {y} {x} {y}\n", x));
        let lattice = read(text.as_bytes()).unwrap();
        assert_eq!((lattice.size, lattice.axes[0][0], lattice.axes[1][1]), ([6, 5, 1], 1.0, 1.0));
        let mask = lattice.mask.unwrap();
        for (i, (v, m)) in lattice.values.as_chunks::<2>().0.iter().zip(&mask).enumerate() {
            let (x, y) = (i % 6, i / 6);
            let expected = if x == 2 || y == 3 { ([0.0; 2], 0.0) } else { ([x as f64, y as f64], 1.0) };
            assert_eq!((*v, *m), expected, "{x} {y}");
        }
    }

    #[test]
    fn vectors_may_be_no_numbers_where_the_mask_says_so() {
        let lattice = read(b"x y u v mask\n0 0 nan nan 1\n1 0 1 2 0\n").unwrap();
        assert_eq!(lattice.mask, Some(vec![0.0, 1.0]));
        assert!(lattice.values[0].is_nan());
    }
}
