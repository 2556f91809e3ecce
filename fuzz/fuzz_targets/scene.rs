//! Scene files, with one picture beside them.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_experiments::scene;

/// The only file there is: a picture of 25 x 19 pixels.
fn beside(path: &str) -> Result<Vec<u8>, String> {
    match path {
        "maze.png" => Ok(include_bytes!("../../experiments/scenes/maze.png").to_vec()),
        _ => Err(format!("no file {path}")),
    }
}

fuzz_target!(|text: &str| {
    let _ = scene::prepare("fuzz.scene.ron", text, &beside);
});
