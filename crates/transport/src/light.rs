//! Sources of light.

use crate::TransportError;
use std::collections::BTreeSet;
use tigereye_core::{Cell, Directions, Grid, PolarProfile, math};

/// A light in one cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Where it is.
    pub cell: Cell,
    /// What it emits and when.
    pub emission: Emission,
}

/// What a light emits, and when.
#[derive(Clone, Debug, PartialEq)]
pub enum Emission {
    /// After every step the cell's whole profile is replaced by this one, W/rad (the thesis's viewer). What arrives at
    /// the light is absorbed.
    Continuous(PolarProfile),
    /// The profile is there before the first step and never again (impulse response, Fig. 3.3).
    Impulse(PolarProfile),
    /// After every step the one sample is set to the value S, so that its integral is 2 pi and its mean 1; what else
    /// arrived stays (the light transport gradient's delta pulse, section 3.5).
    Pulse {
        /// The sample.
        sample: usize,
    },
}

impl Light {
    /// A light that shines all the time.
    #[must_use]
    pub const fn continuous(cell: Cell, profile: PolarProfile) -> Self {
        Self { cell, emission: Emission::Continuous(profile) }
    }
    /// A light that flashes once.
    #[must_use]
    pub const fn impulse(cell: Cell, profile: PolarProfile) -> Self {
        Self { cell, emission: Emission::Impulse(profile) }
    }
    /// The gradient's delta pulse.
    #[must_use]
    pub const fn pulse(cell: Cell, sample: usize) -> Self {
        Self { cell, emission: Emission::Pulse { sample } }
    }

    /// The profile in the light's cell before the first step, W/rad; negative values are clipped to 0.
    #[must_use]
    pub fn initial_profile(&self, directions: Directions) -> PolarProfile {
        match &self.emission {
            Emission::Continuous(p) | Emission::Impulse(p) => p.clone().clipped(),
            Emission::Pulse { sample } => {
                let height = directions.count() as f64;
                PolarProfile::from_fn(directions, |t| if t == *sample { height } else { 0.0 })
            }
        }
    }
}

/// The emitter `max(0, cos(theta - theta0))^m` (Fig. 3.1): m = 0 spherical, m = 1 Lambert, m = 2 cone. Intensity 1
/// W/rad at its brightest; m = 0 shines equally in **all** directions.
#[must_use]
pub fn emitter(directions: Directions, theta0_rad: f64, m: f64) -> PolarProfile {
    PolarProfile::from_fn(directions, |t| {
        // 0^0 = 1 makes the spherical emitter whole.
        math::pow(math::cos(directions.angle_rad(t) - theta0_rad).max(0.0), m)
    })
}

/// Checks that the lights can be propagated in a grid with a sampling.
///
/// # Errors
/// The first fault: no light, one outside the grid, two in a cell, a dark one, one too bright for sums of it, another
/// sampling.
pub fn check_lights(lights: &[Light], grid: Grid, directions: Directions) -> Result<(), TransportError> {
    if lights.is_empty() {
        return Err(TransportError::NoLight);
    }
    let mut taken = BTreeSet::new();
    for light in lights {
        let Cell { x, y } = light.cell;
        if !grid.contains(light.cell) {
            return Err(TransportError::LightOutside { x, y, width: grid.width(), height: grid.height() });
        }
        if !taken.insert((y, x)) {
            return Err(TransportError::LightTwice { x, y });
        }
        match &light.emission {
            Emission::Pulse { sample } if *sample >= directions.count() => {
                return Err(TransportError::PulseSample {
                    x,
                    y,
                    sample: *sample,
                    samples: directions.count(),
                });
            }
            Emission::Pulse { .. } => {}
            Emission::Continuous(p) | Emission::Impulse(p) => {
                if p.directions() != directions {
                    let (samples, expected) = (p.samples().len(), directions.count());
                    return Err(TransportError::LightDirections { x, y, samples, expected });
                }
                if p.samples().iter().all(|&v| v <= 0.0) {
                    return Err(TransportError::DarkLight { x, y });
                }
                let largest = p.samples().iter().fold(0.0, |m: f64, &v| m.max(v));
                if largest > crate::error::BRIGHTEST {
                    return Err(TransportError::TooBright { x, y, largest });
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> Directions {
        Directions::new(16).expect("directions")
    }

    #[test]
    fn emitters_have_the_fluxes_of_their_kind() {
        let d = Directions::new(360).expect("directions");
        let flux = |m| emitter(d, 0.7, m).integral();
        assert!((flux(0.0) - math::TAU).abs() < 1e-12);
        // Lambert 2, cone pi/2, up to the sampling.
        assert!((flux(1.0) - 2.0).abs() < 1e-4);
        assert!((flux(2.0) - math::FRAC_PI_2).abs() < 1e-4);
    }

    #[test]
    fn pulse_has_mean_one() {
        let p = Light::pulse(Cell::new(0, 0), 3).initial_profile(directions());
        assert_eq!(p.mean(), 1.0);
        assert!((p.integral() - math::TAU).abs() < 1e-15);
    }

    #[test]
    fn impossible_lights_are_refused() {
        let g = Grid::new(3, 3).expect("a grid");
        let d = directions();
        let ball = || PolarProfile::constant(d, 1.0);
        let dark = PolarProfile::constant(d, -1.0);
        let check = |lights: &[Light]| check_lights(lights, g, d);
        assert_eq!(check(&[]), Err(TransportError::NoLight));
        let outside = Light::continuous(Cell::new(3, 0), ball());
        assert!(matches!(check(&[outside]), Err(TransportError::LightOutside { x: 3, y: 0, .. })));
        let here = Light::continuous(Cell::new(1, 1), ball());
        assert_eq!(check(&[here.clone(), here]), Err(TransportError::LightTwice { x: 1, y: 1 }));
        let dark = Light::impulse(Cell::new(0, 2), dark);
        assert_eq!(check(&[dark]), Err(TransportError::DarkLight { x: 0, y: 2 }));
        let bright = Light::continuous(Cell::new(2, 2), PolarProfile::constant(d, 1e101));
        assert_eq!(check(&[bright]), Err(TransportError::TooBright { x: 2, y: 2, largest: 1e101 }));
        let pulse = Light::pulse(Cell::new(0, 0), 16);
        assert!(matches!(check(&[pulse]), Err(TransportError::PulseSample { sample: 16, samples: 16, .. })));
    }
}
