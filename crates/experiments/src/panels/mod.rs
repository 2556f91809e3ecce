//! Pictures of figures, one file per kind: its form in the experiment file, what its names refer to, and how it is
//! drawn.
//!
//! A panel is added by its file, which implements `PanelKind`, and its line in `panels!`.

mod additions;
mod kind;
pub mod series;

use kind::PanelKind;
pub(crate) use kind::{Curve, Drawing, PANEL_PX, PlannedPanel, checked_style, series_styles};

use crate::names::Names;
use serde::Deserialize;

macro_rules! panels {
    ($($module:ident::$kind:ident),+ $(,)?) => {
        $(pub mod $module;)+

        /// One panel. Every kind has the documentation of its type.
        #[derive(Clone, Debug, Deserialize, PartialEq)]
        #[allow(missing_docs, reason = "the types are documented")]
        pub enum Panel {
            $($kind($module::$kind),)+
        }

        impl Panel {
            /// How the panel is drawn; `None` where something is wrong, which is reported.
            pub(crate) fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
                match self {
                    $(Self::$kind(form) => form.planned(names),)+
                }
            }
        }
    };
}

panels! {
    glyphs::Glyphs,
    orientation::Orientation,
    lines::Lines,
    texture::Texture,
    map::Map,
    ridges::Ridges,
    overlay::Overlay,
    energy::Energy,
    importance::Importance,
    slice::Slice,
    flat::Flat,
    polar::Polar,
    chart::Chart,
    rows::Rows,
}
