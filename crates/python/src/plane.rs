//! A tensor field in the plane, with what is known about its origin.

use crate::error::Fault;
use numpy::{IntoPyArray, PyArray4, PyArrayMethods, PyReadonlyArray4, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use tigereye_core::{Cell, CellShape, Field, Grid, Tensor2};
use tigereye_experiments::sources::defined_plane;
use tigereye_input::provenance::{hash_of_field, provenance, with_rows};
use tigereye_input::{Derivation, Derived, PlaneField, Reading, open};
use tigereye_io::Rows;
use tigereye_io::volume::{
    ComponentArrays, Crop, Frame, Plane, PlaneChoice, PlaneGeometry, Shear, parse_slice,
};
use tigereye_render::Style;
use tigereye_views::Placement;

/// Position of the lower left cell, directions right and up, spacing.
type Placed = ([f64; 3], [f64; 3], [f64; 3], [f64; 2]);

/// Tensors, and where they come from.
#[pyclass(frozen, name = "Plane", module = "tigereye._native")]
#[derive(Clone, Debug)]
pub(crate) struct TensorPlane {
    pub(crate) name: String,
    pub(crate) plane: PlaneField,
    pub(crate) blake3: String,
    kind: &'static str,
    remarks: Vec<String>,
}

impl TensorPlane {
    pub(crate) const fn field(&self) -> &Field<Tensor2> {
        &self.plane.field
    }

    pub(crate) fn grid(&self) -> Grid {
        self.plane.field.grid()
    }

    pub(crate) fn placement(&self) -> Placement {
        Placement::new(self.plane.geometry, self.grid())
    }

    pub(crate) fn cell(&self) -> CellShape {
        CellShape::of(self.plane.geometry.spacing())
    }

    /// The style of pictures: coordinates and unit of the input.
    pub(crate) fn style(&self) -> Style {
        let (coordinates, unit) = (self.placement().coordinates(), self.plane.unit.map(str::to_owned));
        Style { coordinates, unit, ..Style::default() }
    }

    /// What made a result, for the files it is saved in. `upwards`: whether their rows run upwards in any case.
    pub(crate) fn story(&self, call: &str, mut parameters: serde_json::Value, upwards: bool) -> String {
        if let Some(all) = parameters.as_object_mut() {
            all.insert("input".to_owned(), self.name.clone().into());
        }
        let rows = if upwards { Rows::Upwards } else { Rows::of_results(&self.plane.geometry) };
        provenance(&format!("tigereye.{call} (Python)"), &with_rows(parameters, rows), &self.blake3)
    }
}

#[pymethods]
impl TensorPlane {
    /// The tensors, shape (H, W, 2, 2); a copy.
    fn tensors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        let (width, height) = (self.grid().width(), self.grid().height());
        let values: Vec<f64> = self.field().values().iter().flat_map(Tensor2::components).collect();
        values.into_pyarray(py).reshape([height, width, 2, 2])
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn kind(&self) -> &'static str {
        self.kind
    }

    #[getter]
    fn blake3(&self) -> &str {
        &self.blake3
    }

    #[getter]
    fn found(&self) -> Vec<String> {
        self.plane.story.clone()
    }

    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
    }

    #[getter]
    fn unit(&self) -> Option<&'static str> {
        self.plane.unit
    }

    /// Position of the lower left cell, directions right and up, spacing; `None` where the field lies nowhere.
    #[getter]
    fn geometry(&self) -> Option<Placed> {
        let g = &self.plane.geometry;
        g.is_placed().then(|| (g.corner(), g.right(), g.up(), g.spacing()))
    }
}

/// Makes a field of a specification, `inverse:size=51`.
#[pyfunction]
#[pyo3(signature = (spec, options))]
pub(crate) fn generated(spec: &str, options: BTreeMap<String, String>) -> PyResult<TensorPlane> {
    let reading = reading(&options)?;
    let parsed = tigereye_fields::parse_spec(spec).map_err(|e| PyValueError::new_err(e.to_string()))?;
    let field = tigereye_fields::generate(&parsed.name, &parsed.arguments)
        .map_err(|e| PyValueError::new_err(e.to_string()))?;
    let story = vec!["made by a generator, row 0 on top, x right, y up".to_owned()];
    let blake3 = hash_of_field(&field);
    let plane = defined_plane(PlaneField::new(field, story), &reading).map_err(|e| Fault::input(spec, e))?;
    Ok(TensorPlane { name: spec.to_owned(), plane, blake3, kind: "generator", remarks: Vec::new() })
}

/// Names of the generators with their summaries and parameters: name, default, what is expected, meaning.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "a table, for Python")]
pub(crate) fn generators() -> Vec<(String, String, Vec<(String, String, String, String)>)> {
    let of = |p: &tigereye_fields::Parameter| {
        (p.name.to_owned(), p.kind.format(p.default), p.kind.to_string(), p.help.to_owned())
    };
    let all = tigereye_fields::generators().iter();
    all.map(|g| (g.name.to_owned(), g.summary.to_owned(), g.parameters().map(of).collect())).collect()
}

/// Reads a file of any format. Lets other threads of Python run.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, path: &str, options: BTreeMap<String, String>) -> PyResult<TensorPlane> {
    let reading = reading(&options)?;
    crate::work::run_single(py, None, |_| {
        let mut bytes_of =
            |name: &str| std::fs::read(Path::new(name)).map_err(|e| format!("{name}: reading failed: {e}"));
        let file = open(path, &reading, &mut bytes_of).map_err(|e| Fault::input(path, e))?;
        let plane = file.plane(&reading).map_err(|e| Fault::input(path, e))?;
        let mut remarks = file.remarks();
        remarks.extend(plane.remarks.iter().cloned());
        Ok(TensorPlane { name: file.name, plane, blake3: file.blake3, kind: file.kind, remarks })
    })
}

