//! Results lie on their data: light, gradients, lines, exponents and ridges of one file in the file's world.

use crate::support::Place;
use serde_json::Value;
use tigereye_core::{Cell, Field, Tensor2};
use tigereye_io::volume::points_from_image;
use tigereye_io::{DataArray, ImageData, PolyData, npy, vti, vtp};

/// Directions of the axes of the test volume, one a row: oblique, each nearest to its own axis of the world.
const AXES: [[f64; 3]; 3] = [[0.8, 0.6, 0.0], [-0.576, 0.768, 0.28], [0.168, -0.224, 0.96]];
const SPACING: [f64; 3] = [0.5, 0.5, 2.0];
const ORIGIN: [f64; 3] = [10.0, -20.0, 30.0];
/// Rows and columns of its layers, and its layers.
const SIDE: usize = 13;
const LAYERS: usize = 3;
/// The layer that the tests look at.
const LAYER: usize = 1;
/// Rounding of positions of some tens.
const POSITION: f64 = 1e-9;

/// The order of a file's axes: the world axis of each, and whether it runs against it.
#[derive(Clone, Copy)]
struct Order([usize; 3], [bool; 3]);

const PLAIN: Order = Order([0, 1, 2], [false; 3]);
const TURNED: Order = Order([2, 1, 0], [true, true, false]);

impl Order {
    /// The option that chooses the layer.
    fn slice(self) -> String {
        let axis = self.0.iter().position(|w| *w == 2).unwrap();
        let index = if self.1[axis] { LAYERS - 1 - LAYER } else { LAYER };
        format!("{}={index}", ["x", "y", "z"][axis])
    }
}

/// A generator's field.
fn field(place: &Place) -> Field<Tensor2> {
    place.succeeds(&["convert", "bow:size=13", "field.npy", "--force"]);
    npy::read_tensors(&place.read("field.npy")).unwrap()
}

/// A tensor of a plane of the first two axes along the axes of the world.
fn in_world(t: &Tensor2) -> [f64; 9] {
    let [xx, xy, yx, yy] = t.components();
    std::array::from_fn(|n| {
        let (i, j) = (n / 3, n % 3);
        let ([a, b, _], [c, d, _]) = (AXES.map(|axis| axis[i]), AXES.map(|axis| axis[j]));
        a * (xx * c + xy * d) + b * (yx * c + yy * d)
    })
}

/// A volume that has the field in every layer, in a file of such axes.
fn volume(field: &Field<Tensor2>, Order(world, reversed): Order) -> ImageData {
    let size = [SIDE, SIDE, LAYERS];
    let mut image = ImageData::empty(world.map(|w| size[w]));
    (image.origin, image.spacing) = (ORIGIN, world.map(|w| SPACING[w]));
    let sign = |a: usize| if reversed[a] { -1.0 } else { 1.0 };
    image.direction = Some(std::array::from_fn(|i| sign(i % 3) * AXES[world[i % 3]][i / 3]));
    for w in (0..3).filter(|&a| reversed[a]).map(|a| world[a]) {
        (0..3).for_each(|i| image.origin[i] += (size[w] - 1) as f64 * SPACING[w] * AXES[w][i]);
    }
    let [nx, ny, nz] = image.dimensions;
    let values = (0..nx * ny * nz).flat_map(|point| {
        let voxel = [point % nx, point / nx % ny, point / (nx * ny)];
        let mut at = [0; 3];
        for a in 0..3 {
            at[world[a]] = if reversed[a] { image.dimensions[a] - 1 - voxel[a] } else { voxel[a] };
        }
        in_world(field.at(Cell::new(at[0], SIDE - 1 - at[1])))
    });
    image.point_arrays = vec![DataArray::new("t", 9, values.collect())];
    image
}

/// Where a point of the layer lies, in cells from the lower left, and so far towards the viewer.
fn place_of([x, y, n]: [f64; 3]) -> [f64; 3] {
    let step = [x * SPACING[0], y * SPACING[1], n + LAYER as f64 * SPACING[2]];
    [0, 1, 2].map(|i| ORIGIN[i] + (0..3).map(|a| step[a] * AXES[a][i]).sum::<f64>())
}

/// The other way: cells from the lower left, and how far off the layer.
fn cells_of(p: [f64; 3]) -> [f64; 3] {
    let first = place_of([0.0; 3]);
    let along = |a: usize| (0..3).map(|i| (p[i] - first[i]) * AXES[a][i]).sum::<f64>();
    [along(0) / SPACING[0], along(1) / SPACING[1], along(2)]
}

fn near(a: [f64; 3], b: [f64; 3]) -> bool {
    (0..3).all(|i| (a[i] - b[i]).abs() < POSITION)
}

