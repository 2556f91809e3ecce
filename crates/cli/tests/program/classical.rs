//! The classical methods: lines, topology, and what bad input makes of them.

use crate::support::Place;
use serde_json::{Value, json};
use tigereye_io::{FieldValues, PolyData, vtp};

fn poly_data(place: &Place, name: &str) -> PolyData {
    vtp::read(&place.read(name)).expect("poly data")
}

/// The provenance of poly data.
fn story(data: &PolyData) -> Value {
    let entry = data.field_data.iter().find(|e| e.name == "tigereye").expect("a story");
    let FieldValues::Text(texts) = &entry.values else { panic!("text") };
    serde_json::from_str(&texts[0]).expect("JSON")
}

/// Lines lie where the program's own image data of the same field lie: rows upwards, in the file's unit.
#[test]
fn lines_lie_over_the_field() {
    let place = Place::new();
    place.write(
        "t.field.ron",
        r#"(format: 1, title: "t", field: Axes(width: 9, height: 5, phi: "pi / 4", s1: "2", s2: "1"))"#,
    );
    place.succeeds(&["lines", "t.field.ron", "--seed", "2,1", "-o", "l.vtp", "l.png", "l.svg"]);
    assert_eq!(place.read("l.png")[1..4], *b"PNG");
    let data = poly_data(&place, "l.vtp");
    assert_eq!(data.lines.len(), 1);
    // The axis lies at 45 degrees; the seed is in row 1 of 5.
    assert!(data.points.iter().all(|[x, y, z]| ((x - 2.0) - (y - 3.0)).abs() < 1e-9 && *z == 0.0));
    assert_eq!(story(&data)["parameters"]["seeds"], json!([[2.0, 1.0]]));
    let names: Vec<&str> =
        data.point_arrays.iter().chain(&data.cell_arrays).map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["values", "family", "ends"]);
    place.succeeds(&["convert", "t.field.ron", "t.vti"]);
    let image = place.image("t.vti");
    place.write(
        "far.vti",
        tigereye_io::vti::write(&tigereye_io::ImageData {
            origin: [100.0, -50.0, 7.0],
            spacing: [0.5, 2.0, 1.0],
            ..image
        })
        .expect("a file"),
    );
    // Cells that are no squares bend no line: it lies at 45 degrees in the file's unit.
    place.succeeds(&["lines", "far.vti", "--seed", "2,1", "--ribbon", "-o", "l.vtp"]);
    let data = poly_data(&place, "l.vtp");
    assert!(data.points.iter().all(|[x, y, _]| ((x - 101.0) - (y + 44.0)).abs() < 1e-9));
    assert!(data.point_arrays.iter().any(|a| a.name == "half_width"));
}

#[test]
fn both_families_and_methods_are_followed() {
    let place = Place::new();
    let lines = |more: &[&str]| {
        let args = [&["lines", "inverse:size=21", "--json", "-o", "l.vtp"], more].concat();
        place.succeeds(&args).json()
    };
    let (one, both) = (lines(&[]), lines(&["--family", "both"]));
    let count = |v: &Value| v["lines"].as_u64().expect("a number");
    assert!(count(&both) > count(&one) && count(&one) > 10, "{one} {both}");
    assert_eq!(one["axes"], "half");
    let sparse = lines(&["--separation", "4"]);
    assert!(count(&sparse) < count(&one));
    let seeds = ["--seed", "4.5,3", "--seed", "15,16"];
    let [fixed, adaptive] =
        ["rk4", "rk45"].map(|m| lines(&[&seeds[..], &["--method", m, "--step", "0.5"]].concat()));
    let length = |v: &Value| v["length"].as_f64().expect("a number");
    assert!((length(&fixed) - length(&adaptive)).abs() < 0.1, "{fixed} {adaptive}");
    assert_eq!(lines(&["--axes", "eigen"])["axes"], "eigen");
    assert_eq!(place.succeeds(&["lines", "wedge:size=9", "--json", "-o", "w.vtp"]).json()["axes"], "eigen");
    // Inertia carries lines over the middle.
    let reach = |more: &[&str]| length(&lines(&[&["--seed", "3,10"], more].concat()));
    assert!(reach(&["--inertia", "0.2"]) > reach(&[]) + 5.0);
}

