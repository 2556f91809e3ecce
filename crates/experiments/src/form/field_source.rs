//! Where tensor fields come from.

use super::named::Named;
use super::numbers::{Fraction, Sigma};
use super::placed::Placed;
use serde::Deserialize;

/// A tensor field in a file of its own, `NAME.field.ron`: commands and experiments accept it in place of a generator.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct FieldFile {
    /// Version of the format, 1.
    pub format: Placed<u32>,
    /// Heading of its sheet.
    pub title: String,
    /// Its origin: a paper, a formula, a measurement.
    #[serde(default)]
    pub source: String,
    /// The field.
    pub field: FieldSource,
}

/// The source of a tensor field.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum FieldSource {
    /// A generator with its parameters, as `tigereye field list` shows them.
    Generator {
        /// Name of the generator.
        name: String,
        /// Parameters that differ from their defaults, for example `{"size": "51"}`.
        #[serde(default)]
        parameters: Named<Parameter>,
    },
    /// Semi-axes given by expressions in x, y (-1 to 1, y up), i, j, n, r, theta.
    Axes {
        /// Cells per row.
        width: usize,
        /// Cells per column.
        height: usize,
        /// Direction of the major semi-axis, radians.
        phi: Placed<String>,
        /// Major semi-axis.
        s1: Placed<String>,
        /// Minor semi-axis.
        s2: Placed<String>,
    },
    /// The four components given by expressions in the same variables.
    Components {
        /// Cells per row.
        width: usize,
        /// Cells per column.
        height: usize,
        /// Component xx.
        xx: Placed<String>,
        /// Component xy.
        xy: Placed<String>,
        /// Component yx.
        yx: Placed<String>,
        /// Component yy.
        yy: Placed<String>,
    },
    /// A data file in any format that the program reads, or a field file (`.field.ron`), looked up beside the
    /// experiment file, in its parent folders, and among the program's built-in data. The options are those of the
    /// command line.
    File {
        /// Path of the file.
        path: String,
        /// Array of a VTK file or archive; `None`: its active tensors or its only tensor array.
        #[serde(default)]
        array: Option<String>,
        /// Arrays that hold one component each, `XX=S_XX,YY=S_YY,XY=S_XY`, or one row, `X=T_x,Y=T_y`.
        #[serde(default)]
        components: Option<String>,
        /// Component order: a tool's name or component names.
        #[serde(default)]
        order: Option<String>,
        /// Meaning of the shear components: `tensor` (the default) or `engineering`.
        #[serde(default)]
        shear: Option<String>,
        /// Axes that the components refer to: `voxel`, `world`, `measurement`, `fsl` or `lps`.
        #[serde(default)]
        frame: Option<String>,
        /// Slice of a volume, `z=10`.
        #[serde(default)]
        slice: Option<String>,
        /// Plane of a volume: `xy`, `xz` or `yz`.
        #[serde(default)]
        plane: Option<String>,
        /// Part of the plane, `X0:X1,Y0:Y1`.
        #[serde(default)]
        crop: Option<String>,
        /// Columns and rows to resample to, after cropping.
        #[serde(default)]
        resample: Option<(usize, usize)>,
        /// How tensors are derived from an image.
        #[serde(default)]
        derive: Option<DeriveRule>,
        /// File with one number per voxel; tensors whose number does not exceed
        /// [`mask_above`](Self::File::mask_above) become zero.
        #[serde(default)]
        mask: Option<String>,
        /// Array of the mask's file, where it has several.
        #[serde(default)]
        mask_array: Option<String>,
        /// What a mask, or the confidence in an NRRD file, must exceed.
        #[serde(default)]
        mask_above: f64,
        /// Treatment of tensors that are infinite or not a number: `refuse` (the default) or `zero`.
        #[serde(default)]
        not_finite: Option<String>,
        /// Keeps every n-th cell in both directions, starting at the upper left.
        #[serde(default = "one")]
        stride: usize,
    },
    /// Another field with noise added to its tensors.
    Noisy {
        /// The field.
        of: Box<FieldSource>,
        /// Size of the noise relative to each tensor (Frobenius norm, root mean square).
        share: Fraction,
        /// Seed of the random numbers.
        seed: u64,
    },
}

/// Tensors derived from an image; scales are standard deviations of Gaussians, in cells.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum DeriveRule {
    /// Gradient of a vector field.
    Gradient {
        /// Smoothing before differentiation.
        #[serde(default)]
        sigma: Option<Sigma>,
    },
    /// Second derivatives of a scalar field.
    Hessian {
        /// Smoothing before differentiation.
        #[serde(default)]
        sigma: Option<Sigma>,
    },
    /// Rate of strain: the symmetric part of the gradient of a vector field.
    StrainRate {
        /// Smoothing before differentiation.
        #[serde(default)]
        sigma: Option<Sigma>,
    },
    /// Averaged products of a scalar field's derivatives: light and lines run across stripes.
    Structure {
        /// Smoothing before differentiation.
        #[serde(default)]
        sigma: Option<Sigma>,
        /// Smoothing of the products.
        #[serde(default)]
        window: Option<Sigma>,
    },
    /// The structure tensor with its eigenvalues exchanged: light and lines run along stripes.
    Orientation {
        /// Smoothing before differentiation.
        #[serde(default)]
        sigma: Option<Sigma>,
        /// Smoothing of the products.
        #[serde(default)]
        window: Option<Sigma>,
    },
}

fn one() -> usize {
    1
}

/// A generator's parameter: a number, a flag or a word.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(try_from = "ron::Value")]
pub struct Parameter(pub String);

impl TryFrom<ron::Value> for Parameter {
    type Error = String;

    fn try_from(value: ron::Value) -> Result<Self, String> {
        match value {
            ron::Value::Bool(b) => Ok(Self(b.to_string())),
            ron::Value::String(s) => Ok(Self(s)),
            ron::Value::Number(n) => Ok(Self(number_text(n.into_f64()))),
            other => Err(format!("expected a number, true, false or a string, found {other:?}")),
        }
    }
}

fn number_text(x: f64) -> String {
    format!("{x}")
}
