//! Pictures in the formats of the program.

use crate::error::Fault;
use tigereye_render::{Scene, Style};

/// The bytes of a picture; `format` is `png`, `svg` or `pdf`.
pub(crate) fn encoded(scene: &Scene, format: &str) -> Result<Vec<u8>, Fault> {
    let bytes = match format {
        "svg" => scene.to_svg().map(String::into_bytes),
        "pdf" => scene.to_pdf(),
        "png" => scene.to_png_at(Style::DPI),
        other => return Err(Fault::Value(format!("`{other}`: expected png, svg or pdf"))),
    };
    bytes.map_err(|e| Fault::Value(e.to_string()))
}
