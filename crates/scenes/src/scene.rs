//! Parts of shapes and materials, put together.

use crate::wall::{Beside, closed, diffuse, specular};
use crate::{Fault, SceneError, Shape};
use tigereye_core::{
    Cell, CellTransmission, Directions, Field, Grid, Normalization, Reflection, Surface, Tensor2,
    TransmissionField,
};

/// What a part of a scene is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Passes this part of the light on, in all directions alike: 1 for empty space, with which a part cuts a door into those
    /// before it.
    Clear {
        /// The part, 0 to 1.
        transmittance: f64,
    },
    /// Swallows all light.
    Absorber,
    /// Reflects like a mirror, on both sides.
    Mirror {
        /// The part of the light that is sent back, 0 to 1.
        reflectance: f64,
        /// Direction of the mirror's line, degrees; along the surface of the shape where there is none.
        angle_deg: Option<f64>,
    },
    /// Reflects like a matt wall, on both sides.
    Diffuse {
        /// The part of the light that is sent back, 0 to 1.
        reflectance: f64,
        /// Direction of the wall's line, degrees; along the surface of the shape where there is none.
        angle_deg: Option<f64>,
    },
    /// Passes light on as the tensors of a field do.
    Crystal {
        /// The tensors.
        field: Field<Tensor2>,
        /// Where its upper left cell lies.
        at: Cell,
        /// How their transmission is scaled, by the means of this field.
        normalization: Normalization,
    },
}

/// A shape of one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Where it is.
    pub shape: Shape,
    /// What it is made of.
    pub material: Material,
}

/// Parts on a grid of empty space; later ones cover earlier ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The cells.
    pub grid: Grid,
    /// The parts, in the order in which they are put down.
    pub parts: Vec<Part>,
}

/// A scene as light finds it.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltScene {
    /// What each cell does to light.
    pub transmission: TransmissionField,
    /// What each cell is; `None` for empty space.
    pub surfaces: Field<Option<Surface>>,
    /// The part that each cell belongs to.
    pub parts: Field<Option<usize>>,
}

impl BuiltScene {
    /// Whether a cell is a wall: one that no light can be put into.
    #[must_use]
    pub fn is_wall(&self, cell: Cell) -> bool {
        self.surfaces.at(cell).is_some_and(|s| s.is_wall())
    }
}

impl Scene {
    /// Most cells: a thousand by a thousand.
    pub const MAX_CELLS: usize = 1 << 20;
    /// Most tests of a cell against a side of a shape.
    pub const MAX_WORK: f64 = 1e8;

    /// The cells with their transmission in `directions`.
    ///
    /// # Errors
    /// [`SceneError`] for the first part that is at fault; [`Self::faults`] finds them all.
    pub fn built(&self, directions: Directions) -> Result<BuiltScene, SceneError> {
        if let Some(fault) = self.faults().into_iter().next() {
            return Err(fault);
        }
        let parts = self.painted();
        let of_crystal = |part: &Part| match &part.material {
            Material::Crystal { field, normalization, .. } => {
                TransmissionField::from_tensors(field, directions, *normalization).map(Some)
            }
            _ => Ok(None),
        };
        let crystals: Vec<Option<TransmissionField>> = (self.parts.iter().enumerate())
            .map(|(i, p)| of_crystal(p).map_err(|e| SceneError { part: Some(i), fault: e.into() }))
            .collect::<Result<_, _>>()?;
        let surfaces = Field::from_fn(self.grid, |cell| self.surface(cell, *parts.at(cell)));
        let whole = |fault: tigereye_core::CoreError| SceneError { part: None, fault: fault.into() };
        let mut walls = Vec::new();
        for cell in self.grid.iter() {
            if let Some(parts) = reflection(self, &parts, &surfaces, cell) {
                walls.push((cell, Reflection::new(parts).map_err(whole)?));
            }
        }
        // Both go row by row.
        let mut walls = walls.iter().peekable();
        let transmission = TransmissionField::assembled(self.grid, directions, |cell| {
            let material = parts.at(cell).map(|i| (i, &self.parts[i].material));
            match (walls.next_if(|(wall, _)| *wall == cell), material) {
                (Some((_, reflection)), _) => CellTransmission::Reflecting(reflection),
                (None, Some((i, Material::Crystal { at, .. }))) => match &crystals[i] {
                    Some(crystal) => CellTransmission::Of(crystal, Cell::new(cell.x - at.x, cell.y - at.y)),
                    None => CellTransmission::Isotropic(0.0),
                },
                (None, Some((_, Material::Clear { transmittance }))) => {
                    CellTransmission::Isotropic(*transmittance)
                }
                (None, Some(_)) => CellTransmission::Isotropic(0.0),
                (None, None) => CellTransmission::Isotropic(1.0),
            }
        });
        Ok(BuiltScene { transmission: transmission.map_err(whole)?, surfaces, parts })
    }

