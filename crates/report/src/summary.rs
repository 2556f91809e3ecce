//! The summary for programs: `summary.json`.

use serde::{Serialize, Serializer};

use crate::links::path;
use crate::{CheckOutcome, Expected, ExperimentOutcome};

/// All outcomes as JSON, indented, keys in a fixed order.
///
/// `seconds` is the wall-clock time of the whole run. Paths are relative to the results folder, PNG before
/// SVG. The tolerance of a bound (`kind` is `at most` or `at least`) is 0 and its `expected` the bound.
/// Numbers that JSON does not have, NaN and the infinities, become `null`. A run of no experiment counts as
/// passed.
#[must_use]
pub fn summary_json(outcomes: &[ExperimentOutcome], seconds: f64) -> String {
    let passed = outcomes.iter().all(ExperimentOutcome::passed);
    let experiments = outcomes.iter().map(Experiment::of).collect();
    let summary = Summary { passed, seconds, experiments };
    serde_json::to_string_pretty(&summary).expect("strings, numbers and lists always have a JSON form") + "\n"
}

#[derive(Serialize)]
struct Summary<'a> {
    passed: bool,
    seconds: f64,
    experiments: Vec<Experiment<'a>>,
}

#[derive(Serialize)]
struct Experiment<'a> {
    slug: &'a str,
    title: &'a str,
    source: &'a str,
    seconds: f64,
    passed: bool,
    figures: Vec<String>,
    /// Those among them that draw seconds.
    timed_figures: Vec<String>,
    checks: Vec<Check<'a>>,
    command: &'a str,
    work: Work<'a>,
}

impl<'a> Experiment<'a> {
    fn of(outcome: &'a ExperimentOutcome) -> Self {
        let files =
            |name: &str| ["png", "svg"].map(|ending| path(&outcome.slug, &format!("{name}.{ending}")));
        Self {
            slug: &outcome.slug,
            title: &outcome.title,
            source: &outcome.source,
            seconds: outcome.seconds,
            passed: outcome.passed(),
            figures: outcome
                .figures
                .iter()
                .flat_map(|f| {
                    let moving = (f.frames > 0).then(|| path(&outcome.slug, &format!("{}.apng", f.name)));
                    files(&f.name).into_iter().chain(moving)
                })
                .collect(),
            timed_figures: outcome.figures.iter().filter(|f| f.timed).flat_map(|f| files(&f.name)).collect(),
            checks: outcome.checks.iter().map(Check::of).collect(),
            command: &outcome.command,
            work: Work(&outcome.work),
        }
    }
}

#[derive(Serialize)]
struct Check<'a> {
    name: &'a str,
    value: f64,
    expected: f64,
    tolerance: f64,
    passed: bool,
    kind: &'static str,
    basis: &'a str,
    /// Why there is no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'a str>,
}

impl<'a> Check<'a> {
    fn of(check: &'a CheckOutcome) -> Self {
        let (kind, expected, tolerance) = match check.expected {
            Expected::Near { value, tolerance } => ("near", value, tolerance),
            Expected::AtMost(bound) => ("at most", bound, 0.0),
            Expected::AtLeast(bound) => ("at least", bound, 0.0),
        };
        let CheckOutcome { name, value, passed, basis, reason, .. } = check;
        let reason = reason.as_deref();
        Self { name, value: *value, expected, tolerance, passed: *passed, kind, basis, reason }
    }
}

/// Counters as an object in the order given. JSON readers keep only one of two equal keys, so a repeated
/// label gets a number.
struct Work<'a>(&'a [(String, u64)]);

impl Serialize for Work<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().enumerate().map(|(i, (label, n))| {
            let earlier = self.0[..i].iter().filter(|(l, _)| l == label).count();
            (if earlier == 0 { label.clone() } else { format!("{label} ({})", earlier + 1) }, n)
        }))
    }
}
