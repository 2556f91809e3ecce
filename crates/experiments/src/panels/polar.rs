//! Curves over the direction.

use crate::form::{DirectionCount, Finite, NonNegative, Placed};
use crate::names::Names;
use crate::numerics::fine_directions;
use crate::panels::kind::{PanelKind, PlannedPanel};
use crate::results::Results;
use crate::unavailable::{OrUndefined, Unavailable};
use serde::Deserialize;
use tigereye_core::{PolarProfile, transmission_ellipse};
use tigereye_render::{PolarPlotOptions, PolarSeries, Rgba, SERIES_PALETTE, polar_plot};
use tigereye_transport::{Scheme, SharedWeights, emitter};

/// Curves plotted against the direction.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Polar {
    /// The curves.
    curves: Vec<Curve>,
    /// Name and unit of the radius.
    quantity: String,
    /// Heading of the panel.
    title: String,
}

/// A curve plotted against the direction.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Curve {
    /// Name in the legend.
    label: String,
    /// What it shows.
    source: ProfileSource,
}

/// The data of a curve plotted against the direction.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum ProfileSource {
    /// The emitter `max(0, cos(theta - theta0))^power` at 360 samples.
    Emitter {
        /// Brightest direction, degrees.
        theta_deg: Finite,
        /// Exponent.
        power: NonNegative,
    },
    /// The cone weight of a neighbour (0 to 7) at this many samples.
    ConeWeight {
        /// Neighbour direction.
        neighbour: Placed<usize>,
        /// Samples.
        directions: DirectionCount,
    },
    /// The ellipse (eq. 3.6) of a field's cell, in the tensor's unit.
    Ellipse {
        /// Name of the field.
        field: Placed<String>,
        /// Column and row.
        cell: Placed<(usize, usize)>,
    },
    /// The light of a cell after a run.
    Light {
        /// Name of the light run.
        run: Placed<String>,
        /// Column and row.
        cell: Placed<(usize, usize)>,
        /// Step; the last by default.
        #[serde(default)]
        step: Option<Placed<usize>>,
    },
    /// The light of a cell times its transmission, as the cones weigh it (eq. 3.12 without `n_f`).
    Windowed {
        /// Name of the light run.
        run: Placed<String>,
        /// Column and row.
        cell: Placed<(usize, usize)>,
    },
}

/// Samples of a curve.
type Profile = Box<dyn Fn(&Results<'_>) -> Result<PolarProfile, Unavailable> + Send + Sync>;

/// A curve with its colour, and whether it is filled.
struct PlannedCurve {
    label: String,
    profile: Profile,
    colour: Rgba,
    fill: bool,
}

/// What a profile of samples that are not finite lacks.
const NO_PROFILE: &str = "the profile is not finite";

impl ProfileSource {
    fn resolve(&self, names: &mut Names<'_, '_>, series: Rgba) -> Option<(Profile, Rgba, bool)> {
        Some(match self {
            Self::Emitter { theta_deg, power } => {
                let (theta, power) = (tigereye_core::math::radians(theta_deg.get()), power.get());
                (Box::new(move |_| Ok(emitter(fine_directions(), theta, power))), series, false)
            }
            Self::ConeWeight { neighbour, directions } => {
                if **neighbour > 7 {
                    let problem = format!("neighbour {neighbour}: expected 0 to 7");
                    names.fault(neighbour.key(), &problem);
                    return None;
                }
                let (neighbour, directions) = (**neighbour, directions.0);
                let weights = move |_: &Results<'_>| {
                    let scheme = Scheme::new(directions, SharedWeights::Thesis);
                    Ok(PolarProfile::from_fn(directions, |t| scheme.weights(t)[neighbour]))
                };
                (Box::new(weights), series, true)
            }
            Self::Ellipse { field, cell } => {
                let field = names.field(field)?;
                let cell = names.cell(names.named_field(field).field.grid(), **cell, cell.place())?;
                let ellipse = move |results: &Results<'_>| {
                    Ok(transmission_ellipse(results.field(field).field.at(cell), fine_directions()))
                };
                (Box::new(ellipse), Rgba::TRANSMISSION, true)
            }
            Self::Light { run, cell, step } => {
                let frame = names.frame(run, step.as_ref())?;
                let cell = names.cell_of(frame.light.0, cell)?;
                let light = move |results: &Results<'_>| {
                    let light = results.frame(frame)?;
                    let samples = light.profile(cell).to_vec();
                    PolarProfile::from_samples(light.directions(), samples).ok().or_undefined(NO_PROFILE)
                };
                (Box::new(light), Rgba::LIGHT, true)
            }
            Self::Windowed { run, cell } => {
                let light = names.light(run)?;
                let cell = names.cell_of(light.0, cell)?;
                let windowed = move |results: &Results<'_>| {
                    let run = &results[light];
                    let (profile, shape) = (run.last.profile(cell), run.transmission.shape(cell));
                    let samples = profile.iter().zip(shape).map(|(i, t)| i * t).collect();
                    PolarProfile::from_samples(run.last.directions(), samples).ok().or_undefined(NO_PROFILE)
                };
                (Box::new(windowed), series, false)
            }
        })
    }
}

impl PanelKind for Polar {
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let planned = self.curves.iter().enumerate().map(|(i, curve)| {
            let series = SERIES_PALETTE[i % SERIES_PALETTE.len()];
            let (profile, colour, fill) = curve.source.resolve(names, series)?;
            Some(PlannedCurve { label: curve.label.clone(), profile, colour, fill })
        });
        let curves = planned.collect::<Option<Vec<_>>>()?;
        let quantity = self.quantity.clone();
        Some(PlannedPanel::new(&self.title, move |drawing| {
            let series = curves.iter().map(|curve| {
                let profile = (curve.profile)(drawing.results)?;
                let (label, colour, fill) = (curve.label.clone(), curve.colour, curve.fill);
                Ok(PolarSeries { label, profile, colour, fill, dash_px: Vec::new() })
            });
            let series = series.collect::<Result<Vec<_>, Unavailable>>()?;
            let (title, quantity) = (drawing.title.clone(), quantity.clone());
            Ok(polar_plot(&series, &PolarPlotOptions { title, quantity, ..PolarPlotOptions::default() }))
        }))
    }
}