    /// Everything that is wrong with the parts, in their order.
    #[must_use]
    pub fn faults(&self) -> Vec<SceneError> {
        let (width, height) = (self.grid.width(), self.grid.height());
        if self.grid.cells() > Self::MAX_CELLS {
            return vec![SceneError { part: None, fault: Fault::Size { width, height } }];
        }
        let mut faults = Vec::new();
        let mut work = 0.0;
        for (i, part) in self.parts.iter().enumerate() {
            if let Err(fault) = part.shape.check().and_then(|()| part.material.check()) {
                faults.push(SceneError { part: Some(i), fault });
                continue;
            }
            if let Some([[x0, x1], [y0, y1]]) = part.shape.window(self.grid) {
                work += (x1 + 1 - x0) as f64 * (y1 + 1 - y0) as f64 * part.shape.detail() as f64;
            }
            if work > Self::MAX_WORK {
                faults.push(SceneError { part: Some(i), fault: Fault::Work { work } });
                return faults;
            }
            let mut cells = self.cells_of(&part.shape).peekable();
            if cells.peek().is_none() {
                faults.push(SceneError { part: Some(i), fault: Fault::Outside { width, height } });
            } else if let Some(fault) = cells.find_map(|cell| part.material.missing(cell)) {
                faults.push(SceneError { part: Some(i), fault });
            }
        }
        faults
    }

    fn cells_of<'a>(&self, shape: &'a Shape) -> impl Iterator<Item = Cell> + use<'a> {
        let window = shape.window(self.grid);
        window
            .into_iter()
            .flat_map(|[xs, ys]| {
                (ys[0]..=ys[1]).flat_map(move |y| (xs[0]..=xs[1]).map(move |x| Cell::new(x, y)))
            })
            .filter(|cell| shape.contains(*cell))
    }

    /// The last part that covers each cell.
    fn painted(&self) -> Field<Option<usize>> {
        let mut last = vec![None; self.grid.cells()];
        for (i, part) in self.parts.iter().enumerate() {
            for cell in self.cells_of(&part.shape) {
                last[self.grid.index(cell)] = Some(i);
            }
        }
        Field::from_fn(self.grid, |cell| last[self.grid.index(cell)])
    }

    fn surface(&self, cell: Cell, part: Option<usize>) -> Option<Surface> {
        let part = &self.parts[part?];
        let angle = |given: Option<f64>| {
            given.map_or_else(|| part.shape.surface_deg(cell), |deg| deg.rem_euclid(180.0))
        };
        match part.material {
            Material::Clear { transmittance: 1.0 } => None,
            Material::Crystal { .. } => Some(Surface::Crystal),
            Material::Clear { transmittance: 0.0 } | Material::Absorber => Some(Surface::Absorbing),
            Material::Clear { transmittance } => Some(Surface::Filter { transmittance }),
            Material::Mirror { angle_deg, .. } => Some(Surface::Mirror { angle_deg: angle(angle_deg) }),
            Material::Diffuse { angle_deg, .. } => Some(Surface::Diffuse { angle_deg: angle(angle_deg) }),
        }
    }
}

impl Material {
    fn check(&self) -> Result<(), Fault> {
        let share = |what, value: f64| match (0.0..=1.0).contains(&value) {
            true => Ok(()),
            false => Err(Fault::Share { what, value }),
        };
        match self {
            Self::Clear { transmittance } => share("transmittance", *transmittance),
            Self::Absorber | Self::Crystal { .. } => Ok(()),
            Self::Mirror { reflectance, angle_deg } | Self::Diffuse { reflectance, angle_deg } => {
                share("reflectance", *reflectance)?;
                match angle_deg {
                    Some(value) if !value.is_finite() => Err(Fault::Angle { value: *value }),
                    _ => Ok(()),
                }
            }
        }
    }

    /// What is wrong with a cell of the shape: no tensor.
    fn missing(&self, Cell { x, y }: Cell) -> Option<Fault> {
        let Self::Crystal { field, at, .. } = self else { return None };
        let (width, height) = (field.grid().width(), field.grid().height());
        let there =
            x.checked_sub(at.x).is_some_and(|x| x < width) && y.checked_sub(at.y).is_some_and(|y| y < height);
        (!there).then_some(Fault::Crystal { width, height, left: at.x, top: at.y, x, y })
    }
}

