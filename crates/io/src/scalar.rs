//! Number types of binary files.

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

/// Type of the numbers of an array, as in the file. 64-bit integers beyond 2^53 lose their last bits as `f64`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum ScalarType {
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Float32,
    Float64,
}

/// Runs `$body` with `$t` standing for the Rust type of `$scalar`.
macro_rules! with_type {
    ($scalar:expr, $t:ident => $body:expr) => {
        match $scalar {
            ScalarType::Int8 => {
                type $t = i8;
                $body
            }
            ScalarType::UInt8 => {
                type $t = u8;
                $body
            }
            ScalarType::Int16 => {
                type $t = i16;
                $body
            }
            ScalarType::UInt16 => {
                type $t = u16;
                $body
            }
            ScalarType::Int32 => {
                type $t = i32;
                $body
            }
            ScalarType::UInt32 => {
                type $t = u32;
                $body
            }
            ScalarType::Int64 => {
                type $t = i64;
                $body
            }
            ScalarType::UInt64 => {
                type $t = u64;
                $body
            }
            ScalarType::Float32 => {
                type $t = f32;
                $body
            }
            ScalarType::Float64 => {
                type $t = f64;
                $body
            }
        }
    };
}
pub(crate) use with_type;

impl ScalarType {
    const ALL: [Self; 10] = [
        Self::Int8,
        Self::UInt8,
        Self::Int16,
        Self::UInt16,
        Self::Int32,
        Self::UInt32,
        Self::Int64,
        Self::UInt64,
        Self::Float32,
        Self::Float64,
    ];

    /// The name VTK's XML files use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Int8 => "Int8",
            Self::UInt8 => "UInt8",
            Self::Int16 => "Int16",
            Self::UInt16 => "UInt16",
            Self::Int32 => "Int32",
            Self::UInt32 => "UInt32",
            Self::Int64 => "Int64",
            Self::UInt64 => "UInt64",
            Self::Float32 => "Float32",
            Self::Float64 => "Float64",
        }
    }

    /// The type of a name, the inverse of [`Self::name`].
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|s| s.name() == name)
    }

    /// Bytes of one number.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Int8 | Self::UInt8 => 1,
            Self::Int16 | Self::UInt16 => 2,
            Self::Int32 | Self::UInt32 | Self::Float32 => 4,
            Self::Int64 | Self::UInt64 | Self::Float64 => 8,
        }
    }

    /// A word of text as a number of this type; `None` unless it is one and in range. Floating-point numbers may be
    /// `nan` and `inf`.
    #[must_use]
    #[allow(clippy::unnecessary_cast, reason = "T is f64 in one of ten arms")]
    pub fn parse(self, word: &str) -> Option<f64> {
        // A Float32 in text is rounded to the f32 it was printed from.
        with_type!(self, T => word.parse::<T>().ok().map(|v| v as f64))
    }

    /// Numbers from their bytes; a rest shorter than one number is left out.
    #[must_use]
    #[allow(clippy::unnecessary_cast, reason = "T is f64 in one of ten arms")]
    pub fn decode(self, order: ByteOrder, bytes: &[u8]) -> Vec<f64> {
        with_type!(self, T => {
            const N: usize = size_of::<T>();
            let numbers = bytes.as_chunks::<N>().0.iter();
            match order {
                ByteOrder::Little => numbers.map(|&b| T::from_le_bytes(b) as f64).collect(),
                ByteOrder::Big => numbers.map(|&b| T::from_be_bytes(b) as f64).collect(),
            }
        })
    }

    /// Numbers to little-endian bytes; values outside the type's range saturate.
    #[must_use]
    pub fn encode(self, values: &[f64]) -> Vec<u8> {
        with_type!(self, T => values.iter().flat_map(|&v| (v as T).to_le_bytes()).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_survives_its_bytes() {
        for scalar in ScalarType::ALL {
            let values = [0.0, 1.0, 100.0];
            let bytes = scalar.encode(&values);
            assert_eq!(bytes.len(), 3 * scalar.bytes());
            assert_eq!(scalar.decode(ByteOrder::Little, &bytes), values);
            let big: Vec<u8> = bytes.chunks(scalar.bytes()).flat_map(|c| c.iter().rev().copied()).collect();
            assert_eq!(scalar.decode(ByteOrder::Big, &big), values);
            assert_eq!(ScalarType::from_name(scalar.name()), Some(scalar));
        }
    }

    #[test]
    fn words_out_of_range_are_no_numbers() {
        assert_eq!(ScalarType::Int8.parse("128"), None);
        assert_eq!(ScalarType::UInt8.parse("-1"), None);
        assert_eq!(ScalarType::Int64.parse("1.5"), None);
        assert_eq!(ScalarType::Float32.parse("0.1"), Some(f64::from(0.1_f32)));
    }
}
