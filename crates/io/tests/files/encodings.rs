//! Every way a VTK XML file may hold the same numbers, built here byte by byte, gives the same numbers.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::io::Write as _;
use tigereye_io::{ByteOrder, FieldValues, ImageData, ScalarType, vti};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Ascii,
    Inline,
    AppendedBase64,
    AppendedRaw,
}

#[derive(Clone, Copy, Debug)]
struct Variant {
    format: Format,
    order: ByteOrder,
    word: usize,
    compressor: &'static str,
    /// Bytes of a block before compression.
    block: usize,
}

impl Variant {
    fn words(&self, words: &[usize]) -> Vec<u8> {
        let bytes = |&w: &usize| match self.order {
            ByteOrder::Little => (w as u64).to_le_bytes()[..self.word].to_vec(),
            ByteOrder::Big => (w as u64).to_be_bytes()[8 - self.word..].to_vec(),
        };
        words.iter().flat_map(bytes).collect()
    }

    fn joined(&self, runs: &[Vec<u8>]) -> Vec<u8> {
        match self.format {
            Format::AppendedRaw => runs.concat(),
            _ => runs.iter().flat_map(|r| STANDARD.encode(r).into_bytes()).collect(),
        }
    }

    fn payload(&self, bytes: &[u8]) -> Vec<u8> {
        if self.compressor.is_empty() {
            return self.joined(&[[self.words(&[bytes.len()]), bytes.to_vec()].concat()]);
        }
        let blocks: Vec<Vec<u8>> = bytes.chunks(self.block).map(|b| self.compressed(b)).collect();
        let mut words = vec![blocks.len(), self.block, bytes.len() % self.block];
        words.extend(blocks.iter().map(Vec::len));
        self.joined(&[self.words(&words), blocks.concat()])
    }

    fn compressed(&self, block: &[u8]) -> Vec<u8> {
        if self.compressor == "vtkLZ4DataCompressor" {
            return lz4_flex::block::compress(block);
        }
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(block).unwrap();
        encoder.finish().unwrap()
    }

    fn numbers(&self, scalar: ScalarType, values: &[f64]) -> Vec<u8> {
        if self.format == Format::Ascii {
            return values.iter().map(|v| format!("{v} ")).collect::<String>().into_bytes();
        }
        let mut bytes = scalar.encode(values);
        if self.order == ByteOrder::Big {
            bytes.chunks_mut(scalar.bytes()).for_each(<[u8]>::reverse);
        }
        self.payload(&bytes)
    }

    fn strings(&self, text: &str) -> Vec<u8> {
        if self.format == Format::Ascii {
            // VTK prints bytes as signed numbers.
            return text.bytes().map(|b| format!("{} ", b.cast_signed())).collect::<String>().into_bytes();
        }
        self.payload(text.as_bytes())
    }

    /// A 3 x 2 x 1 image with one array of every number type and one string.
    fn file(&self) -> Vec<u8> {
        let mut appended = Vec::new();
        let mut element = |tag: &str, attributes: String, data: Vec<u8>| -> Vec<u8> {
            let (format, data) = match self.format {
                Format::Ascii => ("ascii".to_owned(), data),
                Format::Inline => ("binary".to_owned(), data),
                _ => {
                    let offset = appended.len();
                    appended.extend(data);
                    (format!("appended\" offset=\"{offset}"), Vec::new())
                }
            };
            let head = format!("<{tag} {attributes} format=\"{format}\">\n ");
            [head.as_bytes(), &data, format!("\n</{tag}>").as_bytes()].concat()
        };
        let text = "type=\"String\" Name=\"text\" NumberOfTuples=\"2\"".to_owned();
        let text = element("Array", text, self.strings("{\"\u{e9}\"}\0\0"));
        let mut arrays = Vec::new();
        for scalar in SCALARS {
            let attributes = format!("type=\"{0}\" Name=\"{0}\" NumberOfComponents=\"2\"", scalar.name());
            arrays.extend(element("DataArray", attributes, self.numbers(scalar, &VALUES)));
        }
        let (order, word) = (format!("{:?}Endian", self.order), 8 * self.word);
        let head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" byte_order=\"{order}\" header_type=\"UInt{word}\" \
             compressor=\"{}\">\n<ImageData WholeExtent=\"2 4 -1 0 0 0\" Origin=\"1 2 3\" Spacing=\"0.5 2 1\">\n<FieldData>",
            self.compressor
        );
        let middle = "</FieldData><Piece Extent=\"2 4 -1 0 0 0\"><PointData>";
        let mut file = [head.as_bytes(), &text, middle.as_bytes(), &arrays].concat();
        file.extend_from_slice(b"</PointData></Piece></ImageData>\n");
        if matches!(self.format, Format::AppendedBase64 | Format::AppendedRaw) {
            let encoding = if self.format == Format::AppendedRaw { "raw" } else { "base64" };
            file.extend(format!("<AppendedData encoding=\"{encoding}\">\n_").into_bytes());
            file.extend(appended);
            file.extend_from_slice(b"\n</AppendedData>");
        }
        file.extend_from_slice(b"\n</VTKFile>\n");
        file
    }
}

