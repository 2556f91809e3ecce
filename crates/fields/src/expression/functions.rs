//! Operators and functions of formulas.

use tigereye_core::math;

/// An operator between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binary {
    Or,
    And,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl Binary {
    pub(super) fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Or => f64::from(a != 0.0 || b != 0.0),
            Self::And => f64::from(a != 0.0 && b != 0.0),
            Self::Less => f64::from(a < b),
            Self::LessEqual => f64::from(a <= b),
            Self::Greater => f64::from(a > b),
            Self::GreaterEqual => f64::from(a >= b),
            Self::Equal => f64::from(a == b),
            Self::NotEqual => f64::from(a != b),
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => math::pow(a, b),
        }
    }
}

/// A function: its name, the number of its arguments, and how to compute it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Function {
    pub(super) name: &'static str,
    /// Smallest and largest number of arguments.
    pub(super) arity: (usize, usize),
    /// The arity in words.
    pub(super) arity_text: &'static str,
    compute: fn(&[f64]) -> f64,
}

impl PartialEq for Function {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Function {
    pub(super) fn find(name: &str) -> Option<Self> {
        FUNCTIONS.iter().find(|f| f.name == name).copied()
    }

    /// The value for a number of arguments that [`Self::arity`] allows.
    pub(super) fn apply(&self, arguments: &[f64]) -> f64 {
        (self.compute)(arguments)
    }
}

/// The constant of this name.
pub(super) fn constant(name: &str) -> Option<f64> {
    CONSTANTS.iter().find(|(n, _)| *n == name).map(|(_, v)| *v)
}

pub(super) const CONSTANTS: [(&str, f64); 3] =
    [("pi", math::PI), ("e", core::f64::consts::E), ("tau", math::TAU)];

const fn one(name: &'static str, compute: fn(&[f64]) -> f64) -> Function {
    Function { name, arity: (1, 1), arity_text: "1 argument", compute }
}
const fn two(name: &'static str, compute: fn(&[f64]) -> f64) -> Function {
    Function { name, arity: (2, 2), arity_text: "2 arguments", compute }
}
const fn three(name: &'static str, compute: fn(&[f64]) -> f64) -> Function {
    Function { name, arity: (3, 3), arity_text: "3 arguments", compute }
}
const fn many(name: &'static str, compute: fn(&[f64]) -> f64) -> Function {
    Function { name, arity: (1, usize::MAX), arity_text: "at least 1 argument", compute }
}

pub(super) const FUNCTIONS: [Function; 30] = [
    one("sin", |a| math::sin(a[0])),
    one("cos", |a| math::cos(a[0])),
    one("tan", |a| math::tan(a[0])),
    one("asin", |a| math::asin(a[0])),
    one("acos", |a| math::acos(a[0])),
    one("atan", |a| math::atan(a[0])),
    two("atan2", |a| math::atan2(a[0], a[1])),
    one("sinh", |a| math::sinh(a[0])),
    one("cosh", |a| math::cosh(a[0])),
    one("tanh", |a| math::tanh(a[0])),
    one("exp", |a| math::exp(a[0])),
    one("log", |a| math::ln(a[0])),
    one("ln", |a| math::ln(a[0])),
    one("log2", |a| math::log2(a[0])),
    one("log10", |a| math::log10(a[0])),
    one("sqrt", |a| a[0].sqrt()),
    one("abs", |a| a[0].abs()),
    one("sign", |a| if a[0] == 0.0 { 0.0 } else { a[0].signum() }),
    one("floor", |a| a[0].floor()),
    one("ceil", |a| a[0].ceil()),
    one("round", |a| math::round_ties_even(a[0])),
    one("clip", |a| larger(a[0], 0.0)),
    one("delta", |a| delta(a[0])),
    two("mod", |a| modulo(a[0], a[1])),
    two("pow", |a| math::pow(a[0], a[1])),
    two("hypot", |a| math::hypot(a[0], a[1])),
    three("clamp", |a| smaller(larger(a[0], a[1]), a[2])),
    three("if", |a| choose(a[0], a[1], a[2])),
    many("min", |a| a[1..].iter().fold(a[0], |m, &x| smaller(m, x))),
    many("max", |a| a[1..].iter().fold(a[0], |m, &x| larger(m, x))),
];

// `f64::min` and `max` drop NaN; here it must show.
fn smaller(a: f64, b: f64) -> f64 {
    if a.is_nan() || a < b { a } else { b }
}
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

fn choose(condition: f64, then: f64, otherwise: f64) -> f64 {
    match condition {
        c if c.is_nan() => c,
        0.0 => otherwise,
        _ => then,
    }
}

fn modulo(a: f64, b: f64) -> f64 {
    let r = a % b;
    if r != 0.0 && (r < 0.0) != (b < 0.0) { r + b } else { r }
}

fn delta(x: f64) -> f64 {
    if x.is_nan() {
        return x;
    }
    let distance = x - math::TAU * math::round_ties_even(x / math::TAU);
    f64::from(distance.abs() <= 1e-9)
}