/// What a wall sends back.
fn reflection(
    scene: &Scene,
    parts: &Field<Option<usize>>,
    surfaces: &Field<Option<Surface>>,
    cell: Cell,
) -> Option<[[f64; 8]; 8]> {
    let sent = match surfaces.at(cell) {
        Some(Surface::Mirror { angle_deg }) => specular(*angle_deg),
        Some(Surface::Diffuse { angle_deg }) => diffuse(*angle_deg),
        _ => return None,
    };
    let reflectance = match parts.at(cell).map(|i| &scene.parts[i].material) {
        Some(Material::Mirror { reflectance, .. } | Material::Diffuse { reflectance, .. }) => *reflectance,
        _ => return None,
    };
    let beside = |k: usize| match scene.grid.neighbour(cell, k).map(|next| *surfaces.at(next)) {
        Some(Some(Surface::Mirror { .. } | Surface::Diffuse { .. })) => Beside::Wall,
        Some(Some(Surface::Absorbing)) | None => Beside::End,
        Some(Some(Surface::Filter { .. } | Surface::Crystal) | None) => Beside::Open,
    };
    Some(closed(sent, beside).map(|row| row.map(|part| reflectance * part)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> Directions {
        Directions::new(16).expect("directions")
    }

    fn scene(parts: Vec<Part>) -> Scene {
        Scene { grid: Grid::new(9, 7).expect("a grid"), parts }
    }

    fn row(y: f64, material: Material) -> Part {
        Part { shape: Shape::Segment { from: [0.0, y], to: [8.0, y], thickness: 1.0 }, material }
    }

    #[test]
    fn later_parts_cover_earlier_ones() {
        let door = Shape::Rectangle { from: [4.0, 3.0], to: [4.0, 3.0] };
        let s = scene(vec![
            row(3.0, Material::Absorber),
            Part { shape: door, material: Material::Clear { transmittance: 1.0 } },
        ]);
        let built = s.built(directions()).expect("a scene");
        assert!(built.is_wall(Cell::new(3, 3)) && !built.is_wall(Cell::new(4, 3)));
        assert_eq!(built.transmission.rates().iter().filter(|r| **r == 0.0).count(), 8);
        assert_eq!((*built.parts.at(Cell::new(4, 3)), *built.parts.at(Cell::new(0, 0))), (Some(1), None));
    }

    #[test]
    fn walls_have_the_matrices_of_their_material() {
        let s = scene(vec![row(2.0, Material::Mirror { reflectance: 0.5, angle_deg: None })]);
        let built = s.built(directions()).expect("a scene");
        let wall = built.transmission.reflection(Cell::new(4, 2)).expect("a wall");
        let mut up_right = [0.0; 8];
        up_right[1] = 2.0;
        assert_eq!(wall.reflected(&up_right)[7], 1.0);
        assert_eq!(*built.surfaces.at(Cell::new(4, 2)), Some(Surface::Mirror { angle_deg: 0.0 }));
    }

    #[test]
    fn crystals_lie_where_they_are_put() {
        let field = Field::from_fn(Grid::new(3, 3).expect("a grid"), |c| {
            Tensor2::from_axes(0.1 * (c.x + 3 * c.y) as f64, 1.0, 0.3)
        });
        let shape = Shape::Disc { centre: [4.0, 4.0], radius: 1.0 };
        let crystal =
            |at| Material::Crystal { field: field.clone(), at, normalization: Normalization::Local };
        let part = |at| Part { shape: shape.clone(), material: crystal(at) };
        let built = scene(vec![part(Cell::new(3, 3))]).built(directions()).expect("a scene");
        let own =
            TransmissionField::from_tensors(&field, directions(), Normalization::Local).expect("a field");
        assert_eq!(built.transmission.shape(Cell::new(4, 5)), own.shape(Cell::new(1, 2)));
        assert_eq!(built.transmission.shape(Cell::new(3, 3)), [1.0; 16], "outside of the disc");
        let e = scene(vec![part(Cell::new(4, 3))]).built(directions()).expect_err("too far right");
        assert!(matches!(e.fault, Fault::Crystal { left: 4, top: 3, x: 3, y: 4, .. }), "{e}");
    }

    #[test]
    fn every_faulty_part_is_named() {
        let far = Shape::Disc { centre: [100.0, 3.0], radius: 2.0 };
        let s = scene(vec![
            row(1.0, Material::Mirror { reflectance: 1.5, angle_deg: None }),
            row(2.0, Material::Absorber),
            Part { shape: far, material: Material::Absorber },
            row(4.0, Material::Diffuse { reflectance: 1.0, angle_deg: Some(f64::NAN) }),
        ]);
        let parts: Vec<_> = s.faults().iter().map(|f| f.part).collect();
        assert_eq!(parts, [Some(0), Some(2), Some(3)]);
        assert!(s.built(directions()).is_err());
        let huge = Scene { grid: Grid::new(2000, 2000).expect("a grid"), parts: Vec::new() };
        assert!(matches!(huge.built(directions()), Err(SceneError { fault: Fault::Size { .. }, .. })));
        let ring: Vec<[f64; 2]> = (0..50_000).map(|i| [f64::from(i % 7), f64::from(i % 5)]).collect();
        let detailed = Part { shape: Shape::Polygon(ring), material: Material::Absorber };
        let large = Scene {
            grid: Grid::new(1000, 1000).expect("a grid"),
            parts: vec![Part {
                shape: Shape::Outside(Box::new(detailed.shape.clone())),
                material: Material::Absorber,
            }],
        };
        assert!(matches!(large.faults()[..], [SceneError { fault: Fault::Work { .. }, .. }]));
    }
}
