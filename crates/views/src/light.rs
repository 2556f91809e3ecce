//! The energy of light in colours.

use tigereye_core::{Cell, CellShape, Field, Surface};
use tigereye_render::{HeatOptions, HeatScale, Overlay, Scene, heat_map};

/// Default range of pictures, decades below the brightest cell.
pub const DECADES: f64 = 4.0;

/// Which picture of the energy.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Heading.
    pub title: String,
    /// Quantity and unit for the legend; `None` for the energy of a cell.
    pub quantity: Option<String>,
    /// Decades below the brightest cell; `None` for a linear scale.
    pub decades: Option<f64>,
    /// Cells of the lights, which are marked.
    pub sources: Vec<Cell>,
    /// What a marked cell is, in the singular; `None` for a light source.
    pub source_name: Option<&'static str>,
    /// What cells below a logarithmic scale are called; `None` for "no light".
    pub dark_name: Option<&'static str>,
    /// The surfaces of a scene.
    pub walls: Option<Field<Option<Surface>>>,
    /// Lines and points drawn on top.
    pub overlays: Vec<Overlay>,
    /// Pixels per cell; `None` for the default of the picture.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
}

impl Request {
    /// The options of a map of the energies of cells (W).
    #[must_use]
    pub fn into_options(self) -> HeatOptions {
        HeatOptions {
            title: self.title,
            quantity: self.quantity.unwrap_or_else(|| "energy of a cell / W".to_owned()),
            scale: self.decades.map_or(HeatScale::Linear, |decades| HeatScale::Logarithmic { decades }),
            sources: self.sources,
            source_name: self.source_name.unwrap_or(HeatOptions::default().source_name),
            dark_name: self.dark_name,
            walls: self.walls,
            overlays: self.overlays,
            cell_px: self.cell_px,
            cell: self.cell,
            ..HeatOptions::default()
        }
    }
}

/// The energy of every cell, W.
#[must_use]
pub fn picture(energy: &Field<f64>, request: Request) -> Scene {
    heat_map(energy, &request.into_options())
}
