//! Words, lines and numbers of a legacy file.

use super::error::LegacyError;
use crate::array_error::ArrayError;
use crate::limits::LimitError;
use crate::text::shortened;
use crate::words::{Words, numbers};
use crate::{ByteOrder, IoError, Limits, ScalarType};

/// Longest line of text.
const MAX_LINE: usize = 4096;

/// A place in the file.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    binary: bool,
    limits: Limits,
    values_left: u64,
}

/// What the elements of an array are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stored {
    Numbers(ScalarType),
    Other(Other),
}

/// Elements that are not numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Other {
    Bits,
    Strings,
    Variants,
}

impl Other {
    /// The type's name in these files.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Bits => "bit",
            Self::Strings => "string",
            Self::Variants => "variant",
        }
    }
}

impl<'a> Cursor<'a> {
    /// Reads the three lines that head every file.
    pub(super) fn open(bytes: &'a [u8], limits: Limits) -> Result<Self, IoError> {
        let mut cursor = Self { bytes, at: 0, binary: false, limits, values_left: limits.values };
        let first = cursor.line()?;
        let head = first.split_at_checked(HEAD.len()).filter(|(head, _)| head.eq_ignore_ascii_case(HEAD));
        let major = head.and_then(|(_, rest)| major_version(rest));
        let expected = "`# vtk DataFile Version` 1.0 to 5.1";
        major.filter(|v| (1..=5).contains(v)).ok_or_else(|| fault(0, first, expected))?;
        cursor.line()?;
        let (byte, word) = cursor.word("ASCII or BINARY")?;
        cursor.binary = match word.to_ascii_uppercase().as_slice() {
            b"ASCII" => false,
            b"BINARY" => true,
            _ => return Err(fault(byte, word, "ASCII or BINARY").into()),
        };
        Ok(cursor)
    }

    pub(super) const fn limits(&self) -> Limits {
        self.limits
    }

