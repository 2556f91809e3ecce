//! The scheme as the thesis writes it, sample by sample: slow, readable, and the judge of every faster engine.
//!
//! It uses nothing that those use beyond the problem, its light and the stopping rule; a test holds that.

use crate::stopping::{StepMeasures, Verdict};
use crate::{Emission, Engine, Observer, Outcome, Problem, ScatteringRule, StepView, TransportError};
use std::ops::ControlFlow;
use tigereye_core::{Cell, Field, LightDistribution, StopReason, Work};

/// Nothing passes below this fraction of the arriving light: `n_f` would be infinite and the result NaN.
const NOTHING_PASSES: f64 = 1e-290;

/// Propagates whole profiles of S samples (eqs. 3.12 to 3.14).
#[derive(Clone, Copy, Debug, Default)]
pub struct SampleSpace;

/// Intensities of all cells (cell-major, S each) and the fluxes that brought them.
#[derive(Clone)]
struct Buffer {
    samples: Vec<f64>,
    incoming: Vec<[f64; 8]>,
}

struct View<'a> {
    problem: &'a Problem<'a>,
    buffer: &'a Buffer,
    measures: StepMeasures,
}

impl Engine for SampleSpace {
    fn id(&self) -> &'static str {
        "SampleSpace"
    }

    fn name(&self) -> &'static str {
        "sample space"
    }

    fn propagate_observed(
        &self,
        problem: &Problem<'_>,
        observe: &mut Observer<'_>,
    ) -> Result<Outcome, TransportError> {
        problem.check()?;
        if let Some(outcome) = problem.without_steps() {
            return Ok(outcome);
        }
        let mut source = Buffer::dark(problem);
        place_lights(problem, &mut source, true);
        let mut measures = StepMeasures::default();
        let mut work = Work::default();
        let stop = loop {
            let mut target = Buffer::dark(problem);
            let (total_flux, cells) = step(problem, &source, work.steps == 0, &mut target);
            place_lights(problem, &mut target, false);
            work.steps += 1;
            work.cell_updates += cells;
            measures = StepMeasures {
                step: work.steps,
                previous_total_flux: measures.total_flux,
                total_flux,
                distribution_change: l1_change(problem, &source, &target),
                energy: target.energy(problem),
            };
            source = target;
            let view = View { problem, buffer: &source, measures };
            let broken = observe(&view) == ControlFlow::Break(());
            match problem.stopping.verdict(&measures) {
                Verdict::Converged => break StopReason::Converged,
                Verdict::StepLimit => break StopReason::StepLimit,
                Verdict::Continue if broken => break StopReason::StepLimit,
                Verdict::Continue => {}
            }
        };
        Ok(Outcome { distribution: source.distribution(problem), stop, work })
    }
}

/// One step from `source` to `target`: the total flux and the number of cells that passed light on.
fn step(problem: &Problem<'_>, source: &Buffer, first: bool, target: &mut Buffer) -> (f64, u64) {
    let scheme = problem.scheme;
    let grid = problem.transmission.grid();
    let s = scheme.directions().count();
    let mut total_flux = 0.0;
    let mut cells = 0;
    for y in 0..grid.height() {
        let mut row_flux = 0.0;
        for x in 0..grid.width() {
            let cell = Cell::new(x, y);
            let i = grid.index(cell);
            let intensity = &source.samples[i * s..(i + 1) * s];
            if intensity.iter().all(|&v| v == 0.0) {
                continue;
            }
            cells += 1;
            let phi = match problem.transmission.reflection(cell) {
                Some(wall) => wall.reflected(&source.incoming[i]),
                None => match scheme.scattering() {
                    ScatteringRule::Joint => outgoing_flux(problem, cell, intensity),
                    ScatteringRule::Linear => linear_flux(problem, cell, &source.incoming[i], first),
                },
            };
            for k in 0..8 {
                let Some(next) = grid.neighbour(cell, k) else { continue };
                let j = grid.index(next);
                for t in 0..s {
                    target.samples[j * s + t] += phi[k] * scheme.lobes(t)[k];
                }
                target.incoming[j][k] = phi[k];
                row_flux += phi[k];
            }
        }
        total_flux += row_flux;
    }
    (total_flux, cells)
}

