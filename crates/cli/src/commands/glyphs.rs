//! `tigereye glyphs`: a glyph for every tensor.

use crate::args::classical::GlyphsArgs;
use crate::commands::{drawing, print_text};
use crate::error::CliError;
use crate::files;
use serde_json::json;
use tigereye_core::{CellShape, Choice, Symmetry};
use tigereye_io::vtp;
use tigereye_render::{Colours, GlyphColour, GlyphKind, GlyphOptions, glyphs};
use tigereye_views::glyphs::{check, poly_data};

pub(crate) fn run(args: &GlyphsArgs) -> Result<u8, CliError> {
    drawing::check_outputs(&args.outputs, &["vtp", "png", "svg", "pdf"])?;
    let input = drawing::open_input(&args.input, &args.reading, &args.outputs)?;
    let kind = match (args.kind, args.gamma) {
        (GlyphKind::Superquadric { .. }, Some(gamma)) => GlyphKind::Superquadric { gamma },
        (kind, _) => kind,
    };
    // Signs of eigenvalues say something of symmetric tensors only, and of the glyphs made for them.
    let signs = Symmetry::of(&input.field).is_symmetric()
        || matches!(args.kind, GlyphKind::Signed | GlyphKind::Arrows | GlyphKind::Asymmetric);
    let usual = if signs { GlyphColour::AxisSign } else { GlyphColour::Anisotropy };
    let colour = args.colour.unwrap_or(usual);
    let title = args.input.clone();
    if args.gamma.is_some() && !matches!(args.kind, GlyphKind::Superquadric { .. }) {
        return Err(CliError::input(
            "--gamma",
            "is the sharpness of superquadrics: expected --kind superquadric",
        ));
    }
    let colours = if colour == GlyphColour::Anisotropy { Colours::Quantity } else { Colours::Kinds };
    let style =
        drawing::placed(drawing::style(&args.style, colours)?, &drawing::placement(&input), input.unit);
    let cell = CellShape::of(input.geometry.spacing());
    let options = GlyphOptions {
        title,
        kind,
        scale: args.scale,
        colour,
        every: args.every,
        cell,
        style: style.clone(),
        ..GlyphOptions::default()
    };
    let parameters = json!({ "kind": args.kind.word(), "scale": args.scale.word(), "every": args.every });
    let story = drawing::story(&input, parameters, &args.reading);
    if args.outputs.iter().any(|o| files::extension(o) == "vtp") {
        check(input.field.grid(), args.every).map_err(|e| CliError::input(&args.input, e))?;
    }
    drawing::write(&args.outputs, &style, &|| Ok(glyphs(&input.field, &options)), &|| {
        vtp::write(&poly_data(&input.field, &options, &drawing::placement(&input), &story))
    })?;
    let grid = input.field.grid();
    print_text(&format!("{} x {} tensors as glyphs\n", grid.width(), grid.height()))?;
    Ok(0)
}
