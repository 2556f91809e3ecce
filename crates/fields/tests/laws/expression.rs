//! Formulas: values, errors with their places, and robustness.

use proptest::prelude::*;
use tigereye_fields::expression::{MAX_LENGTH, MAX_NESTING};
use tigereye_fields::{Expression, ExpressionErrorKind};

/// Variables of all tests, with the values x = 3, y = -2.
const VARIABLES: [&str; 2] = ["x", "y"];

fn eval(text: &str) -> f64 {
    Expression::parse(text, &VARIABLES).unwrap_or_else(|e| panic!("{text}: {e}")).eval(&[3.0, -2.0])
}

fn check(cases: &[(&str, f64)]) {
    for (text, expected) in cases {
        let found = eval(text);
        let close = (found - expected).abs() <= 1e-14 * expected.abs();
        assert!(close || found.is_nan() && expected.is_nan(), "{text} = {found}, expected {expected}");
    }
}

#[test]
fn precedence_is_mathematical() {
    check(&[
        ("-x^2", -9.0),
        ("(-x)^2", 9.0),
        ("2^3^2", 512.0),
        ("(2^3)^2", 64.0),
        ("2^-1", 0.5),
        ("2^-1*4", 2.0),
        ("2^-2^2", 0.0625),
        ("-2^-2", -0.25),
        ("--x", 3.0),
        ("+-+x", -3.0),
        ("-x*y", 6.0),
        ("2*-x", -6.0),
        ("1 - 2 - 3", -4.0),
        ("8/4/2", 1.0),
        ("1 + 2*3^2", 19.0),
        ("(1 + 2)*3", 9.0),
        ("1 - -1", 2.0),
        ("2*3 + 4*5", 26.0),
    ]);
}

#[test]
fn logic_and_comparisons_are_one_or_zero() {
    check(&[
        ("1 < 2", 1.0),
        ("2 <= 1", 0.0),
        ("x > y", 1.0),
        ("x >= 3", 1.0),
        ("x == 3", 1.0),
        ("x != 3", 0.0),
        ("1 + 1 == 2", 1.0),
        ("1 < 2 && 2 < 3", 1.0),
        ("0 && 1 || 1", 1.0),
        ("1 || 1 && 0", 1.0),
        ("!0", 1.0),
        ("!x == 0", 1.0),
        ("!!x", 1.0),
        ("(1 < 2) + (2 < 3)", 2.0),
        ("if(x > 0, 10, 20)", 10.0),
        ("if(0, 1/0, 7)", 7.0),
        ("if(x < 0 || y < 0, 1, 2)", 1.0),
    ]);
}

#[test]
fn numbers_are_read_as_written() {
    check(&[
        ("1e-3", 0.001),
        ("1e-3*x", 0.003),
        ("1.5E+2", 150.0),
        (".5", 0.5),
        ("2.", 2.0),
        ("1e3 - 1", 999.0),
        ("12345678901234567890", 12345678901234567890.0),
    ]);
}

#[test]
fn constants_and_functions_have_their_values() {
    use std::f64::consts::{E, LN_2, PI, TAU};
    check(&[
        ("pi", PI),
        ("e", E),
        ("tau", TAU),
        ("sin(pi/6)", 0.49999999999999994),
        ("cos(0)", 1.0),
        ("tan(pi/4)", 0.9999999999999999),
        ("asin(1)", PI / 2.0),
        ("acos(-1)", PI),
        ("atan(1)", PI / 4.0),
        ("atan2(1, -1)", 0.75 * PI),
        ("sinh(1)", (E - 1.0 / E) / 2.0),
        ("cosh(1)", (E + 1.0 / E) / 2.0),
        ("tanh(0.5)", (E - 1.0) / (E + 1.0)),
        ("exp(1)", E),
        ("log(2)", LN_2),
        ("ln(2)", LN_2),
        ("log2(8)", 3.0),
        ("log10(1000)", 3.0),
        ("sqrt(2)^2", 2.0000000000000004),
        ("abs(y)", 2.0),
        ("sign(y) + sign(0)", -1.0),
        ("floor(-1.5)", -2.0),
        ("ceil(-1.5)", -1.0),
        ("round(2.5) + round(3.5)", 6.0),
        ("min(3, 1, 2)", 1.0),
        ("max(3, 1, 2, x + 1)", 4.0),
        ("min(5)", 5.0),
        ("clamp(5, 0, 2) + clamp(-5, 0, 2)", 2.0),
        ("clip(y) + clip(x)", 3.0),
        ("mod(-1, 3)", 2.0),
        ("mod(5.5, -2)", -0.5),
        ("pow(2, 10)", 1024.0),
        ("hypot(x, 4)", 5.0),
        ("delta(0) + delta(2*pi) + delta(-4*pi + 1e-10)", 3.0),
        ("delta(0.1) + delta(pi)", 0.0),
        ("max(0, cos(0.3))^2", 0.9126678074548391),
    ]);
}

#[test]
fn nan_spreads() {
    for text in
        ["max(0, sqrt(-1))", "min(sqrt(-1), 0)", "if(0/0, 1, 2)", "clip(0/0)", "delta(0/0)", "mod(1, 0)"]
    {
        assert!(eval(text).is_nan(), "{text}");
    }
    // Fewer values than variables.
    assert!(Expression::parse("1", &VARIABLES).expect("a number").eval(&[1.0]).is_nan());
}

