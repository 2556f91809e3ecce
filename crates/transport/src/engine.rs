//! What every propagation engine does.

use crate::light::check_lights;
use crate::{Light, Scheme, Stopping, StoppingRule, TransportError};
use std::ops::ControlFlow;
use tigereye_core::{Cell, Field, LightDistribution, StopReason, TransmissionField, Work};

/// Everything that determines a propagation.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// Weights and lobes.
    pub scheme: &'a Scheme,
    /// Transmission of every cell.
    pub transmission: &'a TransmissionField,
    /// The lights, one per cell at most.
    pub lights: &'a [Light],
    /// When to end.
    pub stopping: Stopping,
}

impl Problem<'_> {
    /// Checks that the parts fit together.
    ///
    /// # Errors
    /// The first [`TransportError`] found.
    pub fn check(&self) -> Result<(), TransportError> {
        let directions = self.scheme.directions();
        if self.transmission.directions() != directions {
            let samples = self.transmission.directions().count();
            return Err(TransportError::TransmissionDirections { samples, expected: directions.count() });
        }
        self.stopping.check()?;
        check_lights(self.lights, self.transmission.grid(), directions)?;
        let in_wall = |light: &&Light| self.transmission.reflection(light.cell).is_some();
        match self.lights.iter().find(in_wall) {
            Some(Light { cell: Cell { x, y }, .. }) => Err(TransportError::LightInWall { x: *x, y: *y }),
            None => Ok(()),
        }
    }
}

impl Problem<'_> {
    /// The lights alone, before the first step.
    #[must_use]
    pub fn before_first_step(&self) -> LightDistribution {
        let (grid, directions) = (self.transmission.grid(), self.scheme.directions());
        let s = directions.count();
        let mut samples = vec![0.0; grid.cells() * s];
        for light in self.lights {
            let i = grid.index(light.cell) * s;
            samples[i..i + s].copy_from_slice(light.initial_profile(directions).samples());
        }
        LightDistribution::new(directions, samples, Field::from_fn(grid, |_| [0.0; 8]))
    }

    /// The outcome where no step is asked for.
    pub(crate) fn without_steps(&self) -> Option<Outcome> {
        (self.stopping.rule == StoppingRule::Steps(0)).then(|| Outcome {
            distribution: self.before_first_step(),
            stop: StopReason::StepLimit,
            work: Work::default(),
        })
    }
}

/// The state after a step, for those who watch.
pub trait StepView {
    /// Number of the step, from 1.
    fn step(&self) -> usize;
    /// Flux passed between cells in this step, W: the sum of Phi_k over cells and existing neighbours.
    fn total_flux(&self) -> f64;
    /// Energy in the grid after the step, W, the lights' own included.
    fn energy(&self) -> f64;
    /// The whole distribution after the step.
    fn distribution(&self) -> LightDistribution;
    /// Energy of every cell after the step, W: that of [`Self::distribution`], to the last bit.
    fn energies(&self) -> Field<f64> {
        self.distribution().energy()
    }
}

/// What a propagation leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The light after the last step.
    pub distribution: LightDistribution,
    /// Why it ended.
    pub stop: StopReason,
    /// What it cost.
    pub work: Work,
}

/// Called after every step; `Break` ends the propagation as the step limit would.
pub type Observer<'a> = dyn FnMut(&dyn StepView) -> ControlFlow<()> + 'a;

/// A way to compute the scheme. All engines give the same numbers up to rounding (1e-13 relative).
pub trait Engine {
    /// Name in experiment files, one word; unique among [`crate::ENGINES`].
    fn id(&self) -> &'static str;

    /// Name for reports.
    fn name(&self) -> &'static str;

    /// Propagates until the stopping rule is met, showing every step to `observe`.
    ///
    /// # Errors
    /// What [`Problem::check`] finds.
    fn propagate_observed(
        &self,
        problem: &Problem<'_>,
        observe: &mut Observer<'_>,
    ) -> Result<Outcome, TransportError>;

    /// Propagates until the stopping rule is met.
    ///
    /// # Errors
    /// What [`Problem::check`] finds.
    fn propagate(&self, problem: &Problem<'_>) -> Result<Outcome, TransportError> {
        self.propagate_observed(problem, &mut |_| ControlFlow::Continue(()))
    }
}
