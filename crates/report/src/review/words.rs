//! A review as a screenful of text and as JSON.

use super::{Entry, ExperimentReview, FigureReview, Kind, NumberReview, Review, State, Subject, Value};
use crate::numbers::counted;
use serde::Serialize;

/// Experiments that the text names.
const NAMED: usize = 12;

/// Checks that fail now and that the text names.
const FAILING: usize = 4;

/// Longest name in the text, characters.
const NAME: usize = 72;

/// What moved, in at most twenty-one lines: counts, checks that fail now, the experiments that moved most.
#[must_use]
pub fn text(review: &Review) -> String {
    let mut lines = vec![format!("{} -> {}, tolerance {:e}", review.base, review.head, review.tolerance)];
    lines.extend(counts(review));
    let failing: Vec<_> = review.failing().collect();
    lines.extend(failing.iter().take(FAILING).map(|(_, e, n)| {
        let expected = n.head.as_ref().and_then(|e| e.expected.as_ref());
        let expected = expected.map_or_else(String::new, |words| format!(", expected {}", clipped(words)));
        format!("  fails now: {}: {}{expected}", clipped(&e.slug), clipped(&n.name))
    }));
    if failing.len() > FAILING {
        lines.push(format!("  and {} more checks fail now", failing.len() - FAILING));
    }
    let moved: Vec<_> = review.experiments.iter().filter(|e| e.state != State::Unchanged).collect();
    for e in moved.iter().take(NAMED) {
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
    if moved.len() > NAMED {
        lines.push(format!("  and {} more", moved.len() - NAMED));
    }
    lines.join("\n") + "\n"
}

/// How many did what, in two sentences.
pub(super) fn counts(review: &Review) -> [String; 2] {
    let noun = review.subject.noun();
    let states = [State::Moved, State::Added, State::Gone, State::Unchanged];
    let states = states.map(|s| format!("{} {}", review.count(s), s.name())).join(", ");
    let of_kind = |kind| {
        let numbers = review.experiments.iter().flat_map(|e| &e.numbers);
        numbers.filter(|n| n.kind == kind).count()
    };
    let verdicts: usize = review.experiments.iter().map(ExperimentReview::verdicts_changed).sum();
    let figures: usize = review.experiments.iter().map(ExperimentReview::figures_moved).sum();
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
    base_expected: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    head_expected: Option<&'a str>,
}

impl<'a> Number<'a> {
    fn of(n: &'a NumberReview) -> Self {
        let value = |e: &'a Option<Entry>| e.as_ref().map(|e| Plain::of(&e.value));
        let passed = |e: &Option<Entry>| e.as_ref().and_then(|e| e.passed);
        let expected = |e: &'a Option<Entry>| e.as_ref().and_then(|e| e.expected.as_deref());
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
