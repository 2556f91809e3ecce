//! One page of all outcomes.

mod contents;
mod document;
mod figures;
mod gallery;
mod glossary;
mod introduction;
mod overview;
mod tables;
#[cfg(test)]
mod tests;
mod verdict;

pub use document::html;

/// What the page says about the run as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// Version of the program.
    pub version: String,
    /// Wall-clock seconds of the whole run.
    pub seconds: f64,
    /// The command line that was run.
    pub command: String,
    /// Whether the thesis's own resolutions were run.
    pub full: bool,
    /// Number of threads; the results do not depend on it.
    pub threads: usize,
    /// Experiments that were left out, and why, a sentence each.
    pub left_out: Vec<String>,
}
