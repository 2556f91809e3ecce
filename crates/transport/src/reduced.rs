//! The reduced eight-lobe engine: the same numbers as [`crate::SampleSpace`] from eight fluxes a cell.

use crate::kernel::{Buffers, normalized, scattered, sum_of_eight};
use crate::linear::{self, Band};
use crate::scattering::{Lobes, NOTHING_PASSES, Scattering};
use crate::sectors::Sectors;
use crate::stopping::{StepMeasures, Verdict};
use crate::window::Window;
use crate::{
    Emission, Engine, Observer, Outcome, Problem, ScatteringRule, StepView, StoppingRule, TransportError,
};
use std::ops::ControlFlow;
use tigereye_core::{Cell, Field, LightDistribution, StopReason, Work};

/// Propagates eight fluxes a cell (module [`crate::Scattering`]).
#[derive(Clone, Copy, Debug, Default)]
pub struct EightLobe;

/// A light, prepared for stepping.
struct PreparedLight {
    cell: Cell,
    /// What the cell holds before the first step, W/rad.
    profile: Vec<f64>,
    /// What the profile passes on, W.
    flux: [f64; 8],
    kind: Kind,
}

enum Kind {
    Continuous,
    Impulse,
    /// `inject[k] = h w_k(t) T(t)`: what one W/rad in sample t adds to `(M a)_k`.
    Pulse {
        sample: usize,
        inject: [f64; 8],
    },
}

/// A propagation under way.
struct Run<'a> {
    problem: &'a Problem<'a>,
    field: Scattering<'a>,
    /// With linear scattering, the matrices of the cells.
    bands: Option<Vec<Band>>,
    sectors: Sectors,
    lights: Vec<PreparedLight>,
    buffers: Buffers,
    window: Window,
    measures: StepMeasures,
    work: Work,
}

impl Engine for EightLobe {
    fn id(&self) -> &'static str {
        "EightLobe"
    }

    fn name(&self) -> &'static str {
        "eight lobes"
    }

    /// With linear scattering, the stationary light is solved for instead of waited for.
    fn propagate(&self, problem: &Problem<'_>) -> Result<Outcome, TransportError> {
        let lasts = |light: &crate::Light| !matches!(light.emission, Emission::Impulse(_));
        match problem.stopping.rule {
            StoppingRule::Converged { tolerance }
                if problem.scheme.scattering() == ScatteringRule::Linear
                    && problem.lights.iter().all(lasts) =>
            {
                linear::stationary_light(problem, tolerance, &mut |_, _| ControlFlow::Continue(()))
            }
            _ => self.propagate_observed(problem, &mut |_| ControlFlow::Continue(())),
        }
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
        let Some(window) = Window::around(problem.lights.iter().map(|l| l.cell)) else {
            return Err(TransportError::NoLight);
        };
        let mut run = Run::new(problem, window);
        let stop = loop {
            run.advance();
            let broken = observe(&run) == ControlFlow::Break(());
            match problem.stopping.verdict(&run.measures) {
                Verdict::Converged => break StopReason::Converged,
                Verdict::StepLimit => break StopReason::StepLimit,
                Verdict::Continue if broken => break StopReason::StepLimit,
                Verdict::Continue => {}
            }
        };
        Ok(Outcome { distribution: run.distribution(), stop, work: run.work })
    }
}

impl<'a> Run<'a> {
    fn new(problem: &'a Problem<'a>, window: Window) -> Self {
        let mut lights: Vec<PreparedLight> = problem.lights.iter().map(|l| prepare(problem, l)).collect();
        let grid = problem.transmission.grid();
        lights.sort_by_key(|l| grid.index(l.cell));
        let field = Scattering::new(problem.scheme, problem.transmission);
        let bands = match problem.scheme.scattering() {
            ScatteringRule::Joint => None,
            ScatteringRule::Linear => Some(linear::bands(&field)),
        };
        Self {
            problem,
            field,
            bands,
            sectors: Sectors::new(problem.scheme),
            lights,
            buffers: Buffers::new(grid),
            window,
            measures: StepMeasures::default(),
            work: Work::default(),
        }
    }

    fn advance(&mut self) {
        let first = self.work.steps == 0;
        let specials: Vec<(Cell, Lobes)> =
            self.lights.iter().filter_map(|l| Some((l.cell, self.special_flux(l, first)?))).collect();
        let total_flux = self.buffers.step(&self.field, self.bands.as_deref(), self.window, &specials);
        self.work.steps += 1;
        self.work.cell_updates += self.window.cells();
        self.window = self.window.grown(self.buffers_grid());
        let mut measures = StepMeasures {
            step: self.work.steps,
            total_flux,
            previous_total_flux: self.measures.total_flux,
            ..StepMeasures::default()
        };
        if self.problem.stopping.needs_distribution_change() {
            measures.distribution_change = self.distribution_change(first);
            measures.energy = self.energy();
        }
        self.measures = measures;
    }

