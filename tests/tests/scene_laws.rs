//! Laws of light in scenes: walls absorb and reflect, and neither directions nor engines are told apart.

mod common;

use common::{directions, field, scheme, transmission};
use tigereye_core::{Cell, Field, Grid, LightDistribution, Normalization, PolarProfile, TransmissionField};
use tigereye_ltg::{LtgSettings, sweep};
use tigereye_scenes::{BuiltScene, Material, Part, Scene, Shape};
use tigereye_transport::{
    EightLobe, Engine, Level, Light, Outcome, Problem, PulseDistribution, PulseSolver, Real, SampleSpace,
    Scattering, Scheme, Stopping, TransportError,
};

const SAMPLES: usize = 16;

const CLEAR: Material = Material::Clear { transmittance: 1.0 };
const MIRROR: Material = Material::Mirror { reflectance: 1.0, angle_deg: None };
const MATT: Material = Material::Diffuse { reflectance: 1.0, angle_deg: None };

fn built(width: usize, height: usize, parts: Vec<Part>) -> BuiltScene {
    let grid = Grid::new(width, height).expect("a grid");
    Scene { grid, parts }.built(directions(SAMPLES)).expect("a scene")
}

fn rectangle(from: [f64; 2], to: [f64; 2]) -> Shape {
    Shape::Rectangle { from, to }
}

fn outline(of: Shape, thickness: f64) -> Shape {
    Shape::Outline { of: Box::new(of), thickness }
}

const fn part(shape: Shape, material: Material) -> Part {
    Part { shape, material }
}

fn problem<'a>(
    scheme: &'a Scheme,
    transmission: &'a TransmissionField,
    lights: &'a [Light],
    steps: usize,
) -> Problem<'a> {
    Problem { scheme, transmission, lights, stopping: Stopping::steps(steps) }
}

fn lit(engine: &dyn Engine, scene: &BuiltScene, lights: &[Light], steps: usize) -> Outcome {
    let scheme = scheme(SAMPLES);
    engine.propagate(&problem(&scheme, &scene.transmission, lights, steps)).expect("a propagation")
}

fn isotropic() -> PolarProfile {
    PolarProfile::constant(directions(SAMPLES), 1.0)
}

/// A beam without symmetry.
fn beam() -> PolarProfile {
    let d = directions(SAMPLES);
    PolarProfile::from_fn(d, |t| 0.2 + (0.7 + d.cos(t) + 0.3 * d.sin(t)).max(0.0))
}

/// Shapes of every kind and material, nothing symmetric, walls that touch the rim and each other.
fn rough_parts() -> Vec<Part> {
    let crystal = Material::Crystal {
        field: field("random:size=29,seed=5"),
        at: Cell::new(0, 0),
        normalization: Normalization::Global,
    };
    vec![
        part(outline(rectangle([0.0, 0.0], [28.0, 22.0]), 1.0), MATT),
        part(rectangle([27.6, 8.0], [28.4, 12.0]), CLEAR),
        part(Shape::Segment { from: [4.0, 15.0], to: [13.0, 18.5], thickness: 1.6 }, MIRROR),
        part(Shape::Disc { centre: [20.3, 5.4], radius: 3.2 }, Material::Absorber),
        part(
            Shape::Disc { centre: [21.0, 15.5], radius: 4.1 },
            Material::Mirror { reflectance: 0.8, angle_deg: None },
        ),
        part(rectangle([9.0, 3.0], [11.0, 9.0]), Material::Clear { transmittance: 0.4 }),
        part(Shape::Polygon(vec![[2.0, 2.0], [8.0, 3.0], [5.0, 10.0]]), crystal),
        part(
            Shape::Segment { from: [14.0, 9.0], to: [14.0, 13.0], thickness: 1.0 },
            Material::Diffuse { reflectance: 0.9, angle_deg: Some(70.0) },
        ),
    ]
}

fn rough_scene() -> BuiltScene {
    built(29, 23, rough_parts())
}

/// Largest difference of two distributions' fluxes over the largest flux (1).
fn difference(a: &Field<[f64; 8]>, b: &Field<[f64; 8]>) -> f64 {
    let flat = |f: &Field<[f64; 8]>| f.values().iter().flatten().copied().collect::<Vec<_>>();
    let (a, b) = (flat(a), flat(b));
    let largest = b.iter().fold(0.0, |m: f64, v| m.max(*v));
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
}

