//! `tigereye lines`: tensor lines and hyperstreamlines.

use crate::args::classical::{LinesArgs, MethodName};
use crate::commands::{counted, drawing, print_json, print_text};
use crate::error::CliError;
use crate::input::Input;
use serde_json::json;
use tigereye_core::{Point, Tensor2};
use tigereye_io::vtp;
use tigereye_lines::{Inertia, LineOptions, Method};
use tigereye_render::{Colours, PlainOptions};
use tigereye_views::lines::{LinesRequest, Seeds, lines, parameters};

/// Distance of lines in parts of the longer side.
const LINES_A_SIDE: f64 = 40.0;
/// Largest error of an adaptive step, cells.
const TOLERANCE: f64 = 1e-6;
/// Longest line in longer sides.
const SIDES: f64 = 4.0;

pub(crate) fn run(args: &LinesArgs) -> Result<u8, CliError> {
    drawing::check_outputs(&args.outputs, &["vtp", "png", "svg", "pdf"])?;
    let input = drawing::open_input(&args.of.input, &args.of.reading, &args.outputs)?;
    if args.tolerance.is_some() && args.method == MethodName::Rk4 {
        return Err(CliError::input(
            "--tolerance",
            "is that of adaptive steps: expected --method rk43 or rk45",
        ));
    }
    let style = drawing::placed(
        drawing::style(&args.style, Colours::Kinds)?,
        &drawing::placement(&input),
        input.unit,
    );
    let request = request(args, &input)?;
    drawing::check_steps(request.options.length, request.options.step)?;
    check_seeds(args, &input)?;
    let found = lines(&input.field, &request).map_err(|e| CliError::input(&args.of.input, e))?;
    let story = drawing::story(&input, parameters(&request), &args.of.reading);
    drawing::write(
        &args.outputs,
        &style,
        &|| {
            let (title, style) = (args.of.input.clone(), style.clone());
            Ok(found.picture(&input.field, PlainOptions { title, style, ..PlainOptions::default() }))
        },
        &|| vtp::write(&found.poly_data(&drawing::placement(&input), &story)),
    )?;
    let (axes, length) = (request.following.axes, found.length());
    if args.of.json {
        print_json(&json!({
            "width": input.field.grid().width(),
            "height": input.field.grid().height(),
            "axes": axes.axes().name(),
            "major": axes.major().name(),
            "lines": found.lines.len(),
            "points": found.lines.iter().map(|l| l.line.points.len()).sum::<usize>(),
            "length": length,
        }))?;
    } else if found.lines.is_empty() {
        let plain = input.field.without_rounding();
        let has_axes = |t: &Tensor2| axes.of(t, request.options.least_anisotropy).is_some();
        print_text(&match plain.values().iter().any(has_axes) {
            true => {
                "no line is long enough: lines leave the field at once, or end where the axes are undefined\n"
                    .to_owned()
            }
            false => format!("no tensor has {}\n", axes.words()),
        })?;
    } else {
        let count = counted(found.lines.len(), "line");
        let unit = drawing::unit(&request.following);
        print_text(&format!("{count} along {}; total length {length:.1} {unit}\n", axes.words()))?;
    }
    Ok(0)
}

/// Refuses seeds outside of the field.
fn check_seeds(args: &LinesArgs, input: &Input) -> Result<(), CliError> {
    let [right, bottom] = [input.field.grid().width() - 1, input.field.grid().height() - 1];
    let is_inside = |p: &Point| (0.0..=right as f64).contains(&p.x) && (0.0..=bottom as f64).contains(&p.y);
    match args.seeds.iter().find(|p| !is_inside(p)) {
        None => Ok(()),
        Some(Point { x, y, .. }) => {
            let problem =
                format!("is not in the field: expected X from 0 to {right} and Y from 0 to {bottom}");
            Err(CliError::input(&format!("--seed {x},{y}"), problem))
        }
    }
}

fn request(args: &LinesArgs, input: &Input) -> Result<LinesRequest, CliError> {
    let following = args.of.following(input)?;
    let side = following.longer_side(input.field.grid());
    let seeds = if args.seeds.is_empty() {
        Seeds::Even(args.separation.unwrap_or((side / LINES_A_SIDE).max(0.5)))
    } else {
        Seeds::At(args.seeds.clone())
    };
    let method = match args.method {
        MethodName::Rk4 => Method::RungeKutta4,
        MethodName::Rk43 => Method::RungeKutta43 { tolerance: args.tolerance.unwrap_or(TOLERANCE) },
        MethodName::Rk45 => Method::DormandPrince { tolerance: args.tolerance.unwrap_or(TOLERANCE) },
    };
    Ok(LinesRequest {
        following,
        families: args.family.to_vec(),
        seeds,
        options: LineOptions {
            method,
            step: args.step,
            length: args.length.unwrap_or(SIDES * side),
            least_anisotropy: args.least_anisotropy,
            inertia: args.inertia.map(|puncture| Inertia { puncture }),
        },
        ribbon: args.ribbon,
    })
}
