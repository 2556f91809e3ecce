//! Tables of results, one file per kind: its form in the experiment file, what its names refer to, and its rows.
//!
//! A table is added by its file, which implements `TableKind`, and its line in `tables!`.

mod entries;
mod kind;

pub(crate) use entries::NOTHING;
pub(crate) use kind::PlannedRow;
use kind::TableKind;

use crate::names::Names;
use serde::Deserialize;
use tigereye_report::Column;

macro_rules! tables {
    ($($module:ident::$kind:ident),+ $(,)?) => {
        $(pub mod $module;)+

        /// What a table shows. Every kind has the documentation of its type.
        #[derive(Clone, Debug, Deserialize, PartialEq)]
        #[allow(missing_docs, reason = "the types are documented")]
        pub enum TableRows {
            $($kind($module::$kind),)+
        }

        impl TableRows {
            /// The columns, that of the rows' names first.
            pub(crate) fn columns(&self) -> Vec<Column> {
                match self {
                    $(Self::$kind(form) => form.columns(),)+
                }
            }

            /// The rows without faults whose runs are made.
            pub(crate) fn rows(&self, names: &mut Names<'_, '_>) -> Vec<PlannedRow> {
                match self {
                    $(Self::$kind(form) => form.rows(names),)+
                }
            }
        }
    };
}

tables! {
    pulses::Pulses,
    gradients::Gradients,
    comparison::Comparison,
    noise::Noise,
    runtimes::Runtimes,
    growth::Growth,
}
