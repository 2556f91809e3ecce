//! Parts of shapes and materials, put together.

use crate::wall::{Beside, Matrix, closed, diffuse, specular};
use crate::{Fault, SceneError, Shape};
use tigereye_core::{
    Cell, CellTransmission, CoreError, Directions, Field, Grid, Normalization, RateScale, Reflection,
    Surface, Tensor2, TransmissionField,
};

/// What a part of a scene is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Passes this fraction of the light on, equally in all directions: 1 for empty space, with which a part cuts a
    /// door into earlier parts.
    Clear {
        /// The part, 0 to 1.
        transmittance: f64,
    },
    /// Swallows all light.
    Absorber,
    /// Reflects like a mirror, on both sides.
    Mirror {
        /// The fraction of the light that is reflected, 0 to 1.
        reflectance: f64,
        /// Direction of the mirror's line, degrees. `None`: along the surface of the shape, and where that has no
        /// direction the cell faces whatever light arrives.
        angle_deg: Option<f64>,
    },
    /// Reflects like a diffuse wall, on both sides.
    Diffuse {
        /// The fraction of the light that is reflected, 0 to 1.
        reflectance: f64,
        /// Direction of the wall's line, degrees. `None`: along the surface of the shape, and where that has no
        /// direction the cell faces whatever light arrives.
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

/// A shape of one material. The surface is the whole shape's, whatever later parts cut out of it: the sides of a door
/// in a thick mirror reflect in the direction of the mirror's nearest border, unless an angle is given.
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

/// What lies where: a scene without its light.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// What each cell is; `None` for empty space.
    pub surfaces: Field<Option<Surface>>,
    /// Index of the part that each cell belongs to; `None` for empty space.
    pub part_of: Field<Option<usize>>,
}

impl Layout {
    /// Whether a cell is a wall: one that no light can be put into.
    #[must_use]
    pub fn is_wall(&self, cell: Cell) -> bool {
        self.surfaces.at(cell).is_some_and(|s| s.is_wall())
    }

    /// Cells that hold a matrix: mirrors and diffuse walls that light reaches.
    #[must_use]
    pub fn reflecting(&self) -> usize {
        self.surfaces.grid().iter().filter(|cell| self.reflects(*cell)).count()
    }

    /// Whether a cell sends light back. None arrives inside of thick walls.
    fn reflects(&self, cell: Cell) -> bool {
        matches!(self.surfaces.at(cell), Some(Surface::Mirror { .. } | Surface::Diffuse { .. }))
            && (0..8).any(|k| self.beside(cell, k) == Beside::Open)
    }

    fn beside(&self, cell: Cell, k: usize) -> Beside {
        match self.surfaces.grid().neighbour(cell, k).map(|next| *self.surfaces.at(next)) {
            Some(Some(Surface::Mirror { .. } | Surface::Diffuse { .. })) => Beside::Wall,
            Some(Some(Surface::Absorbing)) | None => Beside::End,
            Some(Some(Surface::Filter { .. } | Surface::Crystal) | None) => Beside::Open,
        }
    }
}

impl Scene {
    /// Most cells: a thousand by a thousand.
    pub const MAX_CELLS: usize = crate::limits::MAX_CELLS;
    /// Most tests of a cell against a side of a shape.
    pub const MAX_WORK: f64 = crate::limits::MAX_WORK;

