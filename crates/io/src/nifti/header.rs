//! The 348 bytes that head a NIfTI-1 file.

use super::error::NiftiError;
use crate::inflate::DataError;
use crate::limits::LimitError;
use crate::volume::Content;
use crate::{ByteOrder, IoError, Limits, ScalarType};

/// Bytes of the header.
pub(super) const LENGTH: usize = 348;
/// Extensions before the data are skipped up to here.
const MAX_OFFSET: f64 = (1_u64 << 26) as f64;

/// Intents.
pub(super) const SYMMETRIC: i16 = 1005;
pub(super) const MATRIX: i16 = 1004;
/// Displacements and other vectors.
const VECTORS: [i16; 2] = [1006, 1007];

/// What other intents make of several numbers a voxel: no tensors, and no vectors along known axes. FSL's are those of
/// its warps (fnirt, topup).
const FOREIGN: [(i16, &str); 12] = [
    (1008, "a set of points"),
    (1009, "triangles"),
    (1010, "quaternions"),
    (2003, "RGB colours"),
    (2004, "RGBA colours"),
    (FNIRT_WARP, "a warp of FNIRT"),
    (2007, "coefficients of a cubic spline of FNIRT"),
    (2008, "coefficients of a cosine transform of FNIRT"),
    (2009, "coefficients of a quadratic spline of FNIRT"),
    (2016, "coefficients of a cubic spline of TOPUP"),
    (2017, "coefficients of a quadratic spline of TOPUP"),
    (2018, "a field of TOPUP"),
];
const FNIRT_WARP: i16 = 2006;

/// Refuses intents that are known to hold something else than tensors and vectors.
fn check_intent(intent: i16) -> Result<(), NiftiError> {
    let Some((_, words)) = FOREIGN.iter().find(|(code, _)| *code == intent) else { return Ok(()) };
    let expected = if intent == FNIRT_WARP {
        "tensors or vectors; displacements along FSL's axes are read by --frame fsl where the intent is 0 and they are relative"
    } else {
        "tensors (intent 1004, 1005 or 0) or vectors (1006, 1007 or 0)"
    };
    Err(fault(68, "intent_code", format!("{intent} ({words})"), expected))
}

/// Steps along the voxel axes, and the first voxel.
pub(super) type Position = ([[f64; 3]; 3], [f64; 3]);

/// What the header says, in range.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) order: ByteOrder,
    pub(super) scalar: ScalarType,
    /// First byte of the numbers.
    pub(super) offset: u64,
    pub(super) size: [usize; 3],
    pub(super) components: usize,
    /// What the intent makes of the components.
    pub(super) content: Content,
    /// The step along the fourth axis, where that is the components' and the header calls it time, in words.
    pub(super) time_step: Option<String>,
    /// Unit of the positions.
    pub(super) unit: Option<&'static str>,
    pub(super) kind: &'static str,
    /// Slope and intercept, where they do something.
    pub(super) scaling: Option<(f64, f64)>,
    /// And which part of the header it is from.
    pub(super) position: (Position, &'static str),
    /// The distance by which voxels lie elsewhere by the qform than by the sform, where it is more than rounding.
    pub(super) disagreement: Option<f64>,
}

/// Fields by their place.
struct Bytes<'a> {
    bytes: &'a [u8],
    order: ByteOrder,
}

impl Bytes<'_> {
    fn get<const N: usize>(&self, at: usize) -> [u8; N] {
        let mut b = [0; N];
        // The length was checked.
        b.copy_from_slice(&self.bytes[at..at + N]);
        if self.order == ByteOrder::Big {
            b.reverse();
        }
        b
    }

    fn short(&self, at: usize) -> i16 {
        i16::from_le_bytes(self.get(at))
    }

    fn float(&self, at: usize) -> f64 {
        f64::from(f32::from_le_bytes(self.get(at)))
    }

    fn floats<const N: usize>(&self, at: usize) -> [f64; N] {
        std::array::from_fn(|i| self.float(at + 4 * i))
    }
}

fn fault(byte: usize, field: &'static str, found: impl ToString, expected: &'static str) -> NiftiError {
    NiftiError::Field { byte, field, found: found.to_string(), expected }
}