    fn buffers_grid(&self) -> tigereye_core::Grid {
        self.problem.transmission.grid()
    }

    /// What a light's cell passes on this step; `None` where its lobes tell.
    fn special_flux(&self, light: &PreparedLight, first: bool) -> Option<[f64; 8]> {
        if let Some(bands) = &self.bands {
            let index = self.buffers_grid().index(light.cell);
            let passed = linear::banded(&bands[index], &self.lobes_at(&self.buffers.from, light.cell));
            let shines = first || !matches!(light.kind, Kind::Impulse);
            return shines.then(|| std::array::from_fn(|k| passed[k] + light.flux[k]));
        }
        match &light.kind {
            Kind::Continuous => Some(light.flux),
            Kind::Impulse => first.then_some(light.flux),
            Kind::Pulse { sample, inject } => {
                let index = self.buffers_grid().index(light.cell);
                let a = self.lobes_at(&self.buffers.from, light.cell);
                let delta = self.missing_intensity(&a, *sample);
                let m = &self.field.cells[index];
                let ma = scattered(m, &a);
                let ma = std::array::from_fn(|k| ma[k] + inject[k] * delta);
                let energy = sum_of_eight(&a) + self.problem.scheme.directions().step_rad() * delta;
                Some(normalized(m.rate, energy, &ma))
            }
        }
    }

    /// What the pulse adds to its sample so that it holds the value S, W/rad.
    fn missing_intensity(&self, a: &[f64; 8], sample: usize) -> f64 {
        self.problem.scheme.directions().count() as f64 - self.problem.scheme.intensity(a, sample)
    }

    fn lobes_at(&self, state: &[Lobes], cell: Cell) -> [f64; 8] {
        state[self.buffers.padding.index(cell.x, cell.y)]
    }

    /// `sum_cells h sum_t |I_n - I_(n-1)|`, W. The light's own samples do not change, except where an impulse ends.
    fn distribution_change(&self, first: bool) -> f64 {
        let h = self.problem.scheme.directions().step_rad();
        let grid = self.buffers_grid();
        let mut total = 0.0;
        for y in self.window.y0..=self.window.y1 {
            let mut row = 0.0;
            for x in self.window.x0..=self.window.x1 {
                let cell = Cell::new(x, y);
                row += match self.lights.binary_search_by_key(&grid.index(cell), |l| grid.index(l.cell)) {
                    Ok(i) => self.light_change(&self.lights[i], first),
                    Err(_) => {
                        let (a, b) =
                            (self.lobes_at(&self.buffers.from, cell), self.lobes_at(&self.buffers.to, cell));
                        self.sectors.l1(&std::array::from_fn(|j| a[j] - b[j]))
                    }
                };
            }
            total += row;
        }
        h * total
    }

    /// `sum_t |I_n - I_(n-1)|` in a light's cell, W/rad.
    fn light_change(&self, light: &PreparedLight, first: bool) -> f64 {
        let now = self.lobes_at(&self.buffers.from, light.cell);
        let before = self.lobes_at(&self.buffers.to, light.cell);
        let scheme = self.problem.scheme;
        let s = scheme.directions().count();
        let lasts = !matches!(light.kind, Kind::Impulse);
        match &light.kind {
            _ if self.bands.is_some() && (lasts || !first) => {
                // What lasts is the same before and after; only what arrives changes.
                let before = |t| if first { 0.0 } else { scheme.intensity(&before, t) };
                (0..s).map(|t| (scheme.intensity(&now, t) - before(t)).abs()).sum()
            }
            Kind::Continuous => 0.0,
            Kind::Impulse if first => {
                (0..s).map(|t| (scheme.intensity(&now, t) - light.profile[t]).abs()).sum()
            }
            Kind::Impulse => {
                (0..s).map(|t| (scheme.intensity(&now, t) - scheme.intensity(&before, t)).abs()).sum()
            }
            Kind::Pulse { sample, .. } => (0..s)
                .filter(|t| t != sample)
                .map(|t| {
                    let before = if first { 0.0 } else { scheme.intensity(&before, t) };
                    (scheme.intensity(&now, t) - before).abs()
                })
                .sum(),
        }
    }
}

