//! Laws of the light transport gradient: its definition, its symmetries, and what it must not depend on.

use crate::common::{
    AllPulses, THIN_RULES, bits, largest_relative_difference, scheme, thin_field, transmission, with_threads,
};
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use tigereye_core::{Cell, Field, LtgVolume, Normalization, Tensor2, TransmissionField};
use tigereye_ltg::{
    Finished, LtgError, LtgOutcome, LtgSettings, NUMERICS, PartialVolume, Phase, Precision, Shard,
    SweepObserver, omega_step_of_slices, omega_step_of_volumes, sweep, sweep_part,
};
use tigereye_test_support::field;
use tigereye_tests::{Symmetry, difference_over_largest};
use tigereye_transport::{
    EightLobe, Engine, Level, Light, Problem, Scattering, Scheme, Stopping, StoppingRule,
};

/// Difference from the brute-force gradient relative to the value itself (1): another order of summation, and the
/// difference of nearly equal samples.
const BRUTE_FORCE: f64 = 1e-12;
/// Difference of a moved gradient relative to the largest value (1): the tensors' decomposition rounds differently in
/// every frame.
const SYMMETRY: f64 = 1e-12;
/// Spread of equal values relative to themselves (1): rounding of sums that start elsewhere.
const UNIFORMITY: f64 = 1e-13;
/// Relative L2 difference of a gradient in single precision (1): rounding of 1e-7, and a source that stops a step early
/// or late now and then.
const SINGLE: f64 = 1e-4;
/// Mean number of steps (steps): published with two decimals.
const PRINTED_STEPS: f64 = 5e-3;

/// A field prepared for sweeps.
struct Scene {
    scheme: Scheme,
    transmission: TransmissionField,
}

impl Scene {
    fn new(tensors: &Field<Tensor2>, samples: usize, normalization: Normalization) -> Self {
        Self { scheme: scheme(samples), transmission: transmission(tensors, samples, normalization) }
    }

    fn of(spec: &str, samples: usize) -> Self {
        Self::new(&field(spec), samples, Normalization::Local)
    }

    fn settings(&self, omega_step: usize) -> LtgSettings {
        LtgSettings { omega_step, ..LtgSettings::reference(self.scheme.directions()) }
    }

    fn try_sweep(
        &self,
        settings: &LtgSettings,
        observer: &dyn SweepObserver,
    ) -> Result<LtgOutcome, LtgError> {
        sweep(&Scattering::new(&self.scheme, &self.transmission), settings, observer)
    }

    fn try_part(
        &self,
        settings: &LtgSettings,
        shard: Shard,
        start: Option<PartialVolume>,
        observer: &dyn SweepObserver,
    ) -> Result<PartialVolume, LtgError> {
        sweep_part(&Scattering::new(&self.scheme, &self.transmission), settings, shard, start, observer)
    }

    fn part(&self, settings: &LtgSettings, shard: Shard) -> PartialVolume {
        self.try_part(settings, shard, None, &()).unwrap_or_else(|e| panic!("{shard}: {e}"))
    }

    fn steps_of(&self, light: Light) -> usize {
        let lights = [light];
        let problem = Problem {
            scheme: &self.scheme,
            transmission: &self.transmission,
            lights: &lights,
            stopping: Stopping::REFERENCE,
        };
        EightLobe.propagate(&problem).expect("a propagation").work.steps
    }

    fn sweep(&self, settings: &LtgSettings) -> LtgOutcome {
        self.try_sweep(settings, &()).unwrap_or_else(|e| panic!("{e}"))
    }
}

