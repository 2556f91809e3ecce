//! `tigereye field list`: the generators.

use crate::args::FieldListArgs;
use crate::commands::{print_json, print_text};
use crate::error::CliError;
use serde_json::{Value, json};
use std::fmt::Write as _;
use tigereye_fields::{Generator, Parameter, ParameterKind, generators};

pub(crate) fn list(args: &FieldListArgs) -> Result<u8, CliError> {
    if args.json {
        print_json(&Value::Array(generators().iter().map(|g| generator_json(g)).collect()))?;
    } else {
        print_text(&generators_text())?;
    }
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
