//! Scene files to scenes: pictures and fields read, everything checked. All problems are reported at once.

use crate::host::Host;
use crate::settings::{LightFault, beside, cell_of, lights_of, make_field, normalization_of};
use crate::spec::{
    self, FieldSource, LightSource, MaterialSource, Point, ProfileShape, SceneFile, ScenePart, ShapeSource,
    SourceText, SpecError,
};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use tigereye_core::{Cell, Directions, Field, Grid, Surface, TransmissionField};
use tigereye_input::format_of;
use tigereye_input::provenance::{hash_of_bytes, hash_of_field};
use tigereye_io::picture;
use tigereye_report::shortened;
use tigereye_scenes::{Fault, Layout, Mask, Material, Part, Scene, SceneError, Shape, leaks};
use tigereye_transport::Light;

/// Ending of files that hold a scene; other `.ron` files below `experiments/` are experiments, or fields.
pub const ENDING: &str = ".scene.ron";

/// Samples in which profiles are checked.
const SAMPLES: usize = 32;

/// Most cells of all crystals' fields together.
const MAX_CRYSTAL_CELLS: usize = 4 * Scene::MAX_CELLS;

/// Whether a file's name says that it holds a scene: it is or ends like `scene.ron`.
#[must_use]
pub fn is_scene_file(name: &str) -> bool {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    name == &ENDING[1..] || name.ends_with(ENDING)
}

/// Line and column, from 1.
type Place = (usize, usize);

/// A scene, ready to be built for any number of directions.
#[derive(Clone, Debug)]
pub struct PreparedScene {
    /// What it is.
    pub title: String,
    /// Its parts.
    pub scene: Scene,
    /// What lies where.
    pub layout: Layout,
    /// Its lights.
    pub lights: Vec<LightSource>,
    /// Where their profiles stand in the file.
    profiles_at: Vec<Place>,
    /// Name of the file.
    file: String,
    /// Hash of the file and of what it names, hex.
    pub blake3: String,
}

impl PreparedScene {
    /// What its cells do to light, in `directions`.
    ///
    /// # Errors
    /// As [`Scene::transmission`]; none for a scene that [`prepare`] has checked.
    pub fn transmission(&self, directions: Directions) -> Result<TransmissionField, SceneError> {
        self.scene.transmission(&self.layout, directions)
    }

    /// The lights, with their profiles in `directions`.
    ///
    /// # Errors
    /// Every light whose profile these directions do not have, with its place in the scene's file.
    pub fn lights_in(&self, directions: Directions) -> Result<Vec<Light>, Vec<SpecError>> {
        let of_file = |fault: LightFault| {
            let (line, column) = self.profiles_at[fault.index];
            SpecError { file: self.file.clone(), line, column, problem: shortened(&fault.problem) }
        };
        lights_of(&self.lights, self.scene.grid, directions)
            .map_err(|faults| faults.into_iter().map(of_file).collect())
    }

    /// Cells that pass light on.
    #[must_use]
    pub fn open(&self) -> Field<bool> {
        Field::from_fn(self.scene.grid, |cell| !self.layout.is_wall(cell))
    }

    /// What looks wrong: walls that light passes between.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let gaps = leaks(&self.layout);
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
    let source = SourceText::new(text);
    let mut reader = Reader {
        path,
        host,
        parts: source.items("parts:"),
        lights: source.items("lights:"),
        source,
        problems: Vec::new(),
        hashes: hash_of_bytes(text.as_bytes()),
        masks: BTreeMap::new(),
        mask_cells: 0,
        crystal_cells: 0,
    };
    let grid = match Grid::new(file.width, file.height) {
        Ok(grid) if grid.cells() <= Scene::MAX_CELLS => grid,
        _ => {
            let fault = Fault::Size { width: file.width, height: file.height };
            let key = if file.width > 0 && file.height == 0 { "height:" } else { "width:" };
            return Err(vec![reader.fault(key, &fault.to_string())]);
        }
    };
    let part = |(i, part)| reader.part(i, part, grid).map(|part| (i, part));
    let (numbers, parts): (Vec<usize>, Vec<Part>) = file.parts.iter().enumerate().filter_map(part).unzip();
    // What is wrong with the rest of the scene is told, too, where parts of it cannot be made.
    let scene = Scene { grid, parts };
    let layout = scene.layout().map_err(|faults| {
        for SceneError { part, fault } in faults {
            reader.fault_of_scene(&SceneError { part: part.map(|i| numbers[i]), fault });
        }
    });
    let layout = layout.ok();
    let Ok(few) = Directions::new(8) else { unreachable!("8 is a multiple of 8") };
    if let Some(Err(SceneError { part, fault })) = layout.as_ref().map(|l| scene.transmission(l, few)) {
        reader.fault_of_scene(&SceneError { part: part.map(|i| numbers[i]), fault });
    }
    let profiles_at = reader.lights(&file, grid, layout.as_ref());
    match layout {
        Some(layout) if reader.problems.is_empty() => {
            let blake3 = hash_of_bytes(reader.hashes.as_bytes());
            let (title, lights) = (file.title, file.lights);
            Ok(PreparedScene { title, scene, layout, lights, profiles_at, file: path.to_owned(), blake3 })
        }
        _ => {
            reader.problems.sort_by_key(|problem| (problem.line, problem.column));
            Err(reader.problems)
        }
    }
}

struct Reader<'a> {
    path: &'a str,
    host: &'a dyn Host,
    source: SourceText<'a>,
    /// Where the parts stand.
    parts: Vec<Range<usize>>,
    /// Where the lights stand.
    lights: Vec<Range<usize>>,
    problems: Vec<SpecError>,
    /// Hashes of all that was read.
    hashes: String,
    /// Bitmaps that were read, by their names and whether they are inverted.
    masks: BTreeMap<(String, bool), Mask>,
    /// Pixels of the bitmaps so far.
    mask_cells: usize,
    /// Cells of the crystals' fields so far.
    crystal_cells: usize,
}

