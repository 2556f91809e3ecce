//! Volumes of other tools: what is read, what is assumed, planes, conversion.

use crate::support::{Place, has_keys, unit_text};
use serde_json::Value;
use tigereye_core::{Cell, Tensor2};
use tigereye_io::volume::{PlaneChoice, Reading, lattice_from_image};
use tigereye_io::{Wanted, matrices, npy};
use tigereye_test_support::{data_folder, reference_folder};

/// 3 x 2 x 2 voxels of diagonal tensors: xx counts voxels from 1, yy = 20, zz = 30; xz = 0.5.
fn nrrd() -> String {
    let head = "NRRD0004\ntype: double\ndimension: 4\nsizes: 6 3 2 2\nkinds: 3D-symmetric-matrix space space space\n\
                space: left-posterior-superior\nspace directions: none (2,0,0) (0,3,0) (0,0,4)\nencoding: ascii\n\n";
    let tuples: String = (1..=12).map(|v| format!("{v} 0 0.5 20 0 30\n")).collect();
    head.to_owned() + &tuples
}

#[test]
fn slices_become_fields_with_up_on_top() {
    let place = Place::new();
    place.write("v.nrrd", nrrd());
    let run = place.tigereye(&["convert", "v.nrrd", "xy.npy", "--slice", "z=1"]);
    assert_eq!(run.code, 0);
    assert_eq!(run.stderr, "v.nrrd: assumed components along the world axes (--frame)\n");
    let xy = npy::read_tensors(&place.read("xy.npy")).unwrap();
    assert_eq!((xy.grid().width(), xy.grid().height()), (3, 2));
    // Voxel (2, 1, 1) is the last of all and lies at the top right.
    assert_eq!(*xy.at(Cell::new(2, 0)), Tensor2::symmetric(12.0, 0.0, 20.0));
    assert_eq!(*xy.at(Cell::new(0, 1)), Tensor2::symmetric(7.0, 0.0, 20.0));
    let across = ["convert", "v.nrrd", "xz.vti", "--plane", "xz", "--slice", "y=0", "--frame", "voxel"];
    place.says(&across, "written in a frame of its own");
    let xz = lattice_from_image(&place.image("xz.vti"), None, Wanted::Tensors).unwrap();
    let xz = xz.tensors(Reading::default()).unwrap().slice(PlaneChoice::default()).unwrap();
    assert_eq!(xz.field.values()[0], Tensor2::symmetric(7.0, 0.5, 30.0));
    assert_eq!(xz.cut.geometry.spacing(), [2.0, 4.0]);
    assert!(place.image("xz.vti").text("tigereye").unwrap().contains("\"slice\":\"y=0\""));
    place.succeeds(&["convert", "xz.vti", "part.txt", "--crop", "1:3,1:2"]);
    let part = matrices::read(&place.read("part.txt")).unwrap();
    assert_eq!(part.values()[0], Tensor2::symmetric(2.0, 0.5, 30.0));
    assert_eq!(part.grid().cells(), 2);
}

#[test]
fn whole_volumes_are_written_as_images() {
    let place = Place::new();
    place.write("v.nrrd", nrrd());
    place.says(
        &["convert", "v.nrrd", "v.vti", "--frame", "world"],
        "along the input's axes (left-posterior-superior)",
    );
    let image = place.image("v.vti");
    assert_eq!((image.dimensions, image.spacing), ([3, 2, 2], [2.0, 3.0, 4.0]));
    assert_eq!(image.point_arrays[0].values[..9], [1.0, 0.0, 0.5, 0.0, 20.0, 0.0, 0.5, 0.0, 30.0]);
    let facts = place.succeeds(&["info", "v.vti", "--json"]).json();
    assert_eq!(facts["dimensions"], serde_json::json!([3, 2, 2]));
    for output in ["v.npy", "v.txt"] {
        place.refuses(&["convert", "v.nrrd", output], &["3 x 2 x 2 voxels", "--slice"]);
    }
    place.refuses(&["convert", "v.nrrd", "w.vti", "--crop", "0:1,0:1"], &["a plane is needed", "--slice"]);
}

