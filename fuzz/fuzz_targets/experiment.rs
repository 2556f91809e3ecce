//! Experiment files.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_experiments::spec;

fuzz_target!(|text: &str| {
    let _ = spec::load("fuzz.ron", text);
});
