//! The report: one page and one summary of all outcomes.
