//! What keeps numbers from being tensors on a lattice, and a volume from being cut.

use thiserror::Error;

/// What keeps numbers on points from being a volume of tensors.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum VolumeError {
    /// Points that do not lie on a regular lattice.
    #[error(
        "the points form no lattice: expected one at every node of equal steps along each axis, in any order; point {point} (from 0) is off, or one is missing or doubled"
    )]
    NoLattice {
        /// The first point that is off, from 0.
        point: usize,
    },
    /// A component order that is not understood, or does not fit the array.
    #[error("component order `{order}` for {components} components: expected {expected}")]
    Order {
        /// As given.
        order: String,
        /// Numbers per tuple in the file.
        components: usize,
        /// What would fit.
        expected: &'static str,
    },
    /// Tuples that make no tensor without being told how.
    #[error(
        "`{array}` has {components} components and nothing says that they are a tensor's: expected 9, 6, 4 or 3 (or 7 with a mask), 3 or 4 with their order"
    )]
    NoTensor {
        /// Name of the array or kind.
        array: String,
        /// Numbers per tuple.
        components: usize,
    },
    /// Numbers without directions.
    #[error("`{array}` holds principal values{}: they have no directions, expected the components of a tensor", if names.is_empty() { String::new() } else { format!(" ({names})") })]
    Principal {
        /// Name of the array.
        array: String,
        /// Names of its components.
        names: String,
    },
    /// Arrays that are no components of one tensor.
    #[error("the components `{first}` and others do not fit together: expected arrays of one number, or as many rows as each has numbers, on the same points, found {}", found.join(", "))]
    UnequalComponents {
        /// Name of the first array.
        first: String,
        /// Name and components of all.
        found: Vec<String>,
    },
    /// Components of one plane where another one is shown.
    #[error(
        "the components are {order}, and the plane shows {needed}: expected its own components, for example --order {needed}"
    )]
    OtherPlane {
        /// The order of the components.
        order: String,
        /// Components of the plane.
        needed: String,
    },
    /// Vectors of two components in a plane that they do not lie in.
    #[error("`{array}` has two components, along {found}, and the plane {shown}: expected three{help}")]
    VectorsAcross {
        /// Name of the array or kind.
        array: String,
        /// The axes of the components.
        found: String,
        /// What the plane shows, or that it is tilted.
        shown: String,
        /// Another way, where there is one.
        help: &'static str,
    },
    /// Tensors that six components cannot hold.
    #[error(
        "the tensors are not symmetric: expected nine components for them (--write-order nifti, or another format)"
    )]
    NotSymmetric,
    /// Engineering shears where every entry is a number of its own.
    #[error("engineering shears: expected an order in which xy and yx are one component, found {order}")]
    NoSharedShear {
        /// The order of the components.
        order: String,
    },
    /// Tuples that are not what should be differentiated.
    #[error("`{array}` has {components} components: expected {expected}")]
    TupleSize {
        /// Name of the array or kind.
        array: String,
        /// Numbers per tuple.
        components: usize,
        /// How many there should be.
        expected: &'static str,
    },
    /// A frame that the file does not describe.
    #[error("the file has no measurement frame: expected frame voxel, world, fsl or lps")]
    NoMeasurementFrame,
    /// Voxel axes that are not at right angles, with tensors in another frame than theirs.
    #[error(
        "the voxel axes are not at right angles (off by {off:e}): expected orthogonal axes, or tensors in frame voxel"
    )]
    SkewedAxes {
        /// Largest cosine between two axes.
        off: f64,
    },
}

/// What is wrong with the choice of a plane.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PlaneError {
    /// A volume without a choice of plane.
    #[error(
        "{} x {} x {} voxels: a plane is needed, expected a slice x=I, y=I or z=I (I from 0)",
        size[0], size[1], size[2]
    )]
    Needed {
        /// Voxels along each axis.
        size: [usize; 3],
    },
    /// A plane without the index of its slice.
    #[error("plane {plane} needs a slice {axis}=I, expected I from 0 to {last}")]
    SliceNeeded {
        /// The plane.
        plane: &'static str,
        /// Its normal.
        axis: char,
        /// Largest index.
        last: usize,
    },
    /// A plane and a slice that do not belong together.
    #[error("plane {plane} and a slice along {axis} do not fit: expected a slice along {normal}")]
    Conflict {
        /// The plane.
        plane: &'static str,
        /// Axis of the slice.
        axis: char,
        /// Normal of the plane.
        normal: char,
    },
    /// A slice outside the volume.
    #[error("slice {axis}={index}: expected an index from 0 to {last}")]
    SliceRange {
        /// Axis of the slice.
        axis: char,
        /// As given.
        index: usize,
        /// Largest index.
        last: usize,
    },
    /// A crop that is empty or sticks out.
    #[error("crop {}:{},{}:{}: expected a part of 0:{width},0:{height} (the end not included)", x[0], x[1], y[0], y[1])]
    CropRange {
        /// First column and the one behind the last.
        x: [usize; 2],
        /// First row and the one behind the last.
        y: [usize; 2],
        /// Columns of the plane.
        width: usize,
        /// Rows of the plane.
        height: usize,
    },
}
