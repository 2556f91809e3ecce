//! All file formats: one row each, from which reading, writing, messages and the documentation are made.

use crate::error::InputError;
use tigereye_core::{Field, Tensor2};
use tigereye_io::table::TableError;
use tigereye_io::volume::{
    Frame, Lattice, TensorVolume, lattice_from_image, lattice_from_points, points_from_image,
};
use tigereye_io::{
    ArrayChoice, ChoiceError, ImageData, IoError, Limits, Wanted, legacy, matrices, nifti, npy, nrrd,
    picture, table, vti, vtp,
};

/// A file format, known by the extensions of its files.
#[derive(Debug)]
pub struct Format {
    /// In lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Whether a file may hold several arrays with names, so that one can be chosen.
    pub has_names: bool,
    /// What files are read as, in Markdown.
    pub read_as: &'static str,
    /// What is written, in Markdown; empty for formats that are not written.
    pub written_for: &'static str,
    read: Reader,
    /// The name of the file that holds the numbers, where bytes are a header.
    detached: Option<Names>,
    /// How tensors are written.
    pub tensors: Option<TensorWriter>,
}

/// From bytes to numbers on a lattice.
type Reader = fn(&Request<'_>) -> Result<Found, InputError>;

/// From the bytes of a header to the name of the file that holds the numbers, if there is one.
type Names = fn(&[u8], Limits) -> Result<Option<String>, IoError>;

/// How tensors are written.
#[derive(Clone, Copy, Debug)]
pub enum TensorWriter {
    /// A plane without a place.
    Plane(fn(&Field<Tensor2>) -> Result<Vec<u8>, IoError>),
    /// A volume, or a plane as a volume of one layer.
    Volume(VolumeWriter),
}

/// How volumes are written: what the format has room for.
#[derive(Clone, Copy, Debug)]
pub enum VolumeWriter {
    /// An image with arrays beside the tensors; the second argument is a title in words, for formats without texts.
    Image(fn(ImageData, &str) -> Result<Vec<u8>, IoError>),
    /// Tensors in a frame, with a story of how they were made.
    Framed(fn(&TensorVolume, Frame, &str) -> Result<Vec<u8>, IoError>),
    /// The same along the voxel axes, with the components in one of several layouts.
    Layouts(fn(&TensorVolume, nifti::WrittenAs, &str) -> Result<Vec<u8>, IoError>),
}

/// The bytes of a file and what is wanted of them.
pub(crate) struct Request<'a> {
    pub(crate) bytes: &'a [u8],
    /// The bytes of the file that a header names.
    pub(crate) detached: Option<&'a [u8]>,
    pub(crate) array: ArrayChoice<'a>,
    pub(crate) wanted: Wanted,
    pub(crate) limits: Limits,
}

