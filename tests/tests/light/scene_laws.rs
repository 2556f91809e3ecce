//! Laws of light in scenes: walls absorb and reflect, and neither directions nor engines are told apart.

use crate::common::{directions, scheme, transmission};
use tigereye_core::{
    Cell, Field, Grid, NEIGHBOUR_OFFSETS, Normalization, PolarProfile, Surface, TransmissionField, math,
};
use tigereye_ltg::{LtgSettings, sweep};
use tigereye_scenes::{Layout, Mask, Material, Part, Scene, Shape};
use tigereye_test_support::field;
use tigereye_transport::{
    ENGINES, EightLobe, Engine, Level, Light, Outcome, Problem, PulseDistribution, PulseSolver, Real,
    SampleSpace, Scattering, Scheme, Stopping, TransportError,
};

const SAMPLES: usize = 16;

const CLEAR: Material = Material::Clear { transmittance: 1.0 };
const MIRROR: Material = Material::Mirror { reflectance: 1.0, angle_deg: None };
const DIFFUSE: Material = Material::Diffuse { reflectance: 1.0, angle_deg: None };

struct BuiltScene {
    scene: Scene,
    layout: Layout,
    transmission: TransmissionField,
}

impl BuiltScene {
    /// The part of the light that a cell passes on or sends back, by its material.
    fn passed(&self, cell: Cell) -> f64 {
        match self.layout.part_of.at(cell).map(|i| &self.scene.parts[i].material) {
            None => 1.0,
            Some(Material::Clear { transmittance }) => *transmittance,
            Some(Material::Absorber) => 0.0,
            Some(Material::Mirror { reflectance, .. } | Material::Diffuse { reflectance, .. }) => {
                *reflectance
            }
            Some(Material::Crystal { .. }) => self.transmission.rate(cell),
        }
    }
}

fn built(width: usize, height: usize, parts: Vec<Part>) -> BuiltScene {
    let grid = Grid::new(width, height).expect("a grid");
    let scene = Scene { grid, parts };
    let layout = scene.layout().expect("a layout");
    let transmission = scene.transmission(&layout, directions(SAMPLES)).expect("a transmission");
    BuiltScene { scene, layout, transmission }
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
        part(outline(rectangle([0.0, 0.0], [28.0, 22.0]), 1.0), DIFFUSE),
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
        part(rectangle([17.0, 11.0], [19.0, 11.0]), MIRROR),
        part(
            bitmap(5, 11, &["##..", "###.", "#..#", "#..."]),
            Material::Mirror { reflectance: 0.7, angle_deg: None },
        ),
        part(rectangle([15.0, 6.0], [15.0, 6.0]), MIRROR),
        part(Shape::Disc { centre: [11.0, 12.0], radius: 0.4 }, DIFFUSE),
        part(rectangle([20.0, 9.0], [21.0, 9.0]), MIRROR),
        part(
            Shape::Outside(Box::new(Shape::Disc { centre: [14.0, 10.5], radius: 16.4 })),
            Material::Mirror { reflectance: 0.95, angle_deg: None },
        ),
    ]
}

fn bitmap(x: usize, y: usize, rows: &[&str]) -> Shape {
    let mask = Mask::from_fn(rows[0].len(), rows.len(), |c| rows[c.y].as_bytes()[c.x] == b'#');
    Shape::Bitmap { at: Cell::new(x, y), mask }
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
    for &engine in ENGINES {
        let light = Light::continuous(Cell::new(7, 9), isotropic());
        let energy = lit(engine, &scene, &[light], 120).distribution.energy();
        assert!(*energy.at(Cell::new(15, 9)) > 1e-3, "the wall is lit");
        for (cell, e) in energy.iter().filter(|(c, _)| c.x > 15) {
            assert_eq!(*e, 0.0, "{} behind the wall, {cell:?}", engine.name());
        }
    }
}

/// Mirrors and diffuse walls of any direction in an absorbing wall, or from rim to rim, send nothing round their ends.
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
    let grid = Grid::new(21, 21).expect("a grid");
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
            assert_eq!(shape.surface_deg(grid, Cell::new(10, y)), Some(90.0), "{shape:?} {y}");
        }
    }
    for shape in shapes([2.0, 10.0], [18.0, 10.0]) {
        for x in 3..18 {
            assert_eq!(shape.surface_deg(grid, Cell::new(x, 10)), Some(0.0), "{shape:?} {x}");
        }
    }
    // As wide as a cell.
    let wide = rectangle([9.5, 0.0], [10.5, 20.0]);
    assert!((1..20).all(|y| wide.surface_deg(grid, Cell::new(10, y)) == Some(90.0)));
}

