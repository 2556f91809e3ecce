//! Scene files to scenes: pictures and fields read, everything checked. All problems are reported at once.

use crate::host::Host;
use crate::input::format_of;
use crate::provenance::{hash_of_bytes, hash_of_field};
use crate::settings::{beside, make_field, normalization_of};
use crate::shortened;
use crate::spec::{
    self, FieldSource, LightSource, MaterialSource, Point, SceneFile, ScenePart, ShapeSource, SpecError,
};
use tigereye_core::{Cell, Directions, Field, Grid, Surface};
use tigereye_io::picture;
use tigereye_scenes::{BuiltScene, Fault, Mask, Material, Part, Scene, SceneError, Shape, leaks};

/// Ending of files that hold a scene; other `.ron` files below `experiments/` are experiments, or fields.
pub const ENDING: &str = ".scene.ron";

/// Most cells of all crystals' fields together.
const MAX_CRYSTAL_CELLS: usize = 4 * Scene::MAX_CELLS;

/// Whether a file's name says that it holds a scene: it is or ends like `scene.ron`.
#[must_use]
pub fn is_scene_file(name: &str) -> bool {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    name == &ENDING[1..] || name.ends_with(ENDING)
}

/// A scene, ready to be built for any number of directions.
#[derive(Clone, Debug)]
pub struct PreparedScene {
    /// What it is.
    pub title: String,
    /// Its parts.
    pub scene: Scene,
    /// What each cell is.
    pub built: BuiltScene,
    /// Its lights.
    pub lights: Vec<LightSource>,
    /// Hash of the file and of what it names, hex.
    pub blake3: String,
}

impl PreparedScene {
    /// The scene with its transmission in `directions`.
    ///
    /// # Errors
    /// [`SceneError`]; none where the scene was checked, but for memory.
    pub fn in_directions(&self, directions: Directions) -> Result<BuiltScene, SceneError> {
        self.scene.built(directions)
    }

    /// Cells that pass light on.
    #[must_use]
    pub fn open(&self) -> Field<bool> {
        Field::from_fn(self.scene.grid, |cell| !self.built.is_wall(cell))
    }

    /// What looks wrong: walls that light passes between.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let gaps = leaks(&self.built);
        let Some([a, b]) = gaps.first() else { return Vec::new() };
        let more = match gaps.len() {
            1 => String::new(),
            n => format!(", and at {} more places", n - 1),
        };
        vec![format!(
            "light passes between the walls at ({}, {}) and ({}, {}), which touch at a corner only{more}: expected a thickness of 1.5 or more where a wall is to be closed",
            a.x, a.y, b.x, b.y
        )]
    }
}

/// Reads a scene from `text` of the file `path`; the files it names are looked up beside it.
///
/// # Errors
/// Every problem found, with line and column.
pub fn prepare(path: &str, text: &str, host: &dyn Host) -> Result<PreparedScene, Vec<SpecError>> {
    let file = spec::load_scene(path, text).map_err(|e| vec![e])?;
    let mut reader = Reader {
        path,
        text,
        host,
        problems: Vec::new(),
        hashes: hash_of_bytes(text.as_bytes()),
        crystal_cells: 0,
    };
    let grid = match Grid::new(file.width, file.height) {
        Ok(grid) if grid.cells() <= Scene::MAX_CELLS => grid,
        Ok(_) => {
            let fault = Fault::Size { width: file.width, height: file.height };
            return Err(vec![reader.fault(&[], "width", &fault.to_string())]);
        }
        Err(e) => return Err(vec![reader.fault(&[], "width", &e.to_string())]),
    };
    let parts: Vec<Option<Part>> =
        file.parts.iter().enumerate().map(|(i, part)| reader.part(i, part, grid)).collect();
    if parts.contains(&None) {
        return Err(reader.problems);
    }
    let scene = Scene { grid, parts: parts.into_iter().flatten().collect() };
    for fault in scene.faults() {
        reader.fault_of_scene(&fault);
    }
    if !reader.problems.is_empty() {
        return Err(reader.problems);
    }
    let Ok(few) = Directions::new(8) else { unreachable!("8 is a multiple of 8") };
    let built = scene.built(few).map_err(|fault| {
        reader.fault_of_scene(&fault);
        std::mem::take(&mut reader.problems)
    })?;
    reader.lights(&file, &built);
    match reader.problems.is_empty() {
        true => {
            let blake3 = hash_of_bytes(reader.hashes.as_bytes());
            Ok(PreparedScene { title: file.title, scene, built, lights: file.lights, blake3 })
        }
        false => Err(reader.problems),
    }
}

