//! Scalars and their ridges beside each other.

use crate::names::Names;
use crate::quantities::kind::{Measure, QuantityKind, measure};
use crate::scalars::{DistanceNumber, MapSource, RidgeSource};
use serde::Deserialize;

/// Correlation of two scalars over the inner cells where both are numbers.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MapCorrelation {
    /// One scalar.
    map: MapSource,
    /// The other scalar.
    with: MapSource,
}

impl QuantityKind for MapCorrelation {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (map, with) = (self.map.resolve(names)?, self.with.resolve(names)?);
        if names.grid(map.run())? != names.grid(with.run())? {
            let problem = format!("\"{}\" and \"{}\" differ in cells", self.map.run(), self.with.run());
            names.fault(self.with.run().place(), &problem);
            return None;
        }
        measure(move |results| map.correlation(with, results))
    }
}

/// A statistic of the distances of one set of ridges from another.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RidgeDistance {
    /// The ridges whose distance is measured.
    of: RidgeSource,
    /// The ridges from which it is measured.
    from: RidgeSource,
    /// The number.
    number: DistanceNumber,
}

impl QuantityKind for RidgeDistance {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
        let (of, from) = (self.of.resolve(names)?, self.from.resolve(names)?);
        let number = self.number;
        measure(move |results| Ok(number.of(&of.distances(from, results)?)))
    }
}
