//! Parameters as a user writes them: names and texts.

use crate::FieldError;
use core::fmt;

/// Values for some of a generator's parameters, as text, each name at most once, in the order given.
///
/// Numbers, booleans and words of a file become texts through their `Display`, which loses no digit of an `f64`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Arguments {
    items: Vec<(String, String)>,
}

impl Arguments {
    /// No arguments: all defaults.
    #[must_use]
    pub const fn new() -> Self {
        Self { items: Vec::new() }
    }

    /// Adds an argument.
    ///
    /// # Errors
    /// [`FieldError::DuplicateParameter`] if the name is there already.
    pub fn insert(&mut self, name: &str, value: impl fmt::Display) -> Result<(), FieldError> {
        if self.get(name).is_some() {
            return Err(FieldError::DuplicateParameter { parameter: name.to_owned() });
        }
        self.items.push((name.to_owned(), value.to_string()));
        Ok(())
    }

    /// The same with an argument set, whether it was there or not.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl fmt::Display) -> Self {
        self.items.retain(|(k, _)| k != name);
        self.items.push((name.to_owned(), value.to_string()));
        self
    }

    /// The text given for `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&str> {
        self.items.iter().find(|(k, _)| k == name).map(|(_, v)| v.as_str())
    }

    /// Names and texts in the order given.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&str, &str)> {
        self.items.iter().map(|(k, v)| (k.as_str(), v.as_str()))
    }
}

/// A generator's name with its arguments, `inverse:size=51,anisotropy=4`. `Display` writes what [`parse_spec`] reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldSpec {
    /// Name; not yet looked up.
    pub name: String,
    /// Arguments; not yet checked.
    pub arguments: Arguments,
}

impl fmt::Display for FieldSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)?;
        for (k, (name, value)) in self.arguments.iter().enumerate() {
            write!(f, "{}{name}={value}", if k == 0 { ':' } else { ',' })?;
        }
        Ok(())
    }
}

/// Reads `NAME` or `NAME:key=value,key=value`. Blanks around names and values do not count.
///
/// Only the form is checked; [`crate::find`] and [`crate::Generator::resolve`] check names and values.
///
/// # Errors
/// [`FieldError::MalformedSpec`] or [`FieldError::DuplicateParameter`].
pub fn parse_spec(text: &str) -> Result<FieldSpec, FieldError> {
    let malformed =
        |part: &str| FieldError::MalformedSpec { part: part.trim().to_owned(), text: text.to_owned() };
    let (name, rest) = match text.split_once(':') {
        Some((name, rest)) => (name.trim(), Some(rest)),
        None => (text.trim(), None),
    };
    if name.is_empty() {
        return Err(malformed(name));
    }
    let mut arguments = Arguments::new();
    for part in rest.into_iter().flat_map(|r| r.split(',')) {
        let (key, value) = part.split_once('=').ok_or_else(|| malformed(part))?;
        let (key, value) = (key.trim(), value.trim());
        if key.is_empty() || value.is_empty() {
            return Err(malformed(part));
        }
        arguments.insert(key, value)?;
    }
    Ok(FieldSpec { name: name.to_owned(), arguments })
}