#[test]
fn an_absorber_never_transmits() {
    let wall =
        part(Shape::Segment { from: [15.0, 0.0], to: [15.0, 20.0], thickness: 1.0 }, Material::Absorber);
    let scene = built(31, 21, vec![wall]);
    for engine in [&EightLobe as &dyn Engine, &SampleSpace] {
        let light = Light::continuous(Cell::new(7, 9), isotropic());
        let energy = lit(engine, &scene, &[light], 120).distribution.energy();
        assert!(*energy.at(Cell::new(15, 9)) > 1e-3, "the wall is lit");
        for (cell, e) in energy.iter().filter(|(c, _)| c.x > 15) {
            assert_eq!(*e, 0.0, "{} behind the wall, {cell:?}", engine.name());
        }
    }
}

/// Mirrors and matt walls of any direction in an absorbing wall, or from rim to rim, send nothing round their ends.
#[test]
fn walls_in_walls_let_nothing_through() {
    let absorbing = || part(rectangle([10.0, 0.0], [10.0, 20.0]), Material::Absorber);
    let angles = [None, Some(0.0), Some(20.0), Some(45.0), Some(90.0), Some(135.0)];
    for angle_deg in angles {
        for material in [
            Material::Mirror { reflectance: 1.0, angle_deg },
            Material::Diffuse { reflectance: 0.9, angle_deg },
        ] {
            let inset = part(rectangle([10.0, 9.0], [10.0, 11.0]), material.clone());
            let across = part(
                Shape::Segment { from: [7.0, 10.0], to: [13.0, 10.0], thickness: 1.0 },
                material.clone(),
            );
            let spot = part(Shape::Disc { centre: [10.0, 10.0], radius: 0.6 }, material.clone());
            let whole =
                part(Shape::Segment { from: [10.0, 0.0], to: [10.0, 20.0], thickness: 1.0 }, material);
            for parts in
                [vec![absorbing(), inset], vec![absorbing(), spot], vec![across, absorbing()], vec![whole]]
            {
                let name = format!("{parts:?}");
                let scene = built(21, 21, parts);
                let light = Light::continuous(Cell::new(5, 10), isotropic());
                let energy = lit(&EightLobe, &scene, &[light], 150).distribution.energy();
                assert!(*energy.at(Cell::new(9, 10)) > 1e-3, "{name}");
                for (cell, e) in energy.iter().filter(|(c, _)| c.x > 10) {
                    assert_eq!(*e, 0.0, "{cell:?} {name}");
                }
            }
        }
    }
}

/// Thin rectangles and polygons are walls as the segment of the same cells is.
#[test]
fn thin_walls_lie_along_their_longer_side() {
    let shapes = |from: [f64; 2], to: [f64; 2]| {
        let [[x0, y0], [x1, y1]] = [from, to];
        [
            rectangle(from, to),
            Shape::Polygon(vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]),
            Shape::Segment { from, to, thickness: 1.0 },
        ]
    };
    for shape in shapes([10.0, 2.0], [10.0, 18.0]) {
        for y in 3..18 {
            assert_eq!(shape.surface_deg(Cell::new(10, y)), 90.0, "{shape:?} {y}");
        }
    }
    for shape in shapes([2.0, 10.0], [18.0, 10.0]) {
        for x in 3..18 {
            assert_eq!(shape.surface_deg(Cell::new(x, 10)), 0.0, "{shape:?} {x}");
        }
    }
    // As wide as a cell.
    let wide = rectangle([9.5, 0.0], [10.5, 20.0]);
    assert!((1..20).all(|y| wide.surface_deg(Cell::new(10, y)) == 90.0));
}

#[test]
fn a_closed_box_of_perfect_mirrors_keeps_its_energy() {
    let room = rectangle([3.0, 4.0], [18.0, 15.0]);
    let disc = Shape::Disc { centre: [11.2, 9.7], radius: 7.5 };
    let tilted = Shape::Polygon(vec![[3.0, 6.0], [14.0, 2.0], [19.5, 9.0], [9.0, 17.5]]);
    for (shape, thickness, material) in [
        (room.clone(), 1.0, MIRROR),
        (room, 1.0, MATT),
        (disc.clone(), 1.5, MIRROR),
        (disc, 1.5, MATT),
        (tilted.clone(), 1.5, MIRROR),
        (tilted, 1.5, MATT),
    ] {
        let name = format!("{shape:?} of {material:?}");
        let scene = built(23, 20, vec![part(outline(shape, thickness), material)]);
        assert_eq!(tigereye_scenes::leaks(&scene), Vec::<[Cell; 2]>::new(), "{name}");
        let light = Light::impulse(Cell::new(9, 8), beam());
        let before = isotropic_energy(&light);
        let after = lit(&EightLobe, &scene, &[light], 10_000).distribution.total_energy();
        assert!((after / before - 1.0).abs() < 1e-12, "{name}: {before} before, {after} after");
    }
}

