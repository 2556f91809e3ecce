//! Tests of reviews on made-up results.

use super::{Pending, Review, ReviewError, Side, Value, html, json, read, results, snapshots, text};
use serde_json::{Value as Json, json as value};

const TOLERANCE: f64 = 1e-9;

fn check(name: &str, value: &Json, passed: bool) -> Json {
    value!({ "name": name, "value": value, "expected": 1.0, "tolerance": 0.5, "passed": passed, "kind": "near" })
}

fn experiment(slug: &str, checks: Vec<Json>, figures: &[&str]) -> Json {
    let figures: Vec<String> =
        figures.iter().flat_map(|f| ["png", "svg"].map(|e| format!("{slug}/{f}.{e}"))).collect();
    value!({
        "slug": slug, "title": format!("Title of {slug}"), "seconds": 1.5, "passed": true,
        "figures": figures, "checks": checks, "work": { "steps": 12 },
    })
}

fn summary(experiments: &[Json]) -> String {
    value!({ "passed": true, "seconds": 1.0, "experiments": experiments }).to_string()
}

fn png(size: [u32; 2], grey: u8) -> Vec<u8> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, size[0], size[1]);
    encoder.set_color(png::ColorType::Grayscale);
    let mut data = vec![0; (size[0] * size[1]) as usize];
    data[0] = grey;
    encoder.write_header().and_then(|mut w| w.write_image_data(&data)).expect("a PNG");
    png
}

/// Reviews two lists of experiments. Figures are of 4 x 4 pixels; those called `moving` differ in one of them, those
/// called `growing` in size.
fn reviewed(base: &[Json], head: &[Json]) -> Review {
    let parse = |name, list| read(name, &summary(list)).expect("a summary");
    let mut figure = |side, path: &str| {
        let later = side == Side::Head;
        let size = if path.contains("growing") && later { [5, 4] } else { [4, 4] };
        Ok::<_, ReviewError>(png(size, if path.contains("moving") && later { 51 } else { 0 }))
    };
    let (base, head) = (parse("a/summary.json", base), parse("b/summary.json", head));
    results(["a", "b"], &base, &head, TOLERANCE, &mut figure).expect("a review")
}

fn parsed(review: &Review) -> Json {
    serde_json::from_str(&json(review)).expect("JSON")
}

fn one(slug: &str, x: f64) -> Json {
    experiment(slug, vec![check("flux", &value!(x), true)], &["still"])
}

/// Values of an attribute, wherever it stands in a tag.
fn attribute_values<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    page.split(&format!(" {attribute}=\"")).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// One of everything.
fn mixed() -> Review {
    let base = [
        one("same", 1.0),
        experiment(
            "verdict",
            vec![check("a", &value!(1.0), true), check("left", &value!(2.0), true)],
            &["still", "moving"],
        ),
        one("far", 1.0),
        one("near", 1.0),
        experiment("sizes", vec![], &["growing", "dropped"]),
        one("lost", 1.0),
    ];
    let head = [
        one("near", 1.0 + 1e-6),
        one("far", 1.25),
        one("same", 1.0),
        experiment(
            "verdict",
            vec![check("a", &value!(1.0), false), check("come", &value!(2.0), true)],
            &["still", "moving"],
        ),
        experiment("sizes", vec![], &["growing", "drawn"]),
        one("arrived", 1.0),
    ];
    reviewed(&base, &head)
}

#[test]
fn equal_results_are_unchanged() {
    let list = [one("a", 1.0), experiment("b", vec![check("n", &Json::Null, false)], &["still"])];
    let review = reviewed(&list, &list);
    assert!(!review.moved());
    assert!(
        text(&review).contains("2 experiments: 0 moved, 0 added, 0 gone, 2 unchanged"),
        "{}",
        text(&review)
    );
    let page = html(&review);
    assert!(page.contains("Nothing moved.") && !page.contains("<article") && page.contains("<details>"));
    let json = parsed(&review);
    assert_eq!(json["moved"], false);
    assert_eq!(json["experiments"][0]["numbers"], value!([]));
    assert_eq!(json["experiments"][0]["figures"][0]["pixels_differing"], 0);
}

