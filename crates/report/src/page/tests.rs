//! Tests of the page and the summary on made-up outcomes.

use serde_json::Value;

use crate::{
    About, CheckOutcome, Column, DataFile, Expected, ExperimentOutcome, Figure, LeftOut, Made, Summary, Table,
};

fn about() -> About {
    let command = "tigereye reproduce --out results".into();
    About { version: "1.2.3".into(), command, full: false, threads: 4, added: 3, left_out: Vec::new() }
}

/// The summary of a folder of these.
fn summary(outcomes: &[ExperimentOutcome], about: &About) -> Summary {
    let mut summary = Summary { passed: true, about: about.clone(), ..Summary::default() };
    let made = Made { version: "1.2.3", full: false, file: "a.ron" };
    outcomes.iter().for_each(|o| summary.receive(o.summary(&made)));
    summary
}

fn html(outcomes: &[ExperimentOutcome], about: &About) -> String {
    super::html(&summary(outcomes, about), &|path| {
        let figures = outcomes.iter().flat_map(|o| o.figures.iter().map(move |f| (&o.slug, f)));
        let png = |(slug, f): (&String, &Figure)| {
            (path == format!("{slug}/{}.png", f.name)).then(|| vec![f.png.clone()])
        };
        figures.into_iter().find_map(png)
    })
}

fn check(name: &str, value: f64, expected: Expected) -> CheckOutcome {
    CheckOutcome {
        name: name.into(),
        value,
        expected,
        basis: "geometry".into(),
        passed: expected.is_met_by(value),
        reason: None,
    }
}

fn outcome(slug: &str, section: &str, checks: Vec<CheckOutcome>) -> ExperimentOutcome {
    let figure = Figure {
        timed: false,
        frames: 0,
        panels: Vec::new(),
        name: "light map".into(),
        caption: "Light after ten steps.".into(),
        alt: "A bright spot".into(),
        width_px: 300.0,
        height_px: 200.0,
        png: vec![1, 2, 3],
        svg: "<svg/>".into(),
    };
    ExperimentOutcome {
        slug: slug.into(),
        title: format!("Title of {slug}"),
        source: "Thesis, Fig. 4.1".into(),
        section: section.into(),
        claim: "Light follows 1/r.".into(),
        look_for: "A straight line.".into(),
        figures: vec![figure],
        tables: vec![Table {
            title: "Steps by field".into(),
            caption: "Few and many.".into(),
            columns: [("Field", true), ("Steps", false)]
                .map(|(h, words)| Column { heading: h.into(), words })
                .into(),
            rows: vec![("rings".into(), vec!["812 (7 to 900)".into()])],
        }],
        checks,
        work: vec![("steps".into(), 12_345), ("cells".into(), 7), ("steps".into(), 9)],
        data: vec![DataFile { name: "samples.csv".into(), bytes: vec![0; 2048] }],
        seconds: 1.5,
        command: format!("tigereye reproduce --only {slug}"),
    }
}

fn mixed() -> Vec<ExperimentOutcome> {
    let near = Expected::Near { value: 0.5, tolerance: 0.01 };
    vec![
        outcome("drain", "4.5 Gradient", vec![check("column", 50.0, Expected::AtLeast(40.0))]),
        outcome(
            "attenuation",
            "4.1 Propagation",
            vec![check("good flux", 0.505, near), check("bad flux", 0.6, near)],
        ),
        outcome("energy", "4.1 Propagation", vec![check("drift", f64::NAN, Expected::AtMost(3e-13))]),
    ]
}

/// Values of an attribute, wherever it stands in a tag.
fn attribute_values<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    page.split(&format!(" {attribute}=\"")).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

#[test]
fn summary_has_the_agreed_shape() {
    let text = summary(&mixed(), &about()).to_json();
    let summary: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!((&summary["passed"], &summary["seconds"]), (&Value::from(false), &Value::from(4.5)));
    let drain = &summary["experiments"][0];
    assert_eq!(drain["slug"], "drain");
    assert_eq!(drain["passed"], true);
    assert_eq!(drain["figures"], serde_json::json!(["drain/light map.png", "drain/light map.svg"]));
    assert_eq!(drain["work"], serde_json::json!({ "steps": 12_345, "cells": 7, "steps (2)": 9 }));
    let bound = serde_json::json!({
        "name": "column", "value": 50.0, "expected": 40.0, "tolerance": 0.0, "passed": true,
        "kind": "at least", "basis": "geometry",
    });
    assert_eq!(drain["checks"][0], bound);
    let near = &summary["experiments"][1]["checks"][1];
    assert_eq!((&near["expected"], &near["tolerance"]), (&Value::from(0.5), &Value::from(0.01)));
    assert_eq!(summary["experiments"][2]["checks"][0]["value"], Value::Null);
}

