//! Places of keys, names and items in the text of a file.
//!
//! The parser knows the place of what it cannot read. What it has read and turns out wrong later is looked for in the text again,
//! outside of comments.

use std::ops::Range;

/// A file's text, taken apart once; every byte keeps its place.
#[derive(Clone, Debug)]
pub(crate) struct SourceText<'a> {
    text: &'a str,
    /// The text without comments.
    code: String,
    /// The text without comments and without what stands between quotes.
    bare: String,
    /// Where each line begins.
    lines: Vec<usize>,
}

/// What a piece of text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Piece {
    Code,
    Comment,
    /// What lies between the quotes of a string or a character.
    Quoted {
        /// Bytes of the mark before it.
        before: usize,
        /// Bytes of the mark behind it.
        behind: usize,
    },
}

impl<'a> SourceText<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        let (mut code, mut bare) = (String::with_capacity(text.len()), String::with_capacity(text.len()));
        let blank = |into: &mut String, piece: &str| {
            into.extend(piece.bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }));
        };
        let (mut rest, mut previous) = (text, ' ');
        while !rest.is_empty() {
            let (piece, length) = first_piece(rest, previous);
            let (now, next) = rest.split_at(length);
            match piece {
                Piece::Code => {
                    code.push_str(now);
                    bare.push_str(now);
                }
                Piece::Comment => {
                    blank(&mut code, now);
                    blank(&mut bare, now);
                }
                Piece::Quoted { before, behind } => {
                    code.push_str(now);
                    bare.push_str(&now[..before]);
                    blank(&mut bare, &now[before..length - behind]);
                    bare.push_str(&now[length - behind..]);
                }
            }
            previous = now.chars().next_back().unwrap_or(' ');
            rest = next;
        }
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
        Self { text, code, bare, lines }
    }

    /// Line and column, from 1, of `word` behind all `anchors`, each looked for behind the one before. One that is missing is
    /// passed over.
    ///
    /// A word in quotes is a string, one that ends in `:` is a key; any other stands by itself outside of strings. A key of the
    /// file, and a name in what is behind it, are those within the fewest brackets: not what is called the same further inside.
    pub(crate) fn place_after(&self, anchors: &[&str], word: &str) -> (usize, usize) {
        let (mut from, mut place) = (0, 0);
        for (i, part) in anchors.iter().chain(std::iter::once(&word)).enumerate() {
            let outermost = if i < 2 { self.outermost(part, from) } else { None };
            if let Some(found) = outermost.or_else(|| self.find(part, from..self.text.len())) {
                place = found;
                from = found + 1;
            }
        }
        self.line_and_column(place)
    }

    /// The first byte of the key or string `word` that is within the fewest brackets, of those from `from` on to the bracket that
    /// closes what `from` is in.
    fn outermost(&self, word: &str, from: usize) -> Option<usize> {
        if !word.starts_with('"') && !word.ends_with(':') {
            return None;
        }
        let (mut best, mut depth, mut at): (Option<(usize, usize)>, _, _) = (None, 0_usize, from);
        while let Some(found) = self.find(word, at..self.text.len()) {
            for byte in self.bare.bytes().take(found).skip(at) {
                match byte {
                    b'(' | b'[' | b'{' => depth += 1,
                    b')' | b']' | b'}' if depth == 0 => return best.map(|(place, _)| place),
                    b')' | b']' | b'}' => depth -= 1,
                    _ => {}
                }
            }
            if best.is_none_or(|(_, least)| depth < least) {
                best = Some((found, depth));
            }
            at = found + 1;
        }
        best.map(|(place, _)| place)
    }

    /// Where the items of the list behind the key `list` stand, in bytes.
    pub(crate) fn items(&self, list: &str) -> Vec<Range<usize>> {
        let key = self.find(list, 0..self.text.len());
        let Some(first) = key.and_then(|at| Some(at + self.bare[at..].find('[')? + 1)) else {
            return Vec::new();
        };
        let mut items = Vec::new();
        let (mut depth, mut start) = (0_usize, first);
        for (i, byte) in self.bare.bytes().enumerate().skip(first) {
            match byte {
                b'(' | b'[' | b'{' => depth += 1,
                b')' | b']' | b'}' if depth > 0 => depth -= 1,
                b',' if depth == 0 => {
                    items.push(start..i);
                    start = i + 1;
                }
                b')' | b']' | b'}' => {
                    items.push(start..i);
                    break;
                }
                _ => {}
            }
        }
        items
    }

    /// Line and column of `word` in an item, or of the item where it has no such word.
    pub(crate) fn place_in(&self, item: Range<usize>, word: &str) -> (usize, usize) {
        let of_item = || {
            let code = &self.bare[item.clone()];
            item.start + code.len() - code.trim_start().len()
        };
        self.line_and_column(self.find(word, item.clone()).unwrap_or_else(of_item))
    }

    /// The first byte of `word` in a part of the text.
    fn find(&self, word: &str, within: Range<usize>) -> Option<usize> {
        let (text, name, is_key) = match word.strip_suffix(':') {
            _ if word.starts_with('"') => (&self.code, word, false),
            Some(name) => (&self.bare, name, true),
            None => (&self.bare, word, false),
        };
        let fits = |at: usize| {
            let (before, behind) = (&self.bare[..at], &self.bare[at + name.len()..]);
            if name.starts_with('"') {
                // Only the mark that opens a string is followed by what is quoted.
                return self.bare.as_bytes()[at] == b'"';
            }
            let joins =
                |edge: Option<char>, c: Option<char>| edge.is_some_and(in_name) && c.is_some_and(in_name);
            // 45 may be written 45.0.
            let behind = match behind.strip_prefix('.') {
                Some(digits) if name.ends_with(|c: char| c.is_ascii_digit()) => {
                    digits.trim_start_matches('0')
                }
                _ => behind,
            };
            let is_whole = !joins(before.chars().next_back(), name.chars().next())
                && !joins(behind.chars().next(), name.chars().next_back());
            is_whole && (!is_key || behind.trim_start().starts_with(':'))
        };
        let part = text.get(within.clone())?;
        part.match_indices(name).map(|(i, _)| within.start + i).find(|at| fits(*at))
    }

    fn line_and_column(&self, place: usize) -> (usize, usize) {
        let line = self.lines.partition_point(|start| *start <= place);
        let start = self.lines[line - 1];
        (line, self.text[start..place].chars().count() + 1)
    }
}

