//! What a change moved: two results, or snapshots and their pending successors, beside each other.
//!
//! Data in, text out. [`read()`] takes a `summary.json`, [`results`] compares two of them, [`snapshots`] compares files
//! of insta; of a [`Review`] are made one page, one JSON object and a screenful of text. Files are untrusted: sizes are
//! bounded, and a fault names the file and the key.

mod compare;
mod error;
mod page;
mod picture;
mod snapshot;
#[cfg(test)]
mod tests;
mod words;

pub use crate::limits::MAX_FILE;
pub use compare::{ReadFigure, Results, read, results};
pub use error::ReviewError;
pub use page::html;
pub use snapshot::{Pending, snapshots};
pub use words::{json, text};

use crate::Expected;
use picture::Picture;

/// Below this magnitude values are rounding noise, as in snapshots: their changes are relative to it.
const NOISE: f64 = 1e-9;

/// A check that accepts no more than this, relative to what it expects, says that its value is exact but for rounding:
/// within what it accepts, nothing has moved.
const ROUNDING: f64 = 1e-8;

/// One of the two things that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// What was before.
    Base,
    /// What is now.
    Head,
}

/// What moved.
#[derive(Clone, Debug)]
pub struct Review {
    base: String,
    head: String,
    tolerance: f64,
    subject: Subject,
    /// Those that moved most come first.
    experiments: Vec<ExperimentReview>,
}

impl Review {
    /// Whether anything moved beyond the tolerance.
    #[must_use]
    pub fn moved(&self) -> bool {
        self.experiments.iter().any(|e| e.state != State::Unchanged)
    }

    fn new(
        [base, head]: [&str; 2],
        tolerance: f64,
        subject: Subject,
        mut experiments: Vec<ExperimentReview>,
    ) -> Self {
        experiments.sort_by(|a, b| {
            let by_change = b.change.total_cmp(&a.change).then_with(|| a.slug.cmp(&b.slug));
            b.attention().cmp(&a.attention()).then(by_change)
        });
        Self { base: base.to_owned(), head: head.to_owned(), tolerance, subject, experiments }
    }

    /// Checks that fail now and did not before, with the places of their experiment and their own.
    fn failing(&self) -> impl Iterator<Item = Failing<'_>> {
        let all = self.experiments.iter().enumerate();
        let numbers = all.flat_map(|(i, experiment)| {
            let numbers = experiment.numbers.iter().enumerate();
            numbers.map(move |(k, number)| Failing { place: [i, k], experiment, number })
        });
        numbers.filter(|f| f.number.fails_now())
    }

    /// Number of experiments in a state.
    fn count(&self, state: State) -> usize {
        self.experiments.iter().filter(|e| e.state == state).count()
    }
}

/// A check that fails now.
#[derive(Clone, Copy)]
struct Failing<'a> {
    /// Index of the experiment, and of the number in it.
    place: [usize; 2],
    experiment: &'a ExperimentReview,
    number: &'a NumberReview,
}

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Subject {
    /// Experiments of two results.
    Results,
    /// Snapshots; so many accepted ones have no pending successor.
    Snapshots { settled: usize },
}

impl Subject {
    /// What one of them is called.
    const fn noun(self) -> &'static str {
        match self {
            Self::Results => "experiment",
            Self::Snapshots { .. } => "snapshot",
        }
    }

    /// What one of its numbers is called.
    const fn number(self) -> &'static str {
        match self {
            Self::Results => "number",
            Self::Snapshots { .. } => "line",
        }
    }
}

/// Outcome of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Unchanged,
    Moved,
    Added,
    Gone,
}

impl State {
    const fn name(self) -> &'static str {
        match self {
            Self::Unchanged => "unchanged",
            Self::Moved => "moved",
            Self::Added => "added",
            Self::Gone => "gone",
        }
    }

    /// By presence before and after; `moved` decides where it is there both times.
    const fn of(base: bool, head: bool, moved: bool) -> Self {
        match (base, head) {
            (false, _) => Self::Added,
            (_, false) => Self::Gone,
            _ if moved => Self::Moved,
            _ => Self::Unchanged,
        }
    }
}

