//! Numbers that JSON does not have.

use serde::{Deserialize, Deserializer};

/// What a number is that is missing.
pub(crate) const fn not_a_number() -> f64 {
    f64::NAN
}

/// A number, or NaN for `null`.
pub(crate) fn nullable<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(deserializer)?.unwrap_or(f64::NAN))
}
