//! The classical methods: lines, topology, convolution, exponents, glyphs, ridges.

use crate::error::Fault;
use crate::picture::encoded;
use crate::plane::TensorPlane;
use crate::words::{self, count_within, within};
use crate::work;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods, ToPyArray};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::{Value, json};
use tigereye_core::{Choice, Field, Grid, Point, Symmetry};
use tigereye_io::{IoError, PolyData, vti, vtp};
use tigereye_lines::{
    Axes, ConvolutionOptions, Family, Following, FtleOptions, Inertia, LineOptions, Major, Method,
    RidgeOptions, TensorLine, Threshold, isolines, ridge_lines, usual_axes,
};
use tigereye_render::{
    GlyphColour, GlyphKind, GlyphOptions, GlyphScale, HeatOptions, PlainOptions, Scene, TextureOptions,
    glyphs as drawn,
};
use tigereye_views::lic::TextureRequest;
use tigereye_views::lines::{LinesRequest, Seeds};
use tigereye_views::{
    ftle as ftle_view, glyphs as glyph_view, image, lic as lic_view, lines as line_view,
    topology as topology_view,
};

/// Lines with their kind, for Python.
type NamedLines<'py> = Vec<(Bound<'py, PyArray2<f64>>, &'static str)>;

/// A picture and data, both as they are drawn or written.
#[pyclass(frozen, name = "Drawing", module = "tigereye._native")]
#[derive(Debug)]
pub(crate) struct Drawing {
    scene: Scene,
    data: Vec<u8>,
    extension: &'static str,
    arrays: Vec<(String, Field<f64>)>,
    lines: Vec<(Vec<Point>, &'static str)>,
    summary: Value,
    story: String,
}

#[pymethods]
impl Drawing {
    /// The bytes of a file in this format.
    fn encoded<'py>(&self, py: Python<'py>, format: &str) -> PyResult<Bound<'py, PyBytes>> {
        if format == self.extension {
            return Ok(PyBytes::new(py, &self.data));
        }
        let bytes = work::run_single(py, None, |_| encoded(&self.scene, format))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Extension of the file of data.
    #[getter]
    const fn extension(&self) -> &'static str {
        self.extension
    }

    /// Samples by name, shape (H, W), row 0 on top; copies.
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyArray2<f64>>)>> {
        let of = |(name, field): &(String, Field<f64>)| {
            let shape = [field.grid().height(), field.grid().width()];
            Ok((name.clone(), field.values().to_pyarray(py).reshape(shape)?))
        };
        self.arrays.iter().map(of).collect()
    }

    /// Lines with their kind: points of shape (N, 2), column and row in cells; copies.
    fn lines<'py>(&self, py: Python<'py>) -> PyResult<NamedLines<'py>> {
        let of = |(points, kind): &(Vec<Point>, &'static str)| {
            let flat: Vec<f64> = points.iter().flat_map(|p| p.to_array()).collect();
            Ok((flat.into_pyarray(py).reshape([points.len(), 2])?, *kind))
        };
        self.lines.iter().map(of).collect()
    }

    /// Numbers about the result, as JSON.
    #[getter]
    fn summary(&self) -> String {
        self.summary.to_string()
    }

    #[getter]
    fn story(&self) -> &str {
        &self.story
    }
}

/// The axes asked for, or those that are usual for such a field.
fn following(plane: &TensorPlane, axes: Option<&str>, major: Option<&str>) -> Result<Following, Fault> {
    let major = words::optional::<Major>("major", major)?;
    let axes = words::optional("axes", axes)?.unwrap_or_else(|| usual_axes(plane.field()));
    if axes == Axes::DualEigenvectors && major.is_some() {
        let problem = "changes nothing: dual eigenvectors have one order, the longer first";
        return Err(Fault::option("major", problem));
    }
    let ordered = major.map_or_else(|| axes.into(), |major| axes.by(major));
    Ok(Following { axes: ordered, cell: plane.cell() })
}

fn written(bytes: Result<Vec<u8>, IoError>) -> Result<Vec<u8>, Fault> {
    bytes.map_err(|e| Fault::Value(e.to_string()))
}

fn poly(data: &PolyData) -> Result<Vec<u8>, Fault> {
    written(vtp::write(data))
}

fn check_steps(length: f64, step: f64) -> Result<(), Fault> {
    let most = LineOptions::MAX_STEPS;
    if length / step <= most {
        return Ok(());
    }
    Err(Fault::option("length", format!("{length} cells in steps of {step}: expected at most {most} steps")))
}

fn named(lines: impl Iterator<Item = (TensorLine, Family)>) -> Vec<(Vec<Point>, &'static str)> {
    lines.map(|(line, family)| (line.points, family.word())).collect()
}

