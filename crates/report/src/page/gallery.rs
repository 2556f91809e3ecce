//! One article for each experiment.

use maud::{Markup, html};

use super::Pictures;
use super::figures::figures;
use super::tables::tables;
use super::thesis::figure_number;
use super::verdict::{Tally, mark};
use super::words::words;
use crate::links::{address, path};
use crate::numbers::{count, counted, duration, file_size, looks_equal, number, number_with};
use crate::{CheckOutcome, DataSummary, Expected, ExperimentSummary};

/// Everything about one experiment. The tables with the titles `shared` stand beside others of their kind above.
pub(super) fn article(outcome: &ExperimentSummary, shared: &[&str], pictures: &Pictures<'_>) -> Markup {
    let tally = Tally::of([outcome]);
    let heading = format!("{}--title", outcome.slug);
    html! {
        article #(outcome.slug) aria-labelledby=(heading) {
            header {
                h3 #(heading) {
                    @if let Some(number) = figure_number(outcome) { span.figure-number { (number) } " " }
                    (outcome.title)
                }
                p.facts {
                    (tally.badge())
                    span { (words(&outcome.source)) }
                    span { (duration(outcome.seconds)) }
                }
            }
            @if !outcome.claim.is_empty() {
                blockquote.claim {
                    p.label { (if outcome.source.starts_with("Thesis") { "The thesis says" } else { "Claim examined" }) }
                    p { (words(&outcome.claim)) } }
            }
            @if !outcome.look_for.is_empty() {
                p.look-for { b { "What to look for. " } (words(&outcome.look_for)) }
            }
            (figures(&outcome.slug, &outcome.pictures, pictures))
            (tables(&outcome.tables, shared))
            (checks(&outcome.title, &outcome.checks))
            footer {
                p.again { "Run it again: " code { (outcome.command) } }
                (data(&outcome.slug, &outcome.data))
                (work(&outcome.work.0))
            }
        }
    }
}

/// The checks as a table, those that failed first.
fn checks(title: &str, checks: &[CheckOutcome]) -> Markup {
    let (passed, failed): (Vec<_>, Vec<_>) = checks.iter().partition(|c| c.passed);
    html! {
        @if !checks.is_empty() {
            // Without a tab stop the keyboard could not scroll it.
            div.scroll tabindex="0" role="region" aria-label={ "Checks of " (title) } {
                table {
                    thead {
                        tr {
                            th scope="col" { "Result" }
                            th scope="col" { "Check" }
                            th.number scope="col" { "This run" }
                            th.number scope="col" { "Expected" }
                            th.number scope="col" { "Tolerance" }
                            th scope="col" { "Basis" }
                        }
                    }
                    tbody { @for check in failed.into_iter().chain(passed) { (row(check)) } }
                }
            }
        }
    }
}

fn row(check: &CheckOutcome) -> Markup {
    html! {
        tr.failing[!check.passed] {
            td.mark {
                (mark(check))
                @if let Some(beyond) = check.excess().filter(|_| !check.passed) {
                    span.beyond { "by " (number(beyond)) }
                }
            }
            th scope="row" {
                (check.name)
                @if let Some(reason) = &check.reason { " " span.reason { "no value: " (reason) } }
            }
            td.number { (value(check)) }
            td.number { (expected(check.expected)) }
            td.number { (tolerance(check.expected)) }
            td.basis { (words(&check.basis)) }
        }
    }
}

/// The value, and how far it is from what was expected where the digits shown are the same.
fn value(check: &CheckOutcome) -> Markup {
    let off = match check.expected {
        Expected::Near { value, tolerance } if tolerance > 0.0 && looks_equal(value, check.value) => {
            Some(check.value - value)
        }
        _ => None,
    };
    html! {
        (number(check.value))
        @match off {
            Some(0.0) => span.beyond { "to the last digit" },
            Some(off) => span.beyond { "differs by " (number_with(off.abs(), 1)) },
            None => {},
        }
    }
}

fn expected(expected: Expected) -> Markup {
    match expected {
        Expected::Near { value, .. } => number(value),
        Expected::AtMost(bound) => html! { span.bound { "at most " } (number(bound)) },
        Expected::AtLeast(bound) => html! { span.bound { "at least " } (number(bound)) },
    }
}

fn tolerance(expected: Expected) -> Markup {
    match expected {
        Expected::Near { tolerance: 0.0, .. } => html! { "exact" },
        Expected::Near { tolerance, .. } => html! { "± " (number(tolerance)) },
        Expected::AtMost(_) | Expected::AtLeast(_) => {
            html! { span.bound { span aria-hidden="true" { "–" } span.unseen { "none" } } }
        }
    }
}

fn data(slug: &str, data: &[DataSummary]) -> Markup {
    html! {
        @if !data.is_empty() {
            p.data {
                "Data: "
                @for (i, file) in data.iter().enumerate() {
                    @if i > 0 { ", " }
                    a href=(address(&path(slug, &file.name))) { (file.name) }
                    " (" (file_size(file.bytes)) ")"
                }
            }
        }
    }
}

fn work(work: &[(String, u64)]) -> Markup {
    html! {
        @if !work.is_empty() {
            details {
                summary { "Work done: " (counted(work.len(), "counter")) }
                dl.work { @for (label, n) in work { div { dt { (label) } dd { (count(*n)) } } } }
            }
        }
    }
}
