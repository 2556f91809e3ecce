//! Archives of NumPy arrays.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::{Wanted, npy};

fuzz_target!(|bytes: &[u8]| {
    for name in [None, Some("a")] {
        if let Ok((_, array)) = npy::array_of_archive(bytes, name) {
            let _ = npy::read_lattice(&array, Wanted::Tensors);
        }
    }
});
