//! What commands of light say about a field and a result, on standard error: what to beware of, and what to try.

use crate::commands::{counted, in_digits};
use crate::medium::MediumInput;
use tigereye_core::{Below, LightDistribution, Normalization, ProfileRule, TransmissionField};
use tigereye_transport::{Light, Stopping, StoppingRule};
use tigereye_views::light::DECADES;
use tigereye_views::total_anisotropy::ThinCells;

/// The share of totally anisotropic cells, if there are any, and what it means.
pub(super) fn tell_thin(name: &str, thin: Option<&ThinCells>) {
    if let Some(thin) = thin {
        let share = thin.share_with_verb();
        let (rule, effect) = (thin.rule_in_words(), thin.effect_in_words());
        eprintln!("{name}: {share} totally anisotropic ({rule}){effect}");
    }
}

/// Steps after which light that has ended was never under way.
const FEW_STEPS: usize = 3;
/// Share of lit cells below which a picture is nearly blank.
const FEW_CELLS: f64 = 0.05;
/// Grids with fewer cells than this are lit by any light within a few steps.
const SMALL_GRID: usize = 200;
/// Share of totally anisotropic cells from which they are worth a word.
const MANY_THIN: f64 = 0.2;

/// A light, what it went through, and what came of it.
pub(super) struct Lit<'a> {
    pub(super) input: &'a MediumInput,
    pub(super) rule: ProfileRule,
    pub(super) transmission: &'a TransmissionField,
    pub(super) thin: Option<&'a ThinCells>,
    pub(super) lights: &'a [Light],
    pub(super) stopping: &'a Stopping,
    pub(super) light: &'a LightDistribution,
    /// How many steps it took, if it was not solved for.
    pub(super) steps: Option<usize>,
}

impl Lit<'_> {
    /// Says which lights are in cells that transmit nothing, and why, and what to try where hardly any cell is lit.
    pub(super) fn tell(&self) {
        let dark = self.dark_lights();
        for words in &dark {
            eprintln!("{}: {words}", self.input.name());
        }
        if dark.len() < self.lights.len()
            && let Some(words) = self.nearly_blank()
        {
            eprintln!("{}: {words}", self.input.name());
        }
    }

    /// The lights whose cells transmit nothing.
    fn dark_lights(&self) -> Vec<String> {
        let dark = self.lights.iter().filter(|light| self.transmission.rate(light.cell) == 0.0);
        let why = |light: &Light| {
            let tensor = self.input.tensor(light.cell)?;
            let reason = match self.rule.normalization {
                _ if tensor.is_zero() => "its tensor is zero".to_owned(),
                Normalization::LocalAbove { fraction, below: Below::Absorb } => {
                    format!(
                        "it transmits {} of the strongest cell, below the threshold of --normalization \
                         local-above:{fraction}; try a smaller one, --normalization local, or another cell",
                        in_digits((1e3 * self.strength(light)).round() / 1e3)
                    )
                }
                _ => "it absorbs all light".to_owned(),
            };
            Some(format!("the light at ({}, {}) lights no other cell: {reason}", light.cell.x, light.cell.y))
        };
        dark.filter_map(why).collect()
    }

    /// What the cell of a light transmits, relative to the strongest cell.
    fn strength(&self, light: &Light) -> f64 {
        let rule = ProfileRule { normalization: Normalization::Global, ..self.rule };
        let made = self.input.transmission(self.transmission.directions(), rule);
        made.map_or(f64::NAN, |transmission| transmission.rate(light.cell))
    }

    /// Why hardly any cell is lit, and what to try.
    fn nearly_blank(&self) -> Option<String> {
        let energy = self.light.energy();
        let cells = energy.values().len();
        let largest = energy.values().iter().fold(0.0_f64, |m, e| m.max(*e));
        let faintest = largest * tigereye_core::math::pow(10.0, -DECADES);
        let lit = energy.values().iter().filter(|e| **e > faintest).count();
        let asked_for = matches!(self.stopping.rule, StoppingRule::Steps(_));
        let ended = self.steps.filter(|steps| (1..=FEW_STEPS).contains(steps));
        if cells < SMALL_GRID || asked_for || !(ended.is_some() || (lit as f64) < FEW_CELLS * cells as f64) {
            return None;
        }
        let steps = ended.map_or_else(String::new, |steps| format!(" within {}", counted(steps, "step")));
        let share = 100.0 * lit as f64 / cells as f64;
        let mut words = format!("light reached {lit} of {cells} cells ({share:.1} %){steps}");
        for reason in self.reasons() {
            words += "; ";
            words += &reason;
        }
        Some(words)
    }

    fn reasons(&self) -> Vec<String> {
        let mut reasons = Vec::new();
        let step = self.transmission.directions().step_rad();
        let emitted: f64 = (self.lights.iter())
            .map(|light| {
                step * light.initial_profile(self.transmission.directions()).samples().iter().sum::<f64>()
            })
            .sum();
        let threshold = self.stopping.rule.threshold();
        if matches!(
            self.stopping.rule,
            StoppingRule::FluxChange { .. } | StoppingRule::DistributionChange { .. }
        ) && emitted < 4.0 * threshold
        {
            reasons.push(format!(
                "the lights emit {} W, and steps end where the flux changes by less than {}: try --threshold {} or --stop \
                 stationary",
                in_digits((1e4 * emitted).round() / 1e4),
                in_digits(threshold),
                format_args!("{:.0e}", 1e-3 * emitted)
            ));
        }
        if self.rule.normalization != Normalization::Local {
            let mut rates = self.transmission.rates().to_vec();
            rates.sort_by(f64::total_cmp);
            let median = rates[rates.len() / 2];
            if median < 0.5 {
                reasons.push(format!(
                    "with --normalization {} half of the cells pass on less than {:.1} % of what arrives: try \
                     --normalization local",
                    self.rule.normalization,
                    (100.0 * median).max(0.1)
                ));
            }
        }
        if let Some(thin) = self.thin.filter(|thin| thin.share() >= MANY_THIN) {
            reasons.push(format!(
                "{} totally anisotropic and absorb what comes from across: try --total-anisotropy cap",
                thin.share_with_verb()
            ));
        }
        if reasons.is_empty() {
            reasons.push("try another cell, or --stop stationary".to_owned());
        }
        reasons
    }
}
