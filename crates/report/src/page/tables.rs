//! The tables of an experiment.

use maud::{Markup, html};

use crate::{Column, Table};

/// All tables, one below the other.
pub(super) fn tables(tables: &[Table]) -> Markup {
    html! { @for t in tables { (table(t)) } }
}

/// Numbers stand on the right.
pub(super) fn class_of(column: &Column) -> Option<&'static str> {
    (!column.words).then_some("number")
}

/// What may be wider than the page.
pub(super) fn scrolled(label: &str, content: &Markup) -> Markup {
    // Without a tab stop the keyboard could not scroll it.
    html! { div.scroll tabindex="0" role="region" aria-label=(label) { (content) } }
}

fn table(table: &Table) -> Markup {
    scrolled(
        &table.title,
        &html! {
            table.results {
                caption { b { (table.title) "." } " " (table.caption) }
                thead {
                    tr {
                        @for column in &table.columns {
                            th class=[class_of(column)] scope="col" { (column.heading) }
                        }
                    }
                }
                tbody {
                    @for (name, entries) in &table.rows {
                        tr {
                            th scope="row" { (name) }
                            @for (entry, column) in entries.iter().zip(table.columns.iter().skip(1)) {
                                td class=[class_of(column)] { (entry) }
                            }
                        }
                    }
                }
            }
        },
    )
}