/// An experiment, or a snapshot, before and after.
#[derive(Clone, Debug)]
struct ExperimentReview {
    slug: String,
    title: String,
    state: State,
    /// Checks, counters of work or lines that moved.
    numbers: Vec<NumberReview>,
    /// How many did not.
    still: usize,
    figures: Vec<FigureReview>,
    /// Largest relative change of a check or figure, or, where none of them moved, of a counter. Infinite where no
    /// number can say it: added, gone, other words, not a number, another size.
    change: f64,
    /// What changed so much.
    concern: String,
    base_seconds: Option<f64>,
    head_seconds: Option<f64>,
}

impl ExperimentReview {
    fn new(slug: &str, title: &str, [base, head]: [bool; 2], numbers: Vec<NumberReview>) -> Self {
        let (moved, still): (Vec<_>, Vec<_>) = numbers.into_iter().partition(|n| n.state != State::Unchanged);
        let change = still.iter().map(|n| n.change).fold(0.0, f64::max);
        let state = State::of(base, head, !moved.is_empty());
        Self {
            slug: slug.to_owned(),
            title: title.to_owned(),
            state,
            numbers: moved,
            still: still.len(),
            figures: Vec::new(),
            change,
            concern: String::new(),
            base_seconds: None,
            head_seconds: None,
        }
        .with_figures(Vec::new())
    }

    /// Adds the figures, and finds out again what changed most.
    fn with_figures(mut self, figures: Vec<FigureReview>) -> Self {
        self.figures = figures;
        let moved = self.figures.iter().filter(|f| f.state != State::Unchanged);
        let figures = moved.map(|f| (f.change, format!("figure {} ({})", f.name, f.reason())));
        let of_kind = |work: bool| {
            let numbers = self.numbers.iter().filter(move |n| (n.kind == Kind::Work) == work);
            numbers.map(|n| (n.change, format!("{} {}{}", n.kind.name(), n.name, n.reason())))
        };
        // The first of several equal ones.
        let most = |all: &mut dyn Iterator<Item = (f64, String)>| {
            all.reduce(|most, next| if next.0 > most.0 { next } else { most })
        };
        if let Some((change, concern)) =
            most(&mut of_kind(false).chain(figures)).or_else(|| most(&mut of_kind(true)))
        {
            (self.change, self.concern) = (change, concern);
        }
        if self.state == State::Unchanged && self.figures.iter().any(|f| f.state != State::Unchanged) {
            self.state = State::Moved;
        }
        if matches!(self.state, State::Added | State::Gone) {
            self.change = f64::INFINITY;
            self.concern = "as a whole".to_owned();
        }
        self
    }

    /// Whose verdicts changed comes first, whose work alone moved last of those that moved.
    fn attention(&self) -> u8 {
        match self.state {
            State::Unchanged => 0,
            State::Moved if self.verdicts_changed() > 0 => 3,
            State::Moved
                if self.figures_moved() == 0 && self.numbers.iter().all(|n| n.kind == Kind::Work) =>
            {
                1
            }
            _ => 2,
        }
    }

    fn verdicts_changed(&self) -> usize {
        self.numbers.iter().filter(|n| n.verdict_changed()).count()
    }

    fn figures_moved(&self) -> usize {
        self.figures.iter().filter(|f| f.state != State::Unchanged).count()
    }
}

/// What a number is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Check,
    Work,
    Line,
}

impl Kind {
    const fn name(self) -> &'static str {
        match self {
            Self::Check => "check",
            Self::Work => "work",
            Self::Line => "line",
        }
    }
}

/// A value of one side.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    Number(f64),
    Words(String),
}

impl Value {
    /// Difference over the larger magnitude, or over [`NOISE`] where both are smaller; infinite where no number can say
    /// it.
    fn change(&self, other: &Self) -> f64 {
        match (self, other) {
            (Self::Words(a), Self::Words(b)) if a == b => 0.0,
            (Self::Number(a), Self::Number(b)) if a == b || (a.is_nan() && b.is_nan()) => 0.0,
            (Self::Number(a), Self::Number(b)) => {
                // Halves, so that the difference of the largest numbers is one too.
                let change = 2.0 * ((b / 2.0 - a / 2.0).abs() / a.abs().max(b.abs()).max(NOISE));
                if change.is_nan() { f64::INFINITY } else { change }
            }
            _ => f64::INFINITY,
        }
    }
}