/// What an impulse emits, W.
fn isotropic_energy(light: &Light) -> f64 {
    let d = directions(SAMPLES);
    d.step_rad() * light.initial_profile(d).samples().iter().sum::<f64>()
}

#[test]
fn a_mirror_takes_the_part_that_it_does_not_reflect() {
    let material = Material::Mirror { reflectance: 0.75, angle_deg: None };
    let scene = built(
        9,
        9,
        vec![part(Shape::Segment { from: [4.0, 0.0], to: [4.0, 8.0], thickness: 1.0 }, material)],
    );
    // One sample to the right: all of it hits the mirror after one step, less what the cones at the sides take.
    let pulse = |t| {
        Light::impulse(
            Cell::new(3, 4),
            PolarProfile::from_fn(directions(SAMPLES), |i| f64::from(u8::from(i == t))),
        )
    };
    let one = lit(&EightLobe, &scene, &[pulse(0)], 1).distribution;
    let two = lit(&EightLobe, &scene, &[pulse(0)], 2).distribution;
    assert!(one.incoming().at(Cell::new(4, 4))[0] > 0.0);
    let on_mirror: f64 = one.incoming().iter().filter(|(c, _)| c.x == 4).flat_map(|(_, a)| *a).sum();
    assert!((on_mirror / one.total_energy() - 1.0).abs() < 1e-15, "everything travels right");
    assert!((two.total_energy() / one.total_energy() - 0.75).abs() < 1e-15);
}

#[test]
fn a_mirror_image_of_the_scene_gives_the_mirror_image_of_the_light() {
    let w = 29.0;
    let flip = |[x, y]: [f64; 2]| [w - 1.0 - x, y];
    let parts = rough_parts()
        .into_iter()
        .map(|p| part(moved(p.shape, &flip), turned(p.material, |a| 180.0 - a, Field::mirrored_x)))
        .collect();
    let (scene, image) = (rough_scene(), built(29, 23, parts));
    let mirrored = PolarProfile::from_fn(directions(SAMPLES), |t| {
        beam().samples()[(SAMPLES / 2 + SAMPLES - t) % SAMPLES]
    });
    let a = lit(&EightLobe, &scene, &[Light::continuous(Cell::new(12, 12), beam())], 90);
    let b = lit(&EightLobe, &image, &[Light::continuous(Cell::new(16, 12), mirrored)], 90);
    let back = Field::from_fn(scene.surfaces.grid(), |c| {
        let there = b.distribution.incoming().at(Cell::new(28 - c.x, c.y));
        std::array::from_fn(|k| there[(12 - k) % 8])
    });
    // The order of sums differs: rounding.
    assert!(difference(&back, a.distribution.incoming()) < 1e-12);
}

#[test]
fn turning_the_scene_turns_the_light() {
    let w = 29.0;
    let turn = |[x, y]: [f64; 2]| [y, w - 1.0 - x];
    let parts = rough_parts()
        .into_iter()
        .map(|p| part(moved(p.shape, &turn), turned(p.material, |a| a + 90.0, Field::quarter_turned)))
        .collect();
    let (scene, image) = (rough_scene(), built(23, 29, parts));
    let turned = PolarProfile::from_fn(directions(SAMPLES), |t| {
        beam().samples()[(t + SAMPLES - SAMPLES / 4) % SAMPLES]
    });
    let a = lit(&EightLobe, &scene, &[Light::continuous(Cell::new(12, 12), beam())], 90);
    let b = lit(&EightLobe, &image, &[Light::continuous(Cell::new(12, 16), turned)], 90);
    let back = Field::from_fn(scene.surfaces.grid(), |c| {
        let there = b.distribution.incoming().at(Cell::new(c.y, 28 - c.x));
        std::array::from_fn(|k| there[(k + 2) % 8])
    });
    assert!(difference(&back, a.distribution.incoming()) < 1e-12);
}

/// A shape with its points moved.
fn moved(shape: Shape, by: &dyn Fn([f64; 2]) -> [f64; 2]) -> Shape {
    match shape {
        Shape::Rectangle { from, to } => Shape::Rectangle { from: by(from), to: by(to) },
        Shape::Disc { centre, radius } => Shape::Disc { centre: by(centre), radius },
        Shape::Segment { from, to, thickness } => Shape::Segment { from: by(from), to: by(to), thickness },
        Shape::Polygon(corners) => Shape::Polygon(corners.into_iter().map(by).collect()),
        Shape::Outline { of, thickness } => outline(moved(*of, by), thickness),
        other => panic!("{other:?} is not among the parts"),
    }
}

