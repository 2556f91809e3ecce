//! Positions of cells: in index space for the thesis's fields, in a physical window for the others.

use crate::{Parameter, Settings};
use tigereye_core::{Cell, Field, Grid, Tensor2, math};

/// The tensor `R(phi) diag(q, 1) / sqrt(q)`: axis ratio `q`, determinant 1, major axis in direction `phi_rad`.
pub(crate) fn glyph(q: f64, phi_rad: f64) -> Tensor2 {
    let root = q.sqrt();
    Tensor2::from_axes(phi_rad, root, 1.0 / root)
}

/// The glyph along the vector `(dx, dy)`, the identity if it vanishes.
pub(crate) fn glyph_along(q: f64, dy: f64, dx: f64) -> Tensor2 {
    if dx == 0.0 && dy == 0.0 { Tensor2::IDENTITY } else { glyph(q, math::atan2(dy, dx)) }
}

/// A cell in index space. Each axis has its own length.
///
/// ```text
///   (0,0) ---- i ---->  last_i
///     |
///     j       (mid_i, mid_j)        up = (last_j - j) / last_j
///     v
///   last_j                          along = i / last_i
/// ```
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Column.
    pub(crate) i: f64,
    /// Row, 0 on top.
    pub(crate) j: f64,
    /// Last column, width - 1.
    pub(crate) last_i: f64,
    /// Last row, height - 1.
    pub(crate) last_j: f64,
}

impl Place {
    pub(crate) fn new(grid: Grid, cell: Cell) -> Self {
        let last_i = (grid.width() - 1) as f64;
        Self { i: cell.x as f64, j: cell.y as f64, last_i, last_j: (grid.height() - 1) as f64 }
    }
    /// Column relative to the middle; half-integer if the width is even.
    pub(crate) fn right_of_middle(&self) -> f64 {
        self.i - 0.5 * self.last_i
    }
    /// Row relative to the middle, growing downwards.
    pub(crate) fn below_middle(&self) -> f64 {
        self.j - 0.5 * self.last_j
    }
    /// `i / (width - 1)`: 0 on the left, 1 on the right; 0 for a single column.
    pub(crate) fn along(&self) -> f64 {
        if self.last_i > 0.0 { self.i / self.last_i } else { 0.0 }
    }
    /// `(height - 1 - j) / (height - 1)`: 0 at the bottom, 1 on top; 0 for a single row.
    pub(crate) fn up(&self) -> f64 {
        if self.last_j > 0.0 { (self.last_j - self.j) / self.last_j } else { 0.0 }
    }
    /// Whether the cell lies on the line from the top left to the bottom right corner, one cell wide.
    pub(crate) fn on_falling_diagonal(&self) -> bool {
        self.on_diagonal(self.j)
    }
    /// Whether the cell lies on the line from the bottom left to the top right corner.
    pub(crate) fn on_rising_diagonal(&self) -> bool {
        self.on_diagonal(self.last_j - self.j)
    }
    /// Angle of the rising diagonal; 45 degrees for a square.
    pub(crate) fn diagonal_rad(&self) -> f64 {
        if self.last_i == 0.0 && self.last_j == 0.0 {
            math::FRAC_PI_4
        } else {
            math::atan2(self.last_j, self.last_i)
        }
    }
    fn on_diagonal(&self, j: f64) -> bool {
        // The longer axis is walked, the other rounded, so that the line has no gaps.
        if self.last_i >= self.last_j {
            self.last_i == 0.0 || math::round_ties_even(self.i * self.last_j / self.last_i) == j
        } else {
            math::round_ties_even(j * self.last_i / self.last_j) == self.i
        }
    }
}

/// A field whose tensors are functions of the position in index space.
pub(crate) fn index_field(settings: &Settings, tensor: impl Fn(&Place) -> Tensor2) -> Field<Tensor2> {
    let grid = settings.grid();
    Field::from_fn(grid, |cell| tensor(&Place::new(grid, cell)))
}

/// Square cells laid over a piece of the physical plane, samples at the cells' points: the longer side of the grid
/// reaches from `-extent` to `extent`, the middle of the grid is the origin, y points up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    grid: Grid,
    /// Distance of neighbouring samples.
    pub(crate) spacing: f64,
}

impl Window {
    pub(crate) fn new(grid: Grid, extent: f64) -> Self {
        let intervals = grid.width().max(grid.height()) - 1;
        // A single cell lies in the middle; its spacing is the window's own width.
        Self { grid, spacing: 2.0 * extent / intervals.max(1) as f64 }
    }
    pub(crate) fn x(&self, cell: Cell) -> f64 {
        (cell.x as f64 - 0.5 * (self.grid.width() - 1) as f64) * self.spacing
    }
    pub(crate) fn y(&self, cell: Cell) -> f64 {
        (0.5 * (self.grid.height() - 1) as f64 - cell.y as f64) * self.spacing
    }
}

/// The plane of a 3D field; the picture's axes are the plane's two letters, right and up.
pub(crate) const fn plane_parameter(words: &'static [&'static str]) -> Parameter {
    Parameter::choice("plane", words, "plane of the picture: its axes to the right and up")
}

/// An axis-parallel plane of space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plane {
    Xy,
    Xz,
    Yz,
}

impl Plane {
    /// The point at `(u, v)` in the plane (right, up) and at `offset` along its normal.
    pub(crate) const fn point(self, u: f64, v: f64, offset: f64) -> [f64; 3] {
        match self {
            Self::Xy => [u, v, offset],
            Self::Xz => [u, offset, v],
            Self::Yz => [offset, u, v],
        }
    }
    /// The part of a symmetric 3D tensor that lies in the plane.
    pub(crate) const fn section(self, t: &[[f64; 3]; 3]) -> Tensor2 {
        let (a, b) = match self {
            Self::Xy => (0, 1),
            Self::Xz => (0, 2),
            Self::Yz => (1, 2),
        };
        Tensor2::symmetric(t[a][a], t[a][b], t[b][b])
    }
}
