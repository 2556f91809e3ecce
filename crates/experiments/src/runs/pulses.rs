//! How pulses come to rest: the stopping rule's state, plain steps and the solver, compared.

use crate::form::{
    Chosen, DirectionCount, Finite, NormalizationRule, Placed, Scope, Stop, TotalAnisotropyRule,
};
use crate::host::Host;
use crate::ids::MediumId;
use crate::lights::sample_of;
use crate::media::Media;
use crate::runs::digest::{PulsesDigest, quantiles};
use crate::runs::error::RunError;
use crate::runs::setup::{RunResolver, Setup};
use rayon::prelude::*;
use serde::Deserialize;
use std::fmt::Write as _;
use std::sync::atomic::{AtomicU64, Ordering};
use tigereye_core::{Cell, Field, StopReason, TransmissionField};
use tigereye_io::IoError;
use tigereye_report::DataFile;
use tigereye_transport::{
    EightLobe, Engine, Level, Light, Problem, PulseDistribution, PulseSolver, Scattering, Scheme,
    SharedWeights, Stopping, StoppingRule, TransportError,
};

/// A number of a pulse. Only the fluxes between cells are compared, not the injected sample. All but the first two are
/// NaN if no stationary state was reached.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum PulseNumber {
    /// 1 if plain steps and the solver both reach the stationary state, otherwise 0.
    Settled,
    /// Steps until the run's stopping rule ends the propagation.
    StoppedSteps,
    /// Plain steps until the relative change of the distribution is at most 1e-10.
    PlainSteps,
    /// Evaluations of the scheme that the solver needs for the same change.
    Evaluations,
    /// Ratio of plain steps to evaluations.
    Saving,
    /// L1 distance of the stopped fluxes from the stationary ones over all cells and lobes, relative to the sum of the
    /// stationary ones.
    StoppedDistance,
    /// Share of the stationary energy that the stopped state lacks.
    MissingEnergy,
    /// Sum by which the stopped fluxes exceed the stationary ones, relative to the sum of the stationary ones: half the
    /// difference between the distance and the missing energy, 0 if the light only grows.
    Overshoot,
    /// L1 distance, as above, of the solver's state from that after many more steps.
    SolverError,
    /// The same for the state at which plain steps change by 1e-10.
    PlainError,
}

/// Plain steps after which light counts as caught: no field of the thesis needs a third of them.
const PLAIN_LIMIT: usize = 20_000;

/// Relative change of a plain step (1) at which its state stands for the exact one: four digits beyond the tolerance of
/// what is compared with it, and still above rounding.
const EXACT_TOLERANCE: f64 = 1e-14;

/// What one pulse shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PulseRecord {
    pub(crate) cell: Cell,
    pub(crate) sample: usize,
    /// Steps of the run's rule.
    stopped_steps: usize,
    plain_steps: usize,
    evaluations: usize,
    /// Whether plain steps and the solver both ended by their rules.
    settled: bool,
    /// Relative L1 distances over cells and lobes, and the missing share of the energy (1).
    stopped_distance: f64,
    missing_energy: f64,
    solver_error: f64,
    plain_error: f64,
}

impl PulseRecord {
    /// A number of this pulse.
    pub(crate) fn number(&self, number: PulseNumber) -> f64 {
        let settled = |x: f64| if self.settled { x } else { f64::NAN };
        match number {
            PulseNumber::Settled => f64::from(self.settled),
            PulseNumber::StoppedSteps => self.stopped_steps as f64,
            PulseNumber::PlainSteps => settled(self.plain_steps as f64),
            PulseNumber::Evaluations => settled(self.evaluations as f64),
            PulseNumber::Saving => settled(self.plain_steps as f64 / self.evaluations as f64),
            PulseNumber::StoppedDistance => settled(self.stopped_distance),
            PulseNumber::MissingEnergy => settled(self.missing_energy),
            PulseNumber::Overshoot => settled(0.5 * (self.stopped_distance - self.missing_energy)),
            PulseNumber::SolverError => settled(self.solver_error),
            PulseNumber::PlainError => settled(self.plain_error),
        }
    }
}

