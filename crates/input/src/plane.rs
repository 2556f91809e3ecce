//! From a file's content to a field in the plane.

use crate::{Content, Derivation, Derived, InputError, Reading, TensorFile};
use tigereye_core::{Field, Tensor2};
use tigereye_fields::images::{
    MAX_RESAMPLED, MAX_RESAMPLED_CELLS, gradient_tensors, hessian_tensors, orientation_tensors, resampled,
    strain_rate_tensors, structure_tensors,
};
use tigereye_io::volume::{Cut, Lattice, PlaneGeometry, Slice, TensorVolume};

/// A tensor field in the plane, with how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneField {
    /// The tensors, row 0 on top, x right, y up.
    pub field: Field<Tensor2>,
    /// What was read, assumed and done, a sentence each.
    pub story: Vec<String>,
    /// Where its cells lie.
    pub geometry: PlaneGeometry,
    /// Unit of its coordinates, where the file states it.
    pub unit: Option<&'static str>,
    /// What everybody must hear of it beside the story.
    pub remarks: Vec<String>,
}

/// Cells whose sides differ by more than this part are worth a warning.
const SQUARE: f64 = 0.02;

impl TensorFile {
    /// The field in the plane that the reading chooses, or in the only one.
    ///
    /// # Errors
    /// See [`InputError`].
    pub fn plane(&self, reading: &Reading) -> Result<PlaneField, InputError> {
        let unit = match &self.content {
            Content::Tensors(volume) => volume.lattice().unit,
            Content::Numbers(lattice) => lattice.unit,
        };
        let plane = match (&self.content, reading.derive) {
            (Content::Tensors(volume), _) => projected(volume, reading)?,
            (Content::Numbers(lattice), Some(derivation)) => derived(lattice, reading, derivation)?,
            (Content::Numbers(_), None) => {
                return Err(InputError::NoTensors { components: "one number" });
            }
        };
        PlaneField { unit, ..plane }.cropped(reading)?.finite(reading)?.resampled(reading)
    }
}

fn projected(volume: &TensorVolume, reading: &Reading) -> Result<PlaneField, InputError> {
    let slice = volume.slice(reading.choice)?;
    let mut story = volume.story();
    story.push(slice.cut.story(", the components along its normal dropped"));
    let mut plane = placed(slice.field, story, &slice.cut);
    plane.remarks.extend(volume.tilted(&slice.cut));
    let mask = volume.lattice().mask_in(&slice.cut);
    if mask.is_some_and(|mask| mask.values().iter().all(|is_out| *is_out)) {
        plane.remarks.push("WARNING: the mask leaves nothing of this plane".to_owned());
    }
    plane.remarks.extend(volume.contradicted_frame().map(|stated| {
        let taken = volume.frame().0.words();
        format!(
            "WARNING: the file states components along {}, taken along {taken} as given (--frame)",
            stated.words()
        )
    }));
    Ok(plane)
}

/// Tensors from vectors with holes, the spacing of their cells, and the deviation of a Gaussian in cells.
type FromVectors = fn(&Field<Option<[f64; 2]>>, [f64; 2], f64) -> Field<Option<Tensor2>>;

/// Tensors from numbers with holes and the spacing of their cells.
type FromNumbers<'a> = &'a dyn Fn(&Field<Option<f64>>, [f64; 2]) -> Field<Option<Tensor2>>;

fn derived(lattice: &Lattice, reading: &Reading, how: Derivation) -> Result<PlaneField, InputError> {
    let (sigma, window) = (how.sigma, how.window.unwrap_or(Derived::USUAL_WINDOW));
    let of_vectors = |derive: FromVectors| {
        let slice = lattice.vectors(reading.choice, reading.frame)?;
        let samples = Samples::of(&slice, lattice, |v| v.iter().all(|v| v.is_finite()));
        let found = derive(&samples.there, slice.cut.geometry.spacing(), sigma);
        Ok::<_, InputError>((found, samples.map(), slice.cut))
    };
    let of_numbers = |derive: FromNumbers<'_>| {
        let slice = lattice.scalars(reading.choice)?;
        let samples = Samples::of(&slice, lattice, |v| v.is_finite());
        let found = derive(&samples.there, slice.cut.geometry.spacing());
        Ok::<_, InputError>((found, samples.map(), slice.cut))
    };
    let (found, samples, cut) = match how.kind {
        Derived::Gradient => of_vectors(gradient_tensors)?,
        Derived::StrainRate => of_vectors(strain_rate_tensors)?,
        Derived::Hessian => of_numbers(&|image, spacing| hessian_tensors(image, spacing, sigma))?,
        Derived::Structure => of_numbers(&|image, spacing| structure_tensors(image, spacing, sigma, window))?,
        Derived::Orientation => {
            of_numbers(&|image, spacing| orientation_tensors(image, spacing, sigma, window))?
        }
    };
    let mut story = lattice.story();
    story.extend(lattice.words_of_vectors(reading.frame));
    story.push(cut.story(""));
    story.push(words_of(how));
    let loss = samples.loss(&found);
    story.extend(loss.clone());
    let mut plane = placed(samples.completed(&found), story, &cut);
    plane.remarks.extend(loss);
    Ok(plane)
}

