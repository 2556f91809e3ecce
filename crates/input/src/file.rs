//! From the bytes of a file to tensors, or numbers, on a lattice.

use crate::error::InputError;
use crate::foreign::unreadable;
use crate::formats::{Format, NUMPY, ROWS_OF_NUMBERS, Request, TABLE, format_of, is_readable};
use crate::provenance::hash_of_bytes;
use crate::reading::{Derivation, Reading};
use tigereye_core::math;
use tigereye_io::volume::{Frame, Known, Lattice, Overlay, PlaneChoice, TensorVolume, World};
use tigereye_io::{ArrayChoice, Limits, ScalarType, Wanted};

/// What a data file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorFile {
    /// Name, as given.
    pub name: String,
    /// The format in words.
    pub kind: &'static str,
    /// BLAKE3 of the file, in hex; of header, data and mask where these are several.
    pub blake3: String,
    /// What it holds.
    pub content: Content,
    /// The axes that vectors are along, where the user says so.
    frame: Option<Frame>,
    /// How the mask lies over the input, where that is not plain, and what was read of it, a sentence each.
    of_mask: Vec<String>,
    /// Names of all files that were read.
    pub files: Vec<String>,
}

/// Tensors, or what they may be derived from.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Tensors on a lattice, possibly flat.
    Tensors(TensorVolume),
    /// Single numbers or vectors.
    Numbers(Lattice),
}