/// What was read, and the format in words.
pub(crate) type Found = (&'static str, Lattice);

/// Text matrices.
pub(crate) const TEXT_MATRICES: &str = "text matrices";

/// NumPy's formats, whose arrays say nothing of the axes of components.
pub(crate) const NUMPY: [&str; 2] = ["NumPy array", "NumPy archive"];

/// A table, one point a line.
pub(crate) const TABLE: &str = "table";

/// An image of single numbers as text.
pub(crate) const ROWS_OF_NUMBERS: &str = "rows of numbers";

/// Every format that tensors, or what they are derived from, are read from.
pub const FORMATS: &[Format] = &[
    Format {
        extensions: &["txt"],
        has_names: true,
        read_as: "tensors: 2x2 blocks, 2H rows of 2W numbers; tables as below; rows of numbers (`--derive`)",
        written_for: "tensors (`convert`)",
        read: read_text,
        detached: None,
        tensors: Some(TensorWriter::Plane(matrices::write)),
    },
    Format {
        extensions: &["csv", "dat", "vec", "jvc"],
        has_names: true,
        read_as: "tables, one point per line: tensors by names of columns (x, y, S11, S22, S12); vectors (x y u v, `--derive`)",
        written_for: "",
        read: |r| {
            let bytes = table::utf8(r.bytes);
            Ok((TABLE, read_table(&Request { bytes: &bytes, ..*r })?))
        },
        detached: None,
        tensors: None,
    },
    Format {
        extensions: &["npy"],
        has_names: false,
        read_as: "tensors (H, W, 2, 2) and [other shapes](../../crates/io/src/npy/mod.rs); numbers and vectors (`--derive`)",
        written_for: "light (H, W, S); gradient (S, H, W); tensors (H, W, 2, 2)",
        read: |r| Ok((NUMPY[0], npy::read_lattice(r.bytes, r.wanted)?)),
        detached: None,
        tensors: Some(TensorWriter::Plane(|field| Ok(npy::write_tensors(field)))),
    },
    Format {
        extensions: &["npz"],
        has_names: true,
        read_as: "the same, placed by the arrays x and y beside them",
        written_for: "",
        read: |r| Ok((NUMPY[1], npy::read_archive(r.bytes, r.array, r.wanted)?)),
        detached: None,
        tensors: None,
    },
    Format {
        extensions: &["vti"],
        has_names: true,
        read_as: "tensors (an array of 9, 7, 6, 4 or 3 components), flat or a volume; results, for `compare`",
        written_for: "light: energy, intensity, flux; gradient; tensors",
        read: |r| {
            let image = vti::read_with_limits(r.bytes, r.limits)?;
            Ok(("VTK image data", lattice_from_image(&image, r.array, r.wanted)?))
        },
        detached: None,
        tensors: Some(TensorWriter::Volume(VolumeWriter::Image(|image, _| vti::write(&image)))),
    },
    Format {
        extensions: &["vtp"],
        has_names: true,
        read_as: "tensors on points that form a lattice, row by row in any direction, or along the world's axes in any order",
        written_for: "tensors; lines, glyphs, ridges",
        read: |r| {
            let data = vtp::read_with_limits(r.bytes, r.limits)?;
            Ok(("VTK poly data", lattice_from_points(data, r.array, r.wanted)?))
        },
        detached: None,
        tensors: Some(TensorWriter::Volume(VolumeWriter::Image(|image, _| {
            vtp::write(&points_from_image(image))
        }))),
    },
    Format {
        extensions: &["vtk"],
        has_names: true,
        read_as: "tensors on structured points, or on grids whose points form a lattice: TENSORS, TENSORS6, FIELD; ASCII and binary",
        written_for: "tensors",
        read: |r| {
            let image = legacy::read_with_limits(r.bytes, r.limits)?;
            Ok(("legacy VTK", lattice_from_image(&image, r.array, r.wanted)?))
        },
        detached: None,
        tensors: Some(TensorWriter::Volume(VolumeWriter::Image(|image, title| legacy::write(&image, title)))),
    },
    Format {
        extensions: &["nrrd"],
        has_names: false,
        read_as: "tensors: the format's tensor kinds, with or without mask; raw, gzip, ascii",
        written_for: "tensors, gzip, along the world's axes",
        read: read_nrrd,
        detached: Some(nrrd::data_file),
        tensors: Some(TensorWriter::Volume(VolumeWriter::Framed(nrrd::write))),
    },
    Format {
        extensions: &["nhdr"],
        has_names: false,
        read_as: "the same, with the numbers in a file beside it",
        written_for: "",
        read: read_nrrd,
        detached: Some(nrrd::data_file),
        tensors: None,
    },
    Format {
        extensions: &["nii"],
        has_names: false,
        read_as: "tensors: symmetric and general matrices (5-D), six or nine components (4-D)",
        written_for: "tensors: matrices (5-D), along the voxel axes; six components (4-D) with `--write-order`",
        read: read_nifti,
        detached: None,
        tensors: Some(TensorWriter::Volume(VolumeWriter::Layouts(nifti::write))),
    },
    Format {
        extensions: &["nii.gz"],
        has_names: false,
        read_as: "the same",
        written_for: "the same",
        read: read_nifti,
        detached: None,
        tensors: Some(TensorWriter::Volume(VolumeWriter::Layouts(nifti::write_packed))),
    },
    Format {
        extensions: &["png"],
        has_names: false,
        read_as: "brightness, with `--derive`; bitmaps of scenes",
        written_for: "pictures",
        read: |r| Ok(("PNG picture", picture::read_png(r.bytes)?)),
        detached: None,
        tensors: None,
    },
];

/// Other files that the program reads or writes: extension, what they are read as, what they are written for.
const OTHERS: [[&str; 3]; 6] = [
    ["svg", "", "pictures"],
    ["apng", "", "the steps of a propagation as an animation"],
    ["pvd", "", "the steps of a propagation: `NAME.pvd` and a folder `NAME` of images"],
    ["part", "shards of a gradient, for `merge`; checkpoints", "shards (`ltg --shard`); checkpoints"],
    ["scene.ron", "scenes", ""],
    ["field.ron", "fields by formulas, generators or data files", "fields by formulas (`field new`)"],
];

impl Format {
    /// The format of a file by its name.
    #[must_use]
    pub fn of(name: &str) -> Option<&'static Self> {
        let extension = format_of(name);
        FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
    }

    /// The name of the file that holds the numbers, where `bytes` are a header.
    pub(crate) fn detached(&self, bytes: &[u8], limits: Limits) -> Result<Option<String>, IoError> {
        self.detached.map_or(Ok(None), |named| named(bytes, limits))
    }

    /// Reads a file.
    pub(crate) fn read(&self, request: &Request<'_>) -> Result<Found, InputError> {
        (self.read)(request)
    }
}

