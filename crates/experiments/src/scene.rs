//! Scene files to scenes: pictures and fields read, everything checked. All problems are reported at once.

use crate::fault::{Faults, SourceFault, SpecError};
use crate::form::{
    FieldSource, Finite, LightSource, MaterialSource, Place, Placed, Point, ProfileShape, SceneFile,
    ScenePart, ShapeSource,
};
use crate::host::Host;
use crate::lights::{LightFault, LightValue, cell_of, lights_of};
use crate::parse::parse;
use crate::sources::{beside, make_field};
use std::collections::{BTreeMap, BTreeSet};
use tigereye_core::{Cell, Directions, Field, Grid, TransmissionField};
use tigereye_input::format_of;
use tigereye_input::provenance::{hash_of_bytes, hash_of_field};
use tigereye_io::picture;
use tigereye_scenes::{Fault, Layout, Mask, Material, Part, Scene, SceneError, Shape, leaks};
use tigereye_transport::Light;

/// Extension of files that hold a scene; other `.ron` files below `experiments/` are experiments, or fields.
pub const EXTENSION: &str = ".scene.ron";

/// Samples in which profiles are checked.
const SAMPLES: usize = 32;

/// Most cells of all crystals' fields together.
const MAX_CRYSTAL_CELLS: usize = 4 * Scene::MAX_CELLS;

/// Whether a file's name says that it holds a scene: it is or ends like `scene.ron`.
#[must_use]
pub fn is_scene_file(name: &str) -> bool {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    name == &EXTENSION[1..] || name.ends_with(EXTENSION)
}

/// A scene, ready to be built for any number of directions.
#[derive(Clone, Debug)]
pub struct PreparedScene {
    /// Heading.
    pub title: String,
    /// Its parts.
    pub scene: Scene,
    /// What lies where.
    pub layout: Layout,
    /// Its lights.
    pub lights: Vec<LightSource>,
    /// What is reported, with their places, of lights whose profiles some directions do not have.
    profiles_at: Vec<SpecError>,
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
        let of_file =
            |fault: LightFault| SpecError { problem: fault.problem, ..self.profiles_at[fault.index].clone() };
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
    let file = parse(path, text, |scene: &SceneFile| &scene.format).map_err(|e| vec![e])?;
    let mut reader = Reader {
        path,
        host,
        parts: file.parts.iter().map(|p| [p.shape.key(), p.material.key()]).collect(),
        size: file.width.key(),
        faults: Faults::new(path, text),
        hashes: hash_of_bytes(text.as_bytes()),
        masks: BTreeMap::new(),
        mask_cells: 0,
        crystal_cells: 0,
    };
    let (width, height) = (*file.width, *file.height);
    let grid = match Grid::new(width, height) {
        Ok(grid) if grid.cells() <= Scene::MAX_CELLS => grid,
        _ => {
            let fault = Fault::Size { width, height };
            let culprit = if width > 0 && height == 0 { &file.height } else { &file.width };
            return Err(vec![reader.faults.fault(culprit.key(), &fault.to_string())]);
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
        Some(layout) if reader.faults.is_empty() => {
            let blake3 = hash_of_bytes(reader.hashes.as_bytes());
            let (title, lights) = (file.title, file.lights.iter().map(|light| (**light).clone()).collect());
            Ok(PreparedScene { title, scene, layout, lights, profiles_at, blake3 })
        }
        _ => {
            let mut faults = reader.faults.into_errors();
            faults.sort_by_key(|fault| (fault.line, fault.column));
            Err(faults)
        }
    }
}

struct Reader<'a> {
    path: &'a str,
    host: &'a dyn Host,
    /// Where shape and material of the parts stand.
    parts: Vec<[Place; 2]>,
    /// Where the width of the scene stands.
    size: Place,
    faults: Faults<'a>,
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
    fn fault_of_scene(&mut self, error: &SceneError) {
        let problem = error.fault.to_string();
        let of_material = matches!(
            error.fault,
            Fault::Crystal { .. } | Fault::Core(_) | Fault::Share { .. } | Fault::Angle { .. }
        );
        let of_parts = || self.parts.first().map_or(self.size, |places| places[0]);
        let place = error.part.map_or_else(of_parts, |i| self.parts[i][usize::from(of_material)]);
        self.faults.at(place, &problem);
    }

