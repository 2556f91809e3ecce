//! Tensors on a 3D lattice as files have them, and what was read or assumed to know what they mean.
//!
//! A reader gives a [`Lattice`]: tuples of numbers with what the file states about them. [`Lattice::tensors`] adds what the
//! user says ([`Reading`]) and assumes the rest, visibly; the [`TensorVolume`] it gives is cut to a plane by
//! [`TensorVolume::slice`].
//!
//! Frames. Every voxel axis has a direction in the world of the file (`axes`). Components are along the voxel axes, along
//! the world's axes, or along those of NRRD's measurement frame.

mod components;
mod convention;
mod geometry;
mod image;
mod names;
mod order;
mod output;
mod plane;
mod suspicion;

pub use components::ComponentArrays;
pub(crate) use components::{joined, joined_rows};
pub use convention::{ALIASES, Alias, CONVENTIONS, Content, Convention, documentation};
pub use geometry::PlaneGeometry;
pub(crate) use image::points_of_image;
pub use image::{image_from_volume, lattice_from_image, lattice_from_points, points_from_image};
pub(crate) use names::{
    Group, Naming, groups, names_eigenvectors, names_principal_values, naming, order_of, row_groups,
};
pub use order::TensorOrder;
pub(crate) use output::{symmetric, written_scalar};
pub use plane::{Axis, Crop, Cut, Plane, PlaneChoice, Slice, parse_slice};
pub use suspicion::{Suspicion, negative_share};

use crate::{IoError, ScalarType};

/// Largest cosine between two axes that are still taken as orthogonal: files hold them in single precision.
const ORTHOGONAL: f64 = 1e-3;

/// The axes that the components of a tensor are along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The voxel axes.
    Voxel,
    /// The axes of the file's world: VTK's x, y, z; the patient's or scanner's axes.
    World,
    /// NRRD's measurement frame.
    Measurement,
    /// The axes of FSL's gradient tables, and of tensors fitted with them: the voxel axes, the first reversed where the
    /// determinant of the affine is positive (FSL, "What conventions do the bvecs use?", FDT user guide).
    Fsl,
    /// Left, posterior and superior, whatever the file's own world: ITK's axes, in which it writes images of vectors as they are.
    Lps,
}

impl Frame {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Voxel, Self::World, Self::Measurement, Self::Fsl, Self::Lps];

    /// The frame of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }

    /// The name the command line uses.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Voxel => "voxel",
            Self::World => "world",
            Self::Measurement => "measurement",
            Self::Fsl => "fsl",
            Self::Lps => "lps",
        }
    }

    /// The axes in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Voxel => "the voxel axes",
            Self::World => "the world axes",
            Self::Measurement => "the measurement axes",
            Self::Fsl => "the axes of FSL's gradient tables",
            Self::Lps => "the axes left, posterior, superior",
        }
    }
}

/// What the numbers of shear components are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shear {
    /// Components of the tensor.
    #[default]
    Tensor,
    /// Engineering shears, twice the components: gamma_xy = 2 epsilon_xy.
    Engineering,
}

/// How something about a file is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// The file says so.
    Stated,
    /// The user says so.
    Given,
    /// The format leaves it open and this program has a convention for it.
    Convention,
    /// Nobody says so; it is usual.
    Assumed,
}

impl Known {
    /// `stated by the file`, `as given`, `by convention` or `assumed`.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Stated => "stated by the file",
            Self::Given => "as given",
            Self::Convention => "this program's convention for the format",
            Self::Assumed => "ASSUMED: the file does not say",
        }
    }

    /// The same in a word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Stated => "stated",
            Self::Given => "given",
            Self::Convention => "by convention",
            Self::Assumed => "assumed",
        }
    }
}

/// What the axes of the world are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum World {
    /// A viewer's own: x right, y up.
    Viewer,
    /// The patient's or scanner's, by its name in the file.
    Scanner(String),
    /// None: rows and columns of an array or a picture, which lie nowhere.
    Absent,
}

/// Worlds of scanners with the signs that turn their axes to the right, anterior and superior, by NRRD's names.
const SCANNERS: [(&str, &str, [f64; 3]); 3] = [
    ("right-anterior-superior", "RAS", [1.0, 1.0, 1.0]),
    ("left-anterior-superior", "LAS", [-1.0, 1.0, 1.0]),
    ("left-posterior-superior", "LPS", [-1.0, -1.0, 1.0]),
];

