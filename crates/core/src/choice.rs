//! Choices: types with a few values, each of which has a word.

/// A type with a few values, for which options, files and messages have one word each.
///
/// [`crate::choice!`] implements it: the list of a type's values and their words stands there and nowhere else.
pub trait Choice: Copy + Send + Sync + 'static {
    /// Every value, in the order in which they are listed; of values with numbers those with the usual ones.
    const ALL: &'static [Self];

    /// Its word, as options and messages spell it: `half`.
    #[must_use]
    fn word(self) -> &'static str;

    /// What it means, a sentence for help texts.
    #[must_use]
    fn meaning(self) -> &'static str;

    /// Its name in files: the word with a capital, `Half`.
    #[must_use]
    fn file_name(self) -> String {
        let word = self.word();
        let (first, rest) = word.split_at(word.len().min(1));
        first.to_ascii_uppercase() + rest
    }

    /// The value of a word.
    #[must_use]
    fn of_word(word: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.word() == word)
    }

    /// The value of a name in files.
    #[must_use]
    fn of_file_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.file_name() == name)
    }
}

/// Implements [`Choice`](crate::Choice): `choice!(Type { Value = "word": "What it means.", ... })`. A value with
/// numbers says which are usual, `Value { number: 3.0 } = ...`. The compiler asks for values that are missing.
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