/// How pulses approach their stationary states: what a stopping rule misses of them, how many plain steps they take,
/// and how many evaluations the solver of gradients needs instead.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Pulses {
    /// Name of the field.
    field: Placed<String>,
    /// Angular samples S, a multiple of 8.
    #[serde(default)]
    directions: DirectionCount,
    /// How profiles are scaled.
    #[serde(default)]
    normalization: NormalizationRule,
    /// Which tensors transmit along one axis only.
    #[serde(default)]
    total_anisotropy: TotalAnisotropyRule,
    /// Cone weights of the overlap.
    #[serde(default)]
    weights: Chosen<SharedWeights>,
    /// The stopping rule that is compared with the stationary state.
    #[serde(default)]
    stop: Stop,
    /// Columns and rows of the cells from which pulses start.
    cells: Vec<(usize, usize)>,
    /// Directions of the pulses from each of these cells, degrees. Each must be a sample.
    angles_deg: Vec<Finite>,
    /// When it runs.
    #[serde(default)]
    pub(crate) scope: Scope,
}

/// Pulses, ready to start.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// Field and scheme; its rule is the one compared with the stationary state.
    pub(crate) setup: Setup,
    /// Cell and sample of each pulse, in the order of the file: a cell's samples follow each other.
    pub(crate) pulses: Vec<(Cell, usize)>,
}

impl Pulses {
    pub(crate) fn resolve(&self, run: &mut RunResolver<'_, '_>) -> Option<Plan> {
        let setup = run.setup(
            &self.field,
            self.directions,
            (self.normalization, self.total_anisotropy),
            self.weights,
            Chosen::default(),
            self.stop,
        )?;
        let grid = run.media.medium(setup.medium).grid();
        let before = run.faults.len();
        let mut samples = Vec::new();
        for deg in &self.angles_deg {
            match sample_of(deg.get(), setup.directions) {
                Ok(t) if samples.contains(&t) => {
                    run.fault(&format!(": {} degrees is listed twice", deg.get()))
                }
                Ok(t) => samples.push(t),
                Err(problem) => run.fault(&format!(": {problem}")),
            }
        }
        for (i, &(x, y)) in self.cells.iter().enumerate() {
            if !grid.contains(Cell::new(x, y)) {
                let (w, h) = (grid.width(), grid.height());
                run.fault(&format!(": cell ({x}, {y}) lies outside of the {w} x {h} cells"));
            } else if self.cells[..i].contains(&(x, y)) {
                run.fault(&format!(": cell ({x}, {y}) stands twice"));
            }
        }
        if self.cells.is_empty() || self.angles_deg.is_empty() {
            run.fault(" has no pulse: expected cells and angles");
        }
        let of_cell = |&(x, y): &(usize, usize)| samples.iter().map(move |&t| (Cell::new(x, y), t));
        let pulses = self.cells.iter().flat_map(of_cell).collect();
        (run.faults.len() == before).then_some(Plan { setup, pulses })
    }
}

/// What all pulses of a run show.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) records: Vec<PulseRecord>,
}

impl Plan {
    pub(crate) const fn medium(&self) -> MediumId {
        self.setup.medium
    }

    /// Follows every pulse to its stationary state, several at once.
    pub(crate) fn run(
        &self,
        name: &str,
        media: &Media,
        _memory_bytes: u64,
        host: &dyn Host,
    ) -> Result<Outcome, RunError> {
        let transmission = self.setup.transmission(name, media.medium(self.setup.medium))?;
        let scheme = Scheme::new(self.setup.directions, self.setup.weights);
        let scattering = Scattering::new(&scheme, &transmission);
        let study = Study { scheme: &scheme, transmission: &transmission, stopping: self.setup.stopping };
        let (done, total) = (AtomicU64::new(0), self.pulses.len() as u64);
        let solver = || PulseSolver::<f64>::new(&scattering, Level::detect());
        let follow = |solver: &mut PulseSolver<'_, f64>, &(cell, sample): &(Cell, usize)| {
            let finished = done.fetch_add(1, Ordering::Relaxed);
            if host.progress(name, finished, total).is_break() {
                return Err(RunError::Interrupted);
            }
            let failed = |source| RunError::Propagation { run: name.to_owned(), source };
            study.follow(solver, cell, sample).map_err(failed)
        };
        let records = self.pulses.par_iter().map_init(solver, follow).collect::<Result<_, _>>()?;
        Ok(Outcome { records })
    }
}

impl Outcome {
    pub(crate) fn work(&self) -> Vec<(&'static str, u64)> {
        let settled = |number| self.records.iter().map(move |p| p.number(number)).filter(|n| n.is_finite());
        let sum = |number| settled(number).sum::<f64>() as u64;
        vec![
            ("plain steps of all pulses that settle", sum(PulseNumber::PlainSteps)),
            ("evaluations of all pulses that settle", sum(PulseNumber::Evaluations)),
        ]
    }

