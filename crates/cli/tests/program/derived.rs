//! Tensors derived from vectors and images: holes, borders, tables of PIV programs; FA of planes and volumes.

use crate::support::*;
use tigereye_core::{Field, Tensor2};
use tigereye_io::npy;

const W: usize = 12;
const H: usize = 10;
/// Rounding of derivatives, of values of about 1.
const ROUNDING: f64 = 1e-9;

fn array(shape: &[usize], value: impl Fn(usize) -> f64) -> Vec<u8> {
    let values: Vec<f64> = (0..shape.iter().product()).map(value).collect();
    npy::write_array(shape, &values).unwrap()
}

fn converted(place: &Place, options: &[&str]) -> Field<Tensor2> {
    let run = place.tigereye(&[&["convert"], options, &["out.npy", "--force"]].concat());
    assert_eq!(run.code, 0, "{options:?}: {}", run.stderr);
    npy::read_tensors(&place.read("out.npy")).unwrap()
}

#[track_caller]
fn near(t: &Tensor2, expected: [f64; 4], what: &str) {
    let near = t.components().iter().zip(expected).all(|(a, b)| (a - b).abs() < ROUNDING);
    assert!(near, "{what}: {t:?}, not {expected:?}");
}

/// Six cells without a vector.
fn in_hole(cell: usize) -> bool {
    (4..7).contains(&(cell % W)) && (3..5).contains(&(cell / W))
}

/// A flow of gradient ((0.2, 0.1), (0.3, 0)), with something else in its hole.
fn flow(hole: f64) -> Vec<u8> {
    array(&[H, W, 2], |i| {
        let (x, y) = ((i / 2 % W) as f64, (H - 1 - i / 2 / W) as f64);
        if in_hole(i / 2) { hole } else { [0.2 * x + 0.1 * y - 0.9, 0.3 * x][i % 2] }
    })
}

const SAID: &str = "6 of 120 cells of the plane have no derived tensor and are taken as zero tensors: 6";

/// What stands in a hole has no say: NaN or 0 under a mask, NaN taken as a hole, by differences and at a scale.
#[test]
fn holes_are_never_mixed_in() {
    let place = Place::new();
    place.write("nan.npy", flow(f64::NAN));
    place.write("zero.npy", flow(0.0));
    place.write("mask.npy", array(&[H, W], |i| f64::from(u8::from(!in_hole(i)))));
    let readings: [&[&str]; 3] = [
        &["zero.npy", "--mask", "mask.npy"],
        &["nan.npy", "--mask", "mask.npy"],
        &["nan.npy", "--not-finite", "zero"],
    ];
    for reading in readings {
        for sigma in ["0", "1.5"] {
            let options = [reading, &["--derive", "gradient", "--sigma", sigma]].concat();
            for (i, t) in converted(&place, &options).values().iter().enumerate() {
                let expected = if in_hole(i) { [0.0; 4] } else { [0.2, 0.1, 0.3, 0.0] };
                near(t, expected, &format!("{options:?}, cell {i}"));
            }
        }
    }
    place.refuses(
        &["info", "nan.npy", "--derive", "gradient"],
        &["cell (4, 3)", "6 such", "--mask", "--not-finite zero"],
    );
}

/// Every command says how many cells a hole costs, and an experiment does.
#[test]
fn the_loss_is_said() {
    let place = Place::new();
    place.write("nan.npy", flow(f64::NAN));
    let reading = ["--derive", "gradient", "--not-finite", "zero"];
    let commands: [&[&str]; 5] = [
        &["convert", "nan.npy", "o.vti"],
        &["propagate", "nan.npy", "--light", "2,2", "-o", "l.npy"],
        &["ltg", "nan.npy", "--directions", "8", "-o", "g.vti"],
        &["lines", "nan.npy", "-o", "l.svg"],
        &["glyphs", "nan.npy", "-o", "g.svg"],
    ];
    for command in commands {
        let run = place.tigereye(&[command, &reading].concat());
        assert_eq!(run.code, 0, "{command:?}: {}", run.stderr);
        assert!(run.stderr.contains(SAID), "{command:?}: {}", run.stderr);
    }
    let facts = place.succeeds(&[&["info", "nan.npy", "--json"][..], &reading].concat()).json();
    assert!(facts["remarks"].to_string().contains(SAID) && facts["assumptions"].to_string().contains(SAID));
    place.write(
        "f.field.ron",
        "(format: 1, title: \"t\", field: File(path: \"nan.npy\", derive: StrainRate(), not_finite: \"zero\"))",
    );
    let run = place.tigereye(&["convert", "f.field.ron", "o.npy"]);
    assert!(run.code == 0 && run.stderr.contains(SAID), "{}", run.stderr);
}

#[test]
fn hessians_are_right_at_the_border() {
    let place = Place::new();
    let quadric = |i: usize| {
        let (x, y) = ((i % W) as f64, (H - 1 - i / W) as f64);
        3.0 + x - 2.0 * y + 0.25 * x * x + 0.5 * x * y - 1.5 * y * y
    };
    place.write("quadric.npy", array(&[H, W], quadric));
    for sigma in ["0", "0.3", "1", "2"] {
        let options = ["quadric.npy", "--derive", "hessian", "--sigma", sigma];
        for (i, t) in converted(&place, &options).values().iter().enumerate() {
            near(t, [0.5, 0.5, 0.5, -3.0], &format!("sigma {sigma}, cell {i}"));
        }
    }
}

