//! Poly data as files describe them: points, and cells that connect them.

use crate::image::{ActiveArrays, DataArray, FieldEntry};

/// Points anywhere in space, with vertices, lines, strips and polygons over them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolyData {
    /// Positions.
    pub points: Vec<[f64; 3]>,
    /// Single points and groups of them.
    pub verts: Cells,
    /// Polylines.
    pub lines: Cells,
    /// Triangle strips.
    pub strips: Cells,
    /// Polygons.
    pub polys: Cells,
    /// Arrays with one tuple per point.
    pub point_arrays: Vec<DataArray>,
    /// Arrays with one tuple per cell: vertices first, then lines, strips and polygons.
    pub cell_arrays: Vec<DataArray>,
    /// Names of the active point arrays.
    pub point_active: ActiveArrays,
    /// Names of the active cell arrays.
    pub cell_active: ActiveArrays,
    /// What belongs to the whole data set.
    pub field_data: Vec<FieldEntry>,
    /// Arrays that were passed over because they hold something else than numbers: name and type.
    pub skipped: Vec<String>,
}

/// Cells of one kind, each a list of points.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    connectivity: Vec<usize>,
    ends: Vec<usize>,
}

impl Cells {
    /// Adds a cell over points by their indices.
    pub fn push(&mut self, points: impl IntoIterator<Item = usize>) {
        self.connectivity.extend(points);
        self.ends.push(self.connectivity.len());
    }

    /// Number of cells.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no cell.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The cells as lists of points.
    pub fn iter(&self) -> impl Iterator<Item = &[usize]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(a, &b)| &self.connectivity[a..b])
    }

    /// All points of all cells, one cell after the other.
    pub(crate) fn connectivity(&self) -> &[usize] {
        &self.connectivity
    }

    /// Where each cell ends in [`Self::connectivity`].
    pub(crate) fn ends(&self) -> &[usize] {
        &self.ends
    }
}

impl PolyData {
    /// The four kinds of cells with the names of VTK's elements.
    pub(crate) const fn sections(&self) -> [(&'static str, &Cells); 4] {
        [("Verts", &self.verts), ("Lines", &self.lines), ("Strips", &self.strips), ("Polys", &self.polys)]
    }

    /// Cells of all kinds.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.sections().iter().map(|(_, cells)| cells.len()).sum()
    }
}
