//! Choices: types with a few named values.

/// A type with a few values that options, files and messages refer to by name.
///
/// [`crate::choice!`] implements it, which is the only place where the names of a type's values are defined.
pub trait Choice: Copy + Send + Sync + 'static {
    /// Every value, in the order of listings; values with parameters have their usual ones.
    const ALL: &'static [Self];

    /// Its name in options and messages: `half`.
    #[must_use]
    fn word(self) -> &'static str;

    /// Its description, a sentence for help texts.
    #[must_use]
    fn meaning(self) -> &'static str;

    /// Its name in files, which is capitalised: `Half`.
    #[must_use]
    fn file_name(self) -> String {
        let word = self.word();
        let (first, rest) = word.split_at(word.len().min(1));
        first.to_ascii_uppercase() + rest
    }

    /// The value with this name in options and messages.
    #[must_use]
    fn of_word(word: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.word() == word)
    }

    /// The value with this name in files.
    #[must_use]
    fn of_file_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.file_name() == name)
    }
}

/// Implements [`Choice`](crate::Choice): `choice!(Type { Value = "name": "Its description.", ... })`. A value with
/// parameters states the usual ones, `Value { number: 3.0 } = ...`. A missing value is a compile error.
#[macro_export]
macro_rules! choice {
    ($type:ty {
        $($value:ident $({ $($field:ident: $usual:expr),+ })? = $word:literal: $meaning:literal),+ $(,)?
    }) => {
        impl $crate::Choice for $type {
            const ALL: &'static [Self] = &[$(Self::$value $({ $($field: $usual),+ })?),+];

            fn word(self) -> &'static str {
                match self {
                    $(Self::$value $({ $($field: _),+ })? => $word,)+
                }
            }

            fn meaning(self) -> &'static str {
                match self {
                    $(Self::$value $({ $($field: _),+ })? => $meaning,)+
                }
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Shape {
        Round,
        Boxy { sharpness: f64 },
    }

    choice!(Shape {
        Round = "round": "A circle.",
        Boxy { sharpness: 3.0 } = "boxy": "Nearly a square.",
    });

    #[test]
    fn every_value_has_its_word() {
        assert_eq!(Shape::ALL, [Shape::Round, Shape::Boxy { sharpness: 3.0 }]);
        for &value in Shape::ALL {
            assert_eq!(Shape::of_word(value.word()), Some(value));
            assert_eq!(Shape::of_file_name(&value.file_name()), Some(value));
        }
        assert_eq!(
            (Shape::Boxy { sharpness: 1.0 }.word(), Shape::Round.file_name()),
            ("boxy", "Round".to_owned())
        );
        assert_eq!(Shape::Round.meaning(), "A circle.");
        assert_eq!((Shape::of_word("Round"), Shape::of_file_name("round")), (None, None));
    }
}
