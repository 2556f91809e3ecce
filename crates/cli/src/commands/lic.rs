//! `tigereye lic`: line integral convolution.

use crate::args::classical::LicArgs;
use crate::commands::overlaid::Overlaid;
use crate::commands::{drawing, print_json, print_text};
use crate::error::CliError;
use serde_json::json;
use tigereye_input::provenance::with_rows;
use tigereye_io::{Rows, vti};
use tigereye_lines::ConvolutionOptions;
use tigereye_render::{Colours, TextureOptions};
use tigereye_views::added::Additions;
use tigereye_views::image;
use tigereye_views::lic::{self, TextureRequest};

pub(crate) fn run(args: &LicArgs) -> Result<u8, CliError> {
    drawing::check_outputs(&args.outputs, &["png", "svg", "pdf", "vti"])?;
    let input = drawing::open_input(&args.of.input, &args.of.reading, &args.outputs)?;
    let colours = if args.tint { Colours::Values } else { Colours::Kinds };
    let style =
        drawing::placed(drawing::style(&args.style, colours)?, &drawing::placement(&input), input.unit);
    let overlaid = Overlaid::read(&args.overlay)?;
    overlaid.check(&drawing::placement(&input), true, false, false)?;
    let (samples, half_length, seed) = (args.samples, args.half_length, args.seed);
    let following = args.of.following(&input)?;
    let request = TextureRequest {
        following,
        family: args.family,
        hyper: args.hyper,
        options: ConvolutionOptions { samples, half_length, seed },
    };
    let found = lic::texture(&input.field, &request).map_err(|e| CliError::input(&args.of.input, e))?;
    let story = drawing::story(&input, with_rows(lic::parameters(&request), Rows::Upwards), &args.of.reading);
    let picture = || {
        let (title, style) = (args.of.input.clone(), style.clone());
        let Additions { overlays, glyphs } =
            overlaid.additions(Some(&input.field), &drawing::placement(&input), None)?;
        let options = TextureOptions { title, style, overlays, glyphs, ..TextureOptions::default() };
        let scene = lic::picture(&found, &input.field, &request, args.tint, options);
        scene.map_err(|e| CliError::input(&args.of.input, e))
    };
    drawing::write(&args.outputs, &style, &picture, &|| {
        vti::write(&image(&[("LIC", &found)], request.samples_a_cell(), &drawing::placement(&input), &story))
    })?;
    let (width, height) = (found.grid().width(), found.grid().height());
    if args.of.json {
        let axes = following.axes;
        print_json(&json!({
            "width": width,
            "height": height,
            "samples": samples,
            "axes": axes.axes().name(),
            "major": axes.major().name(),
        }))?;
    } else {
        print_text(&format!("{width} x {height} samples; {}\n", following.axes.words()))?;
    }
    Ok(0)
}
