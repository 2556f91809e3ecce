//! From a file's content to a field in the plane.

use super::{Content, Derivation, Derived, InputError, Reading, TensorFile};
use tigereye_core::{Field, Tensor2};
use tigereye_fields::images::{
    MAX_RESAMPLED, MAX_RESAMPLED_CELLS, gradient_tensors, hessian_tensors, resampled, structure_tensors,
};
use tigereye_io::volume::{Cut, Lattice, TensorVolume};

/// A tensor field in the plane, with how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneField {
    /// The tensors, row 0 on top, x right, y up.
    pub field: Field<Tensor2>,
    /// What was read, assumed and done, a sentence each.
    pub story: Vec<String>,
    /// Position of the lower left cell.
    pub origin: [f64; 2],
    /// Distance of the cells.
    pub spacing: [f64; 2],
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
            let field = gradient_tensors(&slice.field, slice.cut.spacing, how.sigma);
            (field, slice.cut, format!("gradient tensor, {scale}"))
        }
        Derived::Hessian => {
            let slice = lattice.scalars(reading.choice)?;
            let field = hessian_tensors(&slice.field, slice.cut.spacing, how.sigma);
            (field, slice.cut, format!("Hessian, {scale}"))
        }
        Derived::Structure => {
            let slice = lattice.scalars(reading.choice)?;
            let window = how.window.unwrap_or(Derived::USUAL_WINDOW);
            let field = structure_tensors(&slice.field, slice.cut.spacing, how.sigma, window);
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
    PlaneField { field, story, origin: cut.origin, spacing: cut.spacing }
}

impl PlaneField {
    /// A field that lies in the plane by itself.
    #[must_use]
    pub const fn new(field: Field<Tensor2>, story: Vec<String>) -> Self {
        Self { field, story, origin: [0.0; 2], spacing: [1.0; 2] }
    }

    /// Words of warning where cells are not square, as light takes them.
    #[must_use]
    pub fn oblong(&self) -> Option<String> {
        let [dx, dy] = self.spacing;
        let off = (dx / dy - 1.0).abs() > SQUARE && (dy / dx - 1.0).abs() > SQUARE;
        let grid = self.field.grid();
        let columns = (grid.width() as f64 * dx / dy).round().max(1.0);
        let rows = (grid.height() as f64 * dy / dx).round().max(1.0);
        let (columns, rows) =
            if dx > dy { (columns, grid.height() as f64) } else { (grid.width() as f64, rows) };
        let warning = format!("WARNING: cells are {dx} x {dy}, and light takes them as squares");
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
        self.origin[0] += crop.x[0] as f64 * self.spacing[0];
        self.origin[1] += (height - crop.y[1]) as f64 * self.spacing[1];
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
        for axis in 0..2 {
            let spacing = self.spacing[axis] * before[axis] as f64 / after[axis] as f64;
            // Cells are squares around their points, and the outermost squares keep their outer sides.
            self.origin[axis] += 0.5 * (spacing - self.spacing[axis]);
            self.spacing[axis] = spacing;
        }
        self.story.push(format!(
            "resampled from {} x {} to {width} x {height} cells (triangle filter, component by component)",
            before[0], before[1]
        ));
        Ok(self)
    }
}
