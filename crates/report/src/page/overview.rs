//! Tables that several experiments of a section have in common, side by side.

use maud::{Markup, html};

use super::tables::table_of;
use crate::links::place;
use crate::{ExperimentSummary, Table};

/// Fewer experiments need no overview.
const LEAST: usize = 3;

/// The tables of the same title and columns in three experiments or more, their rows below each other.
pub(super) fn overview(shared: &[Vec<Part<'_>>]) -> Markup {
    html! {
        @if !shared.is_empty() {
            div.overview {
                h3 { "Side by side" }
                @for parts in shared { (joined(parts)) }
            }
        }
    }
}

/// An experiment with one of its tables.
pub(super) type Part<'a> = (&'a ExperimentSummary, &'a Table);

/// Titles of the tables that stand side by side.
pub(super) fn titles<'a>(shared: &[Vec<Part<'a>>]) -> Vec<&'a str> {
    shared.iter().filter_map(|parts| Some(parts.first()?.1.title.as_str())).collect()
}

/// The tables that experiments have in common.
pub(super) fn shared<'a>(outcomes: &[&'a ExperimentSummary]) -> Vec<Vec<Part<'a>>> {
    let mut found: Vec<Vec<Part<'a>>> = Vec::new();
    for outcome in outcomes {
        for table in outcome.tables.iter().filter(|t| !t.rows.is_empty()) {
            let like = |(_, t): &Part<'_>| t.title == table.title && t.columns == table.columns;
            match found.iter_mut().find(|parts| parts.first().is_some_and(like)) {
                Some(parts) => parts.push((outcome, table)),
                None => found.push(vec![(outcome, table)]),
            }
        }
    }
    found.retain(|parts| parts.len() >= LEAST);
    found
}

fn joined(parts: &[Part<'_>]) -> Markup {
    let Some((_, first)) = parts.first() else { return html! {} };
    let titles: Vec<&str> = parts.iter().map(|(outcome, _)| outcome.title.as_str()).collect();
    let common = common_words(&titles);
    let title = format!("{}, all {} experiments", first.title, parts.len());
    let rows = parts.iter().flat_map(|(outcome, table)| {
        table.rows.iter().map(move |(name, entries)| {
            let head = html! {
                a href=(place(&outcome.slug)) { (&outcome.title[common..]) }
                @if table.rows.len() > 1 { ", " (name) }
            };
            (head, &entries[..])
        })
    });
    table_of(&title, &first.caption, &first.columns, &rows.collect::<Vec<_>>())
}

/// Bytes of the words that all titles begin with; none where a title would be left empty.
fn common_words(titles: &[&str]) -> usize {
    let Some((first, others)) = titles.split_first() else { return 0 };
    let ends = first.char_indices().filter(|(_, c)| *c == ' ').map(|(i, _)| i + 1);
    let is_common = |end: &usize| {
        others.iter().all(|t| t.len() > *end && t.as_bytes()[..*end] == first.as_bytes()[..*end])
    };
    ends.take_while(is_common).last().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_lose_the_words_they_share() {
        assert_eq!(common_words(&["Light and gradient: drain", "Light and gradient: the plate"]), 20);
        assert_eq!(common_words(&["Drain", "Drain of light"]), 0);
        assert_eq!(common_words(&["A b", "A b"]), 2);
        assert_eq!(common_words(&["Ä b c", "Ä b d"]), 5);
    }
}
