//! Parts come back as they were written, and no byte of them can be lost or changed unnoticed.

use proptest::prelude::*;
use tigereye_io::part;
use tigereye_io::part::PartError;

fn small() -> Vec<u8> {
    part::write(
        "{\"a\": \"\u{e9}\"}",
        &[0.5, -0.0, f64::MAX],
        &[true, false, true, true, false, false, true, true, true],
    )
}

/// A file whose checksum is right, whatever else it holds.
fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len() - 32);
    let checksum = blake3::hash(&bytes);
    bytes.extend_from_slice(checksum.as_bytes());
    bytes
}

#[test]
fn parts_have_the_documented_layout() {
    let bytes = small();
    assert_eq!(&bytes[..16], b"tigerprt\x01\0\0\0\0\0\0\0");
    assert_eq!([bytes[16], bytes[24], bytes[32]], [11, 3, 9]);
    assert_eq!(bytes[51..59], 0.5_f64.to_le_bytes());
    assert_eq!(bytes[75..77], [0b1100_1101, 1]);
    assert_eq!(bytes.len(), 77 + 32);
}

#[test]
fn every_truncation_is_refused_at_its_end() {
    let bytes = small();
    for end in 0..bytes.len() {
        let message = part::read(&bytes[..end]).unwrap_err().to_string();
        let at = if end < 8 { 0 } else { end };
        assert!(
            message.starts_with(&format!("byte {at}: ")) && message.contains("expected"),
            "{end}: {message}"
        );
    }
    let message = part::read(&[&bytes[..], b"x"].concat()).unwrap_err().to_string();
    let (present, declared) = (bytes.len() + 1, bytes.len());
    assert_eq!(message, format!("byte {declared}: the file has {present} bytes, expected {declared}"));
}

#[test]
fn every_changed_bit_is_refused() {
    let bytes = small();
    for i in 0..8 * bytes.len() {
        let mut changed = bytes.clone();
        changed[i / 8] ^= 1 << (i % 8);
        let message = part::read(&changed).unwrap_err().to_string();
        assert!(message.starts_with("byte ") && message.contains("expected"), "bit {i}: {message}");
    }
}

#[test]
fn lies_with_a_right_checksum_are_refused_where_they_stand() {
    let with = |at: usize, byte: u8| {
        let mut bytes = small();
        bytes[at] = byte;
        part::read(&signed(bytes))
    };
    assert_eq!(with(8, 2), Err(PartError::Version { byte: 8, found: 2, expected: 1 }));
    assert_eq!(with(12, 1), Err(PartError::Field { byte: 12, expected: "four zero bytes" }));
    assert!(matches!(with(50, 0xff), Err(PartError::Field { byte: 50, .. })));
    assert!(matches!(with(76, 3), Err(PartError::Field { byte: 76, .. })));
    assert!(with(60, 7).is_ok());
    // Sizes up to 2^64 that the file cannot hold.
    for at in 16..40 {
        for byte in [0, 0x7f, 0xff] {
            if small()[at] != byte {
                assert!(matches!(with(at, byte), Err(PartError::Length { .. })), "byte {at} = {byte}");
            }
        }
    }
}

proptest! {
    #[test]
    fn any_part_comes_back(header in ".*", bits in proptest::collection::vec(any::<u64>(), 0..40),
                           marks in proptest::collection::vec(any::<bool>(), 0..40)) {
        let values: Vec<f64> = bits.iter().map(|&b| f64::from_bits(b)).collect();
        let bytes = part::write(&header, &values, &marks);
        let read = part::read(&bytes).unwrap();
        prop_assert_eq!(&read.header, &header);
        prop_assert_eq!(&read.marks, &marks);
        prop_assert_eq!(read.values.iter().map(|v| v.to_bits()).collect::<Vec<_>>(), bits);
    }

    #[test]
    fn any_bytes_are_refused_without_panic(mut bytes in proptest::collection::vec(any::<u8>(), 0..200), sign in any::<bool>()) {
        bytes.splice(..bytes.len().min(16), b"tigerprt\x01\0\0\0\0\0\0\0".iter().copied());
        if sign && bytes.len() >= 32 {
            bytes = signed(bytes);
        }
        let _ = part::read(&bytes);
    }
}
