//! `tigereye field`: the generators, and work on a field of one's own.

use crate::args::fields::{FieldLintArgs, FieldListArgs, FieldNewArgs, FieldShowArgs};
use crate::commands::drawing;
use crate::commands::propagate::check_outputs;
use crate::commands::{counted, print_json, print_text, quoted};
use crate::error::CliError;
use crate::input::Input;
use crate::{files, interrupt, system};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;
use tigereye_core::{Cell, CellShape};
use tigereye_experiments::field_file;
use tigereye_experiments::sheet::{SheetOptions, sheet};
use tigereye_fields::{Generator, Parameter, ParameterKind, generators};
use tigereye_input::lint::{self, Oddity};
use tigereye_ltg::SweepObserver;
use tigereye_render::Colours;

pub(crate) fn list(args: &FieldListArgs) -> Result<u8, CliError> {
    if args.json {
        print_json(&Value::Array(generators().iter().map(|g| generator_json(g)).collect()))?;
    } else {
        print_text(&generators_text())?;
    }
    Ok(0)
}

pub(crate) fn new(args: &FieldNewArgs) -> Result<u8, CliError> {
    let name = &args.name;
    if !field_file::is_name(name) {
        let problem = "is not a valid name: expected up to 60 lower-case letters, digits, - and _, not beginning with -";
        return Err(CliError::input(name, problem));
    }
    let generator = tigereye_fields::find(name);
    if generator.is_some() && !args.experiment {
        let problem =
            "is a generator: expected another name, or --experiment for an experiment that shows it";
        return Err(CliError::input(name, problem));
    }
    let field = args.folder.join(format!("{name}{}", field_file::EXTENSION));
    let experiment = args.folder.join(format!("{name}.ron"));
    let texts = match generator {
        Some(generator) => vec![(&experiment, field_file::generator_template(generator))],
        None if args.experiment => {
            vec![(&field, field_file::template(name)), (&experiment, field_file::experiment_template(name))]
        }
        None => vec![(&field, field_file::template(name))],
    };
    for (path, _) in &texts {
        files::check_writable(path)?;
        if path.exists() {
            let problem = "exists already: expected another name or --folder";
            return Err(CliError::input(&path.display().to_string(), problem));
        }
    }
    texts.iter().try_for_each(|(path, text)| files::write(path, text.as_bytes()))?;
    let quoted_path = |path: &Path| quoted(&path.to_string_lossy());
    let mut words = match generator {
        Some(_) => format!("{} shows the generator {name}. Next:\n", quoted_path(&experiment)),
        None => format!(
            "{field} holds the field. Next:\n  tigereye field show {field} -o {name}.png\n  tigereye field lint {field}\n",
            field = quoted_path(&field)
        ),
    };
    if args.experiment {
        // Writing to a string cannot fail.
        let _ = writeln!(words, "  tigereye run {} --out {name}-results", quoted_path(&experiment));
    }
    print_text(&words)?;
    Ok(0)
}

pub(crate) fn show(args: &FieldShowArgs) -> Result<u8, CliError> {
    check_outputs(std::slice::from_ref(&args.output), &drawing::PICTURES)?;
    let style = drawing::style(&args.style, Colours::Kinds)?;
    drawing::check_whole_page(&args.style)?;
    let input = Input::open_for_squares(&args.input, &args.reading)?;
    input.check_apart(std::slice::from_ref(&args.output))?;
    let options = SheetOptions {
        title: style.title.clone().or(input.title.clone()).unwrap_or_else(|| input.name.clone()),
        rule: args.profiles.rule(),
        scattering: args.scattering,
        light: args.light.map(|[x, y]| Cell::new(x, y)),
        slice_deg: args.slice_deg,
        cell: CellShape::of(input.geometry.spacing()),
        level: system::level()?,
    };
    let picture = sheet(&input.field, &options, &Interruption);
    interrupt::check()?;
    let picture = picture.map_err(|e| CliError::input(&input.name, e))?;
    let picture = style.fitted(picture);
    files::write(&args.output, &drawing::encoded(&picture, &args.output, &style)?)?;
    let (grid, name) = (input.field.grid(), args.output.display());
    print_text(&format!("sheet of {} x {} tensors written to {name}\n", grid.width(), grid.height()))?;
    Ok(0)
}