/// Reads a file of any format by its extension. `bytes_of` gives the bytes of a file by its name: this one, the data
/// file of an NRRD header (in the same folder) and the mask.
///
/// # Errors
/// See [`InputError`].
pub fn open(
    name: &str,
    reading: &Reading,
    bytes_of: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<TensorFile, InputError> {
    if !is_readable(name) {
        return Err(unreadable(name));
    }
    reading.check()?;
    if format_of(name) == "png" && reading.derive.is_none() {
        return Err(InputError::Picture);
    }
    let mut files = Vec::new();
    let mut read = |name: &str| {
        files.push(name.to_owned());
        bytes_of(name).map_err(|words| InputError::Unread { words })
    };
    let (kind, mut lattice, mut hashed) =
        lattice_of(name, reading.array_choice(), reading.wanted(), reading.limits(), &mut read)?;
    if reading.wanted() == Wanted::Tensors {
        lattice = lattice.with_mask_apart();
    }
    let mut of_mask = Vec::new();
    if let Some(mask) = &reading.mask {
        let (found, bytes) = mask_lattice(mask, reading.mask_array.as_deref(), reading.limits(), &mut read)?;
        let overlay = lattice.mask_by(&found).ok_or_else(|| InputError::MaskSize {
            mask: mask.clone(),
            found: found.size,
            expected: lattice.size,
        })?;
        of_mask.extend(overlay_words(overlay, mask, found.world == World::Absent));
        of_mask.extend(found.remarks.iter().map(|words| format!("mask {mask}: {words}")));
        of_mask.extend(found.warnings.iter().map(|words| format!("WARNING: mask {mask}: {words}")));
        hashed.extend(bytes);
    }
    match &mut lattice.mask {
        Some(mask) if !mask.iter().any(|m| *m > reading.mask_above) && reading.mask.is_some() => {
            let (mask, above) = (reading.mask.clone().unwrap_or_default(), reading.mask_above);
            return Err(InputError::NothingLeft { mask, above });
        }
        Some(mask) => mask.iter_mut().for_each(|m| *m = if *m > reading.mask_above { *m } else { 0.0 }),
        None if reading.mask_above != 0.0 => {
            return Err(InputError::Needless {
                option: "--mask-above",
                why: "the file has no confidence of its own, and no --mask is given",
            });
        }
        None => {}
    }
    if let Some(Derivation { kind, .. }) = reading.derive {
        let (fits, expected) = match reading.wanted() {
            Wanted::Vectors => (matches!(lattice.components, 2 | 3), "two or three"),
            _ => (lattice.components == 1, "one"),
        };
        if !fits {
            let (components, name) = (lattice.components, kind.name());
            return Err(InputError::Tuples { components, expected, name });
        }
    }
    let blake3 = hash_of_bytes(&hashed);
    let content = if reading.derive.is_some() || (lattice.components == 1 && reading.order.is_none()) {
        Content::Numbers(lattice)
    } else {
        let words = tigereye_io::volume::Reading {
            order: reading.order.as_deref(),
            frame: reading.frame,
            shear: reading.shear,
        };
        Content::Tensors(lattice.tensors(words)?)
    };
    let (name, frame) = (name.to_owned(), reading.frame);
    Ok(TensorFile { name, kind, blake3, content, frame, of_mask, files })
}

/// A volume with its tensors that are not finite as the reading wants them: refused, or zero.
///
/// # Errors
/// [`InputError::NotFiniteVoxel`].
pub fn finite_volume(volume: TensorVolume, reading: &Reading) -> Result<TensorVolume, InputError> {
    match volume.not_finite() {
        None => Ok(volume),
        Some(_) if reading.zero_not_finite => Ok(volume.with_zeros_for_not_finite()),
        Some((voxel, count)) => Err(InputError::NotFiniteVoxel { voxel, count }),
    }
}

type Read<'a> = dyn FnMut(&str) -> Result<Vec<u8>, InputError> + 'a;

/// The format, the numbers, and the bytes they come from.
fn lattice_of(
    name: &str,
    array: ArrayChoice,
    wanted: Wanted,
    limits: Limits,
    read: &mut Read,
) -> Result<(&'static str, Lattice, Vec<u8>), InputError> {
    let Some(format) = Format::of(name) else { return Err(unreadable(name)) };
    let option = match array {
        ArrayChoice::Usual => None,
        ArrayChoice::Named(_) => Some("--array"),
        ArrayChoice::Components(_) => Some("--components"),
    };
    if let Some(option) = option.filter(|_| !format.has_names) {
        return Err(InputError::nameless(option));
    }
    let mut bytes = read(name)?;
    let detached = format.detached(&bytes, limits)?;
    let data = detached.as_ref().map(|data| read(&beside(name, data))).transpose()?;
    let request = Request { bytes: &bytes, detached: data.as_deref(), array, wanted, limits };
    let (kind, lattice) = format.read(&request).map_err(|error| match error {
        InputError::File { source, .. } => {
            InputError::File { source, detached: detached.map(String::into_boxed_str) }
        }
        other => other,
    })?;
    bytes.extend(data.unwrap_or_default());
    Ok((kind, lattice, bytes))
}

/// A file in the folder of another one.
fn beside(name: &str, file: &str) -> String {
    name.rfind(['/', '\\']).map_or_else(|| file.to_owned(), |at| format!("{}{file}", &name[..=at]))
}

/// How a mask lies over the input, in words, where one of them has no place or they lie apart.
fn overlay_words(overlay: Overlay, mask: &str, mask_is_without: bool) -> Option<String> {
    let without = if mask_is_without { "the mask" } else { "the input" };
    match overlay {
        Overlay::Coincident => None,
        Overlay::Pictures => Some(format!(
            "mask {mask} laid over the picture, its top row over the top row and its left column over the left column: {without} does \
             not say where it lies"
        )),
        Overlay::Voxels => {
            Some(format!("mask {mask} applied voxel by voxel: {without} does not say where it lies"))
        }
        Overlay::Elsewhere => Some(format!(
            "WARNING: the cells of the mask {mask} do not coincide with those of the input; applied voxel by voxel"
        )),
        Overlay::Incomparable => Some(format!(
            "WARNING: the axes of the mask {mask} and of the input are of different worlds, so that their cells cannot be compared; \
             applied voxel by voxel"
        )),
    }
}

/// One number a voxel, and the bytes they come from.
fn mask_lattice(
    mask: &str,
    array: Option<&str>,
    limits: Limits,
    read: &mut Read,
) -> Result<(Lattice, Vec<u8>), InputError> {
    let fault = |words: String| InputError::Mask { mask: mask.to_owned(), words };
    let Some(format) = Format::of(mask) else { return Err(fault(unreadable(mask).to_string())) };
    if array.is_some() && !format.has_names {
        return Err(InputError::nameless("--mask-array"));
    }
    let (_, lattice, bytes) = match lattice_of(mask, array.into(), Wanted::Mask, limits, read) {
        Err(e @ InputError::Unread { .. }) => return Err(e),
        other => other.map_err(|e| fault(e.words_of_mask()))?,
    };
    if lattice.components != 1 {
        return Err(fault(format!("{} numbers per voxel: expected one", lattice.components)));
    }
    Ok((lattice, bytes))
}

impl TensorFile {
    /// Voxels along the axes.
    #[must_use]
    pub const fn size(&self) -> [usize; 3] {
        match &self.content {
            Content::Tensors(volume) => volume.lattice().size,
            Content::Numbers(lattice) => lattice.size,
        }
    }

    /// The numbers with what is known about them.
    #[must_use]
    pub const fn lattice(&self) -> &Lattice {
        match &self.content {
            Content::Tensors(volume) => volume.lattice(),
            Content::Numbers(lattice) => lattice,
        }
    }

    /// Type of the numbers in the file.
    #[must_use]
    pub const fn scalar(&self) -> ScalarType {
        self.lattice().scalar
    }

    /// The axes that vectors are along and how they are known, in words; `None` for tensors and single numbers.
    #[must_use]
    pub fn words_of_vectors(&self) -> Option<String> {
        match &self.content {
            Content::Tensors(_) => None,
            Content::Numbers(lattice) => lattice.words_of_vectors(self.frame),
        }
    }

    /// Whether a plane is chosen, or there is only one.
    #[must_use]
    pub fn has_plane(&self, reading: &Reading) -> bool {
        reading.choice != PlaneChoice::default() || reading.choice.resolve(self.size()).is_ok()
    }

    /// Why the component order looks wrong, and what would look right. A file that states its order is believed.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        let Content::Tensors(volume) = &self.content else { return None };
        if volume.order().1 == Known::Stated {
            return None;
        }
        let s = volume.suspicion()?;
        Some(format!(
            "{:.1} % of the tensors have a negative eigenvalue in this component order and {:.1} % in the order of \
             {} ({}): see --order",
            100.0 * s.share,
            100.0 * s.better,
            s.tools,
            s.orders.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ")
        ))
    }

    /// What had to be assumed about the components, a sentence each.
    #[must_use]
    pub fn assumptions(&self) -> Vec<String> {
        let mut all = self.assumptions_of_content();
        all.extend(self.runs_of_rows());
        all.extend(self.y_of_numbers());
        all
    }

    /// What is assumed of planes of NumPy's arrays: their rows run downwards, while components are along the axes of a
    /// picture.
    fn runs_of_rows(&self) -> Option<String> {
        let lattice = self.lattice();
        let is_open = match &self.content {
            Content::Tensors(volume) => volume.frame().1 == Known::Convention,
            Content::Numbers(_) => lattice.components > 1 && self.frame.is_none(),
        };
        let is_plane = lattice.world == World::Absent && lattice.frame.1 == Known::Convention;
        (NUMPY.contains(&self.kind) && is_open && is_plane).then(|| {
            "took row 0 on top and components along x (right) and y (up); --frame voxel for components along columns and rows, y \
             down"
                .to_owned()
        })
    }

    /// What is assumed of images of numbers without positions. Their derivatives fit the picture in any case; which way
    /// it is up only their author knows. Pictures in files of pictures have row 0 on top.
    fn y_of_numbers(&self) -> Option<String> {
        let Content::Numbers(lattice) = &self.content else { return None };
        let is_array = NUMPY.contains(&self.kind) || [TABLE, ROWS_OF_NUMBERS].contains(&self.kind);
        let has_rows = lattice.world == World::Absent && lattice.axes[1][1] < 0.0;
        (is_array && has_rows && lattice.components == 1).then(|| {
            "took row 0 on top and y upwards, from the last row to the first; where y grows with the row, the picture is upside down \
             and xy has the other sign: reverse the rows of the array"
                .to_owned()
        })
    }

    fn assumptions_of_content(&self) -> Vec<String> {
        match &self.content {
            Content::Tensors(volume) => assumptions_of_tensors(volume),
            Content::Numbers(lattice) if lattice.components > 1 && self.frame.is_none() => {
                let (frame, known) = lattice.frame;
                let words = match known {
                    Known::Assumed => format!("assumed vectors along {} (--frame)", frame.words()),
                    Known::Convention if lattice.is_of_scanner() => {
                        format!(
                            "took vectors along {}, right, anterior and superior, as the format has them (--frame lps for images of \
                             vectors that ITK and ANTs write)",
                            frame.words()
                        )
                    }
                    _ => return Vec::new(),
                };
                vec![words]
            }
            Content::Numbers(_) => Vec::new(),
        }
    }

    /// What everybody must hear: assumptions that options could replace, and warnings.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let warnings = self.lattice().warnings.iter().cloned().chain(self.warning());
        let warnings = warnings.map(|w| format!("WARNING: {w}"));
        // Those about the order of tensors are among the remarks already; vectors have no option for it.
        let said = self.lattice().remarks.iter().cloned();
        let of_vectors = match &self.content {
            Content::Numbers(lattice) if lattice.components > 1 => lattice.order_remarks.clone(),
            _ => Vec::new(),
        };
        self.assumptions()
            .into_iter()
            .chain(said)
            .chain(of_vectors)
            .chain(warnings)
            .chain(self.of_mask.iter().cloned())
            .collect()
    }
}

