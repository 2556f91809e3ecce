//! Numbers that checks test, one file per kind: its form in the experiment file, what its names refer to, and its
//! value.
//!
//! A quantity is added by its file, which implements `QuantityKind`, and its line in
//! `quantities!`.

mod kind;

pub(crate) use kind::Measure;
use kind::QuantityKind;

use crate::names::Names;
use serde::Deserialize;

macro_rules! quantities {
    ($($module:ident::{$($kind:ident),+}),+ $(,)?) => {
        $(pub mod $module;)+

        /// A number of this run. Every kind has the documentation of its type.
        #[derive(Clone, Debug, Deserialize, PartialEq)]
        #[allow(missing_docs, reason = "the types are documented")]
        pub enum Quantity {
            $($($kind($module::$kind),)+)+
        }

        impl Quantity {
            /// How the number is measured; `None` where something is wrong, which is reported.
            pub(crate) fn resolve(&self, names: &mut Names<'_, '_>) -> Option<Measure> {
                match self {
                    $($(Self::$kind(form) => form.resolve(names),)+)+
                }
            }
        }
    };
}

quantities! {
    energy_drift::{EnergyDrift},
    energy_radius::{RadiusMean, RadiusSpread},
    energy_ratio::{EnergyRatio, EnergyOver},
    energy_share::{RingShare, BoxShare},
    falloff::{NetFluxRatio, LobeRatio},
    front_roundness::{FrontRoundness},
    gradient_correlation::{GradientCorrelation},
    gradient_difference::{GradientDifference},
    gradient_summary::{GradientMax, GradientMean, GradientLimited},
    gradient_symmetry::{GradientSymmetry},
    gradient_value::{GradientAt, GradientRatio},
    light_difference::{LightDifference},
    light_end::{Steps, Stopped, TotalEnergy},
    light_symmetry::{LightSymmetry},
    linear::{SuperpositionError, AdjointError, RelativeError},
    major_axis::{MajorAxisDeg, MajorAxisError},
    maps::{MapCorrelation, RidgeDistance},
    of_pulses::{OfPulses},
    paths::{WayLength, WayExcess, WayDifference, ShortestWays},
    ridge_rows::{RidgeColumnError, RidgeContrast},
    scheme::{Scheme, EmitterFlux},
    tensor_extremes::{DeterminantError, LargestAxis},
    tensor_shares::{IsotropicShare, ZeroShare, ComplexShare, TotalAnisotropyShare},
    total_anisotropy_border::{BesideTotalAnisotropy},
}
