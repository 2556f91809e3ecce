//! Files written by other tools, read to the values their own readers give.

use crate::support::{bytes, json};
use serde_json::Value;
use tigereye_core::{Cell, Field, Tensor2};
use tigereye_io::volume::{
    Frame, Lattice, Plane, PlaneChoice, PlaneError, Reading, TensorVolume, lattice_from_image,
    lattice_from_points,
};
use tigereye_io::{
    DataArray, ImageData, Wanted, legacy, ltg_from_image, matrices, nifti, npy, nrrd, vti, vtp,
};
use tigereye_test_support::{data_folder, reference_folder};

/// Relative to the range: the files hold f32, text files fewer digits.
const RANGE_TOLERANCE: f64 = 1e-6;
/// Relative: serde_json may miss the last bit of a number.
const JSON_TOLERANCE: f64 = 3e-16;

fn number(v: &Value) -> f64 {
    v.as_f64().expect("a number")
}
fn index(v: &Value) -> usize {
    usize::try_from(v.as_u64().expect("an index")).unwrap()
}
fn list(v: &Value) -> &[Value] {
    v.as_array().expect("a list")
}

#[track_caller]
fn same(what: &str, value: f64, expected: &Value) {
    let expected = number(expected);
    assert!(
        (value - expected).abs() <= JSON_TOLERANCE * expected.abs(),
        "{what}: {value} instead of {expected}"
    );
}

#[track_caller]
fn near(what: &str, value: f64, expected: f64, scale: f64) {
    assert!((value - expected).abs() <= RANGE_TOLERANCE * scale, "{what}: {value} instead of {expected}");
}

/// Compares all values of a file, tuples of `n` x `n` components, with its entry in `expected.json`.
fn check_values(entry: &Value, n: usize, values: &[f64]) {
    let file = entry["file"].as_str().unwrap();
    let (min, max) = (number(&entry["min"]), number(&entry["max"]));
    let scale = max - min;
    assert_eq!(values.len(), index(&entry["count"]) * n * n, "{file}");
    near(file, values.iter().copied().fold(f64::INFINITY, f64::min), min, scale);
    near(file, values.iter().copied().fold(f64::NEG_INFINITY, f64::max), max, scale);
    let tensors = || values.chunks(n * n);
    let trace = |t: &[f64]| (0..n).map(|i| t[i * n + i]).sum::<f64>();
    let mean = tensors().map(trace).sum::<f64>() / tensors().len() as f64;
    near(file, mean, number(&entry["mean_trace"]), scale);
    let zero = tensors().filter(|t| t.iter().all(|&v| v == 0.0)).count();
    assert_eq!(zero, index(&entry["zero_tensors"]), "{file}");
    let shape: Vec<usize> = list(&entry["shape_xyz"]).iter().map(index).collect();
    for probe in list(&entry["probes"]) {
        let at = list(&probe["index"]).iter().zip(&shape).rev().fold(0, |i, (p, s)| i * s + index(p));
        let rows = list(&probe["tensor"]).iter().flat_map(list);
        for (i, expected) in rows.enumerate() {
            near(file, values[at * n * n + i], number(expected), scale);
        }
    }
}

fn entries(expected: &Value, extension: &str) -> Vec<Value> {
    let named = |e: &&Value| e["file"].as_str().is_some_and(|f| f.ends_with(extension));
    list(&expected["files"]).iter().filter(named).cloned().collect()
}

fn tensor_array(image: &ImageData) -> &DataArray {
    let name = image.point_active.tensors.as_deref().expect("active tensors");
    image.point_array(name).expect("the active array")
}

#[test]
fn numpy_files_have_their_published_values() {
    let Some(data) = data_folder(".") else { return };
    let expected = json(&data, "expected.json");
    let entries = entries(&expected, ".npy");
    assert_eq!(entries.len(), 4);
    for entry in entries {
        let file = bytes(&data, entry["file"].as_str().unwrap());
        let array = npy::read_array(&file).unwrap();
        check_values(&entry, 2, &array.values);
        let field = npy::read_tensors(&file).unwrap();
        let asymmetric = field.values().iter().filter(|t| t.asymmetry() > 0.0).count();
        assert_eq!(asymmetric, index(&entry["asymmetric_tensors"]));
    }
}