    pub(crate) fn digest(&self) -> PulsesDigest {
        let all = |number| self.records.iter().map(|p| p.number(number)).collect::<Vec<f64>>();
        let sum = |number| all(number).iter().sum::<f64>().to_string();
        PulsesDigest {
            pulses: self.records.len(),
            settled: all(PulseNumber::Settled).iter().filter(|s| **s == 1.0).count(),
            stopped_steps: sum(PulseNumber::StoppedSteps),
            plain_steps: sum(PulseNumber::PlainSteps),
            evaluations: sum(PulseNumber::Evaluations),
            stopped_distance: quantiles(all(PulseNumber::StoppedDistance)),
            missing_energy: quantiles(all(PulseNumber::MissingEnergy)),
        }
    }

    /// Every pulse as comma-separated values.
    #[expect(clippy::unnecessary_wraps, reason = "as runs of the other kinds")]
    pub(crate) fn data(
        &self,
        _plan: &Plan,
        name: &str,
        _command: &str,
        _media: &Media,
    ) -> Result<DataFile, IoError> {
        let bytes = comma_separated(&self.records).into_bytes();
        Ok(DataFile { name: format!("{name}.pulses.csv"), bytes })
    }
}

/// What the pulses of a run share.
struct Study<'a> {
    scheme: &'a Scheme,
    transmission: &'a TransmissionField,
    stopping: Stopping,
}

/// Fluxes of every cell, W, with the number of steps they took.
struct Plain {
    lobes: Field<[f64; 8]>,
    steps: usize,
    stop: StopReason,
}

impl Study<'_> {
    fn plain(&self, cell: Cell, sample: usize, stopping: Stopping) -> Result<Plain, TransportError> {
        let lights = [Light::pulse(cell, sample)];
        let problem =
            Problem { scheme: self.scheme, transmission: self.transmission, lights: &lights, stopping };
        let outcome = EightLobe.propagate(&problem)?;
        let lobes = outcome.distribution.incoming().clone();
        Ok(Plain { lobes, steps: outcome.work.steps, stop: outcome.stop })
    }

    fn follow(
        &self,
        solver: &mut PulseSolver<'_, f64>,
        cell: Cell,
        sample: usize,
    ) -> Result<PulseRecord, TransportError> {
        let until =
            |tolerance| Stopping { rule: StoppingRule::Converged { tolerance }, max_iterations: PLAIN_LIMIT };
        let stopped = self.plain(cell, sample, self.stopping)?;
        let plain = self.plain(cell, sample, until(Stopping::STATIONARY.rule.threshold()))?;
        let mut solved = [PulseDistribution::dark(self.transmission.grid().cells())];
        let outcome = solver.solve(cell, &[sample], &Stopping::STATIONARY, &mut solved)[0];
        let settled = [plain.stop, outcome.stop] == [StopReason::Converged; 2];
        // Where light is caught there is nothing exact to step to.
        let exact = if settled {
            self.plain(cell, sample, until(EXACT_TOLERANCE))?.lobes
        } else {
            plain.lobes.clone()
        };
        let exact = exact.values();
        Ok(PulseRecord {
            cell,
            sample,
            stopped_steps: stopped.steps,
            plain_steps: plain.steps,
            evaluations: outcome.work.steps,
            settled,
            stopped_distance: distance(stopped.lobes.values(), exact),
            missing_energy: share(energy(exact) - energy(stopped.lobes.values()), energy(exact)),
            solver_error: distance(solved[0].lobes(), exact),
            plain_error: distance(plain.lobes.values(), exact),
        })
    }
}

/// Sum of all fluxes, W.
fn energy(lobes: &[[f64; 8]]) -> f64 {
    lobes.iter().flatten().sum()
}

/// L1 distance of fluxes over the sum of the second ones (1).
fn distance(a: &[[f64; 8]], b: &[[f64; 8]]) -> f64 {
    share(a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).sum(), energy(b))
}