    fn part(&mut self, index: usize, part: &ScenePart, grid: Grid) -> Option<Part> {
        let shape = self.shape(&part.shape, grid);
        let material = self.material(&part.material);
        match (shape, material) {
            (Ok(shape), Ok(material)) => return Some(Part { shape, material }),
            (shape, material) => {
                let faults = [shape.err().map(SourceFault::from), material.err()];
                for (place, fault) in self.parts[index].into_iter().zip(faults) {
                    if let Some(fault) = fault {
                        self.faults.at(fault.place.unwrap_or(place), &fault.problem);
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

    fn material(&mut self, source: &MaterialSource) -> Result<Material, SourceFault> {
        Ok(match source {
            MaterialSource::Empty => Material::Clear { transmittance: 1.0 },
            MaterialSource::Absorber => Material::Absorber,
            MaterialSource::Filter(part) => Material::Clear { transmittance: part.get() },
            MaterialSource::Mirror { reflectance, angle_deg } => {
                Material::Mirror { reflectance: reflectance.get(), angle_deg: angle_deg.map(Finite::get) }
            }
            MaterialSource::Diffuse { reflectance, angle_deg } => {
                Material::Diffuse { reflectance: reflectance.get(), angle_deg: angle_deg.map(Finite::get) }
            }
            MaterialSource::Crystal { field, at, normalization } => {
                let mut field = (**field).clone();
                name_files_beside(&mut field, self.path, self.host);
                let field = make_field(&field, self.host)?;
                // All of them are kept, with their transmission, until the scene is built.
                self.crystal_cells += field.grid().cells();
                if self.crystal_cells > MAX_CRYSTAL_CELLS {
                    return Err(format!(
                        "the fields of the crystals have more than {MAX_CRYSTAL_CELLS} cells together: expected smaller ones, put in place with `at`"
                    )
                    .into());
                }
                self.hashes += &hash_of_field(&field);
                Material::Crystal {
                    field,
                    at: Cell::new(at.0, at.1),
                    normalization: normalization.normalization(),
                }
            }
        })
    }

    /// Checks that lights can shine, in some directions at least, and stand in the open, as far as walls are known;
    /// what to report of their profiles.
    fn lights(&mut self, file: &SceneFile, grid: Grid, layout: Option<&Layout>) -> Vec<SpecError> {
        let in_wall = |(index, light): (usize, &Placed<LightSource>)| {
            let problem = light_fault(layout?, cell_of(light, grid))?;
            Some(LightFault { index, value: LightValue::Cell, problem, place: None })
        };
        let mut faults: Vec<LightFault> = file.lights.iter().enumerate().filter_map(in_wall).collect();
        let misplaced: BTreeSet<usize> = faults.iter().map(|f| f.index).collect();
        let makes = |lights: &[Placed<LightSource>], samples: usize| match Directions::new(samples) {
            Ok(directions) => {
                lights_of(lights.iter().map(|l| &**l), grid, directions).err().unwrap_or_default()
            }
            Err(_) => Vec::new(),
        };
        for fault in makes(&file.lights, SAMPLES) {
            let light = &file.lights[fault.index];
            // Whether a pulse hits a sample is known once the directions are.
            let is_pulse = fault.value == LightValue::Profile
                && matches!(light.profile.as_deref(), Some(ProfileShape::Pulse { .. }));
            let of_others = || {
                (8..=Directions::MAX)
                    .step_by(8)
                    .any(|samples| makes(std::slice::from_ref(light), samples).is_empty())
            };
            if !(misplaced.contains(&fault.index) || is_pulse && of_others()) {
                faults.push(fault);
            }
        }
        for LightFault { index, value, problem, place } in faults {
            self.faults.at(place.unwrap_or_else(|| place_of(&file.lights[index], value)), &problem);
        }
        file.lights.iter().map(|light| self.faults.fault(place_of(light, LightValue::Profile), "")).collect()
    }
}

/// Where a value of a light stands, or the light where it has no such value.
fn place_of(light: &Placed<LightSource>, value: LightValue) -> Place {
    let place = match value {
        LightValue::Cell => light.cell.as_ref().map(Placed::key),
        LightValue::Profile => light.profile.as_ref().map(Placed::key),
    };
    place.unwrap_or(light.place())
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
        FieldSource::Generator { .. } | FieldSource::Axes { .. } | FieldSource::Components { .. } => {}
    }
}
