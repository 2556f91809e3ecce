//! The parser, and its faults in words.

use ron::extensions::Extensions;
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};
use std::borrow::Borrow;
use std::fmt;
use tigereye_report::shortened;

/// The parser of all files: values need no `Some`, and a kind is written as `Kind(key: value)`.
pub(crate) fn options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME)
        .with_default_extension(Extensions::UNWRAP_VARIANT_NEWTYPES)
}

/// The message about a name that is not among the `expected` ones.
pub(crate) fn no_such_name(found: &str, expected: &[impl Borrow<str>]) -> String {
    format!("there is no `{found}` here: expected {}", one_of(expected))
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
    let words = match error {
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
            format!("there is no key `{found}`{}: expected {}", within(outer), one_of(expected))
        }
        E::MissingStructField { field, outer } => format!("the key `{field}` is missing{}", within(outer)),
        E::DuplicateStructField { field, outer } => {
            format!("the key `{field}` stands here twice{}", within(outer))
        }
        other => other.to_string(),
    };
    shortened(&words)
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