    /// What lies where.
    ///
    /// # Errors
    /// Everything that is wrong with the parts, in their order.
    pub fn layout(&self) -> Result<Layout, Vec<SceneError>> {
        let (width, height) = (self.grid.width(), self.grid.height());
        if self.grid.cells() > Self::MAX_CELLS {
            return Err(vec![SceneError { part: None, fault: Fault::Size { width, height } }]);
        }
        // The last part that covers each cell.
        let mut last = vec![None; self.grid.cells()];
        let mut faults = Vec::new();
        let mut work = 0.0;
        for (i, part) in self.parts.iter().enumerate() {
            let fault = |fault| SceneError { part: Some(i), fault };
            if let Err(e) = part.shape.check().and_then(|()| part.material.check()) {
                faults.push(fault(e));
                continue;
            }
            if let Some([[x0, x1], [y0, y1]]) = part.shape.window(self.grid) {
                work += (x1 + 1 - x0) as f64 * (y1 + 1 - y0) as f64 * part.shape.detail() as f64;
            }
            if work > Self::MAX_WORK {
                faults.push(fault(Fault::Work));
                break;
            }
            let (mut is_empty, mut missing) = (true, None);
            for cell in self.cells_of(&part.shape) {
                is_empty = false;
                missing = missing.or_else(|| part.material.missing(cell));
                last[self.grid.index(cell)] = Some(i);
            }
            let outside = is_empty.then_some(Fault::Outside { width, height });
            faults.extend(outside.or(missing).map(fault));
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let part_of = Field::from_fn(self.grid, |cell| last[self.grid.index(cell)]);
        let surfaces = Field::from_fn(self.grid, |cell| self.surface(cell, *part_of.at(cell)));
        Ok(Layout { surfaces, part_of })
    }

    /// What each cell does to light, in `directions`.
    ///
    /// # Errors
    /// [`SceneError`] for a crystal with a tensor that is not finite, or one that is normalised by a fraction outside 0
    /// to 1; for more samples than [`TransmissionField::MAX_SAMPLES`].
    ///
    /// # Panics
    /// For the layout of another scene.
    pub fn transmission(
        &self,
        layout: &Layout,
        directions: Directions,
    ) -> Result<TransmissionField, SceneError> {
        let scale = |part: &Part| match &part.material {
            Material::Crystal { field, normalization, .. } => {
                RateScale::of(field, directions, *normalization).map(Some)
            }
            _ => Ok(None),
        };
        let scales: Vec<Option<RateScale>> = (self.parts.iter().enumerate())
            .map(|(i, p)| scale(p).map_err(|e| SceneError { part: Some(i), fault: e.into() }))
            .collect::<Result<_, _>>()?;
        let whole = |fault: CoreError| SceneError { part: None, fault: fault.into() };
        let open = TransmissionField::assembled(self.grid, directions, |cell| {
            let Some(i) = *layout.part_of.at(cell) else { return CellTransmission::Isotropic(1.0) };
            match (&self.parts[i].material, &scales[i]) {
                (Material::Crystal { field, at, .. }, Some(scale)) => {
                    CellTransmission::Tensor(field.at(Cell::new(cell.x - at.x, cell.y - at.y)), scale)
                }
                (Material::Clear { transmittance }, _) => CellTransmission::Isotropic(*transmittance),
                _ => CellTransmission::Isotropic(0.0),
            }
        });
        let mut reflections = Vec::new();
        for cell in self.grid.iter() {
            if let Some(matrix) = self.reflected(layout, cell) {
                reflections.push((cell, Reflection::new(matrix).map_err(whole)?));
            }
        }
        Ok(open.map_err(whole)?.with_reflections(reflections))
    }

    /// What a cell that sends light back makes of it. `None` inside of thick walls, where none arrives.
    fn reflected(&self, layout: &Layout, cell: Cell) -> Option<Matrix> {
        let (Some(surface), Some(part)) = (layout.surfaces.at(cell), *layout.part_of.at(cell)) else {
            return None;
        };
        let sent = match surface {
            _ if !layout.reflects(cell) => return None,
            Surface::Mirror { angle_deg } => specular(*angle_deg),
            Surface::Diffuse { angle_deg } => diffuse(*angle_deg),
            _ => return None,
        };
        let (Material::Mirror { reflectance, .. } | Material::Diffuse { reflectance, .. }) =
            &self.parts[part].material
        else {
            return None;
        };
        Some(closed(sent, |k| layout.beside(cell, k)).map(|row| row.map(|share| reflectance * share)))
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

    fn surface(&self, cell: Cell, part: Option<usize>) -> Option<Surface> {
        let part = &self.parts[part?];
        let angle = |given: Option<f64>| {
            given.map(|deg| deg.rem_euclid(180.0)).or_else(|| part.shape.surface_deg(self.grid, cell))
        };
        match part.material {
            Material::Clear { transmittance: 1.0 } => None,
            // Where a crystal passes nothing on, it is a dark wall.
            Material::Crystal { ref field, at, .. }
                if *field.at(Cell::new(cell.x - at.x, cell.y - at.y)) == Tensor2::ZERO =>
            {
                Some(Surface::Absorbing)
            }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> Directions {
        Directions::new(16).expect("directions")
    }

    fn scene(parts: Vec<Part>) -> Scene {
        Scene { grid: Grid::new(9, 7).expect("a grid"), parts }
    }

    fn transmission(scene: &Scene) -> TransmissionField {
        scene.transmission(&scene.layout().expect("a layout"), directions()).expect("a transmission")
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
        let layout = s.layout().expect("a layout");
        assert!(layout.is_wall(Cell::new(3, 3)) && !layout.is_wall(Cell::new(4, 3)));
        assert_eq!(transmission(&s).rates().iter().filter(|r| **r == 0.0).count(), 8);
        let door = Cell::new(4, 3);
        assert_eq!(*layout.surfaces.at(door), None, "a door is empty space");
        assert_eq!((*layout.part_of.at(door), *layout.part_of.at(Cell::new(0, 0))), (Some(1), None));
    }

    #[test]
    fn crystals_are_dark_walls_where_their_tensor_is_zero() {
        let field = Field::from_fn(Grid::new(9, 7).expect("a grid"), |c| {
            if c.x < 4 { Tensor2::ZERO } else { Tensor2::IDENTITY }
        });
        let at = Cell::new(0, 0);
        let s = scene(vec![
            row(3.0, Material::Crystal { field, at, normalization: Normalization::Local }),
            Part {
                shape: Shape::Rectangle { from: [2.0, 3.0], to: [2.0, 3.0] },
                material: Material::Mirror { reflectance: 1.0, angle_deg: Some(0.0) },
            },
        ]);
        let layout = s.layout().expect("a layout");
        assert_eq!(*layout.surfaces.at(Cell::new(1, 3)), Some(Surface::Absorbing));
        assert_eq!(*layout.surfaces.at(Cell::new(5, 3)), Some(Surface::Crystal));
        // No light gets round the mirror through the dark cells beside it.
        let mirror = transmission(&s).reflection(Cell::new(2, 3)).expect("a mirror").clone();
        let mut down = [0.0; 8];
        down[6] = 1.0;
        let sent = mirror.reflected(&down);
        assert_eq!((sent[5], sent[6], sent[7]), (0.0, 0.0, 0.0), "{sent:?}");
    }

    #[test]
    fn walls_have_the_matrices_of_their_material() {
        let s = scene(vec![row(2.0, Material::Mirror { reflectance: 0.5, angle_deg: None })]);
        let made = transmission(&s);
        let wall = made.reflection(Cell::new(4, 2)).expect("a wall");
        let mut up_right = [0.0; 8];
        up_right[1] = 2.0;
        assert_eq!(wall.reflected(&up_right)[7], 1.0);
        assert_eq!(
            *s.layout().expect("a layout").surfaces.at(Cell::new(4, 2)),
            Some(Surface::Mirror { angle_deg: Some(0.0) })
        );
    }

    #[test]
    fn given_angles_turn_walls_from_their_surface() {
        let given = |angle_deg| {
            let s = scene(vec![
                row(2.0, Material::Mirror { reflectance: 1.0, angle_deg: Some(angle_deg) }),
                row(4.0, Material::Diffuse { reflectance: 1.0, angle_deg: Some(angle_deg) }),
            ]);
            let layout = s.layout().expect("a layout");
            let angles = [2, 4].map(|y| match *layout.surfaces.at(Cell::new(4, y)) {
                Some(Surface::Mirror { angle_deg } | Surface::Diffuse { angle_deg }) => angle_deg,
                other => panic!("{other:?}"),
            });
            assert_eq!(angles[0], angles[1]);
            (angles[0], transmission(&s).reflection(Cell::new(4, 2)).expect("a wall").shares()[3][6])
        };
        // Light that falls down on a mirror at 22.5 degrees leaves up to the left.
        assert_eq!((given(22.5), given(202.5)), ((Some(22.5), 1.0), (Some(22.5), 1.0)));
        assert_eq!((given(-30.0).0, given(0.0)), (Some(150.0), (Some(0.0), 0.0)));
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
        let made = transmission(&scene(vec![part(Cell::new(3, 3))]));
        let own =
            TransmissionField::from_tensors(&field, directions(), Normalization::Local).expect("a field");
        assert_eq!(made.shape(Cell::new(4, 5)), own.shape(Cell::new(1, 2)));
        assert_eq!(made.shape(Cell::new(3, 3)), [1.0; 16], "outside of the disc");
        let e = scene(vec![part(Cell::new(4, 3))]).layout().expect_err("too far right");
        assert!(
            matches!(e[..], [SceneError { fault: Fault::Crystal { left: 4, top: 3, x: 3, y: 4, .. }, .. }]),
            "{e:?}"
        );
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
        let faults = |s: &Scene| s.layout().expect_err("faults");
        let parts: Vec<_> = faults(&s).iter().map(|f| f.part).collect();
        assert_eq!(parts, [Some(0), Some(2), Some(3)]);
        let huge = Scene { grid: Grid::new(2000, 2000).expect("a grid"), parts: Vec::new() };
        assert!(matches!(faults(&huge)[..], [SceneError { fault: Fault::Size { .. }, .. }]));
        let ring: Vec<[f64; 2]> = (0..50_000).map(|i| [f64::from(i % 7), f64::from(i % 5)]).collect();
        let detailed = Part { shape: Shape::Polygon(ring), material: Material::Absorber };
        let large = Scene {
            grid: Grid::new(1000, 1000).expect("a grid"),
            parts: vec![Part {
                shape: Shape::Outside(Box::new(detailed.shape.clone())),
                material: Material::Absorber,
            }],
        };
        assert!(matches!(faults(&large)[..], [SceneError { fault: Fault::Work, .. }]));
    }

    #[test]
    fn only_the_skin_of_a_thick_wall_reflects() {
        let block = Shape::Rectangle { from: [2.0, 1.0], to: [6.0, 5.0] };
        let mirror = Material::Mirror { reflectance: 1.0, angle_deg: None };
        let s = scene(vec![Part { shape: block, material: mirror }]);
        let (made, layout) = (transmission(&s), s.layout().expect("a layout"));
        assert_eq!(layout.surfaces.values().iter().flatten().filter(|s| s.is_wall()).count(), 25);
        assert_eq!(made.reflections().count(), 16);
        assert!(made.reflection(Cell::new(3, 2)).is_none() && made.rate(Cell::new(3, 2)) == 0.0);
    }
}
