//! What becomes of values on their way from a file to a field: derivatives, masks, resampling.

use crate::support::*;
use tigereye_core::{Cell, Field, Tensor2};
use tigereye_io::npy;

fn array(shape: &[usize], value: impl Fn(usize) -> f64) -> Vec<u8> {
    let values: Vec<f64> = (0..shape.iter().product()).map(value).collect();
    npy::write_array(shape, &values).unwrap()
}

fn converted(place: &Place, options: &[&str]) -> Field<Tensor2> {
    place.says(&[&["convert"], options, &["out.npy", "--force"]].concat(), "");
    npy::read_tensors(&place.read("out.npy")).unwrap()
}

#[track_caller]
fn near(t: &Tensor2, expected: [f64; 4]) {
    assert!(
        t.components().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9),
        "{t:?}, not {expected:?}"
    );
}

const W: usize = 12;
const H: usize = 10;

/// x to the right and y up, from the index of a cell.
fn place_of(i: usize) -> (f64, f64) {
    ((i % W) as f64, (H - 1 - i / W) as f64)
}

#[test]
fn vectors_give_their_gradient_and_numbers_their_hessian() {
    let place = Place::new();
    let flow = |i: usize| {
        let (x, y) = place_of(i / 2);
        [2.0 * x - 3.0 * y, x + 0.5 * y][i % 2]
    };
    place.write("flow.npy", array(&[H, W, 2], flow));
    let gradient = converted(&place, &["flow.npy", "--derive", "gradient"]);
    gradient.values().iter().for_each(|t| near(t, [2.0, -3.0, 1.0, 0.5]));
    place.write(
        "hill.npy",
        array(&[H, W], |i| {
            let (x, y) = place_of(i);
            x * x + x * y
        }),
    );
    let hessian = converted(&place, &["hill.npy", "--derive", "hessian", "--sigma", "0"]);
    near(hessian.at(Cell::new(5, 5)), [2.0, 1.0, 1.0, 0.0]);
    let structure =
        converted(&place, &["hill.npy", "--derive", "structure", "--sigma", "0", "--window", "0"]);
    // At (5, 4) the slope is (2 x + y, x).
    near(structure.at(Cell::new(5, 5)), [196.0, 70.0, 70.0, 25.0]);
    let text = place.succeeds(&["info", "hill.npy", "--derive", "hessian"]).stdout;
    assert!(text.contains("Hessian, of the image smoothed by 1 cells"), "{text}");
    place.refuses(
        &["ltg", "flow.npy", "--derive", "hessian", "-o", "o.vti"],
        &["flow.npy", "shape [10, 12, 2]", "expected (H, W)"],
    );
    place.write("six.nii", nifti_of_six());
    place.refuses(
        &["info", "six.nii", "--derive", "hessian"],
        &["six.nii", "6 numbers per voxel: expected one"],
    );
    place.refuses(&["info", "hill.npy"], &["hill.npy", "expected (H, W, 2, 2)"]);
    place.refuses(&["info", "hill.npy", "--derive", "hessian", "--sigma", "101"], &["0 to 100"]);
    place.refuses(&["info", "hill.npy", "--sigma", "1"], &["--derive"]);
    place.refuses(&["info", "inverse", "--derive", "hessian"], &["inverse", "--derive has no effect here"]);
}

#[test]
fn masks_leave_voxels_out() {
    let place = Place::new();
    place.write("t.npy", array(&[2, 3, 2, 2], |i| if i % 4 % 3 == 0 { 1.0 } else { 0.0 }));
    place.write("m.npy", array(&[2, 3], |i| i as f64 * 0.25));
    let zeros = |field: &Field<Tensor2>| field.values().iter().map(Tensor2::is_zero).collect::<Vec<_>>();
    let masked = converted(&place, &["t.npy", "--mask", "m.npy"]);
    assert_eq!(zeros(&masked), [true, false, false, false, false, false]);
    let half = converted(&place, &["t.npy", "--mask", "m.npy", "--mask-above", "0.5"]);
    assert_eq!(zeros(&half), [true, true, true, false, false, false]);
    place.write("small.npy", array(&[2, 2], |_| 1.0));
    place.refuses(&["info", "t.npy", "--mask", "small.npy"], &["small.npy", "2 x 2 x 1", "3 x 2 x 1"]);
    place.refuses(&["info", "t.npy", "--mask", "none.npy"], &["none.npy"]);
    place.refuses(&["info", "t.npy", "--mask", "t.npy"], &["mask t.npy", "(H, W) or (X, Y, Z)"]);
    // The mask is part of the input.
    let hash = |options: &[&str]| {
        place.succeeds(&[&["info", "t.npy", "--json"], options].concat()).json()["input_blake3"].clone()
    };
    assert_ne!(hash(&[]), hash(&["--mask", "m.npy"]));
}

