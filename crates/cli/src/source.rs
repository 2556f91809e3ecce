//! Files of every readable format, before a plane is chosen.

use crate::args::ReadingArgs;
use crate::error::CliError;
use crate::files;
use crate::input::Input;
use crate::interrupt;
use std::path::Path;
use tigereye_experiments::provenance::hash_of_bytes;
use tigereye_io::volume::{
    Known, Lattice, PlaneChoice, Reading, TensorVolume, lattice_from_image, lattice_from_points,
};
use tigereye_io::{IoError, legacy, nifti, nrrd, vti, vtp};

/// What INPUT holds.
#[derive(Debug)]
pub(crate) enum Source {
    /// A field in the plane: text, a NumPy array, or a generator's.
    Field(Input),
    /// Tensors on a lattice, possibly flat.
    Volume(VolumeFile),
    /// One number a voxel.
    Scalars(ScalarFile),
}

/// A volume with what is known about its file.
#[derive(Debug)]
pub(crate) struct VolumeFile {
    /// As the user wrote it.
    pub(crate) name: String,
    /// The format.
    pub(crate) kind: &'static str,
    /// Hash of the file; of header and data where these are two.
    pub(crate) blake3: String,
    pub(crate) volume: TensorVolume,
}

/// A scalar image.
#[derive(Debug)]
pub(crate) struct ScalarFile {
    pub(crate) name: String,
    pub(crate) kind: &'static str,
    pub(crate) blake3: String,
    pub(crate) lattice: Lattice,
}

impl Source {
    /// Reads INPUT: a path with a known ending, or a generator.
    pub(crate) fn open(text: &str, reading: &ReadingArgs) -> Result<Self, CliError> {
        let path = Path::new(text);
        let (kind, read): (_, Reader) = match files::format(path).as_str() {
            "vti" => ("VTK image data", |bytes, _, array| {
                vti::read(bytes).and_then(|image| lattice_from_image(&image, array))
            }),
            "vtp" => ("VTK poly data", |bytes, _, array| {
                vtp::read(bytes).and_then(|data| lattice_from_points(data, array))
            }),
            "vtk" => ("legacy VTK", |bytes, _, array| {
                legacy::read(bytes).and_then(|image| lattice_from_image(&image, array))
            }),
            "nii" | "nii.gz" => ("NIfTI-1", |bytes, _, _| nifti::read(bytes)),
            "nrrd" | "nhdr" => ("NRRD", |bytes, data, _| nrrd::read(bytes, data)),
            _ => return Input::of_plane(text, path).map(Self::Field),
        };
        let bytes = files::read(path)?;
        let fault = |e: IoError| CliError::input(text, e);
        let data_name = if kind == "NRRD" { nrrd::data_file(&bytes).map_err(fault)? } else { None };
        let data = data_name.as_ref().map(|name| files::read(&files::beside(path, name))).transpose()?;
        let array = reading.array.as_deref();
        let lattice = read(&bytes, data.as_deref(), array).map_err(|e| match &data_name {
            Some(name) => CliError::input(text, format!("with its data in {name}: {e}")),
            None => fault(e),
        })?;
        // Large inputs take a while.
        interrupt::check()?;
        let blake3 = match &data {
            Some(data) => hash_of_bytes(&[bytes.as_slice(), data].concat()),
            None => hash_of_bytes(&bytes),
        };
        let name = text.to_owned();
        if lattice.components == 1 && reading.order.is_none() {
            return Ok(Self::Scalars(ScalarFile { name, kind, blake3, lattice }));
        }
        let frame = reading.frame.map(Into::into);
        let volume = lattice.tensors(Reading { order: reading.order.as_deref(), frame }).map_err(fault)?;
        Ok(Self::Volume(VolumeFile { name, kind, blake3, volume }))
    }

    /// Whether the plane is clear without asking.
    pub(crate) fn has_plane(&self, reading: &ReadingArgs) -> bool {
        match self {
            Self::Field(_) => true,
            Self::Volume(file) => file.has_plane(reading),
            Self::Scalars(_) => false,
        }
    }
}

type Reader = fn(&[u8], Option<&[u8]>, Option<&str>) -> Result<Lattice, IoError>;

/// What the options say about the plane.
pub(crate) fn choice(reading: &ReadingArgs) -> PlaneChoice {
    PlaneChoice { plane: reading.plane.map(Into::into), slice: reading.slice }
}

impl VolumeFile {
    /// Whether a plane is asked for, or the volume has only one.
    pub(crate) fn has_plane(&self, reading: &ReadingArgs) -> bool {
        let choice = choice(reading);
        choice != PlaneChoice::default() || choice.resolve(self.volume.lattice().size).is_ok()
    }

    /// Why the component order looks wrong, and what would look right.
    pub(crate) fn warning(&self) -> Option<String> {
        let s = self.volume.suspicion()?;
        Some(format!(
            "{:.1} % of the tensors have a negative eigenvalue in this component order and {:.1} % in the order of \
             {} ({}): see --order",
            100.0 * s.share,
            100.0 * s.better,
            s.tools,
            s.order
        ))
    }

    /// What had to be assumed about the components, in a sentence.
    pub(crate) fn assumption(&self) -> Option<String> {
        let (order, frame) = (self.volume.order(), self.volume.frame());
        let order_words = format!("component order {} (--order)", order.0);
        let frame_words = format!("components along the {} axes (--frame)", frame.0.name());
        match (order.1 == Known::Assumed, frame.1 == Known::Assumed) {
            (true, true) => Some(format!("assumed {order_words} and {frame_words}")),
            (true, false) => Some(format!("assumed {order_words}")),
            (false, true) => Some(format!("assumed {frame_words}")),
            (false, false) => None,
        }
    }

    /// Assumptions and warnings to standard error.
    pub(crate) fn tell(&self) {
        for words in
            [self.assumption(), self.warning().map(|w| format!("WARNING: {w}"))].into_iter().flatten()
        {
            eprintln!("{}: {words}", self.name);
        }
    }
}
