//! From a volume to a field in a plane.

use super::choice::{Axis, Plane, PlaneChoice};
use super::error::VolumeError;
use super::geometry::{PlaneGeometry, world_axes};
use super::lattice::Lattice;
use super::matrix3::turned;
use super::meaning::{Frame, World};
use super::names::axes_of_vectors;
use super::tensors::TensorVolume;
use crate::IoError;
use tigereye_core::math::hypot;
use tigereye_core::{Field, Grid, Tensor2};

/// Cosine between the normal of a plane and an axis from which on the plane is across to the axis: files hold
/// directions in single precision.
const ACROSS: f64 = 1.0 - 1e-6;
/// The same up to which the plane holds the axis.
const ALONG: f64 = 1e-3;

const fn is_by_voxels(frame: Frame) -> bool {
    matches!(frame, Frame::Voxel | Frame::Fsl)
}

/// A voxel axis in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Side {
    /// The voxel axis.
    voxel: usize,
    /// The world axis it is assigned to.
    world: usize,
    /// Whether it runs against that.
    reversed: bool,
}

impl Side {
    const fn sign(self) -> f64 {
        if self.reversed { -1.0 } else { 1.0 }
    }

    /// The voxel in a column from the left, or in a row from below.
    const fn voxel_at(self, at: usize, count: usize) -> usize {
        if self.reversed { count - 1 - at } else { at }
    }
}

/// Which voxels a plane is made of, and how they lie in the picture: as the world has them. Of the two axes of the
/// plane the one along the lower world axis runs to the right (x before y before z) and the other one up, both the way
/// the world's do, whatever the order and the signs of the voxel axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// The plane.
    pub plane: Plane,
    /// Index of the slice.
    pub index: usize,
    /// Where its cells lie.
    pub geometry: PlaneGeometry,
    right: Side,
    up: Side,
    /// What right and up are in the world, in words.
    words: Option<[String; 2]>,
    grid: Grid,
    size: [usize; 3],
}

/// A field in a plane of a volume, and how it lies there.
#[derive(Clone, Debug, PartialEq)]
pub struct Slice<T> {
    /// The values, row 0 on top, in the frame x right, y up of the picture.
    pub field: Field<T>,
    /// Which voxels they are.
    pub cut: Cut,
}

impl Cut {
    /// Whether columns, and rows from below, run against their voxel axes.
    #[must_use]
    pub const fn reversed(&self) -> [bool; 2] {
        [self.right.reversed, self.up.reversed]
    }

    /// How the picture was made, in a sentence; `dropped` is what became of the third direction.
    #[must_use]
    pub fn story(&self, dropped: &str) -> String {
        let name =
            |side: Side| format!("{}{}", if side.reversed { "-" } else { "" }, Axis::ALL[side.voxel].name());
        let [right, up] = self
            .words
            .as_ref()
            .map_or_else(Default::default, |words| words.each_ref().map(|words| format!(" ({words})")));
        let rows = match (&self.words, self.up.reversed) {
            (Some(_), _) => "",
            (None, true) => "; rows as in the file",
            (None, false) => "; rows flipped, the file runs upwards",
        };
        format!(
            "plane {}, slice {}={}: voxel axis {} to the right{right}, {} up{up}{dropped}{rows}",
            self.plane.name(),
            self.plane.normal().name(),
            self.index,
            name(self.right),
            name(self.up),
        )
    }

    /// A field of what `value` says of each voxel, by its index `(k * ny + j) * nx + i`.
    pub(super) fn field<T>(&self, mut value: impl FnMut(usize) -> T) -> Field<T> {
        let (width, height) = (self.grid.width(), self.grid.height());
        Field::from_fn(self.grid, |c| {
            let mut at = [self.index; 3];
            at[self.right.voxel] = self.right.voxel_at(c.x, width);
            at[self.up.voxel] = self.up.voxel_at(height - 1 - c.y, height);
            value((at[2] * self.size[1] + at[1]) * self.size[0] + at[0])
        })
    }
}

