//! A review as a screenful of text and as JSON.

use super::{Entry, ExperimentReview, FigureReview, Kind, NumberReview, Review, State, Subject, Value};
use crate::numbers::{counted, plain};
use serde::Serialize;

/// Experiments that the text names, where no check fails now.
const NAMED: usize = 12;

/// Experiments that the text names below checks that fail now.
const NAMED_BELOW: usize = 6;

/// Checks that fail now and that the text names.
const FAILING: usize = 10;

/// Longest name in the text, characters.
const NAME: usize = 72;

/// What moved, in at most two dozen lines: checks that fail now, counts, the experiments that moved most.
#[must_use]
pub fn text(review: &Review) -> String {
    let mut lines = vec![format!("{} -> {}, tolerance {:e}", review.base, review.head, review.tolerance)];
    let failing: Vec<_> = review.failing().collect();
    match failing.len() {
        0 => {}
        1 => lines.push("1 check FAILS now:".to_owned()),
        n => lines.push(format!("{n} checks FAIL now:")),
    }
    lines.extend(failing.iter().take(FAILING).map(|f| {
        let expected = f.number.head.as_ref().and_then(|e| e.expected);
        let expected = expected.map_or_else(String::new, |e| format!(", expected {}", e.words()));
        let value = |e: &Option<Entry>| match e.as_ref().map(|e| &e.value) {
            Some(Value::Number(x)) => plain(*x),
            Some(Value::Words(words)) => clipped(words),
            None => "none".to_owned(),
        };
        let (name, base, head) = (clipped(&f.number.name), value(&f.number.base), value(&f.number.head));
        format!("  {}: {name}: {base} -> {head}{expected}", clipped(&f.experiment.slug))
    }));
    if failing.len() > FAILING {
        lines.push(format!("  and {} more, all on the page", failing.len() - FAILING));
    }
    lines.extend(counts(review));
    let moved: Vec<_> = review.experiments.iter().filter(|e| e.state != State::Unchanged).collect();
    let named = if failing.is_empty() { NAMED } else { NAMED_BELOW };
    for e in moved.iter().take(named) {
        let verdicts = match e.verdicts_changed() {
            0 => String::new(),
            n => format!(", {} changed", counted(n, "verdict")),
        };
        let change = match e.state {
            State::Added | State::Gone => e.state.name().to_owned(),
            _ => format!("{}{}{verdicts}", change_words(e.change), clipped(&e.concern)),
        };
        lines.push(format!("  {}  {change}", clipped(&e.slug)));
    }
    if moved.len() > named {
        lines.push(format!("  and {} more", moved.len() - named));
    }
    lines.join("\n") + "\n"
}

/// How many did what, in two sentences.
pub(super) fn counts(review: &Review) -> [String; 2] {
    let noun = review.subject.noun();
    let states = [State::Moved, State::Added, State::Gone, State::Unchanged];
    let states = states.map(|s| format!("{} {}", review.count(s), s.name())).join(", ");
    // Those of experiments that came or went as a whole count as these.
    let there = || review.experiments.iter().filter(|e| !matches!(e.state, State::Added | State::Gone));
    let of_kind = |kind| there().flat_map(|e| &e.numbers).filter(|n| n.kind == kind).count();
    let verdicts: usize = there().map(ExperimentReview::verdicts_changed).sum();
    let figures: usize = there().map(ExperimentReview::figures_moved).sum();
    let verdicts = counted(verdicts, "verdict");
    match review.subject {
        Subject::Results => [
            format!("{}: {states}", counted(review.experiments.len(), noun)),
            format!(
                "{} moved, {verdicts} changed, {} moved, {} moved",
                counted(of_kind(Kind::Check), "check"),
                counted(figures, "figure"),
                counted(of_kind(Kind::Work), "work counter")
            ),
        ],
        Subject::Snapshots { settled } => [
            format!(
                "{} pending: {states}; {} without",
                counted(review.experiments.len(), noun),
                counted(settled, noun)
            ),
            format!("{} moved, {verdicts} changed", counted(of_kind(Kind::Line), "line")),
        ],
    }
}