/// The sweep finds stationary states by other means than stepping: values agree, counts do not.
#[test]
fn stationary_sweep_is_the_definition_of_stationary_pulses() {
    for spec in ["random:width=7,height=6", "bow:width=7,height=6,anisotropy=4"] {
        let scene = Scene::of(spec, 16);
        let rule = StoppingRule::Converged { tolerance: 1e-14 };
        let expected =
            AllPulses::solve(&scene.scheme, &scene.transmission, Stopping { rule, max_iterations: 2000 })
                .gradient(2);
        let outcome = scene.sweep(&LtgSettings { stopping: Stopping::STATIONARY, ..scene.settings(2) });
        let difference = largest_relative_difference(outcome.volume.values(), &expected);
        // The rule's own tolerance, a few times over.
        assert!(difference < 1e-9, "{spec}: off by {difference:e}");
        assert_eq!(outcome.limited, 0, "{spec}");
    }
}

#[test]
fn sweep_is_the_definition() {
    let zeros = {
        let mut tensors = field("random:width=7,height=6,seed=3");
        for i in [9, 17, 18, 30] {
            tensors.values_mut()[i] = Tensor2::ZERO;
        }
        tensors
    };
    let scenes = [
        ("random", Scene::of("random:width=7,height=6", 16)),
        ("bow", Scene::of("bow:width=7,height=6,anisotropy=4", 16)),
        ("total anisotropy", Scene::of("rings:width=7,height=6,total=true", 16)),
        ("zero cells", Scene::new(&zeros, 16, Normalization::Global)),
    ];
    let rules = [
        Stopping::REFERENCE,
        Stopping::steps(6),
        Stopping { rule: StoppingRule::DistributionChange { threshold: 0.3 }, max_iterations: 200 },
    ];
    for (name, scene) in &scenes {
        for stopping in rules {
            let pulses = AllPulses::solve(&scene.scheme, &scene.transmission, stopping);
            // Half a turn compares every pulse with itself.
            for omega_step in [1, 2, 5, 8] {
                let settings = LtgSettings { stopping, ..scene.settings(omega_step) };
                let outcome = scene.sweep(&settings);
                let expected = pulses.gradient(omega_step);
                let difference = largest_relative_difference(outcome.volume.values(), &expected);
                let what = format!("{name}, {:?}, K = {omega_step}", stopping.rule);
                assert!(difference <= BRUTE_FORCE, "{what}: off by {difference:e}");
                assert!(expected.iter().any(|&v| v > 1.0), "{what}: something to compare");
                // Every pulse takes the steps it takes alone.
                assert_eq!(outcome.work.sources, pulses.steps_of_compared().count() as u64, "{what}");
                assert_eq!(outcome.work.iterations_total, pulses.steps_of_compared().sum::<u64>(), "{what}");
                let longest = pulses.steps_of_compared().max().expect("pulses");
                assert_eq!(outcome.work.iterations_max, longest, "{what}");
            }
        }
    }
}

/// The same, whatever becomes of thin tensors.
#[test]
fn sweep_is_the_definition_under_every_rule_of_total_anisotropy() {
    for rule in THIN_RULES {
        let transmission = thin_field([7, 6], rule, 16, Normalization::Local);
        let scene = Scene { scheme: scheme(16), transmission };
        let expected = AllPulses::solve(&scene.scheme, &scene.transmission, Stopping::REFERENCE).gradient(2);
        let outcome = scene.sweep(&scene.settings(2));
        let difference = largest_relative_difference(outcome.volume.values(), &expected);
        assert!(difference <= BRUTE_FORCE, "{rule}: off by {difference:e}");
    }
}

#[test]
fn border_cells_are_zero_and_inner_cells_are_not() {
    let volume = Scene::of("random:width=9,height=7", 16).sweep(&LtgSettings {
        stopping: Stopping::steps(8),
        ..LtgSettings::reference(crate::common::directions(16))
    });
    for t in 0..16 {
        for (cell, &value) in volume.volume.slice(t).expect("a full volume").iter() {
            assert_eq!(value == 0.0, volume.volume.grid().is_border(cell), "{cell:?}, t = {t}: {value}");
        }
    }
}