impl World {
    const fn is_scanner(&self) -> bool {
        matches!(self, Self::Scanner(_))
    }

    /// Signs that turn the axes to the right, anterior and superior; `None` for worlds that are not the patient's.
    pub(crate) fn signs(&self) -> Option<[f64; 3]> {
        let Self::Scanner(name) = self else { return None };
        let is_named = |(long, short, _): &&(&str, &str, _)| {
            name.eq_ignore_ascii_case(long) || name.eq_ignore_ascii_case(short)
        };
        SCANNERS.iter().find(is_named).map(|(_, _, signs)| *signs)
    }
}

/// Tuples of numbers on a lattice, as a file has them.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// Voxels along the three axes, each at least 1. The first runs fastest.
    pub size: [usize; 3],
    /// Numbers per tuple, a mask left out.
    pub components: usize,
    /// All numbers, tuple by tuple.
    pub values: Vec<f64>,
    /// Type in the file.
    pub scalar: ScalarType,
    /// Step along each voxel axis, in the world's axes and unit.
    pub axes: [[f64; 3]; 3],
    /// Position of the first voxel in the world.
    pub origin: [f64; 3],
    /// What the world is.
    pub world: World,
    /// Columns: axes of the measurement frame in the world, row by row.
    pub measurement: Option<[f64; 9]>,
    /// Confidence of each voxel; 0 where nothing was measured.
    pub mask: Option<Vec<f64>>,
    /// Order of the components and how it is known, where there is a reason for one.
    pub order: Option<(TensorOrder, Known)>,
    /// The frame of the components, stated or usual for the format.
    pub frame: (Frame, Known),
    /// Name of the array, or the words by which the format calls it.
    pub array: String,
    /// Names of the components as the file has them; empty where it has none.
    pub component_names: Vec<String>,
    /// What else was read or assumed, a sentence each.
    pub notes: Vec<String>,
    /// What was assumed or left out that changes the result and that no option says, a sentence each.
    pub remarks: Vec<String>,
    /// What looks wrong in the file, a sentence each.
    pub warnings: Vec<String>,
}

/// What the user says about components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading<'a> {
    /// An alias or component names, see [`TensorOrder::parse`].
    pub order: Option<&'a str>,
    /// The frame of the components.
    pub frame: Option<Frame>,
    /// What shear components are; those of the tensor where nobody says so.
    pub shear: Option<Shear>,
}

/// Tensors on a lattice, with what was read and what was assumed.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorVolume {
    lattice: Lattice,
    order: (TensorOrder, Known),
    frame: (Frame, Known),
    shear: (Shear, Known),
}

impl Lattice {
    /// The tensors, with the user's words before the file's, and the file's before what is usual for the format
    /// ([`CONVENTIONS`]). An alias of the order may bring the frame of its program, where the file does not state one.
    ///
    /// # Errors
    /// [`IoError::NoTensor`], [`IoError::Principal`], [`IoError::Order`], [`IoError::NoMeasurementFrame`], and
    /// [`IoError::NoSharedShear`] for engineering shears where xy and yx are two numbers.
    pub fn tensors(self, reading: Reading) -> Result<TensorVolume, IoError> {
        let this = self.with_mask_apart();
        this.tensors_of_tuples(reading)
    }

    /// Seven numbers a voxel are a mask before six others, as NRRD has them: the mask apart.
    #[must_use]
    pub fn with_mask_apart(mut self) -> Self {
        if self.components == 7 {
            let tuples = self.values.as_chunks::<7>().0;
            self.mask = Some(tuples.iter().map(|t| t[0]).collect());
            self.values = tuples.iter().flat_map(|t| t[1..].iter().copied()).collect();
            self.components = 6;
            self.order = Some((TensorOrder::UPPER, Known::Assumed));
            self.warnings.push("seven numbers taken as a mask and xx,xy,xz,yy,yz,zz".to_owned());
        }
        self
    }

