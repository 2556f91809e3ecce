//! Scenes: light and gradients of files with walls, and what is said of bad ones.

use crate::support::Place;
use serde_json::Value;
use tigereye_io::{FieldValues, ImageData};

const ROOM: &str = r#"(
    format: 1,
    title: "A room",
    width: 15,
    height: 11,
    parts: [
        (shape: Outline(of: Rectangle(from: (0, 0), to: (14, 10))), material: Diffuse(reflectance: 0.5)),
        (shape: Segment(from: (7, 0), to: (7, 7)), material: Absorber),
        (shape: Disc(centre: (11, 5), radius: 1), material: Mirror()),
    ],
    lights: [(cell: (3, 5))],
)"#;

fn story(image: &ImageData) -> Value {
    let entry = image.field_data.iter().find(|e| e.name == "tigereye").expect("a story");
    let FieldValues::Text(texts) = &entry.values else { panic!("text") };
    serde_json::from_str(&texts[0]).expect("JSON")
}

#[test]
fn light_and_gradients_of_a_scene_are_written_in_every_format() {
    let place = Place::new();
    place.write("room.scene.ron", ROOM);
    let run = place.succeeds(&[
        "propagate",
        "room.scene.ron",
        "--steps",
        "30",
        "--json",
        "-o",
        "l.vti",
        "l.npy",
        "l.png",
        "l.svg",
        "l.apng",
    ]);
    let summary = run.json();
    assert_eq!((&summary["width"], &summary["sources"]), (&15.into(), &1.into()));
    let image = place.image("l.vti");
    let told = story(&image);
    assert_eq!(told["parameters"]["normalization"], "scene");
    assert_eq!(told["input_blake3"].as_str().map(str::len), Some(64));
    let svg = String::from_utf8(place.read("l.svg")).expect("text");
    assert!(svg.contains("<title>A room</title>"));
    // An animation is a PNG with a chunk that says so, and a frame for every step and the beginning.
    let apng = place.read("l.apng");
    let control = apng.windows(4).position(|w| w == b"acTL").expect("an animation");
    assert_eq!(u32::from_be_bytes(apng[control + 4..control + 8].try_into().expect("four bytes")), 31);
    place.succeeds(&["ltg", "room.scene.ron", "--directions", "16", "-o", "g.vti", "g.png"]);
    let threads =
        place.succeeds(&["ltg", "room.scene.ron", "--directions", "16", "--threads", "1", "-o", "h.vti"]);
    assert_eq!(threads.code, 0);
    place.succeeds(&["compare", "g.vti", "h.vti", "--tolerance", "0"]);
}

#[test]
fn lights_given_take_the_place_of_the_scenes_own() {
    let place = Place::new();
    place.write("scene.ron", ROOM);
    let energy = |more: &[&str]| {
        let args = [&["propagate", "scene.ron", "--steps", "9", "--json", "-o", "l.npy"], more].concat();
        place.succeeds(&args).json()["energy"].as_f64().expect("a number")
    };
    assert_eq!(energy(&[]), energy(&["--light", "3,5"]));
    assert_ne!(energy(&[]), energy(&["--light", "3,5,2"]));
    assert!(energy(&["--impulse"]) < energy(&[]));
}