#[test]
fn tensors_that_are_not_finite_are_refused_or_zero() {
    let place = Place::new();
    place.write("t.npy", array(&[2, 2, 2, 2], |i| if i == 9 { f64::NAN } else { 1.0 }));
    place.refuses(&["info", "t.npy"], &["cell (0, 1)", "1 such", "--not-finite zero"]);
    place.says(
        &["convert", "t.npy", "out.npy", "--not-finite", "zero"],
        "1 tensor with a component that is infinite",
    );
    let field = npy::read_tensors(&place.read("out.npy")).unwrap();
    assert!(field.at(Cell::new(0, 1)).is_zero() && !field.at(Cell::new(1, 1)).is_zero());
    let facts = place.succeeds(&["info", "t.npy", "--not-finite", "zero", "--json"]).json();
    assert!(facts["assumptions"].to_string().contains("1 tensor with a component"), "{facts:#}");
}

#[test]
fn fields_are_resampled_to_any_size() {
    let place = Place::new();
    let half = converted(&place, &["inverse:size=20", "--resample", "10x5"]);
    assert_eq!((half.grid().width(), half.grid().height()), (10, 5));
    place.succeeds(&["convert", "inverse:size=20", "o.vti", "--resample", "10x5"]);
    let facts = place.succeeds(&["info", "o.vti", "--json"]).json();
    assert_eq!(facts["spacing"], serde_json::json!([2.0, 4.0]));
    assert_eq!(facts["origin"], serde_json::json!([0.5, 1.5]));
    let cropped = converted(&place, &["inverse:size=20", "--crop", "0:8,0:6", "--resample", "4x3"]);
    assert_eq!(cropped.grid().width(), 4);
    place.refuses(&["info", "inverse", "--resample", "0x5"], &["WIDTHxHEIGHT"]);
    place.refuses(&["info", "inverse", "--resample", "99999999x99999999"], &["inverse"]);
}

#[test]
fn thresholds_between_noise_and_signal_are_suggested() {
    let place = Place::new();
    // Nine cells of noise beside nine of signal.
    place.write(
        "t.npy",
        array(&[3, 6, 2, 2], |i| {
            if i % 4 % 3 != 0 {
                0.0
            } else if i / 4 % 6 < 3 {
                0.02
            } else {
                1.0
            }
        }),
    );
    let facts = place.succeeds(&["info", "t.npy", "--json"]).json();
    let suggested = facts["suggested_local_above"].as_f64().unwrap();
    assert!(suggested > 0.3 && suggested < 0.7, "{suggested}");
    assert!(place.succeeds(&["info", "t.npy"]).stdout.contains("--normalization local-above:0."));
}

#[test]
fn archives_need_the_name_of_an_array_only_where_there_are_several() {
    let place = Place::new();
    place.write("not.npz", "no archive");
    place.refuses(&["info", "not.npz"], &["not.npz", "a .npz archive"]);
    place.refuses(&["info", "photo.png"], &["photo.png", "is a picture", "--derive structure"]);
}

/// A NIfTI file of 2 x 2 x 1 voxels with six components.
fn nifti_of_six() -> Vec<u8> {
    let tensors = Field::from_fn(tigereye_core::Grid::new(2, 2).unwrap(), |_| Tensor2::IDENTITY);
    let volume = tigereye_io::volume::TensorVolume::from_field(
        &tensors,
        &tigereye_io::volume::PlaneGeometry::UNPLACED,
    );
    tigereye_io::nifti::write(&volume, tigereye_io::nifti::WrittenAs::Matrices, "").unwrap()
}

/// What one has to be told before light runs: a guess that may be a vector field, cells that are not square, a mask of
/// another place; and no output is written over its input.
#[test]
fn doubtful_readings_are_told() {
    let place = Place::new();
    place.write("three.npy", array(&[4, 4, 3], |i| [1.0, 0.0, 2.0][i % 3]));
    let run = place.tigereye(&["propagate", "three.npy", "--light", "1,1", "-o", "l.npy"]);
    assert_eq!(run.code, 0);
    assert!(run.stderr.contains("a vector field needs --derive gradient"), "{}", run.stderr);
    let run =
        place.tigereye(&["ltg", "inverse:size=20", "--resample", "10x5", "--directions", "8", "-o", "g.vti"]);
    assert!(
        run.stderr.contains("WARNING: cells are 2 x 4") && run.stderr.contains("--resample 10x10"),
        "{}",
        run.stderr
    );
    place.refuses(&["ltg", "three.npy", "-o", "./three.npy"], &["is also an input"]);
    place.refuses(&["convert", "three.npy", "./three.npy", "--force"], &["is also an input"]);
}

