//! Glyphs as VTK data.

use super::{Placement, counts, push_line, push_points, push_story};
use thiserror::Error;
use tigereye_core::{Anisotropy, Field, Grid, Tensor2};
use tigereye_io::{DataArray, PolyData};
use tigereye_render::{GlyphOptions, glyph_outlines};

/// Most glyphs of a data set: their outlines are some hundred megabytes.
pub const MAX_GLYPHS: usize = 1 << 18;

/// More glyphs than a data set may have.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("{glyphs} glyphs: expected at most {MAX_GLYPHS} in a data set (option --every)")]
pub struct TooManyGlyphs {
    glyphs: usize,
}

/// Refuses more glyphs than [`poly_data`] should make.
///
/// # Errors
/// [`TooManyGlyphs`] for more than [`MAX_GLYPHS`].
pub fn check(grid: Grid, every: Option<usize>) -> Result<(), TooManyGlyphs> {
    let every = every.unwrap_or(1).max(1);
    let glyphs = grid.width().div_ceil(every) * grid.height().div_ceil(every);
    if glyphs > MAX_GLYPHS { Err(TooManyGlyphs { glyphs }) } else { Ok(()) }
}

/// The outlines of glyphs ([`glyph_outlines`]): areas as polygons, the rest as lines. Cell arrays: `part` (0 area, 1
/// area left white, 2 line, 3 head of an arrow, 4 sector of a rotation, 5 invariant line of a reflection), `sign` (1
/// tension or counter-clockwise, -1 compression or clockwise, 0 neither or both), `column` and `row` of the tensor (row
/// 0 on top), and its linear `anisotropy`.
#[must_use]
pub fn poly_data(
    field: &Field<Tensor2>,
    options: &GlyphOptions,
    placement: &Placement,
    story: &str,
) -> PolyData {
    let (areas, lines): (Vec<_>, Vec<_>) =
        glyph_outlines(field, options).into_iter().partition(|outline| outline.closed);
    let mut data = PolyData::default();
    for line in &lines {
        push_line(&mut data, line.points.iter().map(|p| placement.place(*p)));
    }
    for area in &areas {
        let corners = push_points(&mut data, area.points.iter().map(|p| placement.place(*p)));
        data.polys.push(corners);
    }
    // Lines come before polygons.
    let all = || lines.iter().chain(&areas);
    let anisotropy = all().map(|o| Anisotropy::of(field.at(o.cell)).linear).collect();
    data.cell_arrays = vec![
        counts("part", all().map(|o| o.part as i32)),
        counts("sign", all().map(|o| i32::from(o.sign))),
        counts("column", all().map(|o| o.cell.x as i32)),
        counts("row", all().map(|o| o.cell.y as i32)),
        DataArray::new("anisotropy", 1, anisotropy),
    ];
    push_story(&mut data, story);
    data
}