fn turned(
    material: Material,
    angle: impl Fn(f64) -> f64,
    tensors: impl Fn(&Field<tigereye_core::Tensor2>) -> Field<tigereye_core::Tensor2>,
) -> Material {
    match material {
        Material::Mirror { reflectance, angle_deg } => {
            Material::Mirror { reflectance, angle_deg: angle_deg.map(angle) }
        }
        Material::Diffuse { reflectance, angle_deg } => {
            Material::Diffuse { reflectance, angle_deg: angle_deg.map(angle) }
        }
        Material::Crystal { field, at, normalization } => {
            Material::Crystal { field: tensors(&field), at, normalization }
        }
        other => other,
    }
}

#[test]
fn a_corner_reflector_sends_light_back() {
    // Two mirrors at a right angle, open to the left: whatever comes from there returns in the opposite direction.
    let walls = vec![
        part(Shape::Segment { from: [8.0, 0.0], to: [20.0, 12.0], thickness: 1.5 }, MIRROR),
        part(Shape::Segment { from: [20.0, 12.0], to: [8.0, 24.0], thickness: 1.5 }, MIRROR),
    ];
    let scene = built(25, 25, walls);
    let only = |k: usize| PolarProfile::from_fn(directions(SAMPLES), |t| f64::from(u8::from(t == 2 * k)));
    let steps = 40;
    for (k, cell) in [(0, Cell::new(8, 10)), (0, Cell::new(8, 15))] {
        let scheme = scheme(SAMPLES);
        let lights = [Light::impulse(cell, only(k))];
        let (mut out, mut back) = (0.0, 0.0);
        EightLobe
            .propagate_observed(&problem(&scheme, &scene.transmission, &lights, steps), &mut |view| {
                // Through the upright line x = 6: to the left it is on its way back, and leaves at the rim soon after.
                let light = view.distribution();
                for (c, a) in light.incoming().iter() {
                    if c.x == 6 {
                        back += a[4] + a[3] + a[5];
                    }
                    if c.x == 22 {
                        out += a[0] + a[1] + a[7];
                    }
                }
                std::ops::ControlFlow::Continue(())
            })
            .expect("a propagation");
        let sent = isotropic_energy(&lights[0]);
        assert_eq!(out, 0.0, "nothing passes the mirrors");
        assert!(back > 0.5 * sent, "{back} of {sent} comes back from {cell:?}");
    }
}

#[test]
fn the_engines_agree_on_scenes() {
    let scene = rough_scene();
    let lights =
        [Light::continuous(Cell::new(12, 12), beam()), Light::impulse(Cell::new(5, 20), isotropic())];
    for steps in [1, 2, 3, 40, 150] {
        let reduced = lit(&EightLobe, &scene, &lights, steps);
        let oracle = lit(&SampleSpace, &scene, &lights, steps);
        assert!(
            difference(reduced.distribution.incoming(), oracle.distribution.incoming()) < 1e-13,
            "{steps} steps"
        );
        assert_eq!(reduced.work.steps, oracle.work.steps);
    }
}

/// Light of all pulses of some cells, solved by the engine of gradients.
fn pulses<T: Real>(
    scene: &BuiltScene,
    level: Level,
    cell: Cell,
    stopping: &Stopping,
) -> Vec<PulseDistribution<T>> {
    let scheme = scheme(SAMPLES);
    let scattering = Scattering::new(&scheme, &scene.transmission);
    let mut results = vec![PulseDistribution::dark(scattering.grid().cells()); 8];
    let samples: Vec<usize> = (0..8).map(|i| 2 * i + i % 2).collect();
    PulseSolver::new(&scattering, level).solve(cell, &samples, stopping, &mut results);
    results
}

fn as_field<T: Real>(scene: &BuiltScene, pulse: &PulseDistribution<T>) -> Field<[f64; 8]> {
    let grid = scene.surfaces.grid();
    Field::from_fn(grid, |c| pulse.lobes()[grid.index(c)].map(|v| v.to_f64()))
}

