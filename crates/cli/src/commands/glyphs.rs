//! `tigereye glyphs`: a glyph for every tensor.

use crate::args::classical::{ColourName, GlyphsArgs, KindName, ScaleName};
use crate::commands::drawing;
use crate::error::CliError;
use crate::files;
use clap::ValueEnum;
use serde_json::json;
use tigereye_core::{CellShape, Symmetry};
use tigereye_io::vtp;
use tigereye_render::{GlyphColour, GlyphKind, GlyphOptions, GlyphScale, glyphs};
use tigereye_views::glyphs::{check, poly_data};

pub(crate) fn run(args: &GlyphsArgs) -> Result<u8, CliError> {
    drawing::check_outputs(&args.outputs, &["vtp", "png", "svg"])?;
    let input = drawing::open_input(&args.input, &args.reading, &args.outputs)?;
    let kind = match args.kind {
        KindName::Ellipse => GlyphKind::Ellipse,
        KindName::Box => GlyphKind::Box,
        KindName::Superquadric => GlyphKind::Superquadric { gamma: args.gamma.unwrap_or(GlyphKind::GAMMA) },
        KindName::Signed => GlyphKind::Signed,
        KindName::Arrows => GlyphKind::Arrows,
        KindName::Asymmetric => GlyphKind::Asymmetric,
    };
    let scale = match args.scale {
        ScaleName::Field => GlyphScale::Field,
        ScaleName::Root => GlyphScale::SquareRoot,
        ScaleName::Glyph => GlyphScale::Glyph,
    };
    // Signs of eigenvalues say something of symmetric tensors only, and of the glyphs made for them.
    let signs = Symmetry::of(&input.field).is_symmetric()
        || matches!(args.kind, KindName::Signed | KindName::Arrows | KindName::Asymmetric);
    let colour = match args.colour {
        Some(ColourName::Sign) => GlyphColour::AxisSign,
        Some(ColourName::Anisotropy) => GlyphColour::Anisotropy,
        None if signs => GlyphColour::AxisSign,
        None => GlyphColour::Anisotropy,
    };
    let title = args.input.clone();
    if args.gamma.is_some() && args.kind != KindName::Superquadric {
        return Err(CliError::input(
            "--gamma",
            "is the sharpness of superquadrics: expected --kind superquadric",
        ));
    }
    let cell = CellShape::of(input.geometry.spacing());
    let options =
        GlyphOptions { title, kind, scale, colour, every: args.every, cell, ..GlyphOptions::default() };
    let parameters = json!({ "kind": name_of(args.kind), "scale": name_of(args.scale), "every": args.every });
    let story = drawing::story(&input, parameters, &args.reading);
    if args.outputs.iter().any(|o| files::extension(o) == "vtp") {
        check(input.field.grid(), args.every).map_err(|e| CliError::input(&args.input, e))?;
    }
    drawing::write(&args.outputs, &|| Ok(glyphs(&input.field, &options)), &|| {
        vtp::write(&poly_data(&input.field, &options, &drawing::placement(&input), &story))
    })?;
    Ok(0)
}

/// A choice as it is spelt on the command line.
fn name_of(choice: impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
}