fn poly_data(place: &Place, name: &str) -> PolyData {
    vtp::read(&place.read(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn parameters(image: &ImageData) -> Value {
    serde_json::from_str::<Value>(image.text("tigereye").unwrap()).unwrap()["parameters"].clone()
}

/// The image's points lie over the cells, so many of them a cell, and the frame is right, up, right x up.
fn lies_on_the_layer(image: &ImageData, samples: f64, what: &str) {
    let points = points_from_image(image.clone()).points;
    for (i, p) in points.into_iter().take(image.dimensions[0] * image.dimensions[1]).enumerate() {
        let at = [i % image.dimensions[0], i / image.dimensions[0]].map(|n| n as f64 / samples);
        assert!(near(p, place_of([at[0], at[1], 0.0])), "{what}: point {i} at {p:?}");
    }
    let direction: [f64; 9] = std::array::from_fn(|i| AXES[i % 3][i / 3]);
    let off = image.direction.unwrap().into_iter().zip(direction).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < POSITION, "{what}: {:?}", image.direction);
    assert_eq!(parameters(image)["rows"], "upwards", "{what}");
}

#[test]
fn everything_made_of_an_oblique_slice_lies_on_it() {
    for order in [PLAIN, TURNED] {
        let place = Place::new();
        place.write("v.vti", vti::write(&volume(&field(&place), order)).unwrap());
        let run = |command: &str, rest: &[&str]| {
            place.succeeds(&[&[command, "v.vti", "--slice", &order.slice()], rest].concat());
        };
        let scheme = ["--normalization", "local", "--directions", "16"];
        // The lamp is in column 4 and row 2 from the top.
        run("propagate", &[&scheme[..], &["--light", "4,2", "-o", "light.vti", "steps.pvd"]].concat());
        for file in ["light.vti", "steps/0003.vti"] {
            let image = place.image(file);
            lies_on_the_layer(&image, 1.0, file);
            let energy = &image.point_array("energy").unwrap().values;
            let brightest = (0..energy.len()).max_by(|&a, &b| energy[a].total_cmp(&energy[b])).unwrap();
            assert_eq!(brightest, (SIDE - 1 - 2) * SIDE + 4, "{file}");
            // Nothing flows out of the plane, and the lamp shines away from itself.
            let flux = |point: usize| -> [f64; 3] {
                image.point_array("flux").unwrap().values[3 * point..][..3].try_into().unwrap()
            };
            let along = |v: [f64; 3], a: usize| (0..3).map(|i| v[i] * AXES[a][i]).sum::<f64>();
            assert!((0..energy.len()).all(|p| along(flux(p), 2).abs() < POSITION), "{file}");
            assert!(along(flux(brightest + 1), 0) > 0.0 && along(flux(brightest + SIDE), 1) > 0.0, "{file}");
        }
        run("ftle", &["--samples", "2", "--length", "3", "-o", "ftle.vti"]);
        lies_on_the_layer(&place.image("ftle.vti"), 2.0, "ftle");
        run("lic", &["--samples", "3", "-o", "lic.vti"]);
        lies_on_the_layer(&place.image("lic.vti"), 3.0, "lic");
        place.succeeds(&["ridges", "lic.vti", "-o", "ridges.vtp"]);
        run("lines", &["-o", "lines.vtp"]);
        run("glyphs", &["-o", "glyphs.vtp"]);
        run("topology", &["-o", "topology.vtp"]);
        for file in ["lines.vtp", "glyphs.vtp", "topology.vtp", "ridges.vtp"] {
            let points = poly_data(&place, file).points;
            assert!(file == "topology.vtp" || !points.is_empty(), "{file}");
            for p in points {
                let [x, y, off] = cells_of(p);
                let inside = |v: f64| (-0.5..=SIDE as f64 - 0.5).contains(&v);
                assert!(inside(x) && inside(y) && off.abs() < POSITION, "{file}: {p:?}");
            }
        }
    }
}

/// A gradient stands on its field: its first layer lies on it, the others follow at right angles, and so do ridges in
/// them.
#[test]
fn gradients_and_their_ridges_lie_on_the_slice() {
    let place = Place::new();
    place.write("v.vti", vti::write(&volume(&field(&place), TURNED)).unwrap());
    let slice = TURNED.slice();
    let ltg = ["ltg", "v.vti", "--slice", &slice, "--normalization", "local", "--directions", "16"];
    place.succeeds(&[&ltg[..], &["-o", "g.vti", "g.npy"]].concat());
    let image = place.image("g.vti");
    let of_layer = |n: f64| place_of([0.0, 0.0, n]);
    let points = points_from_image(image.clone()).points;
    assert!(near(points[0], of_layer(0.0)) && near(points[5 * SIDE * SIDE], of_layer(5.0)));
    assert_eq!(parameters(&image)["rows"], "upwards");
    place.succeeds(&["ridges", "g.vti", "--layer", "5", "-o", "r.vtp"]);
    let ridges = poly_data(&place, "r.vtp").points;
    assert!(!ridges.is_empty());
    let height = cells_of(of_layer(5.0))[2];
    assert!(ridges.iter().all(|p| (cells_of(*p)[2] - height).abs() < POSITION));
    // Row by row the numbers are those of the array, which begins on top.
    let (array, values) =
        (npy::read_array(&place.read("g.npy")).unwrap().values, &image.point_arrays[0].values);
    for (i, v) in values.iter().enumerate() {
        let (x, up, t) = (i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE));
        assert_eq!(*v, array[(t * SIDE + SIDE - 1 - up) * SIDE + x]);
    }
    // Shards know the place.
    for k in ["0", "1"] {
        let (shard, part) = (format!("{k}/2"), format!("{k}.part"));
        place.succeeds(&[&ltg[..], &["--shard", &shard, "-o", &part]].concat());
    }
    place.succeeds(&["merge", "1.part", "0.part", "-o", "m.vti"]);
    let mut merged = place.image("m.vti");
    let story =
        |image: &ImageData| -> Value { serde_json::from_str(image.text("tigereye").unwrap()).unwrap() };
    assert_eq!(parameters(&merged), parameters(&image));
    assert_eq!(story(&merged)["input_blake3"], story(&image)["input_blake3"]);
    merged.field_data = image.field_data.clone();
    assert_eq!(vti::write(&merged).unwrap(), place.read("g.vti"), "all but the command");
    // And so does a checkpoint.
    for _ in 0..2 {
        place.succeeds(&[&ltg[..], &["--checkpoint", "state", "-o", "c.vti"]].concat());
        assert_eq!(place.image("c.vti").origin, image.origin);
    }
}

/// The same field with and without a place: the same numbers for `compare`, the same pictures of ridges on axes in
/// cells.
#[test]
fn a_place_changes_no_number_and_no_picture() {
    let (placed, plain) = (Place::new(), Place::new());
    let tensors = field(&plain);
    placed.write("v.vti", vti::write(&volume(&tensors, PLAIN)).unwrap());
    placed.says(&["convert", "v.vti", "f.npy", "--slice", &PLAIN.slice()], "the plane is oblique");
    plain.write("f.npy", placed.read("f.npy"));
    let both = |args: &[&str]| {
        let slice = PLAIN.slice();
        placed.succeeds(&[&[args[0], "v.vti", "--slice", &slice], &args[1..]].concat());
        plain.says(&[&[args[0], "f.npy"], &args[1..]].concat(), "took row 0 on top");
    };
    both(&["ltg", "--directions", "8", "-o", "g.vti"]);
    both(&["propagate", "--directions", "8", "--light", "3,2", "-o", "l.vti"]);
    both(&["ftle", "--samples", "2", "--length", "3", "-o", "e.vti"]);
    assert_eq!(parameters(&plain.image("g.vti"))["rows"], "downwards");
    assert_eq!((plain.image("g.vti").origin, plain.image("g.vti").direction), ([0.0; 3], Some(UNIT)));
    for file in ["g.vti", "l.vti", "e.vti"] {
        let other = plain.path(file).display().to_string();
        placed.succeeds(&["compare", file, &other, "--tolerance", "0"]);
    }
    for place in [&placed, &plain] {
        let cells = ["--coordinates", "cells"];
        place.succeeds(&[&["ridges", "g.vti", "--layer", "2", "-o", "g.svg"][..], &cells].concat());
        place.succeeds(&[&["ridges", "e.vti", "--array", "FTLE", "-o", "e.svg"][..], &cells].concat());
    }
    for picture in ["g.svg", "e.svg"] {
        assert_eq!(placed.read(picture), plain.read(picture), "{picture}");
    }
    let facts = placed.succeeds(&["info", "g.vti", "--json"]).json();
    assert_eq!((&facts["rows"], &facts["spacing"]), (&"upwards".into(), &serde_json::json!([0.5, 0.5, 1.0])));
}

const UNIT: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Stress at 20 degrees on 21 x 15 points with y running fastest, round at the largest x and smallest y: as `meshgrid`
/// of NumPy and swapped direction matrices have it.
#[test]
fn grids_with_y_fastest_are_upright() {
    let place = Place::new();
    let stress = |x: usize, y: usize| {
        let (s, c) = (0.342_020_143_325_668_7_f64, 0.939_692_620_785_908_4_f64);
        let (major, minor) = if (x, y) == (20, 0) { (1.0, 1.0) } else { (3.0, 1.0) };
        let t = |a: f64, b: f64| a * major + b * minor;
        let (xx, xy, yy) = (t(c * c, s * s), t(c * s, -c * s), t(s * s, c * c));
        [xx, xy, 0.0, xy, yy, 0.0, 0.0, 0.0, 0.0]
    };
    let mut image = ImageData::empty([15, 21, 1]);
    image.direction = Some([0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    let values = (0..315).flat_map(|i| stress(i / 15, i % 15)).collect();
    image.point_arrays = vec![DataArray::new("stress", 9, values)];
    place.write("swapped.vti", vti::write(&image).unwrap());
    place.write("meshgrid.vtp", vtp::write(&points_from_image(image)).unwrap());
    for file in ["swapped.vti", "meshgrid.vtp"] {
        place.succeeds(&["convert", file, "o.npy", "--force"]);
        let tensors = npy::read_tensors(&place.read("o.npy")).unwrap();
        assert_eq!((tensors.grid().width(), tensors.grid().height()), (21, 15), "{file}");
        for (cell, t) in tensors.iter() {
            let [xx, xy, yx, yy] = t.components();
            let [a, b, _, c, d, ..] = stress(cell.x, 14 - cell.y);
            assert_eq!([xx, xy, yx, yy], [a, b, c, d], "{file} at {cell:?}");
        }
        place.succeeds(&["lines", file, "-o", "o.vtp"]);
        let points = poly_data(&place, "o.vtp").points;
        let reach = |i: usize| {
            points.iter().map(|p| p[i]).fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)))
        };
        let ((left, right), (low, high)) = (reach(0), reach(1));
        assert!(left >= -POSITION && right <= 20.0 + POSITION && right > 18.0, "{file}: {left} {right}");
        assert!(low >= -POSITION && high <= 14.0 + POSITION && high > 12.0, "{file}: {low} {high}");
    }
}