#[test]
fn movement_is_what_exceeds_the_tolerance() {
    for (change, moved) in [(0.0, false), (0.9e-9, false), (1.2e-9, true), (1.0, true)] {
        assert_eq!(reviewed(&[one("a", 1.0)], &[one("a", 1.0 + change)]).moved(), moved, "{change}");
    }
    // The largest change stands there, though nothing moved.
    let json = parsed(&reviewed(&[one("a", 1.0)], &[one("a", 1.0 + 0.5e-9)]));
    assert!(json["experiments"][0]["largest_change"].as_f64().is_some_and(|c| c > 0.4e-9 && c < 0.6e-9));
}

#[test]
fn changes_are_relative_to_the_larger_value_and_to_noise() {
    let change = |a: f64, b: f64| Value::Number(a).change(&Value::Number(b));
    assert_eq!((change(1.0, 2.0), change(2.0, 1.0), change(-1.0, 1.0)), (0.5, 0.5, 2.0));
    assert_eq!((change(0.0, 0.0), change(0.0, -0.0), change(0.0, 5.0)), (0.0, 0.0, 1.0));
    assert!((change(1e-16, 2e-16) - 1e-7).abs() < 1e-20);
    assert_eq!(change(f64::MAX, -f64::MAX), 2.0);
    assert_eq!((change(f64::NAN, f64::NAN), change(f64::NAN, 1.0)), (0.0, f64::INFINITY));
    assert_eq!(change(f64::INFINITY, f64::INFINITY), 0.0);
    assert_eq!(change(f64::INFINITY, 1.0), f64::INFINITY);
    assert_eq!(Value::Words("a".into()).change(&Value::Words("b".into())), f64::INFINITY);
}

#[test]
fn values_that_are_no_numbers_move_and_stay() {
    let with = |x: &Json| [experiment("a", vec![check("n", x, true)], &[])];
    assert!(!reviewed(&with(&Json::Null), &with(&Json::Null)).moved());
    let review = reviewed(&with(&Json::Null), &with(&value!(1.0)));
    assert!(review.moved());
    let json = parsed(&review);
    let number = &json["experiments"][0]["numbers"][0];
    assert_eq!((&number["base"], &number["head"]), (&Json::Null, &value!(1.0)));
    assert_eq!((&number["relative_change"], &number["base_passed"]), (&Json::Null, &value!(true)));
    assert!(html(&review).contains("not a number"));
}

#[test]
fn what_fails_now_is_named_at_once() {
    let checks =
        |passed| (0..11).map(|k| check(&format!("law {k}"), &value!(f64::from(k)), passed)).collect();
    let review = reviewed(
        &[experiment("broken", checks(true), &[]), one("mended", 1.0)],
        &[experiment("broken", checks(false), &[]), one("mended", 2.0)],
    );
    let words = text(&review);
    assert!(words.lines().nth(1) == Some("11 checks FAIL now:"), "{words}");
    assert!(words.contains("  broken: law 0: 0 -> 0, expected 1 ± 0.5\n"), "{words}");
    assert!(words.contains("  and 1 more, all on the page") && words.lines().count() <= 24, "{words}");
    let page = html(&review);
    assert!(page.contains("<title>tigereye review: 11 checks fail now, 2 of 2 experiments moved</title>"));
    let (failing, moved) = (page.find("11 checks fail now."), page.find("2 of 2 experiments moved."));
    assert!(failing.is_some() && failing < moved, "failures lead");
    let list =
        page.split("class=\"failures\"").nth(1).and_then(|rest| rest.split("</ul>").next()).expect("a list");
    assert!((0..11).all(|k| list.contains(&format!("law {k}</a>"))), "{list}");
    assert!(list.contains("<a href=\"#moved-1\">Title of broken</a>"), "{list}");
    for link in attribute_values(list, "href") {
        assert!(page.contains(&format!(" id=\"{}\"", &link[1..])), "nothing at {link}");
    }
    // What fails as before, and what passes again, is no news.
    let again =
        reviewed(&[experiment("broken", checks(false), &[])], &[experiment("broken", checks(true), &[])]);
    assert!(!text(&again).contains("FAIL") && !html(&again).contains("failures\""), "{}", text(&again));
}

