//! The header, checked against the bytes that follow before anything is allocated.
//!
//! The dictionary `{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }` is the only Python accepted: strings,
//! two booleans and one flat tuple cannot nest.

use super::error::NpyError;
use crate::ScalarType;
use crate::text::shortened;

/// NumPy's own bound for headers that are not trusted.
const MAX_HEADER: usize = 10_000;
const MAX_AXES: usize = 32;

/// A header that fits its file.
pub(super) struct Header {
    pub(super) scalar: ScalarType,
    pub(super) fortran: bool,
    pub(super) shape: Vec<usize>,
    /// Where the type `b1` stands, for arrays of truth values: bytes of 0 and 1.
    pub(super) truth: Option<usize>,
}

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, NpyError> {
        let (start, end) = text_range(bytes)?;
        let mut text = Text { bytes: &bytes[..end], at: start };
        let (mut descr, mut fortran, mut shape) = (None, None, None);
        text.token(b"{", "a dictionary `{`")?;
        while !text.accept(b"}") {
            let (at, key) = text.string()?;
            text.token(b":", "a colon behind the key")?;
            match key {
                b"descr" => descr = Some(text.string()?),
                b"fortran_order" => fortran = Some(text.boolean()?),
                b"shape" => shape = Some((text.at, text.tuple()?)),
                _ => return Err(header(at, "the keys descr, fortran_order and shape")),
            }
            if !text.accept(b",") {
                text.token(b"}", "a comma or `}`")?;
                break;
            }
        }
        if !text.rest().trim_ascii().is_empty() {
            return Err(header(text.at, "nothing behind `}`"));
        }
        let (Some((at, descr)), Some(fortran), Some((_, shape))) = (descr, fortran, shape) else {
            return Err(header(start, "the keys descr, fortran_order and shape"));
        };
        let scalar =
            scalar_type(descr).ok_or_else(|| NpyError::Type { byte: at, descr: shortened(descr) })?;
        let shape = fitting(&shape, scalar, end, bytes.len() - end)?;
        // Behind the quote and the byte order.
        let truth = (descr.get(1..) == Some(b"b1")).then_some(at + 2);
        Ok(Self { scalar, fortran, shape, truth })
    }
}

fn header(byte: usize, expected: &'static str) -> NpyError {
    NpyError::Header { byte, expected }
}

/// Where the dictionary starts and ends.
fn text_range(bytes: &[u8]) -> Result<(usize, usize), NpyError> {
    if !bytes.starts_with(b"\x93NUMPY") {
        return Err(header(0, "the magic bytes \\x93NUMPY"));
    }
    let long = match bytes.get(6..8) {
        Some([1, 0]) => false,
        Some([2 | 3, 0]) => true,
        _ => return Err(header(6, "version 1.0, 2.0 or 3.0")),
    };
    let field = if long { 8..12 } else { 8..10 };
    let size = bytes.get(field.clone()).ok_or_else(|| header(8, "the size of the header"))?;
    let size = size.iter().rev().fold(0_u64, |n, &b| n << 8 | u64::from(b));
    match usize::try_from(size) {
        Ok(size) if size > MAX_HEADER => Err(header(8, "at most 10000 bytes of header")),
        Ok(size) if size <= bytes.len() - field.end => Ok((field.end, field.end + size)),
        _ => Err(header(bytes.len(), "as many bytes as the header declares")),
    }
}

/// The shape, if its data are exactly the `present` bytes from `byte` on.
fn fitting(shape: &[u64], scalar: ScalarType, byte: usize, present: usize) -> Result<Vec<usize>, NpyError> {
    let count = |n: u128, &axis: &u64| n.saturating_mul(u128::from(axis));
    let declared = shape.iter().fold(scalar.bytes() as u128, count);
    let sizes: Option<Vec<usize>> = shape.iter().map(|&n| usize::try_from(n).ok()).collect();
    // An empty array may still have other axes whose strides would overflow.
    let strides = shape.iter().filter(|&&n| n > 0).fold(1, count);
    match sizes {
        Some(sizes) if declared == present as u128 && strides <= isize::MAX as u128 => Ok(sizes),
        _ => Err(NpyError::Size { byte, declared, present }),
    }
}

fn scalar_type(descr: &[u8]) -> Option<ScalarType> {
    let (order, kind) = descr.split_at_checked(1)?;
    let scalar = match kind {
        b"i1" => ScalarType::Int8,
        b"u1" | b"b1" => ScalarType::UInt8,
        b"i2" => ScalarType::Int16,
        b"u2" => ScalarType::UInt16,
        b"i4" => ScalarType::Int32,
        b"u4" => ScalarType::UInt32,
        b"i8" => ScalarType::Int64,
        b"u8" => ScalarType::UInt64,
        b"f4" => ScalarType::Float32,
        b"f8" => ScalarType::Float64,
        _ => return None,
    };
    // `|` means that the order does not matter: bytes only.
    (matches!(order, b"<" | b">") || order == b"|" && scalar.bytes() == 1).then_some(scalar)
}

/// The dictionary, read from the front.
struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Text<'a> {
    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    fn skip_blanks(&mut self) {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_ascii_start().len();
    }

    fn accept(&mut self, token: &[u8]) -> bool {
        self.skip_blanks();
        let found = self.rest().starts_with(token);
        if found {
            self.at += token.len();
        }
        found
    }

    fn token(&mut self, token: &[u8], expected: &'static str) -> Result<(), NpyError> {
        if self.accept(token) { Ok(()) } else { Err(header(self.at, expected)) }
    }

    /// A quoted string without escapes, and where it starts.
    fn string(&mut self) -> Result<(usize, &'a [u8]), NpyError> {
        self.skip_blanks();
        let at = self.at;
        let Some(&quote @ (b'\'' | b'"')) = self.rest().first() else {
            return Err(header(at, "a string (structured types are not read)"));
        };
        let content = &self.rest()[1..];
        let end = content.iter().position(|&b| b == quote).ok_or_else(|| header(at, "a closed string"))?;
        self.at += end + 2;
        Ok((at, &content[..end]))
    }

    fn boolean(&mut self) -> Result<bool, NpyError> {
        if self.accept(b"False") {
            return Ok(false);
        }
        self.token(b"True", "True or False").map(|()| true)
    }

    fn tuple(&mut self) -> Result<Vec<u64>, NpyError> {
        self.token(b"(", "a tuple `(`")?;
        let mut axes = Vec::new();
        while !self.accept(b")") {
            if axes.len() == MAX_AXES {
                return Err(header(self.at, "at most 32 axes"));
            }
            axes.push(self.integer()?);
            if !self.accept(b",") {
                self.token(b")", "a comma or `)`")?;
                break;
            }
        }
        Ok(axes)
    }

    fn integer(&mut self) -> Result<u64, NpyError> {
        self.skip_blanks();
        let digits = self.rest().iter().take_while(|b| b.is_ascii_digit()).count();
        let text = std::str::from_utf8(&self.rest()[..digits]).ok();
        let axis = text.and_then(|t| t.parse().ok());
        let axis = axis.ok_or_else(|| header(self.at, "a non-negative integer of at most 64 bits"))?;
        self.at += digits;
        Ok(axis)
    }
}
