//! Vectors at positions in text: what PIV programs write, one vector a line.
//!
//! ```text
//! x  y  u  v  [flags  mask]
//! ```
//!
//! Columns are separated by blanks or tabs, by commas, or by semicolons; where semicolons or tabs separate them, a comma is
//! a decimal point. Lines that do not begin with a number come first,
//! if at all; where one of them names columns x, y, u and v (OpenPIV, PIVlab, `VARIABLES=` of Tecplot files as JPIV, DaVis
//! and Insight write them), the names count, with vx and vy for u and v, otherwise the places. Positions form a
//! lattice, in any order; nodes without vector are masked. What may stand beside the vectors:
//!
//! | name | masked where | program |
//! | --- | --- | --- |
//! | `mask` (sixth without names) | not 0 | OpenPIV |
//! | `chc` | below 1 | Insight |
//! | `vector type` | 0 | PIVlab |
//! | `isvalid` | 0 | DaVis |
//! | `flags` (fifth without names) | never: such vectors were mostly replaced; counted | OpenPIV |
//!
//! y is taken to run upwards, and v with it, as OpenPIV's `transform_coordinates` makes them.
//!
//! Tensors in text ([`crate::matrices`]) are rows of numbers, too. [`is_table`] tells them apart.

use crate::error::shortened;
use crate::volume::{Frame, Known, Lattice, World};
use crate::{IoError, ScalarType};

/// Largest distance of a position from its lattice, relative to the step: text has few digits.
const TOLERANCE: f64 = 0.02;
/// Gaps between positions below this part of the largest are rounding.
const GAP: f64 = 0.25;
/// Nodes of the lattice for each vector at most: others lie on no lattice, or on too thin a part of one.
const SPARSE: usize = 2;
/// Columns and rows of a lattice that is recognised without names, and those of one with missing nodes.
const RECOGNISED: usize = 3;
const RECOGNISED_WITH_GAPS: usize = 5;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    X,
    Y,
    U,
    V,
    Flags,
    /// Masked where not 0.
    Mask,
    /// Masked below 1.
    Choice,
}

impl Role {
    const NEEDED: [Self; 4] = [Self::X, Self::Y, Self::U, Self::V];

    /// The role of a name such as `x`, `x [px]`, `"U m/s"` or `Velocity u [m/s]`.
    fn of(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let mut words = name.split([' ', '[', '(', '"']).filter(|w| !w.is_empty());
        let first = words.next()?;
        let word = if ["velocity", "displacement"].contains(&first) { words.next()? } else { first };
        let word = word.replace(['_', ':', '-', '.'], "");
        match word.as_str() {
            "x" | "xpos" | "points0" => Some(Self::X),
            "y" | "ypos" | "points1" => Some(Self::Y),
            "u" | "vx" | "ux" | "u0" | "velx" | "velocityx" | "velocity0" | "uvel" => Some(Self::U),
            "v" | "vy" | "uy" | "u1" | "vely" | "velocityy" | "velocity1" | "vvel" => Some(Self::V),
            "flags" | "flag" => Some(Self::Flags),
            "mask" => Some(Self::Mask),
            "chc" | "vector" | "isvalid" => Some(Self::Choice),
            _ => None,
        }
    }
}

/// Which column holds what.
struct Columns {
    roles: Vec<Option<Role>>,
    /// Line that names them, from 1.
    named: Option<usize>,
}

impl Columns {
    fn by_place(columns: usize) -> Self {
        let all = [Role::X, Role::Y, Role::U, Role::V, Role::Flags, Role::Mask];
        // One column beside the vectors may be anything.
        let known = if columns < all.len() { 4 } else { all.len() };
        Self { roles: all[..known].iter().copied().map(Some).collect(), named: None }
    }