const SCALARS: [ScalarType; 10] = [
    ScalarType::Int8,
    ScalarType::UInt8,
    ScalarType::Int16,
    ScalarType::UInt16,
    ScalarType::Int32,
    ScalarType::UInt32,
    ScalarType::Int64,
    ScalarType::UInt64,
    ScalarType::Float32,
    ScalarType::Float64,
];
const VALUES: [f64; 12] = [0.0, 1.0, 2.0, 3.0, 60.0, 95.0, 38.0, 100.0, 127.0, 9.0, 10.0, 11.0];

fn variants() -> Vec<Variant> {
    let mut list = Vec::new();
    for format in [Format::Ascii, Format::Inline, Format::AppendedBase64, Format::AppendedRaw] {
        for order in [ByteOrder::Little, ByteOrder::Big] {
            for word in [4, 8] {
                for compressor in ["", "vtkZLibDataCompressor", "vtkLZ4DataCompressor"] {
                    // 12 values of 1 to 8 bytes: several blocks, full and partial last ones.
                    for block in [16, 32, 40, 1 << 15] {
                        list.push(Variant { format, order, word, compressor, block });
                    }
                }
            }
        }
    }
    list
}

fn check(variant: Variant, image: &ImageData) {
    assert_eq!(image.dimensions, [3, 2, 1], "{variant:?}");
    // The extent starts at (2, -1): the origin moves along.
    assert_eq!(image.origin, [2.0, 0.0, 3.0], "{variant:?}");
    assert_eq!(image.field_data[0].values, FieldValues::Text(vec!["{\"\u{e9}\"}".into(), String::new()]));
    assert_eq!(image.point_arrays.len(), SCALARS.len(), "{variant:?}");
    for (array, scalar) in image.point_arrays.iter().zip(SCALARS) {
        assert_eq!((array.scalar, array.components), (scalar, 2), "{variant:?}");
        assert_eq!(array.values, VALUES, "{variant:?} {}", array.name);
    }
}

#[test]
fn every_encoding_gives_the_same_numbers() {
    for variant in variants() {
        let image = vti::read(&variant.file()).unwrap_or_else(|e| panic!("{variant:?}: {e}"));
        check(variant, &image);
    }
}

#[test]
fn a_shortened_array_is_never_read() {
    for variant in variants().into_iter().filter(|v| v.block != 1 << 15) {
        let file = variant.file();
        // Taking one byte out of the data must not go unnoticed in binary data.
        if variant.format == Format::AppendedRaw {
            let end = file.len() - b"\n</AppendedData>\n</VTKFile>\n".len();
            // The white space before the closing tag must go too: it would stand in for the missing byte.
            let cut = [&file[..end - 1], b"</AppendedData></VTKFile>"].concat();
            let error = vti::read(&cut).expect_err("a byte is missing").to_string();
            assert!(error.contains("array `Float64`"), "{variant:?}: {error}");
        }
    }
}

