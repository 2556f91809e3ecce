//! Stationary light and importance in the linear scheme.

use super::cells::LinearScattering;
use super::dissection::Operator;
use super::stationary::{Watch, stationary};
use crate::error::BRIGHTEST;
use crate::scattering::Scattering;
use crate::{Emission, Outcome, Problem, TransportError};
use tigereye_core::{Cell, Field, LightDistribution, StopReason, Work};

/// The stationary light of continuous lights and pulses, to a relative change of `tolerance` per step. Impulses have
/// none but darkness.
///
/// # Errors
/// What [`Problem::check`] finds, and [`TransportError::Unsettled`].
pub fn stationary_light(
    problem: &Problem<'_>,
    tolerance: f64,
    watch: &mut Watch<'_>,
) -> Result<Outcome, TransportError> {
    problem.check()?;
    let scattering = Scattering::new(problem.scheme, problem.transmission);
    let field = LinearScattering::new(&scattering);
    let (grid, directions) = (field.grid(), problem.scheme.directions());
    let mut q = vec![[0.0; 8]; grid.cells()];
    let lasting = || problem.lights.iter().filter(|light| !matches!(light.emission, Emission::Impulse(_)));
    for light in lasting() {
        let flux = field.emitted(light.cell, light.initial_profile(directions).samples());
        for (k, flux) in flux.into_iter().enumerate() {
            if let Some(there) = grid.neighbour(light.cell, k) {
                q[grid.index(there)][k] += flux;
            }
        }
    }
    let found = stationary(&field, Operator::Forward, &q, tolerance, watch)?;
    let s = directions.count();
    let mut samples = Vec::with_capacity(grid.cells() * s);
    for a in &found.lobes {
        samples.extend((0..s).map(|t| problem.scheme.intensity(a, t)));
    }
    for light in lasting() {
        let i = grid.index(light.cell) * s;
        let own = light.initial_profile(directions);
        samples[i..i + s].iter_mut().zip(own.samples()).for_each(|(v, own)| *v += own);
    }
    let incoming = Field::from_fn(grid, |cell| found.lobes[grid.index(cell)]);
    Ok(Outcome {
        distribution: LightDistribution::new(directions, samples, incoming),
        stop: StopReason::Converged,
        work: Work { steps: found.sweeps, cell_updates: (found.sweeps * grid.cells()) as u64 },
    })
}

/// What a receiver in one cell gets of the light that any cell emits in any direction.
///
/// The receiver weighs the intensity that arrives in its cell (W/rad) with a sensitivity per sample: it gets
/// `h sum_t sensitivity(t) I(t)`. The samples of the result say which part of a flux that is emitted in that cell and
/// direction gets there, in the stationary state; light that passes the receiver several times counts each time, and
/// what a light in the receiver's own cell emits counts when it comes back. The fluxes per lobe say the same of light
/// that arrives in a cell in each of the eight directions.
///
/// By the adjoint identity, the light that a receiver gets of a light with the intensity f is `h sum importance f`.
///
/// # Errors
/// [`TransportError::ReceiverOutside`], [`TransportError::ReceiverInWall`], [`TransportError::LightDirections`] for a
/// sensitivity of another sampling, [`TransportError::BlindReceiver`], [`TransportError::TooSensitive`], and
/// [`TransportError::Unsettled`].
pub fn importance(
    field: &LinearScattering<'_>,
    receiver: Cell,
    sensitivity: &[f64],
    tolerance: f64,
    watch: &mut Watch<'_>,
) -> Result<(LightDistribution, Work), TransportError> {
    let (grid, scheme) = (field.grid(), field.scheme());
    let (directions, Cell { x, y }) = (scheme.directions(), receiver);
    let s = directions.count();
    if !grid.contains(receiver) {
        return Err(TransportError::ReceiverOutside { x, y, width: grid.width(), height: grid.height() });
    }
    if field.transmission().reflection(receiver).is_some() {
        return Err(TransportError::ReceiverInWall { x, y });
    }
    if sensitivity.len() != s {
        return Err(TransportError::LightDirections { x, y, samples: sensitivity.len(), expected: s });
    }
    let largest = sensitivity.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if largest == 0.0 {
        return Err(TransportError::BlindReceiver { x, y });
    }
    if largest > BRIGHTEST {
        return Err(TransportError::TooSensitive { x, y, largest });
    }
    let weighed: Vec<f64> = sensitivity.iter().map(|v| v * directions.step_rad()).collect();
    let received = field.sampled_back(&weighed);
    // Followed back, light leaves the receiver to the cells from which each lobe arrives.
    let mut r = vec![[0.0; 8]; grid.cells()];
    for (j, received) in received.into_iter().enumerate() {
        let back = (j + 4) % 8;
        if let Some(behind) = grid.neighbour(receiver, back) {
            r[grid.index(behind)][back] += received;
        }
    }
    let found = stationary(field, Operator::Adjoint, &r, tolerance, watch)?;
    // What a flux of 1 W that leaves the cell towards neighbour k is worth.
    let leaving = |cell: Cell| -> [f64; 8] {
        let edges = &found.lobes[grid.index(cell)];
        std::array::from_fn(|k| edges[(k + 4) % 8])
    };
    let mut samples = Vec::with_capacity(grid.cells() * s);
    for cell in grid.iter() {
        let worth = leaving(cell);
        samples.extend((0..s).map(|t| {
            let flux = field.emitted_by_pulse(cell, t);
            flux.iter().zip(worth).map(|(flux, worth)| flux * worth).sum::<f64>() / tigereye_core::math::TAU
        }));
    }
    let arriving = Field::from_fn(grid, |cell| {
        let passed = field.passed_back(cell, &leaving(cell));
        std::array::from_fn(|j| passed[j] + if cell == receiver { received[j] } else { 0.0 })
    });
    let work = Work { steps: found.sweeps, cell_updates: (found.sweeps * grid.cells()) as u64 };
    Ok((LightDistribution::new(directions, samples, arriving), work))
}
