//! How pictures look: sizes, axes, colours, ranges, style files, what is drawn on top, lists of lights.

use crate::support::Place;
use tigereye_io::{ImageData, vti};

/// A folder with a plate with a hole in its middle: 15 x 15 cells, half a unit wide, the lower left one at (10, -3).
fn plate() -> Place {
    let place = Place::new();
    place.succeeds(&["convert", "kirsch:size=15", "cells.vti"]);
    let image = ImageData { origin: [10.0, -3.0, 0.0], spacing: [0.5, 0.5, 1.0], ..place.image("cells.vti") };
    place.write("plate.vti", vti::write(&image).expect("a file"));
    place
}

fn text(place: &Place, name: &str) -> String {
    String::from_utf8(place.read(name)).expect("text")
}

/// The texts of an SVG.
fn texts(svg: &str) -> Vec<&str> {
    svg.split("<text").skip(1).filter_map(|part| part.split('>').nth(1)?.strip_suffix("</text")).collect()
}

const LIGHT: [&str; 8] =
    ["propagate", "plate.vti", "--normalization", "local", "--light", "2,7", "--picture", "energy"];

fn with<'a>(args: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [args, more].concat()
}

#[test]
fn sizes_are_those_asked_for() {
    let place = plate();
    place.succeeds(&with(&LIGHT, &["--width", "85mm", "--dpi", "300", "-o", "a.png", "a.svg", "a.pdf"]));
    let png = place.read("a.png");
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    // 85 mm at 300 pixels an inch, rounded up.
    assert_eq!(number(16), 1004);
    let at = png.windows(4).position(|w| w == b"pHYs").expect("a resolution");
    // Pixels per metre, and the unit that says so.
    assert_eq!((number(at + 4), number(at + 8), png[at + 12]), (11811, 11811, 1));
    assert!(text(&place, "a.svg").contains(r#"width="85.000mm""#));
    let pdf = String::from_utf8_lossy(&place.read("a.pdf")).into_owned();
    // 85 mm in points.
    assert!(pdf.starts_with("%PDF-") && pdf.contains("/MediaBox [0 0 240.94"), "{}", &pdf[..200]);
    place.succeeds(&with(&LIGHT, &["--width", "600px", "-o", "b.png"]));
    assert_eq!(u32::from_be_bytes(place.read("b.png")[16..20].try_into().unwrap()), 600);
}

#[test]
fn pictures_have_the_same_bytes_again() {
    let place = plate();
    for name in ["a.pdf", "a.svg", "a.png"] {
        let first = with(&LIGHT, &["--overlay", "lines", "-o", name]);
        place.succeeds(&first);
        let bytes = place.read(name);
        place.succeeds(&first);
        assert_eq!(place.read(name), bytes, "{name}");
    }
}

#[test]
fn axes_have_the_coordinates_of_the_file() {
    let place = plate();
    place.succeeds(&with(&LIGHT, &["--unit", "mm", "-o", "a.svg"]));
    let svg = text(&place, "a.svg");
    for word in ["x (mm)", "y (mm)", "16", "−2", "no tensor"] {
        assert!(texts(&svg).contains(&word), "{word}: {:?}", texts(&svg));
    }
    place.succeeds(&with(&LIGHT, &["--coordinates", "cells", "--x-label", "along", "-o", "a.svg"]));
    let svg = text(&place, "a.svg");
    assert!(texts(&svg).contains(&"along") && texts(&svg).contains(&"row y (cells)"), "{:?}", texts(&svg));
    // The same for exponents and their ridges.
    place.succeeds(&["ftle", "plate.vti", "--length", "3", "-o", "f.vti", "f.svg"]);
    place.succeeds(&["ridges", "f.vti", "--array", "FTLE", "-o", "r.svg"]);
    let marks = |name: &str| {
        let svg = text(&place, name);
        let number = |t: &&str| t.trim_start_matches('−').parse::<f64>().is_ok();
        texts(&svg).into_iter().filter(number).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(marks("f.svg"), marks("r.svg"));
}

#[test]
fn ranges_and_scales_are_drawn() {
    let place = plate();
    let drawn = |more: &[&str]| {
        place.succeeds(&with(&with(&LIGHT, more), &["-o", "a.svg"]));
        text(&place, "a.svg")
    };
    let linear = drawn(&["--colour-scale", "linear", "--range", "0:0.5"]);
    assert!(
        texts(&linear).contains(&"0.5") && linear.contains("linear colour scale"),
        "{:?}",
        texts(&linear)
    );
    let usual = drawn(&[]);
    assert!(usual.contains("logarithmic colour scale"));
    for more in [&["--colour-map", "magma"][..], &["--range", "5%:95%"], &["--title", "A plate"]] {
        assert_ne!(drawn(more), usual, "{more:?}");
    }
    let named = drawn(&["--bar-label", "light (W)", "--masked-label", "no material", "--title", ""]);
    for word in ["light (W)", "no material"] {
        assert!(texts(&named).contains(&word), "{word}: {:?}", texts(&named));
    }
    assert!(!texts(&named).contains(&"plate.vti"));
}

#[test]
fn settings_without_use_are_refused() {
    let place = plate();
    let refused = |args: &[&str], words: &[&str]| place.refuses(&with(args, &["-o", "a.png"]), words);
    refused(&["lines", "plate.vti", "--range", "0:1"], &["--range", "no effect", "colour bar"]);
    refused(&["lic", "plate.vti", "--colour-map", "vik"], &["--colour-map", "no effect"]);
    refused(&["glyphs", "plate.vti", "--colour-scale", "linear"], &["--colour-scale", "no effect"]);
    refused(&["field", "show", "plate.vti", "--unit", "mm"], &["--unit", "no effect", "--width"]);
    refused(&with(&LIGHT, &["--range", "2:1"]), &["--range", "A below B"]);
    refused(&with(&LIGHT, &["--width", "85"]), &["--width", "20mm to 2000mm"]);
    refused(&with(&LIGHT, &["--width", "30mm"]), &["--width", "30.0 mm leaves no room"]);
    refused(&with(&LIGHT, &["--colour-map", "jet"]), &["jet", "viridis"]);
    refused(&["lic", "plate.vti", "--overlay", "ridges"], &["--overlay", "no scalar"]);
    refused(&["propagate", "plate.vti", "--light", "2,7", "--overlay", "glyphs"], &["--overlay", "energy"]);
    refused(&with(&LIGHT, &["--overlay", "arrows"]), &["lines, ridges, glyphs, topology", ".vtp"]);
}

#[test]
fn style_files_serve_every_picture() {
    let place = plate();
    place
        .write("paper.ron", "(format: 1, style: (colour_map: Plasma, width_mm: 60, unit: \"mm\", dpi: 100))");
    let style = ["--style", "paper.ron"];
    place.succeeds(&with(&["lines", "plate.vti", "-o", "l.svg"], &style));
    assert!(text(&place, "l.svg").contains(r#"width="60.000mm""#));
    // An option goes before the file.
    place.succeeds(&with(&LIGHT, &["--style", "paper.ron", "--width", "70mm", "-o", "a.svg"]));
    assert!(text(&place, "a.svg").contains(r#"width="70.000mm""#));
    place.write("wrong.ron", "(\n    format: 1,\n    style: (\n        colour: Vik,\n    ),\n)");
    place.refuses(&with(&LIGHT, &["--style", "wrong.ron", "-o", "b.png"]), &["wrong.ron:4:9", "`colour`"]);
    place.refuses(&with(&LIGHT, &["--style", "none.ron", "-o", "b.png"]), &["none.ron"]);
}

#[test]
fn lines_ridges_and_files_are_drawn_on_top() {
    let place = plate();
    place.succeeds(&["lines", "plate.vti", "-o", "l.vtp"]);
    let all = ["--overlay", "lines", "--overlay", "ridges", "--overlay", "glyphs", "--overlay", "topology"];
    place.succeeds(&with(&with(&LIGHT, &all), &["--overlay", "l.vtp", "-o", "a.svg"]));
    let svg = text(&place, "a.svg");
    for word in ["height ridges", "l.vtp"] {
        assert!(texts(&svg).contains(&word), "{word}: {:?}", texts(&svg));
    }
    let ltg = ["ltg", "plate.vti", "--normalization", "local", "--directions", "16"];
    place.succeeds(&with(&ltg, &["--slices-deg", "90", "--overlay", "ridges", "-o", "g.svg", "g.vti"]));
    assert_eq!(place.image("g.vti").numbers("slices"), Some(&[4.0][..]));
    place.refuses(&with(&ltg, &["--slices-deg", "91", "-o", "h.vti"]), &["--slices-deg", "22.5"]);
    place.succeeds(&with(&["lic", "plate.vti", "--overlay", "lines"], &["-o", "c.pdf"]));
    place.succeeds(&["ridges", "g.vti", "--mean", "-o", "m.svg"]);
    // Arrays without coordinates have no place for files that have some.
    place.succeeds(&["convert", "plate.vti", "plate.npy"]);
    let args = ["ftle", "plate.npy", "--length", "3", "--overlay", "l.vtp", "-o", "d.png"];
    place.refuses(&args, &["l.vtp", "coordinates"]);
}

#[test]
fn each_light_of_a_list_has_its_own_results() {
    let place = plate();
    place.write("lights.txt", "# two lights\n2,7\n\n  12,7,clip(cos(theta))^2  # to the right\n");
    let list = ["propagate", "plate.vti", "--normalization", "local", "--lights", "lights.txt"];
    let run = place.says(&with(&list, &["-o", "out.npy", "out.png", "--json"]), "plate.vti: light reached");
    let summaries = run.json();
    assert_eq!(summaries.as_array().map(Vec::len), Some(2));
    assert_eq!(summaries[1]["outputs"][0], "out-2.npy");
    place.succeeds(&with(&LIGHT[..6], &["-o", "one.npy"]));
    assert_eq!(place.read("out-1.npy"), place.read("one.npy"));
    assert_ne!(place.read("out-1.npy"), place.read("out-2.npy"));
    place.write("lights.txt", "2,7\n2,x\n");
    place.refuses(&with(&list, &["-o", "bad.npy"]), &["lights.txt:2", "`x`"]);
    place.write("lights.txt", "2,7\n99,7\n");
    place.refuses(&with(&list, &["-o", "bad.npy"]), &["lights.txt:2"]);
    place.write("lights.txt", "# none\n");
    place.refuses(&with(&list, &["-o", "bad.npy"]), &["lights.txt", "no light"]);
}