/// `part / whole`, but 0 if the part is 0, even if the whole is 0 too (a pulse that no cell passes on).
fn share(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

/// Every pulse of a run as comma-separated values.
pub(crate) fn comma_separated(records: &[PulseRecord]) -> String {
    let mut text = String::from(
        "column,row,sample,settled,stopped_steps,plain_steps,evaluations,stopped_distance,missing_energy,solver_error,plain_error\n",
    );
    for r in records {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{:?},{:?},{:?},{:?}",
            r.cell.x,
            r.cell.y,
            r.sample,
            r.settled,
            r.stopped_steps,
            r.plain_steps,
            r.evaluations,
            r.stopped_distance,
            r.missing_energy,
            r.solver_error,
            r.plain_error,
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::FieldId;
    use crate::media::NamedField;
    use tigereye_core::{CellShape, Directions, Grid, Normalization, Svd, Tensor2};
    use tigereye_transport::ScatteringRule;

    fn no_file(path: &str) -> Result<Vec<u8>, String> {
        Err(path.to_owned())
    }

    fn records(field: &Field<Tensor2>, pulses: &[(Cell, usize)]) -> Vec<PulseRecord> {
        let setup = Setup {
            medium: MediumId::Field(FieldId(0)),
            directions: Directions::new(16).expect("a multiple of 8"),
            rule: Normalization::Local.into(),
            weights: SharedWeights::Thesis,
            scattering: ScatteringRule::Joint,
            stopping: Stopping::REFERENCE,
        };
        let named = NamedField {
            name: String::new(),
            field: field.clone(),
            cell: CellShape::SQUARE,
            geometry: tigereye_io::volume::PlaneGeometry::UNPLACED,
            unit: None,
        };
        let media = Media { fields: vec![named], scenes: Vec::new() };
        Plan { setup, pulses: pulses.to_vec() }.run("run", &media, 0, &no_file).expect("pulses").records
    }

    #[test]
    fn a_stopped_pulse_in_an_isotropic_field_lacks_light_and_exceeds_nowhere() {
        let field = Field::from_fn(Grid::new(15, 15).expect("a grid"), |_| Tensor2::IDENTITY);
        let [r] = records(&field, &[(Cell::new(7, 6), 3)])[..] else { panic!("one pulse") };
        assert!(r.settled && r.stopped_steps < r.plain_steps && 3 * r.evaluations < r.plain_steps, "{r:?}");
        assert!(r.missing_energy > 0.02 && r.number(PulseNumber::Overshoot).abs() < 1e-12, "{r:?}");
        assert!(r.solver_error < r.plain_error && r.plain_error < 1e-7, "{r:?}");
    }

    #[test]
    fn a_pulse_that_no_cell_passes_on_lacks_nothing() {
        let field = Field::from_fn(Grid::new(5, 5).expect("a grid"), |_| Tensor2::ZERO);
        let [r] = records(&field, &[(Cell::new(2, 2), 0)])[..] else { panic!("one pulse") };
        assert!(r.settled);
        assert_eq!((r.missing_energy, r.stopped_distance, r.solver_error), (0.0, 0.0, 0.0));
    }

    /// Totally anisotropic cells along closed lines keep some light for ever (see the laws of stationary states).
    #[test]
    fn caught_light_has_no_numbers() {
        let spiral = tigereye_fields::parse_spec("spiral:size=21").expect("a specification");
        let spiral = tigereye_fields::generate(&spiral.name, &spiral.arguments).expect("a field");
        let flat =
            Field::from_fn(spiral.grid(), |c| Tensor2::from_axes(Svd::of(spiral.at(c)).phi_rad(), 1.0, 0.0));
        let pulses: Vec<_> = (0..16).step_by(2).map(|t| (Cell::new(6, 12), t)).collect();
        let records = records(&flat, &pulses);
        let caught: Vec<_> = records.iter().filter(|r| !r.settled).collect();
        assert!(!caught.is_empty(), "no light is caught: the test shows nothing");
        for r in caught {
            assert_eq!(r.number(PulseNumber::Settled), 0.0);
            assert!(
                r.number(PulseNumber::MissingEnergy).is_nan() && r.number(PulseNumber::PlainSteps).is_nan()
            );
        }
    }

    #[test]
    fn lists_have_a_row_for_each_pulse() {
        let field = Field::from_fn(Grid::new(5, 5).expect("a grid"), |_| Tensor2::IDENTITY);
        let text = comma_separated(&records(&field, &[(Cell::new(2, 2), 0), (Cell::new(1, 3), 5)]));
        let rows: Vec<Vec<&str>> = text.lines().map(|l| l.split(',').collect()).collect();
        assert!(rows.iter().all(|r| r.len() == rows[0].len()) && rows.len() == 3, "{text}");
        assert_eq!(rows[2][..4], ["1", "3", "5", "true"]);
    }
}