/// `Phi_k = h sum_t w_k(t) n_f T(t) I(t)` with `n_f = Tbar mean(I) / mean(T I)` (eqs. 3.12 to 3.14), W.
fn outgoing_flux(problem: &Problem<'_>, cell: Cell, intensity: &[f64]) -> [f64; 8] {
    let scheme = problem.scheme;
    let s = scheme.directions().count();
    let h = scheme.directions().step_rad();
    let rate = problem.transmission.rate(cell);
    let transmitted: Vec<f64> =
        intensity.iter().zip(problem.transmission.shape(cell)).map(|(i, shape)| rate * shape * i).collect();
    let mean_i = intensity.iter().sum::<f64>() / s as f64;
    let mean_ti = transmitted.iter().sum::<f64>() / s as f64;
    let n_f = if mean_ti > rate * mean_i * NOTHING_PASSES { rate * mean_i / mean_ti } else { 0.0 };
    std::array::from_fn(|k| h * n_f * (0..s).map(|t| scheme.weights(t)[k] * transmitted[t]).sum::<f64>())
}

/// The outgoing flux (W) where every photon goes its own way (eq. 3.15): that of each arriving lobe alone, and of each
/// sample of a light alone.
fn linear_flux(problem: &Problem<'_>, cell: Cell, incoming: &[f64; 8], first: bool) -> [f64; 8] {
    let scheme = problem.scheme;
    let s = scheme.directions().count();
    let mut total = [0.0; 8];
    let mut pass_alone = |intensity: &[f64]| {
        let phi = outgoing_flux(problem, cell, intensity);
        total.iter_mut().zip(phi).for_each(|(total, phi)| *total += phi);
    };
    for (j, a) in incoming.iter().enumerate().filter(|(_, a)| **a != 0.0) {
        pass_alone(&(0..s).map(|t| a * scheme.lobes(t)[j]).collect::<Vec<_>>());
    }
    let shines = |emission: &Emission| first || !matches!(emission, Emission::Impulse(_));
    for light in problem.lights.iter().filter(|light| light.cell == cell && shines(&light.emission)) {
        let profile = light.initial_profile(scheme.directions());
        for t in (0..s).filter(|&t| profile.samples()[t] != 0.0) {
            pass_alone(&(0..s).map(|u| if u == t { profile.samples()[t] } else { 0.0 }).collect::<Vec<_>>());
        }
    }
    total
}

/// Sets what the lights prescribe: everything before the first step, the lasting parts after each.
fn place_lights(problem: &Problem<'_>, buffer: &mut Buffer, first: bool) {
    let directions = problem.scheme.directions();
    let s = directions.count();
    for light in problem.lights {
        let i = problem.transmission.grid().index(light.cell);
        let profile = &mut buffer.samples[i * s..(i + 1) * s];
        match &light.emission {
            Emission::Impulse(_) if !first => {}
            // Superposed on what arrives.
            _ if problem.scheme.scattering() == ScatteringRule::Linear => {
                let own = light.initial_profile(directions);
                profile.iter_mut().zip(own.samples()).for_each(|(v, own)| *v += own);
            }
            Emission::Impulse(_) | Emission::Continuous(_) => {
                profile.copy_from_slice(light.initial_profile(directions).samples());
            }
            Emission::Pulse { sample } => profile[*sample] = s as f64,
        }
    }
}

/// `sum_cells h sum_t |I_n - I_(n-1)|`, W.
fn l1_change(problem: &Problem<'_>, a: &Buffer, b: &Buffer) -> f64 {
    let h = problem.scheme.directions().step_rad();
    h * a.samples.iter().zip(&b.samples).map(|(a, b)| (a - b).abs()).sum::<f64>()
}

impl Buffer {
    fn dark(problem: &Problem<'_>) -> Self {
        let cells = problem.transmission.grid().cells();
        Self {
            samples: vec![0.0; cells * problem.scheme.directions().count()],
            incoming: vec![[0.0; 8]; cells],
        }
    }

    fn energy(&self, problem: &Problem<'_>) -> f64 {
        let directions = problem.scheme.directions();
        let row = problem.transmission.grid().width() * directions.count();
        directions.step_rad() * self.samples.chunks(row).map(|r| r.iter().sum::<f64>()).sum::<f64>()
    }

    fn distribution(&self, problem: &Problem<'_>) -> LightDistribution {
        let grid = problem.transmission.grid();
        let incoming = Field::from_fn(grid, |c| self.incoming[grid.index(c)]);
        LightDistribution::new(problem.scheme.directions(), self.samples.clone(), incoming)
    }
}

impl StepView for View<'_> {
    fn step(&self) -> usize {
        self.measures.step
    }
    fn total_flux(&self) -> f64 {
        self.measures.total_flux
    }
    fn energy(&self) -> f64 {
        self.measures.energy
    }
    fn distribution(&self) -> LightDistribution {
        self.buffer.distribution(self.problem)
    }
}
