//! Engines by the names in the table of the transport crate.

use super::words::Word;
use serde::Deserialize;
use serde::de::{Deserializer, EnumAccess, Error, VariantAccess, Visitor};
use std::fmt;
use tigereye_transport::{ENGINES, EightLobe, Engine};

/// What computes a distribution: one of [`ENGINES`] by its [`Engine::id`], [`EightLobe`] by default.
#[derive(Clone, Copy)]
pub struct EngineChoice(&'static (dyn Engine + Sync));

impl EngineChoice {
    pub(crate) fn engine(self) -> &'static dyn Engine {
        self.0
    }
}

impl Default for EngineChoice {
    fn default() -> Self {
        Self(&EightLobe)
    }
}

impl fmt::Debug for EngineChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.id())
    }
}

impl PartialEq for EngineChoice {
    fn eq(&self, other: &Self) -> bool {
        self.0.id() == other.0.id()
    }
}

impl Eq for EngineChoice {}

impl<'de> Deserialize<'de> for EngineChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_enum("EngineChoice", &[], Choice)
    }
}

struct Choice;

impl<'de> Visitor<'de> for Choice {
    type Value = EngineChoice;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of an engine")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<EngineChoice, A::Error> {
        let (Word(id), rest) = data.variant()?;
        rest.unit_variant()?;
        let found = ENGINES.iter().find(|engine| engine.id() == id);
        found.map(|engine| EngineChoice(*engine)).ok_or_else(|| {
            let known: Vec<String> = ENGINES.iter().map(|engine| format!("`{}`", engine.id())).collect();
            A::Error::custom(format!("unknown engine `{id}`: expected {}", known.join(" or ")))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_engine_has_its_name() {
        for engine in ENGINES {
            let chosen: EngineChoice = ron::from_str(engine.id()).expect("a name");
            assert_eq!(chosen.engine().name(), engine.name());
            assert_eq!(ENGINES.iter().filter(|e| e.id() == engine.id()).count(), 1);
        }
        let fault = ron::from_str::<EngineChoice>("Warp").expect_err("no engine").to_string();
        assert!(fault.contains("unknown engine `Warp`: expected `SampleSpace` or `EightLobe`"), "{fault}");
    }
}
