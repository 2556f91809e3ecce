//! Curves of charts.

use crate::form::{Finite, Placed};
use crate::names::Names;
use crate::numerics::gradient::inner_cells;
use crate::numerics::light::{lobe_ratio, net_flux_ratio};
use crate::panels::kind::{Curve, Look};
use crate::results::Results;
use crate::runs::light::Outcome;
use crate::runs::pulses::PulseNumber;
use crate::unavailable::{OrUndefined, Unavailable};
use serde::Deserialize;
use tigereye_core::{Cell, LightDistribution};

/// Points at which a formula is drawn.
const FORMULA_POINTS: usize = 121;

/// A curve of a chart.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum SeriesSource {
    /// Given points, which are not joined.
    Points {
        /// Name in the legend.
        label: String,
        /// x and y.
        points: Vec<(Finite, Finite)>,
    },
    /// An expression in `x`.
    Formula {
        /// Name in the legend.
        label: String,
        /// The expression.
        expression: Placed<String>,
        /// Smallest and largest x.
        range: (Finite, Finite),
    },
    /// Net outward flux through the cells right of the light against the distance, relative to distance 1.
    NetFlux {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: Placed<String>,
        /// Largest distance.
        to: usize,
    },
    /// The outward lobe in the cells right of the light against the distance, relative to distance 1.
    OutwardLobe {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: Placed<String>,
        /// Largest distance.
        to: usize,
    },
    /// Difference between another series and an expression in `x`, point by point.
    Deviation {
        /// Name in the legend.
        label: String,
        /// The other series.
        of: Box<SeriesSource>,
        /// The expression.
        from: Placed<String>,
    },
    /// `|energy(n) - energy(0)|` against the step, W.
    EnergyError {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: Placed<String>,
    },
    /// Mean distance of the energy from the centre against the step, cells.
    RadiusMean {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: Placed<String>,
    },
    /// Standard deviation of the energy's distance from the centre against the step, cells.
    RadiusSpread {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: Placed<String>,
    },
    /// A row of a gradient's slice against the column.
    SliceRow {
        /// Name in the legend.
        label: String,
        /// Name of the gradient run.
        run: Placed<String>,
        /// Direction, degrees.
        deg: Placed<Finite>,
        /// Row.
        row: Placed<usize>,
    },
    /// Seconds that runs took, against their number in this list (from 1); runs that are not in scope are omitted.
    Seconds {
        /// Name in the legend.
        label: String,
        /// Names of gradient runs.
        runs: Vec<Placed<String>>,
    },
    /// A number of the pulses in one direction, against the column of their cell.
    PulsesOverColumn {
        /// Name in the legend.
        label: String,
        /// Name of the pulses run.
        run: Placed<String>,
        /// The number.
        number: PulseNumber,
        /// Direction, degrees.
        deg: Placed<Finite>,
    },
    /// Mean of a gradient over all inner cells, against the direction in degrees.
    MeanOverCells {
        /// Name in the legend.
        label: String,
        /// Name of the gradient run.
        run: Placed<String>,
    },
}