/// A change for people who read plain text, with two blanks; nothing where no number says it.
fn change_words(change: f64) -> String {
    if change.is_finite() { format!("{change:.1e}  ") } else { String::new() }
}

fn clipped(name: &str) -> String {
    match name.char_indices().nth(NAME) {
        Some((end, _)) => format!("{}...", &name[..end]),
        None => name.to_owned(),
    }
}

/// A review as JSON, indented, keys in a fixed order.
///
/// `numbers` holds the checks (of snapshots the lines) that moved and `work` the counters that did; all figures are
/// there. A side that is not there is `null`, as are numbers that JSON does not have and changes that no number says:
/// added, gone, other words, not a number, another size.
#[must_use]
pub fn json(review: &Review) -> String {
    let experiments = review.experiments.iter().map(Experiment::of).collect();
    let Review { base, head, tolerance, .. } = review;
    let summary = Summary { base, head, tolerance: *tolerance, moved: review.moved(), experiments };
    serde_json::to_string_pretty(&summary).expect("strings, numbers and lists always have a JSON form") + "\n"
}

#[derive(Serialize)]
struct Summary<'a> {
    base: &'a str,
    head: &'a str,
    tolerance: f64,
    moved: bool,
    experiments: Vec<Experiment<'a>>,
}

#[derive(Serialize)]
struct Experiment<'a> {
    slug: &'a str,
    state: &'static str,
    largest_change: f64,
    numbers: Vec<Number<'a>>,
    work: Vec<Number<'a>>,
    figures: Vec<Figure<'a>>,
    base_seconds: Option<f64>,
    head_seconds: Option<f64>,
}

impl<'a> Experiment<'a> {
    fn of(e: &'a ExperimentReview) -> Self {
        let (work, numbers) = e.numbers.iter().partition::<Vec<_>, _>(|n| n.kind == Kind::Work);
        let listed = |numbers: Vec<&'a NumberReview>| numbers.into_iter().map(Number::of).collect();
        Self {
            slug: &e.slug,
            state: e.state.name(),
            largest_change: e.change,
            numbers: listed(numbers),
            work: listed(work),
            figures: e.figures.iter().map(Figure::of).collect(),
            base_seconds: e.base_seconds,
            head_seconds: e.head_seconds,
        }
    }
}

#[derive(Serialize)]
struct Number<'a> {
    name: &'a str,
    base: Option<Plain<'a>>,
    head: Option<Plain<'a>>,
    relative_change: f64,
    base_passed: Option<bool>,
    head_passed: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    base_expected: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    head_expected: Option<String>,
}

impl<'a> Number<'a> {
    fn of(n: &'a NumberReview) -> Self {
        let value = |e: &'a Option<Entry>| e.as_ref().map(|e| Plain::of(&e.value));
        let passed = |e: &Option<Entry>| e.as_ref().and_then(|e| e.passed);
        let expected = |e: &Option<Entry>| e.as_ref().and_then(|e| e.expected).map(|e| e.words());
        Self {
            name: &n.name,
            base: value(&n.base),
            head: value(&n.head),
            relative_change: n.change,
            base_passed: passed(&n.base),
            head_passed: passed(&n.head),
            base_expected: expected(&n.base),
            head_expected: expected(&n.head),
        }
    }
}

/// A number or words as such.
#[derive(Serialize)]
#[serde(untagged)]
enum Plain<'a> {
    Number(f64),
    Words(&'a str),
}

impl<'a> Plain<'a> {
    fn of(value: &'a Value) -> Self {
        match value {
            Value::Number(x) => Self::Number(*x),
            Value::Words(words) => Self::Words(words),
        }
    }
}

#[derive(Serialize)]
struct Figure<'a> {
    name: &'a str,
    state: &'static str,
    pixels_differing: Option<u64>,
    largest_difference: Option<u8>,
}

impl<'a> Figure<'a> {
    fn of(f: &'a FigureReview) -> Self {
        let same = f.state == State::Unchanged;
        Self {
            name: &f.name,
            state: f.state.name(),
            pixels_differing: f.difference.as_ref().map(|d| d.differing).or(same.then_some(0)),
            largest_difference: f.difference.as_ref().map(|d| d.largest).or(same.then_some(0)),
        }
    }
}
