//! What experiments leave, as a page and a summary, and what changed between two of them.
//!
//! An [`ExperimentOutcome`] holds pictures, tables and judged checks. A [`Summary`] is what a folder of them is, for
//! programs and for everything else here: [`page`] makes one HTML page of it and of the pictures, and [`review`]
//! compares two of them, or snapshots. Nothing here knows tensors.

mod json;
mod limits;
mod links;
mod numbers;
mod outcome;
pub mod page;
mod pixels;
mod preview;
pub mod review;
mod summary;

pub use numbers::{plain, shortened};
pub use outcome::{CheckOutcome, Column, DataFile, Expected, ExperimentOutcome, Figure, PanelPlace, Table};
pub use page::html;
pub use preview::previews;
pub use summary::{
    About, Conflict, DataSummary, ExperimentSummary, FilePath, Incoming, LeftOut, Made, PictureSummary,
    Summary, SummaryError, Work,
};
