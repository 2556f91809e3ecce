//! Lights.

use super::numbers::{Finite, NonNegative, Positive};
use super::placed::Placed;
use serde::Deserialize;

/// A light source.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct LightSource {
    /// Column and row, (0, 0) at the upper left; the centre by default.
    #[serde(default)]
    pub cell: Option<Placed<(usize, usize)>>,
    /// When it emits.
    #[serde(default)]
    pub emission: EmissionKind,
    /// Its intensity by direction.
    #[serde(default)]
    pub profile: Option<Placed<ProfileShape>>,
}

/// When a light source emits.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum EmissionKind {
    /// Always; its cell's profile is replaced after every step.
    #[default]
    Continuous,
    /// Once, before the first step.
    Impulse,
}

/// The intensity of a light source (W/rad) or the sensitivity of a receiver by direction.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum ProfileShape {
    /// The same in every direction.
    Isotropic(Positive),
    /// `max(0, cos(theta - theta0))^power`.
    Emitter {
        /// Brightest direction, degrees.
        theta_deg: Finite,
        /// 0 is spherical, 1 Lambertian, 2 a cone; larger values are narrower.
        power: NonNegative,
        /// Intensity in the brightest direction, W/rad.
        #[serde(default = "Positive::one")]
        intensity: Positive,
    },
    /// One sample.
    Pulse {
        /// Direction, degrees; must be a sample.
        theta_deg: Finite,
    },
    /// An expression in `theta` (radians), negative values clipped.
    Expression(Placed<String>),
}

impl Default for ProfileShape {
    fn default() -> Self {
        Self::Isotropic(Positive::one())
    }
}
