//! Numbers as people write them: the same text on every system.

use tigereye_core::math;

/// `value` with as many decimals as the distance `step` between labels asks for; powers of ten for very large or small
/// numbers.
#[must_use]
pub fn label(value: f64, step: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return if value.is_nan() {
            "not a number"
        } else if value > 0.0 {
            "∞"
        } else {
            "−∞"
        }
        .to_owned();
    }
    let exponent = decade(value.abs());
    if (-3..6).contains(&exponent) {
        return trimmed(value, decimals(step));
    }
    // Subnormal powers of ten have no reciprocal.
    let enlarged = if exponent < -290 { 1e20 } else { 1.0 };
    let unit = if exponent < -290 { power_of_ten(exponent + 20) } else { power_of_ten(exponent) };
    let mantissa = value * enlarged / unit;
    let digits = decimals(step * enlarged / unit).min(6);
    let text = trimmed(mantissa, digits);
    match text.as_str() {
        "1" => power_label(exponent),
        "−1" => format!("−{}", power_label(exponent)),
        _ => format!("{text}·{}", power_label(exponent)),
    }
}

/// `value` to `digits` significant digits.
#[must_use]
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return label(value, 1.0);
    }
    label(value, power_of_ten(decade(value.abs()) - digits + 1))
}

/// `10` with a superscript exponent, such as 10⁻³.
#[must_use]
pub fn power_label(exponent: i32) -> String {
    let digits = exponent.to_string();
    let raised = digits.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    });
    ['1', '0'].into_iter().chain(raised).collect()
}

/// Largest `e` with `10^e <= value`, for a positive finite value.
pub(crate) fn decade(value: f64) -> i32 {
    let guess = math::log10(value).floor() as i32;
    // The logarithm of a power of ten may fall just below it.
    if power_of_ten(guess + 1) <= value { guess + 1 } else { guess }
}

/// `10^exponent`, exact from 10^-22 to 10^22 up to one rounding.
pub(crate) fn power_of_ten(exponent: i32) -> f64 {
    math::pow(10.0, f64::from(exponent))
}

fn decimals(step: f64) -> usize {
    if !(step.is_finite() && step > 0.0) {
        return 3;
    }
    // A step of 0.25 needs one decimal more than its decade.
    let places = -decade(step * (1.0 + 1e-9));
    let scaled = step * power_of_ten(places);
    let more = i32::from((scaled - scaled.round()).abs() > 1e-6);
    usize::try_from(places + more).unwrap_or(0).min(9)
}

fn trimmed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}
