//! Formulas, and fields by their specification.
#![no_main]
use libfuzzer_sys::fuzz_target;
use tigereye_fields::{Expression, parse_spec};

fuzz_target!(|text: &str| {
    if let Ok(expression) = Expression::parse(text, &["x", "y", "theta"]) {
        let _ = expression.eval(&[0.5, -2.0, 1e300]);
    }
    let _ = parse_spec(text);
});
