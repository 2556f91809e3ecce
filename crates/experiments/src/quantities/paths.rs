//! Paths through a scene: the shortest, and the one that light shows.

use crate::form::Placed;
use crate::names::Names;
use crate::numerics::paths::{Paths, solved_part};
use crate::quantities::kind::{Measure, QuantityKind, measure};
use serde::Deserialize;

/// Cells of the shortest path through a scene from its first light to a cell, both ends included.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct WayLength {
    /// Name of the light run.
    run: Placed<String>,
    /// Column and row of its end.
    to: Placed<(usize, usize)>,
}

impl QuantityKind for WayLength {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (light, to) = names.path_to(&self.run, &self.to)?;
        measure(move |results| Ok(Paths::of(&results[light], to)?.shortest.len() as f64))
    }
}

/// How many cells longer the brightest path is than the shortest. It leads from each cell to its brightest neighbour,
/// up to the light.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct WayExcess {
    /// Name of the light run.
    run: Placed<String>,
    /// Column and row of its end.
    to: Placed<(usize, usize)>,
}

impl QuantityKind for WayExcess {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (light, to) = names.path_to(&self.run, &self.to)?;
        measure(move |results| {
            let paths = Paths::of(&results[light], to)?;
            Ok(paths.brightest()?.len() as f64 - paths.shortest.len() as f64)
        })
    }
}

/// Cells on exactly one of the shortest and the brightest path.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct WayDifference {
    /// Name of the light run.
    run: Placed<String>,
    /// Column and row of its end.
    to: Placed<(usize, usize)>,
}

impl QuantityKind for WayDifference {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (light, to) = names.path_to(&self.run, &self.to)?;
        measure(move |results| Ok(Paths::of(&results[light], to)?.difference()? as f64))
    }
}

/// Share of the cells with a path to the scene's first light whose brightest path is also a shortest one.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ShortestWays {
    /// Name of the light run.
    run: Placed<String>,
}

impl QuantityKind for ShortestWays {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let light = names.light_in_scene(&self.run)?;
        measure(move |results| solved_part(&results[light]))
    }
}
