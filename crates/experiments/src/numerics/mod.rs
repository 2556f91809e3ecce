//! Numbers that several figures, tables and checks share.

pub(crate) mod gradient;
pub(crate) mod light;
pub mod mirror;
pub(crate) mod paths;
pub mod pulses;

use tigereye_core::Directions;

/// The largest value; not a number where any of them is not, or where there are none: a check of it must fail.
pub(crate) fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |m: f64, v: f64| if m >= v || m.is_nan() { m } else { v };
    values.into_iter().reduce(larger).unwrap_or(f64::NAN)
}

/// Directions fine enough for smooth curves.
pub(crate) fn fine_directions() -> Directions {
    match Directions::new(360) {
        Ok(directions) => directions,
        Err(_) => unreachable!("360 is a multiple of 8"),
    }
}