    fn tensors_of_tuples(mut self, reading: Reading) -> Result<TensorVolume, IoError> {
        let order = match (reading.order, self.order) {
            (Some(text), _) => (TensorOrder::parse(text, self.components)?, Known::Given),
            (None, _) if self.holds_principal_values() => {
                return Err(IoError::Principal { array: self.array, names: self.component_names.join(", ") });
            }
            (None, Some(order)) => order,
            (None, None) => {
                return Err(IoError::NoTensor { array: self.array, components: self.components });
            }
        };
        let of_program = reading.order.and_then(Alias::named).and_then(|alias| alias.frame);
        let frame = match (reading.frame, of_program) {
            (Some(frame), _) => (frame, Known::Given),
            (None, Some(frame)) if self.frame.1 == Known::Assumed => (frame, Known::Convention),
            _ => self.frame,
        };
        if frame.0 == Frame::Measurement && self.measurement.is_none() {
            return Err(IoError::NoMeasurementFrame);
        }
        if reading.shear == Some(Shear::Engineering) {
            self.halve_shears(order.0)?;
        }
        let shear = reading.shear.map_or((Shear::Tensor, Known::Assumed), |shear| (shear, Known::Given));
        Ok(TensorVolume { lattice: self, order, frame, shear })
    }

    /// The same lattice with the numbers of an array that names its components.
    #[must_use]
    pub(crate) fn with_array(self, array: crate::DataArray) -> Self {
        let order = match naming(&array.component_names, array.components) {
            Naming::Tensor(order) => Some((order, Known::Stated)),
            _ => None,
        };
        Self {
            components: array.components,
            values: array.values,
            scalar: array.scalar,
            order,
            array: array.name,
            component_names: array.component_names,
            ..self
        }
    }

    /// Whether the names say that the numbers have no directions.
    fn holds_principal_values(&self) -> bool {
        match naming(&self.component_names, self.components) {
            Naming::Principal => true,
            Naming::Unnamed => self.components == 3 && names_principal_values(&self.array),
            Naming::Tensor(_) | Naming::Other => false,
        }
    }

    /// Engineering shears to components of the tensor.
    fn halve_shears(&mut self, order: TensorOrder) -> Result<(), IoError> {
        if !order.has_shared_shears() {
            return Err(IoError::NoSharedShear { order: order.to_string() });
        }
        for tuple in self.values.chunks_exact_mut(self.components) {
            order.shears().for_each(|at| tuple[at] *= 0.5);
        }
        self.notes.push("engineering shears halved".to_owned());
        Ok(())
    }

    /// Whether FSL's axes have the first voxel axis reversed: the determinant of the affine, in a world that runs to the right,
    /// anterior and superior, is positive.
    #[must_use]
    pub fn reverses_x_for_fsl(&self) -> bool {
        // FSL takes a volume of which nobody says how it lies as one that needs no reversal.
        if self.is_of_scanner() && self.world.signs().is_none() {
            return false;
        }
        let [a, b, c] = self.directions_by_axis();
        let signs = self.world.signs().unwrap_or([1.0; 3]);
        let determinant = a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        determinant * signs.iter().product::<f64>() > 0.0
    }

    /// Whether the world is a patient's or scanner's.
    #[must_use]
    pub const fn is_of_scanner(&self) -> bool {
        matches!(self.world, World::Scanner(_))
    }

    /// Whether a voxel axis does not run along the world's axis of its own number.
    #[must_use]
    pub fn has_turned_axes(&self) -> bool {
        self.directions() != IDENTITY
    }

    /// Unit vectors along the voxel axes, one after the other.
    fn directions_by_axis(&self) -> [[f64; 3]; 3] {
        let d = self.directions();
        [0, 1, 2].map(|a| [d[a], d[a + 3], d[a + 6]])
    }

    /// The axes left, posterior and superior in the world, one a column.
    fn lps(&self) -> [f64; 9] {
        let [x, y, z] = self.world.signs().unwrap_or([1.0; 3]);
        [-x, 0.0, 0.0, 0.0, -y, 0.0, 0.0, 0.0, z]
    }

    /// Whether components have names that say nothing of a tensor.
    #[must_use]
    pub fn has_unknown_names(&self) -> bool {
        naming(&self.component_names, self.components) == Naming::Other
    }

