//! Fields a user defines by formulas.

use crate::{Expression, FieldError, MAX_SIDE};
use tigereye_core::{Cell, Field, Grid, Tensor2, math};

/// A field whose tensors are formulas of the position.
///
/// | variable | meaning |
/// | --- | --- |
/// | `x`, `y` | position relative to the middle, -1 to 1 from edge to edge of each side, `y` **up**; 0 along a side of one cell |
/// | `i`, `j` | column and row, from 0, row 0 on top |
/// | `n` | width in cells |
/// | `r`, `theta` | `hypot(x, y)` and `atan2(y, x)` |
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionField {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The formulas.
    pub form: Form,
}

/// The formulas of a tensor, as text; see [`crate::expression`] for their syntax.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Form {
    /// A rotation by `phi` times `diag(s1, s2)`, as [`Tensor2::from_axes`]: a semi-axis of length `s1` in direction
    /// `phi`, one of length `s2` across it.
    Axes {
        /// Direction, radians counter-clockwise from +x.
        phi: String,
        /// Length along it, at least 0.
        s1: String,
        /// Length across it, at least 0; larger than `s1` is allowed and makes it the major one.
        s2: String,
    },
    /// The components in the frame x right, y up.
    Components {
        /// Component xx.
        xx: String,
        /// Component xy.
        xy: String,
        /// Component yx.
        yx: String,
        /// Component yy.
        yy: String,
    },
}

impl ExpressionField {
    /// Names of the variables, in the order of their values.
    pub const VARIABLES: [&'static str; 7] = ["x", "y", "i", "j", "n", "r", "theta"];

    /// Parses the formulas and evaluates them in every cell.
    ///
    /// # Errors
    /// [`FieldError::Side`] or [`FieldError::Grid`] for an impossible size, [`FieldError::Expression`] for a formula
    /// that cannot be read, [`FieldError::NonFiniteValue`] or [`FieldError::NegativeAxis`] for the first cell in
    /// row-major order whose value is not finite or a negative length.
    pub fn build(&self) -> Result<Field<Tensor2>, FieldError> {
        let (width, height) = (self.width, self.height);
        if ![width, height].iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(FieldError::Side { width, height });
        }
        let grid = Grid::new(width, height)?;
        let tensors = match &self.form {
            Form::Axes { phi, s1, s2 } => {
                let (phi, s1, s2) =
                    (Formula::parse("phi", phi)?, Formula::parse("s1", s1)?, Formula::parse("s2", s2)?);
                each_cell(grid, |cell, v| {
                    let phi = phi.value(cell, v)?;
                    Ok(Tensor2::from_axes(phi, s1.length(cell, v)?, s2.length(cell, v)?))
                })
            }
            Form::Components { xx, xy, yx, yy } => {
                let (xx, xy) = (Formula::parse("xx", xx)?, Formula::parse("xy", xy)?);
                let (yx, yy) = (Formula::parse("yx", yx)?, Formula::parse("yy", yy)?);
                each_cell(grid, |cell, v| {
                    let [a, b] = [xx.value(cell, v)?, xy.value(cell, v)?];
                    Ok(Tensor2::new(a, b, yx.value(cell, v)?, yy.value(cell, v)?))
                })
            }
        }?;
        Ok(Field::from_values(grid, tensors)?)
    }
}

fn each_cell(
    grid: Grid,
    tensor: impl Fn(Cell, &[f64; 7]) -> Result<Tensor2, FieldError>,
) -> Result<Vec<Tensor2>, FieldError> {
    grid.iter().map(|cell| tensor(cell, &variables(grid, cell))).collect()
}

/// Values of [`ExpressionField::VARIABLES`] at a cell.
#[must_use]
pub fn variables(grid: Grid, cell: Cell) -> [f64; 7] {
    // Twice the distance from the middle over the side: both exact, so that mirrored cells have opposite values.
    let centred = |k: usize, cells: usize| match cells - 1 {
        0 => 0.0,
        last => (2.0 * k as f64 - last as f64) / last as f64,
    };
    let (x, y) = (centred(cell.x, grid.width()), -centred(cell.y, grid.height()));
    // The middle row is +0, lest theta be -pi on its left half.
    let y = if y == 0.0 { 0.0 } else { y };
    [x, y, cell.x as f64, cell.y as f64, grid.width() as f64, math::hypot(x, y), math::atan2(y, x)]
}

/// A parsed formula that knows its name and text.
struct Formula<'a> {
    name: &'static str,
    text: &'a str,
    expression: Expression,
}

impl<'a> Formula<'a> {
    fn parse(name: &'static str, text: &'a str) -> Result<Self, FieldError> {
        Expression::parse(text, &ExpressionField::VARIABLES)
            .map(|expression| Self { name, text, expression })
            .map_err(|error| FieldError::Expression { expression: name, error })
    }

    fn value(&self, cell: Cell, variables: &[f64]) -> Result<f64, FieldError> {
        let value = self.expression.eval(variables);
        if value.is_finite() {
            return Ok(value);
        }
        let (expression, text) = (self.name, self.text.to_owned());
        Err(FieldError::NonFiniteValue { expression, text, x: cell.x, y: cell.y, value })
    }

    fn length(&self, cell: Cell, variables: &[f64]) -> Result<f64, FieldError> {
        let value = self.value(cell, variables)?;
        if value >= 0.0 {
            return Ok(value);
        }
        let (expression, text) = (self.name, self.text.to_owned());
        Err(FieldError::NegativeAxis { expression, text, x: cell.x, y: cell.y, value })
    }
}
