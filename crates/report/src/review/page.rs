//! A review as one page: what moved in tables and pictures, nothing from outside.

use super::words::counts;
use super::{
    Entry, ExperimentReview, Failing, FigureReview, Kind, NOISE, NumberReview, Picture, Review, Side, State,
    Subject, Value,
};
use crate::Expected;
use crate::numbers::{counted, digits_apart, duration, number, number_with};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html as markup};

/// Digits of a change after the first one.
const CHANGE_DIGITS: usize = 1;

/// Forbids everything that is not on the page.
const POLICY: &str =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// A review as one page that needs no other file: style, script and pictures are inside.
///
/// Those that moved stand in the order of how much they did, the unchanged ones in a closed list at the end. Without
/// scripts, and in print, the pictures stand side by side.
#[must_use]
pub fn html(review: &Review) -> String {
    let (moved, unchanged): (Vec<_>, Vec<_>) =
        review.experiments.iter().partition(|e| e.state != State::Unchanged);
    let page = markup! {
        (DOCTYPE)
        html lang="en" {
            (head(review))
            body {
                (masthead(review))
                main {
                    (result(review))
                    @if !moved.is_empty() {
                        (contents(review, &moved))
                        section.experiments aria-labelledby="details" {
                            h2 #details { "Before and after" }
                            @for (i, e) in moved.iter().enumerate() { (article(review, i, e)) }
                        }
                    }
                    (list_of_unchanged(&unchanged))
                }
                footer.page {
                    p {
                        "Changes are relative to the larger of both values, or to " (number(NOISE))
                        " where both are smaller. A check whose tolerance is rounding has not moved within it. Seconds depend on the machine and never count."
                        @if review.subject == Subject::Results { " review.json beside this page holds the same for programs." }
                    }
                }
                script { (PreEscaped(include_str!("page.js"))) }
            }
        }
    };
    page.into_string()
}

fn head(review: &Review) -> Markup {
    markup! {
        head {
            meta charset="utf-8";
            meta http-equiv="Content-Security-Policy" content=(POLICY);
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta name="color-scheme" content="light dark";
            title { "tigereye review: " (headlines(review).join(", ")) }
            style { (PreEscaped(include_str!("../style.css"))) (PreEscaped(include_str!("page.css"))) }
        }
    }
}

/// What matters most: what fails now, if anything does, and how much moved.
fn headlines(review: &Review) -> Vec<String> {
    let moved = review.experiments.len() - review.count(State::Unchanged);
    let failing = match review.failing().count() {
        0 => None,
        1 => Some("1 check fails now".to_owned()),
        n => Some(format!("{} fail now", counted(n, "check"))),
    };
    let moved = match moved {
        0 => "nothing moved".to_owned(),
        n => format!("{n} of {} moved", counted(review.experiments.len(), review.subject.noun())),
    };
    failing.into_iter().chain([moved]).collect()
}

fn masthead(review: &Review) -> Markup {
    markup! {
        header.page {
            h1 { "What moved" }
            dl.sides {
                div { dt { (side(review, Side::Base)) } dd { code { (review.base) } } }
                div { dt { (side(review, Side::Head)) } dd { code { (review.head) } } }
                div { dt { "Tolerance" } dd { (number(review.tolerance)) ", relative" } }
            }
        }
    }
}

/// What a side is called.
const fn side(review: &Review, side: Side) -> &'static str {
    match (review.subject, side) {
        (Subject::Results, Side::Base) => "Before",
        (Subject::Results, Side::Head) => "After",
        (Subject::Snapshots { .. }, Side::Base) => "Accepted",
        (Subject::Snapshots { .. }, Side::Head) => "Pending",
    }
}

fn result(review: &Review) -> Markup {
    let moved = review.moved();
    let failing: Vec<_> = review.failing().collect();
    let class = match (failing.is_empty(), moved) {
        (false, _) => "failed",
        (true, true) => "moved",
        (true, false) => "passed",
    };
    let [states, numbers] = counts(review);
    markup! {
        section.result.(class) aria-labelledby="result" {
            h2 #result { "Result" }
            @for (i, line) in headlines(review).iter().enumerate() {
                @let fails = i == 0 && !failing.is_empty();
                p.headline {
                    span {
                        @if fails { span aria-hidden="true" { "✗ " } }
                        (line[..1].to_uppercase()) (line[1..]) "."
                    }
                }
                @if fails { (list_of_failing(review, &failing)) }
            }
            p { (states) ". " (numbers) "." }
        }
    }
}