#[test]
fn image_files_have_their_published_values() {
    let Some(data) = data_folder(".") else { return };
    let expected = json(&data, "expected.json");
    let entries = entries(&expected, ".vti");
    assert_eq!(entries.len(), 11);
    for entry in entries {
        let image = vti::read(&bytes(&data, entry["file"].as_str().unwrap())).unwrap();
        let shape: Vec<usize> = list(&entry["shape_xyz"]).iter().map(index).collect();
        assert_eq!(image.dimensions.to_vec(), shape);
        check_values(&entry, 3, &tensor_array(&image).values);
    }
}

/// The 2D images hold the same tensors as the arrays; only the rows run the other way.
#[test]
fn images_are_arrays_with_rows_reversed() {
    let Some(data) = data_folder(".") else { return };
    let names =
        ["camera_structure_tensor_128", "mni152_hessian_slice", "piv_velocity_gradient", "plate_hole_stress"];
    for name in names {
        let array = npy::read_tensors(&bytes(&data, &format!("{name}.npy"))).unwrap();
        let image = vti::read(&bytes(&data, &format!("{name}.vti"))).unwrap();
        let read = crate::support::field_of(&image, None).unwrap();
        assert_eq!(read.cut.reversed(), [false, false], "{name}");
        let grid = array.grid();
        let flipped = Field::from_fn(grid, |c| *array.at(Cell::new(c.x, grid.height() - 1 - c.y)));
        assert_eq!(read.field, flipped, "{name}");
    }
}

#[test]
fn all_encodings_give_the_same_tensors() {
    let Some(data) = data_folder(".") else { return };
    let read = |kind: &str| vti::read(&bytes(&data, &format!("pointload_{kind}.vti"))).unwrap();
    let first = read("app_raw_none");
    let others =
        ["app_b64_zlib", "app_raw_lz4", "app_raw_zlib_u32", "app_raw_zlib_u64", "ascii", "binary_zlib"];
    for kind in others {
        let image = read(kind);
        assert_eq!((image.dimensions, image.origin, image.spacing), ([20; 3], [-10.0; 3], first.spacing));
        assert_eq!(image.point_active, first.point_active);
        assert_eq!(image.point_arrays.len(), 2);
        for (a, b) in image.point_arrays.iter().zip(&first.point_arrays) {
            assert_eq!((&a.name, a.components, a.scalar), (&b.name, b.components, b.scalar), "{kind}");
            for (x, y) in a.values.iter().zip(&b.values) {
                near(kind, *x, *y, 27.0);
                assert!(kind == "ascii" || x == y, "{kind}");
            }
        }
    }
}

/// Any file of a volume, its components read in an order.
fn volume(data: &std::path::Path, file: &str, order: Option<&str>) -> TensorVolume {
    let bytes = bytes(data, file);
    let lattice: Lattice = match file {
        _ if file.ends_with(".nrrd") => nrrd::read(&bytes, None).unwrap(),
        _ if file.ends_with(".nii.gz") => nifti::read(&bytes).unwrap(),
        _ if file.ends_with(".vtk") => {
            lattice_from_image(&legacy::read(&bytes).unwrap(), None, Wanted::Tensors).unwrap()
        }
        _ => lattice_from_image(&vti::read(&bytes).unwrap(), None, Wanted::Tensors).unwrap(),
    };
    lattice.tensors(Reading { order, ..Reading::default() }).unwrap()
}

/// The order that a file does not state, by its name.
fn order_of(file: &str) -> Option<&'static str> {
    ["dipy", "fsl", "mrtrix"].into_iter().find(|tool| file.contains(tool))
}