#[test]
fn rounding_within_a_tolerance_of_rounding_is_no_movement() {
    let with = |kind: &str, expected: f64, tolerance: f64, x: f64| {
        let mut check = check("n", &value!(x), true);
        (check["kind"], check["expected"], check["tolerance"]) =
            (value!(kind), value!(expected), value!(tolerance));
        [experiment("a", vec![check], &[])]
    };
    for (kind, expected, tolerance, a, b, moved) in [
        ("at most", 1e-12, 0.0, 9.5e-16, 1.4e-15, false),
        ("near", 425.5, 4e-9, 425.5, 425.500_000_003, false),
        // A bound that accepts more than rounding is no excuse.
        ("at most", 8.0, 0.0, 0.47, 0.48, true),
        ("near", 0.5, 0.1, 0.5, 0.51, true),
        ("at least", 1e-12, 0.0, 0.5, 0.500_001, true),
    ] {
        let review = reviewed(&with(kind, expected, tolerance, a), &with(kind, expected, tolerance, b));
        assert_eq!(review.moved(), moved, "{kind} {expected}: {a} {b}");
    }
}

#[test]
fn a_verdict_or_an_expectation_is_movement_too() {
    let [good, bad] = [true, false].map(|p| [experiment("a", vec![check("n", &value!(1.0), p)], &[])]);
    let review = reviewed(&good, &bad);
    assert!(review.moved() && text(&review).contains("1 verdict changed"), "{}", text(&review));
    let json = parsed(&review);
    let number = &json["experiments"][0]["numbers"][0];
    assert_eq!((&number["base_passed"], &number["head_passed"]), (&value!(true), &value!(false)));
    let mut loose = good.clone();
    loose[0]["checks"][0]["tolerance"] = value!(5.0);
    let review = reviewed(&good, &loose);
    assert!(review.moved());
    let page = html(&review);
    let (before, after) = page.split_once("<span class=\"arrow\">→</span>").expect("both");
    assert!(before.ends_with(">0.5</data></span> ") && after.contains(">5</data>"), "{after}");
}

#[test]
fn seconds_never_count() {
    let mut later = [one("a", 1.0)];
    later[0]["seconds"] = value!(99.0);
    let review = reviewed(&[one("a", 1.0)], &later);
    assert!(!review.moved());
    assert_eq!(parsed(&review)["experiments"][0]["head_seconds"], 99.0);
}

#[test]
fn work_counts_where_both_have_it() {
    let mut more = [one("a", 1.0)];
    more[0]["work"]["steps"] = value!(24);
    let review = reviewed(&[one("a", 1.0)], &more);
    assert!(review.moved() && text(&review).contains("work steps"), "{}", text(&review));
    assert_eq!(parsed(&review)["experiments"][0]["work"][0]["relative_change"], 0.5);
    more[0].as_object_mut().expect("an object").remove("work");
    assert!(!reviewed(&[one("a", 1.0)], &more).moved());
}

#[test]
fn what_moved_most_comes_first() {
    let json = parsed(&mixed());
    let list = json["experiments"].as_array().expect("a list");
    let slugs: Vec<_> = list.iter().map(|e| e["slug"].as_str().unwrap_or("")).collect();
    // Verdicts, then what no number can say, then by change; the unchanged ones last.
    assert_eq!(slugs, ["verdict", "arrived", "lost", "sizes", "far", "near", "same"]);
    let states: Vec<_> = list.iter().map(|e| e["state"].as_str().unwrap_or("")).collect();
    assert_eq!(states, ["moved", "added", "gone", "moved", "moved", "moved", "unchanged"]);
    assert_eq!(list[4]["largest_change"], 0.2);
}

#[test]
fn checks_and_figures_come_and_go() {
    let json = parsed(&mixed());
    let numbers = json["experiments"][0]["numbers"].as_array().expect("a list");
    let of = |name: &str| numbers.iter().find(|n| n["name"] == name).expect("the check");
    assert_eq!((&of("left")["head"], &of("left")["head_passed"]), (&Json::Null, &Json::Null));
    assert_eq!((&of("come")["base"], &of("come")["base_passed"]), (&Json::Null, &Json::Null));
    let figures = &json["experiments"][3]["figures"];
    let states: Vec<_> =
        figures.as_array().expect("a list").iter().map(|f| [f["name"].clone(), f["state"].clone()]).collect();
    assert_eq!(value!(states), value!([["growing", "moved"], ["drawn", "added"], ["dropped", "gone"]]));
    // A column more of white, and the first pixel as before.
    assert_eq!(figures[0]["pixels_differing"], 4);
    let moving = &json["experiments"][0]["figures"][1];
    assert_eq!((&moving["pixels_differing"], &moving["largest_difference"]), (&value!(1), &value!(51)));
}