#[test]
fn merged_shards_are_drawn_as_the_whole_scene() {
    let place = Place::new();
    place.write("room.scene.ron", ROOM);
    let args = ["ltg", "room.scene.ron", "--directions", "16"];
    place.succeeds(&[&args[..], &["-o", "whole.svg", "whole.npy"]].concat());
    for k in 0..2 {
        let (shard, name) = (format!("{k}/2"), format!("{k}.part"));
        place.succeeds(&[&args[..], &["--shard", &shard, "-o", &name]].concat());
    }
    let merge = |outputs: &[&str]| {
        let run = place.tigereye(&[&["merge", "0.part", "1.part", "-o"], outputs].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stderr
    };
    assert_eq!(merge(&["merged.svg", "merged.npy"]), "");
    assert_eq!(place.read("merged.svg"), place.read("whole.svg"));
    assert_eq!(place.read("merged.npy"), place.read("whole.npy"));
    // The picture goes without walls where they are not known, and says so; the volume needs none.
    let bare = |why: &str| {
        let said = merge(&["bare.svg", "bare.npy"]);
        assert!(said.contains("room.scene.ron") && said.contains(why) && said.lines().count() == 1, "{said}");
        assert_ne!(place.read("bare.svg"), place.read("whole.svg"));
        assert_eq!(place.read("bare.npy"), place.read("whole.npy"));
    };
    place.write("room.scene.ron", ROOM.replacen("0.5", "0.6", 1));
    bare("has changed");
    place.write("room.scene.ron", "");
    bare("cannot be read");
    assert_eq!(merge(&["quiet.npy"]), "");
}

#[test]
fn bad_scenes_are_refused_with_their_place() {
    let place = Place::new();
    let refuses = |from: &str, to: &str, words: &[&str]| {
        assert!(ROOM.contains(from), "{from}");
        place.write("bad.scene.ron", ROOM.replacen(from, to, 1));
        place.refuses(&["propagate", "bad.scene.ron", "-o", "l.npy"], words);
        place.refuses(&["ltg", "bad.scene.ron", "-o", "g.npy"], words);
    };
    refuses("centre: (11, 5)", "centre: (110, 5)", &["bad.scene.ron:9:10", "covers no cell"]);
    refuses("cell: (3, 5)", "cell: (7, 5)", &["bad.scene.ron:11:15", "inside a wall of part 2"]);
    refuses("material: Absorber", "material: Glass", &["bad.scene.ron:8:", "Glass", "Absorber"]);
    refuses(
        "Disc(centre: (11, 5), radius: 1)",
        "Bitmap(path: \"no.png\")",
        &["bad.scene.ron:9:10", "no.png"],
    );
    place.write("room.scene.ron", ROOM);
    place.refuses(
        &["propagate", "room.scene.ron", "--light", "7,3", "-o", "l.npy"],
        &["--light", "inside a wall"],
    );
    place.refuses(
        &["propagate", "room.scene.ron", "--slice", "z=1", "-o", "l.npy"],
        &["room.scene.ron", "no reading options"],
    );
    place.refuses(
        &["ltg", "room.scene.ron", "--normalization", "global", "-o", "l.npy"],
        &["--normalization", "crystals"],
    );
    place.refuses(
        &["ltg", "room.scene.ron", "--total-anisotropy", "none", "-o", "l.npy"],
        &["--total-anisotropy", "crystals"],
    );
    place.refuses(&["info", "room.scene.ron"], &["a scene has no tensors"]);
    place.refuses(&["lines", "room.scene.ron", "-o", "l.vtp"], &["a scene has no tensors"]);
    place.refuses(&["propagate", "room.scene.ron", "-o", "room.scene.ron"], &["unknown extension"]);
    place.refuses(&["propagate", "rings", "-o", "l.npy"], &["rings", "--light"]);
    place.refuses(&["propagate", "none.scene.ron", "-o", "l.npy"], &["none.scene.ron"]);
}

#[test]
fn gaps_in_walls_are_told() {
    let place = Place::new();
    place.write("gap.scene.ron", ROOM.replace("from: (7, 0), to: (7, 7)", "from: (4, 2), to: (9, 7)"));
    let run = place.tigereye(&["propagate", "gap.scene.ron", "--steps", "2", "-o", "l.npy"]);
    assert!(run.code == 0 && run.stderr.contains("touch at a corner only"), "{}", run.stderr);
}

#[test]
fn scenes_are_checked_like_experiments() {
    let place = Place::new();
    place.write("room.scene.ron", ROOM);
    let told = place.succeeds(&["check", "room.scene.ron"]).stdout;
    assert_eq!(told, "room.scene.ron: ok, 3 parts, 1 light\n");
    place.write("bad.scene.ron", ROOM.replace("radius: 1)", "radius: -1)"));
    place.refuses(&["check", "bad.scene.ron"], &["bad.scene.ron:9:", "above 0"]);
    // Pictures are looked up beside the scene, from wherever the program runs.
    std::fs::create_dir(place.path("sub")).expect("a folder");
    place.write("sub/walls.png", place.read("room.scene.ron"));
    place.write(
        "sub/a.scene.ron",
        ROOM.replace("Disc(centre: (11, 5), radius: 1)", "Bitmap(path: \"walls.png\")"),
    );
    place.refuses(&["check", "sub/a.scene.ron"], &["sub/a.scene.ron:9:10", "walls.png"]);
    place.refuses(&["run", "room.scene.ron", "--out", "r"], &["room.scene.ron"]);
}
