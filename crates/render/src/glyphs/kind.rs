//! Kinds, scales and colours of glyphs.

use tigereye_core::{PrincipalAxes, Svd, Tensor2, choice};

/// The glyph of a tensor. In every kind, zero tensors are small hollow dots and non-finite tensors small crosses;
/// semi-axes are the singular values unless stated otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GlyphKind {
    /// The ellipse the tensor makes of the unit circle, with its major axis as a thin line. Totally anisotropic tensors
    /// are segments.
    #[default]
    Ellipse,
    /// The rectangle with the semi-axes as half-sides; segments as for ellipses.
    Box,
    /// The superellipse `|x / s1|^(2/e) + |y / s2|^(2/e) = 1` along the semi-axes with `e = (1 - c_l)^gamma` and
    /// `c_l = (s1 - s2) / (s1 + s2)`: a circle where isotropic, boxier the more anisotropic, a segment in the limit.
    ///
    /// Kindlmann ("Superquadric tensor glyphs", VisSym 2004) has two exponents, `(1 - c_p)^gamma` and
    /// `(1 - c_l)^gamma`. A tensor of the plane has no planar part: with `c_p = 0` this is the section of his glyph
    /// through its longest axis, with the `c_l` of two axes instead of three.
    Superquadric {
        /// Sharpness of edges, 0 (always an ellipse) to 100; [`GlyphKind::GAMMA`] is usual, and taken for a value that
        /// is not a number.
        gamma: f64,
    },
    /// The normal component in every direction, `r(n) = |n . T n|`, the section of Reynolds's glyph (Hashash, Yao and
    /// Wotring 2003, "Glyph and hyperstreamline representation of stress and strain tensors and material constitutive
    /// response"): filled lobes where it is positive (tension), hollow ones where it is negative (compression). It
    /// shows the symmetric part alone; along its axes the lobes reach its eigenvalues.
    Signed,
    /// The axes of the symmetric part as a cross of arrows, as long as its eigenvalues: heads outwards for tension,
    /// inwards for compression.
    Arrows,
    /// The ellipse `U S` of `A = U S V^T` together with the orthogonal factor `Q = U V^T`.
    ///
    /// For `det A >= 0` that is a rotation ([`tigereye_core::OrthogonalFactor`]): two opposite sectors open from the
    /// line `v1`, which becomes the major axis, to the major axis `u1`; their angle is that of the rotation, true
    /// whatever the ellipse, their radius 0.6 of the larger semi-axis. They are filled where it is counter-clockwise,
    /// hollow where it is clockwise; half a turn counts as counter-clockwise. If both semi-axes are equal, +x replaces
    /// `u1`. Positive semidefinite symmetric tensors have no sectors. For `det A < 0`, a reflection, a dashed line
    /// shows its invariant direction.
    Asymmetric,
}

choice!(GlyphKind {
    Ellipse = "ellipse": "The ellipse to which the tensor maps the unit circle.",
    Box = "box": "A rectangle along the semi-axes.",
    Superquadric { gamma: Self::GAMMA } = "superquadric":
        "A superellipse: round where isotropic, boxier the more anisotropic (Kindlmann 2004).",
    Signed = "signed":
        "The normal component in every direction: filled lobes for tension, hollow ones for compression.",
    Arrows = "arrows": "Arrows along the principal axes: outwards for tension, inwards for compression.",
    Asymmetric = "asymmetric": "The ellipse and the angle by which a tensor that is not symmetric turns.",
});

impl GlyphKind {
    /// The usual sharpness of superquadrics (Kindlmann 2004).
    pub const GAMMA: f64 = 3.0;

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ellipse => "Ellipse",
            Self::Box => "Box",
            Self::Superquadric { .. } => "Superquadric",
            Self::Signed => "Signed",
            Self::Arrows => "Arrow",
            Self::Asymmetric => "Ellipse and rotation",
        }
    }

    /// Least distance of glyphs, in pixels, at which their parts can be distinguished.
    pub(super) fn pitch_px(self) -> f64 {
        match self {
            Self::Ellipse | Self::Box | Self::Superquadric { .. } => 12.0,
            Self::Signed => 18.0,
            Self::Arrows | Self::Asymmetric => 24.0,
        }
    }

    /// The largest semi-axis as a fraction of the distance between glyphs, such that neighbours never touch.
    pub(super) fn radius(self) -> f64 {
        match self {
            // The corners of a square that stands on one.
            Self::Box => 0.45 / core::f64::consts::SQRT_2,
            Self::Superquadric { gamma } if gamma > Self::GAMMA => 0.45 / core::f64::consts::SQRT_2,
            // Rounded corners of the usual sharpness lie within 1.05 semi-axes.
            _ => 0.45,
        }
    }

    /// Whether the glyph shows only the symmetric part of a tensor.
    pub(super) const fn is_symmetric(self) -> bool {
        matches!(self, Self::Signed | Self::Arrows)
    }

    /// The largest semi-axis in the tensor's unit; not finite if the tensor cannot be drawn.
    pub(super) fn size(self, t: &Tensor2) -> f64 {
        match self {
            _ if !t.is_finite() => f64::NAN,
            Self::Signed | Self::Arrows => {
                let [l1, l2] = PrincipalAxes::of(t).values;
                l1.abs().max(l2.abs())
            }
            _ => Svd::of(t).s[0],
        }
    }
}

/// How glyphs are scaled against each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlyphScale {
    /// The largest semi-axis of the field fills a cell: sizes are comparable.
    #[default]
    Field,
    /// Semi-axes by the square root of the values, the largest filling a cell: fields with peaks stay legible.
    SquareRoot,
    /// Every glyph fills its cell: only shape and direction are shown.
    Glyph,
}

choice!(GlyphScale {
    Field = "field": "The largest glyph of the field fills a cell.",
    SquareRoot = "root": "By the square root; the largest glyph fills a cell.",
    Glyph = "glyph": "Every glyph fills its cell.",
});

/// The meaning of the colour of glyphs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlyphColour {
    /// Tension, compression or both, by the real parts of the eigenvalues; of [`GlyphKind::Asymmetric`], the sense of
    /// rotation.
    #[default]
    AxisSign,
    /// Linear anisotropy `(s1 - s2) / (s1 + s2)`.
    Anisotropy,
}

choice!(GlyphColour {
    AxisSign = "sign": "Tension and compression; of asymmetric glyphs the sense of rotation.",
    Anisotropy = "anisotropy": "Linear anisotropy.",
});
