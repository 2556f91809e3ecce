//! From characters to tokens with positions.

use super::functions::Binary;
use super::{ExpressionError, ExpressionErrorKind};

/// Line and column, both from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Position {
    line: usize,
    column: usize,
}

impl Position {
    pub(super) const fn error(self, kind: ExpressionErrorKind) -> ExpressionError {
        ExpressionError { line: self.line, column: self.column, kind }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Name(String),
    Operator(Binary),
    Not,
    Open,
    Close,
    Comma,
    End,
}

/// A token, where it starts, and its text for messages.
#[derive(Clone, Debug)]
pub(super) struct Located {
    pub(super) token: Token,
    pub(super) position: Position,
    pub(super) text: String,
}

/// All tokens of `text`, the last one [`Token::End`].
pub(super) fn tokens(text: &str) -> Result<Vec<Located>, ExpressionError> {
    let mut lexer =
        Lexer { characters: text.chars().collect(), next: 0, at: Position { line: 1, column: 1 } };
    let mut found = Vec::new();
    loop {
        let token = lexer.token()?;
        let ended = token.token == Token::End;
        found.push(token);
        if ended {
            return Ok(found);
        }
    }
}

struct Lexer {
    characters: Vec<char>,
    next: usize,
    at: Position,
}

impl Lexer {
    fn peek(&self, ahead: usize) -> Option<char> {
        self.characters.get(self.next + ahead).copied()
    }

    fn advance(&mut self) {
        if self.peek(0) == Some('\n') {
            self.at = Position { line: self.at.line + 1, column: 1 };
        } else {
            self.at.column += 1;
        }
        self.next += 1;
    }

    fn advance_while(&mut self, accept: impl Fn(char) -> bool) {
        while self.peek(0).is_some_and(&accept) {
            self.advance();
        }
    }

    fn token(&mut self) -> Result<Located, ExpressionError> {
        self.advance_while(char::is_whitespace);
        let (start, position) = (self.next, self.at);
        let token = match self.peek(0) {
            None => Token::End,
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(position)?,
            Some(c) if c.is_ascii_alphabetic() || c == '_' => {
                self.advance_while(|c| c.is_ascii_alphanumeric() || c == '_');
                Token::Name(self.characters[start..self.next].iter().collect())
            }
            Some(c) => self.symbol(c, position)?,
        };
        let text = self.characters[start..self.next].iter().collect();
        Ok(Located { token, position, text })
    }

    fn number(&mut self, position: Position) -> Result<Token, ExpressionError> {
        let start = self.next;
        self.advance_while(|c| c.is_ascii_digit() || c == '.');
        if self.has_exponent() {
            self.advance();
            self.advance();
            self.advance_while(|c| c.is_ascii_digit());
        }
        let text: String = self.characters[start..self.next].iter().collect();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Token::Number(value)),
            _ => Err(position.error(ExpressionErrorKind::Number { text })),
        }
    }

    /// Whether an exponent follows: `e` alone would be the constant.
    fn has_exponent(&self) -> bool {
        let digit = |ahead| self.peek(ahead).is_some_and(|c| c.is_ascii_digit());
        let signed = matches!(self.peek(1), Some('+' | '-')) && digit(2);
        matches!(self.peek(0), Some('e' | 'E')) && (digit(1) || signed)
    }

    fn symbol(&mut self, first: char, position: Position) -> Result<Token, ExpressionError> {
        let (token, length) = match (first, self.peek(1)) {
            ('|', Some('|')) => (Token::Operator(Binary::Or), 2),
            ('&', Some('&')) => (Token::Operator(Binary::And), 2),
            ('<', Some('=')) => (Token::Operator(Binary::LessEqual), 2),
            ('>', Some('=')) => (Token::Operator(Binary::GreaterEqual), 2),
            ('=', Some('=')) => (Token::Operator(Binary::Equal), 2),
            ('!', Some('=')) => (Token::Operator(Binary::NotEqual), 2),
            ('<', _) => (Token::Operator(Binary::Less), 1),
            ('>', _) => (Token::Operator(Binary::Greater), 1),
            ('+', _) => (Token::Operator(Binary::Add), 1),
            ('-', _) => (Token::Operator(Binary::Subtract), 1),
            ('*', _) => (Token::Operator(Binary::Multiply), 1),
            ('/', _) => (Token::Operator(Binary::Divide), 1),
            ('^', _) => (Token::Operator(Binary::Power), 1),
            ('!', _) => (Token::Not, 1),
            ('(', _) => (Token::Open, 1),
            (')', _) => (Token::Close, 1),
            (',', _) => (Token::Comma, 1),
            ('=', _) => {
                let found = "`=`".to_owned();
                return Err(position.error(ExpressionErrorKind::Unexpected { found, expected: "`==`" }));
            }
            (character, _) => return Err(position.error(ExpressionErrorKind::Character { character })),
        };
        for _ in 0..length {
            self.advance();
        }
        Ok(token)
    }
}
