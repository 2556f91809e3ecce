//! Every command's output has the shape that the contract gives it.

use crate::support::{Place, has_keys, npy_header, unit_text};
use serde_json::Value;
use tigereye_io::ScalarType;

const LTG_SUMMARY: [&str; 14] = [
    "width",
    "height",
    "directions",
    "sources",
    "iterations_total",
    "iterations_max",
    "cell_updates",
    "seconds",
    "peak_memory_bytes",
    "threads",
    "precision",
    "backend",
    "max",
    "mean",
];

fn story(place: &Place, file: &str) -> Value {
    serde_json::from_str(place.image(file).text("tigereye").unwrap()).unwrap()
}

#[test]
fn gradient_volume_is_indexed_direction_row_column() {
    let place = Place::new();
    place.succeeds(&["ltg", "inverse:width=7,height=5", "--directions", "16", "-o", "a.npy"]);
    let header = npy_header(&place.read("a.npy"));
    assert!(header.contains("(16, 5, 7)") && header.contains("'<f8'"), "{header}");
    assert!(header.contains("'fortran_order': False"), "{header}");
}

#[test]
fn light_is_indexed_row_column_direction() {
    let place = Place::new();
    let args =
        ["propagate", "inverse:width=7,height=5", "--light", "3,2", "--directions", "16", "-o", "a.npy"];
    place.succeeds(&args);
    let header = npy_header(&place.read("a.npy"));
    assert!(header.contains("(5, 7, 16)") && header.contains("'<f8'"), "{header}");
}

#[test]
fn gradient_volume_as_image_has_one_array_and_a_dark_border() {
    let place = Place::new();
    place.succeeds(&["ltg", "inverse:width=7,height=5", "--directions", "16", "-o", "a.vti"]);
    let text = String::from_utf8_lossy(&place.read("a.vti")).into_owned();
    assert!(text.contains("WholeExtent=\"0 6 0 4 0 15\""), "{}", &text[..400]);
    let image = place.image("a.vti");
    assert_eq!(image.dimensions, [7, 5, 16]);
    assert_eq!(image.point_arrays.len(), 1);
    let array = image.point_array("LTG").unwrap();
    assert_eq!((array.components, array.scalar), (1, ScalarType::Float64));
    let mut inside = 0.0;
    for (i, &v) in array.values.iter().enumerate() {
        let (x, y) = (i % 7, i / 7 % 5);
        if x == 0 || x == 6 || y == 0 || y == 4 {
            assert_eq!(v, 0.0, "border cell ({x}, {y})");
        } else {
            inside += v;
        }
    }
    assert!(inside > 0.0);
}

#[test]
fn npy_and_image_of_a_volume_hold_the_same_numbers() {
    let place = Place::new();
    for file in ["a.npy", "a.vti"] {
        place.succeeds(&["ltg", "gyre:size=7", "--directions", "8", "-o", file]);
    }
    let run = place.succeeds(&["compare", "a.npy", "a.vti", "--tolerance", "0"]);
    assert!(run.stdout.contains("largest difference 0"), "{}", run.stdout);
}

#[test]
fn selected_slices_ascend_and_equal_those_of_the_whole_volume() {
    let place = Place::new();
    place.succeeds(&["ltg", "bow:size=6", "--directions", "16", "-o", "all.vti"]);
    place.succeeds(&["ltg", "bow:size=6", "--directions", "16", "--slices", "9,0,5", "-o", "some.vti"]);
    let (all, some) = (place.image("all.vti"), place.image("some.vti"));
    assert_eq!(some.numbers("slices"), Some(&[0.0, 5.0, 9.0][..]));
    assert_eq!(some.dimensions, [6, 6, 3]);
    assert_eq!(all.numbers("slices"), None);
    let (all, some) = (&all.point_array("LTG").unwrap().values, &some.point_array("LTG").unwrap().values);
    for (i, t) in [0, 5, 9].into_iter().enumerate() {
        assert_eq!(some[i * 36..(i + 1) * 36], all[t * 36..(t + 1) * 36], "slice {t}");
    }
}

