//! Numbers that are in range once they exist. Checking them while the file is read gives every error its line and
//! column.

use serde::Deserialize;
use tigereye_core::Directions;
use tigereye_fields::images::MAX_SIGMA;

macro_rules! checked_number {
    ($(#[$doc:meta])* $name:ident, $test:expr, $expected:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Deserialize, PartialEq, PartialOrd)]
        #[serde(try_from = "f64")]
        pub struct $name(f64);

        impl $name {
            /// The number.
            #[must_use]
            pub const fn get(self) -> f64 {
                self.0
            }
        }

        impl TryFrom<f64> for $name {
            type Error = String;
            fn try_from(x: f64) -> Result<Self, String> {
                let in_range: fn(f64) -> bool = $test;
                if in_range(x) { Ok(Self(x)) } else { Err(format!("{x} is out of range: expected {}", $expected)) }
            }
        }
    };
}

checked_number!(
    /// A finite number.
    Finite, |x| x.is_finite(), "a finite number"
);
checked_number!(
    /// A finite number above 0.
    Positive, |x| x.is_finite() && x > 0.0, "a finite number above 0"
);
checked_number!(
    /// A finite number from 0.
    NonNegative, |x| x.is_finite() && x >= 0.0, "a finite number from 0"
);
checked_number!(
    /// A ratio from 1 to 1e12.
    Ratio, |x| (1.0..=1e12).contains(&x), "a number from 1 to 1e12"
);
checked_number!(
    /// A number from 0 to 1.
    Fraction, |x| (0.0..=1.0).contains(&x), "a number from 0 to 1"
);

checked_number!(
    /// Standard deviation of a Gaussian, cells.
    Sigma, |x| (0.0..=MAX_SIGMA).contains(&x), "0 to 100 cells"
);

impl Positive {
    pub(crate) const fn one() -> Self {
        Self(1.0)
    }
}

impl Fraction {
    pub(crate) const fn one() -> Self {
        Self(1.0)
    }
}

/// A number of directions, a multiple of 8.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(try_from = "usize")]
pub struct DirectionCount(pub Directions);

impl TryFrom<usize> for DirectionCount {
    type Error = String;
    fn try_from(samples: usize) -> Result<Self, String> {
        Directions::new(samples).map(Self).map_err(|e| e.to_string())
    }
}

impl Default for DirectionCount {
    fn default() -> Self {
        match Directions::new(32) {
            Ok(d) => Self(d),
            Err(_) => unreachable!("32 is a multiple of 8"),
        }
    }
}
