//! Lines along the axes of tensors, degenerate points, the separation of neighbouring lines, textures; ridges and
//! contours of scalars.
//!
//! Points are in cells ([`tigereye_core::Point`], y downwards), directions are physical ([`tigereye_core::Vector`], y
//! upwards) and lengths count in the smaller side of a cell ([`tigereye_core::CellShape`]). Between the centres of four
//! cells tensors are interpolated component by component. Axes ([`Axes`]) have no sign: a line continues in whichever
//! of the two directions is closer to the one it came from.
//!
//! Scalars are interpolated by quintic splines for ridges and linearly for contours. A volume has a third axis, the
//! direction of a light transport gradient, that may be periodic ([`Volume`]).

pub mod agreement;
mod axes;
mod chains;
mod contours;
mod convolution;
mod degenerate;
mod extraction_error;
mod flow_map;
mod followed;
mod ftle;
mod hyperstreamline;
mod interpolated;
mod lanes;
mod line_options;
mod nearest;
mod ridges;
mod seeding;
mod shapes;
mod slope;
mod spline;
mod tensor_line;
mod tetrahedra;
mod topology;
mod volume;
mod walk;

pub use axes::{Axes, Decomposition, Domain, Family, Frame, Major, OrderedAxes};
pub use contours::{isolines, isosurface};
pub use convolution::{ConvolutionOptions, convolved, hyper_convolved};
pub use degenerate::{DegenerateKind, DegeneratePoint, degenerate_points};
pub use extraction_error::ExtractionError;
pub use flow_map::{advected, exponents};
pub use followed::{Followed, Following, is_complex, usual_axes};
pub use ftle::{Ftle, FtleOptions, SamplingError, fine_grid, ftle};
pub use hyperstreamline::half_widths;
pub use interpolated::{Interpolated, ellipse_tensors, signed_ellipse_tensors};
pub use line_options::{Inertia, LineEnd, LineOptions, Method};
pub use nearest::NearestSegment;
pub use ridges::{
    RidgeBounds, RidgeLines, RidgeOptions, RidgeSurface, Threshold, ridge_lines, ridge_surface,
};
pub use seeding::{MAX_POINTS, evenly_spaced};
pub use shapes::{Polyline, Polylines, Surface};
pub use tensor_line::{TensorLine, half_line, half_line_end, tensor_line};
pub use topology::{Separatrix, Topology};
pub use volume::Volume;
