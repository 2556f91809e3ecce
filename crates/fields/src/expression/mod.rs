//! Formulas a user writes: parsed once, evaluated per cell.
//!
//! The semantics are a mathematician's. From weak to strong binding:
//!
//! | operators | note |
//! | --- | --- |
//! | `\|\|` | 1 if one side is not 0 |
//! | `&&` | 1 if both sides are not 0 |
//! | `<` `<=` `>` `>=` `==` `!=` | 1 or 0; `a < b < c` is refused |
//! | `+` `-` | |
//! | `*` `/` | no implied products: `2 x` is refused |
//! | `-` `+` `!` before an operand | `-x^2` is `-(x^2)` |
//! | `^` | from the right: `2^3^2` is `2^9`; `2^-1` is allowed |
//!
//! Numbers are `1`, `1.5`, `.5`, `1e-3`. Constants: `pi`, `e`, `tau`. Angles are radians. Functions: `sin cos tan asin
//! acos atan sinh cosh tanh exp sqrt abs sign floor ceil round log ln log2 log10 clip delta` of one argument, `atan2(y,
//! x)`, `mod`, `pow` and `hypot` of two, `clamp(x, low, high)`, `if(condition, then, else)`, `min` and `max` of any
//! number. `log` is natural; `round` takes ties to even; `mod(a, b)` has the sign of `b`; `clip(x)` is `max(x, 0)`;
//! `delta(x)` is 1 where `x` is a multiple of 2 pi to within 1e-9, else 0. NaN spreads through all of them.

mod error;
mod functions;
mod lexer;
mod parser;

pub use error::{ExpressionError, ExpressionErrorKind};
use functions::{Binary, Function};

/// Longest text in characters.
pub const MAX_LENGTH: usize = 10_000;
/// Deepest nesting of parentheses, signs, powers and arguments.
pub const MAX_NESTING: usize = 200;

/// Operands held without allocating; only long argument lists need more.
const INLINE_STACK: usize = 32;

/// A parsed formula over named variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    /// In postfix order: every instruction takes its operands from the stack.
    code: Vec<Instruction>,
    /// Largest number of operands on the stack.
    stack: usize,
    variables: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Instruction {
    Number(f64),
    Variable(usize),
    Negate,
    Not,
    Binary(Binary),
    /// With the number of arguments.
    Call(Function, usize),
}

impl Expression {
    /// Parses `text`; names in it are those of `variables`, which go before constants of the same name.
    ///
    /// # Errors
    /// [`ExpressionError`] with the line and column of the first problem.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, ExpressionError> {
        parser::parse(text, variables)
    }

    fn from_code(code: Vec<Instruction>, variables: usize) -> Self {
        let (mut depth, mut stack) = (0_usize, 0);
        for instruction in &code {
            depth = depth - instruction.operands() + 1;
            stack = stack.max(depth);
        }
        Self { code, stack, variables }
    }

    /// The value for `values`, one per variable in the order given to [`Self::parse`]; NaN where there are fewer.
    ///
    /// Costs one pass over the formula and, unless an argument list is very long, no allocation.
    #[must_use]
    pub fn eval(&self, values: &[f64]) -> f64 {
        if values.len() < self.variables {
            return f64::NAN;
        }
        if self.stack <= INLINE_STACK {
            self.run(values, &mut [0.0; INLINE_STACK])
        } else {
            self.run(values, &mut vec![0.0; self.stack])
        }
    }

    fn run(&self, values: &[f64], stack: &mut [f64]) -> f64 {
        let mut top = 0;
        for instruction in &self.code {
            let first = top - instruction.operands();
            let operands = &stack[first..top];
            let value = match *instruction {
                Instruction::Number(x) => x,
                Instruction::Variable(k) => values[k],
                Instruction::Negate => -operands[0],
                Instruction::Not => f64::from(operands[0] == 0.0),
                Instruction::Binary(op) => op.apply(operands[0], operands[1]),
                Instruction::Call(function, _) => function.apply(operands),
            };
            stack[first] = value;
            top = first + 1;
        }
        stack[0]
    }
}

impl Instruction {
    const fn operands(&self) -> usize {
        match *self {
            Self::Number(_) | Self::Variable(_) => 0,
            Self::Negate | Self::Not => 1,
            Self::Binary(_) => 2,
            Self::Call(_, arguments) => arguments,
        }
    }
}
