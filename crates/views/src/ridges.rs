//! Height ridges and contours of scalar images.

use super::{Placement, gradient, push_line, push_story};
use serde_json::Value;
use thiserror::Error;
use tigereye_core::{Cell, CellShape, Field, Grid, Point, math};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{DataArray, ImageData, IoError, LTG_ARRAY, PROVENANCE, PolyData, Rows};
use tigereye_lines::{
    ExtractionError, Polyline, Polylines, RidgeOptions, Surface, Volume, isolines, isosurface, ridge_lines,
    ridge_surface,
};
use tigereye_render::{HeatOptions, Overlay, Rgba, Scene, heat_map};

/// Largest number of samples per side of a cell that the commands make.
const MAX_SAMPLES_A_CELL: usize = 64;

/// Why ridges or contours of an image cannot be found.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RidgesError {
    /// There is no array of scalars, or none of the given name.
    #[error("expected an array of one number per point{}, found {found}", wanted.as_ref().map_or(String::new(), |w| format!(" called {w}")))]
    NoArray {
        /// The name asked for.
        wanted: Option<String>,
        /// The available arrays.
        found: String,
    },
    /// Several arrays of single numbers.
    #[error("several arrays of one number per point: {found} (option --array)")]
    Ambiguous {
        /// Their names.
        found: String,
    },
    /// A layer that is not there.
    #[error("layer {layer}: expected 0 to {last}")]
    Layer {
        /// The layer asked for.
        layer: usize,
        /// The last one.
        last: usize,
    },
    /// The image is inconsistent.
    #[error(transparent)]
    Io(#[from] IoError),
    /// Options or sizes that cannot be.
    #[error(transparent)]
    Extraction(#[from] ExtractionError),
}

/// One number at every point of an image.
#[derive(Clone, Debug)]
pub struct ScalarImage {
    /// Name of the array.
    pub array: String,
    /// Layer by layer with row 0 on top, whatever the order of the file.
    values: Vec<f64>,
    size: [usize; 3],
    /// Whether the third axis is periodic: the full circle of directions of a gradient.
    periodic: bool,
    /// Whether it is a gradient, whose third axis is a direction.
    is_gradient: bool,
    /// Whether it is the mean of several layers.
    is_mean: bool,
    /// The direction in which the rows of the file run.
    rows: Rows,
    /// Samples per side of a cell; more than 1 in images that this program sampled more finely.
    samples_a_cell: usize,
    origin: [f64; 3],
    /// From an index of the file to a position in the world, one column per axis.
    axes: [[f64; 3]; 3],
}

impl ScalarImage {
    /// The array of a name, or the only one; gradients by theirs. The border of a gradient, 0 by definition, is
    /// missing.
    ///
    /// # Errors
    /// [`RidgesError::NoArray`], [`RidgesError::Ambiguous`].
    pub fn of(image: &ImageData, wanted: Option<&str>) -> Result<Self, RidgesError> {
        let scalars: Vec<&DataArray> = image.point_arrays.iter().filter(|a| a.components == 1).collect();
        let names =
            |arrays: &[&DataArray]| arrays.iter().map(|a| a.name.as_str()).collect::<Vec<_>>().join(", ");
        let missing = || {
            let all: Vec<&DataArray> = image.point_arrays.iter().collect();
            let found = if all.is_empty() { "none".to_owned() } else { names(&all) };
            RidgesError::NoArray { wanted: wanted.map(str::to_owned), found }
        };
        let wanted = wanted.or_else(|| scalars.iter().find(|a| a.name == LTG_ARRAY).map(|_| LTG_ARRAY));
        let array = match (wanted, &scalars[..]) {
            (Some(name), all) => *all.iter().find(|a| a.name == name).ok_or_else(missing)?,
            (None, [array]) => *array,
            (None, []) => return Err(missing()),
            (None, several) => return Err(RidgesError::Ambiguous { found: names(several) }),
        };
        let is_gradient = array.name == LTG_ARRAY;
        let [width, height, depth] = image.dimensions;
        let rows = Rows::of(image, &array.name);
        let mut values = rows.from_top(&array.values, [width, height], 1);
        if is_gradient && width > 0 && height > 0 {
            for (i, v) in values.iter_mut().enumerate() {
                let (x, y) = (i % width, i / width % height);
                if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
                    *v = f64::NAN;
                }
            }
        }
        let whole = image.numbers(tigereye_io::SLICES).is_none();
        let d = image.direction.unwrap_or([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        let axes = [0, 1, 2].map(|axis| [0, 1, 2].map(|row| d[3 * row + axis] * image.spacing[axis]));
        Ok(Self {
            array: array.name.clone(),
            values,
            size: image.dimensions,
            periodic: is_gradient && whole && depth > 1,
            is_gradient,
            is_mean: false,
            rows,
            samples_a_cell: if is_gradient { 1 } else { samples_a_cell(image) },
            origin: image.origin,
            axes,
        })
    }

    /// The mean over the layers: of a gradient, over its directions.
    #[must_use]
    pub fn mean(self) -> Self {
        let [width, height, depth] = self.size;
        let cells = width * height;
        let sum = |i: usize| (0..depth).map(|layer| self.values[layer * cells + i]).sum::<f64>();
        let values = (0..cells).map(|i| sum(i) / depth as f64).collect();
        Self { values, size: [width, height, 1], periodic: false, is_mean: depth > 1, ..self }
    }

    /// Layers along the third axis.
    #[must_use]
    pub const fn layers(&self) -> usize {
        self.size[2]
    }

    /// Whether the third axis holds the full circle of directions of a gradient.
    #[must_use]
    pub const fn is_periodic(&self) -> bool {
        self.periodic
    }

    /// The sides of a cell in the unit of the smaller of the first two. The third is `third` where it is given,
    /// otherwise the file's, and 1 for the directions of a gradient: degrees have no length.
    #[must_use]
    pub fn cell(&self, third: Option<f64>) -> [f64; 3] {
        let sides = self.axes.map(|[x, y, z]| math::hypot(math::hypot(x, y), z));
        let [dx, dy] = self.shape().sides();
        let smaller = sides[0].min(sides[1]);
        let own = sides[2] / smaller;
        let is_length = !self.is_gradient && own > 0.0 && own.is_finite();
        [dx, dy, third.unwrap_or(if is_length { own } else { 1.0 })]
    }

    /// The shape of a cell of a layer.
    #[must_use]
    pub fn shape(&self) -> CellShape {
        let [dx, dy] = [self.axes[0], self.axes[1]].map(|[x, y, z]| math::hypot(math::hypot(x, y), z));
        CellShape::of([dx, dy])
    }

    /// One layer.
    ///
    /// # Errors
    /// [`RidgesError::Layer`] for one that is not there.
    pub fn layer(&self, layer: usize) -> Result<Field<f64>, RidgesError> {
        let [width, height, depth] = self.size;
        if layer >= depth {
            return Err(RidgesError::Layer { layer, last: depth.saturating_sub(1) });
        }
        let grid = Grid::new(width, height).map_err(IoError::from)?;
        let first = layer * grid.cells();
        Ok(Field::from_fn(grid, |c: Cell| self.values[first + grid.index(c)]))
    }

    /// Where the cells of a layer lie; nowhere in images of cells without a place.
    #[must_use]
    pub fn placement(&self) -> Option<Placement> {
        let [width, height, _] = self.size;
        let samples = self.samples_a_cell;
        let cells = Grid::new((width - 1).div_ceil(samples) + 1, (height - 1).div_ceil(samples) + 1).ok()?;
        let length = |v: [f64; 3]| math::hypot(math::hypot(v[0], v[1]), v[2]);
        let [[right, dx], [up, dy]] = [0, 1].map(|axis| {
            let side = length(self.axes[axis]);
            [self.axes[axis].map(|v| v / side), [side * samples as f64; 3]]
        });
        let lower = match self.rows {
            Rows::Upwards => self.origin,
            Rows::Downwards => return None,
        };
        let geometry = PlaneGeometry::new(lower, right, up, [dx[0], dy[0]]);
        let is_plain = geometry == PlaneGeometry::new([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0; 2]);
        (!is_plain).then(|| Placement::new(geometry, cells))
    }

    /// The quantity with its unit, as far as the array is one of this program's.
    fn quantity(&self) -> String {
        match self.array.as_str() {
            _ if self.is_gradient && self.is_mean => gradient::Scalar::Mean.label(),
            _ if self.is_gradient => gradient::Scalar::Slice.label(),
            "FTLE" | "FTLE_smaller" if self.samples_a_cell > 1 => format!("{} / (1/cell)", self.array),
            name => name.to_owned(),
        }
    }

    fn volume(&self) -> Result<Volume<'_>, ExtractionError> {
        Volume::new(&self.values, self.size, [false, false, self.periodic])
    }

    /// The position in the world of a point in samples, y downwards.
    fn place(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let row = match self.rows {
            Rows::Downwards => y,
            Rows::Upwards => self.size[1].saturating_sub(1) as f64 - y,
        };
        let index = [x, row, z];
        [0, 1, 2]
            .map(|row| self.origin[row] + (0..3).map(|axis| self.axes[axis][row] * index[axis]).sum::<f64>())
    }
}

/// Samples per side of a cell, as stated in images that this program wrote.
fn samples_a_cell(image: &ImageData) -> usize {
    let told = || {
        let story: Value = serde_json::from_str(image.text(PROVENANCE)?).ok()?;
        usize::try_from(story.get("parameters")?.get("samples")?.as_u64()?).ok()
    };
    told().filter(|n| (1..=MAX_SAMPLES_A_CELL).contains(n)).unwrap_or(1)
}

/// The feature to find.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feature {
    /// Height ridges.
    Ridges(RidgeOptions),
    /// Points at which the scalar has this value.
    Contour(f64),
}

