//! Values that know where they stand in their file.

use super::words::{options, words_of_fault};
use ron::value::RawValue;
use serde::{Deserialize, Deserializer, de::DeserializeOwned, de::Error as _};
use std::fmt;
use std::ops::Deref;

/// Where a value begins in the text it was read from.
///
/// It is the address of its first byte, so that values of nested parsers need no offsets handed down. Only the text
/// itself turns it into a line and a column ([`Self::in_text`]); the text must be the one that was parsed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    address: usize,
    /// Whether the key before the value is meant, where it has one.
    of_key: bool,
    /// Line and column, from 1, within the text in quotes that stands there.
    inside: Option<(usize, usize)>,
}

impl Place {
    const fn at(address: usize) -> Self {
        Self { address, of_key: false, inside: None }
    }

    /// A line and a column, from 1, of the text in quotes that stands there.
    pub(crate) const fn inside(self, line: usize, column: usize) -> Self {
        Self { inside: Some((line, column)), ..self }
    }

    /// Where it lies in the text, bytes.
    pub(crate) fn offset_in(self, text: &str) -> usize {
        let offset = self.address.wrapping_sub(text.as_ptr() as usize);
        match (self.inside, text.get(offset..)) {
            (Some(inside), Some(literal)) => offset + offset_inside(literal, inside),
            _ => offset,
        }
    }

    /// Line and column in characters, from 1; the beginning for a place in another text.
    #[must_use]
    pub fn in_text(self, text: &str) -> (usize, usize) {
        let offset = self.offset_in(text);
        let mut before = text.get(..offset).unwrap_or_default();
        if self.of_key
            && let Some(key) = before.trim_end().strip_suffix(':')
        {
            before = key.trim_end().trim_end_matches(|c: char| c.is_alphanumeric() || c == '_');
        }
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
        (line, column)
    }
}

/// The byte at which a line and a column of the content of a text in quotes stand; its end if there are fewer.
fn offset_inside(literal: &str, (line, column): (usize, usize)) -> usize {
    let is_raw = literal.starts_with('r');
    let Some(quote) = literal.find('"') else { return 0 };
    let start = quote + 1;
    let content = &literal[start..];
    let (mut at, mut chars) = ((1, 1), content.char_indices());
    while let Some((offset, c)) = chars.next() {
        if at >= (line, column) || (c == '"' && !is_raw) {
            return start + offset;
        }
        let is_break = match c {
            // One character of the content: `\n`, `\"`, `\u{3c6}`.
            '\\' if !is_raw => {
                let escaped = chars.next().map(|(_, c)| c);
                if escaped == Some('u') {
                    chars.by_ref().find(|(_, c)| *c == '}');
                }
                escaped == Some('n')
            }
            c => c == '\n',
        };
        at = if is_break { (at.0 + 1, 1) } else { (at.0, at.1 + 1) };
    }
    literal.len()
}

/// A value with its place.
#[derive(Clone, Debug)]
pub struct Placed<T> {
    value: T,
    place: Place,
}

impl<T> Placed<T> {
    /// Where it stands.
    pub const fn place(&self) -> Place {
        self.place
    }

    /// Where its key stands; the value itself where it has none.
    pub const fn key(&self) -> Place {
        Place { of_key: true, ..self.place }
    }
}

impl<T> Deref for Placed<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T: fmt::Display> fmt::Display for Placed<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(f)
    }
}

/// Values are compared, not where they stand.
impl<T: PartialEq> PartialEq for Placed<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for Placed<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw: &'de RawValue = Deserialize::deserialize(deserializer)?;
        let text = code_of(raw.get_ron());
        let place = Place::at(text.as_ptr() as usize);
        match options().from_str(text) {
            Ok(value) => Ok(Self { value, place }),
            Err(fault) => Err(D::Error::custom(NestedFault::new(text, &fault))),
        }
    }
}

