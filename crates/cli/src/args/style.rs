//! The command line of pictures: how they look.

use super::values::choice;
use clap::Args;
use core::ops::RangeInclusive;
use std::path::PathBuf;
use tigereye_core::Choice;
use tigereye_render::{AxisNumbers, ColourMap, HeatScale, Length, Style, ValueRange};
use tigereye_views::added::Added;

/// How pictures (.png, .svg and .pdf) look.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Pictures")]
pub(crate) struct StyleArgs {
    /// A style file with any of the settings below; options take precedence.
    #[arg(long, value_name = "FILE.ron")]
    pub(crate) style: Option<PathBuf>,
    /// Heading; empty for none.
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Colour map.
    #[arg(long, value_name = "MAP", value_parser = choice::<ColourMap>(), hide_possible_values = true, long_help = colour_maps())]
    colour_map: Option<ColourMap>,
    /// Scale of the colours: linear, diverging (symmetric about 0), logarithmic, or logarithmic:N over N decades.
    #[arg(long, value_name = "SCALE", value_parser = parse_scale)]
    colour_scale: Option<HeatScale>,
    /// Values at the ends of the colour bar, A:B, or percentiles, for example 2%:98%. One range makes pictures
    /// comparable.
    #[arg(long, value_name = "A:B", value_parser = parse_range, allow_hyphen_values = true)]
    range: Option<ValueRange>,
    /// Text beside the colour bar: quantity and unit.
    #[arg(long, value_name = "TEXT")]
    bar_label: Option<String>,
    /// Text below the horizontal axis.
    #[arg(long, value_name = "TEXT")]
    x_label: Option<String>,
    /// Text beside the vertical axis.
    #[arg(long, value_name = "TEXT")]
    y_label: Option<String>,
    /// What the axes are marked with; the file's coordinates by default, where it has some.
    #[arg(long, value_parser = choice::<AxisNumbers>())]
    coordinates: Option<AxisNumbers>,
    /// Unit of the file's coordinates, where it does not state it.
    #[arg(long, value_name = "TEXT")]
    unit: Option<String>,
    /// What the legend calls cells without a tensor, which are grey; `no tensor` by default.
    #[arg(long, value_name = "TEXT")]
    masked_label: Option<String>,
    /// Width of the picture in millimetres or in pixels of a .png: 85mm, 1200px.
    #[arg(long, value_name = "WIDTH", value_parser = parse_width)]
    width: Option<Length>,
    /// Pixels per inch of a .png, which states them; 192 by default.
    #[arg(long, value_name = "N", value_parser = parse_dpi)]
    dpi: Option<f64>,
    /// Size of axis numbers and legends, points; titles, lines and colour bars grow with it. 8.25 by default.
    #[arg(long, value_name = "PT", value_parser = parse_font_size)]
    font_size: Option<f64>,
}

/// What is drawn over pictures.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Pictures")]
pub(crate) struct OverlayArgs {
    /// Drawn over the picture: lines, ridges, glyphs or topology, with the default settings of these commands, or the
    /// lines and points of a .vtp; may be repeated.
    #[arg(long = "overlay", value_name = "KIND|FILE.vtp", value_parser = parse_overlay)]
    pub(crate) overlays: Vec<OverlayName>,
}

/// One thing to draw over a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum OverlayName {
    Kind(Added),
    File(PathBuf),
}

fn parse_overlay(text: &str) -> Result<OverlayName, String> {
    if let Some(kind) = Added::of_word(text) {
        return Ok(OverlayName::Kind(kind));
    }
    if text.to_ascii_lowercase().ends_with(".vtp") {
        return Ok(OverlayName::File(PathBuf::from(text)));
    }
    let words: Vec<&str> = Added::ALL.iter().map(|kind| kind.word()).collect();
    Err(format!("expected {} or a file .vtp", words.join(", ")))
}

impl StyleArgs {
    /// What the options say.
    pub(crate) fn given(&self) -> Style {
        Style {
            title: self.title.clone(),
            map: self.colour_map,
            scale: self.colour_scale,
            range: self.range,
            quantity: self.bar_label.clone(),
            x_name: self.x_label.clone(),
            y_name: self.y_label.clone(),
            numbers: self.coordinates,
            unit: self.unit.clone(),
            coordinates: None,
            masked: self.masked_label.clone(),
            width: self.width,
            font_pt: self.font_size,
            dpi: self.dpi,
        }
    }
}

/// The help of the colour maps: their names and what they are.
fn colour_maps() -> String {
    let line = |map: &ColourMap| format!("- {}: {}", map.word(), map.meaning().trim_end_matches('.'));
    let lines: Vec<String> = ColourMap::ALL.iter().map(line).collect();
    format!(
        "Colour map. All are perceptually uniform, so that equal steps look equally large.\n\n{}",
        lines.join("\n")
    )
}