/// Parts, other numbers of cells, and field files that name a data file keep the place.
#[test]
fn parts_of_a_slice_stay_where_they_are() {
    let place = Place::new();
    place.write("v.vti", vti::write(&volume(&field(&place), PLAIN)).unwrap());
    let slice = PLAIN.slice();
    let first = |args: &[&str]| {
        place.succeeds(
            &[&["propagate", args[0], "--light", "1,1", "--steps", "1", "-o", "l.vti"], &args[1..]].concat(),
        );
        let image = place.image("l.vti");
        (cells_of(image.origin), image.spacing)
    };
    let (corner, spacing) = first(&["v.vti", "--slice", &slice, "--crop", "2:9,1:8"]);
    assert!(near(corner, [2.0, 5.0, 0.0]) && spacing == [0.5, 0.5, 1.0], "{corner:?}");
    let (corner, spacing) = first(&["v.vti", "--slice", &slice, "--resample", "26x26"]);
    assert!(near(corner, [-0.25, -0.25, 0.0]) && spacing == [0.25, 0.25, 1.0], "{corner:?}");
    let file = "(format: 1, title: \"a slice\", field: File(path: \"v.vti\", slice: \"z=1\", stride: 3))";
    place.write("f.field.ron", file);
    let (corner, spacing) = first(&["f.field.ron"]);
    assert!(near(corner, [0.0; 3]) && spacing == [1.5, 1.5, 1.0], "{corner:?}");
    // A slice as a file of its own keeps a flat frame, and the position where it is the world's own.
    let run = place.tigereye(&["convert", "v.vti", "s.vti", "--slice", &slice]);
    assert!(run.code == 0 && run.stderr.contains("written in a frame of its own"), "{}", run.stderr);
    let image = place.image("s.vti");
    assert_eq!((image.direction, image.origin[2]), (Some(UNIT), 0.0));
    let mut upright = volume(&field(&place), PLAIN);
    upright.direction = None;
    place.write("u.vti", vti::write(&upright).unwrap());
    place.succeeds(&["convert", "u.vti", "t.vti", "--slice", &slice]);
    let image = place.image("t.vti");
    assert_eq!((image.direction, image.origin), (Some(UNIT), [10.0, -20.0, 32.0]));
    let facts = place.succeeds(&["info", "u.vti", "--slice", &slice, "--json"]).json();
    assert_eq!(facts["geometry"]["corner"], serde_json::json!([10.0, -20.0, 32.0]));
    assert_eq!(place.succeeds(&["info", "field.npy", "--json"]).json()["geometry"], Value::Null);
}
