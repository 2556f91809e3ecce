//! Shape of a front of light.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::light::energy_radius;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::unavailable::OrUndefined;
use serde::Deserialize;
use tigereye_core::{Cell, Field, math};

/// Mean distance of the energy in the sectors around the axes relative to that around the diagonals, after a kept step.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct FrontRoundness {
    /// Name of the light run.
    run: Placed<String>,
    /// Step.
    step: Placed<usize>,
}

impl QuantityKind for FrontRoundness {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let frame = names.frame(&self.run, Some(&self.step))?;
        measure(move |results| {
            let energy = results.frame(frame)?.energy();
            roundness(&energy).or_undefined("there is no light in one of the sectors")
        })
    }
}

/// Mean radius of the energy within 22.5 degrees of the axes over that within 22.5 degrees of the diagonals.
fn roundness(energy: &Field<f64>) -> Option<f64> {
    let grid = energy.grid();
    let centre = [(grid.width() - 1) as f64 / 2.0, (grid.height() - 1) as f64 / 2.0];
    let about_axes = |c: Cell| {
        let (dx, dy) = ((c.x as f64 - centre[0]).abs(), (c.y as f64 - centre[1]).abs());
        let (small, large) = (dx.min(dy), dx.max(dy));
        small < math::tan(math::radians(22.5)) * large
    };
    let sector = |axes: bool| {
        energy_radius(&Field::from_fn(grid, |c| if about_axes(c) == axes { *energy.at(c) } else { 0.0 })).0
    };
    Some(sector(true) / sector(false)).filter(|r| r.is_finite())
}
