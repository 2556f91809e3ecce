//! `tigereye ftle`: the finite-time Lyapunov exponent on tensor lines.

use crate::args::classical::FtleArgs;
use crate::commands::overlaid::Overlaid;
use crate::commands::{drawing, print_json, print_text};
use crate::error::CliError;
use serde_json::json;
use tigereye_input::provenance::with_rows;
use tigereye_io::{Rows, vti};
use tigereye_lines::FtleOptions;
use tigereye_render::{Colours, HeatOptions};
use tigereye_views::added::{Additions, Scalars};
use tigereye_views::{ftle, image};

pub(crate) fn run(args: &FtleArgs) -> Result<u8, CliError> {
    drawing::check_outputs(&args.outputs, &["vti", "png", "svg", "pdf"])?;
    let input = drawing::open_input(&args.of.input, &args.of.reading, &args.outputs)?;
    let style = drawing::style(&args.style, Colours::Values)?;
    let style = drawing::placed(style, &drawing::placement(&input), input.unit);
    let overlaid = Overlaid::read(&args.overlay)?;
    overlaid.check(&drawing::placement(&input), true, true, false)?;
    let following = args.of.following(&input)?;
    let axes = following.axes;
    let family = args.family;
    let (length, step, tolerance, samples) = (args.length, args.step, args.tolerance, args.samples);
    let options = FtleOptions { length, step, tolerance, samples, ..FtleOptions::default() };
    let found = ftle::exponents(&input.field, following, family, &options)
        .map_err(|e| CliError::input(&args.of.input, e))?;
    let parameters = json!({
        "axes": axes.axes().name(),
        "major": axes.major().name(),
        "family": family.name(),
        "length": length,
        "step": step,
        "tolerance": tolerance,
        "samples": samples,
    });
    let parameters = with_rows(parameters, Rows::Upwards);
    let story = drawing::story(&input, parameters, &args.of.reading);
    drawing::write(
        &args.outputs,
        &style,
        &|| {
            let (title, style) = (args.of.input.clone(), style.clone());
            let scalars = Scalars { values: &found.larger, samples };
            let placement = drawing::placement(&input);
            let Additions { overlays, glyphs } =
                overlaid.additions(Some(&input.field), &placement, Some(scalars))?;
            let options = HeatOptions { title, style, overlays, glyphs, ..HeatOptions::default() };
            Ok(ftle::picture(&found, &input.field, axes, options))
        },
        &|| {
            let arrays = [("FTLE", &found.larger), ("FTLE_smaller", &found.smaller)];
            vti::write(&image(&arrays, [samples; 2], &drawing::placement(&input), &story))
        },
    )?;
    let finite = || found.larger.values().iter().copied().filter(|v| v.is_finite());
    let count = finite().count();
    let largest = finite().fold(f64::NEG_INFINITY, f64::max);
    let mean = finite().sum::<f64>() / count.max(1) as f64;
    let (width, height) = (found.larger.grid().width(), found.larger.grid().height());
    if args.of.json {
        print_json(&json!({
            "width": width,
            "height": height,
            "samples": samples,
            "axes": axes.axes().name(),
            "major": axes.major().name(),
            "lines": 2 * count,
            "left": found.left,
            "max": if count > 0 { json!(largest) } else { json!(null) },
            "mean": if count > 0 { json!(mean) } else { json!(null) },
        }))?;
    } else if count == 0 {
        let grid = input.field.grid();
        print_text(match grid.width().min(grid.height()) {
            1 => {
                "in a field of one row or column no neighbouring lines can separate: there are no exponents\n"
            }
            _ if found.left > 0.0 => {
                "all lines leave the field before their length: expected a smaller --length\n"
            }
            _ => "no tensor has an axis: there are no lines\n",
        })?;
    } else {
        let left = 100.0 * found.left;
        print_text(&format!(
            "{width} x {height} samples, at most {largest:.6} per {}, {mean:.6} on average; \
             {left:.1} % of the lines leave the field early; {}\n",
            drawing::one_unit(&following),
            axes.words()
        ))?;
    }
    Ok(0)
}
