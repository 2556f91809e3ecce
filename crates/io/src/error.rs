//! What can be wrong with a file, and where.
//!
//! Lines and columns count from 1, bytes from 0 at the start of the file.

use thiserror::Error;
use tigereye_core::CoreError;

/// A file that cannot be read, or data that cannot be written.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IoError {
    // ---- text matrices
    /// A text without any number.
    #[error("line 1: expected rows of numbers, found none (an empty file, or words alone)")]
    EmptyText,
    /// A word that is not a number.
    #[error("line {line}, column {column}: expected a number, found `{found}`")]
    NotANumber {
        /// Line, from 1.
        line: usize,
        /// Column of the word, from 1.
        column: usize,
        /// The word, shortened.
        found: String,
    },
    /// A number that is not finite.
    #[error("line {line}, column {column}: expected a finite number, found `{found}`")]
    NotFinite {
        /// Line, from 1.
        line: usize,
        /// Column of the word, from 1.
        column: usize,
        /// The word, shortened.
        found: String,
    },
    /// A row with more or fewer numbers than the first.
    #[error("line {line}, column {column}: expected {expected} numbers as in line 1, found {found}")]
    RaggedRow {
        /// Line, from 1.
        line: usize,
        /// Column of the first number too many, or where the next was expected.
        column: usize,
        /// Numbers in this row.
        found: usize,
        /// Numbers in the first row.
        expected: usize,
    },
    /// 2x2 blocks need an even number of columns.
    #[error("line 1, column {column}: expected an even number of columns (2x2 blocks), found {columns}")]
    OddColumns {
        /// Column of the last number, from 1.
        column: usize,
        /// Numbers in the row.
        columns: usize,
    },
    /// 2x2 blocks need an even number of rows.
    #[error("line {line}: expected an even number of rows (2x2 blocks), the file ends after {rows}")]
    OddRows {
        /// The last line with numbers.
        line: usize,
        /// Rows with numbers.
        rows: usize,
    },
    /// An empty line above further rows.
    #[error("line {line}: expected numbers, found a blank line (they are allowed at the end only)")]
    BlankLine {
        /// Line, from 1.
        line: usize,
    },

    // ---- tables of vectors
    /// A row of a table with other columns than the first, or too few.
    #[error(
        "line {line}, column {column}: found {found} numbers, expected {expected}: x, y, u, v and as many as in the first row"
    )]
    TableRow {
        /// Line, from 1.
        line: usize,
        /// Where the row ends, from 1.
        column: usize,
        /// Numbers in this row.
        found: usize,
        /// Numbers that are needed.
        expected: usize,
    },
    /// A vector between the positions of the others.
    #[error(
        "line {line}: {axis} = {value} is off the lattice: expected positions in equal steps, here of {step}"
    )]
    Position {
        /// Line, from 1.
        line: usize,
        /// `x` or `y`.
        axis: char,
        /// The position.
        value: f64,
        /// Mean step of the positions.
        step: f64,
    },
    /// Two vectors at one position of the plane, or vectors of several planes.
    #[error(
        "line {line}: a second row at the x and y of line {before}: expected the vectors of one plane, one at each position"
    )]
    SamePosition {
        /// Line, from 1.
        line: usize,
        /// Line of the first one.
        before: usize,
    },
    /// Vectors at few of the positions that their coordinates span.
    #[error(
        "{vectors} vectors on a lattice of {width} x {height} positions: expected a vector at most of them"
    )]
    SparsePositions {
        /// Vectors in the file.
        vectors: usize,
        /// Different x.
        width: usize,
        /// Different y.
        height: usize,
    },

    /// A word that is none of those that say whether a point is valid.
    #[error("line {line}, column {column}: expected a number, true or false, found `{found}`")]
    NotValidity {
        /// Line, from 1.
        line: usize,
        /// Column of the word, from 1.
        column: usize,
        /// The word, shortened.
        found: String,
    },
    /// Columns of several times or parameters.
    #[error(
        "line {line}: the columns are those of several times or parameters ({found}): expected the name of one, such as `{first}`"
    )]
    TableTimes {
        /// The line that names the columns.
        line: usize,
        /// The times, or the first of many.
        found: String,
        /// One of them.
        first: String,
    },
    /// A zone of a Tecplot file that is not one point a line.
    #[error("line {line}: {found}: expected {expected}")]
    TecplotZone {
        /// The line that says so.
        line: usize,
        /// What the zone is.
        found: &'static str,
        /// What it should be, and how to get it.
        expected: &'static str,
    },

    // ---- sizes
    /// A header that declares more cells than the limit.
    #[error("byte {byte}: {cells} cells are declared, the limit is {limit}")]
    TooManyCells {
        /// Where they are declared.
        byte: usize,
        /// Declared cells.
        cells: u128,
        /// [`crate::Limits::cells`].
        limit: u64,
    },
    /// Arrays that hold more numbers than the limit.
    #[error("byte {byte}: array `{array}` brings the file to more than the limit of {limit} values")]
    TooManyValues {
        /// Name of the array.
        array: String,
        /// Where the array is declared.
        byte: usize,
        /// [`crate::Limits::values`].
        limit: u64,
    },

    // ---- npy
    /// A header that is not that of a `.npy` file.
    #[error("byte {byte}: expected {expected} in the .npy header")]
    NpyHeader {
        /// Where it went wrong.
        byte: usize,
        /// What should have been there.
        expected: &'static str,
    },
    /// An element type that is not read.
    #[error("byte {byte}: element type `{descr}` is not read: expected f4, f8, i1 to i8 or u1 to u8")]
    NpyType {
        /// Where the type is declared.
        byte: usize,
        /// The type as written.
        descr: String,
    },
    /// A header and data of different sizes.
    #[error(
        "byte {byte}: the header declares {declared} bytes of data, expected the {present} that are there"
    )]
    NpySize {
        /// First byte of the data.
        byte: usize,
        /// Bytes that the shape needs.
        declared: u128,
        /// Bytes behind the header.
        present: usize,
    },
    /// An array of another shape than wanted.
    #[error("an array of shape {shape:?}: expected {expected}")]
    NpyShape {
        /// Shape as read.
        shape: Vec<usize>,
        /// What was wanted.
        expected: &'static str,
    },

    /// A table whose columns are not known.
    #[error(
        "line {line}: the columns `{found}` are not understood: expected a line above the numbers with names such as x, y, u, v"
    )]
    TableHeader {
        /// The line that should name them, or the first of the numbers.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// Positions in an archive that are no lattice.
    #[error(
        "the positions `{names}` form no lattice with equal steps (position {position}, from 0): expected them in equal steps, or an archive without them"
    )]
    NpzPositions {
        /// Names of the arrays.
        names: String,
        /// The first position that is off.
        position: usize,
    },
    /// An array whose first axis, or first two, are the components.
    #[error(
        "an array of shape {shape:?}, which could have its components first: expected them last, as numpy.moveaxis(array, 0, -1) puts them"
    )]
    NpyComponentsFirst {
        /// Shape as read.
        shape: Vec<usize>,
    },

    // ---- parts
    /// A `.part` file with something else where its format has a fixed meaning.
    #[error("byte {byte}: expected {expected}")]
    PartField {
        /// Where.
        byte: usize,
        /// What should have been there.
        expected: &'static str,
    },
    /// A `.part` file of a format that is not read.
    #[error("byte {byte}: version {found} of the format: expected {expected}")]
    PartVersion {
        /// Where the version stands.
        byte: usize,
        /// The version found.
        found: u32,
        /// The version that is read.
        expected: u32,
    },
    /// A `.part` file of another length than its sizes add up to.
    #[error("byte {byte}: the file has {present} bytes, expected {declared}")]
    PartLength {
        /// Where the file ends, or where it should have ended.
        byte: usize,
        /// Length of the file.
        present: usize,
        /// Length as declared.
        declared: u128,
    },
    /// A `.part` file that was changed.
    #[error("byte {byte}: expected the checksum of everything before it: the file is damaged")]
    PartChecksum {
        /// Where the checksum stands.
        byte: usize,
    },

    // ---- XML
    /// Text that is not well-formed XML.
    #[error("byte {byte}: not well-formed XML: {problem}")]
    XmlSyntax {
        /// Where.
        byte: usize,
        /// What the XML parser says.
        problem: String,
    },
    /// XML that is not what VTK files hold, or beyond the limits on nesting and lengths.
    #[error("byte {byte}: expected {expected}")]
    XmlStructure {
        /// Where.
        byte: usize,
        /// What should have been there.
        expected: &'static str,
    },
    /// An element where another is expected.
    #[error("byte {byte}: found element <{element}>, expected {expected}")]
    XmlElement {
        /// Where the element starts.
        byte: usize,
        /// Its name.
        element: String,
        /// What is expected in its place.
        expected: &'static str,
    },
    /// An element that is missing.
    #[error("byte {byte}: element <{parent}> holds no <{element}>")]
    XmlMissingElement {
        /// Where the parent starts.
        byte: usize,
        /// Name of the parent.
        parent: String,
        /// Name of the missing child.
        element: &'static str,
    },
    /// An attribute that is missing.
    #[error("byte {byte}: element <{element}> has no attribute {attribute}: expected {expected}")]
    XmlMissingAttribute {
        /// Where the element starts.
        byte: usize,
        /// Its name.
        element: String,
        /// Name of the attribute.
        attribute: &'static str,
        /// What its value should be.
        expected: &'static str,
    },
    /// An attribute with a value that makes no sense.
    #[error("byte {byte}: {attribute}=\"{value}\" of element <{element}>: expected {expected}")]
    XmlAttribute {
        /// Where the element starts.
        byte: usize,
        /// Its name.
        element: String,
        /// Name of the attribute.
        attribute: String,
        /// Its value, shortened.
        value: String,
        /// What it should be.
        expected: &'static str,
    },
    /// A data set in several pieces.
    #[error("byte {byte}: {pieces} <Piece> elements: expected one (merge the pieces first)")]
    Pieces {
        /// Where the second piece, or the data set without any, starts.
        byte: usize,
        /// Number of pieces.
        pieces: usize,
    },

    // ---- arrays of VTK files
    /// An array in an encoding or of a type that is not read.
    #[error("byte {byte}: array `{array}` is not read: {attribute}=\"{value}\", expected {expected}")]
    ArrayUnsupported {
        /// Name of the array.
        array: String,
        /// Where the array is declared.
        byte: usize,
        /// Attribute that says so.
        attribute: &'static str,
        /// Its value, shortened.
        value: String,
        /// Values that are read.
        expected: &'static str,
    },
    /// An array with another amount of data than its declaration.
    #[error("byte {byte}: array `{array}` holds {found} {unit}, expected {expected}")]
    ArraySize {
        /// Name of the array.
        array: String,
        /// Where its data start.
        byte: usize,
        /// Amount in the file.
        found: u128,
        /// Amount declared.
        expected: u128,
        /// What is counted.
        unit: &'static str,
    },
    /// An array whose data end too early.
    #[error("byte {byte}: array `{array}` is cut off: expected {needed} more bytes, {present} are there")]
    ArrayTruncated {
        /// Name of the array.
        array: String,
        /// From where the bytes are missing.
        byte: usize,
        /// Bytes needed from there.
        needed: u128,
        /// Bytes there.
        present: usize,
    },
    /// An array in text that holds something else than numbers of its type.
    #[error("byte {byte}: array `{array}`: expected a {scalar} number, found `{found}`")]
    ArrayNumber {
        /// Name of the array.
        array: String,
        /// Where the word starts.
        byte: usize,
        /// The word, shortened.
        found: String,
        /// Type of the array.
        scalar: &'static str,
    },
    /// Base64 text with an invalid character or length.
    #[error("byte {byte}: array `{array}`: expected valid base64")]
    ArrayBase64 {
        /// Name of the array.
        array: String,
        /// Where.
        byte: usize,
    },
    /// A compressed block that does not decompress to its declared size.
    #[error("byte {byte}: array `{array}`: block {block} is not {method} data of {expected} bytes")]
    ArrayBlock {
        /// Name of the array.
        array: String,
        /// Where the block (in base64: the array's blocks) starts.
        byte: usize,
        /// Index of the block.
        block: usize,
        /// Compression method.
        method: &'static str,
        /// Bytes it should decompress to.
        expected: usize,
    },
    /// Text that is not valid UTF-8 or does not end.
    #[error("byte {byte}: array `{array}`: expected strings in UTF-8, each ended by a zero byte")]
    ArrayText {
        /// Name of the array.
        array: String,
        /// Where its data start.
        byte: usize,
    },

    /// A `.npz` archive that cannot be read, or without the array asked for.
    #[error("{problem}: expected {expected}")]
    Archive {
        /// What is wrong, with the arrays that are there.
        problem: String,
        /// What should be there.
        expected: &'static str,
    },
    /// A picture that cannot be decoded.
    #[error("expected a PNG picture: {problem}")]
    Png {
        /// What the decoder says.
        problem: String,
    },

    // ---- tensor volumes
    /// Diffusion-weighted images where tensors were expected.
    #[error(
        "line {line}: these are diffusion-weighted images: expected tensors, as `tend estim` of teem or `DWIToDTIEstimation` of 3D Slicer fit them"
    )]
    NrrdWeighted {
        /// The line that says so.
        line: usize,
    },
    /// A field of an NRRD header that is missing or makes no sense.
    #[error("line {line}: NRRD field `{field}`: found `{found}`, expected {expected}")]
    NrrdField {
        /// Line, from 1; that of the header's end for a missing field.
        line: usize,
        /// Name of the field.
        field: &'static str,
        /// Its value, shortened.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
    /// A field of a NIfTI header that makes no sense.
    #[error("byte {byte}: NIfTI field {field}: found {found}, expected {expected}")]
    NiftiField {
        /// Where the field stands, in the unpacked file.
        byte: usize,
        /// Name of the field in the standard.
        field: &'static str,
        /// Its value.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
    /// A legacy VTK file with something else where its format has a fixed meaning.
    #[error("byte {byte}: found `{found}`, expected {expected}")]
    LegacyWord {
        /// Where.
        byte: usize,
        /// What is there, shortened.
        found: String,
        /// What should have been there.
        expected: &'static str,
    },
    /// Data that end too early.
    #[error("byte {byte}: the data are cut off: expected {needed} bytes, {present} are there")]
    DataTruncated {
        /// Where the data start.
        byte: usize,
        /// Bytes that the header declares.
        needed: u128,
        /// Bytes there, after decompression.
        present: u64,
    },
    /// Corrupt compressed data.
    #[error("byte {byte}: expected gzip data: {problem}")]
    Gzip {
        /// Where they start.
        byte: usize,
        /// What the decompressor says.
        problem: String,
    },
    /// A word in text data that is not a number of its type, or missing.
    #[error("byte {byte}: found `{found}`, expected a {scalar} number")]
    DataWord {
        /// Where.
        byte: usize,
        /// The word, shortened; empty at the end.
        found: String,
        /// Type of the numbers.
        scalar: &'static str,
    },
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
    #[error("the file has no measurement frame: expected frame voxel, world or fsl")]
    NoMeasurementFrame,
    /// Voxel axes that are not at right angles, with tensors in another frame than theirs.
    #[error(
        "the voxel axes are not at right angles (off by {off:e}): expected orthogonal axes, or tensors in frame voxel"
    )]
    SkewedAxes {
        /// Largest cosine between two axes.
        off: f64,
    },
    /// A volume without a choice of plane.
    #[error(
        "{} x {} x {} voxels: a plane is needed, expected a slice x=I, y=I or z=I (I from 0)",
        size[0], size[1], size[2]
    )]
    PlaneNeeded {
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
    PlaneConflict {
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

    // ---- meaning
    /// No array of the wanted name or kind.
    #[error("no {wanted}: the arrays are {}", listed(available))]
    NoArray {
        /// What was looked for.
        wanted: String,
        /// Names and components of the arrays there are.
        available: Vec<String>,
    },
    /// Several arrays fit and none is marked as active.
    #[error("several arrays fit: {}: expected the name of one", listed(candidates))]
    AmbiguousArray {
        /// Names and components of the arrays that fit.
        candidates: Vec<String>,
    },
    /// An array without components.
    #[error("array `{array}` has {components} components: expected at least one")]
    Components {
        /// Name of the array.
        array: String,
        /// Its components.
        components: usize,
    },
    /// Slice indices that do not fit a volume.
    #[error(
        "field data `slices` holds {found:?}: expected {expected} ascending sample indices below {limit}"
    )]
    Slices {
        /// The numbers found (at most eight).
        found: Vec<f64>,
        /// Number of layers of the volume.
        expected: usize,
        /// Indices must be smaller.
        limit: usize,
    },
    /// An image without any point.
    #[error(
        "{} x {} x {} points cannot be written: expected at least one along each axis",
        dimensions[0], dimensions[1], dimensions[2]
    )]
    EmptyImage {
        /// Points along x, y and z.
        dimensions: [usize; 3],
    },
    /// More voxels along an axis than the format can say.
    #[error(
        "{} x {} x {} voxels do not fit into NIfTI-1: expected at most 32767 along each axis",
        size[0], size[1], size[2]
    )]
    NiftiSize {
        /// Voxels along each axis.
        size: [usize; 3],
    },
    /// A name or text that the format cannot hold.
    #[error("`{name}` cannot be written: expected text without control characters")]
    Unwritable {
        /// Name of the array.
        name: String,
    },
    /// Sizes that core refuses.
    #[error(transparent)]
    Core {
        /// Core's own words.
        #[from]
        source: CoreError,
    },
}

fn listed(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// At most 40 characters of something found in a file, for messages.
pub(crate) fn shortened(bytes: &[u8]) -> String {
    const LENGTH: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * LENGTH)]);
    let mut short: String =
        text.chars().take(LENGTH).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().nth(LENGTH).is_some() {
        short.push_str("...");
    }
    short
}
