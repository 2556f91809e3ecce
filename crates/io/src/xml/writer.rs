//! VTK XML files: version 1.0, little-endian, 64-bit headers, zlib blocks, appended raw.

use crate::array_error::ArrayError;
use crate::image::{ActiveArrays, DataArray, FieldEntry, FieldValues};
use crate::text::shortened;
use crate::write_error::WriteError;
use crate::{IoError, ScalarType};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fmt::Write as _;
use std::io::Write as _;

/// Bytes of a block before compression.
const BLOCK: usize = 1 << 17;
/// zlib's level; fixed, so that the same data give the same bytes.
const LEVEL: u32 = 5;

/// Numbers with blanks between them.
pub(crate) fn spaced(numbers: &[f64]) -> String {
    // `{:?}` gives the shortest digits that come back exactly.
    let words: Vec<String> = numbers.iter().map(|n| format!("{n:?}")).collect();
    words.join(" ")
}

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    ImageData,
    PolyData,
}

impl Kind {
    const fn name(self) -> &'static str {
        match self {
            Self::ImageData => "ImageData",
            Self::PolyData => "PolyData",
        }
    }
}

/// The XML text and, beside it, the data it points to.
pub(crate) struct Writer {
    kind: Kind,
    xml: String,
    data: Vec<u8>,
}

impl Writer {
    /// A file whose data set has `attributes`, each after a blank.
    pub(crate) fn open(kind: Kind, attributes: &str) -> Self {
        let mut writer = Self { kind, xml: String::new(), data: Vec::new() };
        let name = kind.name();
        writer.line(format_args!("<?xml version=\"1.0\"?>"));
        writer.line(format_args!(
            "<VTKFile type=\"{name}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">"
        ));
        writer.line(format_args!("  <{name}{attributes}>"));
        writer
    }

    pub(crate) fn line(&mut self, text: std::fmt::Arguments) {
        // Writing to a String does not fail.
        let _ = writeln!(self.xml, "{text}");
    }

    pub(crate) fn field_data(&mut self, entries: &[FieldEntry]) -> Result<(), IoError> {
        if entries.is_empty() {
            return Ok(());
        }
        self.line(format_args!("    <FieldData>"));
        for entry in entries {
            let name = attribute(&entry.name)?;
            let offset = self.data.len();
            match &entry.values {
                FieldValues::Text(strings) => {
                    self.append(&terminated(&entry.name, strings)?);
                    self.line(format_args!(
                        "      <Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"{}\" format=\"appended\" \
                         offset=\"{offset}\"/>",
                        strings.len()
                    ));
                }
                FieldValues::Numbers { components, values, scalar } => {
                    let tuples = check_components(&entry.name, *components, values.len())?;
                    self.append_numbers(*scalar, values);
                    self.line(format_args!(
                        "      <DataArray type=\"{}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
                         NumberOfTuples=\"{tuples}\" format=\"appended\" offset=\"{offset}\"/>",
                        scalar.name()
                    ));
                }
            }
        }
        self.line(format_args!("    </FieldData>"));
        Ok(())
    }

    /// A section with the arrays of points or cells.
    pub(crate) fn arrays(
        &mut self,
        element: &str,
        active: &ActiveArrays,
        arrays: &[DataArray],
        tuples: u128,
    ) -> Result<(), IoError> {
        let mut tag = format!("      <{element}");
        let kinds =
            [("Scalars", &active.scalars), ("Vectors", &active.vectors), ("Tensors", &active.tensors)];
        for (kind, name) in kinds {
            if let Some(name) = name {
                let _ = write!(tag, " {kind}=\"{}\"", attribute(name)?);
            }
        }
        self.line(format_args!("{tag}>"));
        for array in arrays {
            self.array(array, tuples)?;
        }
        self.line(format_args!("      </{element}>"));
        Ok(())
    }