impl Header {
    pub(super) fn parse(bytes: &[u8], limits: Limits) -> Result<Self, IoError> {
        let head = bytes.get(..LENGTH).ok_or(DataError::Truncated {
            byte: 0,
            needed: LENGTH as u128,
            present: bytes.len() as u64,
        })?;
        let fields = Bytes { bytes: head, order: byte_order(head)? };
        if &head[344..348] != b"n+1\0" {
            let found = format!("`{}`", crate::text::shortened(&head[344..347]));
            return Err(fault(344, "magic", found, "`n+1`: one file with header and data").into());
        }
        let dim: [i16; 8] = std::array::from_fn(|i| fields.short(40 + 2 * i));
        let shape = shape(dim)?;
        let scalar = scalar(&fields)?;
        let (components, content, kind) = meaning(&fields, dim[0], shape)?;
        let time_step = time_step(&fields).filter(|_| shape[3] > 1);
        let cells = shape[..3].iter().map(|&n| n as u128).product::<u128>();
        if cells > u128::from(limits.cells) {
            return Err(LimitError::Cells { byte: 40, cells, limit: limits.cells }.into());
        }
        if cells * components as u128 > u128::from(limits.values) {
            return Err(LimitError::Values { array: kind.to_owned(), byte: 40, limit: limits.values }.into());
        }
        let offset = fields.float(108);
        if !((352.0..=MAX_OFFSET).contains(&offset) && offset.fract() == 0.0) {
            return Err(fault(108, "vox_offset", offset, "a whole number from 352 to 67108864").into());
        }
        let (slope, intercept) = (fields.float(112), fields.float(116));
        let scales = slope != 0.0 && slope.is_finite();
        if scales && !intercept.is_finite() {
            return Err(fault(116, "scl_inter", intercept, "a finite number beside a slope").into());
        }
        Ok(Self {
            order: fields.order,
            scalar,
            offset: offset as u64,
            size: [shape[0], shape[1], shape[2]],
            components,
            content,
            time_step,
            unit: unit(&fields),
            kind,
            scaling: (scales && (slope, intercept) != (1.0, 0.0)).then_some((slope, intercept)),
            position: position(&fields)?,
            disagreement: disagreement(&fields, [shape[0], shape[1], shape[2]]),
        })
    }

    /// The name of the world; without sform and qform nobody says how the volume lies.
    pub(super) fn world(&self) -> &'static str {
        if self.position.1 == BY_SIZES { "not stated" } else { "right-anterior-superior" }
    }

    /// Numbers in all; within the limits.
    pub(super) fn values(&self) -> u64 {
        self.size.iter().map(|&n| n as u64).product::<u64>() * self.components as u64
    }
}

fn byte_order(head: &[u8]) -> Result<ByteOrder, NiftiError> {
    let size = [head[0], head[1], head[2], head[3]];
    let (little, big) = (i32::from_le_bytes(size), i32::from_be_bytes(size));
    match (little, big) {
        (348, _) => Ok(ByteOrder::Little),
        (_, 348) => Ok(ByteOrder::Big),
        (540, _) | (_, 540) => Err(fault(0, "sizeof_hdr", "540 (NIfTI-2)", "348 (NIfTI-1)")),
        _ => Err(fault(0, "sizeof_hdr", little, "348 in either byte order")),
    }
}

/// Lengths of seven axes; those beyond the declared number are 1.
fn shape(dim: [i16; 8]) -> Result<[usize; 7], NiftiError> {
    if !(1..=7).contains(&dim[0]) {
        return Err(fault(40, "dim[0]", dim[0], "a number of axes from 1 to 7"));
    }
    let mut shape = [1; 7];
    for axis in 0..dim[0] as usize {
        let length = dim[axis + 1];
        shape[axis] = usize::try_from(length).ok().filter(|&n| n > 0).ok_or_else(|| {
            const NAMES: [&str; 7] = ["dim[1]", "dim[2]", "dim[3]", "dim[4]", "dim[5]", "dim[6]", "dim[7]"];
            fault(42 + 2 * axis, NAMES[axis], length, "a length from 1")
        })?;
    }
    Ok(shape)
}

fn scalar(fields: &Bytes) -> Result<ScalarType, NiftiError> {
    let code = fields.short(70);
    let scalar = match code {
        2 => ScalarType::UInt8,
        4 => ScalarType::Int16,
        8 => ScalarType::Int32,
        16 => ScalarType::Float32,
        64 => ScalarType::Float64,
        256 => ScalarType::Int8,
        512 => ScalarType::UInt16,
        768 => ScalarType::UInt32,
        1024 => ScalarType::Int64,
        1280 => ScalarType::UInt64,
        _ => {
            let expected = "a real number type: 2, 4, 8, 16, 64, 256, 512, 768, 1024 or 1280";
            return Err(fault(70, "datatype", code, expected));
        }
    };
    let bits = fields.short(72);
    if bits as i64 == 8 * scalar.bytes() as i64 {
        Ok(scalar)
    } else {
        Err(fault(72, "bitpix", bits, "the bits of the datatype"))
    }
}

