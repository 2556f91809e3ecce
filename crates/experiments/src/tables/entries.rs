//! Numbers as entries of tables.

/// What stands where there is nothing to say.
pub(crate) const NOTHING: &str = "\u{2013}";

pub(crate) fn shown(x: f64, text: String) -> String {
    if x.is_finite() { text } else { NOTHING.to_owned() }
}

pub(crate) fn whole(x: f64) -> String {
    shown(x, format!("{x:.0}"))
}

pub(crate) fn tenths(x: f64) -> String {
    shown(x, format!("{x:.1}"))
}

pub(crate) fn hundredths(x: f64) -> String {
    shown(x, format!("{x:.2}"))
}

pub(crate) fn percent(share: f64) -> String {
    shown(share, format!("{:.1}", 100.0 * share))
}

/// One digit and the power of ten: all that is meant by an error.
pub(crate) fn power(x: f64) -> String {
    let text = format!("{x:.0e}");
    let raised = |c: char| match c {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' | '3' => char::from(0xb0 + (c as u8 - b'0')),
        _ => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    };
    match text.split_once('e') {
        Some((digit, exponent)) if x > 0.0 => {
            shown(x, format!("{digit} \u{d7} 10{}", exponent.chars().map(raised).collect::<String>()))
        }
        _ => whole(x),
    }
}

/// Seconds to three digits and more.
pub(crate) fn seconds(s: f64) -> String {
    let decimals = match s {
        ..10.0 => 2,
        ..100.0 => 1,
        _ => 0,
    };
    shown(s, grouped(&format!("{s:.decimals$}")))
}

/// The digits before the decimal sign in groups of three.
pub(crate) fn grouped(number: &str) -> String {
    let end = number.find('.').unwrap_or(number.len());
    let mut out = String::new();
    for (i, c) in number.chars().enumerate() {
        if i > 0 && i < end && (end - i).is_multiple_of(3) {
            // Narrow no-break space: no reader takes it for a decimal sign.
            out.push('\u{202f}');
        }
        out.push(c);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_for_readers() {
        assert_eq!((whole(812.4), tenths(7.25), percent(0.0815)), ("812".into(), "7.2".into(), "8.2".into()));
        assert_eq!((power(3.2e-10), power(0.0)), ("3 \u{d7} 10\u{207b}\u{b9}\u{2070}".into(), "0".into()));
        assert_eq!(power(5e-23), "5 \u{d7} 10\u{207b}\u{b2}\u{b3}");
        assert_eq!((seconds(179_878.0), seconds(0.4)), ("179\u{202f}878".into(), "0.40".into()));
        assert_eq!((percent(f64::NAN), seconds(f64::INFINITY)), (NOTHING.into(), NOTHING.into()));
    }
}