const fn in_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '-' | '+')
}

/// What the text begins with, and how many bytes of it.
fn first_piece(text: &str, previous: char) -> (Piece, usize) {
    let first = text.chars().next().map_or(0, char::len_utf8);
    match text.as_bytes() {
        [b'/', b'/', ..] => (Piece::Comment, text.find('\n').unwrap_or(text.len())),
        [b'/', b'*', ..] => (Piece::Comment, block_comment(text)),
        [b'"', ..] => quoted(text, 1, '"'),
        [b'\'', ..] => match text[1..].chars().next() {
            Some('\\') => quoted(text, 1, '\''),
            Some(c) if text[1 + c.len_utf8()..].starts_with('\'') => quoted(text, 1, '\''),
            _ => (Piece::Code, 1),
        },
        [b'r', ..] if !in_name(previous) || previous == 'b' => raw_string(text).unwrap_or((Piece::Code, 1)),
        _ => (Piece::Code, first),
    }
}

/// Bytes of a comment that may hold others.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut i) = (0, 0);
    while i < text.len() {
        match text.as_bytes()[i..] {
            [b'/', b'*', ..] => (depth, i) = (depth + 1, i + 2),
            [b'*', b'/', ..] => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            break;
        }
    }
    i
}

/// Text up to the mark that closes it, with escapes.
fn quoted(text: &str, before: usize, mark: char) -> (Piece, usize) {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        if c == mark && !escaped {
            return (Piece::Quoted { before, behind: 1 }, i + 1);
        }
        escaped = c == '\\' && !escaped;
    }
    (Piece::Quoted { before, behind: 0 }, text.len())
}