impl Lattice {
    /// The voxels of a plane, as the world has them.
    ///
    /// # Errors
    /// As [`PlaneChoice::resolve`].
    pub fn cut(&self, choice: PlaneChoice) -> Result<Cut, IoError> {
        let assigned = world_axes(&self.axes);
        let (plane, index) = self.with_own_plane(choice, assigned).resolve(self.size)?;
        let directions = self.directions();
        let side = |voxel: usize| {
            let world = assigned[voxel];
            Side { voxel, world, reversed: directions[3 * world + voxel] < 0.0 }
        };
        let (a, b) = plane.axes();
        let (right, up) = if assigned[a] < assigned[b] { (side(a), side(b)) } else { (side(b), side(a)) };
        let geometry = self.geometry([right, up], plane.normal() as usize, index);
        let words = self.has_world().then(|| {
            [(right, geometry.right()), (up, geometry.up())].map(|(side, v)| self.world.words(side.world, v))
        });
        Ok(Cut {
            plane,
            index,
            geometry,
            right,
            up,
            words,
            grid: Grid::new(self.size[right.voxel], self.size[up.voxel])?,
            size: self.size,
        })
    }

    /// The world's axis that is vertical in the picture of a single layer.
    pub(crate) fn vertical_axis(&self) -> Option<char> {
        let cut = self.cut(PlaneChoice::default()).ok()?;
        Some(Axis::ALL[cut.up.world].name())
    }

    /// Of several axes of one voxel, that of the last world axis is the normal where nobody chooses, so that a single
    /// row is in the same plane whatever the order of its axes.
    fn with_own_plane(&self, choice: PlaneChoice, assigned: [usize; 3]) -> PlaneChoice {
        if choice != PlaneChoice::default() {
            return choice;
        }
        let flat = (0..3).filter(|&a| self.size[a] == 1).max_by_key(|&a| assigned[a]);
        flat.map_or(choice, |a| PlaneChoice { plane: Some(Plane::of_normal(Axis::ALL[a])), slice: None })
    }

    /// Whether the file says where its voxels lie.
    fn has_world(&self) -> bool {
        self.world != World::Absent
    }

    /// Where the cells of a plane lie.
    fn geometry(&self, sides: [Side; 2], normal: usize, index: usize) -> PlaneGeometry {
        let (spacing, directions) = (self.spacing(), self.directions());
        let mut steps = [0.0; 3];
        steps[normal] = index as f64;
        for side in sides {
            steps[side.voxel] = side.voxel_at(0, self.size[side.voxel]) as f64;
        }
        let corner =
            [0, 1, 2].map(|i| self.origin[i] + (0..3).map(|a| steps[a] * self.axes[a][i]).sum::<f64>());
        let [right, up] = sides.map(|side| [0, 1, 2].map(|i| side.sign() * directions[3 * i + side.voxel]));
        let geometry = PlaneGeometry::new(corner, right, up, sides.map(|side| spacing[side.voxel]));
        if self.has_world() { geometry } else { geometry.flat() }
    }

    /// One number a voxel, in a plane.
    ///
    /// # Errors
    /// [`VolumeError::TupleSize`] for tuples, and as [`Self::cut`].
    pub fn scalars(&self, choice: PlaneChoice) -> Result<Slice<f64>, IoError> {
        if self.components != 1 {
            return Err(self.tuple_size("one number a voxel").into());
        }
        // Distances along the axes are those of the world at right angles only.
        self.orthogonal_directions()?;
        let cut = self.cut(choice)?;
        Ok(Slice { field: cut.field(|voxel| self.values[voxel]), cut })
    }