/// Lines of a layer, or a surface of all of them.
#[derive(Clone, Debug)]
pub enum Found {
    /// Lines with value and strength at every point; contours have no strength.
    Lines {
        /// The layer.
        layer: usize,
        /// The lines.
        lines: Polylines,
        /// Value at every point.
        values: Vec<f64>,
        /// Strength at every point; empty for contours.
        strengths: Vec<f64>,
    },
    /// Triangles with the same.
    Surface {
        /// The triangles.
        surface: Surface,
        /// Value at every point.
        values: Vec<f64>,
        /// Strength at every point; empty for contours.
        strengths: Vec<f64>,
        /// The connected piece of every triangle, 0 the largest; empty for contours.
        pieces: Vec<u32>,
    },
}

/// Looks for lines in a layer, or for a surface in the whole image.
///
/// # Errors
/// See [`RidgesError`].
pub fn find(image: &ScalarImage, layer: Option<usize>, feature: &Feature) -> Result<Found, RidgesError> {
    let layer = layer.or((image.layers() == 1).then_some(0));
    Ok(match (layer, feature) {
        (Some(layer), Feature::Ridges(options)) => {
            let found = ridge_lines(&image.layer(layer)?, options)?;
            Found::Lines { layer, lines: found.shape, values: found.value, strengths: found.strength }
        }
        (Some(layer), Feature::Contour(level)) => {
            let lines = isolines(&image.layer(layer)?, *level);
            Found::Lines { layer, values: vec![*level; lines.points.len()], lines, strengths: Vec::new() }
        }
        (None, Feature::Ridges(options)) => {
            let found = ridge_surface(&image.volume()?, options)?;
            Found::Surface {
                surface: found.shape,
                values: found.value,
                strengths: found.strength,
                pieces: found.piece,
            }
        }
        (None, Feature::Contour(level)) => {
            let surface = isosurface(&image.volume()?, *level);
            let values = vec![*level; surface.points.len()];
            Found::Surface { surface, values, strengths: Vec::new(), pieces: Vec::new() }
        }
    })
}

