//! Every fault in a scene's file is refused with its line, its column and what was expected.

use tigereye_core::{Cell, Directions, Surface};
use tigereye_experiments::scene::{PreparedScene, is_scene_file, prepare};
use tigereye_experiments::{Host, SpecError, load, plan};
use tigereye_scenes::Material;

const GOOD: &str = r#"// A room.
(
    format: 1,
    title: "parts: [ and (brackets", // lights: [
    width: 21,
    height: 13,
    parts: [
        (shape: Outline(of: Rectangle(from: (0, 0), to: (20, 12))), material: Diffuse(reflectance: 0.5)),
        (shape: Disc(centre: (6, 6), radius: 2), material: Absorber),
        (
            shape: Rectangle(from: (10, 4), to: (13, 8)),
            material: Crystal(field: Axes(width: 21, height: 13, phi: "x", s1: "2", s2: "1")),
        ),
        (shape: Segment(from: (15, 3), to: (18, 9), thickness: 1.5), material: Mirror(angle_deg: 30)),
        (shape: Bitmap(path: "marks.png"), material: Filter(0.25)),
        (shape: Bitmap(path: "marks.png", inverted: true), material: Empty),
        (shape: Outside(Polygon([(0, 0), (20, 0), (20, 11), (0, 11)])), material: Absorber),
    ],
    lights: [
        (cell: (2, 2)),
        (cell: (3, 2), emission: Impulse, profile: Emitter(theta_deg: 0, power: 1)),
    ],
)
"#;

/// Files by their names.
struct Files(Vec<(String, Vec<u8>)>);

impl Host for Files {
    fn read(&self, path: &str) -> Result<Vec<u8>, String> {
        let found = self.0.iter().find(|(name, _)| name == path);
        found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| format!("no file {path}"))
    }
}

/// A picture whose pixels are dark where `dark` says so.
fn picture(width: u32, height: u32, dark: impl Fn(u32, u32) -> bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().unwrap();
    let pixels: Vec<u8> = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| if dark(x, y) { 20 } else { 230 })
        .collect();
    writer.write_image_data(&pixels).unwrap();
    writer.finish().unwrap();
    bytes
}

fn files() -> Files {
    Files(vec![("room/marks.png".to_owned(), picture(21, 13, |x, y| (x, y) != (9, 10)))])
}

fn read(text: &str) -> Result<PreparedScene, Vec<SpecError>> {
    prepare("room/a.scene.ron", text, &files())
}

/// The scene with `from` replaced is refused at the place of `at`, and says `words`.
fn refused(from: &str, to: &str, at: &str, words: &[&str]) {
    assert!(GOOD.contains(from), "{from} is not in the file");
    let text = GOOD.replacen(from, to, 1);
    let problems = read(&text).expect_err(to);
    let problem = &problems[0];
    let place = text.find(at).unwrap_or_else(|| panic!("{at} is not in the file"));
    let line = text[..place].matches('\n').count() + 1;
    let column = place - text[..place].rfind('\n').map_or(0, |n| n + 1) + 1;
    assert_eq!((problem.line, problem.column), (line, column), "{to}: {problem}");
    assert_eq!(problem.file, "room/a.scene.ron");
    for word in words {
        assert!(problem.problem.contains(word), "{to}: {problem} does not say {word}");
    }
}

#[test]
fn every_kind_of_part_is_read() {
    let scene = read(GOOD).unwrap();
    let at = |x, y| *scene.layout.surfaces.at(Cell::new(x, y));
    // The dark pixels are filters, over all that was there, the bright one is empty again.
    assert_eq!(at(1, 1), Some(Surface::Filter { transmittance: 0.25 }));
    assert_eq!(at(9, 10), None);
    assert_eq!((scene.lights.len(), scene.scene.parts.len()), (2, 7));
    assert!(matches!(scene.scene.parts[3].material, Material::Mirror { angle_deg: Some(30.0), .. }));
    assert!(is_scene_file("x/scene.ron") && is_scene_file("a.scene.ron") && !is_scene_file("ascene.ron"));
}