    /// Vectors of two or three components projected into a plane, along x (right) and y (up) of the picture.
    ///
    /// # Errors
    /// [`VolumeError::TupleSize`] for other tuples, [`VolumeError::SkewedAxes`], and as [`Self::cut`].
    pub fn vectors(&self, choice: PlaneChoice, frame: Option<Frame>) -> Result<Slice<[f64; 2]>, IoError> {
        if !(2..=3).contains(&self.components) {
            return Err(self.tuple_size("two or three").into());
        }
        let cut = self.cut(choice)?;
        let frame = frame.unwrap_or(self.frame.0);
        let turn = self.to_voxel(frame)?;
        let axes = self.axes_of_components(&cut, frame)?;
        let field = cut.field(|voxel| {
            let mut v = [0.0; 3];
            let from = voxel * self.components;
            axes.iter().zip(&self.values[from..from + self.components]).for_each(|(&axis, &c)| v[axis] = c);
            if let Some(k) = &turn {
                v = [0, 1, 2].map(|i| k[3 * i] * v[0] + k[3 * i + 1] * v[1] + k[3 * i + 2] * v[2]);
            }
            [cut.right, cut.up].map(|side| side.sign() * v[side.voxel])
        });
        Ok(Slice { field, cut })
    }

    /// The axes that the components of vectors are along, in their frame: by their names, else in the order x, y, z.
    /// Two components must lie in the plane: of what is across to them nothing is known.
    fn axes_of_components(&self, cut: &Cut, frame: Frame) -> Result<Vec<usize>, IoError> {
        let named = axes_of_vectors(&self.component_names).filter(|axes| axes.len() == self.components);
        let axes = named.unwrap_or_else(|| (0..self.components).collect());
        let missing = (0..3).find(|axis| !axes.contains(axis));
        let Some(missing) = missing.filter(|&axis| self.across(cut, frame, axis) < ACROSS) else {
            return Ok(axes);
        };
        let name = |axis: usize| Axis::ALL[axis].name();
        let others = |axis: usize| (0..3).filter(move |&a| a != axis).map(name);
        let [found, shown] = [others(missing).collect(), self.words_of_axes(cut, frame)]
            .map(|axes: Vec<char>| axes.iter().map(char::to_string).collect::<Vec<_>>().join(" and "));
        let is_tilted = self.across(cut, frame, missing) > ALONG;
        let by_voxels = is_by_voxels(frame) || cut.plane.normal() as usize != missing;
        Err(VolumeError::VectorsAcross {
            array: self.array.clone(),
            found,
            shown: if is_tilted { "is tilted against these".to_owned() } else { format!("shows {shown}") },
            help: match (by_voxels, is_tilted) {
                (false, _) => ", or --frame voxel where they are along the axes of the file",
                (true, true) => "",
                (true, false) => {
                    ", or two named after the axes of the plane (u and w; --components X=NAME,Z=NAME)"
                }
            },
        }
        .into())
    }

    /// The two axes of a frame that a plane mainly shows.
    fn words_of_axes(&self, cut: &Cut, frame: Frame) -> Vec<char> {
        let mut shown = [cut.right, cut.up].map(|s| if is_by_voxels(frame) { s.voxel } else { s.world });
        shown.sort_unstable();
        shown.iter().map(|&axis| Axis::ALL[axis].name()).collect()
    }

    /// The cosine between the normal of a plane and an axis of the components: 1 where the plane lies along the two
    /// others, 0 where it shows the axis.
    fn across(&self, cut: &Cut, frame: Frame, axis: usize) -> f64 {
        let normal = cut.plane.normal() as usize;
        if is_by_voxels(frame) {
            return f64::from(u8::from(normal == axis));
        }
        let unit = |v: [f64; 3]| {
            let length = hypot(hypot(v[0], v[1]), v[2]);
            v.map(|c| c / length)
        };
        let d = self.directions();
        let column = |m: &[f64; 9], a: usize| [m[a], m[a + 3], m[a + 6]];
        let (a, b) = cut.plane.axes();
        let ([a, b, c], [d, e, f]) = (column(&d, a), column(&d, b));
        let normal = unit([b * f - c * e, c * d - a * f, a * e - b * d]);
        let frame = match (frame, self.measurement) {
            (Frame::Measurement, Some(m)) => unit(column(&m, axis)),
            (Frame::Measurement, None) | (Frame::Voxel | Frame::World | Frame::Fsl | Frame::Lps, _) => {
                [0, 1, 2].map(|i| f64::from(u8::from(i == axis)))
            }
        };
        (0..3).map(|i| normal[i] * frame[i]).sum::<f64>().abs()
    }

