//! Laws of the gradient of linear scattering: the exact one is its definition, the sketched one is right on average
//! and as far off as it says, and neither depends on how it was computed.

use crate::common::{
    AllPulses, bits, directions, largest_relative_difference, scheme, thin_field, transmission, with_threads,
};
use std::ops::ControlFlow;
use std::sync::Mutex;
use tigereye_core::{Cell, Field, Grid, LtgVolume, Normalization, Tensor2, TransmissionField};
use tigereye_io::npy;
use tigereye_ltg::{
    Estimate, LtgError, LtgOutcome, LtgSettings, PartialVolume, Precision, Shard, SketchObserver,
    SketchSettings, SketchSums, SketchedGradient, SweepObserver, linear_sweep_part, omega_step_of_volumes,
};
use tigereye_scenes::{Material, Part, Scene as Walls, Shape};
use tigereye_test_support::{field, reference_folder};
use tigereye_tests::{Symmetry, difference_over_largest};
use tigereye_transport::{
    Level, LinearScattering, Scattering, ScatteringRule, Scheme, Stopping, StoppingRule, TransportError,
};

/// Difference from the published volumes relative to each value (1), in double and in single precision.
const PUBLISHED: [(Precision, f64); 2] = [(Precision::F64, 1e-10), (Precision::F32, 1e-5)];
/// Difference from pulses stepped to a relative change of 1e-15, relative to each value (1): what is left of light that
/// stays between mirrors for a few hundred steps.
const STEPPED: f64 = 1e-10;
/// Difference of a moved gradient relative to the largest value (1): the tensors' decomposition rounds differently in
/// every frame.
const SYMMETRY: f64 = 1e-12;

/// A field prepared for gradients.
struct Scene {
    scheme: Scheme,
    transmission: TransmissionField,
    omega_step: usize,
}

impl Scene {
    fn new(tensors: &Field<Tensor2>, samples: usize, normalization: Normalization) -> Self {
        Self::through(transmission(tensors, samples, normalization))
    }

    fn of(spec: &str, samples: usize) -> Self {
        Self::new(&field(spec), samples, Normalization::Local)
    }

    fn walled(width: usize, height: usize, parts: Vec<Part>) -> Self {
        let walls = Walls { grid: Grid::new(width, height).expect("a grid"), parts };
        let layout = walls.layout().expect("a layout");
        Self::through(walls.transmission(&layout, directions(16)).expect("a transmission"))
    }

    fn through(transmission: TransmissionField) -> Self {
        let directions = transmission.directions();
        let scheme = scheme(directions.count()).with_scattering(ScatteringRule::Linear);
        Self { scheme, transmission, omega_step: omega_step_of_volumes(directions) }
    }

    fn settings(&self) -> LtgSettings {
        LtgSettings { omega_step: self.omega_step, ..LtgSettings::reference(self.scheme.directions()) }
    }

    fn try_part(
        &self,
        settings: &LtgSettings,
        shard: Shard,
        start: Option<PartialVolume>,
        observer: &dyn SweepObserver,
    ) -> Result<PartialVolume, LtgError> {
        let scattering = Scattering::new(&self.scheme, &self.transmission);
        linear_sweep_part(&LinearScattering::new(&scattering), settings, shard, start, observer)
    }

    fn exact(&self, settings: &LtgSettings) -> LtgOutcome {
        let part = self.try_part(settings, Shard::WHOLE, None, &()).expect("a sweep");
        part.into_outcome().expect("all of it")
    }

