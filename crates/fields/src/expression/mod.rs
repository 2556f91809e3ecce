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
mod program;

pub use crate::limits::{MAX_LENGTH, MAX_NESTING};
pub use error::{ExpressionError, ExpressionErrorKind};
pub use program::Expression;
