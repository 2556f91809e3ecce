//! What a quantity is.

use crate::names::Names;
use crate::results::Results;
use crate::unavailable::Unavailable;

/// A number of the results, every name looked up; or why it is not to be had.
pub(crate) type Measure = Box<dyn Fn(&Results<'_>) -> Result<f64, Unavailable> + Send + Sync>;

/// The form in the experiment file, and how its number is measured.
pub(crate) trait QuantityKind {
    /// Looks up names, checks cells and steps, and parses expressions; `None` where something is wrong, which is
    /// reported.
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure>;
}

/// A measure that a closure takes.
pub(crate) fn measure(
    value: impl Fn(&Results<'_>) -> Result<f64, Unavailable> + Send + Sync + 'static,
) -> Option<Measure> {
    Some(Box::new(value))
}
