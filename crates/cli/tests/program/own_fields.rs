//! A field of one's own: begun, looked at, questioned, and used wherever a generator is.

use crate::support::Place;
use serde_json::json;

const SMALL: &str = r#"(format: 1, title: "small", field: Components(width: 9, height: 7, xx: "1", xy: "0", yx: "0", yy: "0.5 + 0.05*i"))"#;

#[test]
fn a_field_begins_with_one_command() {
    let place = Place::new();
    let words = place.succeeds(&["field", "new", "swirl", "--experiment"]).stdout;
    assert!(
        words.contains("tigereye field show ./swirl.field.ron") && words.contains("run ./swirl.ron"),
        "{words}"
    );
    // What it says next works as it stands.
    place.succeeds(&["field", "show", "swirl.field.ron", "-o", "swirl.png"]);
    assert_eq!(place.read("swirl.png")[1..4], *b"PNG");
    let lint = place.succeeds(&["field", "lint", "swirl.field.ron"]).stdout;
    assert_eq!(lint, "swirl.field.ron: no findings (3 notes with --all)\n");
    let lint = place.succeeds(&["field", "lint", "swirl.field.ron", "--all"]).stdout;
    assert!(lint.contains("isotropic") && !lint.contains("determinant"), "{lint}");
    place.succeeds(&["check", "swirl.ron"]);
    // Progress is no fault.
    assert_eq!(place.tigereye(&["run", "swirl.ron", "--out", "results"]).code, 0);
    assert_eq!(place.json("results/summary.json")["passed"], json!(true));
    place.refuses(&["field", "new", "swirl"], &["swirl.field.ron", "exists already"]);
    for name in ["Swirl", "a b", "", "-x", "../up", "inverse"] {
        place.refuses(
            &["field", "new", "--", name],
            &[if name == "inverse" { "is a generator" } else { "is not a valid name" }],
        );
    }
    place.refuses(&["field", "new", "other", "--folder", "none"], &["none", "there is no folder"]);
}

/// A generator has its file already; what is begun is an experiment that shows it.
#[test]
fn an_experiment_of_a_generator_begins_with_one_command() {
    let place = Place::new();
    // Of determinant 1 and not.
    for name in ["inverse", "kirsch"] {
        let words = place.succeeds(&["field", "new", name, "--experiment"]).stdout;
        assert!(words.contains(&format!("tigereye run ./{name}.ron")), "{words}");
        assert!(!place.path(&format!("{name}.field.ron")).exists());
        assert_eq!(place.tigereye(&["run", &format!("{name}.ron"), "--out", "results"]).code, 0, "{name}");
        assert_eq!(place.json("results/summary.json")["passed"], json!(true), "{name}");
    }
}