/// Share of the tensors from which four numbers look like plane strain in the order of a matrix.
const MOSTLY: f64 = 0.9;
/// Difference of xy and yx, relative to the largest component of the tensor, that is no rounding.
const ASYMMETRIC: f64 = 1e-3;

/// Share of the tensors whose xy and yx differ.
fn asymmetric_share(volume: &TensorVolume) -> f64 {
    let differs = |t: &[f64; 9]| {
        let largest = t.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        (t[1] - t[3]).abs() > ASYMMETRIC * largest
    };
    volume.tensors().filter(differs).count() as f64 / volume.lattice().voxels().max(1) as f64
}

/// Numbers that stand for missing data, as geodata, NetCDF's defaults and finite-element exports have them.
const FILLS: [f64; 7] = [-9999.0, -999.0, -99999.0, 9999.0, 1e20, -32768.0, 9.969_209_968_386_869e36];
/// Relative difference of a number from a fill that counts as rounding to single precision.
const FILL_ROUNDING: f64 = 1e-6;

/// The fill that tensors have for every component, and how many have it.
fn filled(volume: &TensorVolume) -> Option<(f64, usize)> {
    let lattice = volume.lattice();
    let tuples = lattice.values.chunks_exact(lattice.components.max(1)).enumerate();
    let is = |fill: f64, v: f64| (v - fill).abs() <= FILL_ROUNDING * fill.abs();
    let count = |fill: f64| {
        tuples
            .clone()
            .filter(|(voxel, t)| !volume.is_masked(*voxel) && t.iter().all(|&v| is(fill, v)))
            .count()
    };
    FILLS.into_iter().map(|fill| (fill, count(fill))).find(|(_, n)| *n > 0)
}