#[test]
fn a_closed_box_of_perfect_mirrors_keeps_its_energy() {
    let room = rectangle([3.0, 4.0], [18.0, 15.0]);
    let disc = Shape::Disc { centre: [11.2, 9.7], radius: 7.5 };
    let tilted = Shape::Polygon(vec![[3.0, 6.0], [14.0, 2.0], [19.5, 9.0], [9.0, 17.5]]);
    for (shape, thickness, material) in [
        (room.clone(), 1.0, MIRROR),
        (room, 1.0, DIFFUSE),
        (disc.clone(), 1.5, MIRROR),
        (disc, 1.5, DIFFUSE),
        (tilted.clone(), 1.5, MIRROR),
        (tilted, 1.5, DIFFUSE),
    ] {
        let name = format!("{shape:?} of {material:?}");
        let scene = built(23, 20, vec![part(outline(shape, thickness), material)]);
        assert_eq!(tigereye_scenes::leaks(&scene.layout), Vec::<[Cell; 2]>::new(), "{name}");
        let light = Light::impulse(Cell::new(9, 8), beam());
        let before = isotropic_energy(&light);
        let after = lit(&EightLobe, &scene, &[light], 10_000).distribution.total_energy();
        assert!((after / before - 1.0).abs() < 1e-12, "{name}: {before} before, {after} after");
    }
}