/// Two masks of one size, of which one lies elsewhere in the world.
#[test]
fn masks_of_another_place_are_told() {
    let place = Place::new();
    let file = |kind: &str, sizes: &str, rest: &str, numbers: &str| {
        format!(
            "NRRD0004\ntype: double\ndimension: {}\nsizes: {sizes}\nkinds: {kind}space space space\nspace: RAS\n{rest}\nencoding: ascii\n\n{numbers}",
            sizes.split(' ').count()
        )
    };
    let tensors = "1 0 0 1 0 1 ".repeat(4);
    place.write(
        "t.nrrd",
        file("3D-symmetric-matrix ", "6 2 2 1", "space directions: none (1,0,0) (0,1,0) (0,0,1)", &tensors),
    );
    for (name, directions) in
        [("here.nrrd", "(1,0,0) (0,1,0) (0,0,1)"), ("there.nrrd", "(2,0,0) (0,1,0) (0,0,1)")]
    {
        place.write(name, file("", "2 2 1", &format!("space directions: {directions}"), "1 1 0 1"));
        let run = place.tigereye(&["convert", "t.nrrd", "o.npy", "--force", "--mask", name]);
        assert_eq!(
            (run.code, run.stderr.contains("do not coincide")),
            (0, name == "there.nrrd"),
            "{}",
            run.stderr
        );
    }
}

/// An option that would change nothing is a misunderstanding.
#[test]
fn options_with_nothing_to_do_are_refused() {
    let place = Place::new();
    place.write("t.npy", array(&[2, 3, 2, 2], |i| if i % 4 % 3 == 0 { 1.0 } else { 0.0 }));
    place.write("n.npy", array(&[4, 4], |i| (i * i) as f64));
    place.write("v.npy", array(&[4, 4, 2], |i| i as f64));
    let cases: [(&[&str], &str); 9] = [
        (&["t.npy", "--array", "x"], "--array has no effect here"),
        (&["t.npy", "--mask-above", "5"], "--mask-above has no effect here"),
        (&["inverse", "--mask-above", "5"], "--mask-above has no effect here"),
        (&["inverse", "--not-finite", "zero"], "--not-finite has no effect here"),
        (&["n.npy", "--derive", "hessian", "--window", "2"], "--window has no effect here"),
        (&["n.npy", "--derive", "hessian", "--order", "fsl"], "--order has no effect here"),
        (&["n.npy", "--derive", "structure", "--frame", "voxel"], "--frame has no effect here"),
        (&["v.npy", "--derive", "gradient", "--window", "1"], "--window has no effect here"),
        (&["n.npy", "--derive", "structure", "--mask-above", "0.5"], "--mask-above has no effect here"),
    ];
    for (options, words) in cases {
        place.refuses(&[&["info"], options].concat(), &[words]);
    }
    place.succeeds(&["info", "v.npy", "--derive", "gradient", "--frame", "voxel"]);
}

/// Whatever was read stays: data behind links, masks, data files of headers.
#[test]
fn nothing_that_was_read_is_overwritten() {
    let place = Place::new();
    place.write("t.npy", array(&[2, 3, 2, 2], |i| i as f64));
    place.write("m.npy", array(&[2, 3], |i| i as f64));
    place.write("d.nrrd", "1 0 0 1 0 1 ".repeat(4));
    let header = "NRRD0004\ntype: float\ndimension: 3\nsizes: 6 2 2\nkinds: 3D-symmetric-matrix domain domain\n\
                  encoding: ascii\ndata file: d.nrrd\n";
    place.write("d.nhdr", header);
    place.refuses(
        &["convert", "t.npy", "m.npy", "--mask", "m.npy", "--force"],
        &["m.npy", "is also an input"],
    );
    place.refuses(&["convert", "d.nhdr", "d.nrrd", "--force"], &["d.nrrd", "is also an input"]);
    place.refuses(&["ltg", "t.npy", "--mask", "m.npy", "-o", "m.npy"], &["m.npy", "is also an input"]);
    place.refuses(&["propagate", "t.npy", "--light", "1,1", "-o", "./t.npy"], &["t.npy", "is also an input"]);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(place.path("t.npy"), place.path("link.npy")).unwrap();
        place.refuses(&["convert", "link.npy", "t.npy", "--force"], &["t.npy", "is also an input"]);
    }
}

