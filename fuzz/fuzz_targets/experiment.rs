//! Experiment files, read and planned.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_experiments::{load, plan};

fuzz_target!(|text: &str| {
    if let Ok(experiment) = load("fuzz.ron", text) {
        let _ = plan("fuzz.ron", text, &experiment, false);
    }
});
