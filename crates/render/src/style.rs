//! How a picture looks, whatever it shows: heading, colours, range, axes and size.

use crate::colour::ColourMap;
use crate::error::RenderError;
use crate::legend::SMALL_PX;
use crate::scale::HeatScale;
use crate::scene::Scene;
use core::ops::RangeInclusive;
use tigereye_core::choice;

/// What of a picture may be chosen; what is `None` is as the picture itself has it.
///
/// Every picture on the axes of a grid takes one. Pictures without a colour bar have no use for `map`, `scale`, `range`
/// and `quantity`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Style {
    /// Heading; empty for none.
    pub title: Option<String>,
    /// Colour map.
    pub map: Option<ColourMap>,
    /// Linear, logarithmic or diverging.
    pub scale: Option<HeatScale>,
    /// Values at the ends of the colour bar.
    pub range: Option<ValueRange>,
    /// Quantity with its unit, beside the colour bar.
    pub quantity: Option<String>,
    /// Name of the horizontal axis with its unit.
    pub x_name: Option<String>,
    /// Name of the vertical axis with its unit.
    pub y_name: Option<String>,
    /// What the axes are marked with; coordinates by default where there are some.
    pub numbers: Option<AxisNumbers>,
    /// Unit of the coordinates.
    pub unit: Option<String>,
    /// Coordinates of columns and rows, where the data has some.
    pub coordinates: Option<[Coordinates; 2]>,
    /// What grey cells, those without a tensor, are called; `no tensor` by default.
    pub masked: Option<String>,
    /// Width of the whole picture; the map takes what titles, axes and colour bar leave.
    pub width: Option<Length>,
    /// Size of axis numbers and legends, points (1/72 inch); everything but the map grows with it. 8.25 by default.
    pub font_pt: Option<f64>,
    /// Pixels per inch of a PNG; [`Style::DPI`] by default.
    pub dpi: Option<f64>,
}

/// What the colours of a picture show, which decides on the settings that it has a use for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colours {
    /// Values, beside a colour bar.
    Values,
    /// A quantity with a range of its own.
    Quantity,
    /// Directions, in a cyclic map.
    Directions,
    /// Kinds of things, which have colours of their own.
    Kinds,
}

/// What the axes of a map are marked with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisNumbers {
    /// Numbers of columns and rows.
    Cells,
    /// Coordinates.
    File,
}

choice!(AxisNumbers {
    Cells = "cells": "Columns and rows from 0, row 0 on top.",
    File = "file": "The file's coordinates, where it has some.",
});

/// Values at the ends of a colour bar. Those beyond have the colours of the ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ValueRange {
    /// These values, the lower first.
    Values(f64, f64),
    /// The values below which so many per cent of all values lie, from 0 to 100, the lower first. Values that cannot be
    /// drawn are left out, and on a logarithmic scale those that are not positive.
    Percentiles(f64, f64),
}

/// A length on paper or on a screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Length {
    /// Millimetres.
    Millimetres(f64),
    /// Pixels of a PNG.
    Pixels(f64),
}

/// Positions along an axis of a grid: cell `i` has its centre at `first + i * step`.
#[derive(Debug, Clone, PartialEq)]
pub struct Coordinates {
    /// Name of the axis without unit.
    pub name: String,
    /// Coordinate of the centre of cell 0, the leftmost column or the uppermost row.
    pub first: f64,
    /// From one cell to the next; negative where coordinates fall.
    pub step: f64,
}

/// Relative difference of two widths that counts as rounding.
const ROUNDING: f64 = 1e-9;
/// Points per inch.
const POINTS_AN_INCH: f64 = 72.0;
/// Millimetres per inch.
const MM_AN_INCH: f64 = 25.4;

impl Style {
    /// Resolution of a PNG for which nobody asks otherwise: two pixels for each of the page.
    pub const DPI: f64 = 192.0;
    /// Widths that may be asked for, millimetres.
    pub const WIDTHS_MM: RangeInclusive<f64> = 20.0..=2000.0;
    /// Font sizes that may be asked for, points.
    pub const FONT_SIZES_PT: RangeInclusive<f64> = 2.0..=72.0;
    /// Resolutions that may be asked for, pixels per inch.
    pub const RESOLUTIONS_DPI: RangeInclusive<f64> = 10.0..=2400.0;

