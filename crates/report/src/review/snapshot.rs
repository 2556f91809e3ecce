//! Snapshots of insta: the accepted file and its pending successor, line by line.

use super::compare::paired;
use super::{Entry, ExperimentReview, Kind, NumberReview, Review, Subject, Value};
use crate::shortened;

/// Deepest nesting that paths are made for; below, lines keep the path of their parent.
const MAX_DEPTH: usize = 64;

/// A pending snapshot.
#[derive(Clone, Debug)]
pub struct Pending {
    /// Its name, without `.snap.new`.
    pub name: String,
    /// Text of the accepted one, if there is one.
    pub accepted: Option<String>,
    /// Text of the pending one.
    pub pending: String,
}

/// Compares pending snapshots with the accepted ones. `names` are those of the two kinds of files; `settled` accepted
/// snapshots have no pending successor.
#[must_use]
pub fn snapshots(names: [&str; 2], pending: &[Pending], settled: usize, tolerance: f64) -> Review {
    let review = |p: &Pending| {
        let (base, head) = (p.accepted.as_deref().map(lines).unwrap_or_default(), lines(&p.pending));
        let entry = |line: Option<&(String, Entry)>| line.map(|(_, e)| e.clone());
        let numbers = paired(&base, &head, |(path, _)| path.clone())
            .into_iter()
            .map(|(path, a, b)| NumberReview::new(path, Kind::Line, entry(a), entry(b), tolerance))
            .collect();
        let title = p.name.strip_prefix("digest@").unwrap_or(&p.name);
        ExperimentReview::new(&p.name, title, [p.accepted.is_some(), true], numbers)
    };
    let subject = Subject::Snapshots { settled };
    Review::new(names, tolerance, subject, pending.iter().map(review).collect())
}

/// A list or an object that is open.
struct Open {
    key: String,
    /// Index of the next entry without a key.
    next: usize,
    /// Whether nothing was in it yet.
    fresh: bool,
}

/// Every value of a snapshot with its path, in the order of the file.
///
/// What is read is RON and YAML as insta writes them, a value a line; a line of no known form is words. An entry of a
/// list is called by its `name` where that comes first, so that an entry more does not move those below.
fn lines(text: &str) -> Vec<(String, Entry)> {
    let mut found = Vec::new();
    let mut open: Vec<Open> = Vec::new();
    let mut depth = 0_usize;
    for line in body(text).lines() {
        let line = line.trim();
        let content = line.strip_suffix(',').unwrap_or(line);
        if content.is_empty() {
            continue;
        }
        if content.starts_with([')', '}', ']']) {
            depth = depth.saturating_sub(1);
            open.truncate(depth.min(MAX_DEPTH));
            continue;
        }
        let (key, value) = split_key(content);
        if value.ends_with(['(', '{', '[']) {
            let key = key.map_or_else(|| next_index(&mut open), shortened);
            depth += 1;
            if open.len() < MAX_DEPTH {
                open.push(Open { key, next: 0, fresh: true });
            }
            continue;
        }
        let fresh = open.last_mut().is_some_and(|o| std::mem::take(&mut o.fresh));
        if let (true, Some("name"), [.., entry]) = (fresh, key, &mut open[..])
            && entry.key.starts_with('[')
        {
            entry.key = format!("[{}]", shortened(unquoted(value)));
            continue;
        }
        let key = key.map_or_else(|| next_index(&mut open), ToOwned::to_owned);
        let path = path(&open, &key);
        match tuple(value) {
            Some(parts) => {
                let parts = parts.iter().enumerate();
                found.extend(parts.map(|(i, part)| (format!("{path}[{i}]"), entry(&path, part))));
            }
            None => found.push((path.clone(), entry(&path, value))),
        }
    }
    found
}

/// A snapshot without its header.
fn body(text: &str) -> &str {
    let Some(rest) = text.strip_prefix("---\n").or_else(|| text.strip_prefix("---\r\n")) else { return text };
    rest.split_once("\n---").map_or(rest, |(_, body)| body)
}

/// The key before a colon, if there is one, and what follows.
fn split_key(content: &str) -> (Option<&str>, &str) {
    let end = match content.strip_prefix('"') {
        Some(rest) => match closing_quote(rest) {
            Some(at) => at + 2,
            None => return (None, content),
        },
        None => content.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-')).unwrap_or(0),
    };
    match content[end..].strip_prefix(": ") {
        Some(value) if end > 0 => (Some(unquoted(&content[..end])), value),
        _ => (None, content),
    }
}

