//! Values of the options that commands of light share.

use crate::args::light::PropagateArgs;
use crate::error::CliError;
use crate::input::insert_reading;
use crate::medium::MediumInput;
use serde_json::{Value, json};
use tigereye_core::{Cell, Choice, Directions, PolarProfile, ProfileRule};
use tigereye_experiments::lights::profile_of_expression;
use tigereye_transport::Stopping;

/// `X,Y[,PROFILE]` of an option; the profile may hold commas itself and is 1 by default.
pub(super) fn cell_and_profile(
    option: &str,
    text: &str,
    directions: Directions,
) -> Result<(Cell, PolarProfile), CliError> {
    let fault = |problem: String| CliError::input(&format!("{option} {text}"), problem);
    let mut parts = text.splitn(3, ',');
    let mut coordinate = |name: &str| {
        let part = parts.next().unwrap_or_default().trim();
        part.parse::<usize>()
            .map_err(|_| fault(format!("`{part}` is not a valid {name}: expected X,Y or X,Y,PROFILE")))
    };
    let cell = Cell::new(coordinate("column")?, coordinate("row")?);
    let profile = match parts.next() {
        None => PolarProfile::constant(directions, 1.0),
        Some(expression) => profile_of_expression(expression, directions).map_err(fault)?,
    };
    Ok((cell, profile))
}

/// The parameters of a propagation, for its provenance.
pub(super) fn parameters(
    args: &PropagateArgs,
    lights: &[String],
    stopping: &Stopping,
    input: &MediumInput,
    rule: ProfileRule,
) -> Value {
    let mut parameters = json!({
        "input": args.input,
        "light": lights,
        "impulse": args.impulse,
        "steps": args.steps,
        "directions": args.scheme.directions.count(),
        "threshold": stopping.rule.threshold(),
        "max_iterations": stopping.max_iterations,
        "stop": args.scheme.stop().word(),
        "scattering": args.scheme.scattering.word(),
        "towards": args.towards,
    });
    input.insert_rule(&mut parameters, rule);
    insert_reading(&mut parameters, &args.scheme.reading);
    parameters
}