#[test]
fn the_hash_sees_all_that_light_does() {
    let hash = |text: &str, host: &Files| prepare("room/a.scene.ron", text, host).unwrap().blake3;
    let other = Files(vec![("room/marks.png".to_owned(), picture(21, 13, |x, _| x > 3))]);
    let first = hash(GOOD, &files());
    assert_eq!(first, hash(GOOD, &files()));
    assert_ne!(first, hash(GOOD, &other));
    assert_ne!(first, hash(&GOOD.replace("reflectance: 0.5", "reflectance: 0.6"), &files()));
}

#[test]
fn shapes_that_cannot_be_are_refused_at_their_place() {
    refused(
        "Disc(centre: (6, 6), radius: 2)",
        "Disc(centre: (60, 6), radius: 2)",
        "shape: Disc",
        &["covers no cell", "21 x 13"],
    );
    refused(
        "Polygon([(0, 0), (20, 0), (20, 11), (0, 11)])",
        "Polygon(points: [(0, 0), (20, 0), (20, 11)])",
        "points: ",
        &["expected a list, `[...]`"],
    );
    refused("radius: 2)", "radius: 0)", "0), material: Absorber", &["out of range"]);
    refused("to: (18, 9), thickness", "to: (15, 3), thickness", "shape: Segment", &["begins where it ends"]);
    refused("(0, 0), (20, 0), (20, 11), (0, 11)", "(0, 0), (20, 0)", "shape: Outside", &["2 corners"]);
    refused("from: (0, 0), to: (20, 12)", "from: (1e9, 0), to: (20, 12)", "shape: Outline", &["coordinate"]);
    refused(
        "Disc(centre: (6, 6), radius: 2)",
        "Outline(of: Bitmap(path: \"marks.png\"))",
        "shape: Outline(of: Bitmap",
        &["outline of a bitmap"],
    );
    refused(
        "Disc(centre: (6, 6), radius: 2)",
        "Circle(centre: (6, 6), radius: 2)",
        "Circle",
        &["Circle", "Disc"],
    );
}

#[test]
fn materials_that_cannot_be_are_refused_at_their_place() {
    refused(
        "material: Absorber),\n        (\n",
        "material: Glass),\n        (\n",
        "Glass",
        &["there is no `Glass` here: expected one of `Empty`, `Absorber`, `Filter`"],
    );
    refused("reflectance: 0.5", "reflectance: 1.5", "1.5)", &["0 to 1"]);
    refused("Filter(0.25)", "Filter(part: 0.25)", "part: 0.25", &["expected a number"]);
    refused(
        "    ],\n    lights",
        "    lights",
        "lights: [\n        (cell",
        &["there is `lights`", "bracket"],
    );
    refused(
        "width: 21, height: 13, phi",
        "width: 12, height: 13, phi",
        "material: Crystal",
        &["12 x 13", "cell (12, 4)"],
    );
    refused("phi: \"x\"", "phi: \"x +\"", "\", s1:", &["expression `phi`", "found the end"]);
}

#[test]
fn pictures_that_do_not_fit_are_refused_at_their_place() {
    refused("width: 21,\n", "width: 22,\n", "shape: Bitmap", &["21 x 13 pixels", "expected 22 x 13"]);
    refused(
        "path: \"marks.png\")",
        "path: \"marks.png\", at: (1, 0))",
        "shape: Bitmap",
        &["at (1, 0)", "does not fit"],
    );
    refused("path: \"marks.png\")", "path: \"no.png\")", "shape: Bitmap", &["no.png"]);
    refused("path: \"marks.png\")", "path: \"marks.txt\")", "shape: Bitmap", &["marks.txt", ".png"]);
}

