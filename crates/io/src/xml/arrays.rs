//! `<DataArray>` and `<Array>` elements to numbers and strings.

use super::blocks::{Expected, payload};
use super::compressor::Compressor;
use super::encoding::{Binary, Stream};
use super::error::XmlError;
use super::place::Place;
use super::tree::{Document, Element};
use crate::limits::LimitError;
use crate::text::shortened;
use crate::{ByteOrder, IoError, Limits, ScalarType};
use std::borrow::Cow;

/// Most components of a tuple: light distributions have one per direction.
const MAX_COMPONENTS: u64 = 1 << 16;
const SCALARS: &str = "Int8 to UInt64, Float32 or Float64";

/// What an array element holds.
pub(crate) enum Content {
    Numbers {
        components: usize,
        values: Vec<f64>,
        scalar: ScalarType,
    },
    Text(Vec<String>),
    /// An array of this type, which holds no numbers; not decoded.
    Skipped(String),
}

/// Reads the arrays of one file and keeps count of what they take.
pub(crate) struct ArrayReader<'d> {
    document: &'d Document<'d>,
    limits: Limits,
    values_left: u64,
}

impl<'d> ArrayReader<'d> {
    pub(crate) fn new(document: &'d Document<'d>, limits: Limits) -> Self {
        Self { document, limits, values_left: limits.values }
    }

    /// Reads one array. `tuples` is `None` where the element itself says how many it has.
    pub(crate) fn read(&mut self, element: &Element, tuples: Option<u64>) -> Result<Content, IoError> {
        let array = shortened(element.attribute("Name").unwrap_or_default().as_bytes());
        let place = Place { array, byte: element.byte };
        if let Some(step) = element.attribute("TimeStep") {
            return Err(place.unsupported("TimeStep", step, "data of one time only").into());
        }
        if let Some(byte) = element.markup {
            return Err(XmlError::Structure { byte, expected: "array text without entities or CDATA" }.into());
        }
        let kind = element.required("type", SCALARS)?;
        let components = integer(element, "NumberOfComponents", MAX_COMPONENTS)?.unwrap_or(1);
        if components == 0 {
            return Err(element.wrong("NumberOfComponents", "an integer from 1 to 65536").into());
        }
        let given = integer(element, "NumberOfTuples", u64::MAX)?;
        if matches!(kind, "Bit" | "Variant" | "UnicodeString") || (kind == "String" && tuples.is_some()) {
            return Ok(Content::Skipped(shortened(kind.as_bytes())));
        }
        if kind == "String" {
            return self.strings(element, &place, given.map(|n| u128::from(n) * u128::from(components)));
        }
        let scalar = ScalarType::from_name(kind).ok_or_else(|| place.unsupported("type", kind, SCALARS))?;
        let tuples = match (tuples, given) {
            (Some(n), Some(m)) if n != m => {
                return Err(place.size(place.byte, u128::from(m), u128::from(n), "tuples").into());
            }
            (Some(n), _) | (None, Some(n)) => n,
            (None, None) => {
                element.required("NumberOfTuples", "the number of tuples")?;
                0
            }
        };
        let count = u128::from(tuples) * u128::from(components);
        let values = self.numbers(element, &place, scalar, count)?;
        Ok(Content::Numbers { components: components as usize, values, scalar })
    }

    fn numbers(
        &mut self,
        element: &Element,
        place: &Place,
        scalar: ScalarType,
        count: u128,
    ) -> Result<Vec<f64>, IoError> {
        let left = u64::try_from(count).ok().and_then(|n| self.values_left.checked_sub(n));
        self.values_left = left.ok_or_else(|| LimitError::Values {
            array: place.array.clone(),
            byte: place.byte,
            limit: self.limits.values,
        })?;
        if element.required("format", FORMATS)? == "ascii" {
            return self.words(element, place, scalar, count);
        }
        let expected = Expected::Exactly(count * scalar.bytes() as u128);
        self.binary(element, place, expected, |bytes, order, _| Ok(scalar.decode(order, bytes)))
    }

    /// Numbers in text.
    fn words(
        &self,
        element: &Element,
        place: &Place,
        scalar: ScalarType,
        count: u128,
    ) -> Result<Vec<f64>, IoError> {
        let mut values = Vec::new();
        let mut found = 0_u128;
        for (byte, word) in self.text_words(element) {
            found += 1;
            if found <= count {
                let text = std::str::from_utf8(word).ok();
                let value = text.and_then(|w| scalar.parse(w));
                values.push(value.ok_or_else(|| place.number(byte, word, scalar.name()))?);
            }
        }
        if found == count { Ok(values) } else { Err(place.size(place.byte, found, count, "numbers").into()) }
    }

    /// Strings: zero-terminated, in text as the codes of their bytes.
    fn strings(&mut self, element: &Element, place: &Place, count: Option<u128>) -> Result<Content, IoError> {
        let check = |bytes: &[u8], byte: usize| {
            let strings = split_strings(bytes).ok_or_else(|| place.text(byte))?;
            match count {
                Some(n) if n != strings.len() as u128 => {
                    Err(place.size(byte, strings.len() as u128, n, "strings"))
                }
                _ => Ok(Content::Text(strings)),
            }
        };
        if element.required("format", FORMATS)? == "ascii" {
            let mut bytes = Vec::new();
            for (byte, word) in self.text_words(element) {
                bytes.push(byte_code(word).ok_or_else(|| place.number(byte, word, "byte (-128 to 255)"))?);
            }
            return Ok(check(&bytes, place.byte)?);
        }
        let left = u128::from(self.values_left);
        let (content, length) = self.binary(element, place, Expected::AtMost(left), |bytes, _, byte| {
            Ok((check(bytes, byte)?, bytes.len() as u64))
        })?;
        self.values_left = self.values_left.saturating_sub(length);
        Ok(content)
    }

