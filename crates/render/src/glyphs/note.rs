//! The meanings of the marks of glyphs.

/// Something a legend must explain, in its order there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Note {
    Tension,
    Compression,
    Mixed,
    PositiveLobe,
    NegativeLobe,
    ArrowsOutwards,
    ArrowsInwards,
    TurnedLeft,
    TurnedRight,
    Mirrored,
    SymmetricPart,
    NoSymmetricPart,
    Zero,
    Broken,
}