impl TensorWriter {
    /// Whether there is room for arrays beside the tensors.
    #[must_use]
    pub const fn has_arrays(&self) -> bool {
        matches!(self, Self::Volume(VolumeWriter::Image(_)))
    }

    /// Whether the components may be written in several layouts.
    #[must_use]
    pub const fn has_layouts(&self) -> bool {
        matches!(self, Self::Volume(VolumeWriter::Layouts(_)))
    }
}

/// The extension that tells the format, in lower case: `nii.gz` or what stands behind the last dot; empty without a
/// dot.
#[must_use]
pub fn format_of(name: &str) -> String {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name).to_ascii_lowercase();
    if file.ends_with(".nii.gz") {
        return "nii.gz".to_owned();
    }
    file.rsplit_once('.').map_or_else(String::new, |(_, extension)| extension.to_owned())
}

/// Whether [`crate::open`] knows what to do with a file of this name.
#[must_use]
pub fn is_readable(name: &str) -> bool {
    Format::of(name).is_some()
}

/// The extensions of the formats that `has` something, in words: `.a, .b or .c`.
fn extensions(has: impl Fn(&Format) -> bool) -> String {
    let all = FORMATS.iter().filter(|f| has(f)).flat_map(|f| f.extensions).map(|e| format!(".{e}"));
    let all: Vec<String> = all.collect();
    match &all[..] {
        [before @ .., last] if !before.is_empty() => format!("{} or {last}", before.join(", ")),
        all => all.concat(),
    }
}

/// The extensions of files that are read, in words.
#[must_use]
pub fn readable_extensions() -> String {
    extensions(|_| true)
}

/// The extensions of files that tensors are written to and whose writer is as wanted, in words.
#[must_use]
pub fn writable_extensions(wanted: impl Fn(&TensorWriter) -> bool) -> String {
    extensions(|f| f.tensors.as_ref().is_some_and(&wanted))
}

/// The page of the documentation.
#[must_use]
pub fn documentation() -> String {
    let mut page = "\
# File formats

<!-- Made from crates/input/src/formats.rs by `TIGEREYE_BLESS=1 cargo test -p tigereye-input`. -->

The extension of a file name determines the format.

| extension | read as | written for |
| --- | --- | --- |
"
    .to_owned();
    let tensors = FORMATS.iter().map(|f| (f.extensions, f.read_as, f.written_for));
    let others = OTHERS
        .iter()
        .map(|[extension, read_as, written_for]| (std::slice::from_ref(extension), *read_as, *written_for));
    for (extensions, read_as, written_for) in tensors.chain(others) {
        let extensions: Vec<String> = extensions.iter().map(|e| format!("`.{e}`")).collect();
        page += &format!("| {} | {read_as} | {written_for} |\n", extensions.join(", "));
    }
    page + "\nReports also write `.html`, `.json` and, for charts, `.csv`. Nothing else is read or written.\n"
}

/// Blocks of tensors, rows of numbers, or a table, by what is wanted and what stands in it.
fn read_text(request: &Request<'_>) -> Result<Found, InputError> {
    let bytes = table::utf8(request.bytes);
    let request = &Request { bytes: &bytes, ..*request };
    let option = match request.array {
        ArrayChoice::Usual => None,
        ArrayChoice::Named(_) => Some("--array"),
        ArrayChoice::Components(_) => Some("--components"),
    };
    match (is_table(request.bytes, request.wanted), option) {
        (true, _) => Ok((TABLE, read_table(request)?)),
        (false, Some(option)) => Err(InputError::nameless(option)),
        _ if request.wanted.is_numbers() => Ok((ROWS_OF_NUMBERS, table::read_numbers(request.bytes)?)),
        _ => Ok((TEXT_MATRICES, matrices::read_lattice(request.bytes)?)),
    }
}

