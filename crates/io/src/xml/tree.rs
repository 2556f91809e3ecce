//! The elements of a VTK XML file as a small tree, and the appended data behind them.
//!
//! Raw appended data may hold any byte, so the XML parser stops at `<AppendedData>`; from there on the file is only
//! cut, not parsed.

use super::error::XmlError;
use crate::text::shortened;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;
use std::ops::Range;

const MAX_DEPTH: usize = 16;
const MAX_ELEMENTS: usize = 100_000;
const MAX_ATTRIBUTES: usize = 16_384;
const MAX_TAG_BYTES: usize = 1 << 20;

/// One element. Texts stay where they are in the file.
#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) name: String,
    /// Offset of its tag in the file.
    pub(crate) byte: usize,
    pub(crate) attributes: Vec<(String, String)>,
    pub(crate) children: Vec<Element>,
    /// Its direct text, as ranges of the file.
    pub(crate) text: Vec<Range<usize>>,
    /// Offset of the first entity reference or CDATA section in its text, which no array holds.
    pub(crate) markup: Option<usize>,
}

/// Appended data, from behind the underscore up to the closing tag.
#[derive(Clone, Debug)]
pub(crate) struct Appended {
    pub(crate) base64: bool,
    pub(crate) range: Range<usize>,
}

/// A VTK XML file in its parts.
pub(crate) struct Document<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) root: Element,
    pub(crate) appended: Option<Appended>,
}

impl Element {
    pub(crate) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }

    pub(crate) fn required(&self, attribute: &'static str, expected: &'static str) -> Result<&str, XmlError> {
        self.attribute(attribute).ok_or_else(|| XmlError::MissingAttribute {
            byte: self.byte,
            element: self.name.clone(),
            attribute,
            expected,
        })
    }

    /// The error that an attribute's value is not what it should be.
    pub(crate) fn wrong(&self, attribute: &str, expected: &'static str) -> XmlError {
        XmlError::Attribute {
            byte: self.byte,
            element: self.name.clone(),
            attribute: attribute.to_owned(),
            value: shortened(self.attribute(attribute).unwrap_or_default().as_bytes()),
            expected,
        }
    }

    /// The error that this element has no place here.
    pub(crate) fn unexpected(&self, expected: &'static str) -> XmlError {
        XmlError::Element { byte: self.byte, element: self.name.clone(), expected }
    }
}

impl<'a> Document<'a> {
    /// Parses a file up to its appended data.
    pub(crate) fn parse(bytes: &'a [u8]) -> Result<Self, XmlError> {
        let mut builder = Builder { open: Vec::new(), root: None, elements: 0 };
        let mut reader = Reader::from_reader(bytes);
        loop {
            let byte = position(&reader);
            let event = reader.read_event().map_err(|e| XmlError::Syntax {
                byte: usize::try_from(reader.error_position()).unwrap_or(byte),
                problem: e.to_string(),
            })?;
            let after = position(&reader);
            match event {
                Event::Start(tag) if builder.is_appended(&tag) => {
                    let appended = builder.element(&tag, byte)?;
                    let appended = cut_appended(bytes, &appended, after)?;
                    let root = builder.finish(bytes.len(), true)?;
                    return Ok(Self { bytes, root, appended: Some(appended) });
                }
                Event::Start(tag) => builder.start(&tag, byte)?,
                Event::Empty(tag) => {
                    builder.start(&tag, byte)?;
                    builder.end();
                }
                Event::End(_) => builder.end(),
                Event::Text(_) => builder.text(byte..after, bytes)?,
                Event::CData(_) | Event::GeneralRef(_) => builder.markup(byte),
                Event::DocType(_) => {
                    return Err(XmlError::Structure { byte, expected: "no document type declaration" });
                }
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) => {}
                Event::Eof => {
                    let root = builder.finish(byte, false)?;
                    return Ok(Self { bytes, root, appended: None });
                }
            }
        }
    }
}

fn position(reader: &Reader<&[u8]>) -> usize {
    // Never beyond the slice, so it fits.
    usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX)
}

/// Finds underscore and closing tag by hand.
fn cut_appended(bytes: &[u8], element: &Element, after: usize) -> Result<Appended, XmlError> {
    let base64 = match element.required("encoding", "raw or base64")? {
        "raw" => false,
        "base64" => true,
        _ => return Err(element.wrong("encoding", "raw or base64")),
    };
    let content = &bytes[after..];
    let blanks = content.iter().take_while(|b| b.is_ascii_whitespace()).count();
    if content.get(blanks) != Some(&b'_') {
        let expected = "an underscore before the appended data";
        return Err(XmlError::Structure { byte: after + blanks, expected });
    }
    let start = after + blanks + 1;
    let end = closing_tag(&bytes[start..]).ok_or(XmlError::Structure {
        byte: bytes.len(),
        expected: "</AppendedData></VTKFile> at the end of the file",
    })?;
    Ok(Appended { base64, range: start..start + end })
}

/// Where the closing tags start that end the file; raw data may hold the same letters earlier.
fn closing_tag(data: &[u8]) -> Option<usize> {
    let rest = data.trim_ascii_end().strip_suffix(b"</VTKFile>")?;
    let rest = rest.trim_ascii_end().strip_suffix(b"</AppendedData>")?;
    Some(rest.len())
}

/// The tree while it grows.
struct Builder {
    open: Vec<Element>,
    root: Option<Element>,
    elements: usize,
}