#[test]
fn grids_without_inner_cells_have_no_gradient() {
    for spec in ["random:width=2,height=9", "random:width=9,height=1"] {
        let scene = Scene::of(spec, 8);
        let outcome = scene.sweep(&scene.settings(1));
        assert!(outcome.volume.values().iter().all(|&v| v == 0.0), "{spec}");
        assert_eq!(outcome.work.sources, 0, "{spec}");
    }
}

#[test]
fn gradient_does_not_depend_on_threads_or_instruction_set() {
    for scene in
        [Scene::of("random:width=11,height=9", 16), Scene::of("rings:width=10,height=11,total=true", 24)]
    {
        let settings = LtgSettings { level: Level::BASELINE, ..scene.settings(2) };
        let expected = with_threads(1, || scene.sweep(&settings));
        for threads in [1, 2, 5] {
            for level in Level::available() {
                let found = with_threads(threads, || scene.sweep(&LtgSettings { level, ..settings.clone() }));
                let what = format!("{threads} threads, {}", level.name());
                assert_eq!(bits(&found.volume), bits(&expected.volume), "{what}");
                assert_eq!((found.work, found.limited), (expected.work, expected.limited), "{what}");
            }
        }
    }
}

#[test]
fn gradient_and_its_work_do_not_depend_on_the_memory_bound() {
    let scene = Scene::of("random:width=11,height=9", 16);
    for threads in [1, 2] {
        with_threads(threads, || {
            let settings = scene.settings(2);
            let expected = scene.sweep(&settings);
            let refused = scene.try_sweep(&LtgSettings { memory_bytes: 1, ..settings.clone() }, &());
            let Err(LtgError::Memory { needed, bound: 1 }) = refused else { panic!("{refused:?}") };
            let least = u64::try_from(needed).expect("a small field");
            let mut solved_again = Vec::new();
            for percent in [100, 120, 150, 200, 300, 400, 600, 1000, 2000] {
                let memory_bytes = least / 100 * percent + least % 100;
                let observer = impatient(u64::MAX);
                let settings = LtgSettings { memory_bytes, ..settings.clone() };
                let found = scene.try_sweep(&settings, &observer).expect("a sweep");
                let what = format!("{percent} % of the least memory");
                assert_eq!(bits(&found.volume), bits(&expected.volume), "{what}");
                assert_eq!((found.work, found.limited), (expected.work, expected.limited), "{what}");
                let solved = observer.done.into_inner();
                assert!(solved >= expected.work.sources, "{what}");
                solved_again.push(solved - expected.work.sources);
            }
            // Strips solve the columns beside them again; with enough memory nothing is solved twice.
            assert!(solved_again[0] > 0, "the least memory means strips: {solved_again:?}");
            assert_eq!(solved_again.last(), Some(&0));
            assert!(solved_again.is_sorted_by(|a, b| a >= b), "more memory, less work: {solved_again:?}");
            // The refusal names the least bound that is accepted.
            let below = LtgSettings { memory_bytes: least - 1, ..settings.clone() };
            assert!(matches!(scene.try_sweep(&below, &()), Err(LtgError::Memory { .. })));
        });
    }
}

#[test]
fn slices_are_the_slices_of_the_full_volume() {
    let scene = Scene::of("random:width=9,height=8", 32);
    let settings = scene.settings(3);
    let full = scene.sweep(&settings).volume;
    for chosen in [vec![0], vec![8], vec![1, 31], vec![30, 2, 8, 8], (0..32).rev().collect::<Vec<_>>()] {
        let outcome = scene.sweep(&LtgSettings { slices: Some(chosen.clone()), ..settings.clone() });
        let mut ascending = chosen.clone();
        ascending.sort_unstable();
        ascending.dedup();
        assert_eq!(outcome.volume.slices(), ascending);
        for &t in &ascending {
            let slice = |v: &LtgVolume| -> Vec<u64> {
                v.slice(t).expect("a slice held").values().iter().map(|v| v.to_bits()).collect()
            };
            assert_eq!(slice(&outcome.volume), slice(&full), "slice {t} of {chosen:?}");
        }
    }
}