impl StepView for Run<'_> {
    fn step(&self) -> usize {
        self.work.steps
    }

    fn total_flux(&self) -> f64 {
        self.measures.total_flux
    }

    fn energy(&self) -> f64 {
        let h = self.problem.scheme.directions().step_rad();
        let mut total = 0.0;
        for y in self.window.y0..=self.window.y1 {
            let mut row = 0.0;
            for x in self.window.x0..=self.window.x1 {
                let a = self.lobes_at(&self.buffers.from, Cell::new(x, y));
                row += sum_of_eight(&a);
            }
            total += row;
        }
        for light in &self.lights {
            let a = self.lobes_at(&self.buffers.from, light.cell);
            total += match &light.kind {
                Kind::Continuous | Kind::Pulse { .. } if self.bands.is_some() => {
                    h * light.profile.iter().sum::<f64>()
                }
                Kind::Continuous => h * light.profile.iter().sum::<f64>() - a.iter().sum::<f64>(),
                Kind::Impulse => 0.0,
                Kind::Pulse { sample, .. } => h * self.missing_intensity(&a, *sample),
            };
        }
        total
    }

    fn distribution(&self) -> LightDistribution {
        let scheme = self.problem.scheme;
        let s = scheme.directions().count();
        let grid = self.buffers_grid();
        let incoming = Field::from_fn(grid, |c| self.lobes_at(&self.buffers.from, c));
        let mut samples = Vec::with_capacity(grid.cells() * s);
        for a in incoming.values() {
            samples.extend((0..s).map(|t| scheme.intensity(a, t)));
        }
        for light in &self.lights {
            let i = grid.index(light.cell) * s;
            match &light.kind {
                Kind::Continuous | Kind::Pulse { .. } if self.bands.is_some() => {
                    samples[i..i + s].iter_mut().zip(&light.profile).for_each(|(v, own)| *v += own);
                }
                Kind::Continuous => samples[i..i + s].copy_from_slice(&light.profile),
                Kind::Impulse => {}
                Kind::Pulse { sample, .. } => samples[i + sample] = s as f64,
            }
        }
        LightDistribution::new(scheme.directions(), samples, incoming)
    }

    fn energies(&self) -> Field<f64> {
        let scheme = self.problem.scheme;
        let (s, h) = (scheme.directions().count(), scheme.directions().step_rad());
        let grid = self.buffers_grid();
        Field::from_fn(grid, |cell| {
            let a = self.lobes_at(&self.buffers.from, cell);
            let light = self.lights.binary_search_by_key(&grid.index(cell), |l| grid.index(l.cell));
            let kind = light.ok().map(|i| (&self.lights[i].kind, &self.lights[i].profile));
            let sample = |t: usize| match kind {
                Some((Kind::Continuous | Kind::Pulse { .. }, profile)) if self.bands.is_some() => {
                    scheme.intensity(&a, t) + profile[t]
                }
                Some((Kind::Continuous, profile)) => profile[t],
                Some((Kind::Pulse { sample, .. }, _)) if t == *sample => s as f64,
                _ => scheme.intensity(&a, t),
            };
            h * (0..s).map(sample).sum::<f64>()
        })
    }
}

/// What a cell hands on of a profile that need not be made of lobes (eqs. 3.12 to 3.14), W.
fn flux_of_profile(problem: &Problem<'_>, cell: Cell, profile: &[f64]) -> [f64; 8] {
    let (directions, rate) = (problem.scheme.directions(), problem.transmission.rate(cell));
    let (mut arriving, mut passing, mut parts) = (0.0, 0.0, [0.0; 8]);
    for (t, (intensity, shape)) in profile.iter().zip(problem.transmission.shape(cell)).enumerate() {
        let passed = rate * shape * intensity;
        arriving += intensity;
        passing += passed;
        for (part, weight) in parts.iter_mut().zip(problem.scheme.weights(t)) {
            *part += weight * passed;
        }
    }
    let factor = if passing > rate * arriving * NOTHING_PASSES { rate * arriving / passing } else { 0.0 };
    parts.map(|part| directions.step_rad() * factor * part)
}

fn prepare(problem: &Problem<'_>, light: &crate::Light) -> PreparedLight {
    let directions = problem.scheme.directions();
    let profile = light.initial_profile(directions).samples().to_vec();
    let flux = match problem.scheme.scattering() {
        ScatteringRule::Joint => flux_of_profile(problem, light.cell, &profile),
        ScatteringRule::Linear => linear::emitted(problem.scheme, problem.transmission, light.cell, &profile),
    };
    let kind = match light.emission {
        Emission::Continuous(_) => Kind::Continuous,
        Emission::Impulse(_) => Kind::Impulse,
        Emission::Pulse { sample } => {
            let t = problem.transmission.shape(light.cell)[sample];
            let h = directions.step_rad();
            Kind::Pulse { sample, inject: problem.scheme.weights(sample).map(|w| h * w * t) }
        }
    };
    PreparedLight { cell: light.cell, profile, flux, kind }
}