#[test]
fn lights_in_walls_and_outside_are_refused_at_their_place() {
    // Without the picture, whose filters are no walls.
    let text = GOOD
        .replace("(shape: Bitmap(path: \"marks.png\"), material: Filter(0.25)),", "")
        .replace("(shape: Bitmap(path: \"marks.png\", inverted: true), material: Empty),", "");
    let wall = text.replace("(cell: (3, 2), emission", "(cell: (6, 6), emission");
    let problems = read(&wall).unwrap_err();
    let line = wall[..wall.find("(cell: (6, 6)").unwrap()].matches('\n').count() + 1;
    assert_eq!((problems[0].line, problems[0].column), (line, 10), "{}", problems[0]);
    assert!(problems[0].problem.contains("inside a wall of part 2"), "{}", problems[0]);
    refused("cell: (2, 2)", "cell: (21, 2)", "cell: (21, 2)", &["outside", "21 x 13"]);
}

#[test]
fn lights_that_cannot_shine_are_refused_at_their_place() {
    let beam = "profile: Emitter(theta_deg: 0, power: 1)";
    let expression = |text: &str| format!("profile: Expression(\"{text}\")");
    refused(beam, &expression("cos(theta) + $"), "$", &["the light at (3, 2)", "unknown character"]);
    refused(beam, &expression("1/0"), "profile: Expression", &["the light at (3, 2)", "`1/0`"]);
    refused(beam, &expression("-1"), "profile: Expression", &["(3, 2)", "0 in every direction"]);
    refused("cell: (3, 2)", "cell: (2, 2)", "cell: (2, 2), emission", &["(2, 2)", "two lights"]);
    refused(beam, "profile: Pulse(theta_deg: 7.123)", "profile: Pulse", &["7.123 degrees is no sample"]);
    // Which directions there are is not the scene's business, and faults of theirs have its place all the same.
    let scene = read(&GOOD.replace(beam, "profile: Pulse(theta_deg: 2.5)")).unwrap();
    let d = |samples| Directions::new(samples).unwrap();
    assert_eq!(scene.lights_in(d(144)).unwrap().len(), 2);
    let problem = scene.lights_in(d(16)).unwrap_err().remove(0).to_string();
    assert!(problem.starts_with("room/a.scene.ron:21:43: the light at (3, 2): 2.5 degrees"), "{problem}");
}

#[test]
fn places_do_not_depend_on_how_the_file_is_written() {
    let disc = ("Disc(centre: (6, 6), radius: 2)", "Disc(centre: (60, 6), radius: 2)");
    let places: Vec<(&str, &str)> = vec![
        ("    parts: [", "    /* parts: [ (shape: 1), */ parts: ["),
        ("    parts: [", "    parts : /* [ */\n ["),
        ("\"parts: [ and (brackets\"", "r#\"parts: [ \" and (brackets\"#"),
        ("\"parts: [ and (brackets\"", "\"parts: [ \\\" lights: [\""),
        ("(shape: Outline", "( /* , ) shape: */ shape: Outline"),
        ("(shape: Disc", "( // shape:\n shape: Disc"),
    ];
    for (from, to) in places {
        let text = GOOD.replacen(disc.0, disc.1, 1).replacen(from, to, 1);
        assert!(text.contains(to), "{from}");
        let problem = &read(&text).unwrap_err()[0];
        let place = text.find("shape: Disc(centre: (60").unwrap();
        let line = text[..place].matches('\n').count() + 1;
        let column = place - text[..place].rfind('\n').map_or(0, |n| n + 1) + 1;
        assert_eq!((problem.line, problem.column), (line, column), "{to}: {problem}");
    }
}