    /// The signs that turn the voxel axes into FSL's.
    fn fsl_signs(&self) -> [f64; 9] {
        let x = if self.reverses_x_for_fsl() { -1.0 } else { 1.0 };
        [x, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    }

    /// Takes a mask of another file: a voxel keeps the smaller of both confidences. Where an axis of one lattice runs
    /// against that of the other, as far as both say where they lie, the mask is turned round along it. Returns whether the
    /// mask lies elsewhere all the same, or in a world that cannot be compared.
    ///
    /// # Panics
    /// Where the mask has another size or holds tuples.
    pub fn mask_by(&mut self, mask: &Self) -> bool {
        assert!(mask.size == self.size && mask.components == 1, "a mask of the lattice's size");
        let [nx, ny, _] = self.size;
        let signs = match (self.world.signs(), mask.world.signs()) {
            (Some(a), Some(b)) => Some((a, b)),
            // Viewers, what has rows on top or below, and worlds of one name.
            _ if self.world == mask.world || !(self.world.is_scanner() || mask.world.is_scanner()) => {
                Some(([1.0; 3], [1.0; 3]))
            }
            _ => None,
        };
        let place = |v: [f64; 3], signs: [f64; 3]| [0, 1, 2].map(|i| signs[i] * v[i]);
        let mut reversed = [false; 3];
        if let Some((a, b)) = signs {
            for axis in 0..3 {
                let (own, other) = (place(self.axes[axis], a), place(mask.axes[axis], b));
                reversed[axis] = (0..3).map(|i| own[i] * other[i]).sum::<f64>() < 0.0;
            }
        }
        let mut confidence = Vec::with_capacity(self.voxels());
        for voxel in 0..self.voxels() {
            let at = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
            let [x, y, z] = [0, 1, 2].map(|a| if reversed[a] { self.size[a] - 1 - at[a] } else { at[a] });
            let of_mask = mask.values[(z * ny + y) * nx + x];
            let own = self.mask.as_ref().and_then(|m| m.get(voxel).copied());
            // What is not a number is no confidence.
            let both = own.map_or(of_mask, |own| if own < of_mask { own } else { of_mask });
            confidence.push(if both.is_nan() { 0.0 } else { both });
        }
        self.mask = Some(confidence);
        let names = ["x", "y", "z"];
        let turned: Vec<&str> =
            (0..3).filter(|&a| reversed[a] && self.size[a] > 1).map(|a| names[a]).collect();
        if !turned.is_empty() {
            self.notes.push(format!(
                "the mask turned round along {}, where its axes run the other way",
                turned.join(" and ")
            ));
        }
        if self.world == World::Absent || mask.world == World::Absent {
            return false;
        }
        // Worlds of different kinds cannot be compared.
        let Some((a, b)) = signs else { return true };
        let step = self.spacing().into_iter().fold(f64::INFINITY, f64::min);
        let far = |v: [f64; 3], w: [f64; 3]| (0..3).any(|i| (v[i] - w[i]).abs() > 1e-2 * step);
        let mut first = mask.origin;
        for axis in (0..3).filter(|&axis| reversed[axis]) {
            let last = (self.size[axis] - 1) as f64;
            (0..3).for_each(|i| first[i] += last * mask.axes[axis][i]);
        }
        let turned = |axis: usize| mask.axes[axis].map(|v| if reversed[axis] { -v } else { v });
        far(place(self.origin, a), place(first, b))
            || (0..3).any(|axis| far(place(self.axes[axis], a), place(turned(axis), b)))
    }

    /// What was read, a sentence each.
    #[must_use]
    pub fn story(&self) -> Vec<String> {
        let mut story =
            vec![format!("`{}`: {} components, {}", self.array, self.components, self.scalar.name())];
        if let World::Scanner(name) = &self.world {
            story.push(format!("world: {name}"));
        }
        if let Some(mask) = &self.mask {
            let masked = mask.iter().filter(|&&m| m == 0.0).count();
            story.push(format!("{masked} voxels masked out, taken as zero tensors"));
        }
        story.extend(self.notes.iter().chain(&self.remarks).cloned());
        story
    }

    /// Voxels in all.
    #[must_use]
    pub fn voxels(&self) -> usize {
        self.size.iter().product()
    }

    /// Distance of the voxels along each axis, in the world's unit; 1 for an axis without length.
    #[must_use]
    pub fn spacing(&self) -> [f64; 3] {
        self.axes.map(|a| {
            let length = tigereye_core::math::hypot(tigereye_core::math::hypot(a[0], a[1]), a[2]);
            if length > 0.0 && length.is_finite() { length } else { 1.0 }
        })
    }

    /// Directions of the voxel axes in the world, one a column, row by row.
    #[must_use]
    pub fn directions(&self) -> [f64; 9] {
        let spacing = self.spacing();
        let mut columns = [0, 1, 2].map(|a| self.axes[a].map(|v| v / spacing[a]));
        for (a, column) in columns.iter_mut().enumerate() {
            if *column == [0.0; 3] {
                column[a] = 1.0;
            }
        }
        let at = |i: usize| columns[i % 3][i / 3];
        [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)]
    }