struct Reader<'a> {
    path: &'a str,
    text: &'a str,
    host: &'a dyn Host,
    problems: Vec<SpecError>,
    /// Hashes of all that was read.
    hashes: String,
    /// Cells of the crystals' fields so far.
    crystal_cells: usize,
}

impl Reader<'_> {
    /// A fault at `word`, behind the anchors.
    fn fault(&self, anchors: &[&str], word: &str, problem: &str) -> SpecError {
        let (line, column) = spec::place_after(self.text, anchors, word);
        SpecError { file: self.path.to_owned(), line, column, problem: shortened(problem) }
    }

    /// Reports a fault at `word` of an item of a list.
    fn fault_in(&mut self, list: &str, index: usize, word: &str, problem: &str) {
        let (line, column) = spec::place_in_list(self.text, list, index, word);
        let problem = shortened(problem);
        self.problems.push(SpecError { file: self.path.to_owned(), line, column, problem });
    }

    fn fault_of_scene(&mut self, error: &SceneError) {
        let problem = error.fault.to_string();
        let of_material = matches!(
            error.fault,
            Fault::Crystal { .. } | Fault::Core(_) | Fault::Share { .. } | Fault::Angle { .. }
        );
        match error.part {
            Some(i) => self.fault_in("parts:", i, if of_material { "material:" } else { "shape:" }, &problem),
            None => self.problems.push(self.fault(&[], "parts", &problem)),
        }
    }

    fn part(&mut self, index: usize, part: &ScenePart, grid: Grid) -> Option<Part> {
        let shape = self.shape(&part.shape, grid);
        let material = self.material(&part.material);
        match (shape, material) {
            (Ok(shape), Ok(material)) => return Some(Part { shape, material }),
            (shape, material) => {
                for (word, fault) in [("shape:", shape.err()), ("material:", material.err())] {
                    if let Some(problem) = fault {
                        self.fault_in("parts:", index, word, &problem);
                    }
                }
            }
        }
        None
    }

    fn shape(&mut self, source: &ShapeSource, grid: Grid) -> Result<Shape, String> {
        Ok(match source {
            ShapeSource::Rectangle { from, to } => Shape::Rectangle { from: point(from), to: point(to) },
            ShapeSource::Disc { centre, radius } => {
                Shape::Disc { centre: point(centre), radius: radius.get() }
            }
            ShapeSource::Segment { from, to, thickness } => {
                Shape::Segment { from: point(from), to: point(to), thickness: thickness.get() }
            }
            ShapeSource::Polygon(corners) => Shape::Polygon(corners.iter().map(point).collect()),
            ShapeSource::Bitmap { path, at, inverted } => {
                let at = at.map(|(x, y)| Cell::new(x, y));
                Shape::Bitmap {
                    at: at.unwrap_or(Cell::new(0, 0)),
                    mask: self.mask(path, at, *inverted, grid)?,
                }
            }
            ShapeSource::Outline { of, thickness } => {
                Shape::Outline { of: Box::new(self.shape(of, grid)?), thickness: thickness.get() }
            }
            ShapeSource::Outside(of) => Shape::Outside(Box::new(self.shape(of, grid)?)),
        })
    }

    /// The dark pixels of a picture.
    fn mask(&mut self, name: &str, at: Option<Cell>, inverted: bool, grid: Grid) -> Result<Mask, String> {
        if format_of(name) != "png" {
            return Err(format!("{name}: expected a picture .png"));
        }
        let bytes = self.host.read(&beside(self.path, name, self.host))?;
        let picture = picture::read_png(&bytes).map_err(|e| format!("{name}: {e}"))?;
        let [width, height, _] = picture.size;
        let (w, h) = (grid.width(), grid.height());
        match at {
            None if (width, height) != (w, h) => {
                return Err(format!(
                    "{name} has {width} x {height} pixels: expected {w} x {h} as the scene has cells, or `at: (x, y)`"
                ));
            }
            Some(Cell { x, y }) if x.saturating_add(width) > w || y.saturating_add(height) > h => {
                return Err(format!(
                    "{name} of {width} x {height} pixels at ({x}, {y}) does not fit the {w} x {h} cells"
                ));
            }
            _ => {}
        }
        self.hashes += &hash_of_bytes(&bytes);
        Ok(Mask::new(width, picture.values.iter().map(|v| (*v < 0.5) != inverted).collect()))
    }

    fn material(&mut self, source: &MaterialSource) -> Result<Material, String> {
        Ok(match source {
            MaterialSource::Empty => Material::Clear { transmittance: 1.0 },
            MaterialSource::Absorber => Material::Absorber,
            MaterialSource::Filter(part) => Material::Clear { transmittance: part.get() },
            MaterialSource::Mirror { reflectance, angle_deg } => Material::Mirror {
                reflectance: reflectance.get(),
                angle_deg: angle_deg.map(spec::Finite::get),
            },
            MaterialSource::Diffuse { reflectance, angle_deg } => Material::Diffuse {
                reflectance: reflectance.get(),
                angle_deg: angle_deg.map(spec::Finite::get),
            },
            MaterialSource::Crystal { field, at, normalization } => {
                let mut field = (**field).clone();
                name_files_beside(&mut field, self.path, self.host);
                let field = make_field(&field, self.host)?;
                // All of them are kept, with their transmission, until the scene is built.
                self.crystal_cells += field.grid().cells();
                if self.crystal_cells > MAX_CRYSTAL_CELLS {
                    return Err(format!(
                        "the fields of the crystals have more than {MAX_CRYSTAL_CELLS} cells together: expected smaller ones, put in place with `at`"
                    ));
                }
                self.hashes += &hash_of_field(&field);
                Material::Crystal {
                    field,
                    at: Cell::new(at.0, at.1),
                    normalization: normalization_of(*normalization),
                }
            }
        })
    }

    /// Checks that lights stand in the open.
    fn lights(&mut self, file: &SceneFile, built: &BuiltScene) {
        let grid = built.surfaces.grid();
        for (i, light) in file.lights.iter().enumerate() {
            let cell = light.cell.map_or(grid.centre(), |(x, y)| Cell::new(x, y));
            if let Some(problem) = light_fault(built, cell) {
                self.fault_in("lights:", i, "cell:", &problem);
            }
        }
    }
}

