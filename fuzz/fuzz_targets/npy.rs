//! NumPy arrays as tensors, vectors and numbers.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::{Wanted, npy};

fuzz_target!(|bytes: &[u8]| {
    let _ = npy::read_array(bytes);
    let _ = npy::read_tensors(bytes);
    for wanted in [Wanted::Tensors, Wanted::Vectors, Wanted::Scalars] {
        let _ = npy::read_lattice(bytes, wanted);
    }
});
