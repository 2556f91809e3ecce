//! What is said of files that leave something open, and what is refused with the way out.

use crate::support::*;
use tigereye_core::{Cell, Tensor2};
use tigereye_io::npy;

/// 4 x 3 points with one line each behind the names of the columns.
fn table(names: &str, line: impl Fn(usize, usize) -> String) -> String {
    let points = (0..12).map(|i| (i % 4, i / 4));
    points.fold(format!("{names}\n"), |text, (x, y)| text + &line(x, y) + "\n")
}

/// Every cell the tensor xx = 1, xy = yx = 0.5, yy = 2.
fn tilted(shape: &[usize]) -> Vec<u8> {
    let values: Vec<f64> = (0..shape.iter().product()).map(|i| [1.0, 0.5, 0.5, 2.0][i % 4]).collect();
    npy::write_array(shape, &values).unwrap()
}

#[test]
fn columns_of_validity_are_masks_of_tensors_and_vectors() {
    let place = Place::new();
    let valid = |x: usize| if x == 0 { "False" } else { "True" };
    place.write("t.csv", table("x,y,S11,S22,S12,isValid", |x, y| format!("{x},{y},1,2,3,{}", valid(x))));
    place.write("v.csv", table("x,y,u,v,isValid", |x, y| format!("{x},{y},{x},{y},{}", valid(x))));
    let words =
        |points: &str| format!("3 of 12 {points} left out by the column `isValid`, where it is below 1");
    place.says(&["convert", "t.csv", "t.npy"], &words("points"));
    let field = npy::read_tensors(&place.read("t.npy")).unwrap();
    assert!(
        field.at(Cell::new(0, 1)).is_zero()
            && *field.at(Cell::new(1, 1)) == Tensor2::symmetric(1.0, 3.0, 2.0)
    );
    place.says(&["convert", "v.csv", "v.npy", "--derive", "gradient"], &words("vectors"));
    let field = npy::read_tensors(&place.read("v.npy")).unwrap();
    assert!(field.at(Cell::new(0, 1)).is_zero() && *field.at(Cell::new(1, 1)) == Tensor2::isotropic(1.0));
    place.write("bad.csv", table("x,y,S11,S22,S12,valid", |x, y| format!("{x},{y},1,2,3,good")));
    place.refuses(
        &["info", "bad.csv"],
        &["bad.csv: line 2, column 11: expected a number, true or false, found `good`"],
    );
}

/// Rows of arrays run downwards; whether components do, too, only their author knows.
#[test]
fn the_direction_of_y_in_arrays_is_said() {
    let place = Place::new();
    let words = "took row 0 on top and components along x (right) and y (up)";
    place.write("t.npy", tilted(&[2, 3, 2, 2]));
    place.says(&["convert", "t.npy", "up.txt"], words);
    assert!(place.succeeds(&["info", "t.npy"]).stdout.contains(words));
    place.succeeds(&["convert", "t.npy", "down.txt", "--frame", "voxel"]);
    let xy = |name: &str| tigereye_io::matrices::read(&place.read(name)).unwrap().values()[0].xy();
    assert_eq!([xy("up.txt"), xy("down.txt")], [0.5, -0.5]);
    place.write("v.npy", tilted(&[4, 6, 2]));
    place.says(&["convert", "v.npy", "v.txt", "--derive", "gradient"], words);
    place.succeeds(&["convert", "v.npy", "v.txt", "--derive", "gradient", "--frame", "voxel", "--force"]);
    // Numbers have no components, but their derivatives have.
    place.write("n.npy", tilted(&[4, 4]));
    place.write("n.csv", "1,2,3\n4,5,6\n7,8,9\n");
    place.write("rows.txt", "1 2 3\n4 5 6\n7 8 9\n");
    for name in ["n.npy", "n.csv", "rows.txt"] {
        let words = "took row 0 on top and y upwards, from the last row to the first";
        for derived in ["hessian", "structure"] {
            place.says(&["convert", name, "n.vti", "--derive", derived, "--force"], words);
        }
        place.refuses(
            &["info", name, "--derive", "hessian", "--frame", "voxel"],
            &["--frame has no effect here", "single numbers, which are along no axes"],
        );
    }
    place.write("at.csv", table("x,y,f", |x, y| format!("{x},{y},{}", x * y)));
    place.says(&["convert", "at.csv", "n.vti", "--derive", "hessian", "--force"], "y taken to run upwards");
}

