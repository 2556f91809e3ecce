//! Pictures of tensor fields, light distributions and gradients: data in, a [`Scene`] out, exported as PNG, SVG or PDF.
//!
//! Every function here is pure. Nothing is written, nothing is asked of the system, and the same data gives the same
//! bytes. Values that cannot be drawn (not finite, or not positive on a logarithmic scale) are never silently turned
//! into others: the picture's legend names them.

mod animation;
mod axis;
mod chart;
mod chart_backend;
mod colour;
mod colour_bar;
mod error;
mod font;
mod glyphs;
mod heat_map;
mod legend;
mod map_frame;
mod mask;
mod multiples;
pub mod number;
mod orientation;
mod outline;
mod overlay;
mod pdf;
mod plain_map;
mod png_export;
mod polar_overlay;
mod polar_plot;
mod ribbon;
mod row_chart;
mod sampling;
mod scale;
mod scene;
mod shapes;
mod style;
mod svg;
mod texture;
mod walls;

pub use animation::{MAX_ANIMATED_PIXELS, Pace, animation};
pub use chart::{Chart, ChartAxis, Reference, Series, line_chart};
pub use colour::{ColourMap, Rgba, SERIES_PALETTE};
pub use error::RenderError;
pub use font::{has_glyph, text_width};
pub use glyphs::{
    GlyphColour, GlyphKind, GlyphOptions, GlyphOutline, GlyphPart, GlyphScale, glyph_outlines, glyphs,
};
pub use heat_map::{Difference, HeatOptions, difference_map, heat_map};
pub use multiples::{PageRect, placed_multiples, small_multiples};
pub use orientation::{OrientationOptions, orientation_map};
pub use outline::outline;
pub use overlay::Overlay;
pub use plain_map::{PlainOptions, plain_map};
pub use polar_overlay::{IntensityScale, PolarOptions, TransmissionScale, polar_overlay};
pub use polar_plot::{PolarPlotOptions, PolarSeries, polar_plot};
pub use ribbon::Ribbon;
pub use row_chart::{RowChart, row_chart};
pub use scale::HeatScale;
pub use scene::{
    Anchor, Item, Page, PagePoint, PageVector, Path, PathBuilder, Raster, Scene, Segment, Stroke, Text,
};
pub use shapes::Marker;
pub use style::{AxisNumbers, Colours, Coordinates, Length, Style, ValueRange};
pub use texture::{TextureOptions, Tint, texture_map};