/// What was derived, in a sentence.
fn words_of(how: Derivation) -> String {
    let scale = if how.sigma == 0.0 {
        "by differences of neighbours".to_owned()
    } else {
        format!("of the image smoothed by {} cells", how.sigma)
    };
    let averaged = format!("averaged over {} cells", how.window.unwrap_or(Derived::USUAL_WINDOW));
    match how.kind {
        Derived::Gradient => format!("gradient tensor, {scale}"),
        Derived::StrainRate => format!("rate of strain (symmetric part of the gradient), {scale}"),
        Derived::Hessian => format!("Hessian, {scale}"),
        Derived::Structure => format!(
            "structure tensor, {scale}, {averaged}: its major axis, and with it light and lines, runs across stripes \
             (orientation: along them)"
        ),
        Derived::Orientation => format!(
            "orientation tensor (structure tensor J as trace(J) I - J), {scale}, {averaged}: light and lines run along stripes"
        ),
    }
}

/// The samples of a plane that may be differentiated, and why the others may not.
struct Samples<T> {
    there: Field<Option<T>>,
    /// Samples that no mask leaves out but that are infinite or not a number.
    strange: Field<bool>,
}

impl<T: Copy> Samples<T> {
    fn of(slice: &Slice<T>, lattice: &Lattice, is_finite: impl Fn(&T) -> bool) -> Self {
        let mask = lattice.mask_in(&slice.cut);
        let is_masked = |cell| mask.as_ref().is_some_and(|m| *m.at(cell));
        let grid = slice.field.grid();
        let there = Field::from_fn(grid, |c| {
            let sample = slice.field.at(c);
            (is_finite(sample) && !is_masked(c)).then_some(*sample)
        });
        let strange = Field::from_fn(grid, |c| !is_finite(slice.field.at(c)) && !is_masked(c));
        Self { there, strange }
    }

    /// Where samples are, without them.
    fn map(&self) -> Samples<()> {
        Samples { there: self.there.map(|v| v.map(|_| ())), strange: self.strange.clone() }
    }
}

impl Samples<()> {
    /// Zero where no tensor could be derived; not a number where a sample is not finite, for whoever refuses such.
    fn completed(&self, found: &Field<Option<Tensor2>>) -> Field<Tensor2> {
        Field::from_fn(found.grid(), |c| match found.at(c) {
            _ if *self.strange.at(c) => Tensor2::isotropic(f64::NAN),
            Some(t) => *t,
            None => Tensor2::ZERO,
        })
    }

    /// How many cells have no tensor, in words, where there are such.
    fn loss(&self, found: &Field<Option<Tensor2>>) -> Option<String> {
        let cells = found.grid().cells();
        let missing = self.there.values().iter().filter(|v| v.is_none()).count();
        let strange = self.strange.values().iter().filter(|v| **v).count();
        let alone = found.values().iter().filter(|t| t.is_none()).count() - missing;
        let counts = [
            (missing - strange, "masked"),
            (strange, "not finite"),
            (alone, "with too few neighbours for a difference"),
        ];
        let parts: Vec<String> =
            counts.iter().filter(|(n, _)| *n > 0).map(|(n, why)| format!("{n} {why}")).collect();
        let lost = missing + alone;
        (lost > 0).then(|| {
            format!(
                "{lost} of {cells} cells of the plane have no derived tensor and are taken as zero tensors: {}; differences \
                 beside them are one-sided",
                parts.join(", ")
            )
        })
    }
}

fn placed(field: Field<Tensor2>, story: Vec<String>, cut: &Cut) -> PlaneField {
    PlaneField { field, story, geometry: cut.geometry, unit: None, remarks: Vec::new() }
}

/// What became of tensors that are not finite, in words.
#[must_use]
pub fn not_finite_words(count: usize) -> String {
    let (tensors, zero) = if count == 1 { ("tensor", "a zero tensor") } else { ("tensors", "zero tensors") };
    format!("{count} {tensors} with a component that is infinite or not a number, taken as {zero}")
}

impl PlaneField {
    /// A field that lies nowhere.
    #[must_use]
    pub const fn new(field: Field<Tensor2>, story: Vec<String>) -> Self {
        Self { field, story, geometry: PlaneGeometry::UNPLACED, unit: None, remarks: Vec::new() }
    }

    /// Words of warning where cells are not square, as light takes them.
    #[must_use]
    pub fn oblong(&self) -> Option<String> {
        let [dx, dy] = self.geometry.spacing();
        let off = (dx / dy - 1.0).abs() > SQUARE && (dy / dx - 1.0).abs() > SQUARE;
        let grid = self.field.grid();
        let columns = (grid.width() as f64 * dx / dy).round().max(1.0);
        let rows = (grid.height() as f64 * dy / dx).round().max(1.0);
        let (columns, rows) =
            if dx > dy { (columns, grid.height() as f64) } else { (grid.width() as f64, rows) };
        let warning = format!("WARNING: cells are {dx} x {dy}, and light treats them as squares");
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
        let words = not_finite_words(count);
        self.story.push(words.clone());
        self.remarks.push(words);
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