#[test]
fn summary_keys_stand_in_a_fixed_order() {
    let text = summary(&mixed()[..1], &about()).to_json();
    let keys: Vec<&str> =
        text.lines().filter_map(|l| l.trim().strip_prefix('"')?.split_once("\": ")).map(|(k, _)| k).collect();
    let expect = "passed seconds about version command full threads added left_out experiments slug title source seconds \
                  passed figures timed_figures checks name value expected tolerance passed kind basis command work \
                  steps cells steps (2) version full file section claim look_for pictures name caption alt width_px \
                  height_px frames panels tables title caption columns heading words heading words rows data name bytes";
    assert_eq!(keys.join(" "), expect);
}

#[test]
fn what_was_written_is_read_back() {
    let mut written = summary(&mixed(), &about());
    let text = written.to_json();
    let read = Summary::from_json("summary.json", &text).expect("a summary");
    assert_eq!(read.to_json(), text);
    // NaN equals nothing, itself least of all.
    written.experiments.retain(|e| e.checks.iter().all(|c| !c.value.is_nan()));
    assert_eq!(Summary::from_json("summary.json", &written.to_json()).expect("a summary"), written);
}

#[test]
fn page_has_every_experiment_in_ascending_sections() {
    let page = html(&mixed(), &about());
    let ids = attribute_values(&page, "id");
    let articles: Vec<_> = ids.iter().filter(|id| ["attenuation", "energy", "drain"].contains(id)).collect();
    assert_eq!(articles, [&"attenuation", &"energy", &"drain"]);
    let mut unique = ids.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), ids.len(), "ids are unique");
}