    /// The columns that a line names.
    fn of_header(line: &str, number: usize) -> Option<Self> {
        let names = line.trim().trim_start_matches(['#', '%', '/']).trim();
        let lower = names.to_ascii_lowercase();
        let names = match lower.find("variables") {
            Some(at) => {
                // Insight has its whole header in one line.
                let behind =
                    ["zone", "datasetauxdata"].iter().filter_map(|w| Some(at + lower[at..].find(w)?));
                names[at..behind.min().unwrap_or(names.len())].split_once('=')?.1
            }
            None => names,
        };
        let words: Vec<&str> = if names.contains('"') {
            names.split('"').skip(1).step_by(2).collect()
        } else if let Some(separator) = ['\t', ',', ';'].into_iter().find(|s| names.contains(*s)) {
            names.split(separator).collect()
        } else {
            // Units stand apart.
            names.split_whitespace().filter(|w| !w.starts_with(['[', '('])).collect()
        };
        let roles: Vec<Option<Role>> = words.into_iter().map(Role::of).collect();
        let once = |role: &Role| roles.iter().filter(|r| **r == Some(*role)).count() == 1;
        Role::NEEDED.iter().all(once).then_some(Self { roles, named: Some(number) })
    }

    fn of(&self, role: Role) -> Option<usize> {
        self.roles.iter().position(|r| *r == Some(role))
    }
}

/// What separates the numbers of a line.
#[derive(Clone, Copy)]
enum Separator {
    Blank,
    Mark(u8),
}

impl Separator {
    fn of(line: &[u8]) -> Self {
        let mark = [b';', b'\t', b','].into_iter().find(|mark| line.contains(mark));
        mark.filter(|mark| *mark != b'\t').map_or(Self::Blank, Self::Mark)
    }

    /// The words of a line with their columns, from 1.
    fn words(self, line: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
        let is_mark = move |b: &u8| match self {
            Self::Blank => b.is_ascii_whitespace(),
            Self::Mark(mark) => *b == mark,
        };
        let blank = matches!(self, Self::Blank);
        let line = line.trim_ascii_end();
        // A mark behind the last number separates nothing.
        let line = if blank { line } else { line.strip_suffix(&[self.mark()]).unwrap_or(line) };
        line.split(is_mark)
            .scan(1, |column, word| {
                let at = *column;
                *column += word.len() + 1;
                Some((at + word.len() - word.trim_ascii_start().len(), word.trim_ascii()))
            })
            .filter(move |(_, word)| !(blank && word.is_empty()))
    }

    const fn mark(self) -> u8 {
        match self {
            Self::Blank => b' ',
            Self::Mark(mark) => mark,
        }
    }
}

/// The lines of a text, the first of its numbers, and what names the columns.
struct Text<'a> {
    /// Lines from the first that begins with a number, blank ones at the end left out.
    lines: Vec<&'a [u8]>,
    /// Number of the first, from 1.
    first: usize,
    header: Option<Columns>,
    /// The line above the numbers, where it has a word for every column but was not understood, and its number.
    unknown: Option<(usize, String)>,
    separator: Separator,
}

impl<'a> Text<'a> {
    fn of(bytes: &'a [u8]) -> Result<Self, IoError> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_end();
        let mut header = None;
        let mut above: Option<(usize, &[u8])> = None;
        let mut lines = bytes.split(|&b| b == b'\n');
        for (i, line) in lines.by_ref().enumerate() {
            let separator = Separator::of(line);
            let begins = separator.words(line).next().and_then(|(_, word)| parsed(word));
            if begins.is_some() {
                let columns = separator.words(line).count();
                let names_all = |line: &[u8]| {
                    let text = String::from_utf8_lossy(line);
                    let names = text.trim().trim_start_matches(['#', '%', '/']).trim().to_owned();
                    (separator.words(names.as_bytes()).count() == columns).then_some(names)
                };
                let unknown = above.filter(|_| header.is_none()).and_then(|(i, l)| Some((i, names_all(l)?)));
                let lines = std::iter::once(line).chain(lines).collect();
                return Ok(Self { lines, first: i + 1, header, unknown, separator });
            }
            above = Some((i + 1, line));
            let named = Columns::of_header(&String::from_utf8_lossy(line), i + 1);
            header = named.or(header);
        }
        Err(IoError::EmptyText)
    }

    /// Whether numbers are written with commas.
    fn has_decimal_commas(&self) -> bool {
        let separates = matches!(self.separator, Separator::Mark(b','));
        !separates && self.lines.iter().any(|line| line.contains(&b','))
    }