#[test]
fn strain_rates_and_orientations_belong_to_gradients_and_structures() {
    let place = Place::new();
    place.write("flow.npy", flow(0.5));
    let gradient = converted(&place, &["flow.npy", "--derive", "gradient"]);
    let strain = converted(&place, &["flow.npy", "--derive", "strain-rate"]);
    assert_eq!(strain, gradient.map(Tensor2::symmetric_part));
    // Stripes along y.
    place.write("stripes.npy", array(&[H, W], |i| f64::from(u8::from(i % W % 4 < 2))));
    let structure = converted(&place, &["stripes.npy", "--derive", "structure", "--window", "2"]);
    let orientation = converted(&place, &["stripes.npy", "--derive", "orientation", "--window", "2"]);
    for (j, t) in structure.values().iter().zip(orientation.values()) {
        assert!(j.xx() > 0.0 && j.yy().abs() < ROUNDING, "{j:?}");
        assert_eq!((t.xx(), t.yy()), (j.yy(), j.xx()));
    }
    let text = place.succeeds(&["info", "stripes.npy", "--derive", "structure"]).stdout;
    assert!(text.contains("runs across stripes"), "{text}");
    let text = place.succeeds(&["info", "stripes.npy", "--derive", "orientation"]).stdout;
    assert!(text.contains("along stripes"), "{text}");
    place.refuses(
        &["info", "flow.npy", "--derive", "strain-rate", "--window", "2"],
        &["--window has no effect here"],
    );
}

/// x y u v flags mask as OpenPIV saves them, of a rotation and a shear: gradient ((0, -0.01), (0.02, 0)).
fn openpiv(header: &str, masked: impl Fn(usize) -> bool) -> String {
    (0..48).fold(header.to_owned(), |text, i| {
        let (x, y) = (16.0 * (1 + i % 8) as f64, 96.0 - 16.0 * (i / 8) as f64);
        let (u, v) = (0.01 * (96.0 - y), 0.02 * (x - 72.0));
        let mask = u8::from(masked(i));
        let (u, v) = if mask == 1 { (0.0, 0.0) } else { (u, v) };
        text + &format!("{x:.4e}\t{y:.4e}\t{u:.4e}\t{v:.4e}\t0.0000e+00\t{mask}\n")
    })
}

/// Tables of vectors are never read as blocks of tensors.
#[test]
fn tables_of_vectors_give_their_gradient() {
    let place = Place::new();
    let cases = [
        ("plain.txt", openpiv("", |_| false), 0),
        ("named.txt", openpiv("# x\ty\tu\tv\tflags\tmask\n", |i| i == 20), 1),
        ("commas.csv", openpiv("x,y,u,v,flags,mask\n", |_| false).replace('\t', ","), 0),
    ];
    for (name, text, masked) in cases {
        place.write(name, text);
        place.says(&["convert", name, "--derive", "gradient", "g.npy", "--force"], "y taken to run upwards");
        let gradient = npy::read_tensors(&place.read("g.npy")).unwrap();
        assert_eq!((gradient.grid().width(), gradient.grid().height()), (8, 6));
        assert_eq!(gradient.values().iter().filter(|t| t.is_zero()).count(), masked, "{name}");
        for t in gradient.values().iter().filter(|t| !t.is_zero()) {
            near(t, [0.0, -0.01, 0.02, 0.0], name);
        }
        place.refuses(&["info", name], &[name, "table", "--derive gradient"]);
        let words = if name == "plain.txt" { "without column names" } else { "several arrays fit: `u`" };
        place.refuses(&["info", name, "--derive", "hessian"], &[name, words]);
        let facts = place.succeeds(&["info", name, "--derive", "strain-rate", "--json"]).json();
        assert_eq!(facts["spacing"], serde_json::json!([16.0, 16.0]));
        assert!(facts["assumptions"].to_string().contains("y taken to run upwards"), "{facts:#}");
    }
    place.write("blocks.txt", "1 0 2 0\n0 1 0 2\n3 0 4 0\n0 3 0 4\n");
    assert_eq!(converted(&place, &["blocks.txt"]).values()[3], Tensor2::isotropic(4.0));
    place.write("bad.csv", "x,y,u,v\n1,2,3,4\n2,2,z,4\n");
    place.refuses(&["info", "bad.csv", "--derive", "gradient"], &["line 3, column 5", "`z`"]);
}

/// FA is one quantity: that of a plane is that of the volume of one layer.
#[test]
fn planes_and_volumes_have_one_fractional_anisotropy() {
    let place = Place::new();
    place.write("shear.npy", array(&[8, 8, 2, 2], |i| [0.0, 1.0, 1.0, 0.0][i % 4]));
    place.write("mixed.npy", array(&[4, 5, 2, 2], |i| ((i * i * 7 + 3) % 11) as f64 - 4.0));
    for (name, above) in [("shear.npy", 64), ("mixed.npy", 1)] {
        let plane = place.succeeds(&["info", name, "--json"]).json();
        for key in
            ["fractional_anisotropy", "fractional_anisotropy_histogram", "fractional_anisotropy_above_1"]
        {
            assert_eq!(plane[key], plane["volume"][key], "{name}: {key}");
        }
        assert!(plane["fractional_anisotropy_above_1"].as_u64() >= Some(above), "{plane:#}");
    }
    let shear = place.succeeds(&["info", "shear.npy", "--json"]).json();
    assert!((shear["fractional_anisotropy"]["max"].as_f64().unwrap() - 1.5_f64.sqrt()).abs() < ROUNDING);
    assert_eq!(shear["planar_anisotropy"]["max"], 0.0);
    let text = place.succeeds(&["info", "shear.npy"]).stdout;
    assert!(text.contains("64 above 1 (indefinite symmetric parts)"), "{text}");
}
