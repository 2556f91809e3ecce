//! Generators of test fields, and the settings they receive: arguments checked and completed.

use crate::parameter::SIZES;
use crate::{Arguments, FieldError, Known, Parameter};
use tigereye_core::{Field, Grid, Tensor2};

/// A test field: its name and source, its parameters, and what is known about it.
#[derive(Debug)]
pub struct Generator {
    /// Name, unique.
    pub name: &'static str,
    /// One line on what the field shows.
    pub summary: &'static str,
    /// Its source.
    pub source: &'static str,
    /// Parameters besides `size`, `width` and `height`; see [`Generator::parameters`].
    pub own_parameters: &'static [Parameter],
    /// Whether every tensor has determinant 1 for the default parameters.
    pub determinant_one: bool,
    /// Whether every tensor is symmetric for the default parameters.
    pub symmetric: bool,
    /// Known properties of its fields, at least one.
    pub known: &'static [Known],
    pub(crate) build: fn(&Settings) -> Field<Tensor2>,
}

/// Generators are identified by name.
impl PartialEq for Generator {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Generator {
    /// All parameters: `size`, `width`, `height`, then its own.
    pub fn parameters(&self) -> impl Iterator<Item = &'static Parameter> + use<> {
        SIZES.iter().chain(self.own_parameters)
    }

    /// Checks arguments and fills in defaults.
    ///
    /// # Errors
    /// [`FieldError::UnknownParameter`], [`FieldError::InvalidValue`], [`FieldError::Grid`].
    pub fn resolve(&'static self, arguments: &Arguments) -> Result<Settings, FieldError> {
        Settings::resolve(self, arguments)
    }
}

/// A generator with a value for each of its parameters, all in range.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    generator: &'static Generator,
    grid: Grid,
    values: Vec<(Parameter, f64)>,
}

impl Settings {
    /// Checks the arguments' names and values and fills in the defaults.
    fn resolve(generator: &'static Generator, arguments: &Arguments) -> Result<Self, FieldError> {
        check_names(generator, arguments)?;
        let mut values = Vec::new();
        for parameter in generator.parameters() {
            values.push((*parameter, value_of(generator, parameter, arguments)?));
        }
        // `width` and `height` follow `size` unless they are given.
        let size = values[0].1;
        for (parameter, value) in &mut values[1..SIZES.len()] {
            if arguments.get(parameter.name).is_none() {
                *value = size;
            }
        }
        let grid = Grid::new(values[1].1 as usize, values[2].1 as usize)?;
        Ok(Self { generator, grid, values })
    }

    /// The generator.
    #[must_use]
    pub const fn generator(&self) -> &'static Generator {
        self.generator
    }
    /// The cells.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.grid
    }
    /// All parameters with their values; [`crate::ParameterKind::format`] writes a value as text.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&Parameter, f64)> {
        self.values.iter().map(|(p, v)| (p, *v))
    }
    /// The value of a parameter: the number, 0 or 1 for a flag, the index for a choice.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.iter().find(|(p, _)| p.name == name).map(|(_, v)| v)
    }
    /// The field.
    #[must_use]
    pub fn field(&self) -> Field<Tensor2> {
        (self.generator.build)(self)
    }

    /// The value of a parameter the generator declares. Panics for another: a mistake in the generator's own file.
    pub(crate) fn number(&self, name: &str) -> f64 {
        self.value(name).unwrap_or_else(|| panic!("field `{}` declares no `{name}`", self.generator.name))
    }
    /// Whether a flag is set.
    pub(crate) fn is_set(&self, name: &str) -> bool {
        self.number(name) != 0.0
    }
}

fn check_names(generator: &'static Generator, arguments: &Arguments) -> Result<(), FieldError> {
    let known = || generator.parameters().map(|p| p.name);
    match arguments.iter().find(|(name, _)| !known().any(|k| k == *name)) {
        None => Ok(()),
        Some((name, _)) => Err(FieldError::UnknownParameter {
            generator: generator.name,
            parameter: name.to_owned(),
            known: known().collect(),
        }),
    }
}

fn value_of(
    generator: &'static Generator,
    parameter: &Parameter,
    arguments: &Arguments,
) -> Result<f64, FieldError> {
    let Some(text) = arguments.get(parameter.name) else { return Ok(parameter.default) };
    parameter.kind.parse(text).ok_or_else(|| FieldError::InvalidValue {
        generator: generator.name,
        parameter: parameter.name,
        text: text.to_owned(),
        expected: parameter.kind,
    })
}