#[test]
fn outputs_are_replaced_only_by_force() {
    let place = Place::new();
    place.write("field.txt", unit_text(3, 2));
    place.write("kept.npy", "an earlier result");
    place.refuses(&["convert", "field.txt", "kept.npy"], &["kept.npy", "exists", "--force"]);
    place.refuses(&["convert", "field.txt", "f.png"], &[".nrrd, .nii or .nii.gz"]);
    place.succeeds(&["convert", "field.txt", "kept.npy", "--force"]);
    assert_eq!(npy::read_tensors(&place.read("kept.npy")).unwrap().grid().width(), 3);
    place.succeeds(&["convert", "inverse:size=5", "generated.vti"]);
    place.succeeds(&["compare", "inverse:size=5", "generated.vti", "--tolerance", "0"]);
}

#[test]
fn planes_and_options_that_do_not_fit_are_refused() {
    let place = Place::new();
    place.write("v.nrrd", nrrd());
    place.write("flat.txt", unit_text(3, 2));
    let refuses = |input: &str, options: &[&str], words: &[&str]| {
        for command in [&["info", input][..], &["ltg", input, "-o", "o.vti"]] {
            if command[0] == "ltg" || !options.is_empty() {
                place.refuses(&[command, options].concat(), words);
            }
        }
    };
    refuses("v.nrrd", &[], &["3 x 2 x 2 voxels", "a plane is needed", "--slice AXIS=INDEX"]);
    refuses("v.nrrd", &["--plane", "xz"], &["plane xz needs a slice y=I", "0 to 1"]);
    refuses("v.nrrd", &["--plane", "xz", "--slice", "z=0"], &["plane xz", "expected a slice along y"]);
    refuses("v.nrrd", &["--slice", "x=3"], &["slice x=3", "0 to 2"]);
    refuses("v.nrrd", &["--slice", "z=0", "--crop", "0:4,0:1"], &["crop 0:4,0:1", "0:3,0:2"]);
    refuses("v.nrrd", &["--slice", "z=0", "--order", "afni"], &["`afni`", "expected vtk, nrrd"]);
    refuses("v.nrrd", &["--slice", "z=0", "--frame", "measurement"], &["no measurement frame"]);
    refuses("v.nrrd", &["--slice", "w=0"], &["z=INDEX"]);
    refuses("v.nrrd", &["--crop", "3:1,0:1"], &["X0 < X1"]);
    refuses("flat.txt", &["--plane", "yz"], &["flat.txt"]);
    refuses("flat.txt", &["--order", "xx,xy,yy"], &["a name for every component"]);
    refuses("flat.txt", &["--crop", "0:9,0:1"], &["0:3,0:2"]);
    place.succeeds(&["info", "flat.txt", "--plane", "xy", "--slice", "z=0", "--crop", "1:3,0:1"]);
}

#[test]
fn detached_data_lie_beside_their_header() {
    let place = Place::new();
    let (head, data) = nrrd().split_once("\n\n").map(|(h, d)| (h.to_owned(), d.to_owned())).unwrap();
    place.write("folder/v.nhdr", format!("{head}\ndata file: numbers.txt\n"));
    place.refuses(&["info", "folder/v.nhdr"], &["numbers.txt", "reading"]);
    place.write("folder/numbers.txt", &data);
    let facts = place.succeeds(&["info", "folder/v.nhdr", "--json"]).json();
    assert_eq!(facts["range"]["max"], 30.0);
    place.write("folder/numbers.txt", "1 2 3");
    place.refuses(&["info", "folder/v.nhdr"], &["v.nhdr", "numbers.txt", "byte 5"]);
}

#[test]
fn info_describes_whole_volumes() {
    let place = Place::new();
    place.write("v.nrrd", nrrd());
    let facts = place.succeeds(&["info", "v.nrrd", "--json"]).json();
    has_keys(
        &facts,
        &["dimensions", "spacing", "component_order", "frame", "range", "shares", "assumptions"],
    );
    assert_eq!(facts["component_order"], "xx,xy,xz,yy,yz,zz");
    assert_eq!(facts["mean_trace"], 56.5);
    assert_eq!(facts["negative_eigenvalues_histogram"], serde_json::json!([12, 0, 0, 0]));
    let bars = facts["fractional_anisotropy_histogram"].as_array().unwrap();
    assert_eq!(bars.iter().map(|b| b.as_u64().unwrap()).sum::<u64>(), 12);
    let text = place.succeeds(&["info", "v.nrrd"]).stdout;
    assert!(text.contains("stated by the file") && text.contains("ASSUMED"), "{text}");
}

