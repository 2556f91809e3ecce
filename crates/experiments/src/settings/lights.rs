//! Lights and their profiles.

use crate::spec::{self, ProfileShape};
use tigereye_core::{Cell, Directions, Grid, PolarProfile};
use tigereye_fields::Expression;
use tigereye_transport::{Light, emitter};

/// The sample at an angle, which must be one.
pub(crate) fn sample_of(degrees: f64, directions: Directions) -> Result<usize, String> {
    let t = directions.nearest(degrees);
    let off = (directions.angle_deg(t) - degrees).rem_euclid(360.0);
    if off.min(360.0 - off) < 1e-9 {
        Ok(t)
    } else {
        let step = 360.0 / directions.count() as f64;
        Err(format!(
            "{degrees} degrees is no sample of {}: expected a multiple of {step} degrees",
            directions.count()
        ))
    }
}

/// Lights with their profiles, and a sentence for each whose profile cannot be made. Lights without a cell stand in the centre.
#[must_use]
pub fn lights_of(
    sources: &[spec::LightSource],
    grid: Grid,
    directions: Directions,
) -> (Vec<Light>, Vec<String>) {
    let (mut lights, mut faults) = (Vec::new(), Vec::new());
    for source in sources {
        let cell = source.cell.map_or(grid.centre(), |(x, y)| Cell::new(x, y));
        match profile_of(&source.profile, directions) {
            Ok(profile) => lights.push(match source.emission {
                spec::EmissionKind::Continuous => Light::continuous(cell, profile),
                spec::EmissionKind::Impulse => Light::impulse(cell, profile),
            }),
            Err(problem) => faults.push(format!("light at ({}, {}): {problem}", cell.x, cell.y)),
        }
    }
    (lights, faults)
}

/// Samples of a light's profile.
///
/// # Errors
/// A sentence for an expression that cannot be read, or an angle that is no sample.
pub fn profile_of(shape: &ProfileShape, directions: Directions) -> Result<PolarProfile, String> {
    match shape {
        ProfileShape::Isotropic(i) => Ok(PolarProfile::constant(directions, i.get())),
        ProfileShape::Emitter { theta_deg, power, intensity } => {
            let theta = tigereye_core::math::radians(theta_deg.get());
            let unit = emitter(directions, theta, power.get());
            Ok(PolarProfile::from_fn(directions, |t| intensity.get() * unit.samples()[t]))
        }
        ProfileShape::Pulse { theta_deg } => {
            let sample = sample_of(theta_deg.get(), directions)?;
            Ok(PolarProfile::from_fn(
                directions,
                |t| if t == sample { directions.count() as f64 } else { 0.0 },
            ))
        }
        ProfileShape::Expression(text) => profile_of_expression(text, directions),
    }
}

/// Samples of an expression in `theta` (radians), negative values clipped.
///
/// # Errors
/// A sentence naming the place in the expression, or the sample that is not finite.
pub fn profile_of_expression(text: &str, directions: Directions) -> Result<PolarProfile, String> {
    let expression = Expression::parse(text, &["theta"]).map_err(|e| format!("`{text}`: {e}"))?;
    let samples = (0..directions.count()).map(|t| expression.eval(&[directions.angle_rad(t)])).collect();
    PolarProfile::from_samples(directions, samples)
        .map(PolarProfile::clipped)
        .map_err(|e| format!("`{text}`: {e}"))
}
