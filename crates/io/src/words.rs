//! Words of text with the byte each begins at.

use crate::ScalarType;
use crate::text::{TextError, shortened};

/// Words separated by ASCII blanks.
pub(crate) struct Words<'a> {
    text: &'a [u8],
    /// Next byte, relative to the text.
    at: usize,
}

impl<'a> Words<'a> {
    pub(crate) const fn new(text: &'a [u8]) -> Self {
        Self { text, at: 0 }
    }

    /// First byte that is not yet read.
    pub(crate) const fn at(&self) -> usize {
        self.at
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let blank = |b: &u8| b.is_ascii_whitespace();
        let rest = self.text.get(self.at..)?;
        let start = self.at + rest.iter().position(|b| !blank(b))?;
        let word = &self.text[start..];
        let length = word.iter().position(blank).unwrap_or(word.len());
        self.at = start + length;
        Some((start, &word[..length]))
    }
}

/// `count` numbers of text that begins at `start` of its file; memory grows with the words there.
pub(crate) fn numbers_in_text(
    text: &[u8],
    start: usize,
    scalar: ScalarType,
    count: u64,
) -> Result<Vec<f64>, TextError> {
    let mut words = Words::new(text);
    numbers(&mut words, start, scalar, count)
}

/// The next `count` words as numbers.
pub(crate) fn numbers(
    words: &mut Words,
    start: usize,
    scalar: ScalarType,
    count: u64,
) -> Result<Vec<f64>, TextError> {
    let mut values = Vec::new();
    for _ in 0..count {
        let (byte, word) = words.next().unwrap_or((words.text.len(), b""));
        let number = std::str::from_utf8(word).ok().and_then(|w| scalar.parse(w));
        let fault = || TextError::Word { byte: start + byte, found: shortened(word), scalar: scalar.name() };
        values.push(number.ok_or_else(fault)?);
    }
    Ok(values)
}