#[test]
fn topology_names_points_and_separatrices() {
    let place = Place::new();
    let found = place.succeeds(&["topology", "trisector:size=21", "--json", "-o", "t.vtp", "t.png"]).json();
    assert_eq!(found["points"], json!([{ "x": 10.0, "y": 10.0, "index": -0.5 }]));
    assert_eq!(
        (&found["index_sum"], found["separatrices"].as_array().map(Vec::len)),
        (&json!(-0.5), Some(3))
    );
    let data = poly_data(&place, "t.vtp");
    assert_eq!((data.verts.len(), data.lines.len(), data.points[0]), (1, 3, [10.0, 10.0, 0.0]));
    let both =
        place.succeeds(&["topology", "trisector:size=21", "--family", "both", "--json", "-o", "t.vtp"]);
    assert_eq!(both.json()["separatrices"].as_array().map(Vec::len), Some(6));
    let words = place.succeeds(&["topology", "wedge:size=21", "-o", "w.svg"]).stdout;
    assert_eq!(
        words,
        "1 degenerate point of index sum 0.5, 1 separatrix; eigenvectors, major by value (tension positive)\n"
    );
}

/// Radial tension of 2 and hoop compression of -5 about a point outside of the field, xy and yx apart by rounding in
/// single precision.
const MIXED: &str = r#"(format: 1, title: "mixed", field: Components(width: 21, height: 15,
    xx: "2*cos(atan2(7*(y+3),10*(x+3)))^2 - 5*sin(atan2(7*(y+3),10*(x+3)))^2",
    xy: "7*sin(atan2(7*(y+3),10*(x+3)))*cos(atan2(7*(y+3),10*(x+3))) + 1e-7*sin(40*x)",
    yx: "7*sin(atan2(7*(y+3),10*(x+3)))*cos(atan2(7*(y+3),10*(x+3))) - 1e-7*cos(50*y)",
    yy: "2*sin(atan2(7*(y+3),10*(x+3)))^2 - 5*cos(atan2(7*(y+3),10*(x+3)))^2"))"#;

/// Rounding turns nothing: tension is major by value, compression by magnitude, and everything says which.
#[test]
fn the_major_axis_is_named_and_does_not_hang_on_rounding() {
    let place = Place::new();
    place.write("m.field.ron", MIXED);
    // Distances of the line's ends from the centre: along a radius they differ, around it they do not.
    let bends = |more: &[&str]| {
        let found = place
            .succeeds(&[&["lines", "m.field.ron", "--seed", "10,7", "--json", "-o", "l.vtp"], more].concat());
        let data = poly_data(&place, "l.vtp");
        let distance = |p: [f64; 3]| {
            let (x, y) = (p[0] + 20.0, p[1] + 14.0);
            (x * x + y * y).sqrt()
        };
        let ends = [data.points[0], data.points[data.points.len() - 1]].map(distance);
        let names = (found.json()["axes"].clone(), found.json()["major"].clone());
        assert_eq!(story(&data)["parameters"]["major"], names.1);
        ((ends[0] - ends[1]).abs() > 5.0, names)
    };
    let is = |axes: &str, major: &str| (json!(axes), json!(major));
    assert_eq!(bends(&[]), (true, is("eigen", "value")));
    assert_eq!(bends(&["--major", "magnitude"]), (false, is("eigen", "magnitude")));
    assert_eq!(bends(&["--axes", "half"]), (false, is("half", "magnitude")));
    assert_eq!(bends(&["--axes", "half", "--major", "value"]), (true, is("half", "value")));
    let words = place.succeeds(&["lines", "m.field.ron", "-o", "l.svg"]).stdout;
    assert!(words.contains("along eigenvectors, major by value (tension positive)"), "{words}");
    for (command, output, length) in [
        ("topology", "t.vtp", "--length=9"),
        ("lic", "t.vti", "--half-length=3"),
        ("ftle", "t.vti", "--length=3"),
    ] {
        let words = place.succeeds(&[command, "m.field.ron", length, "-o", output]).stdout;
        assert!(words.contains("eigenvectors, major by value"), "{command}: {words}");
        let found =
            place.succeeds(&[command, "m.field.ron", "--major", "magnitude", "--json", "-o", output]).json();
        assert_eq!((&found["axes"], &found["major"]), (&json!("eigen"), &json!("magnitude")), "{command}");
        place.refuses(
            &[command, "m.field.ron", "--axes", "dual", "--major", "value", "-o", output],
            &["--major", "one order"],
        );
    }
    let shares = place.succeeds(&["info", "m.field.ron", "--json"]).json()["shares"].clone();
    assert_eq!((&shares["asymmetric"], &shares["complex"]), (&json!(0.0), &json!(0.0)), "{shares}");
    let odd = place.succeeds(&["field", "lint", "m.field.ron"]).stdout;
    assert!(!odd.contains("not symmetric"), "{odd}");
}