#[test]
fn page_needs_nothing_outside_itself() {
    let page = html(&mixed(), &about());
    for address in [attribute_values(&page, "src"), attribute_values(&page, "href")].concat() {
        let inside = address.starts_with('#') || address.starts_with("data:image/png;base64,");
        assert!(inside || address.starts_with("./"), "{address}");
    }
    for forbidden in ["http:", "https:", "url(", "@import", "<script", "<link"] {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
    for link in attribute_values(&page, "href").iter().filter_map(|a| a.strip_prefix('#')) {
        assert!(page.contains(&format!(" id=\"{link}\"")), "nothing at #{link}");
    }
}

#[test]
fn files_beside_the_page_are_linked_by_relative_address() {
    let page = html(&mixed(), &about());
    for link in ["./drain/light%20map.svg", "./drain/light%20map.png", "./drain/samples.csv"] {
        assert!(attribute_values(&page, "href").contains(&link), "{link}");
    }
    assert!(page.contains("samples.csv</a> (2.0 kB)"));
}

#[test]
fn text_is_escaped_everywhere() {
    let evil = "<script>alert(\"x\")</script>";
    let mut hostile = outcome(evil, evil, vec![check(evil, 1.0, Expected::AtMost(0.0))]);
    for text in [
        &mut hostile.title,
        &mut hostile.source,
        &mut hostile.claim,
        &mut hostile.look_for,
        &mut hostile.command,
    ] {
        *text = evil.into();
    }
    hostile.checks[0].basis = evil.into();
    hostile.work = vec![(evil.into(), 1)];
    hostile.data[0].name = evil.into();
    let table = &mut hostile.tables[0];
    (table.title, table.caption, table.columns[0].heading) = (evil.into(), evil.into(), evil.into());
    table.rows[0] = (evil.into(), vec![evil.into()]);
    let figure = &mut hostile.figures[0];
    (figure.name, figure.caption, figure.alt) = (evil.into(), evil.into(), evil.into());
    let about = About { version: evil.into(), command: evil.into(), ..about() };
    let page = html(&[hostile], &about);
    assert!(!page.contains("<script") && !page.contains("\"x\""));
    assert!(page.contains("&lt;script&gt;"));
}

#[test]
fn failing_checks_come_first_and_say_so() {
    let page = html(&mixed(), &about());
    assert!(page.contains("3 experiments: 2 of 4 checks failed."));
    assert!(page.contains("1 of 2 checks failed"));
    let article = page.split("<article id=\"attenuation\"").nth(1).expect("the article");
    let (bad, good) = (article.find("bad flux").expect("bad"), article.find("good flux").expect("good"));
    assert!(bad < good);
    let row = article.split("<tr").find(|r| r.contains("bad flux")).expect("its row");
    assert!(row.contains("✗") && row.contains("failed") && row.contains("by ") && row.contains("0.09"));
    assert!(page.contains("not a number"));
}

#[test]
fn figures_have_alternative_text_and_size() {
    let page = html(&mixed(), &about());
    assert!(page.contains("alt=\"A bright spot\" width=\"300\" height=\"200\""));
    assert!(page.contains("data:image/png;base64,AQID"));
}

#[test]
fn animations_move_only_for_those_who_ask() {
    let still = html(&mixed(), &about());
    assert!(!still.contains("apng"));
    let mut outcomes = mixed();
    outcomes[0].figures[0].frames = 12;
    let slug = outcomes[0].slug.clone();
    let page = html(&outcomes, &about());
    let image = format!("<img src=\"./{slug}/light%20map.apng\" loading=\"lazy\"");
    let details = page.find("<details class=\"animation\"").expect("a closed part of the page");
    assert!(page[details..].contains("Watch the 12 frames"));
    assert!(page[details..].contains(&image), "{image}");
    assert!(page[details..].contains("alt=\"Animation. Light after ten steps.\""));
}

#[test]
fn tables_have_headings_of_rows_and_columns() {
    let page = html(&mixed()[..1], &about());
    for part in [
        "<caption><b>Steps by field.</b> Few and many.</caption>",
        "<th scope=\"col\">Field</th><th class=\"number\" scope=\"col\">Steps</th>",
        "<th scope=\"row\">rings</th><td class=\"number\">812 (7 to 900)</td>",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn tables_that_three_experiments_share_stand_side_by_side() {
    let named = |slug: &str, title: &str, steps: &str| {
        let mut o = outcome(slug, "6 Comparison", Vec::new());
        o.title = format!("Steps of: {title}");
        o.tables[0].rows[0].1[0] = steps.to_owned();
        o
    };
    let two = [named("a", "drain", "11"), named("b", "gyre", "22")];
    assert!(!html(&two, &about()).contains("Side by side"));
    let [a, b] = two;
    let mut other = named("c", "star", "33");
    other.tables[0].rows.push(("more".into(), vec!["44".into()]));
    let page = html(&[a, b, other], &about());
    let overview = page.find("Side by side").expect("an overview");
    let articles = page.find("<article").expect("experiments");
    assert!(overview < articles);
    let overview = &page[overview..articles];
    assert!(overview.contains("Steps by field, all 3 experiments"));
    for row in [
        "<th scope=\"row\"><a href=\"#a\">drain</a></th><td class=\"number\">11</td>",
        "<th scope=\"row\"><a href=\"#b\">gyre</a></th><td class=\"number\">22</td>",
        "<th scope=\"row\"><a href=\"#c\">star</a>, rings</th><td class=\"number\">33</td>",
        "<th scope=\"row\"><a href=\"#c\">star</a>, more</th><td class=\"number\">44</td>",
    ] {
        assert!(overview.contains(row), "{row} in {overview}");
    }
}

#[test]
fn nothing_run_is_still_a_page() {
    let page = html(&[], &about());
    assert!(page.contains("No experiment was run") && page.contains("Glossary") && page.ends_with("</html>"));
    assert!(!page.contains("passed.") && !page.contains("<table"));
    let summary: Value = serde_json::from_str(&summary(&[], &about()).to_json()).expect("JSON");
    assert_eq!(summary["experiments"], serde_json::json!([]));
}

#[test]
fn an_experiment_without_checks_is_not_praised() {
    let page = html(&[outcome("bare", "1", vec![])], &about());
    assert!(page.contains("nothing was checked") && page.contains("no checks") && !page.contains("✓"));
}

#[test]
fn equal_outcomes_give_equal_pages() {
    assert_eq!(html(&mixed(), &about()), html(&mixed(), &about()));
}

#[test]
fn experiments_left_out_are_named() {
    let left_out = vec![LeftOut { slug: "brain".into(), needs: "reference/x.vtp".into() }];
    let page = html(&[], &About { left_out, ..about() });
    assert!(page.contains("does not come with tigereye: brain (<code>reference/x.vtp</code>)."), "{page}");
}
