//! The energy of light in colours.

use tigereye_render::{HeatOptions, HeatScale};

/// Default range of pictures, decades below the brightest cell.
pub const DECADES: f64 = HeatScale::USUAL_DECADES;

/// Options of a map of the energies of cells (W), over so many decades below the brightest cell; `None` for a linear
/// scale.
#[must_use]
pub fn options(decades: Option<f64>) -> HeatOptions {
    HeatOptions {
        quantity: "energy of a cell / W".to_owned(),
        scale: decades.map_or(HeatScale::Linear, |decades| HeatScale::Logarithmic { decades }),
        ..HeatOptions::default()
    }
}

/// Options of a map of mean importances over direction (no unit).
#[must_use]
pub fn importance_options(decades: Option<f64>) -> HeatOptions {
    HeatOptions {
        quantity: "mean importance over direction".to_owned(),
        source_name: "receiver",
        dark_name: Some("unimportant"),
        ..options(decades)
    }
}
