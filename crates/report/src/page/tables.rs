//! The tables of an experiment.

use maud::{Markup, html};

use super::words::words;
use crate::{Column, Table};

/// More columns than a page has room for stand below each other: then a row of the table is a column.
const MOST_COLUMNS: usize = 8;

/// All tables, one below the other; those with a title among `shared` are folded, because the same numbers stand above
/// beside those of other experiments.
pub(super) fn tables(tables: &[Table], shared: &[&str]) -> Markup {
    html! {
        @for t in tables {
            @if shared.contains(&t.title.as_str()) {
                details.shared { summary { "Table: " (t.title) } (table(t)) }
            } @else {
                (table(t))
            }
        }
    }
}

fn table(table: &Table) -> Markup {
    let rows: Vec<(Markup, &[String])> =
        table.rows.iter().map(|(name, entries)| (html! { (name) }, &entries[..])).collect();
    table_of(&table.title, &table.caption, &table.columns, &rows)
}

/// A table of rows with heads; turned round where it is wide and low.
pub(super) fn table_of(
    title: &str,
    caption: &str,
    columns: &[Column],
    rows: &[(Markup, &[String])],
) -> Markup {
    let turned = columns.len() > MOST_COLUMNS && rows.len() < columns.len();
    let content = if turned { down(columns, rows) } else { across(columns, rows) };
    html! {
        // Without a tab stop the keyboard could not scroll it.
        div.scroll tabindex="0" role="region" aria-label=(title) {
            table.results.turned[turned] { caption { b { (title) "." } " " (words(caption)) } (content) }
        }
    }
}

fn across(columns: &[Column], rows: &[(Markup, &[String])]) -> Markup {
    html! {
        thead { tr { @for column in columns { th class=[class_of(column)] scope="col" { (column.heading) } } } }
        tbody {
            @for (head, entries) in rows {
                tr {
                    th scope="row" { (head) }
                    @for (entry, column) in entries.iter().zip(columns.iter().skip(1)) {
                        td class=[class_of(column)] { (entry) }
                    }
                }
            }
        }
    }
}

fn down(columns: &[Column], rows: &[(Markup, &[String])]) -> Markup {
    html! {
        thead {
            tr {
                th scope="col" { (columns.first().map_or("", |c| &c.heading)) }
                @for (head, _) in rows { th.number scope="col" { (head) } }
            }
        }
        tbody {
            @for (i, column) in columns.iter().skip(1).enumerate() {
                tr {
                    th scope="row" { (column.heading) }
                    @for (_, entries) in rows {
                        td.number { (entries.get(i).map_or("", String::as_str)) }
                    }
                }
            }
        }
    }
}

/// Numbers stand on the right.
fn class_of(column: &Column) -> Option<&'static str> {
    (!column.words).then_some("number")
}