    /// What turns components in `frame` into components along the voxel axes, `K v` or `K D K^T`; `None` where nothing does.
    pub(crate) fn to_voxel(&self, frame: Frame) -> Result<Option<[f64; 9]>, IoError> {
        let measured = match (frame, self.measurement) {
            (Frame::Voxel, _) => return Ok(None),
            (Frame::Fsl, _) => return Ok(self.reverses_x_for_fsl().then(|| self.fsl_signs())),
            (Frame::Measurement, Some(m)) => m,
            (Frame::Lps, _) => self.lps(),
            _ => IDENTITY,
        };
        let directions = self.orthogonal_directions()?;
        if directions == measured {
            return Ok(None);
        }
        inverse(&directions).map(|r| Some(product(&r, &measured))).ok_or(IoError::SkewedAxes { off: 1.0 })
    }

    fn orthogonal_directions(&self) -> Result<[f64; 9], IoError> {
        self.skew().map_or_else(|| Ok(self.directions()), |off| Err(IoError::SkewedAxes { off }))
    }

    /// The largest cosine between two voxel axes, where they are not at right angles.
    #[must_use]
    pub fn skew(&self) -> Option<f64> {
        let d = self.directions();
        let cosine = |a: usize, b: usize| (d[a] * d[b] + d[a + 3] * d[b + 3] + d[a + 6] * d[b + 6]).abs();
        let off = cosine(0, 1).max(cosine(0, 2)).max(cosine(1, 2));
        // What is no number is no right angle.
        (off.is_nan() || off > ORTHOGONAL).then_some(off)
    }
}

impl TensorVolume {
    /// What the file holds.
    #[must_use]
    pub const fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Order of the components, and how it is known.
    #[must_use]
    pub const fn order(&self) -> (TensorOrder, Known) {
        self.order
    }

    /// Frame of the components, and how it is known.
    #[must_use]
    pub const fn frame(&self) -> (Frame, Known) {
        self.frame
    }

    /// The tensor of a voxel as stored, row by row, in [`Self::frame`]; index `(k * ny + j) * nx + i`.
    #[must_use]
    pub fn stored(&self, voxel: usize) -> [f64; 9] {
        let n = self.lattice.components;
        self.order.0.tensor(self.lattice.values.get(voxel * n..(voxel + 1) * n).unwrap_or_default())
    }

