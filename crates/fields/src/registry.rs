//! All generators by name.

use crate::generators::ALL;
use crate::nearest::nearest;
use crate::{Arguments, FieldError, Generator};
use tigereye_core::{Field, Tensor2};

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