impl Reader<'_> {
    /// A fault at a key of the scene itself.
    fn fault(&self, key: &str, problem: &str) -> SpecError {
        self.fault_at(self.source.place_after(&[], key), problem)
    }

    fn fault_at(&self, (line, column): Place, problem: &str) -> SpecError {
        SpecError { file: self.path.to_owned(), line, column, problem: shortened(problem) }
    }

    /// The place of a key in one of the parts or lights, or of that one where it has no such key.
    fn place_in(&self, items: &[Range<usize>], index: usize, key: &str) -> Place {
        items.get(index).map_or((1, 1), |item| self.source.place_in(item.clone(), key))
    }

    fn fault_of_scene(&mut self, error: &SceneError) {
        let problem = error.fault.to_string();
        let of_material = matches!(
            error.fault,
            Fault::Crystal { .. } | Fault::Core(_) | Fault::Share { .. } | Fault::Angle { .. }
        );
        let key = if of_material { "material:" } else { "shape:" };
        self.problems.push(match error.part {
            Some(i) => self.fault_at(self.place_in(&self.parts, i, key), &problem),
            None => self.fault("parts:", &problem),
        });
    }

    fn part(&mut self, index: usize, part: &ScenePart, grid: Grid) -> Option<Part> {
        let shape = self.shape(&part.shape, grid);
        let material = self.material(&part.material);
        match (shape, material) {
            (Ok(shape), Ok(material)) => return Some(Part { shape, material }),
            (shape, material) => {
                for (key, fault) in [("shape:", shape.err()), ("material:", material.err())] {
                    if let Some(problem) = fault {
                        let place = self.place_in(&self.parts, index, key);
                        self.problems.push(self.fault_at(place, &problem));
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
        let key = (name.to_owned(), inverted);
        let mask = match self.masks.get(&key) {
            Some(mask) => mask.clone(),
            None => {
                let mask = self.read_mask(name, inverted, grid)?;
                self.masks.insert(key, mask.clone());
                mask
            }
        };
        let (width, height) = (mask.width(), mask.height());
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
        Ok(mask)
    }

    fn read_mask(&mut self, name: &str, inverted: bool, grid: Grid) -> Result<Mask, String> {
        let bytes = self.host.read(&beside(self.path, name, self.host))?;
        let fault = |e| format!("{name}: {e}");
        let [width, height] = picture::size_of_png(&bytes).map_err(fault)?;
        // Before it is unpacked: a small file may hold a huge picture.
        if width > grid.width() || height > grid.height() {
            let (w, h) = (grid.width(), grid.height());
            return Err(format!(
                "{name} has {width} x {height} pixels: expected {w} x {h} as the scene has cells, or fewer with `at: (x, y)`"
            ));
        }
        self.mask_cells += width * height;
        if self.mask_cells as f64 > Scene::MAX_WORK {
            return Err(format!("the bitmaps have more than {} pixels together", Scene::MAX_WORK));
        }
        let picture = picture::read_png(&bytes).map_err(fault)?;
        self.hashes += &hash_of_bytes(&bytes);
        Ok(Mask::from_fn(width, height, |c| (picture.values[c.y * width + c.x] < 0.5) != inverted))
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

    /// Checks that lights can shine, in some directions at least, and stand in the open, as far as walls are known; the places of
    /// their profiles.
    fn lights(&mut self, file: &SceneFile, grid: Grid, layout: Option<&Layout>) -> Vec<Place> {
        let in_wall = |(index, light)| {
            let problem = light_fault(layout?, cell_of(light, grid))?;
            Some(LightFault { index, key: "cell:", problem })
        };
        let mut faults: Vec<LightFault> = file.lights.iter().enumerate().filter_map(in_wall).collect();
        let misplaced: BTreeSet<usize> = faults.iter().map(|f| f.index).collect();
        let makes = |lights: &[LightSource], samples: usize| match Directions::new(samples) {
            Ok(directions) => lights_of(lights, grid, directions).err().unwrap_or_default(),
            Err(_) => Vec::new(),
        };
        for fault in makes(&file.lights, SAMPLES) {
            let light = &file.lights[fault.index];
            // Whether a pulse hits a sample is known once the directions are.
            let is_pulse = fault.key == "profile:" && matches!(light.profile, ProfileShape::Pulse { .. });
            let of_others = || {
                (8..=Directions::MAX)
                    .step_by(8)
                    .any(|samples| makes(std::slice::from_ref(light), samples).is_empty())
            };
            if !(misplaced.contains(&fault.index) || is_pulse && of_others()) {
                faults.push(fault);
            }
        }
        for LightFault { index, key, problem } in faults {
            let place = self.place_in(&self.lights, index, key);
            self.problems.push(self.fault_at(place, &problem));
        }
        (0..file.lights.len()).map(|i| self.place_in(&self.lights, i, "profile:")).collect()
    }
}

/// What keeps a light from a cell.
#[must_use]
pub fn light_fault(layout: &Layout, cell: Cell) -> Option<String> {
    let (grid, Cell { x, y }) = (layout.surfaces.grid(), cell);
    if !grid.contains(cell) {
        let (w, h) = (grid.width(), grid.height());
        return Some(format!("the light at ({x}, {y}) lies outside of the {w} x {h} cells"));
    }
    layout.is_wall(cell).then(|| {
        let part = layout.part_of.at(cell).map(|i| format!(" of part {}", i + 1)).unwrap_or_default();
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