/// `r#"..."#` with any number of `#`.
fn raw_string(text: &str) -> Option<(Piece, usize)> {
    let hashes = text[1..].len() - text[1..].trim_start_matches('#').len();
    let before = hashes + 2;
    if text.as_bytes().get(before - 1) != Some(&b'"') {
        return None;
    }
    let end = format!("\"{}", "#".repeat(hashes));
    let length = text[before..].find(&end).map(|i| before + i + end.len());
    let behind = if length.is_some() { end.len() } else { 0 };
    Some((Piece::Quoted { before, behind }, length.unwrap_or(text.len())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_strings_hide_what_stands_in_them() {
        let text = "/* runs: /* \"a\": */ runs: */ (title: \"runs: // é\", x: '\"', // runs:\n  y: r#\"runs: \" \"#, é: 1, runs : {\n \"a\": 2})";
        let source = SourceText::new(text);
        assert_eq!((source.code.len(), source.bare.len()), (text.len(), text.len()));
        assert_eq!(source.place_after(&[], "runs:"), (2, 27));
        assert_eq!(source.place_after(&["runs:"], "\"a\""), (3, 2));
        assert_eq!(source.place_after(&["nothing:"], "y:"), (2, 3));
        assert_eq!(source.place_after(&[], "title:"), (1, 31));
    }

    #[test]
    fn names_and_keys_are_the_outermost_ones() {
        let source = SourceText::new(
            "(parts: [(width: 1)], runs: {\"a\": (of: \"b\"), \"b\": 1}, figures: [(of: \"d\"), (name: \"c\", of: (\"e\")), (name: \"e\")], width: 2)",
        );
        let at = |anchors: &[&str], word: &str, behind: &str| {
            let (line, column) = source.place_after(anchors, word);
            assert_eq!(line, 1);
            assert!(source.text[column - 1..].starts_with(behind), "{word}: {}", &source.text[column - 1..]);
        };
        at(&[], "width:", "width: 2");
        at(&["runs:"], "\"b\"", "\"b\": 1");
        at(&["figures:"], "\"e\"", "\"e\")], width");
        at(&["runs:", "\"a\""], "of:", "of: \"b\"");
        // What the list does not hold may stand behind it.
        at(&["runs:"], "\"c\"", "\"c\", of");
    }

    #[test]
    fn words_are_whole() {
        let source = SourceText::new("(cells: 12, cell: 1, s: -1.25, t: 1.2)");
        assert_eq!(source.place_after(&[], "cell:"), (1, 13));
        assert_eq!(source.place_after(&[], "1"), (1, 19));
        assert_eq!(source.place_after(&[], "1.2"), (1, 35));
        let source = SourceText::new("(a: 45.05, a: 45.00, a: 45)");
        assert_eq!(source.place_after(&[], "a: 45"), (1, 12));
    }

    #[test]
    fn items_of_lists_are_told_apart() {
        let text = "(l : [(a: [1, 2]), \"],\" /* , */, (\n  b: 3)], m: [], n: [1,])";
        let source = SourceText::new(text);
        let items = source.items("l:");
        assert_eq!(items.len(), 3);
        assert_eq!(source.place_in(items[2].clone(), "b:"), (2, 3));
        assert_eq!(source.place_in(items[2].clone(), "a:"), (1, 34), "the item where it has no such word");
        assert_eq!(source.place_in(items[0].clone(), "a:"), (1, 8));
        assert_eq!((source.items("m:").len(), source.items("n:").len(), source.items("k:").len()), (1, 2, 0));
    }

    #[test]
    fn broken_text_is_taken_apart_too() {
        for text in ["\"", "r#\"", "/*", "'", "'\\", "\"\\", "r", "br#", "é'é", "l: [", "[", "/* /* */"] {
            let source = SourceText::new(text);
            assert_eq!(source.bare.len(), text.len(), "{text}");
            let _ = (source.place_after(&[], "x"), source.items("l:"));
        }
    }
}