#[test]
fn pulses_in_scenes_are_those_of_the_plain_engine() {
    let scene = rough_scene();
    for (cell, steps) in [(Cell::new(12, 12), 37), (Cell::new(26, 10), 24), (Cell::new(4, 5), 60)] {
        let stopping = Stopping::steps(steps);
        let exact = pulses::<f64>(&scene, Level::detect(), cell, &stopping);
        let single = pulses::<f32>(&scene, Level::detect(), cell, &stopping);
        for (i, (pulse, single)) in exact.iter().zip(&single).enumerate() {
            let light = Light::pulse(cell, 2 * i + i % 2);
            let plain = lit(&EightLobe, &scene, &[light], steps);
            let plain = plain.distribution.incoming();
            assert!(difference(&as_field(&scene, pulse), plain) < 1e-13, "{cell:?}, {i}");
            assert!(difference(&as_field(&scene, single), plain) < 1e-5, "{cell:?}, {i}, single precision");
        }
    }
}

#[test]
fn every_level_gives_the_same_bits_in_scenes() {
    let scene = rough_scene();
    let stopping = Stopping { max_iterations: 300, ..Stopping::REFERENCE };
    let reference = pulses::<f64>(&scene, Level::BASELINE, Cell::new(12, 12), &stopping);
    for level in Level::available() {
        let other = pulses::<f64>(&scene, level, Cell::new(12, 12), &stopping);
        for (a, b) in reference.iter().zip(&other) {
            assert!(a.lobes() == b.lobes(), "{}", level.name());
        }
    }
}

#[test]
fn stationary_light_in_scenes_is_that_of_many_steps() {
    let scene = rough_scene();
    let cell = Cell::new(12, 12);
    let settled = pulses::<f64>(&scene, Level::detect(), cell, &Stopping::STATIONARY);
    for (i, pulse) in settled.iter().enumerate() {
        let plain = lit(&EightLobe, &scene, &[Light::pulse(cell, 2 * i + i % 2)], 4000);
        // A relative change of 1e-10 a step leaves about 1e-8 where light stays for a hundred steps.
        let d = difference(&as_field(&scene, pulse), plain.distribution.incoming());
        assert!(d < 1e-7, "{i}: {d:e}");
    }
}

#[test]
fn pulses_in_walls_shine_on_nothing() {
    let scene = rough_scene();
    let stopping = Stopping { max_iterations: 20, ..Stopping::REFERENCE };
    let wall = Cell::new(14, 11);
    assert!(scene.transmission.reflection(wall).is_some());
    for pulse in pulses::<f64>(&scene, Level::detect(), wall, &stopping) {
        assert!(pulse.lobes().iter().flatten().all(|v| *v == 0.0));
    }
    let scheme = scheme(SAMPLES);
    let lights = [Light::continuous(wall, isotropic())];
    let refused = EightLobe.propagate(&problem(&scheme, &scene.transmission, &lights, 3));
    assert_eq!(refused, Err(TransportError::LightInWall { x: 14, y: 11 }));
}

#[test]
fn gradients_of_scenes_do_not_depend_on_tiles() {
    let scene = built(13, 11, {
        let mut parts = vec![part(outline(rectangle([0.0, 0.0], [12.0, 10.0]), 1.0), MATT)];
        parts.push(part(Shape::Segment { from: [6.0, 0.0], to: [6.0, 6.0], thickness: 1.0 }, MIRROR));
        parts
    });
    let scheme = scheme(SAMPLES);
    let scattering = Scattering::new(&scheme, &scene.transmission);
    let settings = |memory_bytes| LtgSettings {
        stopping: Stopping { max_iterations: 100, ..Stopping::REFERENCE },
        memory_bytes,
        ..LtgSettings::reference(directions(SAMPLES))
    };
    let whole = sweep(&scattering, &settings(1 << 30), &()).expect("a sweep");
    let strips = sweep(&scattering, &settings(3 << 20), &()).expect("a sweep in strips");
    assert!(whole.volume == strips.volume);
    let slice = whole.volume.max_over_directions();
    // The shadow's edge behind the mirror parts what is seen on both sides of it.
    assert!(*slice.at(Cell::new(6, 7)) > 0.0);
}

#[test]
fn a_crystal_that_fills_the_scene_is_its_field() {
    let tensors = field("inverse:size=21");
    let own = transmission(&tensors, SAMPLES, Normalization::Local);
    let crystal =
        Material::Crystal { field: tensors, at: Cell::new(0, 0), normalization: Normalization::Local };
    let scene = built(21, 21, vec![part(rectangle([0.0, 0.0], [20.0, 20.0]), crystal)]);
    assert!(scene.transmission == own);
}

#[test]
fn light_distributions_of_scenes_are_finite() {
    let light: LightDistribution =
        lit(&EightLobe, &rough_scene(), &[Light::continuous(Cell::new(12, 12), beam())], 200).distribution;
    assert!(light.samples().iter().all(|v| v.is_finite() && *v >= 0.0));
}