/// Points of a curve.
type Points = Box<dyn Fn(&Results<'_>) -> Result<Vec<(f64, f64)>, Unavailable> + Send + Sync>;

/// A curve, ready to be drawn.
pub(crate) struct PlannedSeries {
    /// Name in the legend.
    pub(crate) label: String,
    points: Points,
    look: Look,
    /// Whether it shows seconds, which are others in every run.
    pub(crate) is_timed: bool,
}

impl PlannedSeries {
    fn new(
        label: &str,
        points: impl Fn(&Results<'_>) -> Result<Vec<(f64, f64)>, Unavailable> + Send + Sync + 'static,
    ) -> Self {
        Self { label: label.to_owned(), points: Box::new(points), look: Look::Joined, is_timed: false }
    }

    pub(crate) fn curve(&self, results: &Results<'_>) -> Result<Curve, Unavailable> {
        let points = (self.points)(results)?;
        Ok(Curve { label: self.label.clone(), points, look: self.look })
    }
}

impl SeriesSource {
    pub(crate) fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedSeries> {
        Some(match self {
            Self::Points { label, points } => {
                let points: Vec<(f64, f64)> = points.iter().map(|p| (p.0.get(), p.1.get())).collect();
                PlannedSeries { look: Look::Marks, ..PlannedSeries::new(label, move |_| Ok(points.clone())) }
            }
            Self::Formula { label, expression, range } => {
                let f = names.expression(expression, &["x"])?;
                let (a, b) = (range.0.get(), range.1.get());
                let at = move |i: usize| a + (b - a) * i as f64 / (FORMULA_POINTS - 1) as f64;
                let points = move |_: &Results<'_>| {
                    Ok((0..FORMULA_POINTS).map(|i| (at(i), f.eval(&[at(i)]))).collect())
                };
                PlannedSeries { look: Look::Line, ..PlannedSeries::new(label, points) }
            }
            Self::Deviation { label, of, from } => {
                let f = names.expression(from, &["x"])?;
                let of = of.resolve(names)?;
                let look = of.look;
                let points = move |results: &Results<'_>| {
                    let points = (of.points)(results)?;
                    Ok(points.into_iter().map(|(x, y)| (x, y - f.eval(&[x]))).collect())
                };
                PlannedSeries { look, ..PlannedSeries::new(label, points) }
            }
            Self::NetFlux { label, run, to } => {
                let (light, to) = (names.light(run)?, *to);
                PlannedSeries::new(label, move |results| along(&results[light], to, net_flux_ratio))
            }
            Self::OutwardLobe { label, run, to } => {
                let (light, to) = (names.light(run)?, *to);
                PlannedSeries::new(label, move |results| along(&results[light], to, lobe_ratio))
            }
            Self::EnergyError { label, run } => {
                let light = names.light(run)?;
                PlannedSeries::new(label, move |results| {
                    let energies = &results[light].energies;
                    let start = energies.first().copied().unwrap_or(0.0);
                    Ok(counted(energies.iter().map(|e| (e - start).abs())))
                })
            }
            Self::RadiusMean { label, run } => {
                let light = names.light_with_radii(run)?;
                PlannedSeries::new(label, move |results| {
                    Ok(counted(results[light].radii.iter().map(|r| r.0)))
                })
            }
            Self::RadiusSpread { label, run } => {
                let light = names.light_with_radii(run)?;
                PlannedSeries::new(label, move |results| {
                    Ok(counted(results[light].radii.iter().map(|r| r.1)))
                })
            }
            Self::Seconds { label, runs } => {
                let runs = runs.iter().map(|run| names.run(run)).collect::<Option<Vec<_>>>()?;
                let points = move |results: &Results<'_>| {
                    // Runs of another scope only leave points out.
                    let taken = |(i, run)| Some(((i + 1) as f64, results.seconds(run)?));
                    Ok(runs.iter().copied().enumerate().filter_map(taken).collect())
                };
                PlannedSeries { look: Look::Marks, is_timed: true, ..PlannedSeries::new(label, points) }
            }
            Self::SliceRow { label, run, deg, row } => {
                let slice = names.slice(run, deg)?;
                names.cell(names.grid(slice.gradient.0)?, (0, **row), row.place())?;
                let row = **row;
                PlannedSeries::new(label, move |results| {
                    let slice = results.slice(slice)?;
                    let inner = 1..slice.grid().width() - 1;
                    Ok(inner.map(|x| (x as f64, *slice.at(Cell::new(x, row)))).collect())
                })
            }
            Self::PulsesOverColumn { label, run, number, deg } => {
                let pulses = names.pulses(run)?;
                let (sample, number) = (names.pulse_direction(pulses, deg)?, *number);
                PlannedSeries::new(label, move |results| {
                    let of_direction = results[pulses].records.iter().filter(|p| p.sample == sample);
                    Ok(of_direction.map(|p| (p.cell.x as f64, p.number(number))).collect())
                })
            }
            Self::MeanOverCells { label, run } => {
                let gradient = names.gradient(run)?;
                PlannedSeries::new(label, move |results| {
                    let volume = results[gradient].volume();
                    let cells: Vec<Cell> = inner_cells(volume.grid()).collect();
                    let mean = |t| {
                        let sum = cells.iter().map(|&c| volume.value(c, t)).sum::<Option<f64>>()?;
                        Some((volume.directions().angle_deg(t), sum / cells.len().max(1) as f64))
                    };
                    let means = volume.slices().iter().map(|&t| mean(t)).collect::<Option<Vec<_>>>();
                    means.or_undefined("the gradient has no inner cells")
                })
            }
        })
    }
}

/// Values over their number.
fn counted(values: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
    values.enumerate().map(|(i, v)| (i as f64, v)).collect()
}

/// Ratios at distances right of the first light, as far as there are cells.
fn along(
    light: &Outcome,
    to: usize,
    ratio: fn(&LightDistribution, Cell, usize) -> Option<f64>,
) -> Result<Vec<(f64, f64)>, Unavailable> {
    let source = *light.sources.first().or_undefined("the run has no light")?;
    Ok((1..=to).filter_map(|d| Some((d as f64, ratio(&light.last, source, d)?))).collect())
}