/// Commands and experiments take the file where they take a generator, and say the same of it.
#[test]
fn field_files_stand_where_generators_do() {
    let place = Place::new();
    place.write(
        "inverse.field.ron",
        r#"(format: 1, title: "t", field: Generator(name: "inverse", parameters: {"size": 9}))"#,
    );
    place.succeeds(&["compare", "inverse.field.ron", "inverse:size=9", "--tolerance", "0"]);
    let facts = place.succeeds(&["info", "inverse.field.ron", "--json"]).json();
    assert_eq!((&facts["width"], &facts["kind"]), (&json!(9), &json!("field file")));
    let ltg = |input: &str, out: &str| {
        place.succeeds(&["ltg", input, "--directions", "8", "-o", out]);
    };
    ltg("inverse.field.ron", "a.npy");
    ltg("inverse:size=9", "b.npy");
    assert_eq!(place.read("a.npy"), place.read("b.npy"));
    place.succeeds(&["propagate", "inverse.field.ron", "--light", "4,4", "-o", "l.npy"]);
    place.succeeds(&["convert", "inverse.field.ron", "part.npy", "--crop", "0:4,0:3", "--resample", "8x6"]);
    place.refuses(
        &["convert", "inverse.field.ron", "x.npy", "--order", "fsl"],
        &["--order has no effect here"],
    );
    place.refuses(&["ltg", "inverse.field.ron", "-o", "inverse.field.ron"], &["inverse.field.ron"]);
    // One that names a data file is that file, in every respect.
    place.write(
        "in/data.npy",
        tigereye_io::npy::write_array(&[4, 4, 2, 2], &[2.0, 0.0, 0.0, 1.0].repeat(16)).unwrap(),
    );
    place.write(
        "in/data.field.ron",
        r#"(format: 1, title: "HEADING", field: File(path: "data.npy", resample: (8, 8)))"#,
    );
    let facts = |name: &str, said: &str| place.says(&["info", name, "--json"], said).json();
    let (field, data) = (facts("in/data.field.ron", "took row 0 on top"), facts("in/data.npy", ""));
    assert_eq!((&field["kind"], &field["spacing"]), (&data["kind"], &json!([0.5, 0.5])));
    assert!(field["assumptions"].to_string().contains("[row][column]"), "{field:#}");
    place.refuses(
        &["convert", "in/data.field.ron", "in/data.npy", "--force"],
        &["in/data.npy", "is also an input"],
    );
    place.says(&["field", "show", "in/data.field.ron", "-o", "sheet.svg"], "took row 0 on top");
    assert!(String::from_utf8(place.read("sheet.svg")).unwrap().contains("HEADING"));
    place.write("above.field.ron", r#"(format: 1, title: "t", field: File(path: "in/data.npy"))"#);
    place.says(&["compare", "above.field.ron", "in/data.npy", "--tolerance", "0"], "took row 0 on top");
    // Fields may lie beside experiments in a folder, and name data beside themselves.
    place.write("own/data.txt", "1 0 2 0\n0 1 0 1\n");
    place.write("own/two.field.ron", r#"(format: 1, title: "two", field: File(path: "data.txt"))"#);
    let experiment = |path: &str, cells: &str| {
        format!(
            r#"(format: 1, title: "t", source: "s", section: "x", claim: "c", look_for: "l",
               fields: {{"f": File(path: "{path}")}}, figures: [(name: "f", caption: "c", panels: [Glyphs(field: "f", title: "t")])],
               checks: [(name: "largest axis", quantity: LargestAxis(field: "f"), expect: AtMost({cells}), basis: "b")])"#
        )
    };
    place.write("own/two.ron", experiment("two.field.ron", "2"));
    place.write("outer.ron", experiment("own/two.field.ron", "2"));
    place.succeeds(&["check", "outer.ron"]);
    assert_eq!(place.tigereye(&["reproduce", "--experiments", "own", "--out", "r"]).code, 0);
    assert_eq!(place.json("r/summary.json")["experiments"].as_array().map(Vec::len), Some(1));
}

#[test]
fn faults_of_field_files_have_their_place() {
    let place = Place::new();
    for (text, words) in [
        ("(format: 2, title: \"t\", field: Generator(name: \"x\"))", "a.field.ron:1:2: format 2 is unknown"),
        ("(format: 1,\n titel: \"t\")", "a.field.ron:2"),
        ("(format: 1, title: \"t\", field: Generator(name: \"none\"))", "a.field.ron: "),
        (
            "(format: 1, title: \"t\", field: Axes(width: 3, height: 3, phi: \"1 +\", s1: \"1\", s2: \"1\"))",
            "a.field.ron:1:67: expression `phi`",
        ),
        (
            "(format: 1, title: \"t\",\n field: Axes(width: 3, height: 3, phi: \"0\",\n s1: \"1 + tan(z)\", s2: \"1\"))",
            "a.field.ron:3:15: expression `s1`: unknown name `z`",
        ),
        (
            "(format: 1, title: \"t\",\n field: Axes(width: \"51\", height: 3, phi: \"0\", s1: \"1\", s2: \"1\"))",
            "expected a whole number (`width: \"51\"`)",
        ),
        (
            "(format: 1, title: \"t\",\n field: Axes(widht: 51, height: 3, phi: \"0\", s1: \"1\", s2: \"1\"))",
            "there is no key `widht` in `Axes`: did you mean `width`? expected one of",
        ),
        ("(format: 1, title: \"t\", field: File(path: \"absent.npy\"))", "absent.npy"),
    ] {
        place.write("a.field.ron", text);
        place.refuses(&["info", "a.field.ron"], &["a.field.ron", words]);
    }
    place.write("b.field.ron", r#"(format: 1, title: "t", field: File(path: "c.field.ron"))"#);
    place.write("c.field.ron", r#"(format: 1, title: "t", field: File(path: "b.field.ron"))"#);
    place
        .refuses(&["info", "b.field.ron"], &["c.field.ron", "expected a generator, formulas or a data file"]);
    place.write("d.field.ron", [0xff, 0xfe, b'(']);
    place.refuses(&["info", "d.field.ron"], &["byte 0", "UTF-8"]);
    place.refuses(&["info", "absent.field.ron"], &["absent.field.ron", "reading"]);
}

#[test]
fn sheets_and_oddities_are_told_of_anything_readable() {
    let place = Place::new();
    place.write("small.field.ron", SMALL);
    place.succeeds(&[
        "field",
        "show",
        "small.field.ron",
        "-o",
        "s.svg",
        "--light",
        "1,2",
        "--slice-deg",
        "45",
    ]);
    assert!(String::from_utf8(place.read("s.svg")).unwrap().contains("(f)"));
    let first = place.read("s.svg");
    place.succeeds(&[
        "field",
        "show",
        "small.field.ron",
        "-o",
        "s.svg",
        "--light",
        "1,2",
        "--slice-deg",
        "45",
    ]);
    assert_eq!(place.read("s.svg"), first, "the same picture again");
    let lint = place.succeeds(&["field", "lint", "small.field.ron", "--json"]).json();
    assert_eq!(lint["oddities"].as_array().map(Vec::len), Some(1));
    assert_eq!(
        (&lint["oddities"][0]["kind"], &lint["oddities"][0]["first"]),
        (&json!("determinant"), &json!([0, 0]))
    );
    assert!(place.succeeds(&["field", "lint", "sink:size=9", "--all"]).stdout.contains("zero"));
    place.succeeds(&["field", "show", "x:width=1,height=1", "-o", "one.png"]);
    place.refuses(&["field", "show", "small.field.ron", "-o", "s.gif"], &["s.gif", ".png, .svg or .pdf"]);
    place.refuses(
        &["field", "show", "small.field.ron", "-o", "n.png", "--light", "9,0"],
        &["cell (9, 0)", "column to 8"],
    );
    place.refuses(
        &["field", "show", "small.field.ron", "-o", "n.png", "--slice-deg", "50"],
        &["50 degrees", "22.5 from 0 to 337.5"],
    );
    place.refuses(&["field", "show", "small.field.ron", "-o", "n.png", "--light", "a"], &["X,Y"]);
}
