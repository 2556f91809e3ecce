//! Tables of vectors and of named columns at positions.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::{ArrayChoice, Wanted, table};

mod common;

fuzz_target!(|bytes: &[u8]| {
    let _ = table::kind(bytes);
    if let Ok(lattice) = table::read_vectors(bytes) {
        assert_eq!(lattice.values.len(), 2 * lattice.voxels());
        common::use_everything(lattice);
    }
    if let Ok(lattice) = table::read_columns(bytes, ArrayChoice::Usual, Wanted::Tensors) {
        assert_eq!(lattice.values.len(), lattice.components * lattice.voxels());
        common::use_everything(lattice);
    }
});
