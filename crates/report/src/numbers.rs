//! Numbers for readers: six significant digits, a real minus sign, powers of ten as such.

use maud::{Markup, html};

/// Digits after the first one that are shown.
const FURTHER_DIGITS: usize = 5;

/// Digits after the first one that tell any two numbers apart.
const ALL_FURTHER_DIGITS: usize = 16;

/// From this power of ten on, numbers are written with their exponent.
const LARGE_EXPONENT: i32 = 7;

/// Up to this power of ten, numbers are written with their exponent.
const SMALL_EXPONENT: i32 = -5;

/// `value` with six significant digits; its full digits are kept for machines and, where they say more, as a
/// tooltip.
pub(crate) fn number(value: f64) -> Markup {
    number_with(value, FURTHER_DIGITS)
}

/// [`number`] with `further` digits after the first one.
pub(crate) fn number_with(value: f64, further: usize) -> Markup {
    let exact = format!("{value}");
    let (digits, exponent) = shown(value, further);
    let rounded = value.is_finite() && in_full(value, further).parse() != Ok(value);
    html! {
        data value=(exact) title=[rounded.then_some(&exact)] {
            (digits)
            @if let Some(exponent) = exponent { " × 10" sup { (with_minus(&exponent.to_string())) } }
        }
    }
}

/// Whether two numbers are shown with the same digits.
pub(crate) fn looks_equal(a: f64, b: f64) -> bool {
    shown(a, FURTHER_DIGITS) == shown(b, FURTHER_DIGITS)
}

/// `value` in plain text: six significant digits, a power of ten where there would be many zeros.
#[must_use]
pub fn plain(value: f64) -> String {
    plain_with(value, FURTHER_DIGITS)
}

/// [`plain`] with `further` digits after the first one.
fn plain_with(value: f64, further: usize) -> String {
    if value.is_finite() { in_full(value, further) } else { format!("{value}") }
}

/// Digits after the first one that tell two numbers apart, six in all at the least.
pub(crate) fn digits_apart(a: f64, b: f64) -> usize {
    let apart = |further: &usize| shown(a, *further) != shown(b, *further);
    (FURTHER_DIGITS..=ALL_FURTHER_DIGITS)
        .find(apart)
        .map_or(FURTHER_DIGITS, |n| (n + 1).min(ALL_FURTHER_DIGITS))
}

/// Mantissa and, if the number is written with one, exponent.
fn shown(value: f64, further: usize) -> (String, Option<i32>) {
    if value.is_nan() {
        return ("not a number".into(), None);
    }
    if value.is_infinite() {
        return (if value > 0.0 { "∞" } else { "−∞" }.into(), None);
    }
    let (mantissa, exponent) = rounded(value, further);
    if value == 0.0 || (exponent > SMALL_EXPONENT && exponent < LARGE_EXPONENT) {
        let decimals = usize::try_from(further as i32 - exponent).unwrap_or(0);
        // Adding zero turns a negative zero into a plain one.
        return (with_minus(&trimmed(&format!("{:.decimals$}", value + 0.0))), None);
    }
    (with_minus(&trimmed(&mantissa)), Some(exponent))
}

/// The digits that are shown, as a literal that can be read back.
fn in_full(value: f64, further: usize) -> String {
    match shown(value, further) {
        (digits, None) => digits.replace('−', "-"),
        (digits, Some(exponent)) => format!("{}e{exponent}", digits.replace('−', "-")),
    }
}

/// Mantissa and exponent after rounding, so that 999 999.9 counts as a million.
fn rounded(value: f64, further: usize) -> (String, i32) {
    let text = format!("{value:.further$e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => (mantissa.to_owned(), exponent.parse().unwrap_or(0)),
        None => (text, 0),
    }
}

/// Without zeros at the end of the decimals.
fn trimmed(text: &str) -> String {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text.to_owned()
    }
}

fn with_minus(text: &str) -> String {
    text.replace('-', "−")
}

/// A count in groups of three digits.
pub(crate) fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            // Narrow no-break space: no reader takes it for a decimal sign.
            out.push('\u{202f}');
        }
        out.push(digit);
    }
    out
}