/// COMSOL's exports of several times are read one at a time.
#[test]
fn columns_of_several_times_ask_for_one() {
    let place = Place::new();
    let names: Vec<String> = ["t=0", "t=0.5"]
        .iter()
        .flat_map(|t| ["sx", "sy", "sxy"].map(|s| format!("solid.{s} (N/m^2) @ {t}")))
        .collect();
    let text = table(&format!("% X  Y  {}", names.join("  ")), |x, y| format!("{x} {y} 1 2 3 4 5 6"));
    for name in ["a.txt", "a.dat"] {
        place.write(name, &text);
        place.refuses(&["info", name], &["line 1", "several times or parameters (t=0; t=0.5)", "--array"]);
        place.says(&["convert", name, "o.npy", "--array", "t=0.5", "--force"], "y taken to run upwards");
        let field = npy::read_tensors(&place.read("o.npy")).unwrap();
        assert_eq!(field.values()[0], Tensor2::symmetric(4.0, 6.0, 5.0));
    }
}

#[test]
fn zones_of_tecplot_that_are_no_table_are_refused_by_name() {
    let place = Place::new();
    let head = "TITLE = \"a\"\nVARIABLES = \"X\"\n\"Y\"\n\"S11\"\n\"S22\"\n\"S12\"\n";
    for name in ["a.txt", "a.dat"] {
        place.write(name, format!("{head}ZONE I=2, J=2, DATAPACKING=BLOCK\n0 1 0 1\n0 0 1 1\n1 1 1 1\n"));
        place.refuses(
            &["info", name],
            &["line 7", "one variable after the other (BLOCK)", "DATAPACKING=POINT"],
        );
        place.write(
            name,
            format!("{head}ZONE I=2, J=2, DATAPACKING=POINT\n0 0 1 2 3\n1 0 1 2 3\n0 1 1 2 3\n1 1 1 2 3\n"),
        );
        let facts = place.succeeds(&["info", name, "--json"]).json();
        assert_eq!(facts["dimensions"], serde_json::json!([2, 2]));
    }
}

/// Usual names of shears are read; for others the message says how to name them.
#[test]
fn shears_may_have_a_name_of_their_own() {
    let place = Place::new();
    let write = |names: &str| place.write("t.csv", table(names, |x, y| format!("{x},{y},1,2,3")));
    for names in ["x,y,sxx,syy,txy", "x,y,sigma_x,sigma_y,tau_xy", "x,y,exx,eyy,gamma_xy"] {
        write(names);
        let run = place.says(&["convert", "t.csv", "t.npy", "--force"], "y taken to run upwards");
        let field = npy::read_tensors(&place.read("t.npy")).unwrap();
        assert_eq!(field.values()[0], Tensor2::symmetric(1.0, 3.0, 2.0), "{names}");
        assert_eq!(
            run.stderr.contains("--shear engineering"),
            names.contains("gamma"),
            "{names}: {}",
            run.stderr
        );
    }
    write("x,y,a,b,c");
    place.refuses(&["info", "t.csv"], &["`a` (1 component)", "--components XX=NAME,YY=NAME,XY=NAME"]);
    place.write("three.txt", "1 2 3\n4 5 6\n");
    place.refuses(&["info", "three.txt"], &["an even number of columns (2x2 blocks)", "x,y,S11,S22,S12"]);
}

/// A header that calls the fourth axis time is contradicted only by whoever states the order of components.
#[test]
fn tensors_along_an_axis_of_time_are_said() {
    let place = Place::new();
    place.write("t.npy", tilted(&[2, 3, 2, 2]));
    place.says(&["convert", "t.npy", "t.nii", "--write-order", "fsl"], "");
    let mut bytes = place.read("t.nii");
    // Millimetres and seconds, in steps of 1 s, as programs write them beside tensors; then a measured series.
    bytes[123] = 10;
    place.write("usual.nii", &bytes);
    bytes[92..96].copy_from_slice(&2.5_f32.to_le_bytes());
    place.write("series.nii", &bytes);
    let words = "the fourth axis is time, in steps of 2.5 s: its 6 volumes are taken as components";
    place.says(&["convert", "series.nii", "o.npy"], words);
    for options in [&["series.nii", "--order", "fsl"][..], &["usual.nii"]] {
        let run = place.tigereye(&[&["convert"], options, &["o.npy", "--force"]].concat());
        assert!(run.code == 0 && !run.stderr.contains("time"), "{options:?}: {}", run.stderr);
    }
    assert!(place.succeeds(&["info", "series.nii"]).stdout.contains(words));
}

