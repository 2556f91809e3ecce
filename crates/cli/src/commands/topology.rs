//! `tigereye topology`: degenerate points and separatrices.

use crate::args::classical::TopologyArgs;
use crate::commands::{counted, drawing, print_json, print_text};
use crate::error::CliError;
use serde_json::json;
use tigereye_io::vtp;
use tigereye_lines::LineOptions;
use tigereye_render::{Colours, PlainOptions};
use tigereye_views::topology;

pub(crate) fn run(args: &TopologyArgs) -> Result<u8, CliError> {
    drawing::check_outputs(&args.outputs, &["vtp", "png", "svg", "pdf"])?;
    let input = drawing::open_input(&args.of.input, &args.of.reading, &args.outputs)?;
    let following = args.of.following(&input)?;
    let style = drawing::placed(
        drawing::style(&args.style, Colours::Kinds)?,
        &drawing::placement(&input),
        input.unit,
    );
    let axes = following.axes;
    let length = args.length.unwrap_or(4.0 * following.longer_side(input.field.grid()));
    let options = LineOptions { step: args.step, length, ..LineOptions::default() };
    drawing::check_steps(length, args.step)?;
    let families = args.family;
    let found = topology::topology(&input.field, following, families, &options);
    let names: Vec<&str> = families.iter().map(|f| f.name()).collect();
    let parameters = json!({
        "axes": axes.axes().name(),
        "major": axes.major().name(),
        "family": names,
        "step": args.step,
        "length": length,
    });
    let story = drawing::story(&input, parameters, &args.of.reading);
    drawing::write(
        &args.outputs,
        &style,
        &|| {
            let (title, style) = (args.of.input.clone(), style.clone());
            let options = PlainOptions { title, style, ..PlainOptions::default() };
            Ok(topology::picture(&found, &input.field, following, families, options))
        },
        &|| vtp::write(&topology::poly_data(&found, &drawing::placement(&input), &story)),
    )?;
    let summary = topology::summary(&found, following);
    if args.of.json {
        print_json(&summary)?;
    } else {
        print_text(&format!(
            "{} of index sum {}, {}; {}\n",
            counted(found.points.len(), "degenerate point"),
            summary["index_sum"],
            match found.separatrices.len() {
                1 => "1 separatrix".to_owned(),
                n => format!("{n} separatrices"),
            },
            axes.words()
        ))?;
    }
    Ok(0)
}
