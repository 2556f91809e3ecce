//! Numbers of a run: what checks compare and charts draw.

mod fields;
mod gradients;
mod lights;
mod pulses;

pub(crate) use fields::mean_anisotropy;
pub(crate) use gradients::{difference as gradient_difference, inner_cells, ridge_columns};
pub(crate) use lights::{at_step, lobe_ratio, net_flux_ratio};
pub(crate) use pulses::summary;

use crate::comparison;
use crate::runs::{LightResult, Results, RunError};
use crate::settings::Settings;
use crate::settings::{axes_of, sample_of};
use crate::spec::{Check, Expectation, Quantity, SchemeConstant};
use crate::ways::{self, Ways};
use tigereye_core::{Directions, Field, StopReason, Tensor2, math};
use tigereye_ltg::LtgOutcome;
use tigereye_report::{CheckOutcome, Expected};
use tigereye_transport::{Scheme, SharedWeights, emitter, half_core_alpha_rad};

/// Measures and judges a check. What cannot be measured is not a number and fails.
pub(crate) fn check(check: &Check, settings: &Settings, results: &Results) -> Result<CheckOutcome, RunError> {
    let value = Measure { settings, results }.quantity(&check.quantity)?.unwrap_or(f64::NAN);
    let expected = match check.expect {
        Expectation::Near(v, t) => Expected::Near { value: v.get(), tolerance: t.get() },
        Expectation::NearRelative(v, t) => {
            Expected::Near { value: v.get(), tolerance: t.get() * v.get().abs() }
        }
        Expectation::AtMost(v) => Expected::AtMost(v.get()),
        Expectation::AtLeast(v) => Expected::AtLeast(v.get()),
    };
    Ok(CheckOutcome {
        name: check.name.clone(),
        value,
        expected,
        basis: check.basis.clone(),
        passed: expected.is_met_by(value),
    })
}

/// The largest value; not a number where any of them is not, or where there are none: such a check must fail.
fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |m: f64, v: f64| if m >= v || m.is_nan() { m } else { v };
    values.into_iter().reduce(larger).unwrap_or(f64::NAN)
}

struct Measure<'a> {
    settings: &'a Settings,
    results: &'a Results,
}