/// A message with its middle left out where somebody's input makes it longer than people read.
#[must_use]
pub fn shortened(message: &str) -> String {
    const HEAD: usize = 1500;
    const TAIL: usize = 300;
    let count = message.chars().count();
    if count <= HEAD + TAIL {
        return message.to_owned();
    }
    let head: String = message.chars().take(HEAD).collect();
    let tail: String = message.chars().skip(count - TAIL).collect();
    format!("{head} [... {} characters ...] {tail}", count - HEAD - TAIL)
}

/// A count with its noun, which takes an s unless there is one.
pub(crate) fn counted(n: usize, noun: &str) -> String {
    format!("{} {noun}{}", count(n as u64), if n == 1 { "" } else { "s" })
}

/// A time span in the units a person would use.
pub(crate) fn duration(seconds: f64) -> String {
    if !seconds.is_finite() || seconds < 0.0 {
        return "unknown".into();
    }
    if seconds < 9.995 {
        return format!("{seconds:.2} s");
    }
    if seconds < 59.95 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds.round() as u64;
    let (hours, minutes, rest) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 { format!("{hours} h {minutes:02} min") } else { format!("{minutes} min {rest:02} s") }
}

/// A file size.
pub(crate) fn file_size(bytes: usize) -> String {
    match bytes {
        0..1_000 => counted(bytes, "byte"),
        1_000..1_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(value: f64, expect: &str) {
        let (digits, exponent) = shown(value, FURTHER_DIGITS);
        let text = exponent.map_or(digits.clone(), |e| format!("{digits} × 10^{e}"));
        assert_eq!(text, expect, "{value}");
    }

    #[test]
    fn six_significant_digits() {
        check(0.0, "0");
        check(-0.0, "0");
        check(1.0, "1");
        check(-2.5, "−2.5");
        check(1.0 / 3.0, "0.333333");
        check(0.000_123_456_789, "0.000123457");
        check(179_878.4, "179878");
        check(999_999.9, "1000000");
        check(51.0, "51");
    }

    #[test]
    fn exponents_for_the_very_small_and_very_large() {
        check(2.5e-14, "2.5 × 10^-14");
        check(-3e-13, "−3 × 10^-13");
        check(1e37, "1 × 10^37");
        check(12_345_678.0, "1.23457 × 10^7");
        check(9.999_999e-5, "0.0001");
    }

    #[test]
    fn values_without_digits() {
        check(f64::NAN, "not a number");
        check(f64::INFINITY, "∞");
        check(f64::NEG_INFINITY, "−∞");
    }

    #[test]
    fn full_digits_only_where_they_say_more() {
        assert!(number(1.0 / 3.0).into_string().contains("title=\"0.3333333333333333\""));
        assert!(!number(0.25).into_string().contains("title"));
        assert!(number(-1e-9).into_string().contains("<sup>−9</sup>"));
    }

    #[test]
    fn numbers_that_differ_late_are_told_apart() {
        assert_eq!(digits_apart(1.0, 2.0), FURTHER_DIGITS + 1);
        assert_eq!(digits_apart(1.0, 1.0), FURTHER_DIGITS);
        let (a, b) = (0.123_456_789_012, 0.123_456_789_013);
        let digits = digits_apart(a, b);
        assert!(digits <= 12 && shown(a, digits) != shown(b, digits));
        assert_eq!(digits_apart(1.0, 1.0 + f64::EPSILON), ALL_FURTHER_DIGITS);
    }

    #[test]
    fn counts_spans_and_sizes() {
        assert_eq!(count(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!((counted(1, "check"), counted(0, "check")), ("1 check".into(), "0 checks".into()));
        assert_eq!(duration(0.4321), "0.43 s");
        assert_eq!(duration(59.97), "1 min 00 s");
        assert_eq!(duration(3725.0), "1 h 02 min");
        assert_eq!(file_size(999), "999 bytes");
        assert_eq!(file_size(12_345), "12.3 kB");
    }
}