    /// The words of an element's text with their offsets in the file.
    fn text_words(&self, element: &Element) -> impl Iterator<Item = (usize, &'d [u8])> {
        let bytes = self.document.bytes;
        let ranges = element.text.clone();
        ranges.into_iter().flat_map(move |range| {
            let words = bytes[range.clone()].split(u8::is_ascii_whitespace);
            words
                .scan(range.start, |at, word| {
                    let byte = *at;
                    *at += word.len() + 1;
                    Some((byte, word))
                })
                .filter(|(_, word)| !word.is_empty())
        })
    }

    /// Decodes binary data, inline or appended, and hands them to `with`.
    fn binary<T>(
        &self,
        element: &Element,
        place: &Place,
        expected: Expected,
        with: impl FnOnce(&[u8], ByteOrder, usize) -> Result<T, IoError>,
    ) -> Result<T, IoError> {
        let binary = self.settings(place)?;
        let inline;
        let stream = match element.required("format", FORMATS)? {
            "binary" => {
                inline = self.inline_text(element);
                let byte = element.text.first().map_or(element.byte, |r| r.start);
                Stream::new(&inline.0, byte + inline.1, true)
            }
            "appended" => self.appended(element)?,
            other => return Err(place.unsupported("format", other, FORMATS).into()),
        };
        let byte = stream.byte();
        with(&payload(stream, &binary, expected, place)?, binary.order, byte)
    }

    /// Base64 text without the blanks around it, and how many of them came first.
    fn inline_text(&self, element: &Element) -> (Cow<'d, [u8]>, usize) {
        let bytes = self.document.bytes;
        if let [range] = &element.text[..] {
            let text = &bytes[range.clone()];
            let leading = text.len() - text.trim_ascii_start().len();
            if !text.trim_ascii().iter().any(u8::is_ascii_whitespace) {
                return (Cow::Borrowed(text.trim_ascii()), leading);
            }
        }
        let all = element.text.iter().flat_map(|r| &bytes[r.clone()]);
        (Cow::Owned(all.copied().filter(|b| !b.is_ascii_whitespace()).collect()), 0)
    }

    fn appended(&self, element: &Element) -> Result<Stream<'d>, IoError> {
        let expected = "a byte offset into the appended data";
        let offset = element.required("offset", expected)?;
        let wrong = || element.wrong("offset", expected);
        let offset: usize = offset.trim().parse().map_err(|_| wrong())?;
        let Some(appended) = &self.document.appended else {
            let (parent, byte) = (self.document.root.name.clone(), self.document.root.byte);
            return Err(XmlError::MissingElement { byte, parent, element: "AppendedData" }.into());
        };
        let data = &self.document.bytes[appended.range.clone()];
        let data = if appended.base64 { data.trim_ascii_end() } else { data };
        let rest = data.get(offset..).ok_or_else(wrong)?;
        Ok(Stream::new(rest, appended.range.start + offset, appended.base64))
    }

    /// What the root says about binary arrays; asked for only where there are some.
    fn settings(&self, place: &Place) -> Result<Binary, IoError> {
        let root = &self.document.root;
        let orders = "LittleEndian or BigEndian";
        let order = match root.required("byte_order", orders)? {
            "LittleEndian" => ByteOrder::Little,
            "BigEndian" => ByteOrder::Big,
            _ => return Err(root.wrong("byte_order", orders).into()),
        };
        let word = match root.attribute("header_type") {
            // Files from before the attribute existed.
            None | Some("UInt32") => 4,
            Some("UInt64") => 8,
            Some(_) => return Err(root.wrong("header_type", "UInt32 or UInt64").into()),
        };
        let compressor = match root.attribute("compressor") {
            None | Some("") => Compressor::None,
            Some("vtkZLibDataCompressor") => Compressor::Zlib,
            Some("vtkLZ4DataCompressor") => Compressor::Lz4,
            Some(other) => {
                let expected = "vtkZLibDataCompressor, vtkLZ4DataCompressor or none";
                return Err(place.unsupported("compressor", other, expected).into());
            }
        };
        Ok(Binary { order, word, compressor })
    }
}

const FORMATS: &str = "ascii, binary or appended";

/// An attribute that holds an integer from 0 to `most`.
fn integer(element: &Element, attribute: &str, most: u64) -> Result<Option<u64>, IoError> {
    let Some(text) = element.attribute(attribute) else { return Ok(None) };
    match text.trim().parse::<u64>() {
        Ok(n) if n <= most => Ok(Some(n)),
        _ => Err(element.wrong(attribute, "a non-negative integer of sensible size").into()),
    }
}

/// The code of a byte; VTK prints those above 127 as negative numbers.
fn byte_code(word: &[u8]) -> Option<u8> {
    let code: i16 = std::str::from_utf8(word).ok()?.parse().ok()?;
    u8::try_from(code).or_else(|_| i8::try_from(code).map(i8::cast_unsigned)).ok()
}

fn split_strings(bytes: &[u8]) -> Option<Vec<String>> {
    if bytes.is_empty() {
        return Some(Vec::new());
    }
    let strings = bytes.strip_suffix(&[0])?.split(|&b| b == 0);
    strings.map(|s| String::from_utf8(s.to_vec()).ok()).collect()
}
