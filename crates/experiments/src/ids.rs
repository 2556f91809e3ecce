//! Ids that names resolve to.

/// A tensor field of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct FieldId(pub(crate) usize);

/// What a run's light goes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MediumId {
    Field(FieldId),
    /// By its place among the scenes.
    Scene(usize),
}

/// A run of any kind, by its place among all runs of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct RunId(pub(crate) usize);

macro_rules! run_ids {
    ($($(#[doc = $doc:literal])* $name:ident),* $(,)?) => {
        $(
            $(#[doc = $doc])*
            #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
            pub(crate) struct $name(pub(crate) RunId);
        )*
    };
}

run_ids!(
    /// A run of light.
    LightId,
    /// A gradient.
    GradientId,
    /// An importance.
    ImportanceId,
    /// A study of pulses.
    PulsesId,
    /// Exponents on tensor lines.
    FtleId,
);

/// The state of a run of light after a step, or at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FrameId {
    pub(crate) light: LightId,
    /// The step; `None`: the last.
    pub(crate) step: Option<usize>,
}

/// One direction of a gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SliceId {
    pub(crate) gradient: GradientId,
    pub(crate) sample: usize,
}
