//! From [`ImageData`] to bytes.

use crate::error::shortened;
use crate::image::{ActiveArrays, DataArray, FieldValues, ImageData};
use crate::{IoError, ScalarType};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fmt::Write as _;
use std::io::Write as _;

/// Bytes of a block before compression.
const BLOCK: usize = 1 << 17;
/// zlib's level; fixed, so that the same data give the same bytes.
const LEVEL: u32 = 5;

/// Writes a file: version 1.0, little-endian, 64-bit headers, zlib blocks, appended raw.
///
/// # Errors
/// [`IoError::ArraySize`] for an array that does not fill the image, [`IoError::Unwritable`] for names or texts with
/// control characters, [`IoError::Components`] for an array without components, [`IoError::EmptyImage`].
pub fn write(image: &ImageData) -> Result<Vec<u8>, IoError> {
    let mut writer = Writer::default();
    let [Some(x), Some(y), Some(z)] = image.dimensions.map(|n| n.checked_sub(1)) else {
        return Err(IoError::EmptyImage { dimensions: image.dimensions });
    };
    let extent = format!("0 {x} 0 {y} 0 {z}");
    let direction = image.direction.unwrap_or([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    writer.line(format_args!("<?xml version=\"1.0\"?>"));
    writer.line(format_args!(
        "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
         compressor=\"vtkZLibDataCompressor\">"
    ));
    writer.line(format_args!(
        "  <ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\" Direction=\"{}\">",
        spaced(&image.origin),
        spaced(&image.spacing),
        spaced(&direction)
    ));
    writer.field_data(image)?;
    writer.line(format_args!("    <Piece Extent=\"{extent}\">"));
    let points = tuples(image.dimensions);
    writer.arrays("PointData", &image.point_active, &image.point_arrays, points)?;
    writer.arrays("CellData", &image.cell_active, &image.cell_arrays, tuples(image.cell_dimensions()))?;
    writer.line(format_args!("    </Piece>\n  </ImageData>\n  <AppendedData encoding=\"raw\">"));
    Ok(writer.finish())
}

fn tuples(dimensions: [usize; 3]) -> u128 {
    dimensions.iter().fold(1, |n, &d| n.saturating_mul(d as u128))
}

fn spaced(numbers: &[f64]) -> String {
    // `{:?}` gives the shortest digits that come back exactly.
    let words: Vec<String> = numbers.iter().map(|n| format!("{n:?}")).collect();
    words.join(" ")
}

/// The XML text and, beside it, the data it points to.
#[derive(Default)]
struct Writer {
    xml: String,
    data: Vec<u8>,
}

impl Writer {
    fn line(&mut self, text: std::fmt::Arguments) {
        // Writing to a String does not fail.
        let _ = writeln!(self.xml, "{text}");
    }

    fn field_data(&mut self, image: &ImageData) -> Result<(), IoError> {
        if image.field_data.is_empty() {
            return Ok(());
        }
        self.line(format_args!("    <FieldData>"));
        for entry in &image.field_data {
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

    fn arrays(
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

    fn array(&mut self, array: &DataArray, tuples: u128) -> Result<(), IoError> {
        let found = array.values.len() as u128;
        let expected = tuples.saturating_mul(array.components as u128);
        if found != expected {
            let (array, unit) = (array.name.clone(), "numbers");
            return Err(IoError::ArraySize { array, byte: self.xml.len(), found, expected, unit });
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

    fn finish(self) -> Vec<u8> {
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
        _ => Err(IoError::Components { array: name.to_owned(), components }),
    }
}

/// Strings, each ended by a zero byte.
fn terminated(name: &str, strings: &[String]) -> Result<Vec<u8>, IoError> {
    if strings.iter().any(|s| s.contains('\0')) {
        return Err(IoError::Unwritable { name: shortened(name.as_bytes()) });
    }
    Ok(strings.iter().flat_map(|s| s.bytes().chain([0])).collect())
}

/// An attribute's value with what XML reserves escaped.
fn attribute(text: &str) -> Result<String, IoError> {
    if text.chars().any(char::is_control) {
        return Err(IoError::Unwritable { name: shortened(text.as_bytes()) });
    }
    Ok(quick_xml::escape::escape(text).into_owned())
}
