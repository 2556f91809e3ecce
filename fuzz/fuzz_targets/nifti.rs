//! NIfTI-1.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::nifti;

mod common;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(lattice) = nifti::read_with_limits(bytes, common::LIMITS) {
        common::use_everything(lattice);
    }
});
