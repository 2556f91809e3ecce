//! Scalars over the cells, from exponents and gradients, and their height ridges.

use crate::form::{Finite, NonNegative, Placed};
use crate::ids::{FtleId, GradientId, RunId, SliceId};
use crate::names::Names;
use crate::results::Results;
use crate::unavailable::{OrUndefined, Unavailable};
use serde::Deserialize;
use tigereye_core::{Field, Grid};
use tigereye_lines::agreement::{COMPARED, Distances, append, chance, correlation};
use tigereye_lines::{Polylines, RidgeOptions, ridge_lines};

/// A scalar over the cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum MapSource {
    /// FTLE on tensor lines, at the cells.
    Ftle {
        /// Name of the FTLE run.
        run: Placed<String>,
    },
    /// One direction of a gradient.
    Slice {
        /// Name of the gradient run.
        run: Placed<String>,
        /// Direction, degrees.
        deg: Placed<Finite>,
    },
    /// Mean of a gradient over its directions.
    Mean {
        /// Name of the gradient run.
        run: Placed<String>,
    },
    /// Maximum of a gradient over its directions.
    Maximum {
        /// Name of the gradient run.
        run: Placed<String>,
    },
}

/// Height ridges of scalars over the cells.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum RidgeSource {
    /// Ridges of one scalar.
    Of(MapSource),
    /// Ridges of every direction of a gradient, combined.
    EverySlice {
        /// Name of the gradient run.
        run: Placed<String>,
    },
}

/// A statistic of the distances of one set of ridges from another, over the length of the first.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub enum DistanceNumber {
    /// Mean distance, cells.
    Mean,
    /// The distance below which 95 % lie, cells.
    Most,
    /// Share within this many cells.
    ShareWithin(NonNegative),
}

impl DistanceNumber {
    pub(crate) fn of(self, distances: &Distances) -> f64 {
        match self {
            Self::Mean => distances.mean(),
            Self::Most => distances.quantile(0.95),
            Self::ShareWithin(cells) => distances.share_within(cells.get()),
        }
    }
}

/// A scalar with its run looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Map {
    Ftle(FtleId),
    Slice(SliceId),
    Mean(GradientId),
    Maximum(GradientId),
}

impl MapSource {
    pub(crate) fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Map> {
        match self {
            Self::Ftle { run } => names.ftle(run).map(Map::Ftle),
            Self::Slice { run, deg } => names.slice(run, deg).map(Map::Slice),
            Self::Mean { run } => names.gradient(run).map(Map::Mean),
            Self::Maximum { run } => names.gradient(run).map(Map::Maximum),
        }
    }

    /// The name of the run.
    pub(crate) const fn run(&self) -> &Placed<String> {
        match self {
            Self::Ftle { run } | Self::Slice { run, .. } | Self::Mean { run } | Self::Maximum { run } => run,
        }
    }
}

impl Map {
    pub(crate) const fn run(self) -> RunId {
        match self {
            Self::Ftle(id) => id.0,
            Self::Slice(slice) => slice.gradient.0,
            Self::Mean(id) | Self::Maximum(id) => id.0,
        }
    }

    /// The scalar at the cells; of a gradient where it is a result.
    pub(crate) fn scalar(self, results: &Results<'_>) -> Result<Field<f64>, Unavailable> {
        Ok(match self {
            Self::Ftle(id) => results[id].at_cells(),
            Self::Slice(id) => results[id.gradient].where_result(&results.slice(id)?),
            Self::Mean(id) => results[id].where_result(&results[id].volume().mean_over_directions()),
            Self::Maximum(id) => results[id].where_result(&results[id].volume().max_over_directions()),
        })
    }

    /// The sides of a cell: light takes cells as squares, and so do gradients.
    fn cell(self, results: &Results<'_>) -> [f64; 3] {
        match self {
            Self::Ftle(id) => {
                let [dx, dy] = results[id].found.cell.sides();
                [dx, dy, 1.0]
            }
            Self::Slice(_) | Self::Mean(_) | Self::Maximum(_) => [1.0; 3],
        }
    }

    fn grid(self, results: &Results<'_>) -> Grid {
        match self {
            Self::Ftle(id) => results[id].at_cells().grid(),
            Self::Slice(SliceId { gradient, .. }) => results[gradient].volume().grid(),
            Self::Mean(id) | Self::Maximum(id) => results[id].volume().grid(),
        }
    }

    /// Correlation with another scalar over the inner cells where both are numbers.
    pub(crate) fn correlation(self, with: Self, results: &Results<'_>) -> Result<f64, Unavailable> {
        let (a, b) = (self.scalar(results)?, with.scalar(results)?);
        correlation(&a, &b).or_undefined("the correlation of a constant, or of fields of different size")
    }
}

/// Ridges with their runs looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ridges {
    Of(Map),
    EverySlice(GradientId),
}

impl RidgeSource {
    pub(crate) fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Ridges> {
        match self {
            Self::Of(map) => map.resolve(names).map(Ridges::Of),
            Self::EverySlice { run } => names.gradient(run).map(Ridges::EverySlice),
        }
    }
}

impl Ridges {
    /// The ridges, in cells.
    pub(crate) fn lines(self, results: &Results<'_>) -> Result<Polylines, Unavailable> {
        let mut all = Polylines::default();
        match self {
            Self::Of(map) => {
                let options = RidgeOptions { cell: map.cell(results), ..COMPARED };
                append(&mut all, &ridge_lines(&map.scalar(results)?, &options)?.shape);
            }
            Self::EverySlice(id) => {
                let gradient = &results[id];
                let volume = gradient.volume();
                for slice in volume.slices().iter().filter_map(|&t| volume.slice(t)) {
                    append(&mut all, &ridge_lines(&gradient.where_result(&slice), &COMPARED)?.shape);
                }
            }
        }
        Ok(all)
    }

    fn grid(self, results: &Results<'_>) -> Grid {
        match self {
            Self::Of(map) => map.grid(results),
            Self::EverySlice(id) => results[id].volume().grid(),
        }
    }

    /// Distances from other ridges.
    pub(crate) fn distances(self, from: Self, results: &Results<'_>) -> Result<Distances, Unavailable> {
        Ok(Distances::between(&self.lines(results)?, &from.lines(results)?, self.grid(results)))
    }

    /// How much of anything would meet these ridges by chance.
    pub(crate) fn chance(self, within: f64, results: &Results<'_>) -> Result<f64, Unavailable> {
        Ok(chance(&self.lines(results)?, self.grid(results), within))
    }
}