/// Components, what they are, and a name.
fn meaning(
    fields: &Bytes,
    axes: i16,
    shape: [usize; 7],
) -> Result<(usize, Content, &'static str), NiftiError> {
    let (intent, p1, p2) = (fields.short(68), fields.float(56), fields.float(60));
    if shape[5] != 1 || shape[6] != 1 || (shape[3] != 1 && shape[4] != 1) {
        let found = format!("{shape:?}");
        return Err(fault(
            40,
            "dim",
            found,
            "components along the fourth or the fifth axis, and nothing else",
        ));
    }
    let components = shape[3] * shape[4];
    let stated = |expected: usize, content, kind| {
        if components == expected && shape[4] == components {
            Ok((components, content, kind))
        } else {
            Err(fault(
                50,
                "dim[5]",
                shape[4],
                "as many components along the fifth axis as the intent's matrix has (along the fourth they are read where the intent is 0)",
            ))
        }
    };
    // ITK leaves the size of the matrix 0.
    let size = |p: f64, components: usize| match (p, shape[4]) {
        (0.0, n) if n == components => true,
        (p, _) => p == if matches!(components, 3 | 4) { 2.0 } else { 3.0 },
    };
    if components > 1 {
        check_intent(intent)?;
    }
    const SYMMETRIC_WORDS: &str = "symmetric matrix (intent 1005)";
    const MATRIX_WORDS: &str = "matrix (intent 1004)";
    match intent {
        SYMMETRIC if size(p1, 6) => stated(6, Content::NiftiSymmetric, SYMMETRIC_WORDS),
        SYMMETRIC if size(p1, 3) => stated(3, Content::NiftiSymmetric, SYMMETRIC_WORDS),
        SYMMETRIC => Err(fault(56, "intent_p1", p1, "2 or 3, the size of the symmetric matrix")),
        MATRIX if size(p1, 9) && size(p2, 9) => stated(9, Content::NiftiMatrix, MATRIX_WORDS),
        MATRIX if size(p1, 4) && size(p2, 4) => stated(4, Content::NiftiMatrix, MATRIX_WORDS),
        MATRIX => Err(fault(56, "intent_p1", p1, "2 x 2 or 3 x 3, the size of the matrix")),
        _ if components == 1 => Ok((1, Content::NiftiNumbers, "scalar image")),
        _ if VECTORS.contains(&intent) => {
            Ok((components, Content::NiftiVector, "vectors (intent 1006 or 1007)"))
        }
        _ if axes <= 4 && time_step(fields).is_some() => Ok((
            components,
            Content::NiftiNumbers,
            "volumes along the fourth axis, which is time by the header",
        )),
        _ if axes <= 4 => Ok((components, Content::NiftiNumbers, "components along the fourth axis")),
        _ => Ok((components, Content::NiftiNumbers, "components along the fifth axis")),
    }
}

/// The unit of time in `xyzt_units`, and the codes it may have (nifti1.h).
const TIME_BITS: u8 = 0x38;
const TIME_UNITS: [(u8, &str); 3] = [(8, "s"), (16, "ms"), (24, "us")];

/// The unit of space in `xyzt_units`, and the codes it may have (nifti1.h).
const SPACE_BITS: u8 = 0x07;
const SPACE_UNITS: [(u8, &str); 3] = [(1, "m"), (2, "mm"), (3, "µm")];

/// The unit of positions, where the header states it.
fn unit(fields: &Bytes) -> Option<&'static str> {
    let [units] = fields.get(123);
    SPACE_UNITS.into_iter().find(|(code, _)| *code == units & SPACE_BITS).map(|(_, unit)| unit)
}

/// The step of time along the fourth axis. A step of 1 s is what programs leave there that write tensors (dipy, FSL,
/// MRtrix3), and says nothing.
fn time_step(fields: &Bytes) -> Option<String> {
    let [units] = fields.get(123);
    let (code, unit) = TIME_UNITS.into_iter().find(|(code, _)| *code == units & TIME_BITS)?;
    let step = fields.float(92);
    let is_stated = step > 0.0 && step.is_finite() && (code, step) != (8, 1.0);
    is_stated.then(|| format!("{step} {unit}"))
}