    /// One array, which must have so many tuples.
    pub(crate) fn array(&mut self, array: &DataArray, tuples: u128) -> Result<(), IoError> {
        let found = array.values.len() as u128;
        let expected = tuples.saturating_mul(array.components as u128);
        if found != expected {
            let (array, unit) = (array.name.clone(), "numbers");
            return Err(ArrayError::Size { array, byte: self.xml.len(), found, expected, unit }.into());
        }
        check_components(&array.name, array.components, array.values.len())?;
        let mut names = String::new();
        for (i, name) in array.component_names.iter().enumerate().take(array.components) {
            if !name.is_empty() {
                let _ = write!(names, " ComponentName{i}=\"{}\"", attribute(name)?);
            }
        }
        let offset = self.data.len();
        self.append_numbers(array.scalar, &array.values);
        self.line(format_args!(
            "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{names} format=\"appended\" \
             offset=\"{offset}\"/>",
            array.scalar.name(),
            attribute(&array.name)?,
            array.components
        ));
        Ok(())
    }

    /// Encodes block by block, so that no second array of the whole size is needed.
    fn append_numbers(&mut self, scalar: ScalarType, values: &[f64]) {
        let count = values.len() * scalar.bytes();
        self.append_blocks(count, values.chunks(BLOCK / scalar.bytes()).map(|v| scalar.encode(v)));
    }

    fn append(&mut self, bytes: &[u8]) {
        self.append_blocks(bytes.len(), bytes.chunks(BLOCK).map(<[u8]>::to_vec));
    }

    /// The block table, then the blocks.
    fn append_blocks(&mut self, count: usize, blocks: impl ExactSizeIterator<Item = Vec<u8>>) {
        let words = [blocks.len(), BLOCK, count % BLOCK];
        self.data.extend(words.iter().flat_map(|&w| (w as u64).to_le_bytes()));
        let mut entry = self.data.len();
        self.data.resize(entry + 8 * blocks.len(), 0);
        for block in blocks {
            let before = self.data.len();
            self.compress(&block);
            let size = (self.data.len() - before) as u64;
            self.data[entry..entry + 8].copy_from_slice(&size.to_le_bytes());
            entry += 8;
        }
    }

    fn compress(&mut self, block: &[u8]) {
        let mut encoder = ZlibEncoder::new(&mut self.data, Compression::new(LEVEL));
        // Writing to a Vec does not fail.
        let _ = encoder.write_all(block);
        let _ = encoder.finish();
    }

    /// The whole file; the open `<Piece>` ends here.
    pub(crate) fn finish(mut self) -> Vec<u8> {
        let name = self.kind.name();
        self.line(format_args!("    </Piece>\n  </{name}>\n  <AppendedData encoding=\"raw\">"));
        let mut bytes = self.xml.into_bytes();
        bytes.extend_from_slice(b"   _");
        bytes.extend_from_slice(&self.data);
        bytes.extend_from_slice(b"\n  </AppendedData>\n</VTKFile>\n");
        bytes
    }
}

/// Number of tuples, where the numbers fill them.
fn check_components(name: &str, components: usize, values: usize) -> Result<usize, IoError> {
    match values.checked_rem(components) {
        Some(0) => Ok(values / components),
        _ => Err(ArrayError::Components { array: name.to_owned(), components }.into()),
    }
}

/// Strings, each ended by a zero byte.
fn terminated(name: &str, strings: &[String]) -> Result<Vec<u8>, IoError> {
    if strings.iter().any(|s| s.contains('\0')) {
        return Err(WriteError::Unwritable { name: shortened(name.as_bytes()) }.into());
    }
    Ok(strings.iter().flat_map(|s| s.bytes().chain([0])).collect())
}

/// An attribute's value with what XML reserves escaped.
fn attribute(text: &str) -> Result<String, IoError> {
    if text.chars().any(char::is_control) {
        return Err(WriteError::Unwritable { name: shortened(text.as_bytes()) }.into());
    }
    Ok(quick_xml::escape::escape(text).into_owned())
}