/// The same for small rooms, whose light meets a wall every few steps, with walls that are turned against it.
#[test]
fn small_closed_rooms_keep_their_energy() {
    for i in 0..72 {
        let (inner, angle_deg) = (1 + i % 3, Some(7.5 * (i / 3) as f64));
        let material = match i % 2 {
            0 => Material::Diffuse { reflectance: 1.0, angle_deg },
            _ => Material::Mirror { reflectance: 1.0, angle_deg },
        };
        let far = (inner + 2) as f64;
        let scene = built(
            inner + 4,
            inner + 4,
            vec![part(outline(rectangle([1.0, 1.0], [far, far]), 1.0), material.clone())],
        );
        let light = Light::impulse(Cell::new(2, 2), beam());
        let after = lit(&EightLobe, &scene, std::slice::from_ref(&light), 10_000).distribution.total_energy();
        let change = after / isotropic_energy(&light) - 1.0;
        assert!(change.abs() < 1e-12, "{inner} cells, {material:?}: {change:e}");
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
    let sent: f64 = isotropic_energy(&pulse(0));
    assert!((one.total_energy() / sent - 1.0).abs() < 1e-15, "empty space takes nothing");
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
    let back = Field::from_fn(scene.layout.surfaces.grid(), |c| {
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
    let back = Field::from_fn(scene.layout.surfaces.grid(), |c| {
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
        Shape::Outside(of) => Shape::Outside(Box::new(moved(*of, by))),
        Shape::Bitmap { at, mask } => {
            let all = (0..mask.height()).flat_map(|y| (0..mask.width()).map(move |x| Cell::new(x, y)));
            let marked: Vec<Cell> = all
                .filter(|c| mask.contains(*c))
                .map(|c| by([(at.x + c.x) as f64, (at.y + c.y) as f64]))
                .map(|[x, y]| Cell::new(x as usize, y as usize))
                .collect();
            let least = |of: fn(&Cell) -> usize| marked.iter().map(of).min().expect("a mark");
            let most = |of: fn(&Cell) -> usize| marked.iter().map(of).max().expect("a mark");
            let at = Cell::new(least(|c| c.x), least(|c| c.y));
            let (w, h) = (most(|c| c.x) - at.x + 1, most(|c| c.y) - at.y + 1);
            let mask = Mask::from_fn(w, h, |c| marked.contains(&Cell::new(at.x + c.x, at.y + c.y)));
            Shape::Bitmap { at, mask }
        }
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

/// Light of one direction alone, followed from wall to wall: empty space does not spread it here. Shares of it that
/// leave the grid in each direction.
fn traced(scene: &BuiltScene, from: Cell, direction: usize) -> [f64; 8] {
    let grid = scene.scene.grid;
    let mut left = [0.0; 8];
    let mut rays = std::collections::BTreeMap::from([((from.y, from.x, direction), 1.0)]);
    for _ in 0..4000 {
        let mut next = std::collections::BTreeMap::new();
        for ((y, x, k), share) in rays {
            let Some(cell) = grid.neighbour(Cell::new(x, y), k) else {
                left[k] += share;
                continue;
            };
            for out in 0..8 {
                let part = match scene.transmission.reflection(cell) {
                    None => f64::from(u8::from(out == k)),
                    Some(wall) => wall.shares()[out][k],
                };
                if part > 0.0 {
                    *next.entry((cell.y, cell.x, out)).or_insert(0.0) += share * part;
                }
            }
        }
        rays = next;
    }
    assert!(rays.values().sum::<f64>() < 1e-9, "light stays in the corner");
    left
}

#[test]
fn a_corner_reflector_sends_every_ray_back() {
    let corner = |material: Material| {
        let side = |from, to| part(Shape::Segment { from, to, thickness: 1.5 }, material.clone());
        built(25, 25, vec![side([8.0, 0.0], [20.0, 12.0]), side([20.0, 12.0], [8.0, 24.0])])
    };
    let flat = built(25, 25, vec![part(rectangle([20.0, 0.0], [20.0, 24.0]), MIRROR)]);
    let (mirrors, diffuse) = (corner(MIRROR), corner(DIFFUSE));
    let mut of_diffuse = 0.0;
    for y in 3..=21 {
        for k in [0, 1, 7] {
            let back = |scene: &BuiltScene| traced(scene, Cell::new(7, y), k)[(k + 4) % 8];
            assert_eq!(back(&mirrors), 1.0, "row {y}, direction {k}");
            assert!(k == 0 || back(&flat) == 0.0, "a flat mirror, row {y}, direction {k}");
            of_diffuse += back(&diffuse) / (19.0 * 3.0);
        }
    }
    assert!(of_diffuse < 0.7, "a diffuse corner sends {of_diffuse} back");
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
    let grid = scene.layout.surfaces.grid();
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

/// Nothing leaves a closed room: light fills it until as much comes back to the pulse as it sends.
#[test]
fn closed_rooms_have_a_stationary_light() {
    for material in [MIRROR, DIFFUSE] {
        let scene = built(8, 8, vec![part(outline(rectangle([1.0, 1.0], [6.0, 6.0]), 1.0), material)]);
        let cell = Cell::new(3, 3);
        let settled = pulses::<f64>(&scene, Level::detect(), cell, &Stopping::STATIONARY);
        let plain = pulses::<f64>(&scene, Level::detect(), cell, &Stopping::steps(20_000));
        let single = pulses::<f32>(&scene, Level::detect(), cell, &Stopping::STATIONARY);
        for (i, pulse) in plain.iter().enumerate() {
            let filled = as_field(&scene, pulse);
            let d = difference(&as_field(&scene, &settled[i]), &filled);
            assert!(d < 1e-7, "{i}: {d:e}");
            let d = difference(&as_field(&scene, &single[i]), &filled);
            assert!(d < 1e-4, "{i}, f32: {d:e}");
        }
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
        let mut parts = vec![part(outline(rectangle([0.0, 0.0], [12.0, 10.0]), 1.0), DIFFUSE)];
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

/// What leaves a cell for its neighbours is what arrived in it, times what its material passes on or sends back.
#[test]
fn every_cell_keeps_the_balance_of_its_material() {
    let scene = rough_scene();
    let grid = scene.scene.grid;
    let light = [Light::impulse(Cell::new(12, 12), beam())];
    for steps in [1, 2, 7, 30, 100] {
        let now = lit(&EightLobe, &scene, &light, steps).distribution;
        let next = lit(&EightLobe, &scene, &light, steps + 1).distribution;
        let largest = now.incoming().values().iter().flatten().copied().fold(0.0, f64::max);
        for cell in grid.iter().filter(|c| !grid.is_border(*c)) {
            let arrived: f64 = now.incoming().at(cell).iter().sum();
            let sent = (0..8).filter_map(|k| Some((k, grid.neighbour(cell, k)?)));
            let left: f64 = sent.map(|(k, there)| next.incoming().at(there)[k]).sum();
            let expected = scene.passed(cell) * arrived;
            assert!((left - expected).abs() < 1e-14 * largest, "{cell:?}, step {steps}: {left}, {expected}");
        }
        assert!(next.samples().iter().all(|v| v.is_finite() && *v >= 0.0));
    }
}

/// The matrix of every wall, derived a second time: reflection of vectors, cosines as scalar products, and a flood
/// round the cell for what lies on its side.
#[test]
fn walls_reflect_as_vectors_do() {
    let scene = rough_scene();
    let mut seen = [0; 4];
    for (cell, reflection) in scene.transmission.reflections() {
        let reflectance = scene.passed(cell);
        let surface = scene.layout.surfaces.at(cell).expect("a surface");
        let beside: [Option<bool>; 8] = std::array::from_fn(|k| {
            // Whether light goes on there; `None` for walls that send it back.
            match scene.scene.grid.neighbour(cell, k) {
                None => Some(false),
                Some(next) => match scene.layout.surfaces.at(next) {
                    Some(Surface::Mirror { .. } | Surface::Diffuse { .. }) => None,
                    Some(Surface::Absorbing) => Some(false),
                    _ => Some(true),
                },
            }
        });
        for j in 0..8 {
            let (free, angle) = match surface {
                Surface::Mirror { angle_deg } => (mirrored(angle_deg, j), angle_deg),
                Surface::Diffuse { angle_deg } => (scattered(angle_deg, j), angle_deg),
                other => panic!("{other:?} sends nothing back"),
            };
            seen[usize::from(angle.is_some())] += 1;
            let from = (j + 4) % 8;
            let reached = flood(&beside, from);
            let mut expected = [0.0; 8];
            for k in 0..8 {
                expected[if reached[k] { k } else { from }] += reflectance * free[k];
                seen[2 + usize::from(reached[k])] += 1;
            }
            for k in 0..8 {
                let got = reflection.shares()[k][j];
                assert!((got - expected[k]).abs() < 1e-14, "{cell:?} {surface:?}: {j} to {k}: {got}");
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 0), "with and without a direction, on both sides: {seen:?}");
}

/// Unit vector of a direction, y upwards.
fn unit(k: usize) -> [f64; 2] {
    let (dx, dy) = NEIGHBOUR_OFFSETS[k];
    let (x, y) = (dx as f64, -(dy as f64));
    [x / math::hypot(x, y), y / math::hypot(x, y)]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Degrees.
fn angle_between(a: [f64; 2], b: [f64; 2]) -> f64 {
    math::degrees(math::atan2(a[0] * b[1] - a[1] * b[0], dot(a, b))).abs()
}

/// Normal of a wall; that of one without a direction is the light's.
fn normal(angle_deg: Option<f64>, j: usize) -> [f64; 2] {
    angle_deg.map_or(unit(j), |a| [-math::sin(math::radians(a)), math::cos(math::radians(a))])
}

fn mirrored(angle_deg: Option<f64>, j: usize) -> [f64; 8] {
    let (d, n) = (unit(j), normal(angle_deg, j));
    let out = [d[0] - 2.0 * dot(d, n) * n[0], d[1] - 2.0 * dot(d, n) * n[1]];
    // The two of the eight directions about it, by the angle to them.
    let mut near: Vec<(f64, usize)> =
        (0..8).map(|k| (angle_between(out, unit(k)), k)).filter(|(deg, _)| *deg < 45.0 - 1e-5).collect();
    // Not through the wall.
    near.retain(|(_, k)| dot(d, n).abs() < 1e-9 || dot(d, n) * dot(unit(*k), n) < 1e-9);
    let mut shares = [0.0; 8];
    match near[..] {
        [(_, k)] => shares[k] = 1.0,
        [(a, k), (b, l)] => {
            (shares[k], shares[l]) = (b / (a + b), a / (a + b));
        }
        _ => panic!("{near:?}"),
    }
    shares
}

fn scattered(angle_deg: Option<f64>, j: usize) -> [f64; 8] {
    let n = normal(angle_deg, j);
    let (from, cosines) = (dot(unit(j), n), std::array::from_fn::<f64, 8, _>(|k| dot(unit(k), n)));
    let back = cosines.map(|c| if from.abs() < 1e-9 { c.abs() } else { (-c * from.signum()).max(0.0) });
    let back = back.map(|c| if c < 1e-9 { 0.0 } else { c });
    let sum: f64 = back.iter().sum();
    back.map(|c| c / sum)
}

/// The neighbours that can be walked to round the cell, from one that is no wall over open ones.
fn flood(beside: &[Option<bool>; 8], from: usize) -> [bool; 8] {
    let mut reached = [false; 8];
    reached[from] = true;
    // From another wall nothing arrives.
    let mut border = if beside[from].is_some() { vec![from] } else { Vec::new() };
    while let Some(k) = border.pop() {
        for next in [(k + 1) % 8, (k + 7) % 8] {
            // The walk may end beside an absorber, and begin there, but not pass it.
            if !reached[next] && beside[next].is_some() {
                reached[next] = true;
                if beside[next] == Some(true) {
                    border.push(next);
                }
            }
        }
    }
    reached
}
