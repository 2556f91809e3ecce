//! Experiment files, read and planned; there are no files beside them.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_experiments::{load, plan};

fn nothing(path: &str) -> Result<Vec<u8>, String> {
    Err(format!("no file {path}"))
}

fuzz_target!(|text: &str| {
    if let Ok(experiment) = load("fuzz.ron", text) {
        let _ = plan("fuzz.ron", text, &experiment, false, &nothing);
    }
});