/// A wave whose crests lie at 45 degrees, sampled twice as coarsely along x: ridges, glyphs and textures see its true
/// shape.
#[test]
fn oblong_cells_keep_their_shape() {
    let place = Place::new();
    let spaced = |name: &str, spacing: [f64; 3]| {
        let image = place.image("t.vti");
        let image = tigereye_io::ImageData { spacing, ..image };
        place.write(name, tigereye_io::vti::write(&image).expect("a file"));
    };
    place.write(
        "t.field.ron",
        r#"(format: 1, title: "t", field: Axes(width: 13, height: 25, phi: "pi / 4", s1: "2", s2: "1"))"#,
    );
    place.succeeds(&["convert", "t.field.ron", "t.vti"]);
    spaced("wide.vti", [2.0, 1.0, 1.0]);
    place.succeeds(&["glyphs", "wide.vti", "-o", "g.vtp", "g.png", "g.svg"]);
    // An ellipse is as long as it is wide around its centre, in the file's unit: at 45 degrees both extents are the
    // same.
    let data = poly_data(&place, "g.vtp");
    let first = data.polys.iter().next().expect("an ellipse").to_vec();
    let extent = |axis: usize| {
        let all = first.iter().map(|&i| data.points[i][axis]);
        all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
    };
    assert!((extent(0) / extent(1) - 1.0).abs() < 1e-3, "{} {}", extent(0), extent(1));
    let size = |name: &str| {
        let text = String::from_utf8(place.read(name)).expect("text");
        let number = |key: &str| {
            let (_, rest) = text.split_once(key).expect("a size");
            rest.split('"').next().and_then(|v| v.parse::<f64>().ok()).expect("a number")
        };
        number("width=\"") / number("height=\"")
    };
    place.succeeds(&["lic", "wide.vti", "-o", "l.svg", "l.vti"]);
    place.succeeds(&["lic", "t.vti", "-o", "s.svg"]);
    assert!(size("l.svg") > 1.4 * size("s.svg"), "{} {}", size("l.svg"), size("s.svg"));
    // Samples as far apart along both sides.
    let texture = place.image("l.vti");
    assert_eq!((texture.dimensions, texture.spacing), ([97, 97, 1], [0.25, 0.25, 1.0]));
    let found = place.succeeds(&["ftle", "wide.vti", "--length", "3", "-o", "f.vti", "f.png"]).stdout;
    assert!(found.contains("per smaller cell side"), "{found}");
    place.succeeds(&["ridges", "f.vti", "--array", "FTLE", "-o", "r.vtp", "r.svg"]);
    place.succeeds(&["topology", "wide.vti", "-o", "t.png"]);
    // Light takes cells as squares, and says so.
    let run = place.tigereye(&["field", "show", "wide.vti", "-o", "sheet.png"]);
    assert!(
        run.code == 0 && run.stderr.contains("cells are 2 x 1, and light treats them as squares"),
        "{}",
        run.stderr
    );
}