#[test]
fn gradient_mirrors_and_turns_with_the_field() {
    for spec in ["random:width=9,height=7", "bow:width=9,height=8,anisotropy=4"] {
        let tensors = field(spec);
        for samples in [8, 16, 24] {
            let omega_step = omega_step_of_volumes(crate::common::directions(samples));
            let run = |tensors: &Field<Tensor2>| {
                let scene = Scene::new(tensors, samples, Normalization::Global);
                scene.sweep(&scene.settings(omega_step))
            };
            let straight = run(&tensors);
            for symmetry in Symmetry::ALL {
                let moved = run(&symmetry.field(&tensors));
                assert_eq!(moved.work, straight.work, "{spec}, S = {samples}, {symmetry:?}");
                let (mut found, mut expected) = (Vec::new(), Vec::new());
                for t in 0..samples {
                    for cell in tensors.grid().iter() {
                        let there = symmetry.cell(tensors.grid(), cell);
                        let value = moved.volume.value(there, symmetry.sample(samples, t));
                        found.push(value.expect("a value"));
                        expected.push(straight.volume.value(cell, t).expect("a value"));
                    }
                }
                let difference = difference_over_largest(&found, &expected);
                assert!(difference <= SYMMETRY, "{spec}, S = {samples}, {symmetry:?}: {difference:e}");
            }
        }
    }
}

/// After n steps a pulse has not met the rim where it is n cells away; its neighbours need one more.
#[test]
fn gradient_of_a_uniform_field_is_uniform_away_from_the_rim() {
    let steps = 4;
    for spec in ["x:width=14,height=13", "isotropic:width=14,height=13"] {
        let scene = Scene::of(spec, 16);
        let outcome = scene.sweep(&LtgSettings { stopping: Stopping::steps(steps), ..scene.settings(2) });
        let grid = outcome.volume.grid();
        let away = |c: Cell| {
            let margin = steps + 1;
            (margin..grid.width() - margin).contains(&c.x) && (margin..grid.height() - margin).contains(&c.y)
        };
        for t in 0..16 {
            let slice = outcome.volume.slice(t).expect("a slice");
            let values: Vec<f64> = slice.iter().filter(|(c, _)| away(*c)).map(|(_, &v)| v).collect();
            assert_eq!(values.len(), 4 * 3);
            for &v in &values {
                assert!((v - values[0]).abs() <= UNIFORMITY * values[0], "{spec}, t = {t}: {values:?}");
            }
            // Both fields are their own mirror images.
            let centre = Cell::new(6, 6);
            for mirrored in [(16 - t) % 16, (24 - t) % 16] {
                let (a, b) = (outcome.volume.value(centre, t), outcome.volume.value(centre, mirrored));
                let (a, b) = (a.expect("a value"), b.expect("a value"));
                assert!((a - b).abs() <= UNIFORMITY * a, "{spec}, t = {t}: {a} and {b}");
            }
        }
    }
}

#[test]
fn every_pulse_but_the_corners_is_solved_once() {
    for (width, height) in [(3, 3), (5, 9), (12, 4)] {
        for samples in [8, 16] {
            let scene = Scene::of(&format!("spiral:width={width},height={height}"), samples);
            let outcome = scene.sweep(&scene.settings(1));
            assert_eq!(outcome.work.sources, ((width * height - 4) * samples) as u64, "{width} x {height}");
        }
    }
}

/// Breaks after some sources, and keeps what was finished last.
struct Impatient {
    after: u64,
    calls: AtomicU64,
    phases: AtomicU64,
    done: AtomicU64,
    finished: Mutex<Option<PartialVolume>>,
}

