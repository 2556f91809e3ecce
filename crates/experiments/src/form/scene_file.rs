//! The contents of a scene file, `NAME.scene.ron`.

use super::choices::NormalizationRule;
use super::field_source::FieldSource;
use super::light_source::LightSource;
use super::numbers::{Finite, Fraction, Positive};
use super::placed::Placed;
use serde::Deserialize;

/// Walls, mirrors and crystals on a grid, with lights.
///
/// Positions are in cells, `(0, 0)` the centre of the upper left one, y downwards; angles in degrees, counter-clockwise
/// from the right. A cell belongs to a shape if its centre does, border included; later parts cover earlier ones.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Version of the format, 1.
    pub format: Placed<u32>,
    /// Heading.
    pub title: String,
    /// Columns.
    pub width: Placed<usize>,
    /// Rows.
    pub height: Placed<usize>,
    /// The parts in the empty space; later ones cover earlier ones.
    #[serde(default)]
    pub parts: Vec<ScenePart>,
    /// The lights, unless a run specifies others.
    #[serde(default)]
    pub lights: Vec<Placed<LightSource>>,
}

/// A shape of one material.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ScenePart {
    /// The region it covers.
    pub shape: Placed<ShapeSource>,
    /// Its material.
    pub material: Placed<MaterialSource>,
}

/// A point, x and y in cells.
pub type Point = (Finite, Finite);

/// A region.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum ShapeSource {
    /// An upright rectangle.
    Rectangle {
        /// One corner.
        from: Point,
        /// The opposite corner.
        to: Point,
    },
    /// A disc.
    Disc {
        /// Its centre.
        centre: Point,
        /// Its radius, cells.
        radius: Positive,
    },
    /// All points within half a thickness of a line. Slanted walls are closed from a thickness of 1.5 upwards.
    Segment {
        /// One end.
        from: Point,
        /// The other end.
        to: Point,
        /// Thickness, cells.
        #[serde(default = "Positive::one")]
        thickness: Positive,
    },
    /// A closed polygon.
    Polygon(Vec<Point>),
    /// The dark pixels of a PNG picture, those below half the full brightness.
    Bitmap {
        /// The file, looked up beside the scene's.
        path: String,
        /// Column and row of its upper left pixel. If omitted, the picture must be as large as the scene.
        #[serde(default)]
        at: Option<(usize, usize)>,
        /// Takes the bright pixels instead.
        #[serde(default)]
        inverted: bool,
    },
    /// All points within half a thickness of the border of a rectangle, a disc or a polygon.
    Outline {
        /// The shape.
        of: Box<ShapeSource>,
        /// Thickness, cells.
        #[serde(default = "Positive::one")]
        thickness: Positive,
    },
    /// Everything outside a shape.
    Outside(Box<ShapeSource>),
}

/// What a part is made of.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum MaterialSource {
    /// Nothing: an opening in the parts beneath.
    Empty,
    /// Absorbs all light.
    Absorber,
    /// Passes this fraction of the light on, equally in all directions.
    Filter(Fraction),
    /// Reflects like a mirror, on both sides.
    Mirror {
        /// Fraction of the light that is reflected.
        #[serde(default = "Fraction::one")]
        reflectance: Fraction,
        /// Direction of the mirror's line, degrees; by default along the surface of the shape. Multiples of 22.5
        /// degrees are exact; at other angles light is split between the two nearest of them.
        #[serde(default)]
        angle_deg: Option<Finite>,
    },
    /// Reflects like a diffuse wall, on both sides (Lambert's law).
    Diffuse {
        /// Fraction of the light that is reflected.
        #[serde(default = "Fraction::one")]
        reflectance: Fraction,
        /// Direction of the wall's line, degrees; by default along the surface of the shape.
        #[serde(default)]
        angle_deg: Option<Finite>,
    },
    /// Passes light on according to a tensor field.
    Crystal {
        /// The tensors; the field must cover the whole shape.
        field: Box<FieldSource>,
        /// Column and row at which the field's upper left cell lies.
        #[serde(default)]
        at: (usize, usize),
        /// How their transmission is scaled.
        #[serde(default)]
        normalization: NormalizationRule,
    },
}
