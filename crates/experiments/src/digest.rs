//! The numbers of an experiment that snapshot tests remember.

use crate::ids::RunId;
use crate::plan::Plan;
use crate::results::Results;
use crate::runs::{
    FtleDigest, GradientDigest, ImportanceDigest, LightDigest, PulsesDigest, RunOutcome, rounded,
};
use serde::Serialize;
use std::collections::BTreeMap;
use tigereye_core::{Anisotropy, Field, Surface, Tensor2};
use tigereye_report::ExperimentOutcome;

/// Shapes, extrema, quantiles, counters and checks of an experiment. Numbers are rounded to nine digits; what is
/// smaller than 1e-9 is rounding noise of the computation and kept as `~0`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Digest {
    slug: String,
    fields: BTreeMap<String, FieldDigest>,
    /// Scenes by the cells of each kind.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    scenes: BTreeMap<String, SceneDigest>,
    lights: BTreeMap<String, LightDigest>,
    gradients: BTreeMap<String, GradientDigest>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    importance: BTreeMap<String, ImportanceDigest>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pulses: BTreeMap<String, PulsesDigest>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    ftle: BTreeMap<String, FtleDigest>,
    figures: Vec<String>,
    /// Headings of tables, with their numbers of rows.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    tables: Vec<String>,
    checks: Vec<CheckDigest>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct FieldDigest {
    width: usize,
    height: usize,
    mean_planar_anisotropy: String,
    largest_component: String,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct SceneDigest {
    width: usize,
    height: usize,
    absorbing: usize,
    filters: usize,
    mirrors: usize,
    diffuse: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct CheckDigest {
    name: String,
    value: String,
    expected: String,
    passed: bool,
}

/// Digests an evaluated experiment.
#[must_use]
pub(crate) fn digest(plan: &Plan, results: &Results<'_>, outcome: &ExperimentOutcome) -> Digest {
    let fields = plan.media.fields.iter().map(|named| (named.name.clone(), of_field(&named.field)));
    let scenes = plan.media.scenes.iter().map(|(name, s)| {
        let count =
            |is: fn(&Surface) -> bool| s.layout.surfaces.values().iter().flatten().filter(|s| is(s)).count();
        let digest = SceneDigest {
            width: s.scene.grid.width(),
            height: s.scene.grid.height(),
            absorbing: count(|s| matches!(s, Surface::Absorbing)),
            filters: count(|s| matches!(s, Surface::Filter { .. })),
            mirrors: count(|s| matches!(s, Surface::Mirror { .. })),
            diffuse: count(|s| matches!(s, Surface::Diffuse { .. })),
        };
        (name.clone(), digest)
    });
    let mut digest = Digest {
        slug: plan.slug.clone(),
        fields: fields.collect(),
        scenes: scenes.collect(),
        lights: BTreeMap::new(),
        gradients: BTreeMap::new(),
        importance: BTreeMap::new(),
        pulses: BTreeMap::new(),
        ftle: BTreeMap::new(),
        figures: outcome
            .figures
            .iter()
            .map(|f| {
                let frames = match f.frames {
                    0 => String::new(),
                    n => format!(", {n} frames"),
                };
                format!("{} {}x{}{frames}", f.name, f.width_px.round(), f.height_px.round())
            })
            .collect(),
        tables: outcome.tables.iter().map(|t| format!("{}: {} rows", t.title, t.rows.len())).collect(),
        checks: outcome
            .checks
            .iter()
            .map(|c| CheckDigest {
                name: c.name.clone(),
                value: rounded(c.value),
                expected: c.expected.to_string(),
                passed: c.passed,
            })
            .collect(),
    };
    for (i, run) in plan.runs.iter().enumerate() {
        let name = || run.name.clone();
        match results.outcome(RunId(i)) {
            Some(RunOutcome::Light(light)) => _ = digest.lights.insert(name(), light.digest()),
            Some(RunOutcome::Gradient(gradient)) => _ = digest.gradients.insert(name(), gradient.digest()),
            Some(RunOutcome::Importance(found)) => _ = digest.importance.insert(name(), found.digest()),
            Some(RunOutcome::Pulses(pulses)) => _ = digest.pulses.insert(name(), pulses.digest()),
            Some(RunOutcome::Ftle(ftle)) => _ = digest.ftle.insert(name(), ftle.digest()),
            None => {}
        }
    }
    digest
}

fn of_field(field: &Field<Tensor2>) -> FieldDigest {
    let largest = field.values().iter().map(Tensor2::max_abs).fold(0.0, f64::max);
    let anisotropy = field.values().iter().map(|t| Anisotropy::of(t).planar).sum::<f64>();
    FieldDigest {
        width: field.grid().width(),
        height: field.grid().height(),
        mean_planar_anisotropy: rounded(anisotropy / field.values().len() as f64),
        largest_component: rounded(largest),
    }
}
