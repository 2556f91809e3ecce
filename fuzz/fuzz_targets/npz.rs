//! Archives of NumPy arrays.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::{ArrayChoice, Wanted, npy};

fuzz_target!(|bytes: &[u8]| {
    for choice in [ArrayChoice::Usual, ArrayChoice::Named("a")] {
        let _ = npy::read_archive(bytes, choice, Wanted::Tensors);
    }
});
