//! Choices by their names in files.

use super::words::{Word, no_such_name};
use serde::Deserialize;
use serde::de::{Deserializer, EnumAccess, Error, VariantAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;
use tigereye_core::{Choice, Field, Tensor2};
use tigereye_lines::{Axes, Major, OrderedAxes, usual_axes};

/// One of the values of a [`Choice`], by its name in files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Chosen<T>(pub T);

impl<'de, T: Choice> Deserialize<'de> for Chosen<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let find = |name: &str| T::of_file_name(name).map(Self);
        deserializer.deserialize_enum("Chosen", &[], Names { others: &[], find, choice: PhantomData::<T> })
    }
}

/// The axes that lines follow: `Usual` or one of [`Axes`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxesChoice(Option<Axes>);

/// Eigenvectors if the field is symmetric, otherwise semi-axes.
const USUAL: &str = "Usual";

impl<'de> Deserialize<'de> for AxesChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let find = |name: &str| match name {
            USUAL => Some(Self(None)),
            name => Axes::of_file_name(name).map(|axes| Self(Some(axes))),
        };
        let names = Names { others: &[USUAL], find, choice: PhantomData::<Axes> };
        deserializer.deserialize_enum("AxesChoice", &[], names)
    }
}

impl AxesChoice {
    /// These axes for every field.
    pub(crate) const fn always(axes: Axes) -> Self {
        Self(Some(axes))
    }

    /// The axes for a field, in the chosen order or the usual one.
    pub(crate) fn ordered(self, major: Option<Chosen<Major>>, field: &Field<Tensor2>) -> OrderedAxes {
        let axes = self.0.unwrap_or_else(|| usual_axes(field));
        major.map_or_else(|| axes.into(), |Chosen(major)| axes.by(major))
    }
}

/// Reads a name: one of `others` or of the values of `T`, which `find` looks up.
struct Names<T, F> {
    others: &'static [&'static str],
    find: F,
    choice: PhantomData<T>,
}

impl<'de, T: Choice, R, F: Fn(&str) -> Option<R>> Visitor<'de> for Names<T, F> {
    type Value = R;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name without quotes")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<R, A::Error> {
        let (Word(name), rest) = data.variant()?;
        rest.unit_variant()?;
        (self.find)(&name).ok_or_else(|| {
            let own = T::ALL.iter().map(|value| value.file_name());
            let known: Vec<String> = self.others.iter().map(ToString::to_string).chain(own).collect();
            A::Error::custom(no_such_name(&name, &known))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_lines::Family;

    #[test]
    fn names_are_those_of_the_choice() {
        for &family in Family::ALL {
            let chosen: Chosen<Family> = ron::from_str(&family.file_name()).expect("a name");
            assert_eq!(chosen.0, family);
        }
        assert_eq!(ron::from_str::<AxesChoice>("Usual").expect("a name"), AxesChoice::default());
        assert_eq!(ron::from_str::<AxesChoice>("Half").expect("a name"), AxesChoice::always(Axes::HalfAxes));
    }

    #[test]
    fn other_names_are_refused_with_those_there_are() {
        let fault = ron::from_str::<Chosen<Family>>("Largest").expect_err("no family").to_string();
        assert!(fault.contains("there is no `Largest` here: expected one of `Major`, `Minor`"), "{fault}");
        let fault = ron::from_str::<AxesChoice>("half").expect_err("a small letter").to_string();
        assert!(
            fault.contains(
                "there is no `half` here: did you mean `Half`? expected one of `Usual`, `Half`, `Eigen`"
            ),
            "{fault}"
        );
        assert!(ron::from_str::<Chosen<Family>>("\"Major\"").is_err());
    }
}
