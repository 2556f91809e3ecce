//! Legacy VTK files.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::volume::lattice_from_image;
use tigereye_io::{Wanted, legacy};

mod common;

fuzz_target!(|bytes: &[u8]| {
    let Ok(image) = legacy::read_with_limits(bytes, common::LIMITS) else { return };
    if let Ok(lattice) = lattice_from_image(&image, None, Wanted::Tensors) {
        common::use_everything(lattice);
    }
});