impl Measure<'_> {
    fn light(&self, run: &str) -> Option<&LightResult> {
        self.results.lights.get(run)
    }
    fn gradient(&self, run: &str) -> Option<&LtgOutcome> {
        self.results.gradients.get(run)
    }
    fn ways(&self, run: &str, to: (usize, usize)) -> Option<Ways> {
        Ways::of(self.settings, self.results, run, to)
    }
    fn field(&self, name: &str) -> Option<&Field<Tensor2>> {
        self.settings.fields.get(name)
    }

    fn quantity(&self, quantity: &Quantity) -> Result<Option<f64>, RunError> {
        use Quantity as Q;
        Ok(match quantity {
            Q::Scheme(constant) => Some(scheme_constant(*constant)),
            Q::EmitterFlux(power) => fine_directions().map(|d| emitter(d, 0.0, power.get()).integral()),
            Q::DeterminantError { field } => self.field(field).map(fields::determinant_error),
            Q::MajorAxisDeg { field, cell } => {
                self.field(field).and_then(|f| fields::major_axis_deg(f, *cell))
            }
            Q::MajorAxisError { field, phi_deg, axes } => match self.field(field) {
                Some(f) => Some(fields::major_axis_error_deg(f, axes_of(*axes, None, f), phi_deg)?),
                None => None,
            },
            Q::IsotropicShare { field } => self.field(field).map(fields::isotropic_share),
            Q::ZeroShare { field } => self.field(field).map(fields::zero_share),
            Q::TotalAnisotropyShare { field } => self.field(field).map(fields::total_anisotropy_share),
            Q::ComplexShare { field } => self.field(field).map(fields::complex_share),
            Q::LargestAxis { field } => self.field(field).map(fields::largest_axis),
            Q::OfPulses { runs, number, over } => {
                let pulses: Option<Vec<_>> =
                    runs.iter().map(|r| self.results.pulses.get(r).map(Vec::as_slice)).collect();
                pulses.map(|pulses| summary(&pulses, *number, *over))
            }
            Q::MapCorrelation { map, with } => comparison::map_correlation(map, with, self.results),
            Q::RidgeDistance { of, from, number } => comparison::distances(of, from, self.results)
                .map(|d| comparison::distance_number(&d, *number)),
            _ => self.light_quantity(quantity).or_else(|| self.gradient_quantity(quantity)),
        })
    }

    fn light_quantity(&self, quantity: &Quantity) -> Option<f64> {
        use Quantity as Q;
        match quantity {
            Q::Steps { run } => self.light(run).map(|r| r.work.steps as f64),
            Q::Stopped { run } => self.light(run).map(|r| f64::from(r.stop == StopReason::Converged)),
            Q::TotalEnergy { run } => self.light(run).map(|r| r.last.total_energy()),
            Q::EnergyDrift { run } => self.light(run).and_then(lights::energy_drift),
            Q::NetFluxRatio { run, distance } => self.light(run).and_then(|r| net_flux_ratio(r, *distance)),
            Q::LobeRatio { run, distance } => self.light(run).and_then(|r| lobe_ratio(r, *distance)),
            Q::EnergyOver { run, over, cell } => {
                let (a, b) = (self.light(run), self.light(over));
                a.zip(b).and_then(|(a, b)| lights::energy_over(a, b, *cell))
            }
            Q::WayLength { run, to } => self.ways(run, *to).map(|w| w.shortest.len() as f64),
            Q::WayExcess { run, to } => {
                self.ways(run, *to).and_then(|w| Some(w.brightest?.len() as f64 - w.shortest.len() as f64))
            }
            Q::WayDifference { run, to } => self.ways(run, *to)?.difference().map(|n| n as f64),
            Q::ShortestWays { run } => ways::solved_part(self.settings, self.results, run),
            Q::EnergyRatio { run, cell, over } => {
                self.light(run).and_then(|r| lights::energy_ratio(r, *cell, *over))
            }
            Q::RingShare { run, range } => {
                self.light(run).and_then(|r| lights::ring_share(r, range.0.get()..=range.1.get()))
            }
            Q::BoxShare { run, columns, rows } => {
                self.light(run).and_then(|r| lights::box_share(r, columns.0..=columns.1, rows.0..=rows.1))
            }
            Q::LightSymmetry { run, under } => {
                self.light(run).and_then(|r| lights::symmetry_error(r, *under))
            }
            Q::RadiusMean { run, step } => self.light(run)?.radii.get(*step).map(|r| r.0),
            Q::RadiusSpread { run, step } => self.light(run)?.radii.get(*step).map(|r| r.1),
            Q::FrontRoundness { run, step } => self.light(run).and_then(|r| lights::roundness(r, *step)),
            Q::LightDifference { run, from } => lights::difference(self.light(run)?, self.light(from)?),
            _ => None,
        }
    }

    fn gradient_quantity(&self, quantity: &Quantity) -> Option<f64> {
        use Quantity as Q;
        match quantity {
            Q::GradientRatio { run, deg, cell, over } => {
                let volume = &self.gradient(run)?.volume;
                let sample = sample_of(deg.get(), volume.directions()).ok()?;
                let at = |(x, y)| volume.value(tigereye_core::Cell::new(x, y), sample);
                Some(at(*cell)? / at(*over)?)
            }
            Q::GradientAt { run, cell, sample } => {
                self.gradient(run)?.volume.value(tigereye_core::Cell::new(cell.0, cell.1), *sample)
            }
            Q::GradientMax { run } => Some(worst(self.gradient(run)?.volume.values().iter().copied())),
            Q::GradientMean { run } => {
                let values = self.gradient(run)?.volume.values();
                Some(values.iter().sum::<f64>() / values.len() as f64)
            }
            Q::GradientLimited { run } => {
                let g = self.gradient(run)?;
                Some(g.limited as f64 / g.work.sources.max(1) as f64)
            }
            Q::RidgeColumnError { run, deg, column, rows } => gradients::ridge_column_error(
                &self.gradient(run)?.volume,
                deg.get(),
                column.get(),
                rows.0..=rows.1,
            ),
            Q::RidgeContrast { run, deg, column, rows } => {
                gradients::ridge_contrast(&self.gradient(run)?.volume, deg.get(), *column, rows.0..=rows.1)
            }
            Q::GradientSymmetry { run, under } => {
                gradients::symmetry_error(&self.gradient(run)?.volume, *under)
            }
            Q::GradientCorrelation { run, with } => {
                gradients::correlation(&self.gradient(run)?.volume, &self.gradient(with)?.volume)
            }
            Q::GradientDifference { run, from } => {
                gradient_difference(&self.gradient(run)?.volume, &self.gradient(from)?.volume)
            }
            _ => None,
        }
    }
}

/// Directions fine enough for smooth curves.
pub(crate) fn fine_directions() -> Option<Directions> {
    Directions::new(360).ok()
}

fn scheme_constant(constant: SchemeConstant) -> f64 {
    match constant {
        SchemeConstant::E1 => SharedWeights::Thesis.e1(),
        SchemeConstant::E2 => SharedWeights::Thesis.e2(),
        SchemeConstant::AlphaDeg => math::degrees(2.0 * half_core_alpha_rad()),
        SchemeConstant::WeightSumError => (8..=360)
            .step_by(8)
            .filter_map(|s| Directions::new(s).ok())
            .map(|d| {
                let scheme = Scheme::new(d, SharedWeights::Thesis);
                let error = |t| (scheme.weights(t).iter().sum::<f64>() - 1.0).abs();
                (0..d.count()).map(error).fold(0.0, f64::max)
            })
            .fold(0.0, f64::max),
    }
}