    /// What `self` leaves open as in `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            title: self.title.or(other.title),
            map: self.map.or(other.map),
            scale: self.scale.or(other.scale),
            range: self.range.or(other.range),
            quantity: self.quantity.or(other.quantity),
            x_name: self.x_name.or(other.x_name),
            y_name: self.y_name.or(other.y_name),
            numbers: self.numbers.or(other.numbers),
            unit: self.unit.or(other.unit),
            coordinates: self.coordinates.or(other.coordinates),
            masked: self.masked.or(other.masked),
            width: self.width.or(other.width),
            font_pt: self.font_pt.or(other.font_pt),
            dpi: self.dpi.or(other.dpi),
        }
    }

    /// The first setting that a picture with such colours has no use for, by its name in files, and what it would need.
    #[must_use]
    pub fn useless(&self, colours: Colours) -> Option<(&'static str, &'static str)> {
        let has_bar = matches!(colours, Colours::Values | Colours::Quantity);
        let cyclic = self.map.is_none_or(ColourMap::is_cyclic);
        let bar = "a picture with a colour bar";
        let values = "a picture of values with a colour bar";
        [
            (self.map.is_some() && colours == Colours::Kinds, "colour_map", bar),
            (!cyclic && colours == Colours::Directions, "colour_map", "a cyclic map for directions"),
            (self.quantity.is_some() && !has_bar, "bar_label", bar),
            (self.scale.is_some() && colours != Colours::Values, "colour_scale", values),
            (self.range.is_some() && colours != Colours::Values, "range", values),
        ]
        .into_iter()
        .find_map(|(is_useless, setting, expected)| is_useless.then_some((setting, expected)))
    }

    /// Refuses a picture that had to become wider than asked for.
    ///
    /// # Errors
    /// [`RenderError::Narrow`].
    pub fn check_width(&self, scene: &Scene) -> Result<(), RenderError> {
        let mm = |pt: f64| pt * MM_AN_INCH / POINTS_AN_INCH;
        let least_mm = mm(scene.width_px * scene.pt_per_px);
        match self.width_pt().map(mm) {
            Some(asked_mm) if least_mm > asked_mm * (1.0 + ROUNDING) => {
                Err(RenderError::Narrow { asked_mm, least_mm })
            }
            _ => Ok(()),
        }
    }

    /// A finished picture in the size asked for, together with everything in it.
    #[must_use]
    pub fn fitted(&self, mut scene: Scene) -> Scene {
        scene.pt_per_px = match self.width_pt() {
            Some(width_pt) => width_pt / scene.width_px,
            None => self.pt_per_px(),
        };
        scene.on_paper |= self.width.is_some() || self.font_pt.is_some();
        scene
    }

    /// The heading, or the picture's own.
    pub(crate) fn title_or<'a>(&'a self, own: &'a str) -> &'a str {
        self.title.as_deref().unwrap_or(own)
    }

    /// The coordinates that the axes are marked with.
    pub(crate) fn marked(&self) -> Option<&[Coordinates; 2]> {
        self.coordinates.as_ref().filter(|_| self.numbers != Some(AxisNumbers::Cells))
    }

    /// A name with the unit of the coordinates.
    pub(crate) fn with_unit(&self, name: &str) -> String {
        match self.unit.as_deref() {
            None | Some("") => name.to_owned(),
            Some(unit) => format!("{name} ({unit})"),
        }
    }

    /// Points per pixel of the page.
    pub(crate) fn pt_per_px(&self) -> f64 {
        self.font_pt.map_or(crate::scene::PT_PER_PX, |pt| pt / SMALL_PX)
    }

    /// Pixels of a PNG per pixel of the page where a size was chosen, otherwise 1.
    pub(crate) fn fineness(&self) -> f64 {
        match self.width {
            Some(_) => self.dpi.unwrap_or(Self::DPI) / POINTS_AN_INCH * self.pt_per_px(),
            None => 1.0,
        }
    }

    /// Width of the page in pixels of the page.
    pub(crate) fn width_px(&self) -> Option<f64> {
        self.width_pt().map(|width_pt| width_pt / self.pt_per_px())
    }

    fn width_pt(&self) -> Option<f64> {
        let inches = match self.width? {
            Length::Millimetres(mm) => mm / MM_AN_INCH,
            Length::Pixels(pixels) => pixels / self.dpi.unwrap_or(Self::DPI),
        };
        Some(inches * POINTS_AN_INCH)
    }
}