/// What one side says of a check, a counter or a line.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    value: Value,
    passed: Option<bool>,
    /// What a check expects.
    expected: Option<Expected>,
}

impl Entry {
    const fn bare(value: Value) -> Self {
        Self { value, passed: None, expected: None }
    }

    /// The difference that is rounding, by the check's own expectation; none where it accepts more than that.
    fn rounding(&self) -> Option<f64> {
        match self.expected? {
            Expected::Near { value, tolerance } => {
                Some(tolerance).filter(|t| *t <= ROUNDING * value.abs().max(1.0))
            }
            Expected::AtMost(bound) => Some(bound).filter(|b| (0.0..=ROUNDING).contains(b)),
            Expected::AtLeast(_) => None,
        }
    }

    /// Whether this is the other one but for rounding.
    fn is_rounding_of(&self, other: &Self) -> bool {
        match (&self.value, &other.value, self.rounding()) {
            (Value::Number(a), Value::Number(b), Some(rounding)) => {
                (self.passed, self.expected) == (other.passed, other.expected) && (a - b).abs() <= rounding
            }
            _ => false,
        }
    }
}

/// A check, counter or line before and after.
#[derive(Clone, Debug)]
struct NumberReview {
    name: String,
    kind: Kind,
    base: Option<Entry>,
    head: Option<Entry>,
    change: f64,
    state: State,
}

impl NumberReview {
    fn new(name: String, kind: Kind, base: Option<Entry>, head: Option<Entry>, tolerance: f64) -> Self {
        let (change, moved) = match (&base, &head) {
            (Some(a), Some(b)) if a.is_rounding_of(b) => (0.0, false),
            (Some(a), Some(b)) => {
                let change = a.value.change(&b.value);
                (change, change > tolerance || a.passed != b.passed || a.expected != b.expected)
            }
            _ => (f64::INFINITY, true),
        };
        let state = State::of(base.is_some(), head.is_some(), moved);
        Self { name, kind, base, head, change, state }
    }

    /// Why the change cannot be quantified.
    fn reason(&self) -> &'static str {
        let numbers = [&self.base, &self.head].into_iter().flatten();
        match self.state {
            State::Added => ", added",
            State::Gone => ", gone",
            _ if self.change.is_finite() => "",
            _ if numbers.clone().any(|e| matches!(e.value, Value::Words(_))) => ", other words",
            _ => ", not a number",
        }
    }

    /// Whether it fails and did not fail before.
    fn fails_now(&self) -> bool {
        let verdict = |e: &Option<Entry>| e.as_ref().and_then(|e| e.passed);
        verdict(&self.head) == Some(false) && verdict(&self.base) != Some(false)
    }

    fn verdict_changed(&self) -> bool {
        let verdict = |e: &Option<Entry>| e.as_ref().and_then(|e| e.passed);
        verdict(&self.base).is_some_and(|a| verdict(&self.head).is_some_and(|b| a != b))
    }
}

/// A figure before and after.
#[derive(Clone, Debug)]
struct FigureReview {
    /// Path without the experiment's folder and the extension.
    name: String,
    state: State,
    /// Mean difference of a pixel over the full range; infinite where one is missing.
    change: f64,
    /// Where the pictures differ; none where one is missing.
    difference: Option<picture::Difference>,
    /// Their sizes, where these differ: both are drawn on white of the larger width and height.
    sizes: Option<[[u32; 2]; 2]>,
    /// The pictures, kept where they differ.
    base: Option<Picture>,
    head: Option<Picture>,
}

impl FigureReview {
    /// What its change is, or why it cannot be quantified.
    const fn reason(&self) -> &'static str {
        match self.state {
            State::Added => "added",
            State::Gone => "gone",
            _ => "mean difference of its pixels",
        }
    }
}
