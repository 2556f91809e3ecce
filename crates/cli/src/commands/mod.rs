//! One module per command.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod field;
pub(crate) mod info;
pub(crate) mod ltg;
pub(crate) mod propagate;
pub(crate) mod reproduce;

use serde_json::Value;

/// Prints JSON to standard output. A reader that has gone away is no fault of ours.
pub(crate) fn print_json(value: &Value) {
    print_text(&format!("{value:#}\n"));
}

/// Prints text to standard output.
pub(crate) fn print_text(text: &str) {
    use std::io::Write;
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// A number with its noun.
pub(crate) fn counted(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// The command line as the user gave it, for provenance.
pub(crate) fn command_line() -> String {
    let mut words = std::env::args();
    // The path of the program is of no interest to others.
    words.next();
    std::iter::once("tigereye".to_owned()).chain(words.map(quoted)).collect::<Vec<_>>().join(" ")
}

/// A word as a POSIX shell reads it back.
fn quoted(word: String) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+,.:/@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn words_survive_the_shell() {
        assert_eq!(quoted("inverse:size=51".into()), "inverse:size=51");
        assert_eq!(quoted("5,5,cos(theta)".into()), "'5,5,cos(theta)'");
        assert_eq!(quoted("it's".into()), "'it'\\''s'");
    }
}
