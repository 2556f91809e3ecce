//! PNG pictures.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::picture;

fuzz_target!(|bytes: &[u8]| {
    let _ = picture::read_png(bytes);
});