#[test]
fn a_volume_tells_how_it_was_made() {
    let place = Place::new();
    place.write("f.txt", unit_text(4, 4));
    let args =
        ["ltg", "f.txt", "--directions", "16", "--threshold", "0.25", "--slices", "3,1", "-o", "a.vti"];
    place.succeeds(&args);
    let story = story(&place, "a.vti");
    assert_eq!(story["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(story["command"], format!("tigereye {}", args.join(" ")));
    let hash = story["input_blake3"].as_str().unwrap();
    assert!(hash.len() == 64 && hash.bytes().all(|b| b.is_ascii_hexdigit()), "{hash}");
    let p = &story["parameters"];
    assert_eq!(p["directions"], 16);
    assert_eq!(p["threshold"], 0.25);
    assert_eq!(p["max_iterations"], 1000);
    assert_eq!(p["omega_step"], 2);
    assert_eq!(p["normalization"], "local");
    assert_eq!(p["precision"], "f64");
    assert_eq!(p["slices"].as_array().map(Vec::len), Some(2));
    assert!(p["memory"].is_u64(), "{p:#}");
}

#[test]
fn every_parameter_of_a_volume_is_resolved() {
    let place = Place::new();
    place.succeeds(&["ltg", "x:size=4", "--directions", "8", "-o", "a.vti"]);
    let p = &story(&place, "a.vti")["parameters"];
    // Which slices and how many threads: also where the defaults were taken.
    let open: Vec<_> = p.as_object().unwrap().iter().filter(|(_, v)| v.is_null()).map(|(k, _)| k).collect();
    assert!(open.is_empty(), "unresolved {open:?} in {p:#}");
}

#[test]
fn a_light_distribution_tells_how_it_was_made() {
    let place = Place::new();
    place.succeeds(&["propagate", "x:size=5", "--light", "2,2,cos(theta)", "--steps", "3", "-o", "a.vti"]);
    let story = story(&place, "a.vti");
    has_keys(&story, &["version", "command", "parameters", "input_blake3"]);
    assert!(story["command"].as_str().unwrap().contains("'2,2,cos(theta)'"), "{story:#}");
    assert_eq!(story["parameters"]["steps"], 3);
    assert_eq!(story["parameters"]["light"][0], "2,2,cos(theta)");
    let image = place.image("a.vti");
    assert_eq!(image.dimensions, [5, 5, 1]);
    assert_eq!(image.point_array("intensity").unwrap().components, 32);
}

#[test]
fn every_input_is_normalised_locally_unless_asked() {
    let place = Place::new();
    place.write("f.txt", unit_text(4, 4));
    place.write("f.npy", {
        let data: Vec<u8> =
            [1.0_f64, 0.0, 0.0, 1.0].repeat(16).iter().flat_map(|x| x.to_le_bytes()).collect();
        let head = "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 4, 2, 2), }";
        [crate::support::npy_file(head, 0), data].concat()
    });
    for (input, rule, said) in
        [("f.txt", "local", ""), ("isotropic:size=4", "local", ""), ("f.npy", "local", "took row 0 on top")]
    {
        place.says(&["ltg", input, "--directions", "8", "-o", "a.vti"], said);
        assert_eq!(story(&place, "a.vti")["parameters"]["normalization"], rule, "{input}");
        let global = ["ltg", input, "--directions", "8", "--normalization", "global", "-o", "b.vti"];
        place.says(&global, said);
        assert_eq!(story(&place, "b.vti")["parameters"]["normalization"], "global", "{input}");
    }
}

#[test]
fn summary_of_a_sweep_has_the_agreed_keys() {
    let place = Place::new();
    let args = ["ltg", "inverse:size=6", "--directions", "16", "--threads", "2", "--json", "-o", "a.vti"];
    let summary = place.succeeds(&args).json();
    has_keys(&summary, &LTG_SUMMARY);
    has_keys(&summary["seconds"], &["total", "propagation", "difference"]);
    assert_eq!(summary["width"], 6);
    assert_eq!(summary["directions"], 16);
    assert_eq!(summary["threads"], 2);
    assert_eq!(summary["precision"], "f64");
    // Every cell and direction shines once; no inner cell has a corner for a neighbour.
    assert_eq!(summary["sources"], (36 - 4) * 16);
    assert!(summary["max"].as_f64().unwrap() >= summary["mean"].as_f64().unwrap());
}

#[test]
fn propagation_has_a_summary_too() {
    let place = Place::new();
    let args = ["propagate", "inverse:size=6", "--light", "3,3", "--json", "-o", "a.npy"];
    let summary = place.succeeds(&args).json();
    has_keys(&summary, &["width", "height", "directions", "sources", "iterations_total", "iterations_max"]);
    has_keys(&summary, &["cell_updates", "seconds", "peak_memory_bytes", "max", "mean"]);
    assert_eq!(summary["sources"], 1);
}

#[test]
fn propagation_writes_every_format_at_once() {
    let place = Place::new();
    place.succeeds(&[
        "propagate",
        "star:size=9",
        "--light",
        "2,2",
        "--light",
        "6,6,cos(theta)",
        "--impulse",
        "--steps",
        "4",
        "-o",
        "a.vti",
        "a.npy",
        "a.png",
        "a.SVG",
    ]);
    assert_eq!(&place.read("a.png")[..8], b"\x89PNG\r\n\x1a\n");
    assert!(String::from_utf8(place.read("a.SVG")).unwrap().contains("<svg"));
    assert_eq!(place.files().len(), 4);
    place.succeeds(&["propagate", "star:size=9", "--light", "2,2", "--picture", "energy", "-o", "b.png"]);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let place = Place::new();
    for n in ["1", "2", "5"] {
        let file = format!("{n}.vti");
        place.succeeds(&["ltg", "random:size=9", "--directions", "16", "--threads", n, "-o", &file]);
    }
    for n in ["2.vti", "5.vti"] {
        let run = place.succeeds(&["compare", "1.vti", n, "--tolerance", "0"]);
        assert!(run.stdout.contains("largest difference 0"), "{}", run.stdout);
    }
    // Beyond the provenance even the bytes agree.
    let bytes = |file: &str| {
        let mut image = place.image(file);
        image.field_data.retain(|e| e.name != "tigereye");
        tigereye_io::vti::write(&image).unwrap()
    };
    assert_eq!(bytes("1.vti"), bytes("2.vti"));
}

#[test]
fn the_same_command_again_writes_the_same_bytes() {
    let place = Place::new();
    let args = ["ltg", "random:size=7", "--directions", "8", "-o", "a.vti"];
    place.succeeds(&args);
    let first = place.read("a.vti");
    place.succeeds(&args);
    assert_eq!(first, place.read("a.vti"));
}

#[test]
fn comparison_judges_by_the_tolerance() {
    let place = Place::new();
    place.succeeds(&["ltg", "inverse:size=6", "--directions", "8", "-o", "a.vti"]);
    place.succeeds(&["ltg", "inverse:size=6", "--directions", "8", "--threshold", "0.1", "-o", "b.vti"]);
    place.succeeds(&["compare", "a.vti", "a.vti", "--tolerance", "0"]);
    let run = place.tigereye(&["compare", "a.vti", "b.vti", "--tolerance", "0"]);
    assert_eq!((run.code, run.stderr.as_str()), (1, ""));
    assert!(
        run.stdout.contains("largest difference") && run.stdout.contains("relative L2"),
        "{}",
        run.stdout
    );
    place.succeeds(&["compare", "a.vti", "b.vti", "--tolerance", "1e9"]);
    let fields = place.tigereye(&["compare", "inverse:size=5", "gyre:size=5"]);
    assert_eq!(fields.code, 1);
    place.succeeds(&["compare", "inverse:size=5", "inverse:size=5"]);
}

#[test]
fn comparison_names_the_place_by_its_slice() {
    let place = Place::new();
    place.succeeds(&["ltg", "inverse:size=5", "--directions", "8", "--slices", "6", "-o", "a.vti"]);
    let args = ["ltg", "gyre:size=5", "--directions", "8", "--slices", "6", "-o", "b.vti"];
    place.succeeds(&args);
    let run = place.tigereye(&["compare", "a.vti", "b.vti"]);
    assert_eq!(run.code, 1);
    assert!(run.stdout.contains("at [6, "), "{}", run.stdout);
    place.succeeds(&["compare", "a.vti", "b.vti", "--except-slices", "6"]);
}

#[test]
fn generators_are_listed_with_their_parameters() {
    let place = Place::new();
    let list = place.succeeds(&["field", "list", "--json"]).json();
    let list = list.as_array().unwrap();
    assert!(list.len() >= 25, "{}", list.len());
    let names: Vec<_> = list.iter().map(|g| g["name"].as_str().unwrap()).collect();
    for name in ["inverse", "gyre", "bow", "star", "rings", "absorb", "step", "random", "kirsch"] {
        assert!(names.contains(&name), "{name} of {names:?}");
    }
    let text = place.succeeds(&["field", "list"]).stdout;
    for generator in list {
        let name = generator["name"].as_str().unwrap();
        assert!(text.lines().any(|l| l == name), "{name} in the text");
        for parameter in generator["parameters"].as_array().unwrap() {
            has_keys(parameter, &["name", "default", "type", "help"]);
        }
    }
}

#[test]
fn every_generator_runs_with_its_defaults() {
    let place = Place::new();
    let list = place.succeeds(&["field", "list", "--json"]).json();
    for generator in list.as_array().unwrap() {
        let name = generator["name"].as_str().unwrap();
        place.succeeds(&["info", name, "--json"]);
        place.succeeds(&["ltg", &format!("{name}:size=5"), "--directions", "8", "-o", "a.npy"]);
    }
}

#[test]
fn info_tells_what_was_read_and_assumed() {
    let place = Place::new();
    place.write("f.txt", "1 0 0 0\n0 1 0 0\n1 2 -1 0\n0 1 0 1\n");
    let info = place.succeeds(&["info", "f.txt", "--json"]).json();
    assert_eq!((info["width"].as_u64(), info["height"].as_u64()), (Some(2), Some(2)));
    has_keys(&info, &["spacing", "component_order", "frame", "assumptions", "components", "shares"]);
    for (share, expected) in [("zero", 0.25), ("degenerate", 0.5), ("asymmetric", 0.25), ("indefinite", 0.25)]
    {
        assert_eq!(info["shares"][share], expected, "{share}: {info:#}");
    }
    assert_eq!(info["components"]["xy"]["max"], 2.0);
    let text = place.succeeds(&["info", "f.txt"]).stdout;
    assert!(text.contains("2 x 2 cells") && text.contains("first row on top"), "{text}");
}

#[test]
fn help_and_version_are_data() {
    let place = Place::new();
    for args in [&["--help"][..], &["ltg", "--help"], &["--version"]] {
        assert!(!place.succeeds(args).stdout.is_empty());
    }
}

/// A collection names one image for the start and one for every step; the last is the light of the other outputs.
#[test]
fn steps_become_frames_of_a_collection() {
    let place = Place::new();
    let run = ["propagate", "inverse:size=7", "--light", "3,3", "--impulse", "--steps", "4"];
    place.succeeds(&[&run[..], &["-o", "pulse.pvd", "end.vti"]].concat());
    let collection = String::from_utf8(place.read("pulse.pvd")).unwrap();
    let energy = |file: &str| {
        let image = tigereye_io::vti::read(&place.read(file)).unwrap();
        image.point_array("energy").unwrap().values.clone()
    };
    for step in 0..=4 {
        let file = format!("pulse/{step:04}.vti");
        assert!(
            collection.contains(&format!("timestep=\"{step}.0\" part=\"0\" file=\"{file}\"")),
            "{collection}"
        );
        assert!(energy(&file).iter().sum::<f64>() > 0.0);
    }
    assert_eq!(energy("pulse/0004.vti"), energy("end.vti"));
    assert_eq!(energy("pulse/0000.vti").iter().filter(|e| **e > 0.0).count(), 1);
    assert!(place.image("pulse/0002.vti").text("tigereye").is_some_and(|t| t.contains("--impulse")));
    // A shorter run leaves none of the longer one's frames; other files stay.
    place.write("pulse/notes.txt", "mine");
    place.succeeds(&["propagate", "inverse:size=7", "--light", "3,3", "--steps", "2", "-o", "pulse.pvd"]);
    let frames = place.files().into_keys().filter(|name| name.starts_with(place.path("pulse"))).count();
    assert_eq!((frames, place.read("pulse/notes.txt")), (4, b"mine".to_vec()));
    assert_eq!(String::from_utf8(place.read("pulse.pvd")).unwrap().matches("timestep").count(), 3);
    place.refuses(&["ltg", "inverse:size=5", "-o", "g.pvd"], &["g.pvd", ".vti, .npy, .png, .svg or .pdf"]);
}

#[test]
fn collections_that_cannot_be_written_are_refused_first() {
    let place = Place::new();
    let refuses = |input: &str, rest: &[&str], words: &[&str]| {
        place.refuses(&[&["propagate", input, "--light", "1,1"], rest].concat(), words);
    };
    place.write("taken", "a file");
    refuses("inverse:size=5", &["-o", "a.vti", "taken.pvd"], &["taken.pvd", "which is a file"]);
    refuses("inverse:size=5", &["-o", "z.pvd", "--steps", "20000"], &["z.pvd", "10000", "--steps"]);
    place.succeeds(&["convert", "inverse:size=5", "t.vti"]);
    place.write("fr/0000.vti", place.read("t.vti"));
    refuses("fr/0000.vti", &["-o", "fr.pvd"], &["fr/0000.vti", "folder fr of the frames"]);
    refuses("inverse:size=5", &["-o", "fr.pvd", "fr/0001.vti"], &["fr/0001.vti", "folder of its frames"]);
    place.write("g.view.py/inside", "a folder is in the way");
    place.refuses(&["ltg", "inverse:size=5", "-o", "g.vti", "--view"], &["g.view.py", "is a folder"]);
}

#[test]
fn a_script_for_paraview_lies_beside_the_volume() {
    let place = Place::new();
    place.succeeds(&["ltg", "inverse:size=5", "--directions", "8", "-o", "a \"b\".vti", "--view"]);
    place.refuses(&["ltg", "inverse:size=5", "-o", "a.npy", "--view"], &["--view", ".vti"]);
    let script = String::from_utf8(place.read("a \"b\".view.py")).unwrap();
    assert!(script.contains(r#"os.path.join(here, "a \"b\".vti")"#) && !script.contains('@'), "{script}");
}
