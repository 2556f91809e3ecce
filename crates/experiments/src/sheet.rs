//! One page about a tensor field: ellipses, lines, anisotropy, determinant, one light, a gradient.

use thiserror::Error;
use tigereye_core::{
    Anisotropy, Cell, CellShape, CoreError, Directions, Eigenvalues, Field, Grid, PolarProfile, ProfileRule,
    Symmetry, Tensor2, TransmissionField,
};
use tigereye_fields::{FieldError, images::resampled};
use tigereye_lines::{Family, Interpolated, LineOptions, degenerate_points, ellipse_tensors, evenly_spaced};
use tigereye_ltg::{
    LtgError, LtgSettings, Shard, SweepObserver, linear_sweep_part, omega_step_of_slices, sweep,
};
use tigereye_render::{
    GlyphColour, GlyphOptions, HeatOptions, HeatScale, OrientationOptions, Overlay, Scene as Picture, glyphs,
    heat_map, orientation_map, small_multiples,
};
use tigereye_transport::{
    EightLobe, Engine, Level, Light, LinearScattering, Problem, Scattering, ScatteringRule, Scheme,
    SharedWeights, Stopping, StoppingRule, TransportError,
};
use tigereye_views::total_anisotropy::ThinCells;
use tigereye_views::{gradient as gradient_view, light, line_overlay, masked, point_overlays};

/// What a sheet shows.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetOptions {
    /// Heading.
    pub title: String,
    /// How tensors become transmission profiles.
    pub rule: ProfileRule,
    /// How a cell scatters light that arrives from several sides.
    pub scattering: ScatteringRule,
    /// The cell that shines; where nobody says, the one nearest to the middle whose tensor is not zero.
    pub light: Option<Cell>,
    /// Direction of the gradient's slice, degrees, a multiple of 22.5.
    pub slice_deg: f64,
    /// The shape of a cell. Light takes cells as squares.
    pub cell: CellShape,
    /// Instruction set of the sweep; results do not depend on it.
    pub level: Level,
}

