//! What can be wrong with a scene.

use thiserror::Error;
use tigereye_core::CoreError;

/// A scene that cannot be built, with the part that is at fault.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{fault}")]
pub struct SceneError {
    /// Index of the part, in the order of the scene; `None`: the scene as a whole.
    pub part: Option<usize>,
    /// What is wrong with it.
    pub fault: Fault,
}

/// What is wrong with a part of a scene, or with the whole.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Fault {
    /// No cells, or more than a scene may have.
    #[error("a scene of {width} x {height} cells is not possible: expected 1 to {max} cells", max = crate::limits::MAX_CELLS)]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A number of a shape that is not finite or absurdly large.
    #[error("the shape has the coordinate {value}: expected a number between -1e6 and 1e6")]
    Coordinate {
        /// The number.
        value: f64,
    },
    /// A thickness or radius that is not positive, or absurdly large.
    #[error("the {what} is {value}: expected more than 0, at most 1e6")]
    Extent {
        /// `radius` or `thickness`.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A line that is a point.
    #[error("the segment begins where it ends: expected two points")]
    NoLength,
    /// Too few corners.
    #[error("the polygon has {corners} corners: expected 3 or more")]
    Corners {
        /// How many it has.
        corners: usize,
    },
    /// Bitmaps, segments and outlines have no border of their own.
    #[error("an outline of a {what} is not possible: expected a rectangle, a disc or a polygon")]
    Outline {
        /// The kind of shape.
        what: &'static str,
    },
    /// No cell of the grid lies in the shape.
    #[error("the shape covers no cell of the {width} x {height} cells: expected one whose centre lies in it")]
    Outside {
        /// Columns of the scene.
        width: usize,
        /// Rows of the scene.
        height: usize,
    },
    /// A part of light outside 0 to 1.
    #[error("the {what} is {value}: expected 0 to 1")]
    Share {
        /// `reflectance` or `transmittance`.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A mirror's direction that is not a number.
    #[error("the angle is {value}: expected a finite number of degrees")]
    Angle {
        /// Its value.
        value: f64,
    },
    /// A tensor field that does not cover its shape.
    #[error(
        "the crystal's field of {width} x {height} cells lies at ({left}, {top}) and does not reach cell ({x}, {y}) of its shape"
    )]
    Crystal {
        /// Columns of the field.
        width: usize,
        /// Rows of the field.
        height: usize,
        /// Column of its upper left cell.
        left: usize,
        /// Row of its upper left cell.
        top: usize,
        /// Column of a cell it does not have.
        x: usize,
        /// Row of that cell.
        y: usize,
    },
    /// Shapes that take too long.
    #[error("the shapes so far are too many or too detailed for so many cells: expected at most {max} cells times sides", max = crate::limits::MAX_WORK)]
    Work,
    /// A tensor that is not finite, or a normalisation by a fraction that is none.
    #[error(transparent)]
    Core(#[from] CoreError),
}
