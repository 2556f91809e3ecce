//! VTK image data.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::volume::lattice_from_image;
use tigereye_io::{Wanted, ltg_from_image, vti};

mod common;

fuzz_target!(|bytes: &[u8]| {
    let Ok(image) = vti::read_with_limits(bytes, common::LIMITS) else { return };
    let _ = (ltg_from_image(&image), vti::write(&image));
    for wanted in [Wanted::Tensors, Wanted::Vectors, Wanted::Scalars] {
        if let Ok(lattice) = lattice_from_image(&image, None, wanted) {
            common::use_everything(lattice);
        }
    }
});