/// What is left where there is neither.
const BY_SIZES: &str = "the voxel sizes alone (no sform, no qform)";

/// The sform where there is one, else the qform, else the voxel sizes.
fn position(fields: &Bytes) -> Result<(Position, &'static str), NiftiError> {
    if let Some(sform) = sform(fields)? {
        return Ok((sform, "the sform"));
    }
    if let Some(qform) = qform(fields)? {
        return Ok((qform, "the qform"));
    }
    let [x, y, z] = steps(fields);
    let axes = [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
    Ok(((axes, [0.0; 3]), BY_SIZES))
}

fn sform(fields: &Bytes) -> Result<Option<Position>, NiftiError> {
    if fields.short(254) <= 0 {
        return Ok(None);
    }
    let m: [f64; 12] = fields.floats(280);
    if !m.iter().all(|v| v.is_finite()) {
        return Err(fault(280, "srow_x", "a number that is not finite", "a finite matrix"));
    }
    let axes = [0, 1, 2].map(|a| [m[a], m[4 + a], m[8 + a]]);
    Ok(Some((axes, [m[3], m[7], m[11]])))
}

fn qform(fields: &Bytes) -> Result<Option<Position>, NiftiError> {
    if fields.short(252) <= 0 {
        return Ok(None);
    }
    let q: [f64; 6] = fields.floats(256);
    if !q.iter().all(|v| v.is_finite()) {
        return Err(fault(256, "quatern_b", "a number that is not finite", "finite numbers"));
    }
    let flip = if fields.float(76) < 0.0 { -1.0 } else { 1.0 };
    Ok(Some((rotated([q[0], q[1], q[2]], steps(fields), flip), [q[3], q[4], q[5]])))
}

/// Voxel sizes, whose signs mean nothing; 1 where the header has none.
fn steps(fields: &Bytes) -> [f64; 3] {
    let pixdim: [f64; 8] = fields.floats(76);
    [1, 2, 3].map(|i| if pixdim[i] != 0.0 && pixdim[i].is_finite() { pixdim[i].abs() } else { 1.0 })
}

/// Distance of the two positions of a corner voxel, of a voxel's size, that is a disagreement: quaternions in single
/// precision are off by less.
const APART: f64 = 0.05;

/// How far the qform puts a corner of the volume from where the sform has it, where both are there and that is more
/// than rounding.
fn disagreement(fields: &Bytes, size: [usize; 3]) -> Option<f64> {
    let (Ok(Some(a)), Ok(Some(b))) = (sform(fields), qform(fields)) else { return None };
    let corner = |(axes, origin): &Position, which: usize| {
        let steps = [0, 1, 2].map(|axis| if which >> axis & 1 == 1 { (size[axis] - 1) as f64 } else { 0.0 });
        [0, 1, 2].map(|i| origin[i] + (0..3).map(|axis| axes[axis][i] * steps[axis]).sum::<f64>())
    };
    let length = |v: [f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let apart = |which: usize| {
        let (p, q) = (corner(&a, which), corner(&b, which));
        length([p[0] - q[0], p[1] - q[1], p[2] - q[2]])
    };
    let largest = (0..8).map(apart).fold(0.0, f64::max);
    let voxel = steps(fields).into_iter().fold(f64::INFINITY, f64::min);
    (largest > APART * voxel).then_some(largest)
}

/// What three numbers of single precision may be off from a length of 1, squared.
const HALF_TURN: f64 = 3.0 * f32::EPSILON as f64;

/// Axes from the three imaginary parts of a unit quaternion; the third axis may be reversed. Parts of length 1, up to
/// single precision, are a half turn: the root of what is left would be a rotation by the root of the rounding, 3e-4.
fn rotated([b, c, d]: [f64; 3], steps: [f64; 3], flip: f64) -> [[f64; 3]; 3] {
    let square = b * b + c * c + d * d;
    let is_half_turn = square > 1.0 - HALF_TURN;
    let shrink = if is_half_turn { 1.0 / square.sqrt() } else { 1.0 };
    let [b, c, d] = [b, c, d].map(|v| v * shrink);
    let a = if is_half_turn { 0.0 } else { (1.0 - square).sqrt() };
    let first = [a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)];
    let second = [2.0 * (b * c - a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d + a * b)];
    let third = [2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a + d * d - c * c - b * b];
    [first.map(|v| v * steps[0]), second.map(|v| v * steps[1]), third.map(|v| v * steps[2] * flip)]
}