/// Ends a sweep when the user asks.
struct Interruption;

impl SweepObserver for Interruption {
    fn progress(&self, _done: u64, _total: u64) -> ControlFlow<()> {
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

pub(crate) fn lint(args: &FieldLintArgs) -> Result<u8, CliError> {
    let input = Input::open(&args.input, &args.reading)?;
    let found = lint::lint(&input.field);
    if args.json {
        let oddity = |o: &Oddity| {
            let first = o.first.map(|c| [c.x, c.y]);
            json!({
                "kind": o.kind,
                "likely_mistake": o.is_likely_mistake,
                "count": o.count,
                "first": first,
                "words": o.words,
            })
        };
        let grid = input.field.grid();
        print_json(&json!({
            "input": input.name,
            "width": grid.width(),
            "height": grid.height(),
            "oddities": found.iter().map(oddity).collect::<Vec<_>>(),
        }))?;
        return Ok(0);
    }
    let (likely, notes): (Vec<_>, Vec<_>) = found.iter().partition(|o| o.is_likely_mistake);
    let mut text = match likely.len() {
        0 => format!("{}: no findings", input.name),
        n => format!("{}: {}", input.name, counted(n, "finding")),
    };
    text += &match notes.len() {
        0 => "\n".to_owned(),
        n if args.all => format!(" and {}\n", counted(n, "note")),
        n => format!(" ({} with --all)\n", counted(n, "note")),
    };
    let notes = notes.into_iter().filter(|_| args.all);
    for o in likely.into_iter().chain(notes) {
        let place = o.first.map_or_else(String::new, |c| format!(" (first: cell ({}, {}))", c.x, c.y));
        let _ = writeln!(text, "  {:<16}  {}{place}", o.kind, o.words);
    }
    print_text(&text)?;
    Ok(0)
}

fn generators_text() -> String {
    let mut text = String::new();
    for g in generators() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}\n    {} [{}]", g.name, g.summary, g.source);
        for p in g.own_parameters {
            let _ = writeln!(text, "    {}={}  {} ({})", p.name, p.default_text(), p.help, p.kind);
        }
    }
    text.push_str("\nEvery field also has size=51 (cells a side), or width and height.\n");
    text.push_str("Use: NAME or NAME:key=value,key=value, for example inverse:size=51,anisotropy=4\n");
    text
}

fn generator_json(g: &Generator) -> Value {
    json!({
        "name": g.name,
        "summary": g.summary,
        "source": g.source,
        "symmetric": g.symmetric,
        "determinant_one": g.determinant_one,
        "parameters": g.parameters().map(parameter_json).collect::<Vec<_>>(),
    })
}

fn parameter_json(p: &Parameter) -> Value {
    let mut value = json!({ "name": p.name, "help": p.help, "expected": p.kind.to_string() });
    value["default"] = match p.kind {
        ParameterKind::Integer { .. } => json!(p.default as i64),
        ParameterKind::Real { .. } => json!(p.default),
        ParameterKind::Flag => json!(p.default != 0.0),
        ParameterKind::Choice(_) => json!(p.default_text()),
    };
    match p.kind {
        ParameterKind::Integer { min, max } => {
            value["type"] = json!("integer");
            value["minimum"] = json!(min);
            value["maximum"] = json!(max);
        }
        ParameterKind::Real { min, max } => {
            value["type"] = json!("real");
            value["minimum"] = json!(min);
            value["maximum"] = json!(max);
        }
        ParameterKind::Flag => value["type"] = json!("flag"),
        ParameterKind::Choice(words) => {
            value["type"] = json!("choice");
            value["choices"] = json!(words);
        }
    }
    value
}