/// What keeps a light from a cell.
#[must_use]
pub fn light_fault(built: &BuiltScene, cell: Cell) -> Option<String> {
    let (grid, Cell { x, y }) = (built.surfaces.grid(), cell);
    if !grid.contains(cell) {
        let (w, h) = (grid.width(), grid.height());
        return Some(format!("the light at ({x}, {y}) lies outside of the {w} x {h} cells"));
    }
    built.is_wall(cell).then(|| {
        let part = built.parts.at(cell).map(|i| format!(" of part {}", i + 1)).unwrap_or_default();
        format!("the light at ({x}, {y}) is inside a wall{part}: expected a cell that passes light on")
    })
}

/// What the legend of a gradient calls the cells that [`where_result`] leaves out.
#[must_use]
pub fn missing_label(surfaces: Option<&Field<Option<Surface>>>) -> &'static str {
    match surfaces.is_some_and(|s| s.values().iter().flatten().any(Surface::is_wall)) {
        true => "border, or beside a wall",
        false => "border, 0 by definition",
    }
}

/// A gradient's scalar where it is a result, not a number elsewhere: at the border, where it is 0 by definition, and in and beside
/// the walls of a scene, where others are compared with a pulse that shines on nothing.
#[must_use]
pub fn where_result(field: &Field<f64>, surfaces: Option<&Field<Option<Surface>>>) -> Field<f64> {
    let grid = field.grid();
    let is_wall_at = |cell: Cell| {
        let surface = surfaces.and_then(|s| *s.at(cell));
        surface.is_some_and(|s| s.is_wall())
    };
    let beside = |cell: Cell| [0, 2, 4, 6].iter().filter_map(|&k| grid.neighbour(cell, k)).any(is_wall_at);
    Field::from_fn(grid, |cell| {
        let missing = grid.is_border(cell) || is_wall_at(cell) || beside(cell);
        if missing { f64::NAN } else { *field.at(cell) }
    })
}

fn point(p: &Point) -> [f64; 2] {
    [p.0.get(), p.1.get()]
}

/// Lets a field's files be those beside `path`, where they are there.
fn name_files_beside(source: &mut FieldSource, path: &str, host: &dyn Host) {
    match source {
        FieldSource::Noisy { of, .. } => name_files_beside(of, path, host),
        FieldSource::File { path: name, mask, .. } => {
            for name in std::iter::once(name).chain(mask) {
                *name = beside(path, name, host);
            }
        }
        _ => {}
    }
}