/// What was assumed about tensors, with the option that says it.
fn assumptions_of_tensors(volume: &TensorVolume) -> Vec<String> {
    let ((order, order_known), (frame, frame_known)) = (volume.order(), volume.frame());
    let mut all = Vec::new();
    if order_known == Known::Assumed {
        let other = match order.components() {
            3 => "; finite-element programs also write xx,yy,xy, and a vector field needs --derive gradient",
            4 => "; plane strain is xx,yy,zz,xy",
            _ => "",
        };
        all.push(format!("assumed component order {order} (--order{other})"));
        let asymmetric = asymmetric_share(volume);
        if order.components() == 4 && asymmetric > MOSTLY {
            let percent = 100.0 * asymmetric;
            all.push(format!(
                "WARNING: {percent:.0} % of the tensors are asymmetric in this order, as happens when plane-strain components (xx,yy,zz,xy) are read in it"
            ));
        }
    }
    if order_known != Known::Given && volume.lattice().has_unknown_names() {
        let names = volume.lattice().component_names.join(", ");
        all.push(format!(
            "WARNING: the component names {names} were not understood: components taken by their places"
        ));
    }
    if let Some(stated) = volume.contradicted_order() {
        all.push(format!("WARNING: the file states the component order {stated}, taken as given: {order}"));
    }
    if frame_known == Known::Assumed {
        all.push(format!("assumed components along {} (--frame)", frame.words()));
    }
    let by_voxels = frame == Frame::Voxel && frame_known == Known::Assumed;
    if by_voxels && volume.lattice().is_of_scanner() && volume.lattice().reverses_x_for_fsl() {
        all.push(
            "WARNING: the determinant of the affine is positive: tensors fitted with FSL's gradient tables (bvecs) have x \
             reversed here, as --frame fsl says; those along the voxel axes do not, as --frame voxel says"
                .to_owned(),
        );
    }
    if let Some(cosine) = volume.lattice().skew().filter(|_| matches!(frame, Frame::Voxel | Frame::Fsl)) {
        let degrees = 90.0 - math::acos(cosine.abs().min(1.0)).to_degrees();
        all.push(format!(
            "WARNING: the voxel axes are {degrees:.1} degrees off right angles: tensors along them are drawn as if they were square"
        ));
    }
    if let Some((value, count)) = filled(volume) {
        all.push(format!(
            "WARNING: {count} tensors have {value} for every component, a common marker of missing data: use --mask to exclude them"
        ));
    }
    if volume.suggests_engineering_shears() {
        all.push(
            "the names suggest strains: shears taken as components of the tensor (--shear engineering for gamma = 2 epsilon)"
                .to_owned(),
        );
    }
    all
}
