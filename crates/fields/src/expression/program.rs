//! A formula as instructions for a stack.

use super::functions::{Binary, Function};

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
pub(super) enum Instruction {
    Number(f64),
    Variable(usize),
    Negate,
    Not,
    Binary(Binary),
    /// With the number of arguments.
    Call(Function, usize),
}

impl Expression {
    pub(super) fn from_code(code: Vec<Instruction>, variables: usize) -> Self {
        let (mut depth, mut stack) = (0_usize, 0);
        for instruction in &code {
            depth = depth - instruction.operands() + 1;
            stack = stack.max(depth);
        }
        Self { code, stack, variables }
    }

    /// The value for `values`, one per variable in the order given to [`Self::parse`]; NaN if there are fewer.
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
