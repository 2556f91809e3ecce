//! The result in short, and the list of all experiments.

use maud::{Markup, html};

use super::order::{natural, of_section};
use super::thesis::{figure_number, is_of_thesis};
use super::verdict::Tally;
use crate::links::place;
use crate::numbers::{count, counted, duration};
use crate::{About, ExperimentSummary, LeftOut, Summary};

/// Experiments by section, in the order of the source.
pub(super) type Sections<'a> = Vec<(&'a str, Vec<&'a ExperimentSummary>)>;

/// `outcomes` by section.
pub(super) fn by_section(outcomes: &[ExperimentSummary]) -> Sections<'_> {
    let mut sections = Sections::new();
    for outcome in outcomes {
        match sections.iter_mut().find(|(section, _)| *section == outcome.section) {
            Some((_, outcomes)) => outcomes.push(outcome),
            None => sections.push((&outcome.section, vec![outcome])),
        }
    }
    sections.sort_by(|(a, _), (b, _)| natural(a, b));
    sections.iter_mut().for_each(|(_, outcomes)| outcomes.sort_by(|a, b| of_section(a, b)));
    sections
}

/// Id of the section at position `index`. Two hyphens set the page's own ids apart from slugs.
pub(super) fn section_id(index: usize) -> String {
    format!("page--section-{}", index + 1)
}

/// How the run went: one sentence, its numbers, and what failed.
pub(super) fn result(summary: &Summary) -> Markup {
    let Summary { experiments: outcomes, about, seconds, .. } = summary;
    let tally = Tally::of(outcomes);
    html! {
        section.result.(tally.class()) aria-labelledby="page--result" {
            h2 #page--result { "Result" }
            p.headline { span aria-hidden="true" { (tally.sign()) " " } (headline(outcomes.len(), tally)) }
            dl.numbers {
                (entry("Experiments", html! { (count(outcomes.len() as u64)) }))
                (entry("Checks", html! { (count(tally.checks as u64)) }))
                (entry("Passed", html! { (count(tally.passed() as u64)) }))
                (entry("Failed", html! { (count(tally.failed as u64)) }))
                (entry("Time", html! { (duration(*seconds)) }))
                (entry("Version", html! { (about.version) }))
            }
            p.command { @if about.added < outcomes.len() { "Latest run, of " (counted(about.added, "experiment")) ": " } code { (about.command) } }
            p.setting { (setting(about, is_of_thesis(outcomes))) }
            (left_out(&about.left_out))
            (failures(outcomes))
        }
    }
}

fn entry(name: &str, value: Markup) -> Markup {
    html! { div { dt { (name) } dd { (value) } } }
}

fn headline(experiments: usize, tally: Tally) -> String {
    if experiments == 0 {
        return "No experiment was run, so nothing was checked.".into();
    }
    let verdict = if tally.checks == 0 { "nothing was checked".into() } else { tally.sentence() };
    format!("{}: {verdict}.", counted(experiments, "experiment"))
}

fn setting(about: &About, of_thesis: bool) -> String {
    let resolution = match (about.full, of_thesis) {
        (true, true) => "Run at the thesis’s own resolutions (--full)",
        (true, false) => "Run with --full",
        (false, true) => "Run at the default resolutions; --full runs the thesis’s own where they are larger",
        (false, false) => "Run without what is marked for --full only",
    };
    format!("{resolution}. {}; only the times depend on it.", counted(about.threads, "thread"))
}

/// What is not on the page.
fn left_out(left_out: &[LeftOut]) -> Markup {
    html! {
        @if !left_out.is_empty() {
            p.setting {
                "Not run, for want of data that does not come with tigereye: "
                @for (i, l) in left_out.iter().enumerate() {
                    @if i > 0 { ", " }
                    (l.slug) " (" code { (l.needs) } ")"
                }
                "."
            }
        }
    }
}

/// Every failed check with a link to its experiment.
fn failures(outcomes: &[ExperimentSummary]) -> Markup {
    let mut failed =
        outcomes.iter().flat_map(|o| o.checks.iter().filter(|c| !c.passed).map(move |c| (o, c))).peekable();
    html! {
        @if failed.peek().is_some() {
            ul.failures {
                @for (outcome, check) in failed {
                    li {
                        span.verdict.failed { span aria-hidden="true" { "✗ " } "failed" }
                        " " a href=(place(&outcome.slug)) { (outcome.title) } ": " (check.name)
                    }
                }
            }
        }
    }
}

/// The list of experiments, by section, with how each went.
pub(super) fn contents(sections: &Sections<'_>, of_thesis: bool) -> Markup {
    html! {
        nav.contents aria-labelledby="page--contents" {
            h2 #page--contents { "Contents" }
            ul.sections {
                @for (i, (section, outcomes)) in sections.iter().enumerate() {
                    li {
                        a.section href={ "#" (section_id(i)) } { (section) }
                        ul { @for outcome in outcomes { (line(outcome)) } }
                    }
                }
                @if of_thesis {
                    li { a.section href="#page--lines" { "Where the thesis draws tensor lines" } }
                }
                li { a.section href="#page--glossary" { "Glossary" } }
            }
        }
    }
}

fn line(outcome: &ExperimentSummary) -> Markup {
    let tally = Tally::of([outcome]);
    html! {
        li {
            span.verdict.(tally.class()) {
                span aria-hidden="true" title=(tally.sentence()) { (tally.sign()) }
                span.unseen { (tally.sentence()) ": " }
            }
            a href=(place(&outcome.slug)) {
                @if let Some(number) = figure_number(outcome) { span.figure-number { (number) } " " }
                (outcome.title)
            }
            @if tally.failed > 0 {
                span.failed-count aria-hidden="true" { (tally.failed) " of " (tally.checks) " failed" }
            }
        }
    }
}
