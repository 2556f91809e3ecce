//! Shares of a field's cells.

use crate::form::Placed;
use crate::names::Names;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::quantities::major_axis::is_isotropic;
use serde::Deserialize;
use tigereye_core::{Field, Tensor2, is_totally_anisotropic};
use tigereye_lines::is_complex;

/// Share of cells whose semi-axes differ by at most 1 %, zero tensors included.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct IsotropicShare {
    /// Name of the field.
    field: Placed<String>,
}

impl QuantityKind for IsotropicShare {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let field = names.field(&self.field)?;
        measure(move |results| Ok(share(&results.field(field).field, is_isotropic)))
    }
}

/// Share of cells whose tensor is 0.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ZeroShare {
    /// Name of the field.
    field: Placed<String>,
}

impl QuantityKind for ZeroShare {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let field = names.field(&self.field)?;
        measure(move |results| Ok(share(&results.field(field).field, Tensor2::is_zero)))
    }
}

/// Share of cells whose tensor has complex eigenvalues.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ComplexShare {
    /// Name of the field.
    field: Placed<String>,
}

impl QuantityKind for ComplexShare {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let field = names.field(&self.field)?;
        measure(move |results| Ok(share(&results.field(field).field.without_rounding(), is_complex)))
    }
}

/// Share of cells that are totally anisotropic, zero tensors not counted.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct TotalAnisotropyShare {
    /// Name of the field.
    field: Placed<String>,
}

impl QuantityKind for TotalAnisotropyShare {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let field = names.field(&self.field)?;
        measure(move |results| Ok(share(&results.field(field).field, |t| !t.is_zero() && is_totally_anisotropic(t))))
    }
}

fn share(field: &Field<Tensor2>, test: impl Fn(&Tensor2) -> bool) -> f64 {
    field.values().iter().filter(|t| test(t)).count() as f64 / field.values().len() as f64
}
