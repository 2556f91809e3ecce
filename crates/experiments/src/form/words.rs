//! The parser, and its faults in words.

use ron::extensions::Extensions;
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};
use std::borrow::Borrow;
use std::fmt;
use tigereye_fields::nearest;
use tigereye_report::shortened;

/// The parser of all files: values need no `Some`, and a kind is written as `Kind(key: value)`.
pub(crate) fn options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME)
        .with_default_extension(Extensions::UNWRAP_VARIANT_NEWTYPES)
}

/// The message about a name that is not among the `expected` ones.
pub(crate) fn no_such_name(found: &str, expected: &[impl Borrow<str>]) -> String {
    format!("there is no `{}` here: {}", shortened(found), expected_instead(found, expected))
}

/// More names than this are listed in the order of the alphabet.
const FEW: usize = 10;

/// What was expected in place of a name, with the one that was probably meant.
fn expected_instead(found: &str, expected: &[impl Borrow<str>]) -> String {
    let mut names: Vec<&str> = expected.iter().map(Borrow::borrow).collect();
    let meant = nearest(found, names.iter().copied());
    if names.len() > FEW {
        names.sort_unstable();
    }
    let meant = meant.map_or_else(String::new, |name| format!("did you mean `{name}`? "));
    format!("{meant}expected {}", one_of(&names))
}

fn one_of(names: &[impl Borrow<str>]) -> String {
    match names {
        [] => "none".to_owned(),
        [name] => format!("`{}`", name.borrow()),
        names => format!("one of `{}`", names.join("`, `")),
    }
}

/// What the parser says of `text`, without the names of types that do not stand there.
pub(crate) fn words_of_fault(error: &ron::Error, text: &str) -> String {
    use ron::Error as E;
    let within = |outer: &Option<String>| match outer {
        Some(name) if text.contains(name.as_str()) => format!(" in `{name}`"),
        _ => String::new(),
    };
    match error {
        E::IntegerOutOfBounds => {
            "the number is out of range: expected a whole number from 0 that fits the machine".to_owned()
        }
        E::ExpectedArray => "expected a list, `[...]`".to_owned(),
        E::ExpectedMap => "expected names with values, `{...}`".to_owned(),
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) => "expected `(`".to_owned(),
        E::ExpectedFloat => "expected a number".to_owned(),
        E::ExpectedInteger => "expected a whole number".to_owned(),
        E::ExpectedString => "expected text in quotes".to_owned(),
        E::ExpectedDifferentStructName { found, .. } => {
            format!("there is `{found}` where `(` was expected: is a bracket missing before it?")
        }
        E::Eof => "the file ends within a value".to_owned(),
        E::ExceededRecursionLimit => "values are nested too deeply".to_owned(),
        E::TrailingCharacters => "expected the end of the file".to_owned(),
        E::NoSuchEnumVariant { expected, found, .. } => no_such_name(found, expected),
        E::NoSuchStructField { expected, found, outer } => {
            let key = shortened(found);
            format!("there is no key `{key}`{}: {}", within(outer), expected_instead(found, expected))
        }
        E::MissingStructField { field, outer } => format!("the key `{field}` is missing{}", within(outer)),
        E::DuplicateStructField { field, outer } => {
            format!("the key `{field}` appears twice here{}", within(outer))
        }
        other => shortened(&other.to_string()),
    }
}

/// The key and the value at an offset of a text, as ` (width: "51")`; only the value where there is no key, and nothing
/// where there is no value.
pub(crate) fn key_and_value(text: &str, offset: usize) -> String {
    let (Some(before), Some(rest)) = (text.get(..offset), text.get(offset..)) else { return String::new() };
    let value = rest.trim_start();
    let in_quotes = value.strip_prefix('"').and_then(|v| v.find('"')).map(|end| end + 2);
    let end = in_quotes.unwrap_or_else(|| value.find([',', ')', ']', '}', '\n']).unwrap_or(value.len()));
    let value = value[..end].trim();
    if value.is_empty() || value.chars().count() > 60 || value.contains('\n') {
        return String::new();
    }
    let key = before.trim_end().strip_suffix(':').map(str::trim_end);
    let name = |k: &str| k.len() - k.trim_end_matches(|c: char| c.is_alphanumeric() || c == '_').len();
    let key = key.map(|k| &k[k.len() - name(k)..]).filter(|key| !key.is_empty());
    match key {
        Some(key) => format!(" (`{key}: {value}`)"),
        None => format!(" (`{value}`)"),
    }
}

/// A word without quotes.
pub(crate) struct Word(pub(crate) String);

impl<'de> Deserialize<'de> for Word {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Letters;
        impl Visitor<'_> for Letters {
            type Value = Word;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a word")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Word, E> {
                Ok(Word(word.to_owned()))
            }
        }
        deserializer.deserialize_identifier(Letters)
    }
}