/// What has no axes gives empty results, and no field makes them run on.
#[test]
fn fields_without_axes_give_nothing() {
    let place = Place::new();
    place.write("zero.txt", "0 0\n0 0\n");
    let odd = ["isotropic:size=9", "x:width=1,height=9", "x:width=9,height=1", "x:size=1", "x:size=2"];
    for input in odd {
        for command in ["lines", "topology"] {
            let found = place.succeeds(&[command, input, "--json", "-o", "o.vtp", "o.png"]).json();
            assert!(found["points"] != json!(null), "{command} {input}: {found}");
        }
    }
    let none = place.succeeds(&["lines", "isotropic:size=9", "--json", "-o", "o.vtp"]).json();
    assert_eq!((&none["lines"], &none["points"]), (&json!(0), &json!(0)));
    // And it is said why.
    for (command, input, why) in [
        ("lines", "zero.txt", "no tensor has"),
        ("lines", "x:width=1,height=9", "no line is long enough"),
        ("ftle", "isotropic:size=9", "no tensor has an axis"),
        ("ftle", "x:width=9,height=1", "one row or column"),
        ("ftle", "x:size=9", "smaller --length"),
    ] {
        let output = if command == "lines" { "o.vtp" } else { "o.vti" };
        let told = place.succeeds(&[command, input, "-o", output]).stdout;
        assert!(told.contains(why), "{command} {input}: {told}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let place = Place::new();
    for command in ["lines", "topology"] {
        place.refuses(&[command, "x:size=5", "-o", "o.vti"], &["o.vti", "expected .vtp, .png, .svg"]);
        place.refuses(&[command, "x:size=5", "-o", "none/o.vtp"], &["there is no folder none"]);
        place.refuses(&[command, "nothing.vti", "-o", "o.vtp"], &["nothing.vti"]);
        for step in ["0", "-1", "nan", "1e-9", "inf"] {
            let option = format!("--step={step}");
            place.refuses(
                &[command, "x:size=5", &option, "-o", "o.vtp"],
                &["--step", "expected a number of cells"],
            );
        }
    }
    place.refuses(&["lines", "x:size=5", "--seed", "1", "-o", "o.vtp"], &["--seed", "X,Y"]);
    place.refuses(
        &["lines", "x:size=5", "--seed", "1,1", "--separation", "2", "-o", "o.vtp"],
        &["--separation"],
    );
    place.refuses(&["lines", "x:size=5", "--seed", "9,1", "-o", "o.vtp"], &["--seed 9,1", "X from 0 to 4"]);
    place.refuses(&["lines", "x:size=5", "--tolerance", "1e-3", "-o", "o.vtp"], &["--tolerance", "rk45"]);
    place.refuses(&["glyphs", "x:size=5", "--gamma", "2", "-o", "o.png"], &["--gamma", "superquadric"]);
    place.refuses(&["lines", "x:size=5", "--inertia", "2", "-o", "o.vtp"], &["--inertia", "from 0 to 1"]);
    place.write("t.vtp", "x");
    place.refuses(&["lines", "t.vtp", "-o", "t.vtp"], &["t.vtp"]);
    assert_eq!(place.read("t.vtp"), b"x");
}

/// Textures and exponents lie over the field, in samples finer than the cells.
#[test]
fn textures_and_exponents_lie_over_the_field() {
    let place = Place::new();
    for (command, array, samples) in [("lic", "LIC", "3"), ("ftle", "FTLE", "2")] {
        let args = [command, "bow:size=35", "--samples", samples, "--json", "-o", "o.vti", "o.png", "o.svg"];
        let found = place.succeeds(&args).json();
        let n: f64 = samples.parse().expect("a number");
        let side = 34.0 * n + 1.0;
        assert_eq!((&found["width"], &found["height"]), (&json!(side as u64), &json!(side as u64)));
        let image = place.image("o.vti");
        assert_eq!((image.dimensions[0] as f64, image.spacing[0]), (side, 1.0 / n));
        let values = &image.point_array(array).expect("the array").values;
        assert!(values.iter().filter(|v| v.is_finite()).count() > 100, "{command}");
    }
    let hyper = place.succeeds(&["lic", "x:size=9", "--hyper", "--tint", "-o", "h.png"]).stdout;
    assert_eq!(hyper, "33 x 33 samples; eigenvectors, major by value (tension positive)\n");
    let [one, two] = ["1", "2"].map(|n| {
        place.succeeds(&["lic", "inverse:size=31", "-o", "t.vti", "--seed", n]);
        place.read("t.vti")
    });
    assert_ne!(one, two);
}

/// The light gradient and the exponents of the same field have ridges, as lines and as surfaces.
#[test]
fn ridges_are_found_in_gradients_and_exponents() {
    let place = Place::new();
    place.succeeds(&["ltg", "inverse:size=19", "--directions", "16", "-o", "g.vti"]);
    let surface = place.succeeds(&["ridges", "g.vti", "--json", "-o", "s.vtp"]).json();
    assert_eq!((&surface["kind"], &surface["periodic"]), (&json!("triangle"), &json!(true)));
    let data = poly_data(&place, "s.vtp");
    assert!(data.polys.len() > 100 && data.cell_arrays.iter().any(|a| a.name == "piece"));
    // The third coordinate counts layers, and the seam belongs to both ends.
    assert!(data.points.iter().all(|p| (0.0..=16.0).contains(&p[2]) && (1.0..=17.0).contains(&p[0])));
    let line = place.succeeds(&["ridges", "g.vti", "--layer", "4", "--json", "-o", "l.vtp", "l.png"]).json();
    assert_eq!(line["kind"], "line");
    let lines = poly_data(&place, "l.vtp");
    // Pulses sent upwards part in the middle column, below the middle.
    let middle =
        lines.points.iter().filter(|p| (p[0] - 9.0).abs() < 0.1 && p[1] > 9.0 && p[2] == 4.0).count();
    assert!(middle > 5, "{middle} of {}", lines.points.len());
    place.succeeds(&["ftle", "inverse:size=19", "--length", "4", "-o", "f.vti"]);
    place.refuses(
        &["ridges", "f.vti", "--array", "LTG", "-o", "r.vtp"],
        &["called LTG", "FTLE, FTLE_smaller"],
    );
    place.refuses(&["ridges", "f.vti", "-o", "r.vtp"], &["several arrays", "--array"]);
    place.succeeds(&["ridges", "f.vti", "--array", "FTLE", "-o", "r.vtp"]);
    // In the unit of the field: its middle is (9, 9).
    let exponents = poly_data(&place, "r.vtp");
    assert!(exponents.points.iter().any(|p| (p[0] - 9.0).abs() < 0.05 && (p[1] - 5.0).abs() < 0.5));
    let contour = place.succeeds(&["ridges", "g.vti", "--contour", "150", "--json", "-o", "c.vtp"]).json();
    assert!(contour["parts"].as_u64() > Some(100), "{contour}");
    for (args, words) in [
        (&["ridges", "g.vti", "-o", "p.png"][..], &["p.png", "--layer"][..]),
        (&["ridges", "g.vti", "--layer", "16", "-o", "p.png"], &["layer 16", "0 to 15"]),
        (&["ridges", "g.npy", "-o", "p.vtp"], &["g.npy", "expected .vti"]),
        (&["ridges", "none.vti", "-o", "p.vtp"], &["none.vti"]),
        (&["ridges", "g.vti", "-o", "g.vti"], &["expected .vtp, .png, .svg"]),
        (&["ridges", "g.vti", "--contour", "nan", "-o", "p.vtp"], &["--contour", "finite"]),
    ] {
        place.refuses(args, words);
    }
}

#[test]
fn glyphs_of_every_kind_are_drawn() {
    let place = Place::new();
    for kind in ["ellipse", "box", "superquadric", "signed", "arrows", "asymmetric"] {
        for input in ["random:size=7", "double_gyre:width=9,height=5", "isotropic:size=3", "x:size=1"] {
            place.succeeds(&["glyphs", input, "--kind", kind, "-o", "g.png", "g.svg"]);
            assert_eq!(place.read("g.png")[1..4], *b"PNG");
        }
    }
    let [field, own] = ["field", "glyph"].map(|scale| {
        place.succeeds(&["glyphs", "flamant:size=9", "--scale", scale, "--every", "2", "-o", "g.svg"]);
        place.read("g.svg")
    });
    assert_ne!(field, own);
    place.refuses(&["glyphs", "x:size=3", "-o", "g.vti"], &["expected .vtp, .png, .svg"]);
    place.refuses(&["glyphs", "x:size=3", "--kind", "blob", "-o", "g.png"], &["blob", "superquadric"]);
}

/// Outlines lie around their cells, rows upwards, and say which.
#[test]
fn glyphs_are_data_too() {
    let place = Place::new();
    place.succeeds(&["glyphs", "cantilever:width=9,height=5", "--kind", "signed", "-o", "g.vtp"]);
    let data = poly_data(&place, "g.vtp");
    let array = |name: &str| &data.cell_arrays.iter().find(|a| a.name == name).expect("the array").values;
    assert!(data.polys.len() > 40 && data.lines.is_empty());
    assert_eq!(story(&data)["parameters"]["kind"], "signed");
    for (i, corners) in data.polys.iter().enumerate() {
        let middle = [array("column")[i], 4.0 - array("row")[i]];
        for &p in corners {
            let at = data.points[p];
            assert!((0..2).all(|d| (at[d] - middle[d]).abs() < 0.5), "{at:?} {middle:?}");
        }
        // Tension is filled, compression left white.
        assert_eq!((array("part")[i], array("sign")[i].abs()), (0.5 - 0.5 * array("sign")[i], 1.0));
    }
    place.succeeds(&["glyphs", "random:size=20", "--every", "4", "-o", "g.vtp", "g.png"]);
    let data = poly_data(&place, "g.vtp");
    assert_eq!((data.polys.len(), data.lines.len()), (16, 16), "an ellipse and its major axis each");
    place.refuses(&["glyphs", "x:size=600", "-o", "h.vtp"], &["360000 glyphs", "--every"]);
}

#[test]
fn impossible_samplings_are_refused() {
    let place = Place::new();
    for command in ["lic", "ftle"] {
        for n in ["0", "65", "-1", "x"] {
            let option = format!("--samples={n}");
            place.refuses(&[command, "x:size=5", &option, "-o", "o.png"], &["--samples", "1 to 64"]);
        }
        place.refuses(
            &[command, "isotropic:size=2000", "--samples", "64", "-o", "o.png"],
            &["samples: expected at most"],
        );
    }
    let endless =
        ["ftle", "x:size=500", "--samples", "16", "--length", "1000", "--step", "0.01", "-o", "o.png"];
    place.refuses(&endless, &["steps to each side", "together"]);
    place.refuses(&["ftle", "x:size=5", "--length", "1e9", "-o", "o.png"], &["--length", "1000"]);
    place.refuses(&["lic", "x:size=5", "--half-length=0", "-o", "o.png"], &["--half-length", "0.1"]);
    let none = place.succeeds(&["ftle", "isotropic:size=5", "--json", "-o", "o.png", "o.vti"]).json();
    assert_eq!((&none["lines"], &none["max"]), (&json!(0), &json!(null)));
}
