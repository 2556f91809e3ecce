//! From a file's content to a field in the plane.

use super::{Content, Derivation, Derived, InputError, Reading, TensorFile};
use tigereye_core::{Field, Tensor2};
use tigereye_fields::images::{
    MAX_RESAMPLED, MAX_RESAMPLED_CELLS, gradient_tensors, hessian_tensors, resampled, structure_tensors,
};
use tigereye_io::volume::{Cut, Lattice, PlaneGeometry, TensorVolume};

/// A tensor field in the plane, with how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneField {
    /// The tensors, row 0 on top, x right, y up.
    pub field: Field<Tensor2>,
    /// What was read, assumed and done, a sentence each.
    pub story: Vec<String>,
    /// Where its cells lie.
    pub geometry: PlaneGeometry,
}

/// Cells whose sides differ by more than this part are worth a warning.
const SQUARE: f64 = 0.02;

impl TensorFile {
    /// The field in the plane that the reading chooses, or in the only one.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn plane(&self, reading: &Reading) -> Result<PlaneField, InputError> {
        let plane = match (&self.content, reading.derive) {
            (Content::Tensors(volume), _) => projected(volume, reading)?,
            (Content::Numbers(lattice), Some(derivation)) => derived(lattice, reading, derivation)?,
            (Content::Numbers(_), None) => {
                return Err(InputError::NoTensors { components: "one number" });
            }
        };
        plane.cropped(reading)?.finite(reading)?.resampled(reading)
    }
}

fn projected(volume: &TensorVolume, reading: &Reading) -> Result<PlaneField, InputError> {
    let slice = volume.slice(reading.choice)?;
    let mut story = volume.story();
    story.push(slice.cut.story(", the third row and column dropped"));
    Ok(placed(slice.field, story, &slice.cut))
}

fn derived(lattice: &Lattice, reading: &Reading, how: Derivation) -> Result<PlaneField, InputError> {
    let mut story = lattice.story();
    let scale = if how.sigma == 0.0 {
        "by differences of neighbours".to_owned()
    } else {
        format!("of the image smoothed by {} cells", how.sigma)
    };
    let (mut field, cut, words) = match how.kind {
        Derived::Gradient => {
            let slice = lattice.vectors(reading.choice, reading.frame)?;
            let field = gradient_tensors(&slice.field, slice.cut.geometry.spacing(), how.sigma);
            (field, slice.cut, format!("gradient tensor, {scale}"))
        }
        Derived::Hessian => {
            let slice = lattice.scalars(reading.choice)?;
            let field = hessian_tensors(&slice.field, slice.cut.geometry.spacing(), how.sigma);
            (field, slice.cut, format!("Hessian, {scale}"))
        }
        Derived::Structure => {
            let slice = lattice.scalars(reading.choice)?;
            let window = how.window.unwrap_or(Derived::USUAL_WINDOW);
            let field = structure_tensors(&slice.field, slice.cut.geometry.spacing(), how.sigma, window);
            (field, slice.cut, format!("structure tensor, {scale}, averaged over {window} cells"))
        }
    };
    if let Some(mask) = lattice.mask_in(&cut) {
        for (t, masked) in field.values_mut().iter_mut().zip(mask.values()) {
            if *masked {
                *t = Tensor2::ZERO;
            }
        }
    }
    story.push(cut.story(""));
    story.push(words);
    Ok(placed(field, story, &cut))
}

fn placed(field: Field<Tensor2>, story: Vec<String>, cut: &Cut) -> PlaneField {
    PlaneField { field, story, geometry: cut.geometry }
}

impl PlaneField {
    /// A field that lies nowhere.
    #[must_use]
    pub const fn new(field: Field<Tensor2>, story: Vec<String>) -> Self {
        Self { field, story, geometry: PlaneGeometry::UNPLACED }
    }

    /// Words of warning where cells are not square, as light and lines take them.
    #[must_use]
    pub fn oblong(&self) -> Option<String> {
        let [dx, dy] = self.geometry.spacing();
        let off = (dx / dy - 1.0).abs() > SQUARE && (dy / dx - 1.0).abs() > SQUARE;
        let grid = self.field.grid();
        let columns = (grid.width() as f64 * dx / dy).round().max(1.0);
        let rows = (grid.height() as f64 * dy / dx).round().max(1.0);
        let (columns, rows) =
            if dx > dy { (columns, grid.height() as f64) } else { (grid.width() as f64, rows) };
        let warning = format!("WARNING: cells are {dx} x {dy}, and light and lines take them as squares");
        let possible =
            columns.max(rows) <= MAX_RESAMPLED as f64 && columns * rows <= MAX_RESAMPLED_CELLS as f64;
        let advice = format!("; --resample {columns}x{rows} makes them so");
        off.then(|| if possible { warning + &advice } else { warning })
    }

    /// The part that the reading chooses.
    ///
    /// # Errors
    /// A part that sticks out.
    pub fn cropped(mut self, reading: &Reading) -> Result<Self, InputError> {
        let Some(crop) = reading.crop else { return Ok(self) };
        let height = self.field.grid().height();
        self.field = crop.of(&self.field)?;
        self.geometry = self.geometry.cropped(crop, height);
        self.story.push(format!(
            "cropped to columns {} to {} and rows {} to {} of the plane, row 0 on top",
            crop.x[0],
            crop.x[1] - 1,
            crop.y[0],
            crop.y[1] - 1
        ));
        Ok(self)
    }

    /// Without tensors that are not finite: refused, or turned into zeros and counted.
    fn finite(mut self, reading: &Reading) -> Result<Self, InputError> {
        let Some(first) = self.field.first_non_finite() else { return Ok(self) };
        let count = self.field.values().iter().filter(|t| !t.is_finite()).count();
        if !reading.zero_not_finite {
            return Err(InputError::NotFinite { x: first.x, y: first.y, count });
        }
        self.field = self.field.map(|t| if t.is_finite() { *t } else { Tensor2::ZERO });
        self.story.push(format!("{count} tensors that are not finite, taken as zero tensors"));
        Ok(self)
    }

    /// With the number of cells that the reading asks for; the picture stays the same.
    ///
    /// # Errors
    /// A size that no grid has.
    pub fn resampled(mut self, reading: &Reading) -> Result<Self, InputError> {
        let Some([width, height]) = reading.resample else { return Ok(self) };
        let grid = self.field.grid();
        let (before, after) = ([grid.width(), grid.height()], [width, height]);
        self.field = resampled(&self.field, width, height)?;
        self.geometry = self.geometry.resampled(before, after);
        self.story.push(format!(
            "resampled from {} x {} to {width} x {height} cells (triangle filter, component by component)",
            before[0], before[1]
        ));
        Ok(self)
    }
}
