//! Tensor lines and hyperstreamlines.

use super::{Placement, counts, line_overlay, plain_options, push_line, push_story};
use thiserror::Error;
use tigereye_core::{Field, Point, Tensor2};
use tigereye_io::{DataArray, PolyData};
use tigereye_lines::{
    Family, LineEnd, LineOptions, MAX_POINTS, TensorLine, evenly_spaced, half_widths, tensor_line,
};
use tigereye_lines::{Followed, Following};
use tigereye_render::{PlainOptions, Rgba, Ribbon, Scene, plain_map};

/// Colours of major and minor bands.
const RIBBONS: [Rgba; 2] = [Rgba::hex(0x0072b2), Rgba::hex(0xd55e00)];

/// The seeds of lines.
#[derive(Clone, Debug, PartialEq)]
pub enum Seeds {
    /// Evenly spaced over the field, with this separation, in units of the smaller side of a cell.
    Even(f64),
    /// At these points.
    At(Vec<Point>),
}

/// Which lines of a field.
#[derive(Clone, Debug, PartialEq)]
pub struct LinesRequest {
    /// The axes to follow, over which cells.
    pub following: Following,
    /// One family or both.
    pub families: Vec<Family>,
    /// Their seeds.
    pub seeds: Seeds,
    /// How they are integrated.
    pub options: LineOptions,
    /// Half of a hyperstreamline's width, in units of the smaller side of a cell, for the largest semi-axis, or
    /// eigenvalue, of the field; `None` for plain lines.
    pub ribbon: Option<f64>,
}

/// Lines with their data.
#[derive(Clone, Debug)]
pub struct FieldLines {
    /// The lines, one family after the other.
    pub lines: Vec<FieldLine>,
    followed: Followed,
}

/// A line of a family.
#[derive(Clone, Debug)]
pub struct FieldLine {
    /// The family.
    pub family: Family,
    /// Its points and ends.
    pub line: TensorLine,
    /// Half of its width at every point, in units of the smaller side of a cell; empty for plain lines.
    pub half_widths: Vec<f64>,
}

/// Lines of more points together than can be drawn and written.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error(
    "the lines have more than {MAX_POINTS} points together: expected fewer or shorter lines, or longer steps"
)]
pub struct TooManyPoints;

/// Follows the requested lines. Seeds at degenerate tensors give no line.
///
/// # Errors
/// [`TooManyPoints`] for more than [`MAX_POINTS`].
pub fn lines(field: &Field<Tensor2>, request: &LinesRequest) -> Result<FieldLines, TooManyPoints> {
    let followed = Followed::new(field, request.following);
    let between = followed.interpolated();
    let scale = request.ribbon.map(|widest| {
        let values = field.values().iter().filter_map(|t| request.following.axes.values(t)).flatten();
        let largest = values.map(f64::abs).fold(0.0, f64::max);
        if largest > 0.0 { widest / largest } else { 0.0 }
    });
    let (mut lines, mut points) = (Vec::new(), 0);
    for &family in &request.families {
        let found: Box<dyn Iterator<Item = TensorLine>> = match &request.seeds {
            Seeds::Even(separation) => {
                Box::new(evenly_spaced(&between, family, *separation, &request.options).into_iter())
            }
            Seeds::At(seeds) => Box::new(
                seeds
                    .iter()
                    .map(|&seed| tensor_line(&between, seed, family, &request.options, &mut |_| true))
                    .filter(|line| line.points.len() > 1),
            ),
        };
        for line in found {
            points += line.points.len();
            if points > MAX_POINTS {
                return Err(TooManyPoints);
            }
            let half_widths = scale.map(|s| half_widths(&between, &line, family, s)).unwrap_or_default();
            lines.push(FieldLine { family, line, half_widths });
        }
    }
    Ok(FieldLines { lines, followed })
}

impl FieldLines {
    /// The lines on white, below the overlays of `options`; cells without a tensor are grey.
    #[must_use]
    pub fn picture(&self, field: &Field<Tensor2>, options: PlainOptions) -> Scene {
        let overlays = [Family::Major, Family::Minor].into_iter().filter_map(|family| {
            let lines: Vec<&TensorLine> =
                self.lines.iter().filter(|l| l.family == family).map(|l| &l.line).collect();
            let label = format!("{} lines: {}", family.name(), self.following().axes.words());
            (!lines.is_empty()).then(|| line_overlay(lines, family, &label))
        });
        let overlays = overlays.chain(options.overlays.iter().cloned()).collect();
        let options = PlainOptions { overlays, ribbons: self.ribbons(), ..options };
        plain_map(field.grid(), &plain_options(field, self.following(), "Tensor lines", options))
    }