fn parse_scale(text: &str) -> Result<HeatScale, String> {
    let decades = |text: &str| text.parse::<f64>().ok().filter(|d| (0.1..=300.0).contains(d));
    match text.split_once(':') {
        None if text == "linear" => Ok(HeatScale::Linear),
        None if text == "diverging" => Ok(HeatScale::Diverging),
        None if text == "logarithmic" => Ok(HeatScale::USUAL_LOGARITHMIC),
        Some(("logarithmic", number)) => decades(number)
            .map(|decades| HeatScale::Logarithmic { decades })
            .ok_or_else(|| "expected 0.1 to 300 decades, for example logarithmic:3".to_owned()),
        _ => Err("expected linear, diverging, logarithmic or logarithmic:DECADES".to_owned()),
    }
}

fn parse_range(text: &str) -> Result<ValueRange, String> {
    let expected = || "expected A:B with A below B, or percentiles such as 2%:98%".to_owned();
    let (low, high) = text.split_once(':').ok_or_else(expected)?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let range = match (low.trim().strip_suffix('%'), high.trim().strip_suffix('%')) {
        (Some(low), Some(high)) => {
            let share = |text: &str| number(text).filter(|v| (0.0..=100.0).contains(v));
            share(low).zip(share(high)).map(|(a, b)| (a, b, ValueRange::Percentiles(a, b)))
        }
        (None, None) => number(low).zip(number(high)).map(|(a, b)| (a, b, ValueRange::Values(a, b))),
        _ => None,
    };
    range.filter(|(a, b, _)| a < b).map(|(_, _, range)| range).ok_or_else(expected)
}

/// Widths that may be asked for, pixels of a PNG.
const WIDTHS_PX: RangeInclusive<f64> = 100.0..=8192.0;

fn parse_width(text: &str) -> Result<Length, String> {
    let number = |text: &str, bounds: &RangeInclusive<f64>| {
        text.trim().parse::<f64>().ok().filter(|v| bounds.contains(v))
    };
    let (mm, px) = (Style::WIDTHS_MM, WIDTHS_PX);
    let width = match (text.strip_suffix("mm"), text.strip_suffix("px")) {
        (Some(millimetres), _) => number(millimetres, &mm).map(Length::Millimetres),
        (_, Some(pixels)) => number(pixels, &px).map(Length::Pixels),
        _ => None,
    };
    let [[mm0, mm1], [px0, px1]] = [mm, px].map(|r| [*r.start(), *r.end()]);
    width.ok_or_else(|| format!("expected {mm0}mm to {mm1}mm or {px0}px to {px1}px"))
}

fn parse_dpi(text: &str) -> Result<f64, String> {
    let bounds = Style::RESOLUTIONS_DPI;
    let dpi = text.parse::<f64>().ok().filter(|v| bounds.contains(v));
    dpi.ok_or_else(|| format!("expected {} to {} pixels per inch", bounds.start(), bounds.end()))
}

fn parse_font_size(text: &str) -> Result<f64, String> {
    let bounds = Style::FONT_SIZES_PT;
    let size = text.strip_suffix("pt").unwrap_or(text).trim().parse::<f64>().ok();
    let expected = || format!("expected {} to {} points, for example 8pt", bounds.start(), bounds.end());
    size.filter(|v| bounds.contains(v)).ok_or_else(expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_spelled_as_documented() {
        assert_eq!(parse_range("-1:2.5"), Ok(ValueRange::Values(-1.0, 2.5)));
        assert_eq!(parse_range("2%:98%"), Ok(ValueRange::Percentiles(2.0, 98.0)));
        for wrong in ["", "1", "2:1", "1:1", "2%:98", "nan:1", "0:inf", "-1%:50%", "0%:101%", "a:b"] {
            assert!(parse_range(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse_width("85mm"), Ok(Length::Millimetres(85.0)));
        assert_eq!(parse_width("1200px"), Ok(Length::Pixels(1200.0)));
        for wrong in ["", "85", "mm", "5mm", "1e9px", "nanmm", "85cm"] {
            assert!(parse_width(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse_scale("logarithmic:2"), Ok(HeatScale::Logarithmic { decades: 2.0 }));
        for wrong in ["", "log", "linear:2", "logarithmic:0", "logarithmic:x"] {
            assert!(parse_scale(wrong).is_err(), "{wrong}");
        }
        assert_eq!((parse_font_size("8pt"), parse_font_size("9.5")), (Ok(8.0), Ok(9.5)));
        assert!(parse_font_size("0").is_err() && parse_dpi("0").is_err() && parse_dpi("300") == Ok(300.0));
    }
}
