//! Extremes of a field.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::worst;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use serde::Deserialize;
use tigereye_core::Svd;

/// Largest `|determinant - 1|` of a field.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct DeterminantError {
    /// Name of the field.
    field: Placed<String>,
}

impl QuantityKind for DeterminantError {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let field = names.field(&self.field)?;
        measure(move |results| Ok(worst(results.field(field).field.values().iter().map(|t| (t.determinant() - 1.0).abs()))))
    }
}

/// Largest singular value of a field.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct LargestAxis {
    /// Name of the field.
    field: Placed<String>,
}

impl QuantityKind for LargestAxis {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let field = names.field(&self.field)?;
        measure(move |results| Ok(worst(results.field(field).field.values().iter().map(|t| Svd::of(t).s[0]))))
    }
}