impl Builder {
    /// Appended data are a child of the root.
    fn is_appended(&self, tag: &BytesStart) -> bool {
        self.open.len() == 1 && tag.name().as_ref() == "AppendedData"
    }

    fn start(&mut self, tag: &BytesStart, byte: usize) -> Result<(), XmlError> {
        if self.open.is_empty() && self.root.is_some() {
            return Err(XmlError::Structure { byte, expected: "one root element" });
        }
        if self.open.len() == MAX_DEPTH {
            return Err(XmlError::Structure { byte, expected: "at most 16 nested elements" });
        }
        if self.elements == MAX_ELEMENTS {
            return Err(XmlError::Structure { byte, expected: "at most 100000 elements" });
        }
        self.elements += 1;
        let element = self.element(tag, byte)?;
        self.open.push(element);
        Ok(())
    }

    fn element(&self, tag: &BytesStart, byte: usize) -> Result<Element, XmlError> {
        if tag.len() > MAX_TAG_BYTES {
            return Err(XmlError::Structure { byte, expected: "tags of at most 1 MiB" });
        }
        Ok(Element {
            name: tag.name().as_ref().to_owned(),
            byte,
            attributes: attributes(tag, byte)?,
            children: Vec::new(),
            text: Vec::new(),
            markup: None,
        })
    }

    fn end(&mut self) {
        // The reader checks that tags match, so one is open.
        if let Some(element) = self.open.pop() {
            match self.open.last_mut() {
                Some(parent) => parent.children.push(element),
                None => self.root = Some(element),
            }
        }
    }

    fn text(&mut self, range: Range<usize>, bytes: &[u8]) -> Result<(), XmlError> {
        let blank = bytes[range.clone()].trim_ascii().is_empty();
        match self.open.last_mut() {
            Some(_) if blank => Ok(()),
            Some(element) => {
                element.text.push(range);
                Ok(())
            }
            // A byte order mark is part of the first text.
            None if blank || range.start == 0 && &bytes[range.clone()] == b"\xef\xbb\xbf" => Ok(()),
            None => Err(XmlError::Structure { byte: range.start, expected: "an XML element" }),
        }
    }

    fn markup(&mut self, byte: usize) {
        if let Some(element) = self.open.last_mut() {
            element.markup.get_or_insert(byte);
        }
    }

    /// The root; with appended data it is still open.
    fn finish(mut self, byte: usize, root_open: bool) -> Result<Element, XmlError> {
        if root_open {
            self.end();
        }
        match self.root {
            Some(root) if self.open.is_empty() => Ok(root),
            _ => Err(XmlError::Structure { byte, expected: "closed elements at the end of the file" }),
        }
    }
}

fn attributes(tag: &BytesStart, byte: usize) -> Result<Vec<(String, String)>, XmlError> {
    let syntax = |problem: String| XmlError::Syntax { byte, problem };
    let mut list: Vec<(String, String)> = Vec::new();
    // The reader's own check for duplicates takes quadratic time.
    for attribute in tag.attributes().with_checks(false) {
        let attribute = attribute.map_err(|e| syntax(e.to_string()))?;
        let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|e| syntax(e.to_string()))?;
        list.push((attribute.key.as_ref().to_owned(), value.into_owned()));
        if list.len() > MAX_ATTRIBUTES {
            return Err(XmlError::Structure { byte, expected: "at most 16384 attributes of an element" });
        }
    }
    let mut names: Vec<&str> = list.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    if names.windows(2).any(|w| w[0] == w[1]) {
        return Err(XmlError::Structure { byte, expected: "each attribute once" });
    }
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Element, String> {
        Document::parse(text.as_bytes()).map(|d| d.root).map_err(|e| e.to_string())
    }

    #[test]
    fn texts_and_attributes_keep_their_places() {
        let text = "<?xml version=\"1.0\"?>\n<a x=\"1 &lt; 2\"><b/> 12 <!-- no --> 3</a>";
        let root = parse(text).unwrap();
        assert_eq!((root.byte, root.attribute("x"), root.children.len()), (22, Some("1 < 2"), 1));
        let texts: Vec<&str> = root.text.iter().map(|r| text[r.clone()].trim()).collect();
        assert_eq!(texts, ["12", "3"]);
    }

    #[test]
    fn raw_data_may_hold_anything() {
        let mut bytes = b"<VTKFile><AppendedData encoding=\"raw\">\n _".to_vec();
        bytes.extend_from_slice(b"\x00\xff<&</AppendedData></VTKFile>_\n</AppendedData>\n</VTKFile>\n");
        let document = Document::parse(&bytes).unwrap();
        let data = &bytes[document.appended.unwrap().range];
        assert_eq!(data, b"\x00\xff<&</AppendedData></VTKFile>_\n");
    }

    #[test]
    fn hostile_markup_is_refused() {
        assert!(parse(&"<a>".repeat(17)).unwrap_err().contains("at most 16 nested"));
        assert!(parse("<a x='1' x='2'/>").unwrap_err().contains("each attribute once"));
        assert!(parse("<!DOCTYPE a [<!ENTITY b 'c'>]><a/>").unwrap_err().contains("no document type"));
        assert!(parse("<a><b></a>").unwrap_err().starts_with("byte 6: not well-formed"));
        assert!(parse("<a/><b/>").unwrap_err().contains("one root"));
        assert!(parse("").unwrap_err().contains("closed elements"));
        let many = format!("<a {}/>", (0..20_000).map(|i| format!("x{i}='' ")).collect::<String>());
        assert!(parse(&many).unwrap_err().contains("at most 16384 attributes"));
    }
}