impl SweepObserver for Impatient {
    fn busy(&self, _with: Option<Phase>) {
        self.phases.fetch_add(1, Ordering::Relaxed);
    }
    fn progress(&self, done: u64, total: u64) -> ControlFlow<()> {
        assert!(done <= total, "{done} of {total}");
        self.calls.fetch_add(1, Ordering::Relaxed);
        self.done.fetch_max(done, Ordering::Relaxed);
        if done >= self.after { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
    fn finished(&self, volume: &PartialVolume) -> ControlFlow<()> {
        *self.finished.lock().expect("no panic") = Some(volume.clone());
        ControlFlow::Continue(())
    }
}

fn impatient(after: u64) -> Impatient {
    let zero = || AtomicU64::new(0);
    Impatient { after, calls: zero(), phases: zero(), done: zero(), finished: Mutex::new(None) }
}

#[test]
fn an_observer_interrupts_the_sweep() {
    let scene = Scene::of("random:width=9,height=8", 16);
    let settings = scene.settings(2);
    let all = (9 * 8 - 4) * 16;
    for threads in [1, 2] {
        let observer = impatient(100);
        let outcome = with_threads(threads, || scene.try_sweep(&settings, &observer));
        let Err(LtgError::Interrupted { done, total }) = outcome else { panic!("{outcome:?}") };
        assert_eq!(total, all);
        assert!((100..all).contains(&done), "{done} of {total}");
    }
    let observer = impatient(u64::MAX);
    let watched = scene.try_sweep(&settings, &observer).expect("a sweep");
    assert_eq!(bits(&watched.volume), bits(&scene.sweep(&settings).volume), "watching changes nothing");
    assert!(observer.calls.into_inner() > 0 && observer.phases.into_inner() > 0);
}

/// Scenes with several sets of directions, slices whose partners lie in other sets, and a single set, with their K and
/// slices.
fn scenes_to_cut() -> Vec<(&'static str, Scene, LtgSettings)> {
    let several = Scene::of("random:width=8,height=7", 64);
    let some = Scene::of("bow:width=7,height=8,anisotropy=4", 64);
    let one = Scene::of("rings:width=9,height=6", 16);
    let (a, b, c) = (several.settings(6), some.settings(6), one.settings(2));
    let slices: Vec<usize> = (0..64).filter(|t| t % 5 < 2).collect();
    vec![
        ("several sets", several, LtgSettings { stopping: Stopping::steps(5), ..a }),
        ("some slices", some, LtgSettings { slices: Some(slices), stopping: Stopping::steps(4), ..b }),
        ("one set", one, c),
    ]
}

fn assert_same(found: &LtgOutcome, expected: &LtgOutcome, what: &str) {
    assert_eq!(bits(&found.volume), bits(&expected.volume), "{what}");
    assert_eq!((found.work, found.limited), (expected.work, expected.limited), "{what}");
}

#[test]
fn shards_merge_to_the_bits_and_the_work_of_the_whole() {
    for (name, scene, settings) in scenes_to_cut() {
        let expected = scene.sweep(&settings);
        for count in [1, 2, 3, 7, 40] {
            let shards: Vec<Shard> = (0..count).map(|i| Shard::new(i, count).expect("a shard")).collect();
            let mut parts: Vec<PartialVolume> = shards.iter().map(|&s| scene.part(&settings, s)).collect();
            for (part, &shard) in parts.iter().zip(&shards) {
                assert_eq!(part.missing(shard), 0, "{name}, {shard}");
            }
            // The order of merging does not matter.
            if count % 2 == 1 {
                parts.reverse();
            }
            let merged = parts.iter().skip(1).try_fold(parts[0].clone(), |sum, part| sum.merged(part));
            let merged = merged.expect("no cell twice").into_outcome().expect("no cell missing");
            assert_same(&merged, &expected, &format!("{name}, {count} shards"));
        }
    }
}

#[test]
fn any_interruption_resumes_to_the_bits_and_the_work_of_the_whole() {
    for (name, scene, settings) in scenes_to_cut() {
        let expected = scene.sweep(&settings);
        let sources = expected.work.sources;
        for after in (0..12).map(|i| 1 + i * sources / 12) {
            let observer = impatient(after);
            let outcome = with_threads(2, || scene.try_part(&settings, Shard::WHOLE, None, &observer));
            assert!(matches!(outcome, Err(LtgError::Interrupted { .. })), "{name}, after {after}");
            let finished = observer.finished.into_inner().expect("no panic").expect("told what is finished");
            assert!(finished.finished().work.sources <= observer.done.into_inner());
            let resumed = scene.try_part(&settings, Shard::WHOLE, Some(finished), &()).expect("a sweep");
            assert_same(&resumed.into_outcome().expect("all"), &expected, &format!("{name}, after {after}"));
        }
    }
}

#[test]
fn a_sweep_interrupted_again_and_again_with_other_resources_ends_with_the_same_bits() {
    for (name, scene, settings) in scenes_to_cut() {
        let expected = scene.sweep(&settings);
        let least = match scene.try_sweep(&LtgSettings { memory_bytes: 1, ..settings.clone() }, &()) {
            Err(LtgError::Memory { needed, .. }) => u64::try_from(needed).expect("a small field"),
            other => panic!("{other:?}"),
        };
        let (mut start, mut runs) = (None, 0);
        let last = loop {
            let done = start.as_ref().map_or(0, |v: &PartialVolume| v.finished().work.sources);
            // Enough for some rows: less would never finish one.
            let observer = impatient(done + 400 + 100 * (runs % 3));
            let threads = 1 + runs as usize % 3;
            let settings = LtgSettings {
                memory_bytes: if runs % 2 == 0 { u64::MAX } else { 2 * least },
                level: Level::available()[runs as usize % Level::available().len()],
                ..settings.clone()
            };
            match with_threads(threads, || scene.try_part(&settings, Shard::WHOLE, start.take(), &observer)) {
                Ok(volume) => break volume,
                Err(LtgError::Interrupted { .. }) => {
                    start = observer.finished.into_inner().expect("no panic")
                }
                Err(e) => panic!("{name}: {e}"),
            }
            runs += 1;
            assert!(runs < 100, "{name}: no progress");
        };
        assert!(runs > 0, "{name}");
        assert_same(&last.into_outcome().expect("all"), &expected, name);
    }
}

#[test]
fn what_is_finished_is_right_at_every_moment() {
    struct Judge(Vec<f64>, AtomicU64);
    impl SweepObserver for Judge {
        fn finished(&self, volume: &PartialVolume) -> ControlFlow<()> {
            let (slices, grid) = (volume.slices().len(), volume.grid());
            let inner = (grid.width() - 2) * (grid.height() - 2);
            let sets = volume.finished().done.len() / inner;
            for (i, &square) in volume.finished().squares.iter().enumerate() {
                let cell = grid.cell(i % grid.cells());
                let whole = !grid.is_border(cell) && {
                    let at = (cell.y - 1) * (grid.width() - 2) + cell.x - 1;
                    (0..sets).all(|set| volume.finished().done[set * inner + at])
                };
                if whole {
                    assert_eq!(square.sqrt(), self.0[i]);
                } else {
                    assert!(square >= 0.0 && square.sqrt() <= self.0[i]);
                }
            }
            assert_eq!(volume.finished().squares.len(), slices * grid.cells());
            self.1.fetch_add(1, Ordering::Relaxed);
            ControlFlow::Continue(())
        }
    }
    for (name, scene, settings) in scenes_to_cut() {
        let judge = Judge(scene.sweep(&settings).volume.values().to_vec(), AtomicU64::new(0));
        scene.try_sweep(&settings, &judge).expect("a sweep");
        assert!(judge.1.into_inner() >= 4, "{name}: told after every row");
    }
}

#[test]
fn an_observer_that_cannot_keep_what_is_finished_ends_the_sweep() {
    struct Full;
    impl SweepObserver for Full {
        fn finished(&self, _volume: &PartialVolume) -> ControlFlow<()> {
            ControlFlow::Break(())
        }
    }
    let scene = Scene::of("random:width=9,height=8", 16);
    let outcome = scene.try_sweep(&scene.settings(2), &Full);
    assert!(matches!(outcome, Err(LtgError::Interrupted { .. })), "{outcome:?}");
}

#[test]
fn finished_sweeps_have_nothing_left_to_do() {
    let scene = Scene::of("random:width=9,height=8", 16);
    let settings = scene.settings(2);
    let whole = scene.part(&settings, Shard::WHOLE);
    let observer = impatient(0);
    let again = scene.try_part(&settings, Shard::WHOLE, Some(whole.clone()), &observer).expect("a sweep");
    assert_eq!(again, whole);
    assert_eq!(observer.calls.into_inner(), 0);
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let scene = Scene::of("random:width=9,height=8", 16);
    let settings = scene.settings(2);
    let shards = [0, 1, 2].map(|i| Shard::new(i, 3).expect("a shard"));
    let [a, b, c] = shards.map(|shard| scene.part(&settings, shard));
    let twice = a.clone().merged(&b).and_then(|ab| ab.merged(&b)).expect_err("twice");
    assert!(matches!(twice, LtgError::DoneTwice { x: 1, y: 3, direction: 0, count: 14 }), "{twice}");
    let missing = a.clone().merged(&c).expect("two parts");
    assert_eq!(missing.missing_shards(3), [1]);
    let missing = missing.into_outcome().expect_err("missing");
    assert_eq!(missing, LtgError::Missing { x: 1, y: 3, direction: 0, count: 14, total: 42 });
    let other = [
        (Scene::of("random:width=8,height=9", 16), settings.clone(), "grids"),
        (Scene::of("random:width=9,height=8", 24), settings.clone(), "numbers of directions"),
        (Scene::of("random:width=9,height=8", 16), scene.settings(1), "angular steps"),
        (
            Scene::of("random:width=9,height=8", 16),
            LtgSettings { slices: Some(vec![1]), ..settings.clone() },
            "slices",
        ),
    ];
    for (scene, other, what) in other {
        let part = scene.part(&other, shards[1]);
        assert_eq!(a.clone().merged(&part), Err(LtgError::Unlike { what }));
        let resumed = scene.try_part(&other, shards[0], Some(a.clone()), &());
        assert_eq!(resumed, Err(LtgError::Unlike { what }));
    }
    let restored =
        |finished| PartialVolume::restored(a.grid(), a.directions(), a.slices().to_vec(), 2, finished);
    assert_eq!(restored(a.finished().clone()), Ok(a.clone()));
    let mut short = a.finished().clone();
    short.done.pop();
    let error = restored(short);
    assert_eq!(error, Err(LtgError::Length { what: "marks", found: 41, expected: 42 }));
    let error = restored(Finished { squares: vec![0.0; 5], ..a.finished().clone() });
    assert_eq!(error, Err(LtgError::Length { what: "values", found: 5, expected: 9 * 8 * 16 }));
}

#[test]
fn single_precision_is_close_to_double_precision() {
    for spec in ["random:width=11,height=9", "inverse:size=11,anisotropy=4", "rings:size=10,total=true"] {
        let scene = Scene::of(spec, 32);
        let settings = scene.settings(3);
        let double = scene.sweep(&settings).volume;
        let single = scene.sweep(&LtgSettings { precision: Precision::F32, ..settings.clone() });
        let (mut square, mut norm) = (0.0, 0.0);
        for (a, b) in single.volume.values().iter().zip(double.values()) {
            square += (a - b) * (a - b);
            norm += b * b;
        }
        let l2 = (square / norm).sqrt();
        assert!(l2 <= SINGLE, "{spec}: off by {l2:e}");
        // And as independent of shards and threads as the other.
        let settings = LtgSettings { precision: Precision::F32, ..settings };
        let [a, b] = [0, 1].map(|i| {
            let shard = Shard::new(i, 2).expect("a shard");
            with_threads(1 + i, || scene.part(&settings, shard))
        });
        let merged = a.merged(&b).and_then(PartialVolume::into_outcome).expect("both halves");
        assert_same(&merged, &single, spec);
    }
}

#[test]
fn impossible_sweeps_are_refused_before_any_work() {
    let scene = Scene::of("random:width=9,height=8", 16);
    let settings = scene.settings(2);
    let refusal = |settings: LtgSettings| {
        let observer = impatient(u64::MAX);
        let error = scene.try_sweep(&settings, &observer).expect_err("a refusal");
        assert_eq!(observer.calls.into_inner() + observer.phases.into_inner(), 0, "{error}: work was done");
        error
    };
    let memory = refusal(LtgSettings { memory_bytes: 1000, ..settings.clone() });
    assert!(matches!(memory, LtgError::Memory { bound: 1000, needed } if needed > 1000), "{memory:?}");
    for omega_step in [0, 9] {
        let error = refusal(LtgSettings { omega_step, ..settings.clone() });
        assert_eq!(error, LtgError::OmegaStep { omega_step, directions: 16 });
    }
    let error = refusal(LtgSettings { slices: Some(vec![3, 16]), ..settings.clone() });
    assert_eq!(error, LtgError::Slice { slice: 16, directions: 16 });
    assert_eq!(refusal(LtgSettings { slices: Some(vec![]), ..settings.clone() }), LtgError::NoSlices);
    let rule = StoppingRule::FluxChange { threshold: f64::NAN };
    let error = refusal(LtgSettings { stopping: Stopping { rule, max_iterations: 9 }, ..settings });
    assert!(matches!(error, LtgError::Stopping(_)), "{error:?}");
}

#[test]
fn work_of_inverse13_is_known() {
    let scene = Scene::of("inverse:size=13,anisotropy=4", 64);
    let directions = scene.scheme.directions();
    assert_eq!((omega_step_of_volumes(directions), omega_step_of_slices(directions)), (6, 4));
    let outcome = scene.sweep(&LtgSettings::reference(directions));
    // The published mean of 12.88 steps is over all 13 x 13 x 64 pulses, the corners' among them.
    let in_corners: usize = [(0, 0), (12, 0), (0, 12), (12, 12)]
        .iter()
        .flat_map(|&(x, y)| (0..64).map(move |t| Light::pulse(Cell::new(x, y), t)))
        .map(|light| scene.steps_of(light))
        .sum();
    let mean = (outcome.work.iterations_total + in_corners as u64) as f64 / f64::from(13 * 13 * 64);
    assert!((mean - 12.88).abs() <= PRINTED_STEPS, "{mean} steps on average");
    insta::assert_debug_snapshot!((outcome.work, outcome.limited), @r"
    (
        SweepWork {
            sources: 10560,
            iterations_total: 137756,
            iterations_max: 21,
            cell_updates: 13888524,
        },
        0,
    )
    ");
}

/// Checkpoints and shards of other numerics are distinguished by a number. Every instruction set gives the same bits,
/// so they can be recorded: where this fails on purpose, raise `NUMERICS`, record the new pair, and say so under
/// "Numbers" in CHANGELOG.md.
#[test]
fn bits_change_with_the_count_of_numerics_only() {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for spec in ["inverse:size=9", "rings:size=8,anisotropy=3"] {
        for precision in [Precision::F64, Precision::F32] {
            let scene = Scene::of(spec, 16);
            let settings = LtgSettings { precision, ..scene.settings(2) };
            let volume = scene.try_sweep(&settings, &()).expect("a sweep").volume;
            // FNV-1a over the bits.
            for byte in volume.values().iter().flat_map(|v| v.to_le_bytes()) {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
            }
        }
    }
    insta::assert_snapshot!(format!("numerics {NUMERICS}: {hash:016x}"), @"numerics 2: 8f62f13a05ae287c");
}