/// Every example file is read, and converted where it holds tensors.
#[test]
fn example_files_work_with_every_command() {
    let Some(data) = data_folder(".") else { return };
    let place = Place::new();
    let expected: Value =
        serde_json::from_slice(&std::fs::read(data.join("expected.json")).unwrap()).unwrap();
    for entry in expected["files"].as_array().unwrap() {
        let file = entry["file"].as_str().unwrap();
        let input = data.join(file).display().to_string();
        let order = ["dipy", "fsl", "mrtrix"].into_iter().find(|tool| file.contains(tool));
        let order: Vec<&str> = order.iter().flat_map(|o| ["--order", o, "--frame", "voxel"]).collect();
        let facts = place.succeeds(&[&["info", &input, "--json"], &order[..]].concat()).json();
        if entry["scalar"] == true {
            assert_eq!(facts["range"]["max"], entry["max"], "{file}");
            continue;
        }
        let volume = if facts["volume"].is_object() { &facts["volume"] } else { &facts };
        if entry["rank"] == 3 {
            let near = |found: &Value, key: &str| {
                let (found, expected) = (found.as_f64().unwrap(), entry[key].as_f64().unwrap());
                let scale = entry["max"].as_f64().unwrap() - entry["min"].as_f64().unwrap();
                assert!((found - expected).abs() < 1e-6 * scale, "{file} {key}: {found}");
            };
            near(&volume["range"]["min"], "min");
            near(&volume["range"]["max"], "max");
            near(&volume["mean_trace"], "mean_trace");
            assert_eq!(volume["zero_tensors"], entry["zero_tensors"], "{file}");
            assert_eq!(volume["dimensions"], entry["shape_xyz"], "{file}");
            assert!(volume["warning"].is_null(), "{file}");
        }
        let thick = entry["shape_xyz"][2].as_u64().is_some_and(|n| n > 1);
        let slice: Vec<&str> = if thick { vec!["--slice", "y=4"] } else { vec![] };
        let run =
            place.tigereye(&[&["convert", &input, "o.vti", "--force"], &order[..], &slice[..]].concat());
        assert_eq!(run.code, 0, "{file}: {}", run.stderr);
        for output in ["o.vtp", "o.vtk", "o.nrrd", "o.nii", "o.nii.gz"] {
            let run =
                place.tigereye(&[&["convert", &input, output, "--force"], &order[..], &slice[..]].concat());
            assert_eq!(run.code, 0, "{file}: {}", run.stderr);
            let run = place.tigereye(&["compare", "o.vti", output, "--tolerance", "0"]);
            assert_eq!(run.code, 0, "{file} as {output}: {}{}", run.stdout, run.stderr);
        }
        let crop = ["--crop", "2:7,1:8", "--directions", "8", "--steps", "3"];
        let light = ["propagate", &input, "--light", "2,3", "-o", "o.npy"];
        let run = place.tigereye(&[&light, &order[..], &slice[..], &crop[..]].concat());
        assert_eq!(run.code, 0, "{file}: {}", run.stderr);
    }
}

#[test]
fn wrong_orders_are_warned_of() {
    let Some(data) = data_folder(".") else { return };
    let place = Place::new();
    let input = data.join("small_64D_tensor_fsl.nii.gz").display().to_string();
    let facts = place.succeeds(&["info", &input, "--json"]).json();
    assert!(facts["warning"].as_str().unwrap().contains("nrrd, itk, fsl"), "{facts:#}");
    let run = place.tigereye(&["convert", &input, "o.npy", "--slice", "z=3"]);
    assert!(
        run.stderr.contains("assumed component order") && run.stderr.contains("WARNING"),
        "{}",
        run.stderr
    );
    let stated = ["convert", &input, "p.npy", "--slice", "z=3", "--order", "fsl", "--frame", "voxel"];
    let run = place.says(&stated, "the plane is oblique");
    assert!(!run.stderr.contains("WARNING"), "{}", run.stderr);
}

/// What the components are read along says nothing about where a slice lies.
#[test]
fn slices_keep_their_place_in_every_frame() {
    let place = Place::new();
    let shifted = nrrd().replace("encoding: ascii", "space origin: (5,6,7)\nencoding: ascii");
    place.write("v.nrrd", shifted);
    for frame in ["voxel", "world"] {
        let out = format!("{frame}.vti");
        place.says(
            &["convert", "v.nrrd", &out, "--slice", "z=1", "--frame", frame],
            "along the input's axes (left-posterior-superior)",
        );
        let facts = place.succeeds(&["info", &out, "--json"]).json();
        assert_eq!(facts["origin"], serde_json::json!([5.0, 6.0]), "{frame}");
        assert_eq!(facts["spacing"], serde_json::json!([2.0, 3.0]), "{frame}");
    }
}