/// VTK's formats have no name for a patient's axes.
#[test]
fn axes_of_a_patient_are_named_where_the_format_has_no_name() {
    let place = Place::new();
    let head = "NRRD0004\ntype: float\ndimension: 4\nsizes: 6 2 2 2\nkinds: 3D-symmetric-matrix space space space\n\
                space directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: ascii\n";
    for (space, is_said) in [("left-posterior-superior", true), ("3D-right-handed", false)] {
        let numbers = "1 0 0 1 0 1 ".repeat(8);
        place.write(
            "v.nrrd",
            format!("{head}space: {space}\nmeasurement frame: (1,0,0) (0,1,0) (0,0,1)\n\n{numbers}"),
        );
        for options in [&["v.vti"][..], &["v.vtk", "--slice", "z=0"]] {
            let run = place.tigereye(&[&["convert", "v.nrrd", "--force"], options].concat());
            let words = "along the input's axes (left-posterior-superior)";
            assert_eq!((run.code, run.stderr.contains(words)), (0, is_said), "{options:?}: {}", run.stderr);
        }
        let run = place.tigereye(&["convert", "v.nrrd", "w.nrrd", "--force"]);
        assert!(!run.stderr.contains("the input's axes"), "{}", run.stderr);
    }
}

/// Whether vectors are along right and anterior or left and posterior matters on axes of any direction.
#[test]
fn the_frame_of_vectors_of_images_is_said() {
    let place = Place::new();
    let words = "took vectors along the world axes, right, anterior and superior";
    // u = 2 x, 0, 0 on three columns.
    let along_x = [0.0, 2.0, 4.0].repeat(3).into_iter().chain(vec![0.0; 18]).collect::<Vec<f64>>();
    for (intent, steps) in [(1007, [1.0; 3]), (1006, [1.0; 3]), (1007, [-1.0, 1.0, 1.0])] {
        place.write("u.nii", nifti_file([5, 3, 3, 1, 1, 3, 1, 1], steps, intent, &along_x));
        place.says(&["convert", "u.nii", "o.npy", "--derive", "gradient", "--force"], words);
        let xx = |name: &str| npy::read_tensors(&place.read(name)).unwrap().at(Cell::new(1, 1)).xx();
        assert_eq!(xx("o.npy"), f64::from(steps[0]) * 2.0, "intent {intent}");
        place.succeeds(&["convert", "u.nii", "l.npy", "--derive", "gradient", "--frame", "lps", "--force"]);
        assert_eq!(xx("l.npy"), f64::from(-steps[0]) * 2.0, "intent {intent}");
        let of_vectors = "vectors along the world axes (this program's convention for the format)";
        let info = ["info", "u.nii", "--derive", "gradient"];
        let run = place.tigereye(&info);
        assert!(run.stdout.contains(of_vectors), "{}", run.stdout);
        let run = place.tigereye(&[&info[..], &["--frame", "lps"]].concat());
        let given = "vectors along the axes left, posterior, superior (as given)";
        assert!(run.stdout.contains(given), "{}", run.stdout);
    }
}

/// Abaqus writes engineering shears for every kind of strain.
#[test]
fn strains_of_every_kind_may_have_engineering_shears() {
    let place = Place::new();
    for name in ["E", "LE", "NE", "EE", "PE", "CE", "IE", "VE", "THE", "ER"] {
        let column = |pair: &str| format!("{name}-{name}{pair}");
        let names = format!("x,y,{},{},{}", column("11"), column("22"), column("12"));
        place.write("t.csv", table(&names, |x, y| format!("{x},{y},1,2,3")));
        place.says(&["convert", "t.csv", "t.npy", "--force"], "--shear engineering");
    }
    let mut image = tigereye_io::ImageData::empty([2, 2, 1]);
    let array = tigereye_io::DataArray::new("CE", 6, vec![1.0; 24]);
    image.point_arrays.push(array.with_component_names(&["CE11", "CE22", "CE33", "CE12", "CE13", "CE23"]));
    place.write("t.vti", tigereye_io::vti::write(&image).unwrap());
    place.says(&["convert", "t.vti", "t.npy", "--force"], "--shear engineering");
}
