//! One module per command.

pub(crate) mod advice;
pub(crate) mod bench;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod convert;
pub(crate) mod drawing;
pub(crate) mod field;
pub(crate) mod ftle;
pub(crate) mod glyphs;
pub(crate) mod importance;
pub(crate) mod info;
pub(crate) mod lattice;
pub(crate) mod lic;
pub(crate) mod light_options;
pub(crate) mod lines;
pub(crate) mod ltg;
pub(crate) mod merge;
pub(crate) mod overlaid;
pub(crate) mod plan;
pub(crate) mod propagate;
pub(crate) mod reproduce;
pub(crate) mod review;
pub(crate) mod ridges;
pub(crate) mod shell;
pub(crate) mod status;
pub(crate) mod topology;
pub(crate) mod volume;

use crate::error::CliError;
use serde_json::Value;
use std::io::{ErrorKind, Write};

/// Prints JSON to standard output.
pub(crate) fn print_json(value: &Value) -> Result<(), CliError> {
    print_text(&format!("{value:#}\n"))
}

/// Prints text to standard output. A reader that has gone away is no fault of ours; a full disk is one.
pub(crate) fn print_text(text: &str) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(source) if source.kind() != ErrorKind::BrokenPipe => {
            Err(CliError::File { path: "standard output".to_owned(), action: "writing", source })
        }
        _ => Ok(()),
    }
}

/// A number with its noun.
pub(crate) fn counted(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// A number with up to seven digits, as people write it: `0.25`, `1.5e-9`.
pub(crate) fn in_digits(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e7).contains(&size) {
        let text = format!("{x:.6e}");
        return match text.split_once('e') {
            Some((digits, exponent)) => format!("{}e{exponent}", trimmed(digits)),
            None => text,
        };
    }
    let before = format!("{size:.0}").len();
    trimmed(&format!("{x:.*}", if size < 1.0 { 7 } else { 7_usize.saturating_sub(before) })).to_owned()
}

/// Without zeros behind the last digit that is none.
fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

/// Lengths along the axes, `0.5 x 0.5`.
pub(crate) fn in_lengths(lengths: &Value) -> String {
    let lengths = lengths.as_array().into_iter().flatten();
    lengths.map(|x| in_digits(x.as_f64().unwrap_or(f64::NAN))).collect::<Vec<_>>().join(" x ")
}

/// The command line as the user gave it, for provenance.
pub(crate) fn command_line() -> String {
    // The path of the program is of no interest to others. File names need not be text.
    let words = std::env::args_os().skip(1).map(|w| quoted(&w.to_string_lossy()));
    std::iter::once("tigereye".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// A word as a POSIX shell reads it back.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+,.:/@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::{in_digits, quoted};

    #[test]
    fn numbers_are_written_as_people_do() {
        let found = [0.0, 2.0, -0.25, 349.429_504, 1e-9, 1.5e12, 123_456.78, 1.0 / 3.0].map(in_digits);
        assert_eq!(found, ["0", "2", "-0.25", "349.4295", "1e-9", "1.5e12", "123456.8", "0.3333333"]);
    }

    #[test]
    fn words_survive_the_shell() {
        assert_eq!(quoted("inverse:size=51"), "inverse:size=51");
        assert_eq!(quoted("5,5,cos(theta)"), "'5,5,cos(theta)'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
    }
}
