//! Tables in text, one point a line: vectors as PIV programs write them, and named columns of any program.
//!
//! ```text
//! x  y  u  v  [flags  mask]          x,y,S11,S22,S12
//! ```
//!
//! Columns are separated by blanks or tabs, by commas, or by semicolons; where semicolons or tabs separate them, a
//! comma is a decimal point. Lines that do not begin with a number come first, if at all; one of them may name the
//! columns (`VARIABLES=` of Tecplot files, also one a line; `%` of COMSOL; the first line of a `.csv`). y is taken to
//! run upwards. A Tecplot file has one ordered zone of points; of COMSOL's columns of several times
//! (`solid.sx @ t=0.5`) those of one are read, which the user chooses.
//!
//! [`read_vectors`]: columns x, y, u and v by their names (OpenPIV, PIVlab, JPIV, DaVis, Insight; vx and vy for u and
//! v), otherwise by their places. Positions form a lattice, in any order; nodes without vector are masked.
//!
//! Columns that say which points hold no measurement, beside vectors and tensors, as numbers, `true` and `false`, or
//! `yes` and `no`:
//!
//! | name | masked where | program |
//! | --- | --- | --- |
//! | `mask` (sixth without names) | not 0 | OpenPIV |
//! | `chc` | below 1 | Insight |
//! | `vector type` | 0 | PIVlab |
//! | `isvalid`, `valid`, `validity` | below 1 | DaVis and others |
//! | `vtkValidPointMask` | below 1 | ParaView |
//! | `vtkGhostType` | hidden points | ParaView |
//! | `flags` (fifth without names) | never: such vectors were mostly replaced; counted | OpenPIV |
//!
//! `status` is none of them: programs disagree about whether its 0 is good or bad. Like every column that is not read,
//! it is named.
//!
//! [`read_numbers`]: an image, one number a cell.
//!
//! [`read_columns`]: every column with a name is an array, those of `Stress:0`, `Stress:1`, ... (ParaView) are one;
//! tensors are found in them as in any file with several arrays.
//!
//! 2x2 blocks ([`crate::matrices`]) are rows of numbers, too. [`kind`] tells them apart.

mod columns;
mod error;
mod numbers;
mod steps;
mod text;
mod times;
mod validity;
mod vectors;

pub use columns::read as read_columns;
pub use error::TableError;
pub use numbers::read as read_numbers;
pub use vectors::read as read_vectors;

pub use text::utf8;

use steps::Steps;
use text::{Text, parsed};

/// Columns and rows of a lattice that is recognised without names, and those of one with missing nodes.
const RECOGNISED: usize = 3;
const RECOGNISED_WITH_GAPS: usize = 5;

/// What a text with numbers is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A table with names of its columns.
    Named,
    /// A table with positions in its first two columns.
    Positions,
    /// A table with positions in others, or with numbered lines.
    Numbered,
    /// None of these: possibly rows of 2x2 blocks.
    Other,
}

/// Whether a text is a table, one point a line, rather than 2x2 blocks: a line names the columns; or two neighbouring
/// columns are the positions of a complete lattice of 3 x 3 nodes or more (or of most of 5 x 5 or more); or a column
/// counts the lines.
///
/// Blocks are mistaken only where a pair of columns visits every node of such a lattice once, or a column grows by the
/// same step in every row.
#[must_use]
pub fn kind(bytes: &[u8]) -> Kind {
    let Ok(text) = Text::of(bytes) else { return Kind::Other };
    let columns = text.columns();
    if columns < 3 {
        return Kind::Other;
    }
    if text.names().next().is_some() || vectors::names_vectors(&text) || text.is_of_tecplot() {
        return Kind::Named;
    }
    let row = |(_, line): &(usize, &[u8])| {
        let words = text.separator.words(line).map(|(_, word)| parsed(word).filter(|v| v.is_finite()));
        words.collect::<Option<Vec<f64>>>().filter(|row| row.len() == columns)
    };
    // Text columns at the end and ragged rows: the first two columns say enough.
    let position = |(_, line): &(usize, &[u8])| {
        let mut words = text.separator.words(line).map(|(_, word)| parsed(word).filter(|v| v.is_finite()));
        Some([words.next()??, words.next()??])
    };
    let positions: Option<Vec<[f64; 2]>> = text.lines.iter().map(position).collect();
    if positions.is_some_and(|p| are_nodes(&p)) {
        return Kind::Positions;
    }
    if columns < 4 {
        return Kind::Other;
    }
    let Some(rows) = text.lines.iter().map(row).collect::<Option<Vec<_>>>() else { return Kind::Other };
    let pair = |at: usize| rows.iter().map(|row| [row[at], row[at + 1]]).collect::<Vec<_>>();
    let counts = |at: usize| {
        let step = rows.get(1).map_or(0.0, |second| second[at] - rows[0][at]);
        rows.len() >= COUNTED && step != 0.0 && rows.windows(2).all(|r| r[1][at] - r[0][at] == step)
    };
    if columns <= WIDEST && ((1..columns - 1).any(|at| are_nodes(&pair(at))) || (0..columns).any(counts)) {
        return Kind::Numbered;
    }
    Kind::Other
}

/// Lines that count up at least, and columns at most, of what is taken for a table.
const COUNTED: usize = 6;
const WIDEST: usize = 24;

/// Whether positions visit the nodes of a lattice once each.
fn are_nodes(positions: &[[f64; 2]]) -> bool {
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
