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
    place.succeeds(&["lines", "far.vti", "--seed", "2,1", "--ribbon", "-o", "l.vtp"]);
    let data = poly_data(&place, "l.vtp");
    assert!(data.points.iter().all(|[x, y, _]| ((x - 101.0) / 0.5 - (y + 44.0) / 2.0).abs() < 1e-9));
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
    assert_eq!(words, "1 degenerate point of index sum 0.5, 1 separatrix\n");
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
    place.refuses(&["lines", "x:size=5", "--inertia", "2", "-o", "o.vtp"], &["--inertia", "from 0 to 1"]);
    place.write("t.vtp", "x");
    place.refuses(&["lines", "t.vtp", "-o", "t.vtp"], &["t.vtp"]);
    assert_eq!(place.read("t.vtp"), b"x");
}