/// Every check that fails now and did not before, by experiment, each with its place on the page.
fn list_of_failing(review: &Review, failing: &[Failing<'_>]) -> Markup {
    let value = |entry: &Option<Entry>| match entry.as_ref().map(|e| &e.value) {
        Some(Value::Number(x)) => number(*x),
        Some(Value::Words(words)) => markup! { (words) },
        None => markup! { "none" },
    };
    markup! {
        ul.failures {
            @for group in failing.chunk_by(|a, b| a.place[0] == b.place[0]) {
                li {
                    a href={ "#moved-" (group[0].place[0] + 1) } { (group[0].experiment.title) }
                    ul {
                        @for f in group {
                            li {
                                a href={ "#" (row_id(f.place)) } { (f.number.name) } ": "
                                (side(review, Side::Base).to_lowercase()) " " (value(&f.number.base)) ", "
                                (side(review, Side::Head).to_lowercase()) " " (value(&f.number.head))
                                @if let Some(expected) = f.number.head.as_ref().and_then(|e| e.expected) {
                                    ", expected " (expectation(expected))
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Id of a number's row.
fn row_id([experiment, number]: [usize; 2]) -> String {
    format!("moved-{}-{}", experiment + 1, number + 1)
}

/// What a check expects, never broken inside.
fn expectation(expected: Expected) -> Markup {
    let words = match expected {
        Expected::Near { value, tolerance: 0.0 } => markup! { "exactly " (number(value)) },
        Expected::Near { value, tolerance } => markup! { (number(value)) " ± " (number(tolerance)) },
        Expected::AtMost(bound) => markup! { "at most " (number(bound)) },
        Expected::AtLeast(bound) => markup! { "at least " (number(bound)) },
    };
    markup! { span.whole { (words) } }
}

/// The experiments that moved, with what moved most.
fn contents(review: &Review, moved: &[&ExperimentReview]) -> Markup {
    markup! {
        section.contents aria-labelledby="list" {
            h2 #list { "What moved most" }
            div.scroll tabindex="0" role="region" aria-label="What moved most" {
                table.moved-list {
                    thead {
                        tr {
                            th scope="col" { (if review.subject == Subject::Results { "Experiment" } else { "Snapshot" }) }
                            th scope="col" { "State" }
                            th.number scope="col" { "Largest relative change" }
                            th scope="col" { "Where" }
                        }
                    }
                    tbody {
                        @for (i, e) in moved.iter().enumerate() {
                            tr {
                                th scope="row" { a href={ "#moved-" (i + 1) } { (e.title) } }
                                td { (state(e)) }
                                td.number { (change(e.change)) }
                                td { (e.concern) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn state(e: &ExperimentReview) -> Markup {
    let verdicts = e.verdicts_changed();
    markup! {
        span.state.(e.state.name()) { (e.state.name()) }
        @if verdicts > 0 { ", " span.verdict.failed { (counted(verdicts, "verdict")) " changed" } }
    }
}

fn change(change: f64) -> Markup {
    if change.is_finite() {
        number_with(change, CHANGE_DIGITS)
    } else {
        markup! { span aria-hidden="true" { "–" } span.unseen { "no number" } }
    }
}

fn article(review: &Review, index: usize, e: &ExperimentReview) -> Markup {
    let id = format!("moved-{}", index + 1);
    let heading = format!("{id}--title");
    let seconds = |s: Option<f64>| s.map_or_else(|| "none".to_owned(), duration);
    let of_kind = |work: bool| {
        let numbers = e.numbers.iter().enumerate().map(|(k, n)| (row_id([index, k]), n));
        numbers.filter(|(_, n)| (n.kind == Kind::Work) == work).collect::<Vec<_>>()
    };
    let (moved, still): (Vec<_>, Vec<_>) = e.figures.iter().partition(|f| f.state != State::Unchanged);
    markup! {
        article #(id) aria-labelledby=(heading) {
            h3 #(heading) { (e.title) }
            p.facts {
                span { (state(e)) }
                @if e.title != e.slug { span { (e.slug) } }
                @if e.base_seconds.is_some() || e.head_seconds.is_some() {
                    span { "Time: " (seconds(e.base_seconds)) " → " (seconds(e.head_seconds)) }
                }
            }
            @for f in moved { (figure(review, e, f)) }
            @if !still.is_empty() {
                p.unchanged-figures {
                    "Unchanged figures: "
                    @for (i, f) in still.iter().enumerate() { @if i > 0 { ", " } (f.name) }
                }
            }
            (numbers(review, &e.title, &of_kind(false)))
            @let work = of_kind(true);
            @if !work.is_empty() {
                details {
                    summary { "Work: " (counted(work.len(), "counter")) " moved" }
                    (numbers(review, &format!("work of {}", e.title), &work))
                }
            }
            @if e.still > 0 {
                p.unchanged-figures { (counted(e.still, review.subject.number())) " within the tolerance" }
            }
        }
    }
}

fn figure(review: &Review, e: &ExperimentReview, f: &FigureReview) -> Markup {
    let alt = |side| match side {
        Side::Base => format!("Figure {} of {} before, in {}", f.name, e.slug, review.base),
        Side::Head => format!("Figure {} of {} after, in {}", f.name, e.slug, review.head),
    };
    let shown = |picture: &Picture, at: Side| {
        markup! {
            figure {
                (image(&picture.png, picture.size, &alt(at)))
                figcaption { (side(review, at)) ": " (review_side(review, at)) }
            }
        }
    };
    markup! {
        div.figure {
            @match (&f.base, &f.head, &f.difference) {
                (Some(base), Some(head), Some(d)) => {
                    @let share = 100.0 * d.differing as f64 / d.pixels.max(1) as f64;
                    p {
                        b { "Figure " (f.name) ": " }
                        (counted(usize::try_from(d.differing).unwrap_or(usize::MAX), "pixel"))
                        " of " (crate::numbers::count(d.pixels)) " differ"
                        @if d.differing == 1 { "s" }
                        " (" (number_with(share, 2)) " %), by " (d.largest) " of 255 at most"
                        @if let Some([before, after]) = f.sizes {
                            "; the size is another one, " (size(before)) " → " (size(after))
                            " pixels, and both stand in the upper left corner of white"
                        }
                    }
                    div.beside.pair.wide[base.size[0] > 2 * base.size[1]] {
                        div.slider {
                            div.stack.beside { (shown(base, Side::Base)) (shown(head, Side::Head)) }
                            div.bar {
                                input #(input_id(e, f)) type="range" min="0" max="100" step="1" value="50";
                                span aria-hidden="true" { (side(review, Side::Base)) }
                                label for=(input_id(e, f)) {
                                    "Divider: left of it " (side(review, Side::Base).to_lowercase())
                                    ", right of it " (side(review, Side::Head).to_lowercase())
                                    " (figure " (f.name) span.unseen { " of " (e.slug) } ")"
                                }
                                span aria-hidden="true" { (side(review, Side::Head)) }
                            }
                        }
                        figure {
                            (image(&d.map, base.size, &format!(
                                "Map of the {} pixels in which figure {} of {} differs", d.differing, f.name, e.slug
                            )))
                            figcaption {
                                "Difference: " span.legend aria-hidden="true" {} " red, amplified so that " (d.largest)
                                " of 255 is full red, on the faded figure"
                            }
                        }
                    }
                },
                (base, head, _) => {
                    p { b { "Figure " (f.name) ": " } span.state.(f.state.name()) { (f.state.name()) } }
                    div.beside {
                        @if let Some(base) = base { (shown(base, Side::Base)) }
                        @if let Some(head) = head { (shown(head, Side::Head)) }
                    }
                },
            }
        }
    }
}

fn review_side(review: &Review, side: Side) -> &str {
    match side {
        Side::Base => &review.base,
        Side::Head => &review.head,
    }
}

/// An id that no other figure has: slugs and names have neither colon.
fn input_id(e: &ExperimentReview, f: &FigureReview) -> String {
    let plain = |text: &str| text.bytes().map(|b| format!("{b:02x}")).collect::<String>();
    format!("divider-{}-{}", plain(&e.slug), plain(&f.name))
}

fn size([width, height]: [u32; 2]) -> String {
    format!("{width} × {height}")
}

fn image(png: &[u8], [width, height]: [u32; 2], alt: &str) -> Markup {
    markup! {
        div.plate {
            img src={ "data:image/png;base64," (STANDARD.encode(png)) } alt=(alt) width=(width) height=(height)
                style={ "--width:" (width) "px" };
        }
    }
}

/// The numbers that moved.
fn numbers(review: &Review, title: &str, numbers: &[(String, &NumberReview)]) -> Markup {
    let has = |what: fn(&Entry) -> bool| {
        numbers.iter().any(|(_, n)| [&n.base, &n.head].into_iter().flatten().any(what))
    };
    let checks = numbers.iter().any(|(_, n)| n.kind == Kind::Check);
    let (verdicts, expected) = (has(|e| e.passed.is_some()), has(|e| e.expected.is_some()));
    let what = match (checks, review.subject) {
        (true, _) => "Check",
        (_, Subject::Snapshots { .. }) => "Line",
        _ => "Counter",
    };
    markup! {
        @if !numbers.is_empty() {
            div.scroll tabindex="0" role="region" aria-label={ "What moved: " (title) } {
                table {
                    thead {
                        tr {
                            th scope="col" { (what) }
                            th.number scope="col" { (side(review, Side::Base)) }
                            th.number scope="col" { (side(review, Side::Head)) }
                            th.number scope="col" { "Relative change" }
                            @if verdicts { th scope="col" { "Verdict" } }
                            @if expected { th scope="col" { "Expected" } }
                        }
                    }
                    tbody { @for (id, n) in numbers { (row(id, n, verdicts, expected)) } }
                }
            }
        }
    }
}

fn row(id: &str, n: &NumberReview, verdicts: bool, expected: bool) -> Markup {
    let digits = match (&n.base, &n.head) {
        (Some(Entry { value: Value::Number(a), .. }), Some(Entry { value: Value::Number(b), .. })) => {
            digits_apart(*a, *b)
        }
        _ => digits_apart(0.0, 0.0),
    };
    let there = |state: State| markup! { span.state.(state.name()) { (state.name()) } };
    markup! {
        tr.failing[n.fails_now()] #(id) {
            th scope="row" { (n.name) }
            (cell(n.base.as_ref(), digits))
            (cell(n.head.as_ref(), digits))
            td.number {
                @match n.state {
                    State::Added | State::Gone => (there(n.state)),
                    _ => (change(n.change)),
                }
            }
            @if verdicts { td { (both(n, |e| e.passed.map(verdict))) } }
            @if expected { td { (both(n, |e| e.expected.map(expectation))) } }
        }
    }
}

fn cell(entry: Option<&Entry>, digits: usize) -> Markup {
    match entry.map(|e| &e.value) {
        None => markup! { td.number { span aria-hidden="true" { "–" } span.unseen { "none" } } },
        Some(Value::Number(x)) => markup! { td.number { (number_with(*x, digits)) } },
        Some(Value::Words(words)) => markup! { td.words { (words) } },
    }
}

fn verdict(passed: bool) -> Markup {
    let (class, sign) = if passed { ("passed", "✓") } else { ("failed", "✗") };
    markup! { span.verdict.(class) { span aria-hidden="true" { (sign) " " } (class) } }
}

/// What both sides say, once where they say the same.
fn both(n: &NumberReview, what: impl Fn(&Entry) -> Option<Markup>) -> Markup {
    let [base, head] = [&n.base, &n.head].map(|e| e.as_ref().and_then(&what).map(PreEscaped::into_string));
    let plain = |html: &Option<String>| html.as_ref().map(|h| PreEscaped(h.clone())).unwrap_or_default();
    if base.is_none() || head.is_none() || base == head {
        return plain(&head.or(base));
    }
    markup! { (plain(&base)) " " span.arrow { "→" } " " (plain(&head)) }
}

fn list_of_unchanged(unchanged: &[&ExperimentReview]) -> Markup {
    markup! {
        @if !unchanged.is_empty() {
            section.note aria-labelledby="unchanged" {
                h2 #unchanged { "Unchanged" }
                details {
                    summary { (unchanged.len()) " without movement beyond the tolerance" }
                    ul {
                        @for e in unchanged {
                            li {
                                (e.title)
                                @if e.title != e.slug { " (" (e.slug) ")" }
                                ": " (counted(e.still, "number")) ", " (counted(e.figures.len(), "figure"))
                                @if e.change > 0.0 { ", largest change " (change(e.change)) }
                            }
                        }
                    }
                }
            }
        }
    }
}
