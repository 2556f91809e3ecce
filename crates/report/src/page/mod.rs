//! One page of all outcomes.

mod contents;
mod document;
mod figures;
mod gallery;
mod glossary;
mod introduction;
mod order;
mod overview;
mod tables;
#[cfg(test)]
mod tests;
mod thesis;
mod verdict;
mod words;

pub use document::html;

/// Gives the panels of a figure as PNGs by the figure's path in the results folder; none where it is not there.
pub type Pictures<'a> = dyn Fn(&str) -> Option<Vec<Vec<u8>>> + 'a;
