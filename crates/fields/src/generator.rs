//! The registry of generators.

use crate::generators::ALL;
use crate::nearest::nearest;
use crate::parameter::SIZES;
use crate::{Arguments, FieldError, Parameter, Settings};
use tigereye_core::{Field, Tensor2};

/// A test field: what it is, what it can be told, and what is known about it.
#[derive(Debug)]
pub struct Generator {
    /// Name, unique.
    pub name: &'static str,
    /// One line on what the field shows.
    pub summary: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// Parameters besides `size`, `width` and `height`; see [`Generator::parameters`].
    pub own_parameters: &'static [Parameter],
    /// Whether every tensor has determinant 1 for the default parameters.
    pub determinant_one: bool,
    /// Whether every tensor is symmetric for the default parameters.
    pub symmetric: bool,
    pub(crate) build: fn(&Settings) -> Field<Tensor2>,
}

/// Generators are told apart by their unique names.
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

/// All generators, sorted by name.
#[must_use]
pub fn generators() -> &'static [&'static Generator] {
    ALL
}

/// The generator of this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Generator> {
    ALL.binary_search_by_key(&name, |g| g.name).ok().map(|k| ALL[k])
}

/// The field a generator makes of these arguments, width x height tensors in the frame x right, y up.
///
/// # Errors
/// [`FieldError::UnknownGenerator`] and those of [`Generator::resolve`].
pub fn generate(name: &str, arguments: &Arguments) -> Result<Field<Tensor2>, FieldError> {
    let generator = find(name).ok_or_else(|| FieldError::UnknownGenerator {
        name: name.to_owned(),
        suggestion: nearest(name, ALL.iter().map(|g| g.name)),
    })?;
    Ok(generator.resolve(arguments)?.field())
}
