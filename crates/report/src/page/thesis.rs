//! What of a page is of the thesis: users also run experiments of their own.

use crate::ExperimentSummary;

/// Whether the page shows anything of the thesis.
pub(super) fn is_of_thesis(outcomes: &[ExperimentSummary]) -> bool {
    outcomes.is_empty() || outcomes.iter().any(|o| o.source.contains("Thesis"))
}

/// The number of the thesis's figure that an experiment reproduces, such as `Fig. 2.10`; none for anything else.
pub(super) fn figure_number(experiment: &ExperimentSummary) -> Option<&str> {
    let source = &experiment.source;
    let start = source.find("Fig. ").filter(|_| source.starts_with("Thesis"))?;
    let number = &source[start + "Fig. ".len()..];
    let end = number.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(number.len());
    let label = source[start..start + "Fig. ".len() + end].trim_end_matches('.');
    number.starts_with(|c: char| c.is_ascii_digit()).then_some(label)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_the_thesis_are_found_in_its_sources() {
        let of = |source: &str| {
            let experiment = ExperimentSummary { source: source.into(), ..Default::default() };
            figure_number(&experiment).map(str::to_owned)
        };
        assert_eq!(of("Thesis, Fig. 2.10").as_deref(), Some("Fig. 2.10"));
        assert_eq!(of("Thesis, Fig. 3.2, eqs. 3.1 and 3.2").as_deref(), Some("Fig. 3.2"));
        assert_eq!(of("Thesis, Fig. 3.").as_deref(), Some("Fig. 3"));
        assert_eq!(
            (of("Thesis, section 4.3"), of("Another work, Fig. 4"), of("Thesis, Fig. x")),
            (None, None, None)
        );
    }
}
