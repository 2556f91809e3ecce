//! `tigereye lic`: line integral convolution.

use crate::args::classical::LicArgs;
use crate::commands::{drawing, print_json, print_text};
use crate::error::CliError;
use serde_json::json;
use tigereye_input::provenance::with_rows;
use tigereye_io::{Rows, vti};
use tigereye_lines::ConvolutionOptions;
use tigereye_views::image;
use tigereye_views::lic::{self, TextureRequest};

pub(crate) fn run(args: &LicArgs) -> Result<u8, CliError> {
    drawing::check_outputs(&args.outputs, &["png", "svg", "vti"])?;
    let input = drawing::open_input(&args.of.input, &args.of.reading, &args.outputs)?;
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
    let picture = || lic::picture(&found, &input.field, &request, args.tint, &args.of.input, None);
    drawing::write(&args.outputs, &picture, &|| {
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