/// `--frame` says along which axes a whole volume is written where the file states its own, and how numbers are read
/// where it does not.
#[test]
fn frames_of_whole_volumes_turn_tensors_but_never_relabel_them() {
    let place = Place::new();
    let turned = "NRRD0005\ntype: double\ndimension: 4\nspace: RAS\nsizes: 6 1 1 1\n\
                  space directions: none (0,1,0) (-1,0,0) (0,0,1)\nkinds: 3D-symmetric-matrix space space space\n\
                  encoding: ascii\nmeasurement frame: (1,0,0) (0,1,0) (0,0,1)\n\n1 0 0 2 0 3\n";
    place.write("stated.nrrd", turned);
    let first = |file: &str| place.image(file).point_arrays[0].values[..5].to_vec();
    place.says(&["convert", "stated.nrrd", "world.vti"], "along the input's axes (RAS)");
    assert_eq!(first("world.vti"), [1.0, 0.0, 0.0, 0.0, 2.0]);
    place.says(&["convert", "stated.nrrd", "voxel.vti", "--frame", "voxel"], "directions are left out");
    assert_eq!(first("voxel.vti"), [2.0, 0.0, 0.0, 0.0, 1.0]);
    place.says(&["convert", "world.vti", "again.vti", "--frame", "voxel"], "directions are left out");
    assert_eq!(first("again.vti"), [2.0, 0.0, 0.0, 0.0, 1.0]);
    place.succeeds(&["convert", "stated.nrrd", "voxel.nrrd", "--frame", "voxel"]);
    place.succeeds(&["compare", "stated.nrrd", "voxel.nrrd", "--tolerance", "0"]);
    let open = turned.replace("measurement frame: (1,0,0) (0,1,0) (0,0,1)\n", "");
    place.write("open.nrrd", open);
    place.says(&["convert", "open.nrrd", "read.vti", "--frame", "voxel"], "along the input's axes (RAS)");
    assert_eq!(first("read.vti"), [2.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(place.image("read.vti").direction, place.image("world.vti").direction);
    // Of a plane it says how numbers are read, and where the file states something else, that is said.
    let plane = ["convert", "stated.nrrd", "plane.npy", "--slice", "z=0", "--frame", "voxel"];
    place.says(&plane, "the file states components along");
}

/// What a plane is along says nothing of how it lies.
#[test]
fn pictures_stay_upright_whatever_their_frame_is_called() {
    let place = Place::new();
    place.write("p.txt", unit_text(3, 2));
    place.succeeds(&["convert", "p.txt", "plain.vti"]);
    for frame in ["world", "voxel"] {
        let out = format!("{frame}.vti");
        place.succeeds(&["convert", "p.txt", &out, "--frame", frame]);
        assert_eq!(place.image(&out).direction, place.image("plain.vti").direction, "{frame}");
    }
}

/// Voxels that were not measured say nothing about the order.
#[test]
fn masked_voxels_are_not_counted() {
    let place = Place::new();
    let head = "NRRD0004\ntype: double\ndimension: 4\nsizes: 7 2 2 1\nkinds: 3D-masked-symmetric-matrix space space space\n\
                encoding: ascii\n\n";
    place.write("m.nrrd", head.to_owned() + "1 2 0 0 1 0 1\n0 -1 0 0 1 0 1\n0 -1 0 0 1 0 1\n1 0 0 0 0 0 0\n");
    let facts = place.succeeds(&["info", "m.nrrd", "--json", "--slice", "z=0"]).json()["volume"].clone();
    assert_eq!(facts["negative_eigenvalues_histogram"], serde_json::json!([2, 0, 0, 0]));
    assert_eq!(
        (&facts["shares"]["zero"], &facts["masked"]),
        (&serde_json::json!(0.5), &serde_json::json!(2))
    );
}

/// Volumes are compared whole, or slice by slice.
#[test]
fn volumes_are_compared() {
    let place = Place::new();
    place.write("v.nrrd", nrrd());
    place.write("w.nrrd", nrrd().replace("12 0 0.5 20 0 30", "12 0 0.5 20 0 31"));
    let whole = place.tigereye(&["compare", "v.nrrd", "w.nrrd"]);
    assert_eq!(whole.code, 1, "{}", whole.stderr);
    assert!(
        whole.stdout.contains("[2, 2, 3, 3, 3]") && whole.stdout.contains("at [1, 1, 2, 2, 2]"),
        "{}",
        whole.stdout
    );
    let slice = |index| place.tigereye(&["compare", "v.nrrd", "w.nrrd", "--slice", index]).code;
    assert_eq!((slice("z=0"), slice("z=1"), slice("x=2")), (0, 0, 1));
}

#[test]
fn invariants_are_arrays_beside_the_tensors() {
    let place = Place::new();
    place.write("v.nrrd", nrrd());
    place.says(
        &["convert", "v.nrrd", "o.vti", "--invariants", "--frame", "world"],
        "along the input's axes (left-posterior-superior)",
    );
    let image = tigereye_io::vti::read(&place.read("o.vti")).unwrap();
    let first = |name: &str| image.point_array(name).unwrap().values[0];
    // xx 1, yy 20, zz 30, xz 0.5.
    assert!((first("MD") - 17.0).abs() < 1e-12, "{}", first("MD"));
    let fa = tigereye_core::fractional_anisotropy3(tigereye_core::symmetric_eigenvalues3(&[
        1.0, 0.0, 0.5, 0.0, 20.0, 0.0, 0.5, 0.0, 30.0,
    ]));
    assert_eq!(first("FA"), fa);
    assert!(first("mode") < 0.0 && first("mode") > -1.0, "rather planar: {}", first("mode"));
    // A volume of one layer is one too: its third row and column stay.
    let layer = nrrd().replace("sizes: 6 3 2 2", "sizes: 6 3 4 1");
    place.write("layer.nrrd", layer);
    place.says(
        &["convert", "layer.nrrd", "layer.vti", "--invariants", "--frame", "world"],
        "along the input's axes (left-posterior-superior)",
    );
    let layer = tigereye_io::vti::read(&place.read("layer.vti")).unwrap();
    assert_eq!(
        layer.point_array("Tensors").unwrap().values[..9],
        [1.0, 0.0, 0.5, 0.0, 20.0, 0.0, 0.5, 0.0, 30.0]
    );
    let refuses = |options: &[&str], words: &str| {
        place.refuses(&[&["convert", "v.nrrd"], options, &["--invariants"]].concat(), &[words]);
    };
    refuses(&["o.nii"], "expected .vti, .vtp or .vtk");
    refuses(&["p.vti", "--slice", "z=0"], "need a whole volume of 3 x 3 tensors");
    place.refuses(&["convert", "inverse:size=5", "p.vti", "--invariants"], &["volume of 3 x 3 tensors"]);
}

/// Measured slices go through every command; gradient volumes of others are described.
#[test]
fn reference_files_work_with_every_command() {
    let Some(folder) = reference_folder(".") else { return };
    let place = Place::new();
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(folder.join("manifest.json")).unwrap()).unwrap();
    for entry in manifest["real"].as_array().unwrap() {
        let input = folder.join(entry["file"].as_str().unwrap()).display().to_string();
        let facts = place.succeeds(&["info", &input, "--json"]).json();
        assert_eq!(facts["width"], entry["width"], "{input}");
        assert_eq!(facts["volume"]["zero_tensors"], entry["zero_tensors"], "{input}");
        place.succeeds(&["convert", &input, "o.vtk", "--force"]);
        place.succeeds(&["compare", &input, "o.vtk", "--tolerance", "0"]);
        let part = ["--crop", "5:17,5:17", "--directions", "8"];
        place.succeeds(&[&["ltg", &input, "-o", "g.vti"], &part[..]].concat());
        place.says(&[&["propagate", &input, "--light", "6,6", "-o", "l.vti"], &part[..]].concat(), "");
    }
    for entry in manifest["volumes"].as_array().unwrap() {
        let input = folder.join(entry["volume"].as_str().unwrap()).display().to_string();
        let facts = place.succeeds(&["info", &input, "--json"]).json();
        assert_eq!(facts["arrays"][0]["name"], "Energy", "{input}");
        assert!(place.succeeds(&["info", &input]).stdout.contains("no tensor field"), "{input}");
    }
}
