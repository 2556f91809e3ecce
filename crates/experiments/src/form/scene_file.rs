//! What may stand in a scene's file, `NAME.scene.ron`.

use super::choices::NormalizationRule;
use super::field_source::FieldSource;
use super::light_source::LightSource;
use super::numbers::{Finite, Fraction, Positive};
use super::placed::Placed;
use serde::Deserialize;

/// Walls, mirrors and crystals on a grid, with lights.
///
/// Positions are in cells, `(0, 0)` the centre of the upper left one, y downwards; angles in degrees, counter-clockwise
/// from the right. A cell belongs to a shape where its centre does, border included; later parts cover earlier ones.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Version of the format, 1.
    pub format: Placed<u32>,
    /// What it is.
    pub title: String,
    /// Columns.
    pub width: Placed<usize>,
    /// Rows.
    pub height: Placed<usize>,
    /// What stands in the empty space, in the order in which it is put down.
    #[serde(default)]
    pub parts: Vec<ScenePart>,
    /// The lights, where no others are asked for.
    #[serde(default)]
    pub lights: Vec<Placed<LightSource>>,
}

/// A shape of one material.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ScenePart {
    /// Where it is.
    pub shape: Placed<ShapeSource>,
    /// What it is made of.
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
        /// The opposite one.
        to: Point,
    },
    /// A disc.
    Disc {
        /// Its middle.
        centre: Point,
        /// Its radius, cells.
        radius: Positive,
    },
    /// All points within half a thickness of a line. Slanted walls are closed from a thickness of 1.5 on.
    Segment {
        /// One end.
        from: Point,
        /// The other one.
        to: Point,
        /// Thickness, cells.
        #[serde(default = "Positive::one")]
        thickness: Positive,
    },
    /// A closed polygon.
    Polygon(Vec<Point>),
    /// The dark pixels of a PNG picture, those of less than half the brightness.
    Bitmap {
        /// The file, looked up beside the scene's.
        path: String,
        /// Column and row of its upper left pixel. Left out, the picture must be as large as the scene.
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
    /// Everything outside of a shape.
    Outside(Box<ShapeSource>),
}

/// What a part is made of.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum MaterialSource {
    /// Nothing: a door in what lies beneath.
    Empty,
    /// Swallows all light.
    Absorber,
    /// Passes this part of the light on, in all directions alike.
    Filter(Fraction),
    /// Reflects like a mirror, on both sides.
    Mirror {
        /// The part of the light that is sent back.
        #[serde(default = "Fraction::one")]
        reflectance: Fraction,
        /// Direction of the mirror's line, degrees; along the surface of the shape where it is left out. Multiples of
        /// 22.5 degrees are exact; for others light is split between the two nearest of them.
        #[serde(default)]
        angle_deg: Option<Finite>,
    },
    /// Reflects like a diffuse wall, on both sides (Lambert's law).
    Diffuse {
        /// The part of the light that is sent back.
        #[serde(default = "Fraction::one")]
        reflectance: Fraction,
        /// Direction of the wall's line, degrees; along the surface of the shape where it is left out.
        #[serde(default)]
        angle_deg: Option<Finite>,
    },
    /// Passes light on as tensors do.
    Crystal {
        /// The tensors; the field must reach all of the shape.
        field: Box<FieldSource>,
        /// Column and row at which the field's upper left cell lies.
        #[serde(default)]
        at: (usize, usize),
        /// How their transmission is scaled.
        #[serde(default)]
        normalization: NormalizationRule,
    },
}
