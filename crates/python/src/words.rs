//! Values of options, from their words.

use crate::error::Fault;
use tigereye_core::Choice;
use tigereye_lines::Family;

/// The value of a choice that has this name on the command line.
pub(crate) fn choice<T: Choice>(option: &str, word: &str) -> Result<T, Fault> {
    T::of_word(word).ok_or_else(|| {
        let words: Vec<&str> = T::ALL.iter().map(|value| value.word()).collect();
        Fault::option(option, format!("`{word}`: expected one of {}", words.join(", ")))
    })
}

/// The same, where it need not be given.
pub(crate) fn optional<T: Choice>(option: &str, word: Option<&str>) -> Result<Option<T>, Fault> {
    word.map(|word| choice(option, word)).transpose()
}

/// Either family of axes, or both.
pub(crate) fn families(word: &str) -> Result<&'static [Family], Fault> {
    if word == "both" {
        return Ok(Family::ALL);
    }
    match Family::ALL.iter().position(|f| f.word() == word) {
        Some(i) => Ok(&Family::ALL[i..=i]),
        None => Err(Fault::option("family", format!("`{word}`: expected one of major, minor, both"))),
    }
}

/// Refuses numbers outside of a range, both ends included.
pub(crate) fn within(option: &str, value: f64, low: f64, high: f64) -> Result<f64, Fault> {
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        Err(Fault::option(option, format!("{value}: expected a number from {low} to {high}")))
    }
}

/// The same for whole numbers.
pub(crate) fn count_within(option: &str, value: usize, low: usize, high: usize) -> Result<usize, Fault> {
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        Err(Fault::option(option, format!("{value}: expected {low} to {high}")))
    }
}
