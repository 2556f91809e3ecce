//! Lines of numbers, and the lines above them.

use super::error::TableError;
use super::times::MARK;
use crate::IoError;
use crate::text::TextError;
use std::borrow::Cow;

/// What separates the numbers of a line.
#[derive(Clone, Copy)]
pub(super) enum Separator {
    Blank,
    Mark(u8),
}

impl Separator {
    pub(super) fn of(line: &[u8]) -> Self {
        let mark = [b';', b'\t', b','].into_iter().find(|mark| line.contains(mark));
        mark.filter(|mark| *mark != b'\t').map_or(Self::Blank, Self::Mark)
    }

    /// The words of a line with their columns, from 1.
    pub(super) fn words(self, line: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
        let is_mark = move |b: &u8| match self {
            Self::Blank => b.is_ascii_whitespace(),
            Self::Mark(mark) => *b == mark,
        };
        let blank = matches!(self, Self::Blank);
        // A quote at the beginning of a word holds together what stands up to the next.
        let (mut is_quoted, mut begins) = (false, true);
        let is_outer_mark = move |b: &u8| {
            if is_quoted {
                is_quoted = *b != b'"';
                return false;
            }
            is_quoted = begins && *b == b'"';
            let is_mark = is_mark(b);
            begins = is_mark || begins && b.is_ascii_whitespace();
            is_mark
        };
        let line = line.trim_ascii_end();
        // A mark behind the last number separates nothing.
        let line = if blank { line } else { line.strip_suffix(&[self.mark()]).unwrap_or(line) };
        line.split(is_outer_mark)
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

/// A text in UTF-8: one in UTF-16 with its mark at the beginning, as spreadsheets write it, is converted.
#[must_use]
pub fn utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    let unit = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return Cow::Borrowed(bytes),
    };
    let units = bytes[2..].as_chunks::<2>().0.iter().map(|pair| unit(*pair));
    let text: String = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    Cow::Owned(text.into_bytes())
}

/// A text of numbers, one tuple a line, and what stands above them.
pub(super) struct Text<'a> {
    /// Lines from the first of numbers with their own numbers, from 1; blank ones and comments left out.
    pub(super) lines: Vec<(usize, &'a [u8])>,
    /// The lines above, the first of them line 1.
    pub(super) above: Vec<String>,
    /// What separates the numbers.
    pub(super) separator: Separator,
}

/// Numbers in a line that begins with a word, at least.
const LABELLED: usize = 3;

impl<'a> Text<'a> {
    /// # Errors
    /// [`TextError::Empty`] where no line holds numbers.
    pub(super) fn of(bytes: &'a [u8]) -> Result<Self, IoError> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_end();
        let mut above = Vec::new();
        let mut lines = bytes.split(|&b| b == b'\n').enumerate();
        while let Some((i, line)) = lines.next() {
            let separator = Separator::of(line);
            if holds_numbers(separator, line) {
                let is_text = |line: &[u8]| line.trim_ascii().is_empty() || is_comment(line);
                let rest = lines.map(|(i, line)| (i + 1, line)).filter(|(_, line)| !is_text(line));
                return Ok(Self {
                    lines: std::iter::once((i + 1, line)).chain(rest).collect(),
                    above,
                    separator,
                });
            }
            above.push(String::from_utf8_lossy(line).into_owned());
        }
        Err(TextError::Empty.into())
    }

    /// Number of the first line of numbers, from 1.
    pub(super) fn first(&self) -> usize {
        self.lines[0].0
    }

    /// The message about commas in numbers, and whether they look like thousands separators.
    pub(super) fn decimal_commas(&self) -> Option<(&'static str, bool)> {
        let words = || self.lines.iter().flat_map(|(_, line)| self.separator.words(line)).map(|(_, w)| w);
        let with_comma = || words().filter(|w| parsed(w).is_some() && w.contains(&b','));
        with_comma().next()?;
        let after = |w: &[u8]| w.split(|b| *b == b',').nth(1).map_or(0, <[u8]>::len);
        Some(("commas taken as decimal points", with_comma().all(|w| after(w) == 3)))
    }

    /// Numbers in the first line.
    pub(super) fn columns(&self) -> usize {
        self.separator.words(self.lines[0].1).count()
    }

