//! Values of options: from their words, or what was expected.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use tigereye_core::{Choice, CoreError, Directions, Normalization, TotalAnisotropy};
use tigereye_fields::images::MAX_SIGMA;
use tigereye_input::formats::readable_extensions;
use tigereye_lines::Family;
use tigereye_ltg::{FEWEST_SKETCHES, MOST_SKETCHES, Shard};

pub(crate) fn parse_side(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 3..=1000) => Ok(n),
        _ => Err("expected 3 to 1000".to_owned()),
    }
}

pub(crate) fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x <= 60.0 => Ok(x),
        _ => Err("expected a number of seconds above 0, at most 60".to_owned()),
    }
}

pub(crate) fn parse_hours(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x <= 10_000.0 => Ok(x),
        _ => Err("expected a number of hours above 0, at most 10000".to_owned()),
    }
}

pub(crate) fn parse_directions(text: &str) -> Result<Directions, String> {
    let samples =
        text.parse().map_err(|_| format!("expected a multiple of 8 from 8 to {}", Directions::MAX))?;
    Directions::new(samples).map_err(|e| e.to_string())
}

pub(crate) fn parse_threshold(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("expected a finite number from 0".to_owned()),
    }
}

pub(crate) fn parse_count(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "expected a whole number from 0".to_owned())
}

pub(crate) fn parse_sketches(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(n @ FEWEST_SKETCHES..=MOST_SKETCHES) => Ok(n),
        _ => Err(format!("expected {FEWEST_SKETCHES} to {MOST_SKETCHES}")),
    }
}

/// Largest seed: JSON keeps whole numbers up to it.
const LARGEST_SEED: u64 = (1 << 53) - 1;

pub(crate) fn parse_seed(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(n @ 0..=LARGEST_SEED) => Ok(n),
        _ => Err(format!("expected 0 to {LARGEST_SEED}")),
    }
}

/// `3%` or `3`, as 0.03.
pub(crate) fn parse_percentage(text: &str) -> Result<f64, String> {
    match text.strip_suffix('%').unwrap_or(text).trim().parse::<f64>() {
        Ok(percent @ 0.2..=50.0) => Ok(percent / 100.0),
        _ => Err("expected a percentage from 0.2% to 50%".to_owned()),
    }
}

pub(crate) fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=1024) => Ok(n),
        _ => Err("expected 1 to 1024".to_owned()),
    }
}

pub(crate) fn parse_size(text: &str) -> Result<[usize; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.filter(|s| !s.contains(&0)).ok_or_else(|| "expected WIDTHxHEIGHT, for example 64x48".to_owned())
}

pub(crate) fn parse_cell(text: &str) -> Result<[usize; 2], String> {
    let cell = text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    cell.ok_or_else(|| "expected X,Y, for example 25,40".to_owned())
}

pub(crate) fn parse_sigma(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (0.0..=MAX_SIGMA).contains(&x) => Ok(x),
        _ => Err(format!("expected a number of cells from 0 to {MAX_SIGMA}")),
    }
}

pub(crate) fn parse_shard(text: &str) -> Result<Shard, String> {
    let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    let (index, count) = numbers.ok_or("expected K/N, for example 0/4")?;
    Shard::new(index, count).map_err(|e| e.to_string())
}

pub(crate) fn parse_bytes(text: &str) -> Result<u64, String> {
    let expected = || "expected a number of bytes, for example 2000000000, 800M or 2G".to_owned();
    let (digits, factor) = match text.char_indices().last() {
        Some((i, 'k' | 'K')) => (&text[..i], 1 << 10),
        Some((i, 'm' | 'M')) => (&text[..i], 1 << 20),
        Some((i, 'g' | 'G')) => (&text[..i], 1 << 30),
        _ => (text, 1),
    };
    let count: u64 = digits.parse().map_err(|_| expected())?;
    count.checked_mul(factor).filter(|b| *b > 0).ok_or_else(expected)
}

pub(crate) fn parse_normalization(text: &str) -> Result<Normalization, String> {
    text.parse().map_err(|e: CoreError| e.to_string())
}

pub(crate) fn parse_total_anisotropy(text: &str) -> Result<TotalAnisotropy, String> {
    text.parse().map_err(|e: CoreError| e.to_string())
}

/// What INPUT may be, for help texts.
pub(crate) fn input_help() -> String {
    format!(
        "A data file ({}), a field file (NAME.field.ron) or a generator, NAME or NAME:key=value,key=value",
        readable_extensions().replace(" or ", ", ").replace(',', "")
    )
}

/// What INPUT of commands of light may be, for help texts.
pub(crate) fn medium_help() -> String {
    input_help() + "; or a scene (NAME.scene.ron)"
}

/// The parser of a choice by name, with the descriptions for help texts.
pub(crate) fn choice<T: Choice>() -> impl TypedValueParser<Value = T> {
    let words = PossibleValuesParser::new(T::ALL.iter().map(|value| possible(*value)));
    words.try_map(|word| T::of_word(&word).ok_or("expected one of the words"))
}

/// Either family of axes, or both.
pub(crate) fn families() -> impl TypedValueParser<Value = &'static [Family]> {
    let one = Family::ALL.iter().map(|family| possible(*family));
    let words = PossibleValuesParser::new(one.chain([PossibleValue::new("both").help("Both")]));
    words.map(|word| match Family::ALL.iter().position(|f| f.word() == word) {
        Some(i) => &Family::ALL[i..=i],
        None => Family::ALL,
    })
}

fn possible(value: impl Choice) -> PossibleValue {
    // Without the full stop, which clap removes from doc comments as well.
    PossibleValue::new(value.word()).help(value.meaning().trim_end_matches('.'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_io::volume::{Axis, Crop, parse_slice};

    #[test]
    fn bytes_have_suffixes() {
        assert_eq!(parse_bytes("2G"), Ok(2 << 30));
        assert_eq!(parse_bytes("12"), Ok(12));
        assert!(
            parse_bytes("0").is_err() && parse_bytes("x").is_err() && parse_bytes("99999999999G").is_err()
        );
        assert!(parse_bytes("").is_err() && parse_bytes("ü").is_err());
    }

    #[test]
    fn slices_and_crops_are_spelled_as_documented() {
        assert_eq!(parse_slice("z=10"), Ok((Axis::Z, 10)));
        assert_eq!(Crop::parse("1:5,0:4"), Ok(Crop { x: [1, 5], y: [0, 4] }));
        for wrong in ["", "z", "w=1", "z=-1", "xy=1", "z=1.5"] {
            assert!(parse_slice(wrong).is_err(), "{wrong}");
        }
        for wrong in ["", "1:5", "5:5,0:1", "a:b,c:d", "1:5,4:0", "1,2,3,4"] {
            assert!(Crop::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn shards_count_from_zero() {
        assert_eq!(parse_shard("2/3").map(|s| (s.index(), s.count())), Ok((2, 3)));
        for wrong in ["3/3", "0/0", "1", "-1/3", "a/b", "0/3/4", "", "0/99999999999999999999"] {
            assert!(parse_shard(wrong).is_err_and(|e| e.contains("K/N")), "{wrong}");
        }
    }
}
