//! The order of sections and experiments on the page: that of the source, numbers by their size.

use std::cmp::Ordering;

use super::thesis::figure_number;
use crate::ExperimentSummary;

/// Compares texts; digits in them count as numbers, so that 2.6 comes before 2.10, and those before letters.
pub(super) fn natural(a: &str, b: &str) -> Ordering {
    parts(a).cmp(&parts(b)).then_with(|| a.cmp(b))
}

/// Numbers are smaller than words.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Part<'a> {
    Number(u64),
    Words(&'a str),
}

fn parts(text: &str) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let digits = first.is_ascii_digit();
        let end = rest.find(|c: char| c.is_ascii_digit() != digits).unwrap_or(rest.len());
        let (part, after) = rest.split_at(end);
        // A number that no integer holds is a word.
        parts.push(match part.parse() {
            Ok(number) if digits => Part::Number(number),
            _ => Part::Words(part),
        });
        rest = after;
    }
    parts
}

/// Figures of the thesis by their numbers before everything else, which keeps its order.
pub(super) fn of_section(a: &ExperimentSummary, b: &ExperimentSummary) -> Ordering {
    match (figure_number(a), figure_number(b)) {
        (Some(a), Some(b)) => natural(a, b),
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => Ordering::Equal,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_count_as_numbers() {
        let mut names = ["B data", "4.10 b", "2.4 a", "A fields", "4.5 a", "10", "A 2", "A 10", "4.5"];
        names.sort_by(|a, b| natural(a, b));
        assert_eq!(names, ["2.4 a", "4.5", "4.5 a", "4.10 b", "10", "A 2", "A 10", "A fields", "B data"]);
        assert_eq!(natural("1", "01"), Ordering::Greater);
    }
}