/// Where the quotation that is open ends.
fn closing_quote(text: &str) -> Option<usize> {
    let mut escaped = false;
    text.char_indices().find_map(|(i, c)| {
        let closes = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        closes.then_some(i)
    })
}

fn unquoted(text: &str) -> &str {
    text.strip_prefix('"').and_then(|t| t.strip_suffix('"')).unwrap_or(text)
}

fn next_index(open: &mut [Open]) -> String {
    let Some(parent) = open.last_mut() else { return String::new() };
    parent.next += 1;
    format!("[{}]", parent.next - 1)
}

/// Keys joined by dots; indices stand right behind the list.
fn path(open: &[Open], key: &str) -> String {
    let mut path = String::new();
    for key in open.iter().map(|o| o.key.as_str()).chain([key]) {
        if !path.is_empty() && !key.starts_with('[') {
            path.push('.');
        }
        path.push_str(key);
    }
    shortened(&path)
}

/// The parts of a tuple that stands in one line.
fn tuple(value: &str) -> Option<Vec<&str>> {
    let inside = value.strip_prefix('(')?.strip_suffix(')')?;
    let (mut parts, mut rest) = (Vec::new(), inside);
    loop {
        let mut quoted = false;
        let comma = rest.char_indices().find(|(_, c)| {
            quoted ^= *c == '"';
            *c == ',' && !quoted
        });
        let (part, after) = comma.map_or((rest, None), |(i, _)| (&rest[..i], Some(&rest[i + 1..])));
        parts.push(part.trim());
        match after {
            Some(after) => rest = after,
            None => return Some(parts),
        }
    }
}

/// A number where it is one, with or without quotes; `passed` is a verdict.
fn entry(path: &str, value: &str) -> Entry {
    let words = unquoted(value);
    let number = words.parse::<f64>().ok().filter(|_| words != "inf" && words != "nan");
    let passed = path.ends_with(".passed").then(|| words.parse().ok()).flatten();
    let value = number.map_or_else(|| Value::Words(words.to_owned()), Value::Number);
    Entry { passed, ..Entry::bare(value) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"---
source: a.rs
input_file: b.ron
---
Digest(
  slug: "brain",
  fields: {
    "coarse: one": FieldDigest(
      width: 29,
      mean: "3.5e-1",
    ),
  },
  lights: {
    "light": LightDigest(
      energy: ("0", "a, b", "~0"),
    ),
  },
  gradients: {},
  figures: [
    "tensors 1049x452",
    "gradient 10x20",
  ],
  checks: [
    CheckDigest(
      name: "share of \"zero\": one",
      value: "NaN",
      passed: true,
    ),
    CheckDigest(
      name: "other",
      value: "2",
      passed: false,
    ),
  ],
)
"#;

    #[test]
    fn every_line_has_its_path() {
        let found = lines(TEXT);
        let paths: Vec<&str> = found.iter().map(|(path, _)| path.as_str()).collect();
        let expected = [
            "slug",
            "fields.coarse: one.width",
            "fields.coarse: one.mean",
            "lights.light.energy[0]",
            "lights.light.energy[1]",
            "lights.light.energy[2]",
            "gradients",
            "figures[0]",
            "figures[1]",
            r#"checks[share of \"zero\": one].value"#,
            r#"checks[share of \"zero\": one].passed"#,
            "checks[other].value",
            "checks[other].passed",
        ];
        assert_eq!(paths, expected);
        let value = |path: &str| found.iter().find(|(p, _)| p == path).map(|(_, e)| e.value.clone());
        assert_eq!(value("fields.coarse: one.mean"), Some(Value::Number(0.35)));
        assert_eq!(value("lights.light.energy[1]"), Some(Value::Words("a, b".to_owned())));
        assert_eq!(value("lights.light.energy[2]"), Some(Value::Words("~0".to_owned())));
        assert!(found.iter().any(|(p, e)| p == "checks[other].passed" && e.passed == Some(false)));
    }

    #[test]
    fn hostile_text_is_only_words() {
        for text in [
            "",
            "---",
            "---\n",
            ")))",
            "(",
            "\"",
            "a: (",
            "\"a: b",
            "a: (\"",
            ",,,",
            "ä: ö",
            "name: \"x\"",
            "---\nx\n---\n]\n[\nname: 1",
        ] {
            lines(text);
        }
        let deep = "[\n".repeat(100_000) + "1\n" + &"]\n".repeat(100_000) + "after: 2\n";
        let found = lines(&deep);
        assert_eq!(found.len(), 2);
        assert_eq!(found[1].0, "after");
    }
}
