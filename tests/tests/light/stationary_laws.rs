//! Laws of stationary states: reached by far fewer evaluations than stepping takes, and never made up.

use crate::common::{scheme, transmission};
use tigereye_core::{Cell, Field, Grid, Normalization, StopReason, Svd, Tensor2, TransmissionField};
use tigereye_test_support::field;
use tigereye_transport::{
    EightLobe, Engine, LaneOutcome, Level, Light, Outcome, Problem, PulseDistribution, PulseSolver, Real,
    Scattering, Scheme, Stopping, StoppingRule,
};

const SAMPLES: usize = 16;

fn solved<T: Real>(
    scattering: &Scattering<'_>,
    cell: Cell,
    samples: &[usize],
) -> (Vec<PulseDistribution<T>>, Vec<LaneOutcome>) {
    let mut results = vec![PulseDistribution::dark(scattering.grid().cells()); samples.len()];
    let mut solver = PulseSolver::new(scattering, Level::detect());
    let outcomes = solver.solve(cell, samples, &Stopping::STATIONARY, &mut results);
    (results, outcomes)
}

fn plain(scheme: &Scheme, transmission: &TransmissionField, light: Light, stopping: Stopping) -> Outcome {
    EightLobe.propagate(&Problem { scheme, transmission, lights: &[light], stopping }).expect("a propagation")
}

fn energy<T: Real>(lobes: &[[T; 8]]) -> f64 {
    lobes.iter().flatten().map(|v| v.to_f64()).sum()
}

/// L1 difference relative to `b`'s sum (1).
fn difference<T: Real>(a: &[[T; 8]], b: &[[f64; 8]]) -> f64 {
    let l1: f64 = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a.to_f64() - b).abs()).sum();
    l1 / energy(b)
}

/// The light that many more plain steps than needed end with.
fn exact(scheme: &Scheme, transmission: &TransmissionField, light: Light) -> Outcome {
    let rule = StoppingRule::Converged { tolerance: 1e-14 };
    plain(scheme, transmission, light, Stopping { rule, max_iterations: 20_000 })
}

#[test]
fn stationary_states_need_few_evaluations_and_are_nearer_than_plain_steps_end() {
    for (spec, at_least) in [("inverse:size=29", 3.5), ("rings:size=29", 10.0), ("gyre:size=29", 7.0)] {
        let (scheme, transmission) =
            (scheme(SAMPLES), transmission(&field(spec), SAMPLES, Normalization::Local));
        let scattering = Scattering::new(&scheme, &transmission);
        for cell in [Cell::new(14, 14), Cell::new(3, 20)] {
            let samples = [1, 4];
            let (pulses, outcomes) = solved::<f64>(&scattering, cell, &samples);
            for ((pulse, outcome), t) in pulses.iter().zip(outcomes).zip(samples) {
                let light = Light::pulse(cell, t);
                let steps = plain(&scheme, &transmission, light.clone(), Stopping::STATIONARY);
                let exact = exact(&scheme, &transmission, light);
                let exact = exact.distribution.incoming().values();
                let name = format!("{spec}, {cell:?}, {t}");
                assert_eq!(outcome.stop, StopReason::Converged, "{name}");
                assert!(
                    steps.work.steps as f64 > at_least * outcome.work.steps as f64,
                    "{name}: {outcome:?}"
                );
                let (ours, theirs) = (
                    difference(pulse.lobes(), exact),
                    difference(steps.distribution.incoming().values(), exact),
                );
                assert!(ours < theirs, "{name}: {ours} and {theirs}");
            }
        }
    }
}

#[test]
fn single_precision_settles_as_far_as_it_can_tell() {
    let (scheme, transmission) =
        (scheme(SAMPLES), transmission(&field("bow:size=21"), SAMPLES, Normalization::Local));
    let scattering = Scattering::new(&scheme, &transmission);
    let samples: Vec<usize> = (0..SAMPLES).collect();
    let (double, _) = solved::<f64>(&scattering, Cell::new(9, 12), &samples[..8]);
    let (single, outcomes) = solved::<f32>(&scattering, Cell::new(9, 12), &samples);
    assert!(outcomes.iter().all(|o| o.stop == StopReason::Converged));
    for (single, double) in single.iter().zip(&double) {
        assert!(difference(single.lobes(), double.lobes()) < 3e-5);
    }
}

/// In a spiral of totally anisotropic cells some light runs in a closed loop and never leaves: its energy grows for
/// ever. Extrapolation must not make a state of it, in a field of its own and inside another one, whose other light it
/// mixes with.
#[test]
fn light_caught_in_a_loop_is_reported_as_not_stationary() {
    let spiral = field("spiral:size=21");
    let flat = |c: Cell| Tensor2::from_axes(Svd::of(spiral.at(c)).phi_rad(), 1.0, 0.0);
    let whole = Field::from_fn(spiral.grid(), flat);
    let inside = Field::from_fn(Grid::new(13, 13).expect("a grid"), |c| {
        let middle = (3..10).contains(&c.x) && (3..10).contains(&c.y);
        if middle { flat(Cell::new(c.x + 4, c.y + 4)) } else { Tensor2::IDENTITY }
    });
    let caught = [
        caught::<f64>(&whole, &[Cell::new(6, 12), Cell::new(10, 9)]),
        caught::<f64>(&inside, &[Cell::new(6, 6), Cell::new(1, 6), Cell::new(4, 5)]),
        caught::<f32>(&whole, &[Cell::new(6, 12), Cell::new(10, 9)]),
        caught::<f32>(&inside, &[Cell::new(6, 6), Cell::new(1, 6), Cell::new(4, 5)]),
    ];
    assert!(caught.iter().all(|n| *n > 0), "no light is caught: the test shows nothing: {caught:?}");
}

/// Checks the pulses of some cells; how many of them are caught.
fn caught<T: Real>(tensors: &Field<Tensor2>, cells: &[Cell]) -> usize {
    let (scheme, transmission) = (scheme(SAMPLES), transmission(tensors, SAMPLES, Normalization::Local));
    let scattering = Scattering::new(&scheme, &transmission);
    let injected = std::f64::consts::TAU;
    let mut caught = 0;
    for &cell in cells {
        let samples = [0, 2, 4, 6, 8, 10, 12, 14];
        let (pulses, outcomes) = solved::<T>(&scattering, cell, &samples);
        for ((pulse, outcome), t) in pulses.iter().zip(outcomes).zip(samples) {
            let after = |steps| plain(&scheme, &transmission, Light::pulse(cell, t), Stopping::steps(steps));
            let [few, many] = [3000, 6000].map(|steps| energy(after(steps).distribution.incoming().values()));
            let growth = (many - few) / 3000.0 / injected;
            let name =
                format!("{} {cell:?}, {t}: grows by {growth} of what is injected, {outcome:?}", T::NAME);
            // The balance that is asked for is 1e-3.
            if growth > 2e-3 {
                caught += 1;
                assert_eq!(outcome.stop, StopReason::StepLimit, "{name}");
                let difference = difference(pulse.lobes(), after(1001).distribution.incoming().values());
                assert!(difference < 1e-4, "{name}: {difference} from 1001 plain steps");
                continue;
            }
            // Light that leaks out of a loop slowly may be given up; what plain steps settle soon may not.
            let rule = Stopping::STATIONARY.rule;
            let steps =
                plain(&scheme, &transmission, Light::pulse(cell, t), Stopping { rule, max_iterations: 1000 });
            if steps.stop == StopReason::Converged {
                assert_eq!(outcome.stop, StopReason::Converged, "{name}");
            }
        }
    }
    caught
}