    /// Numbers in the first line.
    fn columns(&self) -> usize {
        self.separator.words(self.lines[0]).count()
    }
}

/// A number. Its decimal point may be a comma, which then separates nothing ([`Separator::of`]).
fn parsed(word: &[u8]) -> Option<f64> {
    let word = std::str::from_utf8(word).ok()?;
    word.parse()
        .or_else(|e| if word.matches(',').count() == 1 { word.replace(',', ".").parse() } else { Err(e) })
        .ok()
}

/// Whether a text is a table of vectors rather than 2x2 blocks: a line names x, y, u and v; or numbers stand in four
/// columns or more, of which the first two are different positions of a complete lattice of 3 x 3 nodes or more (or of most
/// of 5 x 5 or more).
///
/// Blocks are mistaken only where every first pair of a row is another node of such a lattice.
#[must_use]
pub fn is_table(bytes: &[u8]) -> bool {
    let Ok(text) = Text::of(bytes) else { return false };
    if text.header.is_some() {
        return true;
    }
    if text.columns() < 4 {
        return false;
    }
    let position = |line: &&[u8]| {
        let mut words = text.separator.words(line).map(|(_, word)| parsed(word).filter(|v| v.is_finite()));
        Some([words.next()??, words.next()??])
    };
    let Some(positions) = text.lines.iter().map(position).collect::<Option<Vec<_>>>() else { return false };
    let axes = [0, 1].map(|a| Steps::of(positions.iter().map(|p| p[a]).collect()));
    let least = axes[0].count.min(axes[1].count);
    let Some(nodes) = axes[0].count.checked_mul(axes[1].count) else { return false };
    let enough = if nodes == positions.len() {
        least >= RECOGNISED
    } else {
        least >= RECOGNISED_WITH_GAPS && nodes <= positions.len() / 3 * 4
    };
    let mut seen = vec![false; if enough { nodes } else { 0 }];
    enough
        && positions.iter().all(|p| match (axes[0].index(p[0]), axes[1].index(p[1])) {
            (Some(x), Some(y)) => !std::mem::replace(&mut seen[y * axes[0].count + x], true),
            _ => false,
        })
}

/// Equal steps along an axis.
#[derive(Clone, Copy, Debug)]
struct Steps {
    first: f64,
    step: f64,
    count: usize,
}

impl Steps {
    /// The steps between finite positions in any order, if they are equal; otherwise [`Self::index`] refuses some.
    fn of(mut positions: Vec<f64>) -> Self {
        positions.sort_by(f64::total_cmp);
        let (first, last) = (positions[0], positions[positions.len() - 1]);
        let largest = positions.windows(2).map(|p| p[1] - p[0]).fold(0.0, f64::max);
        let gaps = positions.windows(2).filter(|p| largest > 0.0 && p[1] - p[0] > GAP * largest).count();
        let step = if gaps == 0 { 1.0 } else { last / gaps as f64 - first / gaps as f64 };
        Self { first, step, count: gaps + 1 }
    }

    fn index(&self, position: f64) -> Option<usize> {
        let place = (position - self.first) / self.step;
        let near = (place - place.round()).abs() <= TOLERANCE;
        (near && place.round() < self.count as f64).then(|| place.round() as usize)
    }
}

/// A vector with its place.
struct Row {
    position: [f64; 2],
    vector: [f64; 2],
    masked: bool,
}

