//! What a panel is.

use crate::names::Names;
use crate::results::Results;
use crate::runs::gradient as gradient_run;
use crate::unavailable::Unavailable;
use tigereye_core::{CellShape, Field, Grid};
use tigereye_render::{Overlay, Scene};
use tigereye_views::gradient;
use tigereye_views::total_anisotropy::ThinCells;

/// A picture of the results, every name looked up; or why it is not to be had.
pub(crate) type Picture = Box<dyn Fn(&Drawing<'_>) -> Result<Scene, Unavailable> + Send + Sync>;
/// The curves behind a picture.
pub(crate) type Curves = Box<dyn Fn(&Results<'_>) -> Result<Vec<Curve>, Unavailable> + Send + Sync>;

/// What stands in the experiment file, and how it is drawn.
pub(crate) trait PanelKind {
    /// Looks up names, checks cells and steps, and parses expressions; `None` where something is wrong, which is
    /// reported.
    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel>;
}

/// A panel, ready to be drawn.
pub(crate) struct PlannedPanel {
    /// Heading.
    pub(crate) title: String,
    pub(crate) picture: Picture,
    /// Curves that are written as a table, too.
    pub(crate) curves: Option<Curves>,
    /// Whether it shows seconds, which are others in every run.
    pub(crate) is_timed: bool,
}

impl PlannedPanel {
    /// A panel that a closure draws.
    pub(crate) fn new(
        title: &str,
        picture: impl Fn(&Drawing<'_>) -> Result<Scene, Unavailable> + Send + Sync + 'static,
    ) -> Self {
        Self { title: title.to_owned(), picture: Box::new(picture), curves: None, is_timed: false }
    }
}

/// A curve of a chart.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve {
    /// Name in the legend.
    pub(crate) label: String,
    pub(crate) points: Vec<(f64, f64)>,
    /// Whether it is a formula: a line without markers.
    pub(crate) is_formula: bool,
}

/// Width of a panel among others, pixels.
pub(crate) const PANEL_PX: usize = 330;

/// What a panel is drawn of and where.
pub(crate) struct Drawing<'a> {
    pub(crate) results: &'a Results<'a>,
    /// Whether the panel is the whole figure.
    pub(crate) alone: bool,
    /// Heading within the picture: empty among others, where it stands above.
    pub(crate) title: String,
}

impl Drawing<'_> {
    /// Pixels per cell: chosen by the picture where it stands alone, fitting a panel otherwise.
    pub(crate) fn cell_px(&self, grid: Grid) -> Option<usize> {
        self.cell_px_of(grid, CellShape::SQUARE)
    }

    /// The same for the smaller side of cells that need not be square.
    pub(crate) fn cell_px_of(&self, grid: Grid, cell: CellShape) -> Option<usize> {
        let longest = cell.longer_side([grid.width(), grid.height()]);
        (!self.alone).then(|| (PANEL_PX / longest.ceil() as usize).max(2))
    }

    /// A scalar of a gradient in colours.
    pub(crate) fn gradient_map(
        &self,
        scalar: &Field<f64>,
        run: &gradient_run::Outcome,
        which: gradient::Scalar,
        mut overlays: Vec<Overlay>,
    ) -> Scene {
        // Beneath the others.
        overlays.splice(0..0, run.thin.iter().map(ThinCells::overlay));
        let request = gradient::Request {
            title: self.title.clone(),
            scalar: which,
            walls: run.surfaces.clone(),
            overlays,
            cell_px: self.cell_px(scalar.grid()),
            ..gradient::Request::default()
        };
        gradient::picture(scalar, request)
    }
}
