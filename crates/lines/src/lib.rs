//! Lines along the axes of tensors, and the points where tensors have none.
//!
//! Points are `[x, y]` in cells: (0, 0) is the centre of the upper left cell, x to the right, y **downwards**. Between the
//! centres of four cells tensors are interpolated component by component. The axes are the half-axes of the ellipse that
//! a tensor makes of the unit circle (its left singular vectors), which are those of the eigenvectors where the tensor is
//! symmetric and positive. They have no sign: a line goes on in the direction that is nearer to where it came from.

mod axes;
mod convolution;
mod degenerate;
mod flow_map;
mod ftle;
mod hyperstreamline;
mod interpolated;
mod seeding;
mod tensor_line;
mod topology;

pub use axes::{Axes, Decomposition, Domain, Family, Frame};
pub use convolution::{ConvolutionOptions, convolved, hyper_convolved};
pub use degenerate::{DegenerateKind, DegeneratePoint, degenerate_points};
pub use flow_map::{advected, exponents};
pub use ftle::{Ftle, FtleOptions, SamplingError, fine_grid, ftle};
pub use hyperstreamline::half_widths;
pub use interpolated::{Interpolated, ellipse_tensors};
pub use seeding::evenly_spaced;
pub use tensor_line::{
    Inertia, LineEnd, LineOptions, Method, TensorLine, half_line, half_line_end, tensor_line,
};
pub use topology::{Separatrix, Topology};