    /// Which cells of a plane the mask leaves out; `None` where there is no mask.
    #[must_use]
    pub fn mask_in(&self, cut: &Cut) -> Option<Field<bool>> {
        let mask = self.mask.as_ref()?;
        Some(cut.field(|voxel| mask.get(voxel) == Some(&0.0)))
    }

    fn tuple_size(&self, expected: &'static str) -> VolumeError {
        VolumeError::TupleSize { array: self.array.clone(), components: self.components, expected }
    }
}

impl TensorVolume {
    /// The field in a plane. Tensors are turned into the axes of the picture and lose the third row and column, so that
    /// direction 90 degrees is up in the picture. Voxels with mask 0 become zero tensors.
    ///
    /// # Errors
    /// [`VolumeError::SkewedAxes`], and as [`Lattice::cut`].
    pub fn slice(&self, choice: PlaneChoice) -> Result<Slice<Tensor2>, IoError> {
        let cut = self.lattice.cut(choice)?;
        self.check_components(&cut)?;
        let (right, up) = (cut.right.voxel, cut.up.voxel);
        let turn = self.lattice.to_voxel(self.frame.0)?;
        // One reversed axis changes the sign of the off-diagonal components.
        let mirrored = cut.right.reversed != cut.up.reversed;
        let field = cut.field(|voxel| {
            if self.is_masked(voxel) {
                return Tensor2::ZERO;
            }
            let t = self.stored(voxel);
            let t = turn.as_ref().map_or(t, |k| turned(k, &t));
            let (xx, xy) = (t[3 * right + right], t[3 * right + up]);
            let (yx, yy) = (t[3 * up + right], t[3 * up + up]);
            let plain = Tensor2::new(xx, xy, yx, yy);
            if mirrored { plain.mirrored_y() } else { plain }
        });
        Ok(Slice { field, cut })
    }

    /// What is assumed of a plane that is tilted against the two axes that the components are along, in words.
    #[must_use]
    pub fn tilted(&self, cut: &Cut) -> Option<String> {
        let missing = self.missing_axis()?;
        (self.lattice.across(cut, self.frame.0, missing) < ACROSS).then(|| {
            let order = self.order.0;
            let axis = Axis::ALL[missing].name();
            format!(
                "WARNING: the plane is tilted against the axes of the components {order}; those along {axis}, which the file does not \
                 have, are taken as zero"
            )
        })
    }

    /// The axis that no component is along, of tensors in a plane.
    fn missing_axis(&self) -> Option<usize> {
        (0..3).find(|&axis| !self.order.0.has(axis, axis))
    }

    /// Refuses components of a plane that is not the one shown: what is shown would be zero.
    fn check_components(&self, cut: &Cut) -> Result<(), IoError> {
        let by_voxels = is_by_voxels(self.frame.0);
        // Along the axes of a turned world a part of every component is shown, unless the plane is at right angles to
        // theirs.
        let is_upright = |axis| self.lattice.across(cut, self.frame.0, axis) <= ALONG;
        if !by_voxels && cut.geometry.is_oblique() && !self.missing_axis().is_some_and(is_upright) {
            return Ok(());
        }
        let axis = |side: Side| if by_voxels { side.voxel } else { side.world };
        let has = |axis: usize| self.order.0.has(axis, axis);
        let shown = [axis(cut.right), axis(cut.up)];
        if shown.into_iter().all(has) {
            return Ok(());
        }
        let [a, b] = shown.map(|axis| Axis::ALL[axis].name());
        let needed = format!("{a}{a},{b}{b},{}", if a < b { format!("{a}{b}") } else { format!("{b}{a}") });
        Err(VolumeError::OtherPlane { order: self.order.0.to_string(), needed }.into())
    }
}
