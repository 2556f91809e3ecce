//! Directions of a field's major axes.

use crate::form::{AxesChoice, Placed};
use crate::names::Names;
use crate::numerics::worst;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use serde::Deserialize;
use tigereye_core::{Cell, Svd, Tensor2, math};
use tigereye_fields::{ExpressionField, variables};
use tigereye_lines::{Axes, Family};

/// Semi-axes that differ by less count as equal: their direction is arbitrary.
const ISOTROPIC_BELOW: f64 = 0.01;

/// Whether a tensor has no direction worth the name.
pub(crate) fn is_isotropic(t: &Tensor2) -> bool {
    t.is_zero() || 1.0 - Svd::of(t).axis_ratio() <= ISOTROPIC_BELOW
}

/// Direction of a cell's major semi-axis, degrees in [0, 180).
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MajorAxisDeg {
    /// Name of the field.
    field: Placed<String>,
    /// Column and row.
    cell: Placed<(usize, usize)>,
}

impl QuantityKind for MajorAxisDeg {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let field = names.field(&self.field)?;
        let grid = names.named_field(field).field.grid();
        let cell = names.cell(grid, *self.cell, self.cell.place())?;
        measure(move |results| {
            let phi = Svd::of(results.field(field).field.at(cell)).phi_rad();
            Ok(math::degrees(phi).rem_euclid(180.0))
        })
    }
}

/// Largest angle (degrees) between the major axis and the expression `phi_deg` in the variables of a field, over the
/// cells whose semi-axes differ by more than 1 %; tensors without these axes are not counted.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MajorAxisError {
    /// Name of the field.
    field: Placed<String>,
    /// Direction expected, degrees.
    phi_deg: Placed<String>,
    /// Which axes.
    #[serde(default = "semi_axes")]
    axes: AxesChoice,
}

/// What light sees.
const fn semi_axes() -> AxesChoice {
    AxesChoice::always(Axes::HalfAxes)
}

impl QuantityKind for MajorAxisError {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let field = names.field(&self.field)?;
        let axes = self.axes.ordered(None, &names.named_field(field).field);
        let expression = names.expression(&self.phi_deg, &ExpressionField::VARIABLES)?;
        measure(move |results| {
            let field = &results.field(field).field;
            let error = |(cell, t): (Cell, &Tensor2)| {
                let axis = axes.of(t, 0.0)?.axes[Family::Major as usize];
                let expected = expression.eval(&variables(field.grid(), cell));
                let off = (math::degrees(math::atan2(axis.y, axis.x)) - expected).rem_euclid(180.0);
                Some(off.min(180.0 - off))
            };
            Ok(worst(field.iter().filter(|(_, t)| !is_isotropic(t)).filter_map(error)))
        })
    }
}