    fn ribbons(&self) -> Vec<Ribbon> {
        let mut ribbons: [Ribbon; 2] = RIBBONS.map(|colour| Ribbon { colour, ..Ribbon::default() });
        for line in self.lines.iter().filter(|l| !l.half_widths.is_empty()) {
            let ribbon = &mut ribbons[line.family as usize];
            ribbon.points.extend(&line.line.points);
            ribbon.half_widths.extend(&line.half_widths);
            ribbon.points.push(Point::splat(f64::NAN));
            ribbon.half_widths.push(f64::NAN);
        }
        ribbons.into_iter().filter(|r| !r.points.is_empty()).collect()
    }

    const fn following(&self) -> Following {
        self.followed.following()
    }

    /// Length of all lines together, in units of the smaller side of a cell.
    #[must_use]
    pub fn length(&self) -> f64 {
        let cell = self.following().cell;
        // The sum of nothing is -0.
        self.lines.iter().map(|l| l.line.length(cell)).sum::<f64>() + 0.0
    }

    /// The lines as polylines. Point arrays: `values` (both half-lengths or eigenvalues, major first) and, for
    /// hyperstreamlines, `half_width` (in the unit of the smaller cell side). Cell arrays: `family` (0 major, 1 minor)
    /// and `ends` (why a line ends: 0 border, 1 degenerate, 2 length, 3 closed, 4 stopped beside another line).
    #[must_use]
    pub fn poly_data(&self, placement: &Placement, story: &str) -> PolyData {
        let mut data = PolyData::default();
        let between = self.followed.interpolated();
        let [dx, dy] = placement.geometry().spacing();
        let unit = dx.min(dy);
        let (mut values, mut widths) = (Vec::new(), Vec::new());
        for line in &self.lines {
            push_line(&mut data, line.line.points.iter().map(|p| placement.place(*p)));
            for p in &line.line.points {
                let found = between.at(*p).and_then(|t| between.axes().values(&t));
                values.extend(found.unwrap_or([f64::NAN; 2]));
            }
            widths.extend(line.half_widths.iter().map(|w| w * unit));
        }
        data.point_arrays.push(DataArray::new("values", 2, values).with_component_names(&["major", "minor"]));
        if widths.len() == data.points.len() && !widths.is_empty() {
            data.point_arrays.push(DataArray::new("half_width", 1, widths));
        }
        data.cell_arrays.push(counts("family", self.lines.iter().map(|l| l.family as i32)));
        let ends = self.lines.iter().flat_map(|l| l.line.ends.map(end_number));
        let ends = counts("ends", ends);
        data.cell_arrays.push(DataArray { components: 2, ..ends }.with_component_names(&["first", "last"]));
        push_story(&mut data, story);
        data
    }
}

const fn end_number(end: LineEnd) -> i32 {
    match end {
        LineEnd::Border => 0,
        LineEnd::Degenerate => 1,
        LineEnd::Length => 2,
        LineEnd::Closed => 3,
        LineEnd::Stopped => 4,
    }
}

/// The parameters of a request, for provenance.
#[must_use]
pub fn parameters(request: &LinesRequest) -> serde_json::Value {
    use tigereye_lines::Method;
    let seeds = match &request.seeds {
        Seeds::Even(separation) => serde_json::json!({ "separation": separation }),
        Seeds::At(points) => {
            serde_json::json!(points.iter().map(|p| p.to_array()).collect::<Vec<_>>())
        }
    };
    let o = &request.options;
    let (method, tolerance) = match o.method {
        Method::RungeKutta4 => ("rk4", None),
        Method::RungeKutta43 { tolerance } => ("rk43", Some(tolerance)),
        Method::DormandPrince { tolerance } => ("rk45", Some(tolerance)),
    };
    serde_json::json!({
        "axes": request.following.axes.axes().name(),
        "major": request.following.axes.major().name(),
        "family": request.families.iter().map(|f| f.name()).collect::<Vec<_>>(),
        "seeds": seeds,
        "method": method,
        "tolerance": tolerance,
        "step": o.step,
        "length": o.length,
        "least_anisotropy": o.least_anisotropy,
        "inertia": o.inertia.map(|i| i.puncture),
        "ribbon": request.ribbon,
    })
}
