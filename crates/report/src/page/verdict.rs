//! Whether something passed: in words and signs, never by colour alone.

use maud::{Markup, html};

use crate::{CheckOutcome, ExperimentSummary};

/// Number of checks and how many of them failed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tally {
    pub(super) checks: usize,
    pub(super) failed: usize,
}

impl Tally {
    /// Of all checks of `outcomes`.
    pub(super) fn of<'a>(outcomes: impl IntoIterator<Item = &'a ExperimentSummary>) -> Self {
        let checks = outcomes.into_iter().flat_map(|o| &o.checks);
        checks.fold(Self::default(), |t, c| Self {
            checks: t.checks + 1,
            failed: t.failed + usize::from(!c.passed),
        })
    }

    /// Number of checks that passed.
    pub(super) fn passed(self) -> usize {
        self.checks - self.failed
    }

    /// Class that colours the verdict.
    pub(super) fn class(self) -> &'static str {
        match self {
            Self { checks: 0, .. } => "none",
            Self { failed: 0, .. } => "passed",
            _ => "failed",
        }
    }

    /// Sign of the verdict.
    pub(super) fn sign(self) -> &'static str {
        match self.class() {
            "none" => "–",
            "passed" => "✓",
            _ => "✗",
        }
    }

    /// The verdict in words.
    pub(super) fn sentence(self) -> String {
        match self {
            Self { checks: 0, .. } => "no checks".into(),
            Self { checks: 1, failed: 0 } => "1 check passed".into(),
            Self { checks: 1, .. } => "1 check failed".into(),
            Self { checks, failed: 0 } => format!("{checks} of {checks} checks passed"),
            Self { checks, failed } => format!("{failed} of {checks} checks failed"),
        }
    }

    /// Sign and words.
    pub(super) fn badge(self) -> Markup {
        html! {
            span.verdict.(self.class()) { span aria-hidden="true" { (self.sign()) " " } (self.sentence()) }
        }
    }
}

/// Sign and word for one check.
pub(super) fn mark(check: &CheckOutcome) -> Markup {
    let (class, sign) = if check.passed { ("passed", "✓") } else { ("failed", "✗") };
    html! { span.verdict.(class) { span aria-hidden="true" { (sign) " " } (class) } }
}
