//! NRRD, attached and detached.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::{Wanted, nrrd};

mod common;

fuzz_target!(|bytes: &[u8]| {
    let _ = nrrd::data_file(bytes, tigereye_io::Limits::default());
    for wanted in [Wanted::Tensors, Wanted::Vectors, Wanted::Scalars] {
        if let Ok(lattice) = nrrd::read_with_limits(bytes, Some(bytes), wanted, common::LIMITS) {
            common::use_everything(lattice);
        }
    }
});