/// Rows of pictures run downwards, those of VTK upwards: the mask follows the picture.
#[test]
fn masks_leave_the_same_cells_out_in_every_format() {
    let place = Place::new();
    place.write("t.npy", array(&[4, 3, 2, 2], |i| if i % 4 % 3 == 0 { 1.0 } else { 0.0 }));
    place.write("m.npy", array(&[4, 3], |i| if i < 3 { 1.0 } else { 0.0 }));
    place.says(&["convert", "t.npy", "t.vti"], "took row 0 on top");
    let of_rows = converted(&place, &["t.npy", "--mask", "m.npy"]);
    assert!(!of_rows.at(Cell::new(1, 0)).is_zero() && of_rows.at(Cell::new(1, 3)).is_zero());
    assert_eq!(converted(&place, &["t.vti", "--mask", "m.npy"]), of_rows);
}

#[test]
fn volumes_taken_whole_have_no_number_that_is_not_finite() {
    let place = Place::new();
    place.write(
        "t.npy",
        array(&[2, 2, 2, 6], |i| if i == 9 { f64::NAN } else { [2.0, 0.0, 0.0, 1.0, 0.0, 3.0][i % 6] }),
    );
    place.refuses(&["convert", "t.npy", "o.vti"], &["voxel (0, 0, 1)", "1 such", "--not-finite zero"]);
    let run = place.tigereye(&["convert", "t.npy", "o.vti", "--not-finite", "zero", "--invariants"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let image = place.image("o.vti");
    assert!(image.point_arrays.iter().all(|a| a.values.iter().all(|v| v.is_finite())));
}

#[test]
fn negative_eigenvalues_are_counted() {
    let place = Place::new();
    // Diagonal tensors with 0, 1, 1 and 2 negative entries.
    let diagonals = [[1.0, 2.0], [-1.0, 2.0], [3.0, -2.0], [-1.0, -1.0]];
    place.write("t.npy", array(&[2, 2, 4], |i| [diagonals[i / 4][0], 0.0, 0.0, diagonals[i / 4][1]][i % 4]));
    let facts = place.succeeds(&["info", "t.npy", "--json"]).json();
    assert_eq!(facts["negative_eigenvalues_histogram"], serde_json::json!([1, 2, 1]));
    let text = place.succeeds(&["info", "t.npy"]).stdout;
    assert!(text.contains("tensors with 0, 1, 2 negative eigenvalues: 1, 2, 1"), "{text}");
}

/// Vectors in tables by other names than u and v: those of another plane are read, several are told apart.
#[test]
fn tables_of_vectors_are_understood_by_their_names() {
    let place = Place::new();
    let table = |names: &str, line: &dyn Fn(f64, f64) -> String| {
        let line = |i: u32| line(f64::from(i % 4), f64::from(i / 4)) + "\n";
        format!("{names}\n{}", (0..12).map(line).collect::<String>())
    };
    let convert = |file: &str, options: &[&str]| {
        place.says(&[&["convert", file, "o.npy", "--force", "--derive", "gradient"], options].concat(), "");
        tigereye_io::npy::read_tensors(&place.read("o.npy")).unwrap().values()[5].components()
    };
    place.write("xz.csv", table("x,z,u,w", &|x, z| format!("{x},{z},{},{}", x + 2.0 * z, 3.0 * x + 4.0 * z)));
    assert_eq!(convert("xz.csv", &[]), [1.0, 2.0, 3.0, 4.0]);
    let both =
        |x: f64, y: f64| format!("{x},{y},{},{},{},{}", x + 2.0 * y, 3.0 * x + 4.0 * y, 5.0 * x, 5.0 * y);
    place.write("both.csv", table("x,y,u,v,Ux,Uy", &both));
    let words = ["several arrays fit: `u, v` (2 components), `Ux, Uy` (2 components)", "(option --array"];
    place.refuses(&["info", "both.csv", "--derive", "gradient"], &words);
    assert_eq!(convert("both.csv", &["--array", "Ux, Uy"]), [5.0, 0.0, 0.0, 5.0]);
    place.write("other.csv", table("x,y,a,b", &|x, y| format!("{x},{y},1,2")));
    let words = ["the columns `x, y, a, b` are not understood", "names such as x, y, u, v"];
    place.refuses(&["info", "other.csv", "--derive", "gradient"], &words);
}

/// Who asks for tensors of a file of vectors hears how they are made.
#[test]
fn vectors_are_called_so_where_tensors_are_missing() {
    let place = Place::new();
    let head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 1\nORIGIN 0 0 0\nSPACING 1 1 1\n\
                POINT_DATA 9\n";
    place.write("v.vtk", format!("{head}VECTORS U double\n{}", "1 2 3\n".repeat(9)));
    place.refuses(&["info", "v.vtk"], &["`U` (3 components, a vector)", "(option --derive gradient"]);
}