    /// Names of the columns: lines above the numbers with as many as there are columns, with their numbers, the nearest
    /// first.
    pub(super) fn names(&self) -> impl Iterator<Item = (usize, Vec<String>)> {
        let columns = self.columns();
        self.headers().into_iter().filter(move |(_, names)| names.len() == columns)
    }

    /// The names in every line above the numbers, with the numbers of these lines, the nearest first. Variables of
    /// Tecplot files may stand one a line.
    pub(super) fn headers(&self) -> Vec<(usize, Vec<String>)> {
        let mut all: Vec<(usize, Vec<String>)> = Vec::new();
        let mut is_list = false;
        for (i, line) in self.above.iter().enumerate() {
            let names = names_of(line);
            match all.last_mut() {
                Some((_, variables)) if is_list && is_quoted(line) => variables.extend(names),
                _ => {
                    is_list = line.to_ascii_lowercase().contains("variables");
                    all.push((i + 1, names));
                }
            }
        }
        all.reverse();
        all
    }

    /// The units of the columns in a line of their own beneath that of the names, `mm,mm,MPa` or `[mm] [mm] [MPa]`;
    /// nothing where the next line is another one.
    pub(super) fn units_below(&self, names: usize) -> Vec<Option<String>> {
        // What follows the variables of Tecplot files begins a zone.
        let line = self.above.get(names).filter(|_| !self.is_of_tecplot()).map_or("", String::as_str);
        let line = line.trim().trim_start_matches(['#', '%', '/', '!']).trim();
        let words: Vec<&str> = match ['\t', ',', ';'].into_iter().find(|s| line.contains(*s)) {
            Some(separator) => line.strip_suffix(separator).unwrap_or(line).split(separator).collect(),
            None => line.split_whitespace().collect(),
        };
        if words.len() != self.columns() {
            return Vec::new();
        }
        let unit =
            |word: &str| word.trim_matches(|c: char| c.is_whitespace() || "[]()\"".contains(c)).to_owned();
        words
            .into_iter()
            .map(|word| Some(unit(word)).filter(|unit| !matches!(unit.as_str(), "" | "-")))
            .collect()
    }

    /// Whether a line above the numbers begins a zone, as Tecplot has it.
    pub(super) fn is_of_tecplot(&self) -> bool {
        self.above.iter().any(|line| words_outside_quotes(line).any(|word| word == "ZONE"))
    }

    /// Refuses zones of Tecplot files that are no table, one point a line.
    ///
    /// # Errors
    /// [`TableError::Zone`].
    pub(super) fn check_zones(&self) -> Result<(), IoError> {
        if !self.is_of_tecplot() {
            return Ok(());
        }
        let fault = |line, found, expected| Err(TableError::Zone { line, found, expected }.into());
        for (i, line) in self.above.iter().enumerate() {
            if words_outside_quotes(line).any(|word| matches!(word.as_str(), "BLOCK" | "FEBLOCK")) {
                let expected = "DATAPACKING=POINT, one point a line, as Tecplot writes it on demand";
                return fault(i + 1, "the zone has one variable after the other (BLOCK)", expected);
            }
            if words_outside_quotes(line).any(|word| ELEMENTS.contains(&word.as_str())) {
                let expected =
                    "an ordered zone of points on a lattice, to which Tecplot or ParaView interpolates";
                return fault(i + 1, "the zone is one of finite elements", expected);
            }
        }
        let begins_zone = |line: &[u8]| {
            let words = line.trim_ascii_start().split(|b| !b.is_ascii_alphanumeric());
            words.take(1).any(|word| word.eq_ignore_ascii_case(b"zone"))
        };
        match self.lines.iter().find(|(_, line)| begins_zone(line)) {
            Some(&(line, _)) => {
                fault(line, "a second zone begins", "one zone, such as that of one time, in a file")
            }
            None => Ok(()),
        }
    }
}

/// What Tecplot calls zones of finite elements.
const ELEMENTS: [&str; 8] = [
    "FEPOINT",
    "FELINESEG",
    "FETRIANGLE",
    "FEQUADRILATERAL",
    "FETETRAHEDRON",
    "FEBRICK",
    "FEPOLYGON",
    "FEPOLYHEDRON",
];

/// The words of a line outside its quotes, in capitals.
fn words_outside_quotes(line: &str) -> impl Iterator<Item = String> {
    let outside = line.split('"').step_by(2).flat_map(|part| part.split(|c: char| !c.is_alphanumeric()));
    outside.filter(|word| !word.is_empty()).map(str::to_ascii_uppercase)
}