#[test]
fn checks_of_one_name_are_told_apart() {
    let twice =
        |x: f64| [experiment("a", vec![check("n", &value!(1.0), true), check("n", &value!(x), true)], &[])];
    let json = parsed(&reviewed(&twice(1.0), &twice(2.0)));
    assert_eq!(json["experiments"][0]["numbers"].as_array().map(Vec::len), Some(1));
    assert_eq!(json["experiments"][0]["numbers"][0]["name"], "n (2)");
}

#[test]
fn pages_are_whole() {
    let page = html(&mixed());
    let images = page.matches("<img ").count();
    // Two and a map, of one size and of two; one added and one gone; an added and a gone experiment's figure.
    assert_eq!(images, 3 + 3 + 2 + 2);
    let alts = attribute_values(&page, "alt");
    assert!(alts.len() == images && alts.iter().all(|a| a.len() > 10), "{alts:?}");
    for address in attribute_values(&page, "src").iter().chain(&attribute_values(&page, "href")) {
        assert!(address.starts_with("data:image/png;base64,") || address.starts_with("#moved-"), "{address}");
    }
    for forbidden in ["http:", "https:", "url(", "@import", "<link", "<script src"] {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
    assert!(page.contains("1 pixel of 16 differs") && page.contains("by 51 of 255 at most"));
    assert!(page.contains("4 × 4 → 5 × 4 pixels"));
    let headings: Vec<u8> =
        page.split("<h").skip(1).map(|rest| rest.as_bytes()[0]).filter(u8::is_ascii_digit).collect();
    assert!(headings.starts_with(b"1") && headings.windows(2).all(|w| w[1] <= w[0] + 1 && w[1] > b'1'));
    let ids = attribute_values(&page, "id");
    for label in attribute_values(&page, "for") {
        assert_eq!(ids.iter().filter(|id| **id == label).count(), 1, "{label}");
    }
    assert_eq!(page.matches("type=\"range\"").count(), 2);
    for link in attribute_values(&page, "href") {
        assert!(ids.contains(&&link[1..]), "{link}");
    }
}

#[test]
fn names_are_escaped() {
    let evil = "<script>alert(\"x\")</script>";
    let list = |x: f64| {
        let mut e = experiment("s", vec![check(evil, &value!(x), true)], &[]);
        (e["slug"], e["title"]) = (value!(evil), value!(evil));
        e["figures"] = value!(["<b>moving</b>.png"]);
        [e]
    };
    let page = html(&reviewed(&list(1.0), &list(2.0)));
    assert!(
        !page.contains("<script>alert") && !page.contains("<b>moving") && page.contains("&lt;script&gt;")
    );
}

#[test]
fn the_text_fits_a_screen() {
    let list = |x: f64| (0..40).map(|i| one(&format!("e{i:02}{}", "x".repeat(300)), x)).collect::<Vec<_>>();
    let words = text(&reviewed(&list(1.0), &list(2.0)));
    assert!(words.lines().count() <= 20 && words.contains("and 28 more"), "{words}");
    assert!(words.lines().all(|l| l.chars().count() < 200));
    let words = text(&mixed());
    assert!(words.contains("  far  2.0e-1  check flux\n"), "{words}");
    assert!(words.contains("  arrived  added\n") && words.contains("  lost  gone\n"), "{words}");
}

#[test]
fn summaries_that_are_wrong_are_refused_by_key() {
    let good = summary(&[one("a", 1.0)]);
    let refused = |text: &str| read("r/summary.json", text).expect_err("refused").to_string();
    for (text, words) in [
        ("", "JSON"),
        ("{\"seconds\": 1", "JSON"),
        ("[]", "invalid length"),
        ("{}", "missing field `experiments`"),
        (r#"{"experiments": {}}"#, "experiments: invalid type: map, expected a sequence"),
        (r#"{"experiments": [7]}"#, "experiments[0]: invalid type"),
    ] {
        let message = refused(text);
        assert!(message.starts_with("r/summary.json: ") && message.contains(words), "{message}");
    }
    for (from, to, words) in [
        ("\"a\"", "7", "experiments[0].slug: invalid type: integer `7`, expected a string"),
        (
            "\"value\":1.0",
            "\"value\":\"1\"",
            "experiments[0].checks[0].value: invalid type: string \"1\", expected f64",
        ),
        (
            "\"passed\":true,\"tolerance\"",
            "\"passed\":1,\"tolerance\"",
            "checks[0].passed: invalid type: integer `1`, expected a boolean",
        ),
        ("\"steps\":12", "\"steps\":[]", "experiments[0].work.steps: invalid type: sequence, expected u64"),
        ("a/still.png", "../still.png", "experiments[0].figures[0]: expected the path"),
        ("a/still.png", "/etc/still.png", "experiments[0].figures[0]: expected the path"),
        ("a/still.png", "a//still.png", "experiments[0].figures[0]: expected the path"),
        ("\"seconds\":1.5", "\"seconds\":true", "experiments[0].seconds"),
    ] {
        assert!(good.contains(from), "{from} in {good}");
        let message = refused(&good.replace(from, to));
        assert!(message.contains(words), "{message}");
    }
    assert!(refused(&summary(&[one("a", 1.0), one("a", 2.0)])).contains("experiments[1].slug"));
    assert!(refused(&format!("{}1{}", "[".repeat(9999), "]".repeat(9999))).starts_with("r/summary.json: "));
    assert!(refused(&good.replace("\"a\"", &format!("\"{}\"", "x".repeat(20_000)))).contains("at most"));
}

#[test]
fn figures_that_are_no_pictures_are_refused_where_they_differ() {
    let list = read("s", &summary(&[one("a", 1.0)])).expect("a summary");
    let review = |bytes: fn(Side) -> Vec<u8>| {
        results(["x", "y"], &list, &list, TOLERANCE, &mut |side, _: &str| Ok::<_, ReviewError>(bytes(side)))
    };
    assert!(!review(|_| b"junk".to_vec()).expect("equal bytes").moved());
    let error = review(|side| format!("junk {side:?}").into_bytes()).expect_err("refused").to_string();
    assert!(error.starts_with("x/a/still.png: "), "{error}");
}

#[test]
fn snapshots_are_compared_line_by_line() {
    let old = "---\nsource: a\n---\nDigest(\n  mean: \"1.00000000e0\",\n  stop: \"Converged\",\n  checks: [\n    C(\n      name: \"n\",\n      passed: true,\n    ),\n  ],\n)\n";
    let pending = |name: &str, accepted: Option<&str>, pending: String| Pending {
        name: name.to_owned(),
        accepted: accepted.map(ToOwned::to_owned),
        pending,
    };
    let review = snapshots(
        ["s/*.snap", "s/*.snap.new"],
        &[
            pending("digest@same", Some(old), old.replace("source: a", "source: b")),
            pending("digest@number", Some(old), old.replace("1.00000000e0", "1.00000001e0")),
            pending("digest@words", Some(old), old.replace("Converged", "Limit")),
            pending("digest@verdict", Some(old), old.replace("true", "false")),
            pending("digest@first", None, old.to_owned()),
        ],
        7,
        TOLERANCE,
    );
    assert!(review.moved());
    let words = text(&review);
    assert!(
        words.contains("5 snapshots pending: 3 moved, 1 added, 0 gone, 1 unchanged; 7 snapshots without"),
        "{words}"
    );
    assert!(
        words.contains("1 verdict changed") && words.contains("digest@number  1.0e-8  line mean"),
        "{words}"
    );
    let json = parsed(&review);
    let slugs: Vec<_> =
        json["experiments"].as_array().expect("a list").iter().map(|e| e["slug"].clone()).collect();
    assert_eq!(
        value!(slugs),
        value!(["digest@verdict", "digest@first", "digest@words", "digest@number", "digest@same"])
    );
    assert_eq!(json["experiments"][2]["numbers"][0]["head"], "Limit");
    assert_eq!(json["experiments"][1]["state"], "added");
    let page = html(&review);
    assert!(page.contains("Pending") && page.contains("1.00000001"), "{page}");
    assert!(!page.contains("http:") && !page.contains("https:"));
}

/// Seconds never count as movement, drawn or not.
#[test]
fn figures_of_seconds_are_left_out() {
    let text = r#"{"experiments": [{"slug": "a", "checks": [],
        "figures": ["a/x.png", "a/x.svg", "a/t.png", "a/t.svg"], "timed_figures": ["a/t.png", "a/t.svg"]}]}"#;
    let results = read("summary.json", text).expect("results");
    assert!(format!("{results:?}").contains(r#"figures: ["a/x.png"]"#), "{results:?}");
}
