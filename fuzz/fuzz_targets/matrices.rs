//! Text matrices: what is read is written and read again.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_io::matrices;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(field) = matrices::read(bytes)
        && let Ok(text) = matrices::write(&field)
    {
        assert_eq!(matrices::read(&text).as_ref(), Ok(&field));
    }
});
