//! The page as a whole.

use maud::{DOCTYPE, Markup, PreEscaped, html as markup};

use super::Pictures;
use super::contents::{Sections, by_section, contents, result, section_id};
use super::gallery::article;
use super::glossary::glossary;
use super::introduction::{about_tensor_lines, introduction};
use super::overview::{overview, shared, titles};
use super::thesis::is_of_thesis;
use super::verdict::Tally;
use crate::numbers::counted;
use crate::{ExperimentSummary, Summary};

const CLOSING: &str = "\
    All pictures and numbers were computed in this run; summary.json beside this page holds the same \
    results for programs.";

/// A folder of results as one page that needs no other file: style and pictures are inside.
///
/// Sections stand in the order of their names, numbers in them by size; in a section the figures of the thesis come
/// first, by their numbers, the others in the order given. Links
/// to the figures and data at full size are relative: the page belongs into the results folder.
#[must_use]
pub fn html(summary: &Summary, pictures: &Pictures<'_>) -> String {
    let outcomes = &summary.experiments;
    let sections = by_section(outcomes);
    let page = markup! {
        (DOCTYPE)
        html lang="en" {
            (head(outcomes))
            body {
                a.skip href="#page--contents" { "Skip to the contents" }
                (masthead(is_of_thesis(outcomes)))
                main {
                    (introduction())
                    (result(summary))
                    (contents(&sections, is_of_thesis(outcomes)))
                    (gallery(&sections, pictures))
                    @if is_of_thesis(outcomes) { (about_tensor_lines()) }
                    (glossary())
                }
                footer.page {
                    p { "Written by tigereye " (summary.about.version) ". " (CLOSING) }
                }
            }
        }
    };
    page.into_string()
}

fn head(outcomes: &[ExperimentSummary]) -> Markup {
    let tally = Tally::of(outcomes);
    markup! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta name="color-scheme" content="light dark";
            title { "tigereye: " (counted(outcomes.len(), "experiment")) ", " (tally.sentence()) }
            style { (PreEscaped(include_str!("../style.css"))) }
        }
    }
}

fn masthead(of_thesis: bool) -> Markup {
    markup! {
        header.page {
            h1 { "tigereye" }
            @if of_thesis {
                p {
                    "Light in tensor fields: the evaluations of the master’s thesis "
                    cite { "Light Transport Techniques for Tensor Field Visualization" }
                    " by Sebastian Bek (Heidelberg University), computed anew and checked"
                }
            } @else {
                p { "Light in tensor fields: experiments and their checks" }
            }
        }
    }
}

fn gallery(sections: &Sections<'_>, pictures: &Pictures<'_>) -> Markup {
    markup! {
        @for (i, (section, outcomes)) in sections.iter().enumerate() {
            section.experiments aria-labelledby=(section_id(i)) {
                h2 #(section_id(i)) { (section) }
                @let shared = shared(outcomes);
                (overview(&shared))
                @let titles = titles(&shared);
                @for outcome in outcomes { (article(outcome, &titles, pictures)) }
                p.back { a href="#page--contents" { "Back to the contents" } }
            }
        }
    }
}
