//! The numbers of an experiment that snapshot tests remember.

use crate::measure::{inner_cells, mean_anisotropy};
use crate::pulses::PulseRecord;
use crate::runs::{LightResult, Results};
use crate::settings::Settings;
use crate::spec::PulseNumber;
use serde::Serialize;
use std::collections::BTreeMap;
use tigereye_core::Surface;
use tigereye_lines::Ftle;
use tigereye_ltg::LtgOutcome;
use tigereye_report::ExperimentOutcome;

/// Shapes, extrema, quantiles, counters and checks of an experiment. Numbers are rounded to nine digits; what is smaller
/// than 1e-9 is rounding noise of the computation and kept as `~0`.
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
struct LightDigest {
    directions: usize,
    steps: usize,
    stop: String,
    cell_updates: u64,
    total_energy: String,
    /// Smallest, quartiles and largest energy of a cell.
    energy_quantiles: [String; 5],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct GradientDigest {
    directions: usize,
    slices: usize,
    sources: u64,
    iterations_total: u64,
    iterations_max: u64,
    cell_updates: u64,
    limited: u64,
    mean: String,
    /// Smallest, quartiles and largest value of an inner cell.
    quantiles: [String; 5],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct PulsesDigest {
    pulses: usize,
    settled: usize,
    /// Steps or evaluations of all pulses.
    stopped_steps: String,
    plain_steps: String,
    evaluations: String,
    /// Smallest, quartiles and largest of the pulses.
    stopped_distance: [String; 5],
    missing_energy: [String; 5],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct FtleDigest {
    samples: usize,
    lines: usize,
    left: String,
    /// Smallest, quartiles and largest of the larger exponents.
    quantiles: [String; 5],
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
pub(crate) fn digest(settings: &Settings, results: &Results, outcome: &ExperimentOutcome) -> Digest {
    let fields = settings.fields.iter().map(|(name, f)| {
        let largest = f.values().iter().map(tigereye_core::Tensor2::max_abs).fold(0.0, f64::max);
        let digest = FieldDigest {
            width: f.grid().width(),
            height: f.grid().height(),
            mean_planar_anisotropy: rounded(mean_anisotropy(f)),
            largest_component: rounded(largest),
        };
        (name.clone(), digest)
    });
    let scenes = settings.scenes.iter().map(|(name, s)| {
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
    Digest {
        slug: settings.slug.clone(),
        fields: fields.collect(),
        scenes: scenes.collect(),
        lights: results.lights.iter().map(|(n, r)| (n.clone(), light(r))).collect(),
        gradients: results.gradients.iter().map(|(n, g)| (n.clone(), gradient(g))).collect(),
        pulses: results.pulses.iter().map(|(n, p)| (n.clone(), pulses(p))).collect(),
        ftle: results.ftle.iter().map(|(n, f)| (n.clone(), exponents(f))).collect(),
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
    }
}

fn light(result: &LightResult) -> LightDigest {
    LightDigest {
        directions: result.last.directions().count(),
        steps: result.work.steps,
        stop: format!("{:?}", result.stop),
        cell_updates: result.work.cell_updates,
        total_energy: rounded(result.last.total_energy()),
        energy_quantiles: quantiles(result.last.energy().values().to_vec()),
    }
}

fn gradient(outcome: &LtgOutcome) -> GradientDigest {
    let (volume, work) = (&outcome.volume, &outcome.work);
    let values = volume.slices().iter().flat_map(|&t| {
        inner_cells(volume.grid()).filter_map(move |c| volume.value(c, t)).collect::<Vec<_>>()
    });
    GradientDigest {
        directions: volume.directions().count(),
        slices: volume.slices().len(),
        sources: work.sources,
        iterations_total: work.iterations_total,
        iterations_max: work.iterations_max,
        cell_updates: work.cell_updates,
        limited: outcome.limited,
        mean: rounded(volume.values().iter().sum::<f64>() / volume.values().len().max(1) as f64),
        quantiles: quantiles(values.collect()),
    }
}

fn exponents(found: &Ftle) -> FtleDigest {
    let finite: Vec<f64> = found.larger.values().iter().copied().filter(|v| v.is_finite()).collect();
    FtleDigest {
        samples: found.samples,
        lines: 2 * finite.len(),
        left: rounded(found.left),
        quantiles: quantiles(finite),
    }
}

fn pulses(records: &[PulseRecord]) -> PulsesDigest {
    let all = |number| records.iter().map(|p| p.number(number)).collect::<Vec<f64>>();
    let sum = |number| all(number).iter().sum::<f64>().to_string();
    PulsesDigest {
        pulses: records.len(),
        settled: all(PulseNumber::Settled).iter().filter(|s| **s == 1.0).count(),
        stopped_steps: sum(PulseNumber::StoppedSteps),
        plain_steps: sum(PulseNumber::PlainSteps),
        evaluations: sum(PulseNumber::Evaluations),
        stopped_distance: quantiles(all(PulseNumber::StoppedDistance)),
        missing_energy: quantiles(all(PulseNumber::MissingEnergy)),
    }
}

fn quantiles(mut values: Vec<f64>) -> [String; 5] {
    values.sort_unstable_by(f64::total_cmp);
    std::array::from_fn(|i| match values.len() {
        0 => "none".to_owned(),
        n => rounded(values[i * (n - 1) / 4]),
    })
}

/// Nine digits, or `~0` for rounding noise.
fn rounded(x: f64) -> String {
    if x == 0.0 {
        "0".to_owned()
    } else if x.abs() < 1e-9 {
        "~0".to_owned()
    } else {
        format!("{x:.8e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_keeps_nine_digits_and_hides_noise() {
        assert_eq!(rounded(std::f64::consts::PI), "3.14159265e0");
        assert_eq!(
            (rounded(-3e-14), rounded(0.0), rounded(f64::NAN)),
            ("~0".into(), "0".into(), "NaN".into())
        );
    }

    #[test]
    fn quantiles_are_order_statistics() {
        let q = quantiles(vec![4.0, 0.0, 3.0, 1.0, 2.0]);
        assert_eq!(q[2], "2.00000000e0");
        assert_eq!(quantiles(Vec::new())[0], "none");
    }
}