#[test]
fn volumes_have_their_published_values() {
    let Some(data) = data_folder(".") else { return };
    let expected = json(&data, "expected.json");
    let mut seen = 0;
    for extension in [".vti", ".vtk", ".nii.gz", ".nrrd"] {
        for entry in entries(&expected, extension).iter().filter(|e| e["rank"] == 3) {
            let file = entry["file"].as_str().unwrap();
            let volume = volume(&data, file, order_of(file));
            let shape: Vec<usize> = list(&entry["shape_xyz"]).iter().map(index).collect();
            assert_eq!(volume.lattice().size.to_vec(), shape, "{file}");
            check_values(entry, 3, &volume.tensors().flatten().collect::<Vec<_>>());
            if let Some(measured) = entry["mask_nonzero"].as_u64() {
                assert_eq!(volume.lattice().voxels() - volume.masked_out(), measured as usize);
            }
            seen += 1;
        }
    }
    assert_eq!(seen, 18);
}

#[test]
fn scalar_images_have_their_published_values() {
    let Some(data) = data_folder(".") else { return };
    let expected = json(&data, "expected.json");
    let entry = &entries(&expected, "small_64D_fa.nii.gz")[0];
    let lattice = nifti::read(&bytes(&data, "small_64D_fa.nii.gz")).unwrap();
    assert_eq!((lattice.size, lattice.components), ([10; 3], 1));
    for probe in list(&entry["probes"]) {
        let [x, y, z] = [0, 1, 2].map(|i| index(&probe["index"][i]));
        near("fa", lattice.values[(z * 10 + y) * 10 + x], number(&probe["value"]), 1.0);
    }
    let tensors = volume(&data, "small_64D_tensor_dipy.nii.gz", None);
    for (t, fa) in tensors.tensors().zip(&lattice.values) {
        // dipy clamps eigenvalues at 1e-9 before it computes FA.
        let l = tigereye_core::symmetric_eigenvalues3(&t).map(|v| v.max(1e-9));
        near("fa", tigereye_core::fractional_anisotropy3(l), *fa, 1.0);
    }
}

/// Every slice of the volume, in the five layouts of one field.
#[test]
fn layouts_of_one_field_give_one_slice() {
    let Some(data) = data_folder(".") else { return };
    let name = |kind: &str| format!("small_64D_tensor_{kind}");
    let dipy = volume(&data, &name("dipy.nii.gz"), Some("dipy"));
    let scale = 0.005;
    for kind in ["symmat5d.nii.gz", "fsl.nii.gz", "mrtrix.nii.gz", "masked.nrrd"] {
        let file = name(kind);
        let order = order_of(&file);
        let frame = order.is_some().then_some(Frame::Voxel);
        let lattice = volume(&data, &file, order).lattice().clone();
        let other = lattice.tensors(Reading { order, frame, ..Reading::default() }).unwrap();
        for plane in [Plane::Xy, Plane::Xz, Plane::Yz] {
            let choice = PlaneChoice { plane: Some(plane), slice: Some((plane.normal(), 4)) };
            let (a, b) = (dipy.slice(choice).unwrap(), other.slice(choice).unwrap());
            for (s, t) in a.field.values().iter().zip(b.field.values()) {
                for (x, y) in s.components().iter().zip(t.components()) {
                    near(&file, y, *x, scale);
                }
            }
        }
    }
}

#[test]
fn wrong_orders_look_wrong() {
    let Some(data) = data_folder(".") else { return };
    for tool in ["dipy", "fsl", "mrtrix"] {
        let file = format!("small_64D_tensor_{tool}.nii.gz");
        assert_eq!(volume(&data, &file, Some(tool)).suspicion(), None, "{file}");
        for wrong in ["vtk", "dipy", "fsl", "mrtrix"].into_iter().filter(|w| *w != tool) {
            let suspicion = volume(&data, &file, Some(wrong)).suspicion().expect("a suspicion");
            assert!(suspicion.tools.contains(tool), "{file} read as {wrong}: {suspicion:?}");
        }
    }
}

#[test]
fn layers_need_a_plane() {
    let Some(data) = data_folder(".") else { return };
    let image = vti::read(&bytes(&data, "pointload_ascii.vti")).unwrap();
    let error = crate::support::field_of(&image, None).unwrap_err();
    assert_eq!(error, tigereye_io::IoError::Plane(PlaneError::Needed { size: [20; 3] }));
}