/// Reads vectors on a lattice: two components, masked nodes with confidence 0.
///
/// # Errors
/// Names line and column of the first word that does not fit; positions off the lattice, and two vectors at one.
pub fn read(bytes: &[u8]) -> Result<Lattice, IoError> {
    let mut text = Text::of(bytes)?;
    if let Some((line, names)) = &text.unknown {
        return Err(IoError::TableHeader { line: *line, found: shortened(names.as_bytes()) });
    }
    let columns = text.header.take().unwrap_or_else(|| Columns::by_place(text.columns()));
    let mut rows = Vec::new();
    let (mut flagged, mut others) = (0, 0);
    for (i, line) in text.lines.iter().enumerate() {
        let numbers = numbers(&text, &columns, line, i)?;
        let of = |role| columns.of(role).and_then(|at| numbers.get(at)).copied();
        let need = |role| of(role).unwrap_or(f64::NAN);
        // A sixth column without name that holds anything but 0 and 1 is no mask.
        let mask = of(Role::Mask).unwrap_or(0.0);
        others += usize::from(mask != 0.0 && mask != 1.0);
        flagged += usize::from(of(Role::Flags).is_some_and(|f| f != 0.0));
        rows.push(Row {
            position: [need(Role::X), need(Role::Y)],
            vector: [need(Role::U), need(Role::V)],
            masked: mask != 0.0 || of(Role::Choice).is_some_and(|c| c < 1.0),
        });
    }
    let mut notes = vec![words_of(&columns)];
    if columns.named.is_none() && columns.roles.len() == 6 && is_flat(&rows) {
        return Err(IoError::TableHeader {
            line: text.first,
            found: "six columns, the third of one value".to_owned(),
        });
    }
    if columns.named.is_none() && others > 0 {
        rows.iter_mut().for_each(|row| row.masked = false);
        notes.push("the sixth column holds more than 0 and 1 and is left aside".to_owned());
    } else if flagged > 0 {
        notes.push(format!("{flagged} vectors with a flag, taken as they stand"));
    }
    let y_up = "y taken to run upwards and v with it (right-handed, as OpenPIV's transform_coordinates makes them); where a \
                file has y downwards the picture is upside down";
    notes.push(y_up.to_owned());
    if text.has_decimal_commas() {
        notes.push("commas taken as decimal points".to_owned());
    }
    let mut lattice = lattice(&rows, text.first, notes)?;
    if columns.named.is_none() {
        lattice.warnings.push(words_of(&columns));
    }
    Ok(lattice)
}

/// Whether what is taken for u has one value, as z of a plane would.
fn is_flat(rows: &[Row]) -> bool {
    rows.iter().all(|row| row.vector[0] == rows[0].vector[0])
}

