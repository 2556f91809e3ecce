//! Published runtimes beside those of this run.

use crate::form::{Placed, Positive};
use crate::names::Names;
use crate::tables::entries::seconds;
use crate::tables::kind::{PlannedRow, TableKind, columns, rows_of};
use serde::Deserialize;
use tigereye_report::Column;

/// Published runtimes beside those of this run. A row whose run is not in scope says so.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Runtimes {
    /// The rows.
    rows: Vec<RuntimeRow>,
}

/// A published runtime.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RuntimeRow {
    /// Heading of the row.
    label: String,
    /// Number of cores of the measurement.
    cores: usize,
    /// Seconds.
    published_s: Positive,
    /// Name of the run; omitted if the data are not part of this project.
    #[serde(default)]
    run: Option<Placed<String>>,
    /// Remarks.
    #[serde(default)]
    remark: String,
}

impl TableKind for Runtimes {
    fn columns(&self) -> Vec<Column> {
        let mut columns = columns(&[
            "Sweep",
            "Published: cores",
            "Published /\u{a0}s",
            "This run /\u{a0}s",
            "Remark",
        ]);
        if let Some(remark) = columns.last_mut() {
            remark.words = true;
        }
        columns
    }

    fn rows(&self, names: &mut Names<'_, '_>) -> Vec<PlannedRow> {
        rows_of(&self.rows, names, |row, names| {
            let run = match &row.run {
                Some(run) => Some(names.run(run)?),
                None => None,
            };
            let row = row.clone();
            Some(Box::new(move |results| {
                let taken = run.map(|run| results.seconds(run));
                Ok((row.label.clone(), row.entries(taken)))
            }))
        })
    }
}

impl RuntimeRow {
    /// The entries of a row. `taken` holds the run's seconds; it is `Some(None)` if the run is out of scope, and `None`
    /// if there is no such run.
    fn entries(&self, taken: Option<Option<f64>>) -> Vec<String> {
        let published_s = self.published_s.get();
        let seconds_taken = match taken {
            Some(Some(s)) => seconds(s),
            Some(None) => "only with --full".to_owned(),
            None => "no data".to_owned(),
        };
        vec![self.cores.to_string(), seconds(published_s), seconds_taken, self.remark.clone()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_runtime_says_why_it_is_missing() {
        let published_s = Positive::try_from(100.0).expect("above 0");
        let row = RuntimeRow { label: "a".into(), cores: 64, published_s, run: None, remark: String::new() };
        assert_eq!(row.entries(Some(Some(2.0)))[..3], ["64", "100", "2.00"]);
        assert_eq!(row.entries(Some(None))[2], "only with --full");
        assert_eq!(row.entries(None)[2], "no data");
    }
}
