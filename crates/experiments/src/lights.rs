//! Lights and their profiles.

use crate::fault::SourceFault;
use crate::form::{EmissionKind, LightSource, Place, ProfileShape};
use std::collections::BTreeSet;
use tigereye_core::{Cell, Directions, Grid, PolarProfile};
use tigereye_fields::Expression;
use tigereye_transport::{Light, TransportError, check_lights, emitter};

/// The sample at an angle, which must be one.
pub fn sample_of(degrees: f64, directions: Directions) -> Result<usize, String> {
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

/// A value of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightValue {
    /// Where it stands.
    Cell,
    /// Its intensity by direction.
    Profile,
}

/// What is wrong with one light of several.
#[derive(Clone, Debug, PartialEq)]
pub struct LightFault {
    /// Which one.
    pub index: usize,
    /// Which of its values is faulty.
    pub value: LightValue,
    /// A sentence.
    pub problem: String,
    /// Where in the file, if it is a formula.
    pub place: Option<Place>,
}

/// Lights with their profiles. Those without a cell stand in the centre.
///
/// # Errors
/// Every light without a profile, outside of the grid, in the cell of another, or dark.
pub fn lights_of<'a>(
    sources: impl IntoIterator<Item = &'a LightSource>,
    grid: Grid,
    directions: Directions,
) -> Result<Vec<Light>, Vec<LightFault>> {
    let (mut lights, mut faults, mut taken) = (Vec::new(), Vec::new(), BTreeSet::new());
    for (index, source) in sources.into_iter().enumerate() {
        let cell = cell_of(source, grid);
        let Cell { x, y } = cell;
        let usual = ProfileShape::default();
        let shape = source.profile.as_ref().map_or(&usual, |profile| &**profile);
        let profile = match profile_of(shape, directions) {
            Ok(profile) => profile,
            Err(fault) => {
                let problem = format!("the light at ({x}, {y}): {fault}");
                faults.push(LightFault { index, value: LightValue::Profile, problem, place: fault.place });
                continue;
            }
        };
        let light = match source.emission {
            EmissionKind::Continuous => Light::continuous(cell, profile),
            EmissionKind::Impulse => Light::impulse(cell, profile),
        };
        let fault = match check_lights(std::slice::from_ref(&light), grid, directions) {
            Err(fault) => Some(fault),
            Ok(()) if !taken.insert((y, x)) => Some(TransportError::LightTwice { x, y }),
            Ok(()) => None,
        };
        if let Some(fault) = fault {
            let of_profile =
                matches!(fault, TransportError::DarkLight { .. } | TransportError::TooBright { .. });
            let value = if of_profile { LightValue::Profile } else { LightValue::Cell };
            faults.push(LightFault { index, value, problem: fault.to_string(), place: None });
        }
        lights.push(light);
    }
    if faults.is_empty() { Ok(lights) } else { Err(faults) }
}

/// Where a light stands.
pub(crate) fn cell_of(source: &LightSource, grid: Grid) -> Cell {
    source.cell.as_ref().map_or(grid.centre(), |cell| Cell::new(cell.0, cell.1))
}

/// Samples of a light's profile.
///
/// # Errors
/// A sentence for an expression that cannot be read, or an angle that is no sample.
pub fn profile_of(shape: &ProfileShape, directions: Directions) -> Result<PolarProfile, SourceFault> {
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
        ProfileShape::Expression(text) => {
            let expression = Expression::parse(text, &["theta"]).map_err(|e| SourceFault {
                problem: format!("`{text}`: {}", e.kind),
                place: Some(text.place().inside(e.line, e.column)),
            })?;
            Ok(sampled(text, &expression, directions)?)
        }
    }
}

/// Samples of an expression in `theta` (radians), negative values clipped.
///
/// # Errors
/// A sentence naming the place in the expression, or the sample that is not finite.
pub fn profile_of_expression(text: &str, directions: Directions) -> Result<PolarProfile, String> {
    let expression = Expression::parse(text, &["theta"]).map_err(|e| format!("`{text}`: {e}"))?;
    sampled(text, &expression, directions)
}

fn sampled(text: &str, expression: &Expression, directions: Directions) -> Result<PolarProfile, String> {
    let samples = (0..directions.count()).map(|t| expression.eval(&[directions.angle_rad(t)])).collect();
    PolarProfile::from_samples(directions, samples)
        .map(PolarProfile::clipped)
        .map_err(|e| format!("`{text}`: {e}"))
}
