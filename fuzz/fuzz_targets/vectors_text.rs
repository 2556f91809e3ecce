//! Tables of vectors at positions.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::vectors_text;

mod common;

fuzz_target!(|bytes: &[u8]| {
    let _ = vectors_text::is_table(bytes);
    if let Ok(lattice) = vectors_text::read(bytes) {
        assert_eq!(lattice.values.len(), 2 * lattice.voxels());
        common::use_everything(lattice);
    }
});