/// The numbers of a line as far as they are needed.
fn numbers(text: &Text, columns: &Columns, line: &[u8], index: usize) -> Result<Vec<f64>, IoError> {
    let number = text.first + index;
    let (expected, mut found) = (text.columns(), Vec::with_capacity(columns.roles.len()));
    if line.trim_ascii().is_empty() {
        return Err(IoError::BlankLine { line: number });
    }
    let mut count = 0;
    for (column, word) in text.separator.words(line) {
        count += 1;
        let role = columns.roles.get(count - 1).copied().flatten();
        let value = match (parsed(word), role) {
            (None, Some(_)) => {
                return Err(IoError::NotANumber { line: number, column, found: shortened(word) });
            }
            (Some(v), Some(Role::X | Role::Y)) if !v.is_finite() => {
                return Err(IoError::NotFinite { line: number, column, found: shortened(word) });
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
        return Err(IoError::TableRow { line: number, column, found: count, expected });
    }
    Ok(found)
}

fn words_of(columns: &Columns) -> String {
    let name = |role: &Option<Role>| match role {
        Some(Role::X) => "x",
        Some(Role::Y) => "y",
        Some(Role::U) => "u",
        Some(Role::V) => "v",
        Some(Role::Flags) => "flags",
        Some(Role::Mask) => "mask (left out where not 0)",
        Some(Role::Choice) => "validity (left out below 1)",
        None => "(not read)",
    };
    let names: Vec<&str> = columns.roles.iter().map(name).collect();
    let how = columns.named.map_or_else(
        || "assumed by their places".to_owned(),
        |line| format!("by their names in line {line}"),
    );
    format!("one vector a line, columns {} {how}", names.join(", "))
}

/// The vectors on the lattice of their positions; `first` is the line of the first row.
fn lattice(rows: &[Row], first: usize, mut notes: Vec<String>) -> Result<Lattice, IoError> {
    let axes = [0, 1].map(|a| Steps::of(rows.iter().map(|row| row.position[a]).collect()));
    let [width, height] = axes.map(|a| a.count);
    let nodes = width.saturating_mul(height);
    let index = |axis: usize, i: usize| {
        let value = rows[i].position[axis];
        let (line, axis_name, step) = (first + i, ['x', 'y'][axis], axes[axis].step);
        axes[axis].index(value).ok_or(IoError::Position { line, axis: axis_name, value, step })
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
            return Err(IoError::SamePosition { line: first + i, before: line_of[node] });
        }
        line_of[node] = first + i;
        values[2 * node..2 * node + 2].copy_from_slice(&row.vector);
        mask[node] = if row.masked { 0.0 } else { 1.0 };
    }
    if sparse {
        return Err(IoError::SparsePositions { vectors: rows.len(), width, height });
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
        world: World::Viewer,
        measurement: None,
        mask: any.then_some(mask),
        order: None,
        frame: (Frame::World, Known::Convention),
        array: "table of vectors".to_owned(),
        component_names: Vec::new(),
        notes,
        warnings: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 4 x 3 positions at steps 2 and 0.5, u = x, v = 10 y.
    fn table(header: &str, line: impl Fn(f64, f64) -> String) -> Vec<u8> {
        let at = (0..12).map(|i| (f64::from(i % 4) * 2.0 + 1.0, 3.0 - f64::from(i / 4) * 0.5));
        at.fold(header.to_owned(), |text, (x, y)| text + &line(x, y) + "\n").into_bytes()
    }

    #[track_caller]
    fn is_read(bytes: &[u8], masked: usize) -> Lattice {
        assert!(is_table(bytes), "{}", String::from_utf8_lossy(bytes));
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
            assert!(lattice.notes.iter().any(|n| n.contains("decimal points")), "{:?}", lattice.notes);
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
            assert!(!is_table(text.as_bytes()), "{text}");
        }
    }

    #[test]
    fn messages_name_line_and_column() {
        #[track_caller]
        fn refused(text: &str, message: &str) {
            assert_eq!(read(text.as_bytes()).map_err(|e| e.to_string()), Err(message.to_owned()), "{text:?}");
        }
        refused("", "line 1: expected rows of numbers, found none (an empty file, or words alone)");
        refused("x y u v\n", "line 1: expected rows of numbers, found none (an empty file, or words alone)");
        refused("x,y,u,v\n1,2,3,4\n1, a,3,4\n", "line 3, column 4: expected a number, found `a`");
        refused("1 2 3 4\nnan 2 3 4\n", "line 2, column 1: expected a finite number, found `nan`");
        refused(
            "1 2 3 4\n\n2 2 3 4\n",
            "line 2: expected numbers, found a blank line (they are allowed at the end only)",
        );
        refused(
            "1 2 3 4\n2 2 3\n",
            "line 2, column 6: found 3 numbers, expected 4: x, y, u, v and as many as in the first row",
        );
        refused(
            "1 2 3\n",
            "line 1, column 6: found 3 numbers, expected 4: x, y, u, v and as many as in the first row",
        );
        refused("1 2 3 4\n1 2 5 6\n", "line 2: a second vector at the position of line 1");
        refused(
            "0 0 3 4\n1 0 5 6\n2.5 0 1 1\n",
            "line 2: x = 1 is off the lattice: expected positions in equal steps, here of 1.25",
        );
        refused(
            "0 0 0 0\n1 1 0 0\n2 2 0 0\n3 3 0 0\n",
            "4 vectors on a lattice of 4 x 4 positions: expected a vector at most of them",
        );
        // Decimal commas between tabs are not taken for two numbers.
        refused(
            "1,5,0\t2\t3\t4\n",
            "line 1: expected rows of numbers, found none (an empty file, or words alone)",
        );
    }

    #[test]
    fn vectors_may_be_no_numbers_where_the_mask_says_so() {
        let lattice = read(b"x y u v mask\n0 0 nan nan 1\n1 0 1 2 0\n").unwrap();
        assert_eq!(lattice.mask, Some(vec![0.0, 1.0]));
        assert!(lattice.values[0].is_nan());
    }
}