/// The text from its first character that is neither blank nor in a comment.
fn code_of(text: &str) -> &str {
    let mut rest = text.trim_start();
    loop {
        let behind = if rest.starts_with("//") {
            rest.split_once('\n').map(|(_, behind)| behind)
        } else if rest.starts_with("/*") {
            rest.split_once("*/").map(|(_, behind)| behind)
        } else {
            return rest;
        };
        let Some(behind) = behind else { return rest };
        rest = behind.trim_start();
    }
}

/// A fault of a value that has a parser of its own. The outer parser knows only where the value ends, so its message
/// carries the place.
struct NestedFault {
    place: Place,
    words: String,
}

/// What stands before and behind the place in the message.
const MARK: char = '\u{1}';

impl NestedFault {
    fn new(text: &str, fault: &ron::error::SpannedError) -> Self {
        // One within another has its place already.
        if let ron::Error::Message(message) = &fault.code
            && let Some((place, words)) = nested(message)
        {
            return Self { place, words: words.to_owned() };
        }
        let start = fault.span.start;
        let line = text.split_inclusive('\n').nth(start.line.saturating_sub(1)).unwrap_or_default();
        let column = line.char_indices().nth(start.col.saturating_sub(1)).map_or(line.len(), |(at, _)| at);
        let place = Place::at(line.as_ptr() as usize + if line.is_empty() { 0 } else { column });
        Self { place, words: words_of_fault(&fault.code, text) }
    }
}

impl fmt::Display for NestedFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{MARK}{}{MARK}{}", self.place.address, self.words)
    }
}

/// Place and words of the message of a nested fault.
pub(crate) fn nested(message: &str) -> Option<(Place, &str)> {
    let (address, words) = message.strip_prefix(MARK)?.split_once(MARK)?;
    Some((Place::at(address.parse().ok()?), words))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Item {
        name: Placed<String>,
        cell: Option<Placed<(usize, usize)>>,
    }

    #[test]
    fn values_know_their_lines_and_columns() {
        let text = "[\n  (name: /* a \"b\" */ \"\u{fc}\"),\n  (name: \"x\", cell: // here\n   (3, 4)),\n]";
        let items: Vec<Placed<Item>> = options().from_str(text).expect("a list");
        assert_eq!(items[1].place().in_text(text), (3, 3));
        assert_eq!(items[0].name.place().in_text(text), (2, 22));
        let cell = items[1].cell.as_ref().expect("a cell");
        assert_eq!((**cell, cell.place().in_text(text)), ((3, 4), (4, 4)));
        let (name, first) = (&items[1].name, &items[1]);
        assert_eq!((name.key().in_text(text), first.key().in_text(text)), ((3, 4), (3, 3)));
    }

    #[test]
    fn places_in_texts_are_those_of_the_file() {
        let at = |text: &'static str, line, column| {
            let item: Item = options().from_str(text).expect("an item");
            item.name.place().inside(line, column).in_text(text)
        };
        assert_eq!(at("(\n name: \"1 + y\")", 1, 5), (2, 13));
        assert_eq!(at("(\n name: \"1 +\n  y\")", 2, 3), (3, 3));
        assert_eq!(at("(name: r#\"a\\ + \"b\"\"#)", 1, 6), (1, 16));
        assert_eq!(at("(name: \"\\u{3c6} + \\n z\")", 1, 5), (1, 19));
        assert_eq!(at("(name: \"\\u{3c6} + \\n z\")", 2, 2), (1, 22));
        // What lies behind the end is the end.
        assert_eq!(at("(name: \"ab\")", 1, 9), (1, 11));
    }

    #[test]
    fn faults_within_values_keep_their_places() {
        let text = "[\n  (name: \"x\",\n   cell: (3, -4)),\n]";
        let fault = options().from_str::<Vec<Placed<Item>>>(text).expect_err("-4");
        let ron::Error::Message(message) = &fault.code else { panic!("{fault:?}") };
        let (place, words) = nested(message).expect("a place");
        assert_eq!((place.in_text(text).0, words.is_empty()), (3, false), "{words}");
    }
}