impl Found {
    /// Number of lines or triangles.
    #[must_use]
    pub fn parts(&self) -> usize {
        match self {
            Self::Lines { lines, .. } => lines.lines.len(),
            Self::Surface { surface, .. } => surface.triangles.len(),
        }
    }

    /// The lines or triangles in the frame of the image. Point arrays: `value` and, for ridges, `strength`. Ridge
    /// surfaces have a cell array `piece`.
    #[must_use]
    pub fn poly_data(&self, image: &ScalarImage, story: &str) -> PolyData {
        let mut data = PolyData::default();
        let (mut value, mut strength, mut piece) = (Vec::new(), Vec::new(), Vec::new());
        match self {
            Self::Lines { layer, lines, values, strengths } => {
                for line in &lines.lines {
                    let closing = if line.closed { line.points.first() } else { None };
                    let indices = || line.points.iter().chain(closing).map(|&i| i as usize);
                    let at = |i: usize| [lines.points[i].x, lines.points[i].y, *layer as f64];
                    push_line(&mut data, indices().map(|i| image.place(at(i))));
                    value.extend(indices().map(|i| values[i]));
                    strength.extend(indices().filter_map(|i| strengths.get(i)));
                }
            }
            Self::Surface { surface, values, strengths, pieces } => {
                data.points = surface.points.iter().map(|p| image.place(*p)).collect();
                for triangle in &surface.triangles {
                    data.polys.push(triangle.map(|i| i as usize));
                }
                value.clone_from(values);
                strength.clone_from(strengths);
                piece = pieces.iter().map(|&p| f64::from(p)).collect();
            }
        }
        data.point_arrays.push(DataArray::new("value", 1, value));
        if !strength.is_empty() {
            data.point_arrays.push(DataArray::new("strength", 1, strength));
        }
        if !piece.is_empty() {
            data.cell_arrays.push(DataArray::new("piece", 1, piece));
        }
        push_story(&mut data, story);
        data
    }

    /// The lines over their layer; `None` for surfaces.
    ///
    /// # Errors
    /// [`RidgesError::Layer`] for another image.
    pub fn picture(
        &self,
        image: &ScalarImage,
        label: &str,
        options: HeatOptions,
    ) -> Result<Option<Scene>, RidgesError> {
        let Self::Lines { layer, lines, .. } = self else { return Ok(None) };
        // In cells, as the field's other pictures.
        let mut overlay = line_overlay(lines, label, Rgba::hex(0xd62728));
        overlay.points.iter_mut().for_each(|p| *p /= image.samples_a_cell as f64);
        let options = HeatOptions {
            quantity: image.quantity(),
            samples_a_cell: image.samples_a_cell,
            overlays: vec![overlay],
            missing: Some("no value".to_owned()),
            cell: image.shape(),
            ..options
        };
        Ok(Some(heat_map(&image.layer(*layer)?, &options)))
    }
}

/// Lines over shared points as an overlay.
#[must_use]
pub fn line_overlay(lines: &Polylines, label: &str, colour: Rgba) -> Overlay {
    let mut points = Vec::new();
    for [a, b] in lines.lines.iter().flat_map(Polyline::segments) {
        points.extend([lines.points[a as usize], lines.points[b as usize], Point::splat(f64::NAN)]);
    }
    Overlay { label: label.to_owned(), points, colour, width_px: 1.4, ..Overlay::default() }
}