/// The options of lines, from a mapping.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct LineArguments {
    family: String,
    separation: Option<f64>,
    seeds: Vec<(f64, f64)>,
    method: String,
    step: f64,
    tolerance: Option<f64>,
    length: Option<f64>,
    least_anisotropy: f64,
    inertia: Option<f64>,
    ribbon: Option<f64>,
    axes: Option<String>,
    major: Option<String>,
    threads: Option<usize>,
}

impl LineArguments {
    fn request(&self, plane: &TensorPlane) -> Result<LinesRequest, Fault> {
        let following = following(plane, self.axes.as_deref(), self.major.as_deref())?;
        let side = following.longer_side(plane.grid());
        let [right, bottom] = [plane.grid().width() - 1, plane.grid().height() - 1];
        if let Some((x, y)) = self
            .seeds
            .iter()
            .find(|(x, y)| !((0.0..=right as f64).contains(x) && (0.0..=bottom as f64).contains(y)))
        {
            let problem =
                format!("{x},{y} is not in the field: expected X from 0 to {right} and Y from 0 to {bottom}");
            return Err(Fault::option("seed", problem));
        }
        let seeds = match (self.seeds.as_slice(), self.separation) {
            ([], separation) => {
                Seeds::Even(within("separation", separation.unwrap_or((side / 40.0).max(0.5)), 0.1, 1e4)?)
            }
            (_, Some(_)) => return Err(Fault::option("separation", "expected either separation or seeds")),
            (seeds, None) => Seeds::At(seeds.iter().map(|(x, y)| Point::new(*x, *y)).collect()),
        };
        let method = match (self.method.as_str(), self.tolerance) {
            ("rk4", None) => Method::RungeKutta4,
            ("rk4", Some(_)) => {
                return Err(Fault::option("tolerance", "is that of adaptive steps: expected rk43 or rk45"));
            }
            ("rk43", tolerance) => Method::RungeKutta43 {
                tolerance: within("tolerance", tolerance.unwrap_or(1e-6), 1e-14, 1.0)?,
            },
            ("rk45", tolerance) => Method::DormandPrince {
                tolerance: within("tolerance", tolerance.unwrap_or(1e-6), 1e-14, 1.0)?,
            },
            (other, _) => {
                return Err(Fault::option("method", format!("`{other}`: expected rk4, rk43 or rk45")));
            }
        };
        let step = within("step", self.step, 1e-3, 1e3)?;
        let length = within("length", self.length.unwrap_or(4.0 * side), 0.01, 1e4)?;
        check_steps(length, step)?;
        let inertia = self.inertia.map(|w| within("inertia", w, 0.0, 1.0)).transpose()?;
        Ok(LinesRequest {
            following,
            families: words::families(&self.family)?.to_vec(),
            seeds,
            options: LineOptions {
                method,
                step,
                length,
                least_anisotropy: within("least_anisotropy", self.least_anisotropy, 0.0, 1.0)?,
                inertia: inertia.map(|puncture| Inertia { puncture }),
            },
            ribbon: self.ribbon.map(|w| within("ribbon", w, 1e-3, 1e3)).transpose()?,
        })
    }
}

/// Tensor lines and hyperstreamlines.
#[pyfunction]
pub(crate) fn lines(py: Python<'_>, plane: &TensorPlane, options: LineArguments) -> PyResult<Drawing> {
    work::run(py, options.threads, None, |_| {
        let request = options.request(plane)?;
        let found = line_view::lines(plane.field(), &request).map_err(|e| Fault::Value(e.to_string()))?;
        let story = plane.story("lines", line_view::parameters(&request), false);
        let (title, style) = (plane.name.clone(), plane.style());
        let scene = found.picture(plane.field(), PlainOptions { title, style, ..PlainOptions::default() });
        let data = poly(&found.poly_data(&plane.placement(), &story))?;
        let summary = json!({ "lines": found.lines.len(), "length": found.length(),
            "axes": request.following.axes.axes().name(), "major": request.following.axes.major().name() });
        let lines = named(found.lines.iter().map(|l| (l.line.clone(), l.family)));
        Ok(Drawing { scene, data, extension: "vtp", arrays: Vec::new(), lines, summary, story })
    })
}

