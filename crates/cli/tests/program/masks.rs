//! Masks of other files: how they lie over the input.

use crate::support::*;
use tigereye_core::Tensor2;
use tigereye_io::npy;

const W: usize = 4;
const H: usize = 3;

/// 0 in the first two cells of the lowest row of a picture, whose row 0 is on top; 1 elsewhere.
fn confidence(column: usize, row: usize) -> f64 {
    if row == H - 1 && column < 2 { 0.0 } else { 1.0 }
}

/// The rows of a picture from above.
fn from_above() -> Vec<f64> {
    (0..W * H).map(|i| confidence(i % W, i / W)).collect()
}

/// The rows of a picture from below, as the y of a volume runs.
fn from_below() -> Vec<f64> {
    (0..W * H).map(|i| confidence(i % W, H - 1 - i / W)).collect()
}

/// A NIfTI file of one axial layer.
fn nifti_layer(thickness: f32, intent: i16, components: usize, values: &[f64]) -> Vec<u8> {
    let shape = [5, W as i16, H as i16, 1, 1, components as i16, 1, 1];
    nifti_file(shape, [0.5, 0.7, thickness], intent, values)
}

fn picture(colour: png::ColorType, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, W as u32, H as u32);
    encoder.set_color(colour);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

/// One rule in all formats: the mask of a plane lies over the picture of the plane, and where one of the two has no
/// place, this is said.
#[test]
fn masks_of_planes_lie_over_the_picture_in_every_format() {
    let place = Place::new();
    let symmetric = [1.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    let all: Vec<f64> = symmetric.iter().flat_map(|v| vec![*v; W * H]).collect();
    place.write("t.nii", nifti_layer(1.0, 1005, 6, &all));
    place.write("t.npy", npy::write_array(&[H, W, 2, 2], &[1.0, 0.0, 0.0, 1.0].repeat(W * H)).unwrap());
    place.says(&["convert", "t.nii", "t.vti", "--slice", "z=0"], "");
    place.says(&["convert", "t.nii", "t.nrrd"], "");
    place.write("m.nii", nifti_layer(1.0, 0, 1, &from_below()));
    place.write("thick.nii", nifti_layer(9.0, 0, 1, &from_below()));
    place.write("m.npy", npy::write_array(&[H, W], &from_above()).unwrap());
    let line = |row: &[f64]| row.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    place.write("m.txt", from_above().chunks(W).map(|row| line(row) + "\n").collect::<String>());
    place.write(
        "m.csv",
        from_above().chunks(W).map(|row| line(row).replace(' ', ",") + "\n").collect::<String>(),
    );
    let grey: Vec<u8> = from_above().iter().map(|v| 255 * *v as u8).collect();
    place.write("m.png", picture(png::ColorType::Grayscale, &grey));
    // Transparent pixels of a white picture leave cells out, too.
    let clear: Vec<u8> = grey.iter().flat_map(|v| [255, *v]).collect();
    place.write("clear.png", picture(png::ColorType::GrayscaleAlpha, &clear));
    for tensors in ["t.nii", "t.nrrd", "t.vti", "t.npy"] {
        for mask in ["m.nii", "thick.nii", "m.npy", "m.txt", "m.csv", "m.png", "clear.png"] {
            let run = place.says(&["convert", tensors, "o.npy", "--force", "--mask", mask], "");
            let field = npy::read_tensors(&place.read("o.npy")).unwrap();
            let kept = field.values().iter().map(|t| if t.is_zero() { 0.0 } else { 1.0 });
            assert_eq!(kept.collect::<Vec<f64>>(), from_above(), "{tensors} {mask}");
            let without = match (tensors, mask.ends_with(".nii")) {
                ("t.npy", false) => None,
                ("t.npy", true) => Some("the input"),
                (_, false) => Some("the mask"),
                (_, true) => None,
            };
            let words = |what: &str| format!("{what} does not say where it lies");
            let said = without.is_none_or(|what| run.stderr.contains(&words(what)));
            assert!(said, "{tensors} {mask}: {}", run.stderr);
            let laid = run.stderr.contains("laid over the picture");
            assert_eq!(laid, without.is_some(), "{tensors} {mask}: {}", run.stderr);
            assert!(!run.stderr.contains("coincide"), "{tensors} {mask}: {}", run.stderr);
        }
    }
}

/// Volumes of few layers are no images of vectors where a mask is wanted.
#[test]
fn masks_of_volumes_are_applied_voxel_by_voxel() {
    let place = Place::new();
    let symmetric = [1.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    let all: Vec<f64> = symmetric.iter().flat_map(|v| vec![*v; 24]).collect();
    place.write("t.nii", nifti_file([5, 4, 2, 3, 1, 6, 1, 1], [1.0; 3], 1005, &all));
    // [x][y][z] without the voxel (3, 0, 2).
    let mask = |i: usize| if i == 3 * 6 + 2 { 0.0 } else { 1.0 };
    place.write("m.npy", npy::write_array(&[4, 2, 3], &(0..24).map(mask).collect::<Vec<f64>>()).unwrap());
    let words = "mask m.npy applied voxel by voxel: the mask does not say where it lies";
    place.says(&["convert", "t.nii", "o.npy", "--slice", "z=2", "--mask", "m.npy"], words);
    let field = npy::read_tensors(&place.read("o.npy")).unwrap();
    let zero: Vec<usize> = (0..8).filter(|&i| field.values()[i].is_zero()).collect();
    assert_eq!(zero, [7], "the lower right cell");
    place.write("rgb.npy", npy::write_array(&[2, 2, 3], &[1.0; 12]).unwrap());
    place.refuses(
        &["info", "t.nii", "--mask", "rgb.npy"],
        &["mask rgb.npy: 2 x 2 x 3 voxels: expected 4 x 2 x 3"],
    );
}

/// Derivatives are one-sided beside transparent pixels, whose colours are nobody's.
#[test]
fn transparent_pixels_are_left_out_of_derivatives() {
    let place = Place::new();
    let pixel = |i: usize| if i % W < 3 { [(20 * (i % W)) as u8, 255] } else { [200, 0] };
    place.write(
        "p.png",
        picture(png::ColorType::GrayscaleAlpha, &(0..W * H).flat_map(pixel).collect::<Vec<u8>>()),
    );
    let options = ["convert", "p.png", "o.npy", "--derive", "structure", "--sigma", "0", "--window", "0"];
    place.says(&options, "3 of 12 pixels are transparent, taken as samples without data");
    let field = npy::read_tensors(&place.read("o.npy")).unwrap();
    let step = 20.0 / 255.0;
    for (i, t) in field.values().iter().enumerate() {
        let expected = if i % W < 3 { Tensor2::symmetric(step * step, 0.0, 0.0) } else { Tensor2::ZERO };
        let off =
            t.components().iter().zip(expected.components()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "cell {i}: {t:?}");
    }
}

/// ParaView's flags of points leave out vectors as they do tensors.
#[test]
fn flags_of_paraview_mask_tensors_and_vectors() {
    let place = Place::new();
    for (flag, out, kept) in [("vtkValidPointMask", 0, 1), ("vtkGhostType", 2, 0)] {
        let table = |names: &str, values: &str| {
            let line = |i: usize| {
                let (x, y) = (i % 5, i / 5);
                let (flag, values) = if i == 12 { (out, "0,0,0") } else { (kept, values) };
                format!("{flag},{},{x},{y},0\n", values.replace('x', &x.to_string()))
            };
            let names = format!("\"{flag}\",{names},\"Points:0\",\"Points:1\",\"Points:2\"\n");
            names + &(0..25).map(line).collect::<String>()
        };
        place.write("t.csv", table("\"S_XX\",\"S_YY\",\"S_XY\"", "1,2,0.5"));
        place.write("v.csv", table("\"U:0\",\"U:1\",\"U:2\"", "x,0,0"));
        for (options, first) in [(&["t.csv"][..], 1.0), (&["v.csv", "--derive", "gradient"], 1.0)] {
            let run = place.says(&[&["convert"], options, &["o.npy", "--force"]].concat(), "1 of 25");
            assert!(run.stderr.contains(&format!("left out by the column `{flag}`")), "{}", run.stderr);
            let unread = run.stderr.lines().find(|line| line.contains("not read"));
            assert!(unread.is_none_or(|line| !line.contains(flag)), "{unread:?}");
            let field = npy::read_tensors(&place.read("o.npy")).unwrap();
            for (i, t) in field.values().iter().enumerate() {
                let is_out = i == 12;
                assert_eq!(
                    (t.is_zero(), t.xx()),
                    (is_out, if is_out { 0.0 } else { first }),
                    "{flag} cell {i}"
                );
            }
        }
    }
}

/// Of several arrays the one that is called a mask is one, whichever is active; what was taken is said, and another may
/// be named.
#[test]
fn the_array_of_a_mask_is_said_and_may_be_named() {
    let place = Place::new();
    let array = |name: &str, value: &dyn Fn(usize) -> f64| {
        let values: Vec<String> = (0..9).map(|i| value(i).to_string()).collect();
        format!("SCALARS {name} double 1\nLOOKUP_TABLE default\n{}\n", values.join(" "))
    };
    let head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 1\nORIGIN 0 0 0\nSPACING 1 1 1\n\
                POINT_DATA 9\n";
    let (pressure, corner, edge) = (
        |_: usize| 5.0,
        |i: usize| if i == 0 { 0.0 } else { 1.0 },
        |i: usize| if i < 3 { -1.0 } else { 1.0 },
    );
    place.write("t.vtk", format!("{head}TENSORS t double\n{}", "1 0 0 0 2 0 0 0 3\n".repeat(9)));
    place.write("named.vtk", head.to_owned() + &array("p", &pressure) + &array("Brain_mask", &corner));
    place.write("plain.vtk", head.to_owned() + &array("p", &edge) + &array("q", &corner));
    place.write("two.vtk", head.to_owned() + &array("mask", &edge) + &array("valid", &corner));
    let zeros = |options: &[&str], words: &str| {
        let run = place.says(&[&["convert", "t.vtk", "o.npy", "--force"], options].concat(), words);
        assert!(words.is_empty() != run.stderr.contains("ignored"), "{}", run.stderr);
        let field = npy::read_tensors(&place.read("o.npy")).unwrap();
        field.values().iter().filter(|t| t.is_zero()).count()
    };
    assert_eq!(zeros(&["--mask", "named.vtk"], "took `Brain_mask`; ignored: `p` (--mask-array)"), 1);
    assert_eq!(zeros(&["--mask", "plain.vtk"], "took the active scalars `p`; ignored: `q`"), 3);
    assert_eq!(zeros(&["--mask", "plain.vtk", "--mask-array", "q"], ""), 1);
    place.refuses(&["info", "t.vtk", "--mask", "two.vtk"], &["several arrays fit", "(option --mask-array)"]);
    place.refuses(&["info", "t.vtk", "--mask", "two.vtk", "--mask-array", "r"], &["no array `r`"]);
    // Inside a table of data such a column would leave points out.
    let line = |i: usize| format!("{},{},{},7\n", i % 3, i / 3, if i == 0 { 0 } else { 1 });
    place.write("m.csv", "x,y,mask,T\n".to_owned() + &(0..9).map(line).collect::<String>());
    let run =
        place.says(&["convert", "t.vtk", "o.npy", "--force", "--mask", "m.csv"], "took `mask`; ignored: `T`");
    assert!(run.stderr.contains("points are kept where it is above 0"), "{}", run.stderr);
    place.refuses(&["info", "t.vtk", "--mask", "m.csv", "--mask-above", "1"], &["leaves nothing", "above 1"]);
}

/// Derivatives, too, are of one array of several, and which is said.
#[test]
fn the_array_that_is_derived_from_is_said() {
    let place = Place::new();
    let head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 1\nORIGIN 0 0 0\nSPACING 1 1 1\n\
                POINT_DATA 9\n";
    let vectors = |name: &str| format!("VECTORS {name} double\n{}", "1 2 3\n".repeat(9));
    let scalars = |name: &str| format!("SCALARS {name} double 1\nLOOKUP_TABLE default\n{}", "4\n".repeat(9));
    place.write("v.vtk", head.to_owned() + &vectors("U") + &vectors("W"));
    place.write("s.vtk", head.to_owned() + &scalars("a") + &scalars("b"));
    place.says(
        &["convert", "v.vtk", "o.npy", "--force", "--derive", "gradient"],
        "took the active vectors `U`; ignored: `W` (--array)",
    );
    place.says(
        &["convert", "s.vtk", "o.npy", "--force", "--derive", "hessian"],
        "took the active scalars `a`; ignored: `b` (--array)",
    );
}