    /// All tensors as stored, the first axis fastest.
    pub fn tensors(&self) -> impl ExactSizeIterator<Item = [f64; 9]> + '_ {
        (0..self.lattice.voxels()).map(|voxel| self.stored(voxel))
    }

    /// The tensor of a voxel as stored; `None` where nothing was measured.
    #[must_use]
    pub fn measured(&self, voxel: usize) -> Option<[f64; 9]> {
        (!self.is_masked(voxel)).then(|| self.stored(voxel))
    }

    /// The first voxel that is measured but has a number that is infinite or none, and how many there are.
    #[must_use]
    pub fn not_finite(&self) -> Option<([usize; 3], usize)> {
        let [nx, ny, _] = self.lattice.size;
        let mut strange = (0..self.lattice.voxels())
            .filter(|&voxel| self.measured(voxel).is_some_and(|t| !t.iter().all(|v| v.is_finite())));
        let first = strange.next()?;
        Some(([first % nx, first / nx % ny, first / (nx * ny)], 1 + strange.count()))
    }

    /// With zero tensors in place of those that are not finite.
    #[must_use]
    pub fn with_zeros_for_not_finite(mut self) -> Self {
        for tuple in self.lattice.values.chunks_exact_mut(self.lattice.components.max(1)) {
            if !tuple.iter().all(|v| v.is_finite()) {
                tuple.fill(0.0);
            }
        }
        self
    }

    /// With the components along the axes that the file states, where it does, whatever the user said.
    #[must_use]
    pub fn as_stated(mut self) -> Self {
        if self.lattice.frame.1 == Known::Stated {
            self.frame = self.lattice.frame;
        }
        self
    }

    /// The order that the file states, where the user says another one.
    #[must_use]
    pub fn contradicted_order(&self) -> Option<TensorOrder> {
        let stated = self.lattice.order.filter(|(_, known)| *known == Known::Stated)?.0;
        (self.order.1 == Known::Given && stated != self.order.0).then_some(stated)
    }

    /// Whether a name suggests strains, whose shears may be engineering ones, while a shear is one number and nobody says
    /// what it is.
    #[must_use]
    pub fn suggests_engineering_shears(&self) -> bool {
        let names = self.lattice.component_names.iter().chain([&self.lattice.array]);
        let is_open = self.shear.1 != Known::Given && self.order.0.has_shared_shears();
        is_open && names.into_iter().any(|n| names::names_strain(n))
    }

    /// Voxels whose mask is zero.
    #[must_use]
    pub fn masked_out(&self) -> usize {
        self.lattice.mask.as_ref().map_or(0, |mask| mask.iter().filter(|&&m| m == 0.0).count())
    }

    /// What was read and what was assumed, a sentence each.
    #[must_use]
    pub fn story(&self) -> Vec<String> {
        let mut story = self.lattice.story();
        let (order, frame) = (self.order, self.frame);
        let words = [
            format!("component order {} ({})", order.0, order.1.words()),
            format!("components along {} ({})", frame.0.words(), frame.1.words()),
        ];
        story.splice(1..1, words);
        story
    }

    /// What turns stored components into components along the world's axes.
    pub(crate) fn to_world(&self) -> Result<Option<[f64; 9]>, IoError> {
        let turn = match (self.frame.0, self.lattice.measurement) {
            (Frame::World, _) => return Ok(None),
            (Frame::Measurement, Some(m)) => m,
            (Frame::Lps, _) => self.lattice.lps(),
            (Frame::Fsl, _) => product(&self.lattice.orthogonal_directions()?, &self.lattice.fsl_signs()),
            _ => self.lattice.orthogonal_directions()?,
        };
        Ok((turn != IDENTITY).then_some(turn))
    }
}

/// The unit matrix, row by row.
pub(crate) const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// `a b` of 3x3 matrices row by row.
fn product(a: &[f64; 9], b: &[f64; 9]) -> [f64; 9] {
    let mut c = [0.0; 9];
    for i in 0..3 {
        for j in 0..3 {
            c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
        }
    }
    c
}

/// `k t k^T`.
fn turned(k: &[f64; 9], t: &[f64; 9]) -> [f64; 9] {
    let transposed = [k[0], k[3], k[6], k[1], k[4], k[7], k[2], k[5], k[8]];
    product(&product(k, t), &transposed)
}

fn inverse(m: &[f64; 9]) -> Option<[f64; 9]> {
    let minor = |a: usize, b: usize, c: usize, d: usize| m[a] * m[d] - m[b] * m[c];
    let adjugate = [
        minor(4, 5, 7, 8),
        minor(2, 1, 8, 7),
        minor(1, 2, 4, 5),
        minor(5, 3, 8, 6),
        minor(0, 2, 6, 8),
        minor(2, 0, 5, 3),
        minor(3, 4, 6, 7),
        minor(1, 0, 7, 6),
        minor(0, 1, 3, 4),
    ];
    let determinant = m[0] * adjugate[0] + m[1] * adjugate[3] + m[2] * adjugate[6];
    (determinant != 0.0 && determinant.is_finite()).then(|| adjugate.map(|a| a / determinant))
}