/// A field of an array of shape (H, W, 2, 2), row 0 on top; one copy. `geometry` is that of [`TensorPlane::geometry`].
#[pyfunction]
#[pyo3(signature = (array, name, geometry=None))]
pub(crate) fn of_array(
    array: PyReadonlyArray4<'_, f64>,
    name: &str,
    geometry: Option<Placed>,
) -> PyResult<TensorPlane> {
    let &[height, width, 2, 2] = array.shape() else {
        return Err(PyValueError::new_err(format!("shape {:?}: expected (H, W, 2, 2)", array.shape())));
    };
    let grid = Grid::new(width, height).map_err(|e| PyValueError::new_err(e.to_string()))?;
    let view = array.as_array();
    let field = Field::from_fn(grid, |Cell { x, y }| {
        Tensor2::new(view[[y, x, 0, 0]], view[[y, x, 0, 1]], view[[y, x, 1, 0]], view[[y, x, 1, 1]])
    });
    if let Some(Cell { x, y }) = field.first_non_finite() {
        return Err(PyValueError::new_err(format!(
            "the tensor in row {y}, column {x} is not finite: expected finite components, or not_finite=\"zero\""
        )));
    }
    let mut plane =
        PlaneField::new(field, vec!["an array of Python, row 0 on top, x right, y up".to_owned()]);
    if let Some((corner, right, up, spacing)) = geometry {
        let numbers = corner.iter().chain(&right).chain(&up).chain(&spacing);
        let is_sound = |d: [f64; 3]| d.iter().map(|v| v * v).sum::<f64>() > 0.0;
        if numbers.clone().any(|v| !v.is_finite())
            || spacing.iter().any(|s| *s <= 0.0)
            || !is_sound(right)
            || !is_sound(up)
        {
            return Err(PyValueError::new_err(
                "geometry: expected finite positions, directions of some length and spacings above 0",
            ));
        }
        plane.geometry = PlaneGeometry::new(corner, right, up, spacing);
    }
    let blake3 = hash_of_field(&plane.field);
    Ok(TensorPlane { name: name.to_owned(), plane, blake3, kind: "array", remarks: Vec::new() })
}

/// The options of reading, by their names on the command line.
fn reading(options: &BTreeMap<String, String>) -> Result<Reading, Fault> {
    let mut reading = Reading::default();
    let (mut sigma, mut window, mut kind) = (None, None, None);
    for (name, text) in options {
        let fault = |expected: &str| Fault::option(name, format!("`{text}`: expected {expected}"));
        let number = || text.parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0);
        match name.as_str() {
            "array" => reading.array = Some(text.clone()),
            "components" => {
                reading.components = Some(ComponentArrays::parse(text).map_err(|e| Fault::option(name, e))?);
            }
            "order" => reading.order = Some(text.clone()),
            "shear" => {
                reading.shear = Some(match text.as_str() {
                    "tensor" => Shear::Tensor,
                    "engineering" => Shear::Engineering,
                    _ => return Err(fault("tensor or engineering")),
                });
            }
            "frame" => {
                let all = [Frame::Voxel, Frame::World, Frame::Measurement, Frame::Fsl, Frame::Lps];
                let found = all.into_iter().find(|f| f.name() == text);
                reading.frame = Some(found.ok_or_else(|| fault("voxel, world, measurement, fsl or lps"))?);
            }
            "slice" => {
                reading.choice = PlaneChoice {
                    slice: Some(parse_slice(text).map_err(|e| Fault::option(name, e))?),
                    ..reading.choice
                }
            }
            "plane" => {
                let found = [Plane::Xy, Plane::Xz, Plane::Yz].into_iter().find(|p| p.name() == text);
                let plane = Some(found.ok_or_else(|| fault("xy, xz or yz"))?);
                reading.choice = PlaneChoice { plane, ..reading.choice };
            }
            "crop" => reading.crop = Some(Crop::parse(text).map_err(|e| Fault::option(name, e))?),
            "resample" => {
                let sides =
                    text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
                let sides = sides.filter(|s: &[usize; 2]| !s.contains(&0));
                reading.resample = Some(sides.ok_or_else(|| fault("WIDTHxHEIGHT, for example 64x48"))?);
            }
            "derive" => {
                let found = Derived::from_name(text);
                kind = Some(
                    found.ok_or_else(|| fault("gradient, strain-rate, hessian, structure or orientation"))?,
                );
            }
            "sigma" | "window" => {
                let most = tigereye_fields::images::MAX_SIGMA;
                let cells = number().filter(|v| *v <= most);
                let cells = Some(cells.ok_or_else(|| fault(&format!("a number of cells from 0 to {most}")))?);
                if name == "sigma" { sigma = cells } else { window = cells }
            }
            "mask" => reading.mask = Some(text.clone()),
            "mask_array" => reading.mask_array = Some(text.clone()),
            "mask_above" => reading.mask_above = number().ok_or_else(|| fault("a finite number from 0"))?,
            "not_finite" => {
                reading.zero_not_finite = match text.as_str() {
                    "refuse" => false,
                    "zero" => true,
                    _ => return Err(fault("refuse or zero")),
                };
            }
            "limit" => reading.limit = Some(text.parse().map_err(|_| fault("a whole number from 0"))?),
            _ => return Err(Fault::Value(format!("{name}: there is no such option of reading"))),
        }
    }
    if kind.is_none() && (sigma.is_some() || window.is_some()) {
        return Err(Fault::Value("sigma and window belong to derive: expected derive=...".to_owned()));
    }
    reading.derive =
        kind.map(|kind| Derivation { kind, sigma: sigma.unwrap_or_else(|| kind.usual_sigma()), window });
    Ok(reading)
}
