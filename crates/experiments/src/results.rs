//! Outcomes of all runs, by id.

use crate::ids::{FieldId, FrameId, FtleId, GradientId, ImportanceId, LightId, PulsesId, RunId, SliceId};
use crate::media::{Media, NamedField};
use crate::runs::{RunOutcome, ftle, gradient, importance, light, pulses};
use crate::unavailable::{OrUndefined, Unavailable};
use std::ops::Index;
use tigereye_core::{Field, LightDistribution};

/// What figures, tables and checks are made of. A plan names only runs that were made, so that no id misses its
/// outcome.
#[derive(Debug)]
pub(crate) struct Results<'a> {
    media: &'a Media,
    /// By [`RunId`]; `None` for runs of another scope.
    outcomes: Vec<Option<RunOutcome>>,
    /// Seconds that each of them took.
    seconds: Vec<Option<f64>>,
}

impl<'a> Results<'a> {
    pub(crate) const fn new(media: &'a Media) -> Self {
        Self { media, outcomes: Vec::new(), seconds: Vec::new() }
    }

    /// The outcome of the next run and its seconds; `None` where it is not made.
    pub(crate) fn push(&mut self, outcome: Option<(RunOutcome, f64)>) {
        let (outcome, seconds) = outcome.map_or((None, None), |(o, s)| (Some(o), Some(s)));
        self.outcomes.push(outcome);
        self.seconds.push(seconds);
    }

    pub(crate) fn field(&self, id: FieldId) -> &'a NamedField {
        self.media.field(id)
    }

    /// The outcome of a run, unless it is of another scope.
    pub(crate) fn outcome(&self, id: RunId) -> Option<&RunOutcome> {
        self.outcomes.get(id.0).and_then(Option::as_ref)
    }

    /// Seconds that a run took, unless it is of another scope.
    pub(crate) fn seconds(&self, id: RunId) -> Option<f64> {
        self.seconds.get(id.0).copied().flatten()
    }

    /// The distribution after a step.
    pub(crate) fn frame(&self, id: FrameId) -> Result<&LightDistribution, Unavailable> {
        let light = &self[id.light];
        let steps = light.work.steps;
        match id.step {
            None => Ok(&light.last),
            Some(wanted) if wanted == steps => Ok(&light.last),
            Some(wanted) => light.frames.get(&wanted).ok_or(Unavailable::BeforeStep { wanted, steps }),
        }
    }

    /// One direction of a gradient.
    pub(crate) fn slice(&self, id: SliceId) -> Result<Field<f64>, Unavailable> {
        self[id.gradient].volume().slice(id.sample).or_undefined("the direction is not among the slices")
    }
}

macro_rules! outcomes {
    ($($id:ident => $kind:ident($outcome:path)),* $(,)?) => {
        $(
            impl Index<$id> for Results<'_> {
                type Output = $outcome;

                fn index(&self, id: $id) -> &$outcome {
                    match self.outcome(id.0) {
                        Some(RunOutcome::$kind(outcome)) => outcome,
                        other => unreachable!("the plan gives {id:?} to a run that is made, found {other:?}"),
                    }
                }
            }
        )*
    };
}

outcomes! {
    LightId => Light(light::Outcome),
    GradientId => Gradient(gradient::Outcome),
    ImportanceId => Importance(importance::Outcome),
    PulsesId => Pulses(pulses::Outcome),
    FtleId => Ftle(ftle::Outcome),
}
