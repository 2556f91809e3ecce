//! VTK poly data.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::volume::lattice_from_points;
use tigereye_io::{Wanted, vtp};

mod common;

fuzz_target!(|bytes: &[u8]| {
    let Ok(data) = vtp::read_with_limits(bytes, common::LIMITS) else { return };
    let _ = vtp::write(&data);
    if let Ok(lattice) = lattice_from_points(data, None, Wanted::Tensors) {
        common::use_everything(lattice);
    }
});