/// Degenerate points and separatrices.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of the command")]
pub(crate) fn topology(
    py: Python<'_>,
    plane: &TensorPlane,
    family: &str,
    step: f64,
    length: Option<f64>,
    axes: Option<&str>,
    major: Option<&str>,
    threads: Option<usize>,
) -> PyResult<Drawing> {
    work::run(py, threads, None, |_| {
        let following = following(plane, axes, major)?;
        let families = words::families(family)?;
        let step = within("step", step, 1e-3, 1e3)?;
        let length =
            within("length", length.unwrap_or(4.0 * following.longer_side(plane.grid())), 0.01, 1e4)?;
        check_steps(length, step)?;
        let options = LineOptions { step, length, ..LineOptions::default() };
        let found = topology_view::topology(plane.field(), following, families, &options);
        let parameters = json!({ "axes": following.axes.axes().name(), "major": following.axes.major().name(),
            "family": families.iter().map(|f| f.name()).collect::<Vec<_>>(), "step": step, "length": length });
        let story = plane.story("topology", parameters, false);
        let (title, style) = (plane.name.clone(), plane.style());
        let options = PlainOptions { title, style, ..PlainOptions::default() };
        let scene = topology_view::picture(&found, plane.field(), following, families, options);
        let data = poly(&topology_view::poly_data(&found, &plane.placement(), &story))?;
        let summary = topology_view::summary(&found, following);
        let lines = named(found.separatrices.iter().map(|s| (s.line.clone(), s.family)));
        Ok(Drawing { scene, data, extension: "vtp", arrays: Vec::new(), lines, summary, story })
    })
}

/// Noise smeared along the axes.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of the command")]
pub(crate) fn lic(
    py: Python<'_>,
    plane: &TensorPlane,
    hyper: bool,
    family: &str,
    half_length: f64,
    samples: usize,
    seed: u64,
    tint: bool,
    axes: Option<&str>,
    major: Option<&str>,
    threads: Option<usize>,
) -> PyResult<Drawing> {
    work::run(py, threads, None, |_| {
        let options = ConvolutionOptions {
            samples: count_within("samples", samples, 1, 64)?,
            half_length: within("half_length", half_length, 0.1, 100.0)?,
            seed,
        };
        let following = following(plane, axes, major)?;
        let request = TextureRequest { following, family: words::choice("family", family)?, hyper, options };
        let fault = |e: String| Fault::Value(format!("{}: {e}", plane.name));
        let found = lic_view::texture(plane.field(), &request).map_err(|e| fault(e.to_string()))?;
        let story = plane.story("lic", lic_view::parameters(&request), true);
        let (title, style) = (plane.name.clone(), plane.style());
        let look = TextureOptions { title, style, ..TextureOptions::default() };
        let scene = lic_view::picture(&found, plane.field(), &request, tint, look);
        let scene = scene.map_err(|e| fault(e.to_string()))?;
        let data = image(&[("LIC", &found)], request.samples_a_cell(), &plane.placement(), &story);
        let data = written(vti::write(&data))?;
        let summary = json!({ "samples": samples, "axes": following.axes.axes().name() });
        let arrays = vec![("LIC".to_owned(), found)];
        Ok(Drawing { scene, data, extension: "vti", arrays, lines: Vec::new(), summary, story })
    })
}

/// Finite-time Lyapunov exponent of the tensor lines.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of the command")]
pub(crate) fn ftle(
    py: Python<'_>,
    plane: &TensorPlane,
    family: &str,
    length: f64,
    samples: usize,
    step: f64,
    tolerance: f64,
    axes: Option<&str>,
    major: Option<&str>,
    threads: Option<usize>,
) -> PyResult<Drawing> {
    work::run(py, threads, None, |_| {
        let options = FtleOptions {
            length: within("length", length, 0.1, 1000.0)?,
            step: within("step", step, 0.01, 10.0)?,
            tolerance: within("tolerance", tolerance, 1e-14, 1.0)?,
            samples: count_within("samples", samples, 1, 64)?,
            ..FtleOptions::default()
        };
        let following = following(plane, axes, major)?;
        let family = words::choice::<Family>("family", family)?;
        let found = ftle_view::exponents(plane.field(), following, family, &options)
            .map_err(|e| Fault::Value(format!("{}: {e}", plane.name)))?;
        let parameters = json!({ "axes": following.axes.axes().name(), "major": following.axes.major().name(),
            "family": family.name(), "length": length, "step": step,
            "tolerance": tolerance, "samples": samples });
        let story = plane.story("ftle", parameters, true);
        let (title, style) = (plane.name.clone(), plane.style());
        let look = HeatOptions { title, style, ..HeatOptions::default() };
        let scene = ftle_view::picture(&found, plane.field(), following.axes, look);
        let arrays = [("FTLE", &found.larger), ("FTLE_smaller", &found.smaller)];
        let data = written(vti::write(&image(&arrays, [samples; 2], &plane.placement(), &story)))?;
        let summary = json!({ "samples": samples, "left": found.left, "axes": following.axes.axes().name() });
        let arrays = vec![("FTLE".to_owned(), found.larger), ("FTLE_smaller".to_owned(), found.smaller)];
        Ok(Drawing { scene, data, extension: "vti", arrays, lines: Vec::new(), summary, story })
    })
}