fn read_nrrd(request: &Request<'_>) -> Result<Found, InputError> {
    Ok(("NRRD", nrrd::read_with_limits(request.bytes, request.detached, request.wanted, request.limits)?))
}

fn read_nifti(request: &Request<'_>) -> Result<Found, InputError> {
    Ok(("NIfTI-1", nifti::read_with_limits(request.bytes, request.limits)?))
}

/// Whether a text is a table. Images of single numbers may have columns that count.
fn is_table(bytes: &[u8], wanted: Wanted) -> bool {
    match (wanted, table::kind(bytes)) {
        (Wanted::Vectors, _) | (_, table::Kind::Named | table::Kind::Positions) => true,
        (Wanted::Scalars | Wanted::Mask, _) | (_, table::Kind::Other) => false,
        (Wanted::Tensors, table::Kind::Numbered) => true,
    }
}

/// What a table holds: vectors by names or places, anything else by the names of its columns.
fn read_table(request: &Request<'_>) -> Result<Lattice, InputError> {
    let (bytes, wanted) = (request.bytes, request.wanted);
    if wanted == Wanted::Vectors && matches!(request.array, ArrayChoice::Usual) {
        return Ok(match table::read_vectors(bytes) {
            // Other positions than x and y, other components than u and v, or several of them.
            Err(error @ IoError::Table(TableError::Header { .. }))
                if table::kind(bytes) == table::Kind::Named =>
            {
                match table::read_columns(bytes, request.array, wanted) {
                    Err(
                        IoError::Table(TableError::Header { .. })
                        | IoError::Choice(ChoiceError::NoArray { .. }),
                    ) => Err(error),
                    other => other,
                }
            }
            other => other,
        }?);
    }
    if wanted.is_numbers() && !is_table(bytes, wanted) {
        return Ok(table::read_numbers(bytes)?);
    }
    match table::read_columns(bytes, request.array, wanted) {
        // Vectors are read without names, too; of tensors nobody knows which columns they are.
        Err(IoError::Table(TableError::Header { .. })) if table::kind(bytes) != table::Kind::Named => {
            Err(InputError::UnnamedTable)
        }
        Err(IoError::Choice(ChoiceError::NoArray { .. })) if table::read_vectors(bytes).is_ok() => {
            Err(InputError::VectorTable)
        }
        other => Ok(other?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_extension_has_one_format() {
        let all: Vec<&str> =
            FORMATS.iter().flat_map(|f| f.extensions).copied().chain(OTHERS.map(|o| o[0])).collect();
        for extension in &all {
            assert_eq!(all.iter().filter(|e| *e == extension).count(), 1, "{extension}");
        }
    }

    #[test]
    fn rows_say_what_they_do() {
        for format in FORMATS {
            let name = format.extensions[0];
            assert!(!format.read_as.is_empty(), "{name}");
            assert!(
                format.tensors.is_none()
                    || format.written_for.contains("tensors")
                    || format.written_for == "the same",
                "{name}"
            );
        }
        assert_eq!(writable_extensions(TensorWriter::has_arrays), ".vti, .vtp or .vtk");
    }

    #[test]
    fn extensions_are_found_in_any_case() {
        for (name, extension) in
            [("a/B.NII.GZ", "nii.gz"), ("x.y/z.vti", "vti"), ("C:\\d.Txt", "txt"), ("a", ""), ("a.gz", "gz")]
        {
            assert_eq!(format_of(name), extension);
        }
        assert!(is_readable("a.NRRD") && !is_readable("a.svg") && !is_readable("a"));
    }

    /// TIGEREYE_BLESS=1 writes the page.
    #[test]
    fn the_documentation_is_made_of_the_table() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/reference/file-formats.md");
        if std::env::var_os("TIGEREYE_BLESS").is_some() {
            std::fs::write(path, documentation()).expect("a writable page");
        }
        let found = std::fs::read_to_string(path).expect("the page");
        assert!(found == documentation(), "{path} is stale: TIGEREYE_BLESS=1 makes it anew");
    }
}
