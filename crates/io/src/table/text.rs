//! Lines of numbers, and the lines above them.

use crate::IoError;

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

/// A text of numbers, one tuple a line, and what stands above them.
pub(super) struct Text<'a> {
    /// Lines from the first that begins with a number, blank ones at the end left out.
    pub(super) lines: Vec<&'a [u8]>,
    /// Number of the first, from 1.
    pub(super) first: usize,
    /// The lines above, the first of them line 1.
    pub(super) above: Vec<String>,
    /// What separates the numbers.
    pub(super) separator: Separator,
}

impl<'a> Text<'a> {
    /// # Errors
    /// [`IoError::EmptyText`] where no line begins with a number.
    pub(super) fn of(bytes: &'a [u8]) -> Result<Self, IoError> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_end();
        let mut above = Vec::new();
        let mut lines = bytes.split(|&b| b == b'\n');
        while let Some(line) = lines.next() {
            let separator = Separator::of(line);
            if separator.words(line).next().and_then(|(_, word)| parsed(word)).is_some() {
                let first = above.len() + 1;
                let lines = std::iter::once(line).chain(lines).collect();
                return Ok(Self { lines, first, above, separator });
            }
            above.push(String::from_utf8_lossy(line).into_owned());
        }
        Err(IoError::EmptyText)
    }

    /// Whether numbers are written with commas.
    pub(super) fn has_decimal_commas(&self) -> bool {
        let separates = matches!(self.separator, Separator::Mark(b','));
        !separates && self.lines.iter().any(|line| line.contains(&b','))
    }

    /// Numbers in the first line.
    pub(super) fn columns(&self) -> usize {
        self.separator.words(self.lines[0]).count()
    }

    /// Names of the columns: the last line above the numbers with as many as there are columns, and its number.
    pub(super) fn names(&self) -> Option<(usize, Vec<String>)> {
        let columns = self.columns();
        let named = |(i, line): (usize, &String)| {
            let names = names_of(line);
            (names.len() == columns).then_some((i + 1, names))
        };
        self.above.iter().enumerate().rev().find_map(named)
    }
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
    } else if let Some(separator) = ['\t', ',', ';'].into_iter().find(|s| names.contains(*s)) {
        owned(names.strip_suffix(separator).unwrap_or(names).split(separator).collect())
    } else {
        owned(names.split_whitespace().filter(|w| !w.starts_with(['[', '('])).collect())
    }
}

/// A number. Its decimal point may be a comma, which then separates nothing ([`Separator::of`]).
pub(super) fn parsed(word: &[u8]) -> Option<f64> {
    let word = std::str::from_utf8(word).ok()?;
    let with_comma = || word.replace(',', ".").parse();
    word.parse().or_else(|e| if word.matches(',').count() == 1 { with_comma() } else { Err(e) }).ok()
}