/// Whether a line holds quoted names alone.
fn is_quoted(line: &str) -> bool {
    let outside: String = line.split('"').step_by(2).collect();
    line.contains('"') && outside.chars().all(|c| c.is_whitespace() || c == ',')
}

fn is_comment(line: &[u8]) -> bool {
    line.trim_ascii_start().first().is_some_and(|b| matches!(b, b'#' | b'%' | b'!'))
}

/// Whether a line is one of numbers: it begins with one, or with a label before three and more.
fn holds_numbers(separator: Separator, line: &[u8]) -> bool {
    if is_comment(line) {
        return false;
    }
    let numbers: Vec<bool> = separator.words(line).map(|(_, word)| parsed(word).is_some()).collect();
    let count = numbers.iter().filter(|is_number| **is_number).count();
    numbers.first() == Some(&true) || (count >= LABELLED && 2 * count >= numbers.len())
}

/// The names in a line: in quotes, between separators, or between blanks with units apart, `x [px] y [px]`.
pub(super) fn names_of(line: &str) -> Vec<String> {
    let names = line.trim().trim_start_matches(['#', '%', '/', '!']).trim();
    let lower = names.to_ascii_lowercase();
    let names = match lower.find("variables") {
        Some(at) => {
            // Insight has its whole header in one line.
            let behind = ["zone", "datasetauxdata"].iter().filter_map(|w| Some(at + lower[at..].find(w)?));
            let end = behind.min().unwrap_or(names.len());
            names.get(at..end).and_then(|n| n.split_once('=')).map_or(names, |(_, n)| n)
        }
        None => names,
    };
    let owned = |words: Vec<&str>| words.into_iter().map(|w| w.trim().to_owned()).collect();
    if names.contains('"') {
        owned(names.split('"').skip(1).step_by(2).collect())
    } else if names.contains(MARK) {
        // Parameters of one column, `@ t=0, Q=3`, have a blank behind their comma.
        const WITHIN: &str = "\u{1}";
        let marked = names.replace(", ", WITHIN);
        if marked.contains(',') {
            marked.split(',').map(|word| word.replace(WITHIN, ", ").trim().to_owned()).collect()
        } else {
            names_between_blanks(names)
        }
    } else if let Some(separator) = ['\t', ',', ';'].into_iter().find(|s| names.contains(*s)) {
        owned(names.strip_suffix(separator).unwrap_or(names).split(separator).collect())
    } else {
        names_between_blanks(names)
    }
}

/// Names between blanks with the units behind them, `x [px] y [px]`; COMSOL's keep what follows their mark of a time,
/// `@ t=0, Q=3`.
fn names_between_blanks(text: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut words = text.split_whitespace();
    while let Some(word) = words.next() {
        match names.last_mut() {
            Some(name) if word == MARK.trim() => {
                name.push_str(MARK.trim_end());
                for word in words.by_ref() {
                    name.push(' ');
                    name.push_str(word);
                    if !word.ends_with([',', ':']) {
                        break;
                    }
                }
            }
            Some(name) if word.starts_with(['[', '(']) => {
                name.push(' ');
                name.push_str(word);
                let mut last = word;
                while !last.ends_with([']', ')']) {
                    let Some(next) = words.next() else { break };
                    name.push(' ');
                    name.push_str(next);
                    last = next;
                }
            }
            // Units without a name are a line of their own.
            None if word.starts_with(['[', '(']) => {}
            _ => names.push(word.to_owned()),
        }
    }
    names
}

/// A number, possibly in quotes, or with Fortran's `D` before its exponent. Its decimal point may be a comma, which
/// then separates nothing ([`Separator::of`]).
pub(super) fn parsed(word: &[u8]) -> Option<f64> {
    let word = std::str::from_utf8(word).ok()?.trim_matches('"');
    let number =
        word.strip_prefix(['-', '+']).unwrap_or(word).starts_with(|c: char| c.is_ascii_digit() || c == '.');
    if number && word.contains(['d', 'D']) {
        return word.replace(['d', 'D'], "e").parse().ok();
    }
    let with_comma = || word.replace(',', ".").parse();
    word.parse().or_else(|e| if word.matches(',').count() == 1 { with_comma() } else { Err(e) }).ok()
}