#[test]
fn base64_may_be_broken_into_lines() {
    let variant = Variant {
        format: Format::Inline,
        order: ByteOrder::Little,
        word: 4,
        compressor: "vtkZLibDataCompressor",
        block: 32,
    };
    let text = String::from_utf8(variant.file()).unwrap();
    let broken = text.replace("eJ", "\n  eJ");
    assert_ne!(text, broken);
    check(variant, &vti::read(broken.as_bytes()).unwrap());
}

#[test]
fn what_is_not_read_is_refused_by_name() {
    let variant = Variant {
        format: Format::Inline,
        order: ByteOrder::Little,
        word: 4,
        compressor: "vtkLZMADataCompressor",
        block: 32,
    };
    let text = String::from_utf8(variant.file()).unwrap();
    let refused = |text: &str, message: &str| {
        let error = vti::read(text.as_bytes()).expect_err(message).to_string();
        assert!(error.contains(message), "{error}");
    };
    refused(&text, "array `text` is not read: compressor=\"vtkLZMADataCompressor\"");
    let text = text.replace("vtkLZMADataCompressor", "vtkZLibDataCompressor");
    // Arrays that hold no numbers are passed over, those of unknown types refused.
    for (kind, words) in [("Bit", "`Int8` (Bit, no numbers)"), ("String", "`Int8` (String, no numbers)")] {
        let image = vti::read(text.replace("\"Int8\" Name", &format!("\"{kind}\" Name")).as_bytes()).unwrap();
        assert_eq!((image.skipped, image.point_arrays.len()), (vec![words.to_owned()], 9));
    }
    refused(&text.replace("\"Int8\" Name", "\"Int9\" Name"), "array `Int8` is not read: type=\"Int9\"");
    refused(
        &text.replace("Name=\"Int8\"", "Name=\"Int8\" TimeStep=\"0\""),
        "`Int8` is not read: TimeStep=\"0\"",
    );
    refused(
        &text.replace("Name=\"Int8\"", "Name=\"Int8\" NumberOfTuples=\"5\""),
        "holds 5 tuples, expected 6",
    );
    refused(&text.replace("<Piece", "<Piece></Piece><Piece"), "2 <Piece> elements: expected one");
    refused(
        &text.replace("type=\"ImageData\"", "type=\"PolyData\""),
        "type=\"PolyData\" of element <VTKFile>",
    );
    refused(&text.replace("Piece Extent=\"2 4", "Piece Extent=\"2 3"), "expected the WholeExtent");
    refused(&text.replace("LittleEndian", "Middle"), "byte_order=\"Middle\"");
    refused(&text.replace("UInt32\" compressor", "UInt16\" compressor"), "header_type=\"UInt16\"");
    refused(&text.replace("<PointData>", "<PointData><Unknown/>"), "found element <Unknown>");
    refused(
        &text.replace("format=\"binary\"", "format=\"appended\" offset=\"0\""),
        "holds no <AppendedData>",
    );
    refused(&text.replace("Spacing=\"0.5", "Spacing=\"nan"), "expected three finite numbers");
}

#[test]
fn text_numbers_are_checked_with_their_byte() {
    let start = "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 0 0 0\"><Piece Extent=\"0 1 0 0 0 0\">\
                 <PointData><DataArray type=\"UInt8\" Name=\"a\" format=\"ascii\">";
    let end = "</DataArray></PointData></Piece></ImageData></VTKFile>";
    let read =
        |numbers: &str| vti::read(format!("{start}{numbers}{end}").as_bytes()).map_err(|e| e.to_string());
    assert_eq!(read(" 1\n 255 ").unwrap().point_arrays[0].values, [1.0, 255.0]);
    let wrong =
        |at: usize, word: &str| format!("byte {at}: array `a`: expected a UInt8 number, found `{word}`");
    assert_eq!(read(" 1 256"), Err(wrong(start.len() + 3, "256")));
    assert_eq!(read("x 2"), Err(wrong(start.len(), "x")));
    let element = start.find("<DataArray").unwrap();
    assert_eq!(read("1 2 3"), Err(format!("byte {element}: array `a` holds 3 numbers, expected 2")));
    assert_eq!(read("1"), Err(format!("byte {element}: array `a` holds 1 numbers, expected 2")));
    assert!(read("1 &#50;").unwrap_err().contains("expected array text without entities"));
}