#[test]
fn published_volumes_have_their_statistics_and_probes() {
    let Some(reference) = reference_folder(".") else { return };
    let manifest = json(&reference, "manifest.json");
    for entry in list(&manifest["volumes"]) {
        let name = entry["volume"].as_str().unwrap();
        let volume = ltg_from_image(&vti::read(&bytes(&reference, name)).unwrap()).unwrap();
        let (w, h) = (index(&entry["width"]), index(&entry["height"]));
        assert_eq!((volume.grid.width(), volume.grid.height()), (w, h), "{name}");
        assert_eq!(volume.slices, (0..index(&entry["directions"])).collect::<Vec<_>>(), "{name}");
        assert_eq!((volume.array.as_str(), volume.provenance), ("Energy", None));
        let values = &volume.values;
        let statistics = &entry["statistics"];
        let max = values.iter().copied().fold(0.0, f64::max);
        same(name, values.iter().copied().fold(0.0, f64::min), &statistics["min"]);
        same(name, max, &statistics["max"]);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        assert!((mean / number(&statistics["mean"]) - 1.0).abs() < 1e-12, "{name}: mean {mean}");
        for probe in list(&entry["probes"]) {
            let [x, y, t] = [0, 1, 2].map(|i| index(&probe[i]));
            same(&format!("{name} at ({x}, {y}, {t})"), values[(t * h + y) * w + x], &probe[3]);
        }
    }
}

#[test]
fn text_fields_have_their_published_counts() {
    let Some(reference) = reference_folder(".") else { return };
    let manifest = json(&reference, "manifest.json");
    for entry in list(&manifest["fields"]) {
        let name = entry["file"].as_str().unwrap();
        let field = matrices::read(&bytes(&reference, name)).unwrap();
        let (w, h) = (index(&entry["width"]), index(&entry["height"]));
        assert_eq!((field.grid().width(), field.grid().height()), (w, h), "{name}");
        let count = |holds: fn(&Tensor2) -> bool| field.values().iter().filter(|&t| holds(t)).count();
        assert_eq!(count(Tensor2::is_zero), index(&entry["zero"]), "{name}");
        assert_eq!(matrices::read(&matrices::write(&field).unwrap()).unwrap(), field, "{name}");
    }
}

/// Measured tensors on poly data: size, range, probes, and the crop that the thesis takes (its first row is the
/// file's).
#[test]
fn measured_slices_have_their_published_values() {
    let Some(reference) = reference_folder(".") else { return };
    let manifest = json(&reference, "manifest.json");
    for entry in list(&manifest["real"]) {
        let file = entry["file"].as_str().unwrap();
        let lattice =
            lattice_from_points(vtp::read(&bytes(&reference, file)).unwrap(), None, Wanted::Tensors).unwrap();
        let (w, h) = (index(&entry["width"]), index(&entry["height"]));
        assert_eq!((lattice.size, lattice.array.as_str()), ([w, h, 1], entry["array"].as_str().unwrap()));
        let volume = lattice.tensors(Reading::default()).unwrap();
        let field = volume.slice(PlaneChoice::default()).unwrap().field;
        let zero = volume.tensors().filter(|t| *t == [0.0; 9]).count();
        assert_eq!(zero, index(&entry["zero_tensors"]), "{file}");
        let range = |f: fn(f64, f64) -> f64, start| volume.tensors().flatten().fold(start, f);
        same(file, range(f64::min, f64::INFINITY), &entry["min"]);
        same(file, range(f64::max, f64::NEG_INFINITY), &entry["max"]);
        for probe in list(&entry["probes"]) {
            let (x, y) = (index(&probe["x"]), index(&probe["y"]));
            let stored = volume.stored(y * w + x);
            stored.iter().zip(list(&probe["tensor"])).for_each(|(v, e)| same(file, *v, e));
            let crop = field.at(Cell::new(x, h - 1 - y)).components();
            assert_eq!(crop, [stored[0], stored[1], stored[3], stored[4]], "{file} ({x}, {y})");
        }
    }
}