#[test]
fn variables_take_precedence_over_constants() {
    let e = Expression::parse("e + pi2", &["e", "pi2"]).expect("an expression");
    assert_eq!(e.eval(&[1.0, 2.0]), 3.0);
}

#[test]
fn errors_name_line_and_column() {
    for (text, line, column, message) in [
        ("", 1, 1, "found the end, expected a number, a name or `(`"),
        ("   ", 1, 4, "found the end, expected a number, a name or `(`"),
        ("1 +", 1, 4, "found the end, expected a number, a name or `(`"),
        ("1 + * 2", 1, 5, "found `*`, expected a number, a name or `(`"),
        ("2 x", 1, 3, "found `x`, expected an operator or the end"),
        ("2x", 1, 2, "found `x`, expected an operator or the end"),
        ("(1 + 2", 1, 7, "found the end, expected an operator or `)`"),
        ("1 + 2)", 1, 6, "found `)`, expected an operator or the end"),
        ("(1, 2)", 1, 3, "found `,`, expected an operator or `)`"),
        ("min(1 2)", 1, 7, "found `2`, expected an operator, `,` or `)`"),
        ("min(1,)", 1, 7, "found `)`, expected a number, a name or `(`"),
        ("1 +\n  sni(x)", 2, 3, "unknown name `sni`, did you mean `sin`?; variables: x, y"),
        ("x +\n\n y + qqqqq", 3, 6, "unknown name `qqqqq`; variables: x, y"),
        ("sin + 1", 1, 1, "`sin` is a function: expected `(` after it"),
        ("x(2)", 1, 1, "`x` is not a function; write `*` for a product"),
        ("1 + pi(2)", 1, 5, "`pi` is not a function; write `*` for a product"),
        ("atan2(1)", 1, 1, "`atan2` takes 2 arguments, not 1"),
        ("sin()", 1, 1, "`sin` takes 1 argument, not 0"),
        ("max()", 1, 1, "`max` takes at least 1 argument, not 0"),
        ("if(1, 2)", 1, 1, "`if` takes 3 arguments, not 2"),
        ("1 < 2 < 3", 1, 7, "comparisons do not chain: write `a < b && b < c`"),
        ("x = 3", 1, 3, "found `=`, expected `==`"),
        ("1.2.3", 1, 1, "`1.2.3` is not a number"),
        (".", 1, 1, "`.` is not a number"),
        ("1e999", 1, 1, "`1e999` is not a number"),
        ("1 + #", 1, 5, "unknown character '#'"),
        ("x & y", 1, 3, "unknown character '&'"),
        ("2 · x", 1, 3, "unknown character '·'"),
    ] {
        let error = Expression::parse(text, &VARIABLES).expect_err(text);
        assert_eq!((error.line, error.column), (line, column), "{text}");
        assert_eq!(error.kind.to_string(), message, "{text}");
        assert_eq!(error.to_string(), format!("line {line}, column {column}: {message}"));
    }
}

#[test]
fn nesting_is_limited_not_fatal() {
    for (open, close) in [("(", ")"), ("-", ""), ("!", ""), ("2^", ""), ("sin(", ")"), ("1+2*3^(", ")")] {
        let nested = |levels: usize| format!("{}1{}", open.repeat(levels), close.repeat(levels));
        // A power inside the parentheses counts as a level too.
        let levels = if open.ends_with("^(") { MAX_NESTING / 2 } else { MAX_NESTING };
        assert!(Expression::parse(&nested(levels), &VARIABLES).is_ok(), "{open}");
        for levels in [levels + 1, MAX_LENGTH / 16] {
            let error = Expression::parse(&nested(levels), &VARIABLES).expect_err(open);
            assert_eq!(error.kind, ExpressionErrorKind::TooDeep, "{open}");
        }
        // Unclosed, and as long as may be.
        let endless = open.repeat(MAX_LENGTH / open.len());
        assert!(Expression::parse(&endless, &VARIABLES).is_err());
    }
}

#[test]
fn length_is_limited_and_used() {
    let sum = |terms: usize| format!("{}1", "1+".repeat(terms));
    assert_eq!(eval(&sum(4999)), 5000.0);
    let error = Expression::parse(&sum(5000), &VARIABLES).expect_err("too long");
    assert_eq!(error.kind, ExpressionErrorKind::TooLong { length: 10_001 });
    assert_eq!(eval(&format!("max({}7)", "1,".repeat(4000))), 7.0);
}

proptest! {
    #[test]
    fn no_text_panics(text in "\\PC{0,60}") {
        let _ = Expression::parse(&text, &VARIABLES).map(|e| e.eval(&[1.0, 2.0]));
    }

    #[test]
    fn no_mixture_of_tokens_panics(parts in proptest::collection::vec(
        prop::sample::select(vec!["x", "y", "1", "2.5", "pi", "sin", "if", "max", "(", ")", ",", "+", "-", "*", "/",
            "^", "<", "==", "!", "&&", "||", " ", "\n", "e", "1e"]), 0..60)) {
        let text = parts.concat();
        let _ = Expression::parse(&text, &VARIABLES).map(|e| e.eval(&[1.0, 2.0]));
    }

    #[test]
    fn sums_and_products_are_those_of_the_machine(a in -1e3..1e3f64, b in -1e3..1e3f64, c in -1e3..1e3f64) {
        let text = format!("({a}) + ({b})*({c}) - x");
        prop_assert_eq!(eval(&text), a + b * c - 3.0);
    }
}
