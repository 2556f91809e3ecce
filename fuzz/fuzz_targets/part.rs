//! Checkpoints and shards.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::part;

fuzz_target!(|bytes: &[u8]| {
    let _ = part::read(bytes);
});
