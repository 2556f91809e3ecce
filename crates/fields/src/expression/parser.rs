//! A Pratt parser that writes postfix code.
//!
//! Pratt, "Top down operator precedence", POPL 1973.

use super::error::{ExpressionError, ExpressionErrorKind};
use super::functions::{Binary, CONSTANTS, FUNCTIONS, Function, constant};
use super::lexer::{Located, Position, Token, tokens};
use super::program::{Expression, Instruction};
use crate::limits::{MAX_LENGTH, MAX_NESTING};
use crate::nearest::nearest;

/// Binding strength of a sign: stronger than a product, weaker than a power.
const PREFIX: u8 = 6;
const COMPARISON: u8 = 3;

/// Binding strength and that required of the right operand.
const fn strength(op: Binary) -> (u8, u8) {
    match op {
        Binary::Or => (1, 2),
        Binary::And => (2, 3),
        Binary::Less
        | Binary::LessEqual
        | Binary::Greater
        | Binary::GreaterEqual
        | Binary::Equal
        | Binary::NotEqual => (COMPARISON, COMPARISON + 1),
        Binary::Add | Binary::Subtract => (4, 5),
        Binary::Multiply | Binary::Divide => (5, 6),
        // The same strength on the right makes powers associate from the right.
        Binary::Power => (7, 7),
    }
}

impl Expression {
    /// Parses `text`; names refer to `variables`, which take precedence over constants of the same name.
    ///
    /// # Errors
    /// [`ExpressionError`] with the line and column of the first problem.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, ExpressionError> {
        parse(text, variables)
    }
}

/// Parses `text` over `variables`.
fn parse(text: &str, variables: &[&str]) -> Result<Expression, ExpressionError> {
    let length = text.chars().count();
    if length > MAX_LENGTH {
        let kind = ExpressionErrorKind::TooLong { length };
        return Err(ExpressionError { line: 1, column: 1, kind });
    }
    let mut parser = Parser { tokens: tokens(text)?, next: 0, variables, code: Vec::new(), depth: 0 };
    parser.expression(0)?;
    match parser.peek().token {
        Token::End => Ok(Expression::from_code(parser.code, variables.len())),
        _ => Err(parser.unexpected("an operator or the end")),
    }
}

struct Parser<'a> {
    tokens: Vec<Located>,
    /// Never beyond the last token, which is the end.
    next: usize,
    variables: &'a [&'a str],
    code: Vec<Instruction>,
    depth: usize,
}

impl Parser<'_> {
    fn peek(&self) -> &Located {
        &self.tokens[self.next]
    }

    fn advance(&mut self) -> Located {
        let token = self.peek().clone();
        self.next = (self.next + 1).min(self.tokens.len() - 1);
        token
    }

    fn unexpected(&self, expected: &'static str) -> ExpressionError {
        let Located { token, position, text } = self.peek();
        let found = if *token == Token::End { "the end".to_owned() } else { format!("`{text}`") };
        position.error(ExpressionErrorKind::Unexpected { found, expected })
    }

    /// An expression whose operators bind at least as strongly as `least`.
    ///
    /// Recursion is bounded: operators of rising strength nest at most once each, all else goes through
    /// [`Self::deeper`].
    fn expression(&mut self, least: u8) -> Result<(), ExpressionError> {
        self.operand()?;
        let mut compared = false;
        while let Token::Operator(op) = self.peek().token {
            let (left, right) = strength(op);
            if left < least {
                break;
            }
            if left == COMPARISON && compared {
                return Err(self.peek().position.error(ExpressionErrorKind::ChainedComparison));
            }
            // A weaker operator ends the comparison: `a < b && c < d`.
            compared = left == COMPARISON;
            self.advance();
            if right > left {
                self.expression(right)?;
            } else {
                self.deeper(right)?;
            }
            self.code.push(Instruction::Binary(op));
        }
        Ok(())
    }

    /// An expression inside something that may nest without end.
    fn deeper(&mut self, least: u8) -> Result<(), ExpressionError> {
        if self.depth == MAX_NESTING {
            return Err(self.peek().position.error(ExpressionErrorKind::TooDeep));
        }
        self.depth += 1;
        self.expression(least)?;
        self.depth -= 1;
        Ok(())
    }

    fn operand(&mut self) -> Result<(), ExpressionError> {
        const EXPECTED: &str = "a number, a name or `(`";
        match &self.peek().token {
            Token::Number(_) | Token::Name(_) => {}
            Token::Operator(Binary::Subtract) => return self.prefixed(Some(Instruction::Negate)),
            Token::Operator(Binary::Add) => return self.prefixed(None),
            Token::Not => return self.prefixed(Some(Instruction::Not)),
            Token::Open => {
                self.advance();
                self.deeper(0)?;
                return self.close("an operator or `)`");
            }
            _ => return Err(self.unexpected(EXPECTED)),
        }
        let Located { token, position, .. } = self.advance();
        match token {
            Token::Number(value) => {
                self.code.push(Instruction::Number(value));
                Ok(())
            }
            Token::Name(name) => self.name(&name, position),
            _ => Err(self.unexpected(EXPECTED)),
        }
    }

    fn prefixed(&mut self, instruction: Option<Instruction>) -> Result<(), ExpressionError> {
        self.advance();
        self.deeper(PREFIX)?;
        self.code.extend(instruction);
        Ok(())
    }

    fn close(&mut self, expected: &'static str) -> Result<(), ExpressionError> {
        if self.peek().token != Token::Close {
            return Err(self.unexpected(expected));
        }
        self.advance();
        Ok(())
    }

    fn name(&mut self, name: &str, position: Position) -> Result<(), ExpressionError> {
        let variable = self.variables.iter().position(|v| *v == name).map(Instruction::Variable);
        let value = variable.or_else(|| constant(name).map(Instruction::Number));
        let called = self.peek().token == Token::Open;
        match (value, Function::find(name)) {
            (Some(_), None) if called => {
                Err(position.error(ExpressionErrorKind::NotAFunction { name: name.to_owned() }))
            }
            (_, Some(function)) if called => self.call(function, position),
            (Some(instruction), _) => {
                self.code.push(instruction);
                Ok(())
            }
            (None, Some(function)) => {
                Err(position.error(ExpressionErrorKind::MissingArguments { name: function.name }))
            }
            (None, None) => Err(position.error(self.unknown(name))),
        }
    }

    fn unknown(&self, name: &str) -> ExpressionErrorKind {
        let constants = CONSTANTS.iter().map(|(n, _)| *n);
        let known = self.variables.iter().copied().chain(constants).chain(FUNCTIONS.iter().map(|f| f.name));
        ExpressionErrorKind::UnknownName {
            name: name.to_owned(),
            suggestion: nearest(name, known).map(str::to_owned),
            variables: self.variables.iter().map(|v| (*v).to_owned()).collect(),
        }
    }

    fn call(&mut self, function: Function, position: Position) -> Result<(), ExpressionError> {
        self.advance();
        let mut found = 0;
        if self.peek().token != Token::Close {
            self.deeper(0)?;
            found = 1;
            while self.peek().token == Token::Comma {
                self.advance();
                self.deeper(0)?;
                found += 1;
            }
        }
        self.close("an operator, `,` or `)`")?;
        if !(function.arity.0..=function.arity.1).contains(&found) {
            return Err(position.error(ExpressionErrorKind::ArgumentCount {
                name: function.name,
                expected: function.arity_text,
                found,
            }));
        }
        self.code.push(Instruction::Call(function, found));
        Ok(())
    }
}