/// What keeps a sheet from being drawn.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SheetError {
    /// A light outside of the field.
    #[error("cell ({x}, {y}) is not in the field: expected a column to {} and a row to {}", width - 1, height - 1)]
    Light {
        /// Column.
        x: usize,
        /// Row.
        y: usize,
        /// Columns of the field.
        width: usize,
        /// Rows of the field.
        height: usize,
    },
    /// A direction that is no sample.
    #[error("a slice at {deg} degrees does not exist: expected a multiple of {step} from 0 to {}", 360.0 - step)]
    Slice {
        /// Degrees asked for.
        deg: f64,
        /// Distance of the samples.
        step: f64,
    },
    /// Tensors that cannot transmit.
    #[error(transparent)]
    Field(#[from] CoreError),
    /// An invalid size.
    #[error(transparent)]
    Size(#[from] FieldError),
    /// A light that cannot be.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// A sweep that cannot start, or was interrupted.
    #[error(transparent)]
    Ltg(#[from] LtgError),
}

/// Angular samples of the light and the gradient.
const SAMPLES: usize = 16;
/// Longest side of the field that the gradient is computed of; larger ones are averaged to it, so that a sheet takes
/// seconds.
const LONGEST: usize = 31;
/// The same for the light.
const LONGEST_LIT: usize = 128;
/// Most steps of the light, and of a pulse of the gradient; light that is caught in rings would take thousands.
const STEPS: usize = 1000;
const PULSE_STEPS: usize = 200;
/// Longer side of a panel, pixels.
const PANEL_PX: usize = 480;
/// Distance of the lines in parts of the longer side.
const LINES_A_SIDE: f64 = 32.0;

/// The sheet: six panels and what is known about each.
///
/// # Errors
/// See [`SheetError`].
pub fn sheet(
    field: &Field<Tensor2>,
    options: &SheetOptions,
    observer: &dyn SweepObserver,
) -> Result<Picture, SheetError> {
    let directions = Directions::new(SAMPLES)?;
    let light = options.light.unwrap_or_else(|| usual_light(field));
    if !field.grid().contains(light) {
        let (width, height) = (field.grid().width(), field.grid().height());
        return Err(SheetError::Light { x: light.x, y: light.y, width, height });
    }
    let step = 360.0 / SAMPLES as f64;
    let sample = options.slice_deg / step;
    if sample.fract() != 0.0 || !(0.0..SAMPLES as f64).contains(&sample) {
        return Err(SheetError::Slice { deg: options.slice_deg, step });
    }
    let panels = [
        ("ellipses".to_owned(), ellipses(field, options.cell)),
        (
            "direction of the longer semi-axis, lines along it, degenerate points".to_owned(),
            lines(field, options.cell),
        ),
        ("linear anisotropy, 0 round and 1 flat".to_owned(), anisotropy(field, options.cell)),
        ("determinant".to_owned(), determinant(field, options.cell)),
        lit(field, options, directions, light)?,
        gradient(field, options, directions, sample as usize, observer)?,
    ];
    Ok(small_multiples(&panels, 2, &options.title))
}

fn anisotropy(field: &Field<Tensor2>, cell: CellShape) -> Picture {
    let quantity = "(s₁ − s₂) / (s₁ + s₂)".to_owned();
    let (range, masked) = (Some((0.0, 1.0)), masked(field));
    let options = HeatOptions { quantity, range, cell, masked, ..HeatOptions::default() };
    heat_map(&field.map(|t| Anisotropy::of(t).linear), &options)
}

/// Signs of eigenvalues say something of symmetric tensors only.
fn ellipses(field: &Field<Tensor2>, cell: CellShape) -> Picture {
    let colour =
        if Symmetry::of(field).is_symmetric() { GlyphColour::AxisSign } else { GlyphColour::Anisotropy };
    let longest = cell.longer_side([field.grid().width(), field.grid().height()]).ceil() as usize;
    let cell_px = Some((PANEL_PX / longest).clamp(1, 40));
    glyphs(field, &GlyphOptions { colour, cell_px, cell, ..GlyphOptions::default() })
}

fn determinant(field: &Field<Tensor2>, cell: CellShape) -> Picture {
    // The determinant of a singular tensor is rounding of either sign.
    let is_negative = |t: &Tensor2| t.determinant() < -Eigenvalues::ROUNDING * t.max_abs() * t.max_abs();
    let negative = field.values().iter().any(is_negative);
    let scale = if negative { HeatScale::Diverging } else { HeatScale::Linear };
    let (quantity, masked) = ("determinant".to_owned(), masked(field));
    let options = HeatOptions { quantity, scale, cell, masked, ..HeatOptions::default() };
    heat_map(&field.map(Tensor2::determinant), &options)
}

/// Lines over the directions, and points by what they are.
fn lines(field: &Field<Tensor2>, cell: CellShape) -> Picture {
    let overlays = line_overlays(field, cell);
    orientation_map(field, &OrientationOptions { overlays, cell, ..OrientationOptions::default() })
}

fn line_overlays(field: &Field<Tensor2>, cell: CellShape) -> Vec<Overlay> {
    let ellipses = ellipse_tensors(field);
    let between = Interpolated::new(&ellipses).with_cell(cell);
    let longest = cell.longer_side([field.grid().width(), field.grid().height()]);
    let separation = (longest / LINES_A_SIDE).max(0.5);
    let options =
        LineOptions { step: 0.2 * separation.min(1.0), length: 4.0 * longest, ..LineOptions::default() };
    let lines = evenly_spaced(&between, Family::Major, separation, &options);
    let mut overlays = vec![line_overlay(&lines, Family::Major, "")];
    overlays.extend(point_overlays(&degenerate_points(&ellipses)));
    overlays
}

/// The cell nearest to the middle that can pass light on.
fn usual_light(field: &Field<Tensor2>) -> Cell {
    let middle = field.grid().centre();
    let distance = |c: Cell| c.x.abs_diff(middle.x).pow(2) + c.y.abs_diff(middle.y).pow(2);
    let bright = field.iter().filter(|(_, t)| !t.is_zero()).map(|(cell, _)| cell);
    bright.min_by_key(|c| distance(*c)).unwrap_or(middle)
}

fn lit(
    field: &Field<Tensor2>,
    options: &SheetOptions,
    directions: Directions,
    at: Cell,
) -> Result<(String, Picture), SheetError> {
    let (coarse, size) = averaged(field, LONGEST_LIT)?;
    let place = |at: usize, before: usize, after: usize| (at * after / before).min(after - 1);
    let (before, after) = (field.grid(), coarse.grid());
    let source =
        Cell::new(place(at.x, before.width(), after.width()), place(at.y, before.height(), after.height()));
    let field = &coarse;
    let transmission = TransmissionField::from_tensors(field, directions, options.rule)?;
    let scheme = Scheme::new(directions, SharedWeights::Thesis).with_scattering(options.scattering);
    let rule = match options.scattering {
        ScatteringRule::Joint => StoppingRule::FluxChange { threshold: 1e-3 },
        ScatteringRule::Linear => StoppingRule::Converged { tolerance: 1e-6 },
    };
    let stopping = Stopping { rule, max_iterations: STEPS };
    let lights = [Light::continuous(source, PolarProfile::constant(directions, 1.0))];
    let problem = Problem { scheme: &scheme, transmission: &transmission, lights: &lights, stopping };
    let outcome = EightLobe.propagate(&problem)?;
    let options = HeatOptions {
        sources: vec![source],
        overlays: thin_overlays(field, options),
        cell: shape_after(options.cell, before, after),
        masked: masked(field),
        ..light::options(Some(light::DECADES))
    };
    let title = format!("light of cell ({}, {}){size}", at.x, at.y);
    Ok((title, heat_map(&outcome.distribution.energy(), &options)))
}

/// The outline of the totally anisotropic cells of a field.
fn thin_overlays(field: &Field<Tensor2>, options: &SheetOptions) -> Vec<Overlay> {
    ThinCells::of(field, options.rule.total_anisotropy).iter().map(ThinCells::overlay).collect()
}

/// The shape of cells of which there are others over the same area; what is averaged of squares stays square.
fn shape_after(cell: CellShape, before: Grid, after: Grid) -> CellShape {
    if cell == CellShape::SQUARE {
        return cell;
    }
    let [dx, dy] = cell.sides();
    let wider = before.width() as f64 / after.width() as f64;
    CellShape::of([dx * wider, dy * before.height() as f64 / after.height() as f64])
}

/// The field, or a smaller one that it is averaged to, with words that say so.
fn averaged(field: &Field<Tensor2>, most: usize) -> Result<(Field<Tensor2>, String), SheetError> {
    let (width, height) = (field.grid().width(), field.grid().height());
    let longest = width.max(height);
    if longest <= most {
        return Ok((field.clone(), String::new()));
    }
    let fit = |n: usize| (n * most).div_ceil(longest).max(1);
    let size = format!(", of the field averaged to {} × {} cells", fit(width), fit(height));
    Ok((resampled(field, fit(width), fit(height))?, size))
}

fn gradient(
    field: &Field<Tensor2>,
    options: &SheetOptions,
    directions: Directions,
    sample: usize,
    observer: &dyn SweepObserver,
) -> Result<(String, Picture), SheetError> {
    let (coarse, size) = averaged(field, LONGEST)?;
    let cell = shape_after(options.cell, field.grid(), coarse.grid());
    let field = &coarse;
    let transmission = TransmissionField::from_tensors(field, directions, options.rule)?;
    let scheme = Scheme::new(directions, SharedWeights::Thesis);
    let settings = LtgSettings {
        slices: Some(vec![sample]),
        omega_step: omega_step_of_slices(directions),
        level: options.level,
        stopping: Stopping { max_iterations: PULSE_STEPS, ..Stopping::REFERENCE },
        ..LtgSettings::reference(directions)
    };
    let scattering = Scattering::new(&scheme, &transmission);
    let outcome = match options.scattering {
        ScatteringRule::Joint => sweep(&scattering, &settings, &Shared(observer))?,
        ScatteringRule::Linear => {
            let linear = LinearScattering::new(&scattering);
            linear_sweep_part(&linear, &settings, Shard::WHOLE, None, &Shared(observer))?.into_outcome()?
        }
    };
    let slice = outcome.volume.slice(sample).unwrap_or_else(|| field.map(|_| 0.0));
    let title = format!("light transport gradient, {}°{size}", options.slice_deg);
    let options = HeatOptions {
        cell,
        overlays: thin_overlays(field, options),
        masked: masked(field),
        ..HeatOptions::default()
    };
    Ok((title, gradient_view::picture(&slice, gradient_view::Scalar::Slice, options)))
}

/// A sweep wants to know whom it talks to.
struct Shared<'a>(&'a dyn SweepObserver);

impl SweepObserver for Shared<'_> {
    fn progress(&self, done: u64, total: u64) -> core::ops::ControlFlow<()> {
        self.0.progress(done, total)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Normalization;
    use tigereye_test_support::field;

    fn options() -> SheetOptions {
        SheetOptions {
            title: "a field".to_owned(),
            rule: Normalization::Local.into(),
            scattering: ScatteringRule::Joint,
            light: None,
            slice_deg: 90.0,
            cell: CellShape::SQUARE,
            level: Level::detect(),
        }
    }

    /// Every panel is there, whatever the field; nothing hangs.
    #[test]
    fn sheets_have_six_panels() {
        for spec in
            ["wedge:size=13", "isotropic:size=5", "sink:size=7", "x:width=1,height=9", "x:width=2,height=1"]
        {
            let svg = sheet(&field(spec), &options(), &()).expect("a sheet").to_svg().expect("a picture");
            for letter in ["(a)", "(b)", "(c)", "(d)", "(e)", "(f)"] {
                assert!(svg.contains(letter), "{spec}: {letter}");
            }
        }
        let labels = |spec| {
            line_overlays(&field(spec), CellShape::SQUARE).into_iter().map(|o| o.label).collect::<Vec<_>>()
        };
        assert_eq!(labels("wedge:size=13"), ["", "wedge (index 1/2)"]);
        assert_eq!(labels("rings:size=13"), ["", "several merged, other index"]);
        assert_eq!(labels("x:size=13"), [""]);
        assert_eq!(usual_light(&field("sink:size=7")), Cell::new(3, 2));
    }

    #[test]
    fn large_fields_are_averaged_for_the_gradient() {
        let svg = sheet(&field("x:width=80,height=20"), &options(), &())
            .expect("a sheet")
            .to_svg()
            .expect("a picture");
        assert!(svg.contains("averaged to 31 × 8 cells"));
    }

    #[test]
    fn places_and_directions_that_do_not_exist_are_refused() {
        let x = field("x:size=5");
        let light = SheetOptions { light: Some(Cell::new(5, 0)), ..options() };
        assert!(matches!(sheet(&x, &light, &()), Err(SheetError::Light { .. })));
        for slice_deg in [91.0, 360.0, -22.5, f64::NAN] {
            let slice = SheetOptions { slice_deg, ..options() };
            assert!(matches!(sheet(&x, &slice, &()), Err(SheetError::Slice { .. })), "{slice_deg}");
        }
    }
}