impl ValueRange {
    /// The ends for these values, of which those that are not finite are left out; `None` where there is no range.
    pub(crate) fn ends(self, values: &[f64], positive: bool) -> Option<(f64, f64)> {
        let (low, high) = match self {
            Self::Values(low, high) => (low, high),
            Self::Percentiles(low, high) => {
                let drawn = |v: &f64| v.is_finite() && (!positive || *v > 0.0);
                let mut sorted: Vec<f64> = values.iter().copied().filter(drawn).collect();
                sorted.sort_unstable_by(f64::total_cmp);
                (percentile(&sorted, low)?, percentile(&sorted, high)?)
            }
        };
        (low.is_finite() && high.is_finite() && low < high).then_some((low, high))
    }
}

/// The value with `per_cent` of all values below it, between neighbours on the straight line.
fn percentile(sorted: &[f64], per_cent: f64) -> Option<f64> {
    let at = (per_cent / 100.0).clamp(0.0, 1.0) * sorted.len().checked_sub(1)? as f64;
    let (below, above) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    // Both factors from 0 to 1: no difference of huge numbers.
    Some(below * (1.0 - at.fract()) + above * at.fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_leave_out_what_is_not_drawn() {
        let values = [f64::NAN, -1.0, 0.0, 1.0, 2.0, 3.0, f64::INFINITY];
        let ends = |range: ValueRange, positive| range.ends(&values, positive);
        assert_eq!(ends(ValueRange::Percentiles(0.0, 100.0), false), Some((-1.0, 3.0)));
        assert_eq!(ends(ValueRange::Percentiles(25.0, 75.0), false), Some((0.0, 2.0)));
        assert_eq!(ends(ValueRange::Percentiles(0.0, 50.0), true), Some((1.0, 2.0)));
        assert_eq!(ends(ValueRange::Percentiles(50.0, 50.0), false), None);
        assert_eq!(ends(ValueRange::Values(0.5, 4.0), true), Some((0.5, 4.0)));
        assert_eq!(ends(ValueRange::Values(4.0, 0.5), true), None);
        assert_eq!(ValueRange::Percentiles(0.0, 100.0).ends(&[f64::NAN], false), None);
    }

    #[test]
    fn widths_on_paper_and_in_pixels_agree() {
        let style = |width, font_pt, dpi| Style { width: Some(width), font_pt, dpi, ..Style::default() };
        // Rounding of some hundred pixels.
        let near = |a: Option<f64>, b: f64| a.is_some_and(|a| (a - b).abs() < 1e-9);
        assert!(near(style(Length::Millimetres(25.4), None, None).width_px(), 96.0));
        assert!(near(style(Length::Pixels(192.0), None, None).width_px(), 96.0));
        assert!(near(style(Length::Pixels(600.0), None, Some(600.0)).width_px(), 96.0));
        assert!(near(style(Length::Millimetres(25.4), Some(11.0), None).width_px(), 72.0));
        assert_eq!(Style::default().width_px(), None);
    }

    #[test]
    fn what_is_open_is_taken_from_the_other() {
        let a = Style { map: Some(ColourMap::Batlow), ..Style::default() };
        let b = Style { map: Some(ColourMap::Vik), dpi: Some(300.0), ..Style::default() };
        let both = a.or(b);
        assert_eq!((both.map, both.dpi), (Some(ColourMap::Batlow), Some(300.0)));
    }
}