/// A small file may name one picture a thousand times, or one that unpacks to many pixels.
#[test]
fn many_bitmaps_cost_no_more_than_their_cells() {
    let part = "(shape: Bitmap(path: \"marks.png\"), material: Filter(0.5)),\n";
    let text = |n: usize, side: usize| {
        format!("(format: 1, title: \"t\", width: {side}, height: {side}, parts: [\n{}])", part.repeat(n))
    };
    let host = |side: u32| Files(vec![("room/marks.png".to_owned(), picture(side, side, |x, _| x > 0))]);
    let tried = |n, side: usize, of: u32| prepare("room/a.scene.ron", &text(n, side), &host(of));
    assert_eq!(tried(200, 300, 300).unwrap().scene.parts.len(), 200);
    let problems = tried(1200, 300, 300).unwrap_err();
    assert!(problems[0].line > 1000 && problems[0].problem.contains("too many"), "{}", problems[0]);
    let problems = tried(1, 300, 2000).unwrap_err();
    assert!(problems[0].problem.contains("2000 x 2000 pixels: expected 300 x 300"), "{}", problems[0]);
}

#[test]
fn scenes_that_are_too_large_are_refused() {
    refused("height: 13,\n", "height: 0,\n", "height: 0", &["21 x 0"]);
    refused("width: 21,\n", "width: 2100000,\n", "width: 2100000", &["not possible", "1 to 1048576 cells"]);
    refused("width: 21,\n", "width: 0,\n", "width: 0", &["0 x 13"]);
    refused("format: 1", "format: 2", "format", &["format 2"]);
}

#[test]
fn crystals_without_end_are_refused() {
    let part = "(shape: Disc(centre: (1, 1), radius: 1), material: Crystal(field: Axes(width: 1200, height: 1000, phi: \"0\", s1: \"1\", s2: \"1\"))),\n";
    let text =
        |n: usize| format!("(format: 1, title: \"t\", width: 9, height: 9, parts: [\n{}])", part.repeat(n));
    assert!(read(&text(2)).is_ok());
    let problems = read(&text(5)).unwrap_err();
    assert_eq!((problems.len(), problems[0].line), (2, 5), "{}", problems[0]);
    assert!(problems[0].problem.contains("4194304 cells together"), "{}", problems[0]);
}

#[test]
fn all_faults_of_a_scene_are_told_at_once() {
    let text = GOOD.replace("centre: (6, 6)", "centre: (-60, 6)").replace("to: (18, 9)", "to: (15, 3)");
    assert_eq!(read(&text).unwrap_err().len(), 2);
    // Those of parts, of the scene that the rest of them make, and of its lights.
    let text = text.replacen("marks.png", "none.png", 1).replace("(cell: (2, 2))", "(cell: (50, 2))");
    let problems: Vec<String> = read(&text).unwrap_err().iter().map(ToString::to_string).collect();
    let told = ["covers no cell", "begins where it ends", "none.png", "(50, 2) lies outside"];
    assert_eq!(problems.len(), told.len(), "{problems:?}");
    assert!(problems.iter().zip(told).all(|(problem, words)| problem.contains(words)), "{problems:?}");
}

#[test]
fn gaps_of_slanted_walls_are_remarked() {
    let text = |thickness: &str| {
        format!(
            "(format: 1, title: \"t\", width: 9, height: 9, parts: [(shape: Segment(from: (1, 1), to: (7, 7), thickness: {thickness}), material: Mirror())])"
        )
    };
    let remarks = |t: &str| read(&text(t)).unwrap().remarks();
    assert!(remarks("1")[0].contains("(1, 1) and (2, 2)") && remarks("1")[0].contains("5 more places"));
    assert!(remarks("1.5").is_empty());
}

const EXPERIMENT: &str = r#"(
    format: 1, title: "t", source: "s", section: "1", claim: "c", look_for: "l",
    fields: { "plain": Axes(width: 21, height: 13, phi: "0", s1: "1", s2: "1") },
    scenes: { "room": "a.scene.ron" },
    runs: {
        "glow": Light(field: "room", stop: Steps(5)),
        "bare": Light(field: "plain", lights: [(cell: (2, 2))], stop: Steps(5)),
    },
    figures: [
        (name: "a", caption: "c", panels: [Energy(run: "glow", title: "t"), Energy(run: "bare", title: "u")], animation: (run: "glow")),
    ],
    checks: [
        (name: "n", quantity: Steps(run: "glow"), expect: Near(5, 0), basis: "b"),
    ],
)"#;