    fn with_sketches<R>(
        &self,
        settings: SketchSettings,
        run: impl FnOnce(&SketchedGradient<'_>) -> R,
    ) -> Result<R, LtgError> {
        let scattering = Scattering::new(&self.scheme, &self.transmission);
        let field = LinearScattering::new(&scattering);
        SketchedGradient::new(&field, settings).map(|gradient| run(&gradient))
    }

    fn sketches(&self, sketches: u32, seed: u64) -> SketchSettings {
        SketchSettings {
            sketches,
            seed,
            omega_step: self.omega_step,
            slices: None,
            memory_bytes: u64::MAX,
            level: Level::detect(),
        }
    }

    fn try_sketched(&self, settings: SketchSettings) -> Result<SketchSums, LtgError> {
        self.with_sketches(settings, |g| g.run(Shard::WHOLE, g.sums(), &()))?
    }

    fn sketched(&self, settings: SketchSettings) -> SketchSums {
        self.try_sketched(settings).expect("sketches")
    }

    fn estimate(&self, sketches: u32, seed: u64) -> Estimate {
        self.sketched(self.sketches(sketches, seed)).estimate().expect("an estimate")
    }
}

fn rectangle(from: [f64; 2], to: [f64; 2]) -> Shape {
    Shape::Rectangle { from, to }
}

const fn mirror(reflectance: f64) -> Material {
    Material::Mirror { reflectance, angle_deg: None }
}

/// Mirrors, an absorber and glass, nothing symmetric; light gets out.
fn walled() -> Scene {
    Scene::walled(
        9,
        8,
        vec![
            Part {
                shape: Shape::Segment { from: [1.0, 6.0], to: [4.0, 3.0], thickness: 1.0 },
                material: mirror(0.9),
            },
            Part {
                shape: rectangle([6.0, 1.0], [6.0, 4.0]),
                material: Material::Diffuse { reflectance: 1.0, angle_deg: None },
            },
            Part { shape: rectangle([2.0, 1.0], [3.0, 1.0]), material: Material::Absorber },
            Part {
                shape: rectangle([4.0, 5.0], [5.0, 6.0]),
                material: Material::Clear { transmittance: 0.4 },
            },
        ],
    )
}

/// Fields with whole and with dark samples, with walls, and one of which only some slices are wanted.
fn scenes_to_cut() -> Vec<(&'static str, Scene, Option<Vec<usize>>)> {
    vec![
        ("random", Scene::of("random:width=9,height=8", 16), None),
        ("total anisotropy", Scene::of("rings:width=8,height=9,total=true", 24), None),
        ("a blend", Scene::through(thin_field([8, 7], "20:2", 16, Normalization::Global)), None),
        ("walls", walled(), None),
        ("some slices", Scene::of("bow:width=7,height=9", 32), Some(vec![1, 8, 9, 30])),
    ]
}

fn shards(count: usize) -> Vec<Shard> {
    (0..count).map(|i| Shard::new(i, count).expect("a shard")).collect()
}

/// The least memory that is accepted, bytes.
fn least<T: std::fmt::Debug>(refused: Result<T, LtgError>) -> u64 {
    match refused {
        Err(LtgError::Memory { needed, .. }) => u64::try_from(needed).expect("a small field"),
        other => panic!("{other:?}"),
    }
}

fn assert_same(found: &LtgOutcome, expected: &LtgOutcome, what: &str) {
    assert_eq!(bits(&found.volume), bits(&expected.volume), "{what}");
    assert_eq!((found.work, found.limited), (expected.work, expected.limited), "{what}");
}

#[test]
fn published_volumes_are_met() {
    let Some(folder) = reference_folder("linear") else { return };
    let array = |name: &str| {
        let path = folder.join(name);
        std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    for (name, samples, rule, normalization) in [
        ("absorb13", 16, "global", Normalization::Global),
        ("bow13", 32, "local", Normalization::Local),
        ("inverse13", 16, "local", Normalization::Local),
    ] {
        let tensors = npy::read_tensors(&array(&format!("{name}_field.npy"))).expect("tensors");
        let published = npy::read_array(&array(&format!("{name}_S{samples}_{rule}.npy"))).expect("an array");
        let scene = Scene::new(&tensors, samples, normalization);
        assert_eq!(published.shape, [samples, tensors.grid().height(), tensors.grid().width()], "{name}");
        for (precision, bound) in PUBLISHED {
            let found = scene.exact(&LtgSettings { precision, ..scene.settings() });
            let off = largest_relative_difference(found.volume.values(), &published.values);
            assert!(off <= bound, "{name}, {}: off by {off:e}", precision.name());
        }
    }
}

/// Pulse by pulse and step by step, on whole profiles.
#[test]
fn exact_gradient_is_the_definition() {
    for (name, scene, slices) in scenes_to_cut() {
        let found = scene.exact(&LtgSettings { slices: slices.clone(), ..scene.settings() });
        let rule = StoppingRule::Converged { tolerance: 1e-15 };
        let stopping = Stopping { rule, max_iterations: 3000 };
        let all = AllPulses::solve(&scene.scheme, &scene.transmission, stopping).gradient(scene.omega_step);
        let cells = scene.transmission.grid().cells();
        let slices = slices.unwrap_or_else(|| (0..scene.scheme.directions().count()).collect());
        let expected: Vec<f64> =
            slices.iter().flat_map(|t| all[t * cells..(t + 1) * cells].iter().copied()).collect();
        let off = largest_relative_difference(found.volume.values(), &expected);
        assert!(off <= STEPPED, "{name}: off by {off:e}");
        assert_eq!(found.work.sources, 8 * (cells as u64 - 4), "{name}: all cells but the corners");
        assert!(expected.iter().any(|&v| v > 1.0), "{name}: something to compare");
    }
}

#[test]
fn rooms_of_perfect_mirrors_are_refused() {
    let outline = Shape::Outline { of: Box::new(rectangle([1.0, 1.0], [6.0, 6.0])), thickness: 1.0 };
    let room = Scene::walled(8, 8, vec![Part { shape: outline, material: mirror(1.0) }]);
    let trapped =
        |e: &LtgError| matches!(e, LtgError::Stopping(TransportError::Trapped { x: 0..8, y: 0..8 }));
    for (precision, _) in PUBLISHED {
        let settings = LtgSettings { precision, ..room.settings() };
        let error = room.try_part(&settings, Shard::WHOLE, None, &()).expect_err("a refusal");
        assert!(trapped(&error), "{error:?}");
    }
    let error = room.try_sketched(room.sketches(64, 0)).expect_err("a refusal");
    assert!(trapped(&error), "{error:?}");
}

#[test]
fn exact_gradient_does_not_depend_on_threads_instruction_set_or_memory() {
    for (name, scene, slices) in scenes_to_cut() {
        for (precision, _) in PUBLISHED {
            let settings = LtgSettings { slices: slices.clone(), precision, ..scene.settings() };
            let expected =
                with_threads(1, || scene.exact(&LtgSettings { level: Level::BASELINE, ..settings.clone() }));
            for threads in [1, 2] {
                with_threads(threads, || {
                    for level in Level::available() {
                        let found = scene.exact(&LtgSettings { level, ..settings.clone() });
                        let what =
                            format!("{name}, {}, {threads} threads, {}", precision.name(), level.name());
                        assert_same(&found, &expected, &what);
                    }
                    let refused = LtgSettings { memory_bytes: 1, ..settings.clone() };
                    let least = least(scene.try_part(&refused, Shard::WHOLE, None, &()));
                    // One column at a time, and a few.
                    for memory_bytes in [least, least + least / 8, least + least / 3] {
                        let found = scene.exact(&LtgSettings { memory_bytes, ..settings.clone() });
                        assert_same(&found, &expected, &format!("{name}, {memory_bytes} bytes"));
                    }
                    let below = LtgSettings { memory_bytes: least - 1, ..settings.clone() };
                    let refused = scene.try_part(&below, Shard::WHOLE, None, &());
                    assert!(matches!(refused, Err(LtgError::Memory { .. })), "{name}: {refused:?}");
                });
            }
        }
    }
}

#[test]
fn exact_shards_merge_to_the_bits_and_the_work_of_the_whole() {
    for (name, scene, slices) in scenes_to_cut() {
        let settings = LtgSettings { slices, ..scene.settings() };
        let expected = scene.exact(&settings);
        for order in [[0, 1, 2], [2, 0, 1]] {
            let parts = order.map(|i| {
                let shard = shards(3)[i];
                let part = scene.try_part(&settings, shard, None, &()).expect("a part");
                assert_eq!(part.missing(shard), 0, "{name}, {shard}");
                part
            });
            let [a, b, c] = parts;
            let merged = a.merged(&b).and_then(|ab| ab.merged(&c)).expect("no cell twice");
            assert_same(&merged.into_outcome().expect("no cell missing"), &expected, name);
        }
    }
}

/// Ends a sweep after some sources, and keeps what was finished last.
struct Impatient {
    after: u64,
    finished: Mutex<Option<PartialVolume>>,
}

impl SweepObserver for Impatient {
    fn progress(&self, done: u64, total: u64) -> ControlFlow<()> {
        assert!(done <= total, "{done} of {total}");
        if done >= self.after { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
    fn finished(&self, volume: &PartialVolume) -> ControlFlow<()> {
        *self.finished.lock().expect("no panic") = Some(volume.clone());
        ControlFlow::Continue(())
    }
}

#[test]
fn interrupted_exact_gradients_resume_to_the_bits_and_the_work_of_the_whole() {
    for (name, scene, slices) in scenes_to_cut() {
        let settings = LtgSettings { slices, ..scene.settings() };
        let expected = scene.exact(&settings);
        for after in (0..8).map(|i| 1 + i * expected.work.sources / 9) {
            let observer = Impatient { after, finished: Mutex::new(None) };
            let outcome = with_threads(2, || scene.try_part(&settings, Shard::WHOLE, None, &observer));
            assert!(matches!(outcome, Err(LtgError::Interrupted { .. })), "{name}, after {after}");
            let finished = observer.finished.into_inner().expect("no panic");
            let resumed = scene.try_part(&settings, Shard::WHOLE, finished, &()).expect("a sweep");
            assert_same(&resumed.into_outcome().expect("all"), &expected, &format!("{name}, after {after}"));
        }
    }
}

#[test]
fn exact_gradient_mirrors_and_turns_with_the_field() {
    for spec in ["random:width=9,height=7", "bow:width=9,height=8,anisotropy=4"] {
        let tensors = field(spec);
        for samples in [8, 16, 24] {
            let run = |tensors: &Field<Tensor2>| {
                let scene = Scene::new(tensors, samples, Normalization::Global);
                scene.exact(&scene.settings())
            };
            let straight = run(&tensors);
            for symmetry in Symmetry::ALL {
                let moved = run(&symmetry.field(&tensors));
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

/// Sketches of an estimate, and how many estimates are averaged.
const SKETCHES: u32 = 400;
const SEEDS: u64 = 40;

/// All pairs of a value and its counterpart that are not 0; zeros must be zeros.
fn pairs<'a>(found: &'a LtgVolume, exact: &'a LtgVolume) -> impl Iterator<Item = (usize, f64, f64)> + 'a {
    let pairs = found.values().iter().zip(exact.values()).enumerate();
    pairs.filter_map(|(i, (&found, &exact))| {
        assert_eq!(found == 0.0, exact == 0.0, "value {i}: {found} and {exact}");
        (exact > 0.0).then_some((i, found, exact))
    })
}

/// The values of one estimate share their random numbers, so their mean ratio to the exact ones scatters nearly as much
/// as a single value does: 3 to 4 % with 400 sketches. The mean over 40 seeds then has a standard error of about 0.6 %.
/// A bound of 1 % leaves it room, as these seeds show, while a bias of 3 % would be beyond it by more than three
/// standard errors.
#[test]
fn estimates_are_right_on_average_and_as_far_off_as_they_say() {
    for (spec, samples) in [
        ("inverse:size=13,anisotropy=4", 16),
        ("bow:size=13", 32),
        ("random:size=12", 16),
        ("rings:size=10,total=true", 16),
    ] {
        let scene = Scene::of(spec, samples);
        let exact = scene.exact(&scene.settings()).volume;
        let (mut means, mut squares, mut count) = (Vec::new(), 0.0, 0_u64);
        for seed in 0..SEEDS {
            let estimate = scene.estimate(SKETCHES, seed);
            let (mut sum, mut values) = (0.0, 0_u64);
            for (i, found, exact) in pairs(&estimate.volume, &exact) {
                sum += found / exact;
                let off = (found - exact) / estimate.error.values()[i];
                squares += off * off;
                values += 1;
            }
            means.push(sum / values as f64);
            count += values;
        }
        let mean = means.iter().sum::<f64>() / SEEDS as f64;
        let variance = means.iter().map(|m| (m - mean) * (m - mean)).sum::<f64>() / (SEEDS - 1) as f64;
        let standard_error = (variance / SEEDS as f64).sqrt();
        let rms = (squares / count as f64).sqrt();
        println!("{spec}: mean {mean:.4}, standard error {standard_error:.4}, in stated errors {rms:.3}");
        assert!((mean - 1.0).abs() < 0.01, "{spec}: {mean} of the exact gradient on average");
        assert!(standard_error < 0.01, "{spec}: the mean is known to {standard_error} only");
        assert!((0.85..1.2).contains(&rms), "{spec}: {rms} times the stated error");
    }
}

/// Whole batches of 32, parts of them, and odd numbers.
#[test]
fn any_number_of_sketches_estimates() {
    let scene = Scene::of("random:width=9,height=8", 16);
    let exact = scene.exact(&scene.settings()).volume;
    for sketches in [16, 17, 33, 100] {
        let (mut ratios, mut squares, mut count) = (0.0, 0.0, 0_u64);
        for seed in 0..SEEDS {
            let estimate = scene.estimate(sketches, seed);
            assert_eq!(estimate.sketches, sketches);
            for (i, found, exact) in pairs(&estimate.volume, &exact) {
                let error = estimate.error.values()[i];
                assert!(error.is_finite() && error > 0.0, "{sketches} sketches, value {i}: error {error}");
                ratios += found / exact;
                let off = (found - exact) / exact;
                squares += off * off;
                count += 1;
            }
            // What one norm's relative error is, at most: three of them make a value.
            let one_norm = std::f64::consts::FRAC_PI_2 / f64::from(sketches).sqrt();
            let stated = estimate.relative_error / one_norm;
            assert!((0.3..1.7).contains(&stated), "{sketches} sketches: {stated} of the error of a norm");
        }
        let (mean, rms) = (ratios / count as f64, (squares / count as f64).sqrt());
        println!("{sketches} sketches: mean {mean:.3}, off by {rms:.3}");
        // A tenth at 16 sketches, as a root of noisy squares is too large on average.
        assert!((mean - 1.0).abs() < 1.6 / f64::from(sketches) + 0.06, "{sketches} sketches: {mean}");
    }
    for sketches in [0, 15, (1 << 20) + 1] {
        let refused = scene.try_sketched(scene.sketches(sketches, 0));
        assert_eq!(refused, Err(LtgError::Sketches { sketches: sketches.into() }));
    }
}

#[test]
fn sketches_do_not_depend_on_threads_instruction_set_or_memory() {
    for (name, scene, slices) in scenes_to_cut() {
        // Four batches, the last of them not whole.
        let settings = SketchSettings { slices, ..scene.sketches(101, 3) };
        let expected =
            with_threads(1, || scene.sketched(SketchSettings { level: Level::BASELINE, ..settings.clone() }));
        for threads in [1, 2] {
            with_threads(threads, || {
                for level in Level::available() {
                    let found = scene.sketched(SketchSettings { level, ..settings.clone() });
                    assert_eq!(found, expected, "{name}, {threads} threads, {}", level.name());
                }
                // One narrow array of lanes, and some more.
                let least = least(scene.try_sketched(SketchSettings { memory_bytes: 1, ..settings.clone() }));
                for memory_bytes in [least, least + least / 4, 2 * least] {
                    let found = scene.sketched(SketchSettings { memory_bytes, ..settings.clone() });
                    assert_eq!(found, expected, "{name}, {threads} threads, {memory_bytes} bytes");
                }
                let below = SketchSettings { memory_bytes: least - 1, ..settings.clone() };
                assert!(matches!(scene.try_sketched(below), Err(LtgError::Memory { .. })), "{name}");
            });
        }
        let other = scene.sketched(SketchSettings { seed: 4, ..settings });
        assert_ne!(other.values(), expected.values(), "{name}: another seed");
    }
}

#[test]
fn shards_of_sketches_merge_in_any_order() {
    let scene = Scene::of("random:width=9,height=8", 16);
    let settings = scene.sketches(150, 9);
    let expected = scene.sketched(settings.clone());
    let part = |settings: &SketchSettings, shard: Shard| {
        let run = scene.with_sketches(settings.clone(), |g| g.run(shard, g.sums(), &()));
        run.and_then(|sums| sums).expect("sketches")
    };
    for order in [vec![0], vec![1, 0], vec![2, 0, 1], vec![6, 1, 5, 0, 2, 4, 3]] {
        let parts: Vec<SketchSums> = order.iter().map(|&i| part(&settings, shards(order.len())[i])).collect();
        let sketched: u32 = parts.iter().map(SketchSums::sketches).sum();
        assert_eq!(sketched, 150, "every sketch once");
        let merged = parts.iter().skip(1).try_fold(parts[0].clone(), |sum, part| sum.merged(part));
        assert_eq!(merged.as_ref(), Ok(&expected), "{order:?}");
    }
    let [a, b] = [0, 1].map(|i| part(&settings, shards(2)[i]));
    assert_eq!(a.missing_shards(2), [1]);
    let twice = expected.clone().merged(&b);
    assert!(matches!(twice, Err(LtgError::SketchedTwice { .. })), "{twice:?}");
    for (other, what) in [
        (SketchSettings { seed: 8, ..settings.clone() }, "seeds"),
        (SketchSettings { sketches: 151, ..settings.clone() }, "numbers of sketches"),
        (SketchSettings { omega_step: 1, ..settings.clone() }, "angular steps"),
        (SketchSettings { slices: Some(vec![1]), ..settings.clone() }, "slices"),
    ] {
        let part = part(&other, shards(2)[1]);
        assert_eq!(a.clone().merged(&part), Err(LtgError::Unlike { what }));
    }
}

/// Ends the work after some batches, and keeps the numbers of what was finished last, as a file would.
struct Leaving {
    after: usize,
    finished: Mutex<Option<(Vec<f64>, Vec<bool>)>>,
}

impl SketchObserver for Leaving {
    fn finished(&self, sums: &SketchSums) -> ControlFlow<()> {
        *self.finished.lock().expect("no panic") = Some((sums.values(), sums.done().to_vec()));
        let done = sums.done().iter().filter(|done| **done).count();
        if done >= self.after { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

#[test]
fn interrupted_sketches_resume_from_stored_numbers() {
    for (name, scene, slices) in scenes_to_cut() {
        let settings = SketchSettings { slices, ..scene.sketches(300, 5) };
        let expected = scene.sketched(settings.clone());
        for after in [1, 2, 5] {
            let observer = Leaving { after, finished: Mutex::new(None) };
            let run = |start: SketchSums, observer: &dyn SketchObserver| {
                scene.with_sketches(settings.clone(), |g| g.run(Shard::WHOLE, start, observer))
            };
            let (shape, empty) =
                scene.with_sketches(settings.clone(), |g| (g.shape(), g.sums())).expect("settings");
            let outcome = with_threads(1, || run(empty, &observer)).expect("settings");
            assert!(matches!(outcome, Err(LtgError::Interrupted { .. })), "{name}: {outcome:?}");
            let (values, done) = observer.finished.into_inner().expect("no panic").expect("some batches");
            let restored = SketchSums::restored(shape, &values, done).expect("stored numbers");
            assert!((1..300).contains(&restored.sketches()), "{name}");
            let resumed = with_threads(2, || run(restored, &())).expect("settings");
            assert_eq!(resumed.as_ref(), Ok(&expected), "{name}, after {after}");
        }
    }
}

#[test]
fn stored_sums_are_checked() {
    let scene = Scene::of("random:width=5,height=5", 8);
    let sums = scene.sketched(scene.sketches(64, 0));
    let (shape, values, done) = (sums.shape().clone(), sums.values(), sums.done().to_vec());
    let restored = SketchSums::restored(shape.clone(), &values, done.clone());
    assert_eq!(restored.as_ref(), Ok(&sums));
    let short = SketchSums::restored(shape.clone(), &values[1..], done.clone());
    assert!(matches!(short, Err(LtgError::Length { what: "values", .. })), "{short:?}");
    let unmarked = SketchSums::restored(shape.clone(), &values, vec![true]);
    assert!(matches!(unmarked, Err(LtgError::Length { what: "marks", found: 1, expected: 2 })));
    for wrong in [0.5, f64::NAN, f64::INFINITY, 1e300] {
        let mut values = values.clone();
        values[3] = wrong;
        let refused = SketchSums::restored(shape.clone(), &values, done.clone());
        assert!(matches!(refused, Err(LtgError::Sum { index: 3, .. })), "{wrong}: {refused:?}");
    }
    let empty = SketchSums::restored(shape, &vec![0.0; values.len()], vec![false; 2]).expect("no sketch");
    assert_eq!(empty.estimate(), Err(LtgError::NoSketches));
}

#[test]
fn asking_for_an_error_takes_as_many_sketches_as_it_needs() {
    let scene = Scene::of("random:width=9,height=8", 16);
    for target in [0.2, 0.06] {
        let run = scene.with_sketches(scene.sketches(64, 1), |g| g.run_to_error(target, &()));
        let sums = run.and_then(|sums| sums).expect("sketches");
        let estimate = sums.estimate().expect("an estimate");
        assert!(estimate.relative_error <= target, "{target}: {}", estimate.relative_error);
        // The same sketches as if their number had been known.
        assert_eq!(sums, scene.sketched(scene.sketches(estimate.sketches, 1)));
        // Twice what one norm takes.
        let one_norm = std::f64::consts::FRAC_PI_2 / target;
        let most = 64.0_f64.max(2.0 * one_norm * one_norm);
        assert!(f64::from(estimate.sketches) <= most, "{target}: {} sketches", estimate.sketches);
    }
    let refused = scene.with_sketches(scene.sketches(64, 1), |g| g.run_to_error(1e-4, &()));
    assert!(matches!(refused, Ok(Err(LtgError::Sketches { .. }))), "more than a million: {refused:?}");
}

#[test]
fn grids_without_inner_cells_have_no_gradient() {
    let scene = Scene::of("random:width=2,height=9", 8);
    assert!(scene.exact(&scene.settings()).volume.values().iter().all(|&v| v == 0.0));
    let estimate = scene.estimate(16, 0);
    assert!(estimate.volume.values().iter().chain(estimate.error.values()).all(|&v| v == 0.0));
    assert_eq!(estimate.relative_error, 0.0);
    assert_eq!(estimate.volume.value(Cell::new(1, 1), 0), Some(0.0));
}