    /// The rest of the line, without its end.
    pub(super) fn line(&mut self) -> Result<&'a [u8], IoError> {
        let rest = &self.bytes[self.at..];
        let window = &rest[..rest.len().min(MAX_LINE)];
        let length = window.iter().position(|&b| b == b'\n').unwrap_or(window.len());
        if length == MAX_LINE {
            return Err(fault(self.at, window, "a line of at most 4096 bytes").into());
        }
        self.at += (length + 1).min(rest.len());
        Ok(window[..length].strip_suffix(b"\r").unwrap_or(&window[..length]))
    }

    /// The next word with its place.
    pub(super) fn word(&mut self, expected: &'static str) -> Result<(usize, &'a [u8]), IoError> {
        Ok(self.next().ok_or_else(|| fault(self.bytes.len(), b"", expected))?)
    }

    /// The next word; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Option<(usize, &'a [u8])> {
        let mut words = Words::new(&self.bytes[self.at..]);
        let (byte, word) = words.next()?;
        let start = self.at;
        self.at += words.at();
        Some((start + byte, word))
    }

    /// The next word without moving on.
    pub(super) fn peek(&self) -> Option<&'a [u8]> {
        Words::new(&self.bytes[self.at..]).next().map(|(_, word)| word)
    }

    /// Whether the next word is a keyword, in any case.
    pub(super) fn peek_is(&self, keyword: &str) -> bool {
        self.peek().is_some_and(|word| word.eq_ignore_ascii_case(keyword.as_bytes()))
    }

    /// Whether the line has another word.
    pub(super) fn more_on_line(&self) -> bool {
        let rest = self.bytes[self.at..].iter();
        rest.take_while(|&&b| b != b'\n').any(|b| !b.is_ascii_whitespace())
    }

    pub(super) fn parse<T: std::str::FromStr>(&mut self, expected: &'static str) -> Result<T, IoError> {
        let (byte, word) = self.word(expected)?;
        let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
        Ok(parsed.ok_or_else(|| fault(byte, word, expected))?)
    }

    pub(super) fn finite(&mut self, expected: &'static str) -> Result<f64, IoError> {
        let byte = self.at;
        let number: f64 = self.parse(expected)?;
        if number.is_finite() {
            Ok(number)
        } else {
            Err(fault(byte, number.to_string().as_bytes(), expected).into())
        }
    }

    /// The name of an array; special characters are written as %HH.
    pub(super) fn name(&mut self) -> Result<String, IoError> {
        self.word("the name of an array").map(|(_, word)| decoded(word))
    }

    /// A number type by its name in these files.
    pub(super) fn scalar(&mut self) -> Result<ScalarType, IoError> {
        let byte = self.at;
        match self.element()? {
            Stored::Numbers(scalar) => Ok(scalar),
            Stored::Other(kind) => Err(fault(byte, kind.name().as_bytes(), TYPES).into()),
        }
    }

    /// The type of the elements of an array.
    pub(super) fn element(&mut self) -> Result<Stored, IoError> {
        let (byte, word) = self.word(TYPES)?;
        Ok(Stored::Numbers(match word.to_ascii_lowercase().as_slice() {
            b"char" | b"signed_char" => ScalarType::Int8,
            b"unsigned_char" => ScalarType::UInt8,
            b"short" => ScalarType::Int16,
            b"unsigned_short" => ScalarType::UInt16,
            b"int" => ScalarType::Int32,
            b"unsigned_int" => ScalarType::UInt32,
            b"long" | b"long_long" | b"vtktypeint64" => ScalarType::Int64,
            b"unsigned_long" | b"unsigned_long_long" | b"vtktypeuint64" => ScalarType::UInt64,
            b"float" => ScalarType::Float32,
            b"double" => ScalarType::Float64,
            // VTK has 64 bits in memory and writes 32 in every version.
            b"vtkidtype" => ScalarType::Int32,
            b"bit" => return Ok(Stored::Other(Other::Bits)),
            b"string" | b"utf8_string" => return Ok(Stored::Other(Other::Strings)),
            b"variant" => return Ok(Stored::Other(Other::Variants)),
            _ => return Err(fault(byte, word, TYPES).into()),
        }))
    }

    /// Skips `count` elements that are not numbers.
    pub(super) fn skip(&mut self, array: &str, kind: Other, count: u128) -> Result<(), IoError> {
        if kind == Other::Bits && !self.binary {
            return self.numbers(array, ScalarType::UInt8, count).map(drop);
        }
        // What is left of the line of the array's type.
        self.line()?;
        if kind == Other::Bits {
            return self.bytes_of(array, count.div_ceil(8)).map(drop);
        }
        let left = (self.bytes.len() - self.at) as u128;
        if count > left {
            let (array, byte, present) = (array.to_owned(), self.at, left as usize);
            return Err(ArrayError::Truncated { array, byte, needed: count, present }.into());
        }
        for _ in 0..count {
            // Text has a line for every string, and for every variant its type and value.
            if self.binary && kind == Other::Strings {
                self.packed_string(array)?;
            } else {
                self.line()?;
            }
        }
        Ok(())
    }

    /// A string of a binary file: its length in 1, 2, 4 or 8 bytes, of which the first two bits say which, and its
    /// bytes (vtkDataWriter.cxx of VTK 9).
    fn packed_string(&mut self, array: &str) -> Result<(), IoError> {
        let first = self.bytes.get(self.at).copied().unwrap_or_default();
        let width = match first >> 6 {
            3 => 1,
            2 => 2,
            1 => 4,
            _ => 8,
        };
        let packed = self.bytes_of(array, width)?;
        let mut length = u128::from(packed[0] & 0x3f);
        for &byte in &packed[1..] {
            length = length << 8 | u128::from(byte);
        }
        self.bytes_of(array, length).map(drop)
    }

    /// The next bytes of an array.
    fn bytes_of(&mut self, array: &str, needed: u128) -> Result<&'a [u8], IoError> {
        let rest = &self.bytes[self.at..];
        if needed > rest.len() as u128 {
            let (array, byte, present) = (array.to_owned(), self.at, rest.len());
            return Err(ArrayError::Truncated { array, byte, needed, present }.into());
        }
        self.at += needed as usize;
        Ok(&rest[..needed as usize])
    }

    /// `count` numbers of an array: words, or big-endian bytes behind the end of the line.
    pub(super) fn numbers(
        &mut self,
        array: &str,
        scalar: ScalarType,
        count: u128,
    ) -> Result<Vec<f64>, IoError> {
        let left = u64::try_from(count).ok().and_then(|n| self.values_left.checked_sub(n));
        let limit = self.limits.values;
        let many = || LimitError::Values { array: array.to_owned(), byte: self.at, limit };
        self.values_left = left.ok_or_else(many)?;
        if !self.binary {
            let mut words = Words::new(&self.bytes[self.at..]);
            let values = numbers(&mut words, self.at, scalar, count as u64)?;
            self.at += words.at();
            return Ok(values);
        }
        self.line()?;
        let stored = self.bytes_of(array, count * scalar.bytes() as u128)?;
        Ok(scalar.decode(ByteOrder::Big, stored))
    }

    pub(super) const fn at(&self) -> usize {
        self.at
    }

    pub(super) const fn binary(&self) -> bool {
        self.binary
    }
}

/// What every file begins with.
const HEAD: &[u8] = b"# vtk DataFile Version ";
const TYPES: &str = "a number type such as float, double or int";

fn major_version(text: &[u8]) -> Option<u32> {
    let (major, minor) = std::str::from_utf8(text).ok()?.trim().split_once('.')?;
    minor.parse::<u32>().ok()?;
    major.parse().ok()
}

/// A name with its special characters, which are written as %HH.
pub(super) fn decoded(word: &[u8]) -> String {
    let mut name = Vec::with_capacity(word.len());
    let mut rest = word;
    while let [first, behind @ ..] = rest {
        let code = behind.get(..2).filter(|_| *first == b'%').and_then(|h| std::str::from_utf8(h).ok());
        if let Some(byte) = code.and_then(|h| u8::from_str_radix(h, 16).ok()) {
            name.push(byte);
            rest = &behind[2..];
        } else {
            name.push(*first);
            rest = behind;
        }
    }
    String::from_utf8_lossy(&name).into_owned()
}

pub(super) fn fault(byte: usize, found: &[u8], expected: &'static str) -> LegacyError {
    LegacyError::Word { byte, found: shortened(found), expected }
}
