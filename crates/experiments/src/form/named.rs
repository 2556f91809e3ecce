//! A map that keeps the file's order and refuses a name twice.

use super::placed::Placed;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Things by name, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T>(Vec<(Placed<String>, T)>);

impl<T> Named<T> {
    /// The thing called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&T> {
        self.0.iter().find(|(n, _)| **n == name).map(|(_, v)| v)
    }
    /// Names and things in order.
    pub fn iter(&self) -> impl Iterator<Item = (&Placed<String>, &T)> {
        self.0.iter().map(|(n, v)| (n, v))
    }
    /// The names, for messages.
    #[must_use]
    pub fn names(&self) -> String {
        self.0.iter().map(|(n, _)| n.as_str()).collect::<Vec<_>>().join(", ")
    }
}

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NamedVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for NamedVisitor<T> {
            type Value = Named<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map from names to values, { \"name\": ... }")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut found = Named(Vec::new());
                while let Some(name) = map.next_key::<Placed<String>>()? {
                    if found.get(&name).is_some() {
                        return Err(A::Error::custom(format!("the name \"{name}\" is used twice here")));
                    }
                    let value = map.next_value()?;
                    found.0.push((name, value));
                }
                Ok(found)
            }
        }
        deserializer.deserialize_map(NamedVisitor(PhantomData))
    }
}