/// A glyph for every tensor.
#[pyfunction]
pub(crate) fn glyphs(
    py: Python<'_>,
    plane: &TensorPlane,
    kind: &str,
    gamma: Option<f64>,
    scale: &str,
    colour: Option<&str>,
    every: Option<usize>,
) -> PyResult<Drawing> {
    work::run_single(py, None, |_| {
        let asked: GlyphKind = words::choice("kind", kind)?;
        let kind = match (asked, gamma) {
            (GlyphKind::Superquadric { .. }, Some(gamma)) => {
                GlyphKind::Superquadric { gamma: within("gamma", gamma, 0.0, 100.0)? }
            }
            (_, Some(_)) => {
                return Err(Fault::option(
                    "gamma",
                    "is the sharpness of superquadrics: expected kind=\"superquadric\"",
                ));
            }
            (kind, None) => kind,
        };
        let signs = Symmetry::of(plane.field()).is_symmetric()
            || matches!(asked, GlyphKind::Signed | GlyphKind::Arrows | GlyphKind::Asymmetric);
        let usual = if signs { GlyphColour::AxisSign } else { GlyphColour::Anisotropy };
        let options = GlyphOptions {
            title: plane.name.clone(),
            kind,
            scale: words::choice::<GlyphScale>("scale", scale)?,
            colour: words::optional("colour", colour)?.unwrap_or(usual),
            every: every.map(|n| count_within("every", n, 1, 64)).transpose()?,
            cell: plane.cell(),
            style: plane.style(),
            ..GlyphOptions::default()
        };
        glyph_view::check(plane.grid(), every).map_err(|e| Fault::Value(e.to_string()))?;
        let parameters = json!({ "kind": kind.word(), "scale": scale, "every": every });
        let story = plane.story("glyphs", parameters, false);
        let scene = drawn(plane.field(), &options);
        let data = poly(&glyph_view::poly_data(plane.field(), &options, &plane.placement(), &story))?;
        let summary = json!({ "kind": kind.word() });
        Ok(Drawing { scene, data, extension: "vtp", arrays: Vec::new(), lines: Vec::new(), summary, story })
    })
}

/// Lines with value and strength at every point.
type FoundLines<'py> = Vec<(Bound<'py, PyArray2<f64>>, bool, Vec<f64>, Vec<f64>)>;

/// Height ridges of an image of shape (H, W), or contours where `contour` is a value.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of the command")]
pub(crate) fn ridges<'py>(
    py: Python<'py>,
    values: PyReadonlyArray2<'_, f64>,
    contour: Option<f64>,
    least_value: f64,
    least_strength: f64,
    least_length: f64,
    samples: Option<usize>,
    threads: Option<usize>,
) -> PyResult<FoundLines<'py>> {
    let &[height, width] = values.shape() else {
        return Err(Fault::Value("expected (H, W)".to_owned()).into());
    };
    let grid = Grid::new(width, height).map_err(|e| Fault::Value(e.to_string()))?;
    let view = values.as_array();
    let field = Field::from_fn(grid, |cell| view[[cell.y, cell.x]]);
    let (found, value, strength) = work::run(py, threads, None, |_| {
        if let Some(level) = contour {
            let level = if level.is_finite() {
                level
            } else {
                return Err(Fault::option("contour", "expected a finite number"));
            };
            let lines = isolines(&field, level);
            let value = vec![level; lines.points.len()];
            return Ok((lines, value, Vec::new()));
        }
        let options = RidgeOptions {
            samples_per_cell: count_within("samples", samples.unwrap_or(2), 1, 64)?,
            least_value: Threshold::Part(within("least_value", least_value, 0.0, 1.0)?),
            least_strength: Threshold::Part(within("least_strength", least_strength, 0.0, 1.0)?),
            least_extent: within("least_length", least_length, 0.0, 1e6)?,
            ..RidgeOptions::default()
        };
        let found = ridge_lines(&field, &options).map_err(|e| Fault::Value(e.to_string()))?;
        Ok((found.shape, found.value, found.strength))
    })?;
    let of = |line: &tigereye_lines::Polyline| {
        let indices = || line.points.iter().map(|&i| i as usize);
        let flat: Vec<f64> = indices().flat_map(|i| found.points[i].to_array()).collect();
        let points = flat.into_pyarray(py).reshape([line.points.len(), 2])?;
        let pick = |all: &[f64]| indices().filter_map(|i| all.get(i).copied()).collect();
        Ok((points, line.closed, pick(&value), pick(&strength)))
    };
    found.lines.iter().map(of).collect()
}