fn problems(from: &str, to: &str) -> String {
    let text = EXPERIMENT.replacen(from, to, 1);
    assert_ne!(text, EXPERIMENT, "{from}");
    let picture = files().0.remove(0).1;
    let host = Files(vec![
        ("a.scene.ron".to_owned(), GOOD.as_bytes().to_vec()),
        ("marks.png".to_owned(), picture),
        (
            "pulse.scene.ron".to_owned(),
            GOOD.replace("Emitter(theta_deg: 0, power: 1)", "Pulse(theta_deg: 2.5)").into_bytes(),
        ),
        ("bad.scene.ron".to_owned(), b"(format: 1)".to_vec()),
    ]);
    let experiment = match load("e.ron", &text) {
        Ok(experiment) => experiment,
        Err(e) => return e.to_string(),
    };
    match plan("e.ron", &text, &experiment, false, &host) {
        Ok(_) => String::new(),
        Err(problems) => problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"),
    }
}

#[test]
fn experiments_take_scenes_where_light_runs_and_nowhere_else() {
    assert_eq!(problems("Steps(5)", "Steps(6)"), "");
    let normalised = problems("field: \"room\",", "field: \"room\", normalization: Global,");
    assert!(normalised.contains("normalisation of their own"), "{normalised}");
    let lines = problems("Light(field: \"room\", stop: Steps(5))", "Ftle(field: \"room\", length: 3)");
    assert!(lines.contains("a scene has no tensors"), "{lines}");
    let glyphs = problems("Energy(run: \"glow\",", "Glyphs(field: \"room\",");
    assert!(glyphs.contains("names a field \"room\""), "{glyphs}");
    let twice = problems("\"room\": \"a.scene.ron\"", "\"plain\": \"a.scene.ron\"");
    assert!(twice.contains("the name of a field and of a scene"), "{twice}");
    let missing = problems("a.scene.ron", "b.scene.ron");
    assert!(missing.starts_with("e.ron:4:") && missing.contains("b.scene.ron"), "{missing}");
    let ending = problems("a.scene.ron", "a.ron");
    assert!(ending.contains("expected a file NAME.scene.ron"), "{ending}");
    let bad = problems("a.scene.ron", "bad.scene.ron");
    assert!(bad.starts_with("bad.scene.ron:1:"), "{bad}");
    let wall = problems("field: \"room\",", "field: \"room\", lights: [(cell: (0, 0))],");
    assert_eq!(wall, "", "the picture's filters cover the walls");
    let pulse = problems("a.scene.ron", "pulse.scene.ron");
    assert!(pulse.starts_with("pulse.scene.ron:21:43: ") && pulse.contains("no sample"), "{pulse}");
    let outside = problems("field: \"room\",", "field: \"room\", lights: [(cell: (40, 0))],");
    assert!(outside.contains("outside"), "{outside}");
    let animation = problems("animation: (run: \"glow\")", "animation: (run: \"glare\")");
    assert!(animation.contains("names a run \"glare\""), "{animation}");
    let never = problems("animation: (run: \"glow\")", "animation: (run: \"glow\", every: 0)");
    assert!(never.starts_with("e.ron:10:"), "{never}");
    let way = problems("Steps(run: \"glow\")", "WayLength(run: \"glow\", to: (30, 2))");
    assert!(way.contains("(30, 2)"), "{way}");
    let solved = problems("Steps(run: \"glow\")", "ShortestWays(run: \"glow\")");
    assert_eq!(solved, "");
    let bare = problems("Steps(run: \"glow\")", "ShortestWays(run: \"bare\")");
    assert!(bare.contains("\"bare\" runs through a field"), "{bare}");
    let no_scene = problems("field: \"room\",", "field: \"plain\", lights: [(cell: (2, 2))],");
    assert_eq!(no_scene, "");
}
